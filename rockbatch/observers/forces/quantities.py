"""Quantities that designers size: forces, gaps, velocities, accelerations and the blows of impacts."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from rockbatch.pier import Pier
from rockbatch.quantities.cases import LANDS, LANDS_BY_IMPULSE, always, gives_way, per_gravity
from rockbatch.quantities.demands import Ceiling
from rockbatch.quantities.limits import LENGTHS, greater
from rockbatch.quantities.quantity import ENDINGS, Limit, Quantity, ReportFormat, Run, fact, in_print

MOST_FRICTION = 2.0
"""Coefficient of friction: concrete on concrete has 0.4 to 1."""

_SLIDES = (Limit(ceiling=Ceiling(always(MOST_FRICTION), "is more than any interface has")),)


def _of_forces(field: str, factor: Callable[[Pier], float | None] | None = None) -> Callable[[Run], float | None]:
    """Return a function of a run: ``field`` of its ``PeakForces`` times ``factor`` of the pier; None if one of them is None."""

    def value(run: Run) -> float | None:
        force = getattr(run.outcome.observed.get("forces"), field, None)
        times = 1.0 if factor is None else factor(run.pier)
        return None if force is None or times is None else force * times

    return value


def _force(
    name: str,
    words: str,
    field: str,
    unit: str,
    head: str,
    form: str,
    factor: int = 1,
    behind: str = "",
    per: Callable[[Pier], float | None] | None = None,
    **facts: Any,
) -> Quantity:
    """Return a quantity of a ``field`` of ``PeakForces``, times ``per`` of the pier."""
    page = ReportFormat(head, form, factor, behind, table="forces")
    source = _of_forces(field, per)
    return Quantity(name, words, source, unit, page, needs="forces", error="forces_error", **facts)


def _in_kilonewtons(
    name: str,
    field: str,
    unit: str,
    head: str,
    per: Callable[[Pier], float | None],
    limit: Limit,
    behind: str = "",
    **entered: Any,
) -> Quantity:
    """Return the quantity of a ``field`` in kN, kN m or kN s, for piers whose mass is known, described as "the same in kN, …"."""
    words = f"the same in {in_print(unit)}, if mass_t is given"
    more: dict[str, Any] = {"sometimes": True, "weighed": True, "limits": (limit,) if limit.words else (), **entered}
    return _force(name, words, field, unit, head, ".0f", per=per, behind=behind, **more)


_TIMES_MASS = {"m/s^2": "kN", "m/s": "kN*s", "m^2/s^2": "kN*m"}
"""Units of quantities over the mass, and of the same quantities times the mass [t]."""


def _over_mass(
    name: str,
    words: str,
    field: str,
    unit: str,
    symbol: str,
    form: str = ".3f",
    more: str = "",
    behind: str = "",
    **facts: Any,
) -> tuple[Quantity, Quantity]:
    """Return a quantity over the mass, and the same of a pier whose mass is known."""
    first, second = f"{name}_{ENDINGS[unit]}", f"{name}_{ENDINGS[_TIMES_MASS[unit]]}"
    limit = Limit(words=words)
    head = f"{symbol}/M"
    entered = {name: facts[name] for name in ("landing", "bending", "directed", "condition") if name in facts}
    return (
        _force(
            first,
            f"{words} over the mass",
            field,
            unit,
            head,
            form,
            more=more,
            behind=behind,
            limits=(Limit(),),
            **facts,
        ),
        _in_kilonewtons(second, field, _TIMES_MASS[unit], symbol, lambda pier: pier.mass_t, limit, first, **entered),
    )


def _half_weight(pier: Pier) -> float | None:
    return None if pier.mass_t is None else 0.5 * pier.mass_t * pier.gravity


_PIVOT_KN = "greatest force of {} support"
_PIVOT = f"{_PIVOT_KN} over half the weight"
_PIVOT_MORE = (
    ", including its dashpot; of a rigid base, when it carries all of N; for a frame the sum over the columns; of a footing "
    "those two at its edges that are equivalent to the push of the bed"
)
_GAP, _GAP_MORE = (
    "heel gap: greatest height of {} pivot above its support",
    ", the stroke of a key or damper",
)
_SPEED = "greatest speed at which the heel gap opens or closes"

QUANTITIES = (
    *_over_mass(
        "base_shear", "greatest base shear V", "base_shear", "m/s^2", "V", more=", without the impulses of impacts", landing=True,
        bending=True, directed=True,
    ),
    *_over_mass(
        "normal_force", "greatest normal force N of all supports", "normal_force", "m/s^2", "N", more=", as for V", landing=True,
    ),
    _force(
        "friction_demand", "greatest V over N at the same time", "friction_demand", "1", "V/N", ".4f", unbounded=True,
        limits=_SLIDES, more=", while N is above [output] least_normal_share of the weight, 0.1 unless given", landing=True,
        bending=True, while_pressed=True, directed=True,
    ),
    _force(
        "pivot_force_left", _PIVOT.format("each"), "pivot_left", "1", "support L/(Mg/2)", ".3f", more=_PIVOT_MORE, landing=True,
    ),
    _force(
        "pivot_force_right", _PIVOT.format("each"), "pivot_right", "1", "support R/(Mg/2)", ".3f", more=_PIVOT_MORE,
        limits=greater("pivot_force", _PIVOT), landing=True,
    ),
    _in_kilonewtons("pivot_force_left_kN", "pivot_left", "kN", "support L", _half_weight, Limit(), landing=True),
    _in_kilonewtons(
        "pivot_force_right_kN", "pivot_right", "kN", "support R", _half_weight,
        greater("pivot_force/_kN", _PIVOT_KN)[0], landing=True,
    ),
    _force("heel_gap_left_m", _GAP.format("each"), "heel_gap_left", "m", "heel gap L", ".1f", 1000, more=_GAP_MORE),
    _force(
        "heel_gap_right_m", _GAP.format("each"), "heel_gap_right", "m", "heel gap R", ".1f", 1000, more=_GAP_MORE,
        limits=greater("heel_gap/_m", _GAP, *LENGTHS), directed=True, later=gives_way,
    ),
    _force("heel_speed_left_m_s", _SPEED, "heel_speed_left", "m/s", "heel speed L", ".3f"),
    _force(
        "heel_speed_right_m_s", _SPEED, "heel_speed_right", "m/s", "heel speed R", ".3f",
        limits=greater("heel_speed/_m_s", _SPEED), directed=True,
    ),
    _force(
        "deck_acceleration_m_s2", "greatest absolute horizontal acceleration of the deck", "deck_acceleration", "m/s^2",
        "deck", ".3f", more=", or of the top without one", limits=(Limit(), Limit(unit="g", times=per_gravity)),
        landing=True, bending=True, pointwise=True, directed=True,
    ),
    _force(
        "landing_velocity_m_s", "speed of the landing pivot at the hardest impact", "landing_velocity", "m/s",
        "landing", ".3f", sometimes=True, limits=(Limit(),), condition=LANDS,
    ),
    *_over_mass(
        "impulse", "vertical impulse of the hardest impact", "impulse", "m/s", "impulse", sometimes=True,
        condition=LANDS_BY_IMPULSE,
    ),
    _force(
        "impact_friction_demand", "greatest horizontal over vertical impulse of an impact", "impact_friction_demand", "1",
        "V/N at impact", ".4f", sometimes=True, limits=_SLIDES, condition=LANDS_BY_IMPULSE,
    ),
    _force(
        "first_uplift_s", "time at which a pivot first leaves its support", "first_uplift", "s", "first uplift", ".3f",
        sometimes=True, least_is_worst=True,
    ),
    _force(
        "first_uplift_g", "magnitude of the horizontal ground acceleration then, over g", "uplift_ground",
        "standard_gravity", "ground then", ".4f", per=lambda pier: 1.0 / pier.gravity, sometimes=True, least_is_worst=True,
    ),
    _force(
        "omega_max_over_p", "greatest angular velocity over p", "omega_over_p", "1", "θ̇_max/p", ".4f", limits=(Limit(),),
        directed=True,
    ),
    *_over_mass(
        "key_shear", "greatest base shear on shear keys", "key_shear", "m/s^2", "V of keys",
        more=": V while N is below that share, as in flight", sometimes=True, landing=True, bending=True, directed=True,
    ),
    _force(
        "flight_longest_s", "duration of the longest flight", "flight_longest", "s",
        "longest flight", ".3f", sometimes=True, limits=(Limit(),),
    ),
    _force(
        "forces_error", "largest relative error among the force columns", "error", "1", "±", ".1g", sometimes=True,
        more=": four times the change when the step was halved; empty with a fixed step",
    ),
    *_over_mass(
        "base_moment", "greatest moment about the middle of the base", "base_moment", "m^2/s^2", "base moment", ".2f",
        "; of the vertical forces of supports, dampers and tendons; for a frame the sum over the columns, each about its own "
        "middle",
        "base_shear_kN",
        landing=True, directed=True,
    ),
)  # fmt: skip
"""Forces and motions for design, until the run ends or the pier leans beyond α for good."""


def _estimates_landings(study: Any) -> bool:
    return study.output.has("forces") and any(
        "contact_stiffness_kN_m" in case.base.parameters(case.pier) for case in study.cases
    )


_LANDING_FORCE = replace(
    _force(
        "landing_force_kN",
        "greatest force of a foot at the hardest impact, by contact_stiffness_kN_m of the case",
        "landing_force",
        "kN",
        "landing foot",
        ".0f",
        per=lambda pier: pier.mass_t,
        sometimes=True,
        weighed=True,
        more=": an orientation, which was within 30 % of the force on springs in 84 % of random runs with less than 0.6 g of "
        "vertical motion and in 42 % of those with more; no check is made of it",
    ),
    requested=_estimates_landings,
)


def _slides_or_not(study: Any) -> bool:
    return study.output.has("forces") and any(case.base.friction is not None for case in study.cases)


_SLIDES_FACT = fact(
    "slides",
    "the friction demand, of impacts too, is more than the interface has",
    ", as `friction` of the case; with [output] forces = true",
    _of_forces("slides"),
    requested=_slides_or_not,
)

LAST = (_LANDING_FORCE, _SLIDES_FACT)
