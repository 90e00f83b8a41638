"""Settlement by the other spring law, the worse of which counts in checks."""

from typing import Any

from rockbatch.quantities.cases import creeps
from rockbatch.quantities.demands import OtherEnd, toe
from rockbatch.quantities.quantity import YIELDING, OfSuite, Quantity, ReportFormat

OTHER_LAW = "settlement_other_law_m"
"""Column of the settlement by the other spring law."""


def _asked(study: Any) -> bool:
    return study.output.has("both_laws") and any(case.base.ratchets for case in study.cases)


FIRST = (
    Quantity(
        OTHER_LAW,
        "settlement of Bouc–Wen springs by the elastic–perfectly plastic law, the other end of the range; with [output] "
        "both_laws = true, or with a check of a settlement",
        lambda run: run.outcome.observed.get("other_law"),
        "m",
        ReportFormat("by the other law", ".2f", 1000, "settlement_m"),
        bases=YIELDING,
        stood=True,
        sometimes=True,
        suite=OfSuite("Settlement by the other law", ".2f"),
        requested=_asked,
    ),
)

_BY_OTHER_LAW = OtherEnd(
    OTHER_LAW,
    "both_laws",
    "other_law",
    lambda runs, case: runs.numbers(OTHER_LAW),
    creeps,
    model="law",
    models="spring laws",
)
OTHER_ENDS = {
    "settlement_m": _BY_OTHER_LAW,
    "toe_settlement_m": _BY_OTHER_LAW._replace(evaluate=toe(OTHER_LAW)),
}
"""Ends of the ranges of demands that are by the other law."""
