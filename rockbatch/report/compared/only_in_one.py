"""Runs that the other study does not have."""

from typing import Any

from rockbatch.report.document import Section
from rockbatch.report.pair import SIDES, Pair
from rockbatch.report.table import Head, table


def section(pair: Pair) -> Section | None:
    """Return a row for each case that has runs without a counterpart; None if all have one."""
    rows: list[list[Any]] = []
    for name, study, runs in zip(SIDES, pair.studies, pair.matched.only, strict=True):
        grouped = runs.groupby(["series", "pier", "scale", "polarity", "with_vertical"], sort=False)
        for _, same in grouped:
            records = list(dict.fromkeys(same["record"]))
            listed = ", ".join(records[:6]) + (f" and {len(records) - 6} more" if len(records) > 6 else "")
            rows.append([name, study.which(same.iloc[0]), len(same), listed])
    heads = [Head("study"), Head("case"), Head("runs"), Head("records")]
    return Section("Only in one", "only", table(heads, rows, name="Only in one")) if rows else None
