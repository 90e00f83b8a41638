"""A release test in the report: what was fitted, and the measured impacts and amplitudes on the computed rotation."""

from rockbatch.analyses.release import quantities
from rockbatch.analyses.release.figures import rotations
from rockbatch.common.lazy import pd
from rockbatch.reporting.finished_analysis import Contents, named, of_files
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import Head, listed
from rockbatch.results.labelled import as_dicts

FIT = ("case", "parameter", "value", "low", "high", "confidence", "scatter", "over_housner", "remark")
IMPACTS = ("case", "impact", "t_measured_s", "t_amplitude_computed_s", "amplitude_measured_rad", "restitution_measured")
HISTORY = ("case", "t_s", "theta_rad")


@of_files("release")
def section(contents: Contents) -> Markup:
    """Show the fit of each case and its picture; empty without a release test."""
    analysis = contents.analysis("release")
    if analysis is None:
        return Markup("")
    fits, impacts = analysis.table("release.csv", FIT), analysis.table("release_impacts.csv", IMPACTS)
    history = analysis.table("release_history.csv", HISTORY)
    if fits is None or impacts is None or history is None:
        return Markup("")
    varied = analysis.info["varied"]
    keys = ["case", *varied]
    tables = []
    for names, of_case in impacts.groupby(keys, sort=False, dropna=False):
        title = f"Impacts of {named(dict(zip(keys, names, strict=True)), keys)}, measured and computed"
        tables.append(listed(quantities.IMPACTS, as_dicts(of_case), name=title))
    lead = (
        "What the pier loses, fitted to the measured times and amplitudes, and the interval of the fit. In the pictures a "
        "measured amplitude stands at the time of the computed one."
    )
    pictures = tag("figure", drawn(rotations(impacts, history, varied)), class_="whole")
    return join(tag("p", lead), _fits(fits, keys), pictures, *tables, analysis.provenance())


def _fits(fits: "pd.DataFrame", keys: list[str]) -> Markup:
    """Return the table of what was fitted."""
    heads = [Head("case", value=lambda fit: named(fit, keys)), *quantities.FIT]
    notes = (f"{named(fit, keys)}: {fit['remark']}." for fit in as_dicts(fits))
    return join(listed(heads, as_dicts(fits), name="Fitted to the release test"), *(tag("p", words) for words in notes))
