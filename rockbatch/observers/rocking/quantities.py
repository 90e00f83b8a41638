"""Rocking about a base that has yielded, its lean, and their errors."""

from rockbatch.quantities.cases import ONE
from rockbatch.quantities.limits import rotation
from rockbatch.quantities.quantity import YIELDING, Quantity, ReportFormat

ROCKING = "theta_rocking_over_alpha"

FIRST = (
    Quantity(
        ROCKING,
        "greatest rotation over α about the current position of rest on the base",
        "theta_rocking", page=ReportFormat("rocking/α", ".5f", behind="theta_max_is"), over_alpha=True, needs="rocking",
        error="theta_rocking_error", limits=(rotation("theta_rocking", ROCKING, "", ONE),),
    ),
    Quantity(
        "theta_lean_over_alpha", "rotation over α of that position at the time of the greatest rotation, positive to its side",
        "theta_lean", page=ReportFormat("lean/α", ".5f", behind=ROCKING), over_alpha=True, bases=YIELDING,
        stood=True, needs="rocking",
    ),
)  # fmt: skip

_ROCKING_ERROR = (
    "estimated error of rocking, and of lean, over α: the change when the step was halved; empty with a fixed step"
)

ERRORS = (
    Quantity(
        "theta_rocking_error",
        _ROCKING_ERROR,
        "theta_rocking_error", page=ReportFormat("±", ".1g", behind=ROCKING), over_alpha=True, stood=True, needs="rocking",
    ),
    Quantity(
        "theta_lean_error",
        _ROCKING_ERROR,
        "theta_lean_error", page=ReportFormat("±", ".1g", behind="theta_lean_over_alpha"), over_alpha=True, bases=YIELDING,
        stood=True, needs="rocking",
    ),
)  # fmt: skip

DIRECTED = (ROCKING,)
"""Demands that each axis of the pier has by itself, so that those of two axes add up."""
