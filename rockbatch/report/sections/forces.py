"""Quantities for design: the greatest forces, gaps and velocities of every case, and those of every run."""

import numpy as np

from rockbatch.lazy import pd
from rockbatch.report.finished import Finished, worst_first
from rockbatch.report.labels import counted, head
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.sections.peaks import on_scale
from rockbatch.report.table import MOST_ROWS, Head, alarm, table, told_apart
from rockbatch.results.columns import Column, on_page

_LEAST = ("first_uplift_s", "first_uplift_g")
"""Columns of which the smallest value is the worst."""

_CUT_SHORT = ("flight", "failed")
"""Statuses of runs that ended early: their values are only bounds."""


def section(finished: Finished) -> Markup:
    """Report forces if the study asks for them."""
    shown = [column for column in on_page("forces") if column.name in finished.runs]
    if not shown or finished.runs.empty:
        return Markup("")
    lead = tag(
        "p",
        "The greatest values of each case over its records, and below those of every run, until it ends or the pier leans beyond "
        "α for good. Forces are without the impulses of impacts. V/N counts while N is above a share of the weight, a tenth "
        "unless the study has another least_normal_share; while it is not, as in flight, shear keys bear V whatever the "
        "friction, which is a column of its own. ± is the error of the least certain column, as a share of it. Of the first "
        "uplift, the earliest and the weakest ground are shown.",
    )
    parts = [lead, _sliding(finished), _of_frames(finished), _of_cases(finished, shown), tag("h3", "Every run")]
    return join(*parts, _every_run(finished, shown))


def _of_cases(finished: Finished, shown: list[Column]) -> Markup:
    """Return a row for each case: the worst of its runs, column by column."""
    rows: list[list[object]] = []
    for words, group in finished.groups():
        for place in group["series"].unique():
            runs, label = group[group["series"] == place], finished.series[int(place)].label
            ended = int(runs["status"].isin(_CUT_SHORT).sum())
            counts = f"{len(runs) - ended} of {len(runs)}"
            cells = (_worst(column, runs, bool(ended)) for column in shown)
            rows.append([f"{label} ({words})" if words else label, alarm(counts) if ended else counts, *cells])
    runs_head = Head(
        "runs", note="that went through, of all; where some did not, the others bound the values from one side"
    )
    drawn = table([Head("case"), runs_head, *map(head, shown)], rows, sortable=True, name="Forces of every case")
    bounds = "≥, ≤: some runs of the case did not go through, and theirs may be worse."
    return join(drawn, tag("p", bounds, class_="legend") if finished.runs["status"].isin(_CUT_SHORT).any() else "")


def _worst(column: Column, runs: "pd.DataFrame", cut_short: bool) -> object:
    """Return the worst of the runs, with ≥ or ≤ if it is only a bound."""
    values = runs[column.name].dropna()
    if values.empty:
        return None
    least = column.name in _LEAST
    value = on_scale(column.name, float(values.min() if least else values.max()))
    shown = number(value, head(column).form)
    return join(f"{'≤' if least else '≥'}\u00a0", shown) if cut_short else value


def _every_run(finished: Finished, shown: list[Column]) -> Markup:
    runs = worst_first(finished.runs, MOST_ROWS)
    rows = [
        [
            finished.shown(run["record"]),
            finished.which(run),
            *(on_scale(column.name, run[column.name]) for column in shown),
        ]
        for _, run in runs.iterrows()
    ]
    heads = [Head("record"), Head("case"), *map(head, shown)]
    drawn = table(heads, rows, sortable=True, name="Forces of every run")
    return join(told_apart(len(runs), len(finished.runs), "worst"), drawn)


def _sliding(finished: Finished) -> Markup:
    """Report how many runs need more friction than their interface has."""
    runs = finished.runs
    pairs = zip(runs["series"], runs["pier"], strict=True)
    available = np.array([finished.cases[pair]["parameters"].get("friction", np.inf) for pair in pairs])
    if not np.isfinite(available).any():
        return Markup("")
    asked = runs[["friction_demand", "impact_friction_demand"]].max(axis=1).to_numpy()
    slides, known = asked > available, np.isfinite(available) & ~np.isnan(asked)
    if not slides.any():
        return tag("p", f"No run asks more friction than its interface has, of {counted(int(known.sum()), 'run')}.")
    message = f"{counted(int(slides.sum()), 'run')} of {int(known.sum())}: the friction demand is greater than the interface's. "
    return tag(
        "p", alarm(message), "The pier would slide there, which the model does not follow: see the notes of the runs."
    )


def _of_frames(finished: Finished) -> Markup:
    if not any("deck_over_columns" in case["pier"] for case in finished.info["cases"]):
        return Markup("")
    return tag(
        "p",
        "Of a frame V, N, supports and impulses are those of all columns together, and |V|/N is their quotient: how the columns "
        "share them hangs on the deck, and one of them may ask more.",
    )
