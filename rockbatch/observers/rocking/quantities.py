"""Rocking about a base that has yielded, its lean, and their errors."""

from rockbatch.quantities.cases import ONE
from rockbatch.quantities.limits import rotation
from rockbatch.quantities.quantity import ALL, YIELDING, Quantity, ReportFormat

ROCKING, LEAN = "theta_rocking_over_alpha", "theta_lean_over_alpha"

FIRST = (
    Quantity(
        ROCKING,
        "greatest rotation over α about the current position of rest on the base",
        "theta_rocking",
        page=ReportFormat("rocking/α", ".5f", behind="theta_max_is"),
        over_alpha=True,
        needs="rocking",
        error="theta_rocking_error",
        limits=(rotation("theta_rocking", ROCKING, "", ONE),),
        directed=True,
    ),
    Quantity(
        LEAN,
        "rotation over α of that position at the time of the greatest rotation, positive to its side",
        "theta_lean",
        page=ReportFormat("lean/α", ".5f", behind=ROCKING),
        over_alpha=True,
        bases=YIELDING,
        stood=True,
        needs="rocking",
    ),
)


def _error(name: str, behind: str, bases: tuple[str, ...] = ALL) -> Quantity:
    """Return the error of a column, ``behind`` which it stands in the report."""
    words = (
        "estimated error of rocking, and of lean, over α: the change when the step was halved; empty with a fixed step"
    )
    page = ReportFormat("±", ".1g", behind=behind)
    return Quantity(name, words, name, page=page, over_alpha=True, bases=bases, stood=True, needs="rocking")


ERRORS = (_error("theta_rocking_error", ROCKING), _error("theta_lean_error", LEAN, YIELDING))
