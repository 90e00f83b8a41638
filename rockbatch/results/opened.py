"""Finished results, opened again: peaks, what was run, and histories."""

import os
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.files import read_table
from rockbatch.common.grouping import closest
from rockbatch.common.lazy import pd
from rockbatch.common.showing import Shown, several, shown
from rockbatch.outcome.response import Response
from rockbatch.quantities.catalogue import in_words
from rockbatch.quantities.rows import simulated, with_case
from rockbatch.results.histories_file import HISTORIES, Responses
from rockbatch.results.intensity import INTENSITY, orders
from rockbatch.results.labelled import Labelled, labelled
from rockbatch.results.reading import Saved, read_saved
from rockbatch.results.sections import SECTIONS, read_sections
from rockbatch.results.shocks import SHOCKS, read_shocks

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_CANDIDATES = 8


@dataclass(frozen=True, eq=False, repr=False)
class Results(Shown, Saved):
    """The results in a folder: ``directory``, ``info`` (run.json), ``peaks``, and the histories that were kept."""

    @cached_property
    def responses(self) -> Responses:
        """The runs whose histories were kept, each read when it is asked for; none if the study asked for none."""
        return Responses(self.directory / HISTORIES, self.info, self.peaks)

    @cached_property
    def intensity(self) -> "pd.DataFrame":
        """``intensity.csv``: measures of each run's motion, where the study asks for them ([output] intensity = true)."""
        return read_table(self._beside(INTENSITY, "[output] intensity = true"))

    @cached_property
    def intensity_order(self) -> "pd.DataFrame":
        """The order in which each measure puts the peaks, a row for each case, scale and measure:
        :class:`rockbatch.results.intensity.Order`."""
        return orders(self.intensity, self.info["varied"])

    @cached_property
    def shocks(self) -> "pd.DataFrame":
        """``shocks.csv``: what each shock does, where some motions are sequences ([[motions.sequence]])."""
        return read_shocks(self._beside(SHOCKS, "a [[motions.sequence]]"), self.info["varied"])

    @cached_property
    def sections(self) -> "pd.DataFrame":
        """``sections.csv``: forces in sections of the shaft, where the study asks for them ([output] sections = 5)."""
        return read_sections(self._beside(SECTIONS, "[output] sections = 5"), self.info["varied"])

    def plot_cdf(self, width_mm: float = 160.0, ax: "Axes | None" = None) -> "Figure":
        """Draw the distribution of θ_max/α over the records, a panel for each pier and scale, a curve for each case: a matplotlib
        Figure, ``width_mm`` wide or in the place of ``ax``.

        A station counts as one record, with the worst of its components, unless the study counts them apart. Records under
        which the pier overturned, or that were ended by flight, are what a curve lacks of 1 at its right end, where a cross
        says so.
        """
        from rockbatch.common.figures.paper import drawn
        from rockbatch.results.figures import distributions_of_all

        return drawn(distributions_of_all(self._labelled, str(self.info.get("count", "station"))), width_mm, ax)

    def _beside(self, name: str, key: str) -> Path:
        path = self.directory / name
        if not path.exists():
            raise InputError(f"{path}: not there; write {key} in the study, and start `rockbatch run` again")
        return path

    def response(self, record: str | None = None, case: str | None = None, **more: float | str) -> Response:
        """Return the response of one run.

        Parameters
        ----------
        record, case : str, optional
            Of which ground motion and case, or how the name of one of them begins; whatever the kept histories leave no
            choice about can be left out.
        **more
            Its ``polarity``, ``scale`` and values of the study's varied keys, where these differ.

        Raises
        ------
        InputError
            If there is none, or more than one; with those that there are.
        """
        wanted = {name: value for name, value in {"record": record, "case": case, **more}.items() if value is not None}
        index = self.responses.runs
        if index.empty:
            raise InputError(
                f'{self.directory}: no histories; write [output] histories = "worst" or "all" in the study, and '
                "start `rockbatch run` again"
            )
        keys = [name for name in index.columns if name != "status"]
        strange = [name for name in wanted if name not in keys]
        if strange:
            raise InputError(*(f"{name}: does not distinguish runs; choose by {', '.join(keys)}" for name in strange))
        fitting = index
        for name, value in wanted.items():
            remaining = fitting[fitting[name] == value]
            if remaining.empty and name in ("record", "case"):
                begun = fitting[fitting[name].str.startswith(str(value))]
                remaining = begun if begun[name].nunique() == 1 else remaining
            if remaining.empty:
                raise InputError(self._none(name, value, fitting))
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
        """Draw the peaks of every run, a matplotlib Figure: ``results.plot().savefig("peaks.pdf")``.

        It is ``width_mm`` wide, or in the place of ``ax``, matplotlib Axes of your own: in them if the figure has one panel, in
        a subfigure that replaces them if it has several.

        With ``axes="records"`` as the paper's Fig. 7: a panel for each record, θ_max/α over the foundations, lines for the rigid
        base; other piers, scales and directions have open marks, or colours of their own. With ``axes="self-similar"`` a panel
        for each foundation, and in it each run of every pier, record and scale at PGA/(g tan α) over ω_g/p with
        ω_g = PGA/PGV, in the tone of its θ_max/α: on these axes slender blocks of all sizes and slendernesses are one
        (Dimitrakopoulos & DeJong 2012). Raises ``InputError`` for others.
        """
        from rockbatch.common.figures.paper import drawn
        from rockbatch.results.figures import peaks_of_all, self_similar

        if axes not in ("records", "self-similar"):
            raise InputError(f'axes = "{axes}": must be "records" or "self-similar"')
        figure = peaks_of_all if axes == "records" else self_similar
        return drawn(figure(self._labelled, self.info), width_mm, ax)

    @property
    def _labelled(self) -> Labelled:
        return labelled(self.peaks, self.info, self.directory)

    def _facts(self) -> tuple[str, dict[str, str]]:
        """See :class:`Shown`."""
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
        """See :class:`Shown`."""
        columns = [
            "record",
            "case",
            *self.info["varied"],
            "status",
            "theta_max_over_alpha",
            "theta_max_error",
            "settlement_m",
        ]
        return simulated(self.peaks)[columns]

    def _none(self, name: str, value: float | str, among: "pd.DataFrame") -> str:
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
        With all that is wrong, if peaks.csv or run.json is missing or damaged.

    Warns
    -----
    MissingColumns
        Where an earlier version wrote them, without columns that it did not have yet.

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
    return Results(saved.directory, saved.info, saved.peaks, saved.missing)


def _candidates(fitting: "pd.DataFrame", criteria: dict[str, float | str]) -> str:
    """Return the runs that fit, by the values that distinguish them."""
    apart = [name for name in fitting.columns if name not in ("status", *criteria) and fitting[name].nunique() > 1]
    runs = fitting[apart].to_dict("records")
    return _listed(
        ", ".join(f"{name} = {shown(value)}" for name, value in run.items() if value == value) for run in runs
    )


def _listed(candidates: Iterable[str]) -> str:
    words = list(candidates)
    more = len(words) - MOST_CANDIDATES
    return "; ".join(words[:MOST_CANDIDATES]) + (f"; and {more} more" if more > 0 else "")
