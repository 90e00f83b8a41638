"""Published values beside computed ones."""

import math

from rockbatch.common.naming import fits
from rockbatch.common.statuses import NOT_STANDING
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import head_of_key
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.reporting.sections.peaks import outcome
from rockbatch.reporting.table import THETA, THETA_FORMAT, Head, table
from rockbatch.results.labelled import Row, as_dicts


def section(finished: Finished) -> Markup:
    """Return a table of the study's references beside the runs that match record pattern, case and columns.

    A reference without a run says "no such run"; empty without references.
    """
    runs, references = finished.runs, finished.info["references"]
    if not references:
        return Markup("")
    keys = [*finished.info["varied"], *(key for key in ("polarity", "scale") if runs[key].nunique() > 1)]
    heads = [Head("record"), Head("case", key=True), *(head_of_key(key) for key in keys)]
    heads += [Head(join(THETA, ", ours"), THETA_FORMAT), Head(join(THETA, ", published"))]
    heads += [Head("difference", "+.1f", unit="%"), Head("source")]
    rows: list[list[object]] = []
    for reference in references:
        case, theirs, source = reference["case"], reference["theta_max_over_alpha"], reference["source"]
        fits = [run for run in as_dicts(runs[runs["case"] == case]) if _fits(run, reference)]
        for run in fits:
            ours = run["theta_max_over_alpha"] if run["status"] not in NOT_STANDING else None
            difference = 100 * (ours / theirs - 1) if ours is not None and theirs else None
            values = [run[key] for key in keys]
            rows.append([finished.shown(run["record"]), case, *values, outcome(run), theirs, difference, source])
        if not fits:
            values = [reference["columns"].get(key, "") for key in keys]
            nothing = tag("span", "no such run", class_="muted")
            rows.append([reference["record"], case, *values, nothing, theirs, None, source])
    return table(heads, rows, name="Compared with published values")


def _fits(run: Row, reference: Row) -> bool:
    """Return whether a run matches a reference's record pattern and columns; numbers within 1e-9 of their size."""

    def equal(ours: object, theirs: object) -> bool:
        if isinstance(ours, float) and isinstance(theirs, float | int):
            return math.isclose(ours, theirs, rel_tol=1e-9)
        return ours == theirs

    return fits(run["record"], reference["record"]) and all(
        equal(run.get(key), value) for key, value in reference["columns"].items()
    )
