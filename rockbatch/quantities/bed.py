"""Quantities of a footing's bed, in the tables of studies with a footing."""

from collections.abc import Callable
from typing import Any

from rockbatch.quantities.cases import THOUSAND, YIELDS, always, bearing, width
from rockbatch.quantities.demands import Ceiling
from rockbatch.quantities.quantity import FOOTING, Limit, Quantity, ReportFormat, Run

MOST_PUSH = 100.0
"""Greatest push of the ground over the weight: landings on stiff ground have some ten."""

ROUNDING = 1e-9
"""Share of the bearing strength by which a limit equal to it may lie below it, for rounding."""


def _on_footing(study: Any) -> bool:
    return any(case.base.name in FOOTING for case in study.cases)


def _of_bed(field: str) -> Callable[[Run], Any]:
    """Return a function that reads ``field`` of a run's ``BedDemands``; None for a run without a bed."""
    return lambda run: None if run.outcome.bed is None else getattr(run.outcome.bed, field)


def _push(run: Run) -> float | None:
    return None if run.outcome.bed is None else run.outcome.bed.force / run.pier.gravity


def _push_error(run: Run) -> float | None:
    error = _of_bed("force_error")(run)
    return None if error is None else error / run.pier.gravity


def _alpha(run: Run) -> float | None:
    return None if run.outcome.bed is None else run.pier.alpha


def _strips_error(run: Run) -> float | None:
    error = _of_bed("strips_error")(run)
    return None if error is None else error / run.pier.alpha


def _edge_error(run: Run) -> float | None:
    """Return the error of an edge's settlement [m]: the middle's, plus half the width times that of the residual rotation.

    None without a bed, or if one of the two errors is not known.
    """
    middle, rotation = run.outcome.settlement_error, run.outcome.theta_res_error
    on_bed = run.outcome.bed is not None and middle is not None and rotation is not None
    return middle + run.pier.half_width * rotation if on_bed else None


def _quantity(
    name: str, words: str, source: Any, unit: str, page: ReportFormat | None = None, more: str = "", **facts: Any
) -> Quantity:
    return Quantity(name, words, source, unit, page, more, bases=FOOTING, requested=_on_footing, **facts)


_WIDER = Ceiling(width, "is more than the pier is wide")
_IN_MM = Limit(unit="mm", times=THOUSAND, ceiling=Ceiling(lambda case: 1000.0 * width(case), _WIDER.beyond))
_BEARING = Ceiling(
    lambda case: bearing(case) * (1.0 - ROUNDING),
    "does not occur, as the bed yields there",
    "limit edge_settlement_m or yielding_half_cycles instead, or the pressure below the bearing strength",
    unreachable=True,
)
_CHANGES = "4 times its change by twice the step, and by half as many strips{}; empty with a fixed step"
_READ = _CHANGES.format(", and 0.125 % of it, for what steps may miss of a peak")
_EDGE = "settlement of the {} edge of the foot, at rest on its bed"

OF_FOOTING = (
    _quantity("foot_alpha_rad", "slenderness α of the foot, atan(B/2h), by which θ/α of the case is divided", _alpha, "rad"),
    _quantity("contact_least", "least share of the foot that was pressed", _of_bed("contact_least"), "1",
        ReportFormat("least contact", ".3f", behind="settlement_m")),
    _quantity("bed_force_over_weight", "greatest push of the bed over the pier's weight, dashpots included", _push, "1",
        ReportFormat("push/(M\u00a0g)", ".3f", behind="contact_least"),
        error="bed_force_error", landing=True,
        limits=(Limit(ceiling=Ceiling(always(MOST_PUSH), "is more than a landing presses")),)),
    _quantity("bed_force_s", "time of it", _of_bed("t_force"), "s"),
    _quantity("bed_force_error", f"estimated error of the greatest push over the weight: {_READ}", _push_error, "1", stood=True,
        sometimes=True),
    _quantity("bed_pressure_MPa", "greatest pressure at an edge", _of_bed("pressure"), "MPa",
        ReportFormat("pressure", ".3g", behind="bed_force_over_weight"), ", if mass_t and length_m are given",
        sometimes=True, weighed=True, landing=True, error="bed_pressure_error_MPa", limits=(Limit(ceiling=_BEARING),)),
    _quantity("bed_pressure_s", "time of it", _of_bed("t_pressure"), "s"),
    _quantity("bed_pressure_at_m", "place of it to the right of the middle", _of_bed("pressure_at"), "m"),
    _quantity("bed_pressure_error_MPa", f"estimated error of the greatest pressure: {_READ}", _of_bed("pressure_error"), "MPa",
        sometimes=True, weighed=True, stood=True),
    _quantity("yielding_half_cycles", "number of rocks to one side in which the ground yielded", _of_bed("yielding_rocks"), "1",
        more="; it has no error, and one that only just yields may count or not", kind="count", limits=(Limit(),),
        condition=YIELDS, cumulative=True),
    _quantity("bed_work_J_kg", "plastic work of the ground, per unit mass of the pier", _of_bed("work"), "J/kg",
        error="bed_work_error_J_kg", limits=(Limit(),), condition=YIELDS, cumulative=True),
    _quantity("bed_work_error_J_kg", f"estimated error of it: {_CHANGES.format(', with what the bed yields after the run')}",
        _of_bed("work_error"), "J/kg", stood=True, sometimes=True),
    _quantity("settlement_left_m", _EDGE.format("left"), _of_bed("settlement_left"), "m",
        more="; above a safety factor of 2 a lower bound", stood=True),
    _quantity("settlement_right_m", _EDGE.format("right"), _of_bed("settlement_right"), "m",
        more="; likewise", stood=True, settlement=True, error="edge_settlement_error_m", condition=YIELDS, limits=(
            Limit("edge_settlement_m", ceiling=_WIDER, words=_EDGE.format("lower"),
                columns=("settlement_left_m", "settlement_right_m")),
            _IN_MM._replace(name="edge_settlement_mm", words=_EDGE.format("lower"),
                columns=("settlement_left_m", "settlement_right_m")),
        )),
    _quantity("edge_settlement_error_m", "estimated error of the settlements of both edges; empty with a fixed step",
        _edge_error, "m", stood=True, sometimes=True),
    _quantity("strips_error", "share of the error of the greatest rotation over α that the number of strips has: 4 times the "
        "change by half as many, 1.5 times that of any extreme before, or what a later one may exceed the peak by; empty with a "
        "fixed step", _strips_error, "1", stood=True, sometimes=True),
)  # fmt: skip
"""Quantities of a footing's bed, at the end of a table."""
