"""Quantities of accuracy.csv: heads, formats and meanings on the terminal and the page."""

from collections.abc import Sequence

from rockbatch.analyses.accuracy.levels import Level
from rockbatch.common.analyses import Entry
from rockbatch.reporting.table import Head

QUANTITIES = (
    Head("method", value="method"),
    Head("k", ".0f", "substeps: steps per sample", value="substeps"),
    Head("tolerance", ".0e", "on θ_max/α", value="tolerance"),
    Head("runs", ".0f", value="runs"),
    Head("with error", ".0f", "runs that end as the reference does and do not overturn", value="compared"),
    Head("median error", ".1e", value="error_median"),
    Head("95 %", ".1e", "error that 95 % of the runs keep", value="error_95"),
    Head("largest", ".1e", value="error_max"),
    Head("time per run", ".3g", value="milliseconds", unit="ms"),
    Head(
        "other outcome",
        ".0f",
        "runs that end otherwise than the reference: overturned, flight",
        value=lambda level: level["status_differs"] or None,
    ),
)
"""Heads of a table of :func:`rows`."""


def rows(levels: Sequence[Level]) -> list[Entry]:
    """Return the fields of each level, and ``milliseconds``, its time per run as text."""
    return [vars(level) | {"milliseconds": level.milliseconds} for level in levels]
