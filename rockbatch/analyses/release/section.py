"""A release test in the report: what was fitted, and the measured impacts and amplitudes on the computed rotation."""

from collections.abc import Sequence

from rockbatch.analyses.release import quantities
from rockbatch.analyses.release.figures import rotations
from rockbatch.common.analyses import Entry
from rockbatch.common.lazy import pd
from rockbatch.reporting.finished_analysis import FinishedAnalysis, answered, named, of_analysis, sentence
from rockbatch.reporting.markup import Markup, figure, join, number, tag
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import Head, listed
from rockbatch.results.labelled import as_dicts

FIT = ("case", "parameter", "value", "low", "high", "confidence", "scatter", "over_housner", "remark", "doubt")
IMPACTS = ("case", "impact", "t_measured_s", "t_amplitude_computed_s", "amplitude_measured_rad", "restitution_measured")
HISTORY = ("case", "t_s", "theta_rad")
CAPTION = "Line: computed with the fitted value. Markers: measured, amplitudes at the time of the computed ones."
METHOD = "The value that makes the measured times and amplitudes likeliest, and its interval. "


@of_analysis("release", release=FIT, release_impacts=IMPACTS, release_history=HISTORY)
def section(
    analysis: FinishedAnalysis, fits: "pd.DataFrame", impacts: "pd.DataFrame", history: "pd.DataFrame"
) -> Markup:
    """Return the report's section of a release test: what was fitted in each case, the figure and the tables."""
    info = analysis.info
    keys, rows = ["case", *info["varied"]], as_dicts(fits)
    heads = [Head("case", value=lambda fit: named(info, fit, keys)), *quantities.FIT]
    computed = [
        tag("p", METHOD, *(f"{named(info, fit, keys)}: {fit['remark']}. " for fit in rows)),
        analysis.provenance(),
    ]
    return join(
        *(_answer(info, fit, keys) for fit in rows),
        figure(drawn(rotations(impacts, history, info)), CAPTION),
        listed(heads, rows, name="Fitted to the release test"),
        tag("details", tag("summary", "How this was computed"), *computed),
        *_impacts(info, impacts, keys),
    )


def _answer(info: Entry, fit: Entry, keys: Sequence[str]) -> Markup:
    """Return what was fitted in a case, in a sentence, with what puts it in doubt."""
    doubts = [doubt] if (doubt := number(fit["doubt"])) else []  # an empty cell is read as NaN
    return answered(sentence(f"{named(info, fit, keys)}: {quantities.in_words(fit)}", doubts))


def _impacts(info: Entry, impacts: "pd.DataFrame", keys: list[str]) -> list[Markup]:
    """Return for each case a folded table of its impacts."""
    tables = []
    for names, of_case in impacts.groupby(keys, sort=False, dropna=False):
        title = f"Impacts of {named(info, dict(zip(keys, names, strict=True)), keys)}, measured and computed"
        tables.append(tag("details", tag("summary", title), listed(quantities.IMPACTS, as_dicts(of_case), name=title)))
    return tables
