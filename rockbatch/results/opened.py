"""Open finished results: peaks, inputs and histories."""

import os
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.grouping import closest
from rockbatch.common.lazy import pd
from rockbatch.common.observers import from_observer
from rockbatch.common.showing import Shown, several, shown
from rockbatch.outcome.response import Response
from rockbatch.quantities.catalogue import in_words
from rockbatch.quantities.demands import OF_SECTIONS, SECTIONS
from rockbatch.quantities.rows import simulated, with_case
from rockbatch.results.beside_peaks import present
from rockbatch.results.columns import with_units
from rockbatch.results.histories_file import HISTORIES, Responses
from rockbatch.results.labelled import Labelled, labelled
from rockbatch.results.reading import Saved, read_saved
from rockbatch.results.sections import read_forces

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_CANDIDATES = 8


@dataclass(frozen=True, eq=False, repr=False)
class Results(Shown, Saved):
    """The results in a folder: ``directory``, ``info`` (run.json), ``peaks`` and kept histories."""

    @cached_property
    def responses(self) -> Responses:
        """The runs with kept histories, each read on access; empty if none were kept."""
        return Responses(self.directory / HISTORIES, self.info, self.peaks)

    @cached_property
    def intensity(self) -> "pd.DataFrame":
        """``intensity.csv``: measures of each run's motion; ``InputError`` unless [output] intensity = true."""
        return from_observer("intensity", "table.read")(self.directory)

    @cached_property
    def intensity_order(self) -> "pd.DataFrame":
        """How well each measure orders the peaks, a row for each case, scale and measure.

        ``rank_correlation`` is Spearman's; ``slope`` and ``dispersion`` are of a line through the logarithms of measure and
        peak. All three are NaN with fewer than three runs.
        """
        return from_observer("intensity", "order.orders")(self.intensity, self.info["varied"])

    @cached_property
    def shocks(self) -> "pd.DataFrame":
        """``shocks.csv``: the response to each shock; ``InputError`` without a [[motions.sequence]]."""
        return from_observer("shocks", "table.read")(self.directory, self.info["varied"])

    @cached_property
    def sections(self) -> "pd.DataFrame":
        """``sections.csv``: forces in sections of the shaft; ``InputError`` without [output] sections."""
        return read_forces(
            present(self.directory / SECTIONS, "[output] sections = 5"), self.info["varied"], OF_SECTIONS
        )

    def plot_cdf(self, width_mm: float = 160.0, ax: "Axes | None" = None) -> "Figure":
        """Draw the distribution of θ_max/α over the records as a matplotlib Figure.

        It has a panel for each pier and scale and a curve for each case, and is ``width_mm`` wide or replaces ``ax``. A
        station counts as one record, with the worst of its components, unless the study counts components. Records under
        which the pier overturned or a run stopped in flight reduce the curve's end below 1; a cross marks the gap.
        """
        from rockbatch.common.figures.paper import drawn
        from rockbatch.results.figures import distributions_of_all

        return drawn(distributions_of_all(self._labelled, str(self.info.get("count", "station"))), width_mm, ax)

    def response(self, record: str | None = None, case: str | None = None, **more: float | str) -> Response:
        """Return the response of one run.

        Parameters
        ----------
        record, case : str, optional
            Names of ground motion and case, or unique beginnings of them; optional where only one is left to choose.
        **more
            Its ``polarity``, ``scale`` and values of the study's varied keys, if several are left.

        Raises
        ------
        InputError
            If no history fits, or more than one does; the message lists the choices.
        """
        wanted = {name: value for name, value in {"record": record, "case": case, **more}.items() if value is not None}
        index = self.responses.runs
        if index.empty:
            raise InputError(
                f'{self.directory}: no histories; add [output] histories = "worst" or "all" to the study and '
                "start `rockbatch run` again"
            )
        keys = [name for name in index.columns if name != "status"]
        strange = [name for name in wanted if name not in keys]
        if strange:
            raise InputError(*(f"{name}: not a key of runs; choose by {', '.join(keys)}" for name in strange))
        fitting = index
        for name, value in wanted.items():
            remaining = fitting[fitting[name] == value]
            if remaining.empty and name in ("record", "case"):
                begun = fitting[fitting[name].str.startswith(str(value))]
                remaining = begun if begun[name].nunique() == 1 else remaining
            if remaining.empty:
                raise InputError(self._no_history(name, value, fitting))
            fitting = remaining
        if len(fitting) > 1:
            raise InputError(
                f"{self.directory}: {len(fitting)} histories fit; choose one: {_candidates(fitting, wanted)}"
            )
        return self.responses[int(fitting.index[0])]

    def history(self, record: str | None = None, case: str | None = None, **more: float | str) -> "pd.DataFrame":
        """Return :attr:`Response.history` of one run, chosen as for :meth:`response`."""
        return self.response(record, case, **more).history

    def events(self, record: str | None = None, case: str | None = None, **more: float | str) -> "pd.DataFrame":
        """Return :attr:`Response.events` of one run, chosen as for :meth:`response`."""
        return self.response(record, case, **more).events

    @checked
    def plot(self, width_mm: float = 160.0, axes: str = "records", ax: "Axes | None" = None) -> "Figure":
        """Draw the peaks of every run as a matplotlib Figure: ``results.plot().savefig("peaks.pdf")``.

        It is ``width_mm`` wide or replaces ``ax``, your own matplotlib Axes: drawn in them if the figure has one panel, in
        a subfigure in their place if it has several.

        ``axes="records"`` follows the paper's Fig. 7: a panel for each record, θ_max/α over the foundations, lines for rigid
        ground; open marks or colours distinguish piers, scales and directions. ``axes="self-similar"`` has a panel for each
        foundation and a point for each run at PGA/(g tan α) over ω_g/p, with ω_g = PGA/PGV, shaded by θ_max/α: on these axes
        slender blocks of all sizes and slendernesses coincide (Dimitrakopoulos & DeJong 2012). Raises ``InputError`` for
        other ``axes``.
        """
        from rockbatch.common.figures.paper import drawn
        from rockbatch.results.figures import peaks_of_all, self_similar

        if axes not in ("records", "self-similar"):
            raise InputError(f'axes = "{axes}": must be "records" or "self-similar"')
        figure = peaks_of_all if axes == "records" else self_similar
        return drawn(figure(self._labelled, self.info), width_mm, ax)

    def plot_peaks(self, ax: "Axes | None" = None) -> "Axes":
        """Draw θ_max/α of every run into ``ax``, by default in a figure of one column of a paper, 88 mm; return the axes.

        A column of points stands for each foundation, its records in it; marks distinguish piers and scales.
        """
        from rockbatch.common.figures.paper import panel_in
        from rockbatch.results.figures import peaks_of_cases

        return panel_in(peaks_of_cases(self._labelled), ax)

    @property
    def _labelled(self) -> Labelled:
        return labelled(self.peaks, self.info, self.directory)

    def _facts(self) -> tuple[str, dict[str, str]]:
        """Return the title, and the numbers of runs by status, the largest peak, the number of unused files, and histories.

        "" hides a fact: see :class:`Shown`.
        """
        runs = simulated(with_case(self.peaks))
        counts = runs["status"].value_counts()
        facts = {"runs": f"{len(runs)}: " + ", ".join(f"{n} {status}" for status, n in counts.items())}
        stood = runs[runs["status"] == "ok"]
        if not stood.empty:
            worst = stood.iloc[int(stood["theta_max_over_alpha"].argmax())]
            also = [f"{name} = {shown(worst[name])}" for name in self.info["varied"] if worst[name] == worst[name]]
            place = ", ".join([f"{worst['record']} on {worst['case']}", *also])
            facts["largest"] = f"θ_max/α = {in_words('theta_max_over_alpha', worst['theta_max_over_alpha'])}, {place}"
        facts["not used"] = several(int((self.peaks["case"] == "").sum()), "file")
        facts["histories"] = HISTORIES if (self.directory / HISTORIES).exists() else ""
        return f"results of {self.info['study']['title']!r} in {self.directory}", facts

    def _beneath(self) -> "pd.DataFrame":
        """Return the table below the facts in a notebook: record, case, varied keys and results of simulated runs.

        Unusable files have rows in it, too.
        """
        results = ["status", "theta_max_over_alpha", "theta_max_error", "settlement_m"]
        return simulated(self.peaks)[["record", "case", *self.info["varied"], *results]]

    def _no_history(self, name: str, value: float | str, among: "pd.DataFrame") -> str:
        """Return the message that no history has this value of ``name``, with the nearest value, or choices ``among`` these."""
        values = among[name].dropna().unique().tolist()
        nearest = closest(value, map(str, values)) if isinstance(value, str) else None
        hint = f"there are {_listed(map(shown, values))}" if values else "it applies to none of them"
        if nearest:
            hint = f"did you mean {shown(nearest)}?"
        return f"{self.directory}: no history with {name} = {shown(value)}; {hint}"


