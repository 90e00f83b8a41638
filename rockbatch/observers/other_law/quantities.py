"""Settlement by the other spring law, the worse of which counts in checks."""

from typing import Any

from rockbatch.quantities.demands import toe
from rockbatch.quantities.limits import OTHER_LAW
from rockbatch.quantities.quantity import YIELDING, OfSuite, Quantity, ReportFormat


def _asked(study: Any) -> bool:
    return study.output.has("both_laws") and any(case.base.ratchets for case in study.cases)


FIRST = (
    Quantity(
        OTHER_LAW,
        "settlement of Bouc–Wen springs by the elastic–perfectly plastic law, the other end of the range; with [output] "
        "both_laws = true, or with a check of a settlement",
        lambda run: run.outcome.observed.get("other_law"),
        "m",
        ReportFormat("by the other law [mm]", ".2f", 1000, "settlement_m"),
        bases=YIELDING,
        stood=True,
        sometimes=True,
        suite=OfSuite("Settlement by the other law [mm]", ".2f"),
        requested=_asked,
    ),
)

BY_OTHER_LAW = {"settlement_m": lambda runs, case: runs.numbers(OTHER_LAW), "toe_settlement_m": toe(OTHER_LAW)}
"""Values of demands by the other law."""
