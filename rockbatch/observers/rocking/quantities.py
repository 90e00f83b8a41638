"""Rocking about a base that has yielded, its lean, and their errors."""

from collections.abc import Callable

from rockbatch.quantities.cases import ONE
from rockbatch.quantities.limits import rotation
from rockbatch.quantities.quantity import ALL, YIELDING, Quantity, ReportFormat, Run

ROCKING, LEAN = "theta_rocking_over_alpha", "theta_lean_over_alpha"


def _part(field: str) -> Callable[[Run], float | None]:
    """Return a function of a run: ``field`` of its ``Parts``, None if they were not computed."""
    return lambda run: getattr(run.outcome.observed.get("rocking"), field, None)


FIRST = (
    Quantity(
        ROCKING,
        "greatest rotation over α about the current position of rest on the base",
        _part("rocking"),
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
        _part("lean"),
        page=ReportFormat("lean/α", ".5f", behind=ROCKING),
        over_alpha=True,
        bases=YIELDING,
        stood=True,
        needs="rocking",
    ),
)


def _error(part: str, behind: str, bases: tuple[str, ...] = ALL) -> Quantity:
    """Return the quantity of the error of a ``part``, "rocking" or "lean", ``behind`` whose column it stands in the report."""
    words = (
        "estimated error of rocking, and of lean, over α: the change when the step was halved; empty with a fixed step"
    )
    page = ReportFormat("±", ".1g", behind=behind)
    source = _part(f"{part}_error")
    return Quantity(
        f"theta_{part}_error", words, source, page=page, over_alpha=True, bases=bases, stood=True, needs="rocking"
    )


ERRORS = (_error("rocking", ROCKING), _error("lean", LEAN, YIELDING))