@checked
def open_results(directory: str | os.PathLike[str]) -> Results:
    """Open the results that ``rockbatch run`` wrote into ``directory``.

    Raises
    ------
    InputError
        With every fault, if peaks.csv or run.json is missing or damaged.

    Warns
    -----
    MissingColumns
        If an earlier version wrote them, without columns that are new.

    Examples
    --------
    >>> table = rb.run("pier4.toml", out="reports/pier4")
    >>> results = rb.open_results("reports/pier4")
    >>> results
    <results of 'Pier 4' in reports/pier4>
      runs       4: 4 ok
      largest    θ_max/α = 0.24223, one-cosine on rigid
      histories  histories.h5
    >>> results.response("one-sine", "rigid").status
    'ok'
    >>> results.plot().savefig("peaks.png")
    """
    saved = read_saved(Path(directory))
    peaks = with_units(saved.peaks, saved.info.get("units", {}))
    return Results(saved.directory, saved.info, peaks, saved.missing)


def _candidates(fitting: "pd.DataFrame", criteria: dict[str, float | str]) -> str:
    """List runs in words, by the values that distinguish them and are no ``criteria``: the first eight, then "and 2 more"."""
    apart = [name for name in fitting.columns if name not in ("status", *criteria) and fitting[name].nunique() > 1]
    runs = [{name: value for name, value in run.items() if value == value} for run in fitting[apart].to_dict("records")]
    return _listed(", ".join(f"{name} = {shown(value)}" for name, value in run.items()) for run in runs)


def _listed(candidates: Iterable[str]) -> str:
    words = list(candidates)
    more = len(words) - MOST_CANDIDATES
    return "; ".join(words[:MOST_CANDIDATES]) + (f"; and {more} more" if more > 0 else "")
