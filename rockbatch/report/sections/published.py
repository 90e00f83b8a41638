"""Published values beside computed ones."""

import math
from fnmatch import fnmatchcase
from typing import Any

from rockbatch.report.finished import Finished, as_dicts
from rockbatch.report.labels import symbol
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.sections.peaks import outcome
from rockbatch.report.table import THETA, THETA_FORMAT, Head, table
from rockbatch.results.suite_statistics import NO_PEAK


def section(finished: Finished) -> Markup:
    """Compare with the references of the study; None if it has none."""
    return _published(finished) if finished.info["references"] else Markup("")


def _published(finished: Finished) -> Markup:
    """Return every run that matches a reference's record pattern, case and columns."""
    runs = finished.runs
    more = [key for key in ("polarity", "scale") if runs[key].nunique() > 1]
    keys = [*finished.info["varied"], *more]
    heads = [Head("record"), Head("case"), *(Head(symbol(key)) for key in keys)]
    heads += [Head(join(THETA, ", ours"), THETA_FORMAT), Head(join(THETA, ", published"))]
    heads += [Head("difference [%]", "+.1f"), Head("source")]
    rows: list[list[object]] = []
    for reference in finished.info["references"]:
        name, case, theirs = reference["record"], reference["case"], reference["theta_max_over_alpha"]
        fits = [run for run in as_dicts(runs[runs["case"] == case]) if _fits(run, reference)]
        for run in fits:
            ours = run["theta_max_over_alpha"] if run["status"] not in (*NO_PEAK, "failed") else None
            difference = 100 * (ours / theirs - 1) if ours is not None and theirs else None
            rows.append(
                [
                    finished.shown(run["record"]),
                    case,
                    *(run[key] for key in keys),
                    outcome(run),
                    theirs,
                    difference,
                    reference["source"],
                ]
            )
        if not fits:
            values = [reference["columns"].get(key, "") for key in keys]
            nothing = tag("span", "no such run", class_="muted")
            rows.append([name, case, *values, nothing, theirs, None, reference["source"]])
    return table(heads, rows, name="Compared with published values")


def _fits(run: dict[str, Any], reference: dict[str, Any]) -> bool:
    def equal(ours: object, theirs: object) -> bool:
        if isinstance(ours, float) and isinstance(theirs, float | int):
            return math.isclose(ours, theirs, rel_tol=1e-9)
        return ours == theirs

    return fnmatchcase(run["record"], reference["record"]) and all(
        equal(run.get(key), value) for key, value in reference["columns"].items()
    )
