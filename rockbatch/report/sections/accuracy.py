"""Cost and errors of the runs, and the results of ``rockbatch accuracy``."""

from collections.abc import Sequence

from rockbatch.report.drawing.accuracy import draw
from rockbatch.report.finished import Finished
from rockbatch.report.finished_accuracy import Level, chosen, read
from rockbatch.report.labels import counted
from rockbatch.report.markup import Markup, figure, join, number, paragraphs, tag
from rockbatch.report.table import Head, table


def section(finished: Finished) -> Markup:
    """Report time and estimated errors of the runs, and the measurement of this study if any."""
    levels = read(finished.directory / "accuracy.csv", finished.study["sha256"])
    return join(paragraphs(_cost(finished)), _measured(levels))


def _cost(finished: Finished) -> str:
    info, errors = finished.info, finished.runs["theta_max_error"].dropna()
    kept = info.get("kept", 0)  # of an earlier session, or of other machines, whose time is unknown
    cost = f"{counted(kept, 'run')} had been finished before. " if kept else ""
    if kept < info["runs"]:
        took = f"{number(float(info['wall_s']), '.3g')} s on {counted(info['jobs'], 'thread')}"
        cost += f"{counted(info['runs'] - kept, 'run')} took {took}."
    if len(errors):
        cost += (
            f" The error of θmax/α, estimated by halving the step, is {errors.median():.0e} in the median and "
            f"{errors.max():.0e} at most."
        )
    return cost


def _measured(levels: Sequence[Level]) -> Markup:
    if not levels:
        against = join(
            "Not measured against references: ", tag("code", "rockbatch accuracy"), " does that for this study."
        )
        return paragraphs(against)
    runs = counted(int(levels[0].runs or 0), "run")
    last_change = number(max(level.reference_change or 0.0 for level in levels), ".0e")
    caption = (
        f"Measured on {levels[0].machine}, in one thread, over {runs} of this study (SciPy's solvers: at most two of "
        "them, on springs), against runs with ever smaller steps, the last halving of which changed the peak by "
        f"{last_change} at most. k: steps per sample; SciPy: its rtol. Runs that overturn, or end otherwise than they "
        "should, have no error; the table counts the latter."
    )
    return join(paragraphs(_lead(levels)), figure(draw(levels), caption), _table(levels))


def _lead(levels: Sequence[Level]) -> str:
    """Describe the study's own setting in a sentence; empty if it was not measured."""
    own = chosen(levels)
    if own is None:
        return ""
    return (
        f"With the setting of this study a run takes {own.milliseconds} ms "
        f"and its peak is off by {own.error_max:.1e} at most, over the runs measured."
    )


def _table(levels: Sequence[Level]) -> Markup:
    """Return every level in numbers."""
    heads = [
        Head("method"),
        Head("k", ".0f", "substeps: steps per sample"),
        Head("tolerance", ".0e", "on θ_max/α; SciPy's rtol"),
        Head("runs", ".0f"),
        Head("median error", ".1e"),
        Head("95 %", ".1e", "error that 95 % of the runs keep"),
        Head("largest", ".1e"),
        Head("time per run [ms]", ".3g"),
        Head("other outcome", ".0f", "runs that end otherwise than the reference: overturned, flight"),
    ]
    rows = [
        [
            level.method, level.substeps, level.tolerance, level.runs, level.error_median, level.error_95,
            level.error_max, level.milliseconds, level.status_differs or None,
        ]
        for level in levels
    ]  # fmt: skip
    return table(heads, rows)
