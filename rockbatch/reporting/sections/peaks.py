"""A table of every run, worst first."""

import math
from typing import TYPE_CHECKING

from rockbatch.common.observers import parts
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.catalogue import COLUMNS, DEMANDS, report_columns
from rockbatch.quantities.design import BOUND
from rockbatch.quantities.limits import IN_MOTION, IN_MOTION_ERROR
from rockbatch.quantities.rows import PEAKS
from rockbatch.reporting.finished import Finished, worst_first
from rockbatch.reporting.labels import counted, head, head_of_key
from rockbatch.reporting.markup import Markup, join, number, tag
from rockbatch.reporting.table import MOST_ROWS, THETA_FORMAT, Head, alarm, table
from rockbatch.reporting.templates import render
from rockbatch.results.labelled import Row, as_dicts

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

REMARKS = ("reason", "note")
"""Columns of texts, which are listed below the table."""
NOMINAL = "nominal"
"""Word for runs of the nominal design, whose bound is empty."""
LAST_DIGIT = 1e-5
"""Resolution of θ_max/α in the table."""
_OTHER_ENDS = {name: end.column for name in COLUMNS if name in DEMANDS and (end := DEMANDS[name].other_end)}
"""Columns of the other ends of ranges, by those of which they are the end."""
MOST_OPEN_REMARKS, MOST_REMARKS = 6, 200


def section(finished: Finished) -> Markup:
    """Return the table of every run, with remarks on its reliability; empty without runs."""
    runs = finished.runs
    if runs.empty:
        return Markup("")
    return render(
        "reporting/sections/peaks.html",
        file=PEAKS,
        runs=runs,
        finished=finished,
        table=_every_run(finished),
        remarks=[remark(finished) for remark in parts("section.remark")],
        far=int(Rows(runs).facts("beyond_linearised").sum()),
    )


def outcome(run: Row | None, worst: float = math.nan) -> object:
    """Return θ_max/α of a run, bold if it equals ``worst``, with marks of a flight or a lean; "" for None.

    Of a run that did not stand: its status, with the time of a flight, or the lower bound of one that failed after its motion.
    """
    if run is None:
        return ""
    status, theta, flight = run["status"], float(run["theta_max_over_alpha"]), run["flight_s"]
    if status == "flight" and flight == flight:
        return alarm(f"flight at {number(flight)} s")
    if status != "ok" or math.isnan(theta):
        return alarm(join(status, ", ", least) if (least := at_least(run)) else status)
    value = number(theta, THETA_FORMAT)
    shown = tag("strong", value) if theta == worst else value
    marks = []
    if flight == flight:
        marks.append(tag("sup", "f", title=f"both pivots off the ground, first at {number(flight)} s"))
    if leans := run["theta_max_is"]:
        marks.append(tag("sup", "\u2009", leans, title="mostly the lean of a yielded base; see its note"))
    return join(shown, *marks) if marks or isinstance(shown, Markup) else theta


def at_least(run: Row) -> Markup:
    """Return the lower bound of θ_max/α of a run that failed after its motion: "≥ 0.3124"; empty if it has none."""
    error = run[IN_MOTION_ERROR]
    if run["status"] != "failed" or error != error:
        return Markup("")
    return Markup(f"≥\u00a0{number(run[IN_MOTION] - error, THETA_FORMAT)}")


def _every_run(finished: Finished) -> Markup:
    """Return the worst :data:`MOST_ROWS` simulated rows of ``peaks.csv``, worst first, with remarks numbered below the table."""
    runs, varied = finished.runs, finished.info["varied"]
    # Shown only if they vary
    also = {"polarity": finished.both_directions, "scale": finished.many_scales}
    names = {"case": head(COLUMNS["case"])._replace(filter=True)}
    names |= {key: head_of_key(key, note=key, filter=True) for key in varied}
    names |= {name: head(COLUMNS[name])._replace(filter=True) for name, changes in also.items() if changes}
    if runs["with_vertical"].nunique() > 1:
        names["with_vertical"] = Head("vertical component", filter=True)
    columns = {column.name: head(column) for column in report_columns() if column.source and column.name in runs}
    known = {*COLUMNS, *varied, "vertical"}
    columns |= {name: Head(name) for name in map(str, finished.saved.peaks) if name not in known}
    for other in _OTHER_ENDS.values():  # shown as a range in the column of the first
        columns.pop(other, None)
    columns["status"] = columns["status"]._replace(filter=True)
    remarks: dict[str, int] = {}
    texts = [name for name in REMARKS if columns.pop(name, None)]

    def cell(run: Row, name: str) -> object:
        if name in _OTHER_ENDS:
            return _range(run, name)
        if name == "theta_max_error":
            return _rounded_up(run[name])
        return (name == "theta_max_over_alpha" and at_least(run)) or _cell(name, run[name])

    def cells(run: Row) -> list[object]:
        own = [remarks.setdefault(run[name], len(remarks) + 1) for name in texts if run[name]]
        return [
            *(NOMINAL if name == BOUND and not run[name] else run[name] for name in names),
            *(cell(run, name) for name in columns),
            " ".join(map(str, own)),
        ]

    heads = [head(COLUMNS["record"]), *names.values(), *columns.values(), Head("remark")]
    drawn = every_run(finished, heads, cells, "Every run")
    return join(drawn, _remarks(list(remarks)))


def _rounded_up(error: float) -> float | None:
    """Return an error rounded up to a multiple of :data:`LAST_DIGIT`; None for NaN."""
    return math.ceil(error / LAST_DIGIT) * LAST_DIGIT if error == error else None


def _remarks(texts: "Sequence[str]") -> Markup:
    """Return the numbered list of the first :data:`MOST_REMARKS` remarks, folded if there are more than six; empty for none."""
    if not texts:
        return Markup("")
    listed = tag("ol", *(tag("li", words) for words in texts[:MOST_REMARKS]), class_="remarks")
    if len(texts) <= MOST_OPEN_REMARKS:
        return listed
    return tag("details", tag("summary", f"{counted(len(texts), 'remark')}"), listed)


def every_run(
    finished: Finished, heads: "Sequence[Head]", cells: "Callable[[Row], Sequence[object]]", name: str
) -> Markup:
    """Return a table of the worst :data:`MOST_ROWS` runs, worst first; ``cells`` returns a run's cells after its record."""
    runs = worst_first(finished.runs, MOST_ROWS)
    rows = ([finished.shown(run["record"]), *cells(run)] for run in as_dicts(runs))
    return table(heads, rows, sortable=True, name=name, worst_of=len(finished.runs))


def _cell(name: str, value: "float | str | None") -> object:
    if name == "status":
        return alarm(str(value)) if value != "ok" else value
    return value if isinstance(value, str) else on_scale(name, value)


def _range(run: Row, name: str) -> object:
    """Return the value of a run in the unit of the page, as a range if it was computed by two models."""
    own, other = (on_scale(name, run.get(column)) for column in (name, _OTHER_ENDS[name]))
    if own is None or other is None:
        return own
    form = COLUMNS[name].page
    low, high = (number(value, form.form if form else ".2f") for value in sorted((own, other)))
    return Markup(low if low == high else f"{low}\u00a0–\u00a0{high}")


def on_scale(name: str, value: float | None) -> float | None:
    """Convert a value of column ``name`` to the unit of the page, unchanged for an unknown column; None for NaN and None."""
    column = COLUMNS.get(name)
    factor = column.page.factor if column and column.page else 1
    return None if value is None or value != value else factor * float(value)
