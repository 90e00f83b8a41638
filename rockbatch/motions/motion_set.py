"""Everything that was read in files and folders: motions in order, and files that could not be used."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from numbers import Integral
from typing import overload

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import closest, grouped
from rockbatch.common.lazy import pd
from rockbatch.common.showing import Shown, several
from rockbatch.common.units import GRAVITY
from rockbatch.motions.intensity import measures
from rockbatch.motions.motion import Motion
from rockbatch.motions.unused import LeftOut, Unusable

Cell = str | float | None
"""A value of a table; ``None`` where it is unknown."""

_COLUMNS: dict[str, tuple[type, Callable[[Motion], Cell]]] = {
    "record": (str, lambda m: m.name),
    "file_h": (str, lambda m: m.source),
    "file_v": (str, lambda m: m.vertical_source),
    "dt_s": (float, lambda m: m.dt),
    "npts": (int, lambda m: m.npts),
    "duration_s": (float, lambda m: m.duration),
    "pga_h_g": (float, lambda m: m.pga / GRAVITY),
    "pga_v_g": (float, lambda m: None if m.pga_vertical is None else m.pga_vertical / GRAVITY),
    "pgv_h_m_s": (float, lambda m: measures.pgv(m.horizontal, m.dt, m.initial)),
    "pgd_h_m": (float, measures.believable_pgd),
    "arias_m_s": (float, lambda m: measures.arias_intensity(m.horizontal, m.dt)),
    "d5_95_s": (float, measures.duration_of_shaking),
    "azimuth_deg": (float, lambda m: m.azimuth),
    "magnitude": (float, lambda m: m.magnitude),
    "distance_km": (float, lambda m: m.distance_km),
    "processed": (str, lambda m: {None: None, True: "yes", False: "no"}[m.processed]),
    "check": (str, lambda m: ", ".join(finding.what for finding in m.findings) or None),
    "processing": (str, lambda m: "; ".join(m.notes)),
    "event": (str, lambda m: m.origin.event or None),
    "station_name": (str, lambda m: m.origin.station or None),
    "direction": (str, lambda m: m.origin.direction or None),
    "station": (str, lambda m: m.of_station),
    "vs30_m_s": (float, lambda m: m.listed.vs30_m_s),
    "list_scale": (float, lambda m: m.listed.scale),
    "list_d5_95_s": (float, lambda m: m.listed.d5_95_s),
    "list_pulse_period_s": (float, lambda m: m.listed.pulse_period_s),
}

COLUMNS = tuple(_COLUMNS)
"""Columns of :meth:`MotionSet.table`, and keys of :func:`row`."""

TEXTS = tuple(name for name, (kind, _) in _COLUMNS.items() if kind is str)
"""Columns of text; the others hold numbers."""

_DTYPES = {str: "str", float: "float64", int: "int64"}
_AT_A_GLANCE = ["record", "event", "station_name", "direction", "dt_s", "duration_s", "pga_h_g", "pga_v_g", "pgv_h_m_s"]


@dataclass(frozen=True, repr=False)
class MotionSet(Shown):
    """Motions in order, with the files that could not be used and those left out on purpose.

    It has a length and iterates over its motions; ``set[i]`` and ``set["name"]`` give one of them.

    Attributes
    ----------
    motions : list of Motion
    unusable : list of Unusable
        Files, or components, that could not be used, each with its reason.
    left_out : list of LeftOut
        Other files and records that are not needed, each with its reason.

    Examples
    --------
    >>> motions = rb.read_motions("motions/near_fault")
    >>> len(motions), motions[0].name
    (10, '20160214_001345_NBLC_20.N00E')
    >>> [round(motion.pga, 2) for motion in motions[:2]]
    [1.86, 1.8]
    >>> motions["CHAN24"].dt
    0.01
    >>> motions.table()[["record", "pga_h_g", "pga_v_g"]].nlargest(1, "pga_h_g").round(2)
                             record  pga_h_g  pga_v_g
    8  20161113_110259_WTMC_20.N28W     0.99     1.84
    """

    motions: list[Motion] = field(default_factory=list)
    unusable: list[Unusable] = field(default_factory=list)
    left_out: list[LeftOut] = field(default_factory=list)

    @property
    def without_vertical(self) -> list[str]:
        """Return the names of motions that lack the vertical component asked for."""
        return [motion.name for motion in self.motions if motion.lacks_vertical]

    @property
    def labels(self) -> dict[str, str]:
        """Return a label for people, "Imperial Valley 1979, Meloland, 270", by each name in tables.

        A label that several motions share is in full length, and if that is shared, too, the name follows in brackets.
        """
        labels = {motion.name: motion.label for motion in self.motions}
        for longer in (lambda motion: motion.origin.full_label or motion.label, lambda motion: motion.named):
            times = Counter(labels.values())
            labels |= {motion.name: longer(motion) for motion in self.motions if times[labels[motion.name]] > 1}
        return labels

    def stations(self) -> dict[str, list[Motion]]:
        """Return the motions that count as one record by its name, mostly the two horizontal components of a station."""
        return grouped(self.motions, lambda motion: motion.of_station)

    def reduced_to(
        self, motions: Sequence[Motion], unusable: Sequence[Unusable] = (), left_out: Sequence[LeftOut] = ()
    ) -> "MotionSet":
        """Return a set of these ``motions``, with ``unusable`` and ``left_out`` added to those of this set."""
        return MotionSet(list(motions), [*self.unusable, *unusable], [*self.left_out, *left_out])

    def __len__(self) -> int:
        return len(self.motions)

    def __iter__(self) -> Iterator[Motion]:
        return iter(self.motions)

    def __contains__(self, which: object) -> bool:
        return any(motion is which or motion.name == which for motion in self.motions)

    @overload
    def __getitem__(self, which: int | str) -> Motion: ...
    @overload
    def __getitem__(self, which: slice) -> list[Motion]: ...
    def __getitem__(self, which: int | str | slice) -> Motion | list[Motion]:
        """Return a motion by index or name, or a list by a slice.

        Raises ``IndexError`` beyond the last one, ``InputError`` for an unknown name and for other types.
        """
        if isinstance(which, Integral | slice):
            return self.motions[which]
        if not isinstance(which, str):
            raise InputError(f"motions[{which!r}]: must be a place, a slice of places or a name")
        if found := next((motion for motion in self.motions if motion.name == which), None):
            return found
        nearest = closest(which, (motion.name for motion in self.motions))
        hint = f'did you mean "{nearest}"?' if nearest else f"there are {_first_names(self.motions)}"
        raise InputError(f'there is no motion "{which}"; {hint}')

    def table(self) -> "pd.DataFrame":
        """Return a table of the motions, a row for each; ``rockbatch motions --csv`` has these columns, and more.

        Returns
        -------
        DataFrame, shape (len, 26)
            ``record``; ``file_h`` and ``file_v``, where its components are from; ``dt_s``, ``npts``, ``duration_s``;
            ``pga_h_g``, ``pga_v_g`` in g of 9.81 m/s², ``pgv_h_m_s``, ``pgd_h_m``, ``arias_m_s`` and ``d5_95_s``, measures of the
            record (:mod:`rockbatch.motions.intensity.measures`); ``azimuth_deg``, ``magnitude``, ``distance_km``, where known;
            ``processed``, "yes" or "no", as its agency says; ``check``, what is odd about it; ``processing``, what was done
            to it here; ``event``, ``station_name``, ``direction``, as its header says; ``station``, what components that
            count as one record share; ``vs30_m_s``, ``list_scale``, ``list_d5_95_s`` and ``list_pulse_period_s``, what PEER's
            ``_SearchResults.csv`` says of the record. Missing words are "" and missing numbers NaN.
        """
        rows = pd.DataFrame([row(motion) for motion in self.motions], columns=list(COLUMNS))
        return rows.fillna(dict.fromkeys(TEXTS, "")).astype(
            {name: _DTYPES[kind] for name, (kind, _) in _COLUMNS.items()}
        )

    def _facts(self) -> tuple[str, dict[str, str]]:
        """Return the title and, by name, the facts that :class:`Shown` prints: records, PGA, files not used or left out."""
        pga = sorted(motion.pga / GRAVITY for motion in self.motions)
        vertical = sum(motion.vertical is not None for motion in self.motions)
        return several(len(self), "ground motion") or "no ground motions", {
            "records": _first_names(self.motions),
            "PGA": " to ".join(f"{value:.3f}" for value in dict.fromkeys((pga[0], pga[-1]))) + " g" if pga else "",
            "vertical": f"{vertical} of {len(self)}" if pga else "",
            "not used": several(len(self.unusable), "file") + (", see .unusable" if self.unusable else ""),
            "left out": several(len(self.left_out), "file") + (", see .left_out" if self.left_out else ""),
        }

    def _beneath(self) -> "pd.DataFrame":
        """Return the main columns of the table, rounded to three decimals, without columns of text that are empty for all."""
        table = self.table()[_AT_A_GLANCE].round(3)
        return table.loc[:, (table != "").any()]


def row(motion: Motion) -> dict[str, Cell]:
    """Return the row of a motion in :meth:`MotionSet.table` by its columns; ``None`` for unknown values."""
    return {name: value(motion) for name, (_, value) in _COLUMNS.items()}


def _first_names(motions: Sequence[Motion]) -> str:
    """Return the names of the first three motions and the number of others: "a, b, c, and 7 more"."""
    names = [motion.name for motion in motions[:3]]
    if len(motions) > 3:
        names.append(f"and {len(motions) - 3} more")
    return ", ".join(names)
