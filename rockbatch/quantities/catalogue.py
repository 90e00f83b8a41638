"""The catalogue: all quantities of a run, a row each, and all that a check may ask of them.

The file peaks.csv with its types and units, the report's tables and tooltips, the comparison of two studies, the demands of
checks, docs/columns.md and the list in configs/checks/stepping_pier.toml follow from it. A new quantity is a row at the end of
:data:`TRAILING`, or of :data:`OPTIONAL`, and a number in ``Outcome`` for it.
"""

from collections.abc import Callable, Iterable
from dataclasses import replace
from itertools import groupby
from typing import Any, Literal

import numpy as np

from rockbatch.common.grouping import grouped
from rockbatch.pier import MOST_ETA, Pier
from rockbatch.pier.restraints import YIELDING_TENDON
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.bed import OF_FOOTING
from rockbatch.quantities.cases import (
    ONE,
    THOUSAND,
    Case,
    Lever,
    alpha,
    always,
    bends,
    per_gravity,
    product,
    top,
    weight,
    width,
)
from rockbatch.quantities.demands import (
    Ceiling,
    Demand,
    Estimated,
    Evaluate,
    axial,
    event,
    in_flight,
    in_section,
    largest,
    parameter,
    tilt,
    toe,
    toe_settlement,
)
from rockbatch.quantities.quantity import (
    BENDING,
    ENDINGS,
    FOOTING,
    SETTLING,
    SPRINGS,
    TILTS,
    TWO_SPRINGS,
    YIELDING,
    Limit,
    OfSuite,
    Quantity,
    ReportFormat,
    Run,
    in_print,
)

IN_MOTION, IN_MOTION_ERROR = "theta_max_in_motion_over_alpha", "theta_max_in_motion_error"
"""Columns of the peak until a motion ends, which a run that failed later has reached, and of its error."""

ROCKING = "theta_rocking_over_alpha"
"""A column that every run with rocking has."""

OTHER_LAW = "settlement_other_law_m"
MIRROR_OF = "mirror_of"
"""Column of the polarity of the run whose mirror image a row is; only where a study has both polarities."""

MOST_DUCTILITY = 100.0
"""Greatest over yield deflection of a support: soils bear some 2 to 10."""

MOST_FRICTION = 2.0
"""Coefficient of friction: concrete on concrete has 0.4 to 1."""

_OVERTURNS = "is past the edge of overturning"
_WIDER = Ceiling(width, "is more than the pier is wide")
_IN_MM = Limit(unit="mm", times=THOUSAND, ceiling=Ceiling(product(THOUSAND, width), _WIDER.beyond))
_LENGTHS = (Limit(ceiling=_WIDER), _IN_MM)
_SPENT = Ceiling(always(MOST_DUCTILITY), "is more than any support bears")
_SLIDES = (Limit(ceiling=Ceiling(always(MOST_FRICTION), "is more than any interface has")),)


def _rotation(of: str, name: str, unit: str, times: Lever, words: str = "") -> Limit:
    """Return a limit on |θ|/α times a factor, from the columns OF_over_alpha and OF_error."""
    reached = largest((IN_MOTION,), times, IN_MOTION_ERROR) if of == "theta_max" else None
    evaluate = largest((f"{of}_over_alpha",), times, f"{of}_error")
    return Limit(name, unit, times, Ceiling(times, _OVERTURNS), words, evaluate=evaluate, reached=reached)


def _displacements(name: str, lever: Lever) -> tuple[Limit, Limit]:
    """Return limits on the greatest rotation times a length, in m and in mm."""
    in_metres, in_millimetres = product(lever, alpha), product(product(THOUSAND, lever), alpha)
    return _rotation("theta_max", f"{name}_m", "m", in_metres), _rotation(
        "theta_max", f"{name}_mm", "mm", in_millimetres
    )


def _top_drift(run: Run) -> float:
    """Return the greatest drift [m]: of a shaft that bends as its own run has it."""
    bent = run.outcome.top_drift_max
    return run.pier.top * run.outcome.theta_max if bent is None else bent


def _bent_as_well(limit: Limit) -> Limit:
    """Return a limit on drift that also holds for a shaft that bends, which drifts by more than it rotates."""
    bent = largest(("top_drift_m",), THOUSAND if limit.unit == "mm" else ONE, "top_drift_error_m")

    def either(rigid: Evaluate | None) -> Evaluate | None:
        return rigid and (lambda runs, case: (bent if bends(case) else rigid)(runs, case))

    return limit._replace(
        evaluate=either(limit.evaluate), reached=either(limit.reached), words="greatest drift", height=top
    )


def _of_forces(field: str, factor: Callable[[Pier], float | None] | None = None) -> Callable[[Run], float | None]:
    """Return the number of a field of ``PeakForces``, times a factor of the pier if that is known."""

    def value(run: Run) -> float | None:
        force = None if run.outcome.forces is None else getattr(run.outcome.forces, field)
        times = 1.0 if factor is None else factor(run.pier)
        return None if force is None or times is None else force * times

    return value


def _force(
    name: str, words: str, field: str, unit: str, head: str, form: str, factor: int = 1, *, more: str = "", behind: str = "",
    per: Callable[[Pier], float | None] | None = None, **facts: Any,
) -> Quantity:  # fmt: skip
    """Return a quantity of a ``field`` of ``PeakForces``, times ``per`` of the pier."""
    page = ReportFormat(head, form, factor, behind, table="forces")
    source = _of_forces(field, per)
    return Quantity(name, words, source, unit, page, more, needs="forces", error="forces_error", **facts)


def _in_kilonewtons(
    name: str,
    field: str,
    unit: str,
    head: str,
    per: Callable[[Pier], float | None],
    limit: Limit,
    behind: str = "",
    **entered: bool,
) -> Quantity:
    """Return the same as the quantity before, for piers whose mass is known."""
    words = f"the same in {in_print(unit)}, if mass_t is given"
    more: dict[str, Any] = {"sometimes": True, "weighed": True, "limits": (limit,) if limit.words else (), **entered}
    return _force(name, words, field, unit, f"{head} [{in_print(unit)}]", ".0f", per=per, behind=behind, **more)


_TIMES_MASS = {"m/s^2": "kN", "m/s": "kN*s", "m^2/s^2": "kN*m"}
"""Units of quantities over the mass [t], and of these."""


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
    head = f"{symbol}/M [{in_print(unit)}]"
    entered = {name: facts[name] for name in ("landing", "bending") if name in facts}
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


def _greater(name: str, words: str, *limits: Limit) -> tuple[Limit, ...]:
    """Return limits on the greater of the left and the right support, in the place of whose side ``name`` has "/".

    ``words`` have "{}" for "each" or "a".
    """
    stem, _, ending = name.partition("/")
    columns = (f"{stem}_left{ending}", f"{stem}_right{ending}")
    return tuple(
        limit._replace(
            name=f"{stem}_{limit.unit}" if limit.unit else stem + ending, words=words.format("a"), columns=columns
        )
        for limit in limits or (Limit(),)
    )


def _settlement(runs: Rows, case: Case) -> Estimated:
    """Return the mean settlement of the supports."""
    return Estimated(runs.numbers("settlement_m"), runs.numbers("settlement_error_m"))


_SETTLEMENTS = (
    Limit(ceiling=_WIDER, evaluate=_settlement, other_law=lambda runs, case: runs.numbers(OTHER_LAW)),
    Limit(
        "toe_settlement_m", ceiling=_WIDER, words="settlement of the support that settles more", evaluate=toe_settlement,
        other_law=toe(OTHER_LAW),
    ),
)  # fmt: skip
_TILTS = (
    Limit(ceiling=Ceiling(alpha, _OVERTURNS), evaluate=tilt(ONE)),
    Limit(
        "differential_settlement_m", "m", ceiling=Ceiling(product(width, alpha), _OVERTURNS),
        words="settlement of one support against the other", evaluate=tilt(width),
    ),
)  # fmt: skip

FIXED = (
    Quantity("record", "ground motion, named after its file or channel", kind="text", page=ReportFormat("record")),
    Quantity("case", "name of the foundation in the study", kind="text", page=ReportFormat("case")),
    Quantity(
        "polarity", "+ as recorded, - horizontal component reversed", kind="text", page=ReportFormat("polarity")
    ),
    Quantity("scale", "factor on all components", page=ReportFormat("scale")),
    Quantity(
        "status",
        "ok, overturned, flight (both pivots left the ground and the run ended there: see reason) or failed (see reason)",
        "status", kind="text", page=ReportFormat("status"),
    ),
    Quantity(
        "theta_max_over_alpha", "greatest rotation over α", "theta_max",
        more="; the run continues until nothing later can exceed it", page=ReportFormat("θ_max/α", ".5f"), over_alpha=True,
        suite=OfSuite("Largest rotation θ_max/α", ".4f"),
        error="theta_max_error",
        limits=(
            _rotation("theta_max", "theta_max_over_alpha", "", ONE),
            _rotation("theta_max", "theta_max_rad", "rad", alpha, "greatest rotation"),
        ),
    ),
    Quantity(
        "theta_max_error",
        "estimated error of the greatest rotation over α: its change when the step was halved, or under a motion 10⁻⁸ stronger "
        "or weaker; empty if it is chaotic, and with a fixed step",
        "theta_max_error", page=ReportFormat("±", ".5f"), over_alpha=True, stood=True,
    ),
    Quantity("t_max_s", "time of the greatest rotation", "t_max", "s", ReportFormat("at t [s]", ".2f")),
    Quantity(
        "theta_res_over_alpha", "residual rotation over α", "theta_res", more=", at rest on the deformed base",
        page=ReportFormat("θ_res/α", ".5f"), over_alpha=True, bases=TILTS, stood=True,
        suite=OfSuite("Residual rotation |θ_res|/α", ".5f"), error="theta_res_error",
        limits=(
            _rotation("theta_res", "theta_res_over_alpha", "", ONE),
            _rotation("theta_res", "theta_res_rad", "rad", alpha, "residual rotation"),
        ),
    ),
    Quantity(
        "settlement_m", "mean settlement of the supports", "settlement", "m",
        ReportFormat("settlement [mm]", ".2f", 1000), " since the start", bases=SPRINGS, stood=True,
        suite=OfSuite("Settlement [mm]", ".2f"), error="settlement_error_m", limits=_SETTLEMENTS,
    ),
    Quantity("impacts", "number of impacts", "impacts", kind="count", limits=(Limit(),)),
    Quantity("separations", "number of separations", "separations", kind="count", limits=(Limit(),)),
    Quantity(
        "flight_s", "time at which both pivots first left the ground, also if the run continued", "t_flight",
        "s", sometimes=True,
    ),
    Quantity("substeps", "integration steps per sample", "substeps", kind="count"),
)  # fmt: skip
"""Quantities that every table has, in its order; then come those of the keys that the study varies."""

_CHANGED = "a motion 10⁻⁸ stronger or weaker"
_KNOWN = "; empty with a fixed step, and of a run that failed"


def _fact(name: str, words: str, more: str = "", source: Callable[[Run], Any] | None = None, **facts: Any) -> Quantity:
    """Return a quantity that is 1 where ``words`` hold and 0 where they do not, of the field of ``Outcome`` of its name."""
    return Quantity(name, f"1 if {words}, 0 if not", source or name, more=more, kind="fact", sometimes=True, **facts)


_DUCTILITY = "greatest deflection of {} support over its yield deflection"
_DISSIPATED = "plastic work of each support, per unit mass"

TRAILING = (
    Quantity(
        "theta_res_error",
        "estimated error of the residual rotation over α, including its drift between readings; empty if it is chaotic, "
        "and with a fixed step",
        "theta_res_error", over_alpha=True, bases=TILTS,
        stood=True,
    ),
    Quantity("t_end_s", "end of the run", "t_end", "s"),
    Quantity(
        "base_tilt_rad", "residual tilt of the base", "base_tilt", "rad",
        ReportFormat("base tilt [mrad]", ".3f", 1000, "theta_res_over_alpha"), bases=SPRINGS, stood=True,
        limits=_TILTS,
    ),
    Quantity(
        "ductility_left", _DUCTILITY.format("each"), "ductility_left",
        page=ReportFormat("demand L", ".2f", behind="settlement_m"), bases=YIELDING,
    ),
    Quantity(
        "ductility_right", _DUCTILITY.format("each"), "ductility_right",
        page=ReportFormat("demand R", ".2f", behind="ductility_left"),
        bases=YIELDING, limits=_greater("ductility", _DUCTILITY, Limit(ceiling=_SPENT)),
    ),
    Quantity(
        "dissipated_left_J_kg", _DISSIPATED, "dissipated_left", "J/kg",
        bases=YIELDING,
    ),
    Quantity(
        "dissipated_right_J_kg", _DISSIPATED, "dissipated_right", "J/kg",
        bases=YIELDING,
    ),
    Quantity(
        "residual_s",
        "time at which residual rotation, tilt and settlement were read: the pier had stopped rocking, or 40/p had passed",
        "t_read", "s", bases=YIELDING, stood=True,
    ),
    Quantity(
        "theta_res_drift_per_s",
        "rate of change of the residual rotation over α when it was read, as undamped vibration continues",
        "theta_res_drift", "1/s", over_alpha=True, bases=YIELDING,
        stood=True,
    ),
    Quantity(
        "settlement_drift_m_s", "rate of change of the settlement when it was read", "settlement_drift", "m/s",
        bases=YIELDING, stood=True,
    ),
    Quantity(
        "reason", "why a run failed, or why the pier flew", "reason", kind="text", page=ReportFormat("reason"),
        sometimes=True,
    ),
    Quantity(
        "note", "remarks on a valid run, such as counts that did not converge", "note",
        kind="text", page=ReportFormat("note"), sometimes=True,
    ),
    Quantity(
        "station",
        "station and earthquake; checks count its components as one record; a pulse is a station of its own",
        kind="text",
    ),
    Quantity(
        "top_drift_m", "greatest drift, at the height `drift_height_m`",
        _top_drift, "m", ReportFormat("drift [mm]", ".1f", 1000, "t_max_s"),
        ": that height times the greatest rotation; of a shaft that bends its greatest horizontal way",
        limits=tuple(_bent_as_well(limit) for limit in _displacements("top_drift", top)),
    ),
    Quantity(
        "heel_uplift_m", "greatest rise of the heel above the toe",
        lambda run: 2.0 * run.pier.half_width * run.outcome.theta_max, "m",
        ReportFormat("heel uplift [mm]", ".1f", 1000, "top_drift_m"),
        ": the width between the pivots times the greatest rotation", limits=_displacements("heel_uplift", width),
    ),
    Quantity(
        "pga_g", "peak horizontal acceleration of the scaled motion, over g",
        lambda run: run.pga / run.pier.gravity, "standard_gravity", ReportFormat("PGA [g]", ".3f", behind="scale"),
    ),
    Quantity(
        "flights", "number of flights, with both pivots off the ground", "flights",
        kind="count", more="; includes a flight that ended the run",
        limits=(Limit(evaluate=in_flight("flights")),),
    ),
    Quantity(
        "flight_duration_s", "time with both pivots in the air",
        lambda run: run.outcome.flight_duration or None, "s",
        more=", in all flights together", sometimes=True, limits=(Limit(evaluate=in_flight("flight_duration_s")),),
    ),
    Quantity(
        "flight_height_m", "greatest height of the lower pivot above the ground",
        lambda run: run.outcome.flight_height or None, "m",
        ReportFormat("flight height [mm]", ".2f", 1000, "ductility_right"),
        ", or above its support, in these flights", sometimes=True,
        limits=(Limit(evaluate=in_flight("flight_height_m"), ceiling=_WIDER),),
    ),
    Quantity(
        "theta_max_is",
        '"lean" if the greatest rotation is mostly the tilt of a base that has yielded, and rocking about it was twice as large '
        "before; otherwise empty",
        "theta_max_is", kind="text", page=ReportFormat("θ_max is", behind="theta_max_error"), bases=YIELDING, sometimes=True,
    ),
    Quantity(
        IN_MOTION,
        "greatest rotation over α until the record's last sample; for a run that failed later, a lower bound of its peak",
        "theta_max_in_motion", over_alpha=True,
    ),
    Quantity(
        IN_MOTION_ERROR, "estimated error of it over α; empty if it has not converged, and with a fixed step",
        "theta_max_in_motion_error", over_alpha=True, sometimes=True,
    ),
    Quantity(
        "settlement_error_m",
        "estimated error of the settlement, including its drift between readings; empty if it is chaotic, and with a "
        "fixed step",
        "settlement_error", "m", bases=SETTLING, stood=True, sometimes=True,
    ),
    Quantity(
        "drift_height_m", "height above the pivots at which drift is read", lambda run: run.pier.top, "m",
        ReportFormat("drift at [m]", ".6g", behind="top_drift_m"), ": `top_m` of the pier, or its highest point",
    ),
    Quantity(
        "failure",
        "kind of failure of a run: contacts, blew up, undecided, ratchets, not settled, large step, many steps; of a record: "
        "unusable; see reason",
        lambda run: run.outcome.failure.value if run.outcome.failure else "", kind="text", sometimes=True,
    ),
    _fact("chaotic", f"{_CHANGED}, or another step, changes the peak or the residuals beyond the tolerance", _KNOWN),
    _fact("may_overturn", f"{_CHANGED} overturns the pier, and this one does not", _KNOWN),
    _fact(
        "beyond_linearised", "the rotations are too large for linearised kinematics",
        '; empty with kinematics = "finite"',
    ),
)  # fmt: skip
"""Quantities that follow those of the varied keys. A table of an earlier version may lack the last of them."""


def _device(
    name: str, words: str, source: str | Callable[[Run], Any], unit: str, head: str, form: str, factor: int = 1,
    *limits: Limit, device: str, more: str = "", behind: str = "", kind: Literal["number", "count"] = "number",
    weighed: bool = False,
) -> Quantity:  # fmt: skip
    """Return a quantity of a kind of devices; checks limit it as it is unless ``limits`` are given."""
    error = "" if kind == "count" else "devices_error"
    page = ReportFormat(head, form, factor, behind)
    return Quantity(
        f"{device}_{name}", words, source, unit, page, more, kind, sometimes=True, error=error, limits=limits or (Limit(),),
        device=device, weighed=weighed,
    )  # fmt: skip


def _device_force(device: str, symbol: str) -> Quantity:
    """Return the greatest force of a kind of devices over the weight."""
    kind = device.replace("_", " ")
    words = f"greatest force of a {kind} over the pier's weight"
    return _device("force_over_weight", words, f"{device}_force", "1", f"{kind} {symbol}/(M g)", ".4f", device=device)


def _device_force_in_kilonewtons(device: str, symbol: str) -> Quantity:
    """Return it in kN; checks take it from that over the weight, since earlier results have no other."""

    def value(run: Run) -> float | None:
        force, mass = getattr(run.outcome, f"{device}_force"), run.pier.mass_t
        return None if force is None or mass is None else force * mass * run.pier.gravity

    kind, over_weight = device.replace("_", " "), f"{device}_force_over_weight"
    limit = Limit(times=weight, columns=(over_weight,))
    return _device(
        "force_kN", f"greatest force of a {kind}", value, "kN", f"{kind} {symbol} [kN]", ".0f", 1, limit, device=device,
        more=", if mass_t is given", behind=over_weight, weighed=True,
    )  # fmt: skip


DEVICES = (
    _device_force("damper", "F"),
    _device(
        "stroke_m", "greatest elongation of a damper", "damper_stroke", "m", "damper stroke [mm]", ".1f", 1000, *_LENGTHS,
        device="damper",
    ),
    _device("speed_m_s", "greatest speed of a damper", "damper_speed", "m/s", "damper speed [m/s]", ".3f", device="damper"),
    _device(
        "energy_J_kg", "energy dissipated by all dampers, per unit mass of the pier", "damper_energy", "J/kg",
        "dampers [J/kg]", ".4f", device="damper",
    ),
    _device_force("tendon", "T"),
    _device(
        "yield_m", "largest permanent elongation of a tendon", "tendon_yield", "m", "tendon yield [mm]", ".2f",
        1000, Limit(ceiling=_WIDER), device="tendon",
    ),
    _device("slack", "number of times tendons went slack", "tendon_slack", "1", "slack", ".0f", device="tendon", kind="count"),
    _device_force_in_kilonewtons("damper", "F"),
    _device_force_in_kilonewtons("tendon", "T"),
    _device_force("stop", "F"),
    _device(
        "deflection_m", "greatest deflection of a stop beyond its gap", "stop_depth", "m", "stop deflection [mm]", ".1f", 1000,
        *_LENGTHS, device="stop",
    ),
    _device("blows", "number of contacts with stops", "stop_blows", "1", "blows", ".0f", device="stop", kind="count"),
    _device(
        "energy_J_kg", "energy dissipated by all stops, per unit mass of the pier", "stop_energy", "J/kg",
        "stops [J/kg]", ".4f", device="stop",
    ),
    _device_force_in_kilonewtons("stop", "F"),
    _device_force("deck_spring", "F"),
    _device(
        "deflection_m", "greatest deflection of a deck spring beyond its gap", "deck_spring_depth", "m",
        "deck spring deflection [mm]", ".1f", 1000, *_LENGTHS, device="deck_spring",
    ),
    _device(
        "blows", "number of times gaps at the deck closed", "deck_spring_blows", "1", "closures", ".0f", device="deck_spring",
        kind="count",
    ),
    _device(
        "energy_J_kg", "energy dissipated by all deck springs, per unit mass of the pier", "deck_spring_energy",
        "J/kg", "deck springs [J/kg]", ".4f", device="deck_spring",
    ),
    _device_force_in_kilonewtons("deck_spring", "F"),
)  # fmt: skip
"""Quantities of devices."""


def _work(
    name: str, words: str, field: str, unit: str, head: str, form: str, factor: int = 1, *limits: Limit, device: str,
    more: str = "", kind: Literal["number", "count"] = "number", per: Callable[[Pier], float | None] = lambda pier: 1.0,
    behind: str = "",
) -> Quantity:  # fmt: skip
    """Return a quantity of a ``field`` of ``DeviceWork``, times ``per`` of the pier if that is known."""

    def value(run: Run) -> float | None:
        work = None if run.outcome.device_work is None else getattr(run.outcome.device_work, field)
        times = per(run.pier)
        return None if work is None or times is None else work * times

    weighed = unit == "kJ"
    quantity = _device(
        name, words, value, unit, head, form, factor, *limits, device=device, more=more, behind=behind, kind=kind,
        weighed=weighed,
    )  # fmt: skip
    return replace(quantity, needs="devices_work")


_WORK = (
    _work(
        "travel_m", "greatest cumulative travel of a damper", "damper_travel", "m", "damper travel [m]", ".3f", device="damper",
        more=", the sum of its way to and fro",
    ),
    _work(
        "work_J_kg", "greatest energy that one damper dissipates, per unit mass of the pier", "damper_work", "J/kg",
        "damper work [J/kg]", ".4f", device="damper",
    ),
    _work(
        "work_kJ", "greatest energy that one damper dissipates", "damper_work", "kJ", "damper work [kJ]", ".1f",
        device="damper", more=", if mass_t is given", per=lambda pier: pier.mass_t,
    ),
    _work(
        "half_cycles", "most half cycles of a damper", "damper_half_cycles", "1", "half cycles", ".0f", device="damper",
        more=", by rainflow counting, from [output] least_stroke_mm from end to end up, 10 mm unless given", kind="count",
    ),
    replace(
        _work(
            "strain_over_yield", "greatest strain of a tendon over its yield strain", "tendon_strain", "1", "tendon ε/ε_y",
            ".3f", device="tendon", more=", prestress and plastic strain included; of tendons that yield",
        ),
        device=YIELDING_TENDON,
    ),
)  # fmt: skip
"""Quantities of the work of devices."""

_PIVOT = "greatest force of {} support over half the weight"
_PIVOT_MORE = ", including its dashpot; of a rigid base, when it carries all of N"
_GAP, _GAP_MORE = (
    "heel gap: greatest height of {} pivot above its support",
    ", the stroke of a key or damper",
)
_SPEED = "greatest speed at which the heel gap opens or closes"

_FORCES = (
    *_over_mass(
        "base_shear", "greatest base shear V", "base_shear", "m/s^2", "V", more=", without the impulses of impacts", landing=True,
        bending=True,
    ),
    *_over_mass(
        "normal_force", "greatest normal force N of all supports", "normal_force", "m/s^2", "N", more=", likewise", landing=True,
    ),
    _force(
        "friction_demand", "greatest V over N at the same time", "friction_demand", "1", "V/N", ".4f", unbounded=True,
        limits=_SLIDES, more=", while N is above [output] least_normal_share of the weight, 0.1 unless given", landing=True,
        bending=True,
    ),
    _force(
        "pivot_force_left", _PIVOT.format("each"), "pivot_left", "1", "support L/(Mg/2)", ".3f", more=_PIVOT_MORE, landing=True,
    ),
    _force(
        "pivot_force_right", _PIVOT.format("each"), "pivot_right", "1", "support R/(Mg/2)", ".3f", more=_PIVOT_MORE,
        limits=_greater("pivot_force", _PIVOT), landing=True,
    ),
    _in_kilonewtons("pivot_force_left_kN", "pivot_left", "kN", "support L", _half_weight, Limit(), landing=True),
    _in_kilonewtons(
        "pivot_force_right_kN", "pivot_right", "kN", "support R", _half_weight,
        _greater("pivot_force/_kN", _PIVOT.removesuffix(" over half the weight"))[0], landing=True,
    ),
    _force("heel_gap_left_m", _GAP.format("each"), "heel_gap_left", "m", "heel gap L [mm]", ".1f", 1000, more=_GAP_MORE),
    _force(
        "heel_gap_right_m", _GAP.format("each"), "heel_gap_right", "m", "heel gap R [mm]", ".1f", 1000, more=_GAP_MORE,
        limits=_greater("heel_gap/_m", _GAP, *_LENGTHS),
    ),
    _force("heel_speed_left_m_s", _SPEED, "heel_speed_left", "m/s", "heel speed L [m/s]", ".3f"),
    _force(
        "heel_speed_right_m_s", _SPEED, "heel_speed_right", "m/s", "heel speed R [m/s]", ".3f",
        limits=_greater("heel_speed/_m_s", _SPEED),
    ),
    _force(
        "deck_acceleration_m_s2", "greatest absolute horizontal acceleration of the deck", "deck_acceleration", "m/s^2",
        "deck [m/s²]", ".3f", more=", or of the top without one", limits=(Limit(), Limit(unit="g", times=per_gravity)),
        landing=True, bending=True,
    ),
    _force(
        "landing_velocity_m_s", "speed of the landing pivot at the hardest impact", "landing_velocity", "m/s",
        "landing [m/s]", ".3f", sometimes=True, limits=(Limit(),),
    ),
    *_over_mass("impulse", "vertical impulse of the hardest impact", "impulse", "m/s", "impulse", sometimes=True),
    _force(
        "impact_friction_demand", "greatest horizontal over vertical impulse of an impact", "impact_friction_demand", "1",
        "V/N at impact", ".4f", sometimes=True, limits=_SLIDES,
    ),
    _force(
        "first_uplift_s", "time at which a pivot first leaves its support", "first_uplift", "s", "first uplift [s]", ".3f",
        sometimes=True,
    ),
    _force(
        "first_uplift_g", "magnitude of the horizontal ground acceleration then, over g", "uplift_ground",
        "standard_gravity", "ground then [g]", ".4f", per=lambda pier: 1.0 / pier.gravity, sometimes=True,
    ),
    _force("omega_max_over_p", "greatest angular velocity over p", "omega_over_p", "1", "θ̇_max/p", ".4f", limits=(Limit(),)),
    *_over_mass(
        "key_shear", "greatest base shear on shear keys", "key_shear", "m/s^2", "V of keys",
        more=": V while N is below that share, as in flight", sometimes=True, landing=True, bending=True,
    ),
    _force(
        "flight_longest_s", "duration of the longest flight", "flight_longest", "s",
        "longest flight [s]", ".3f", sometimes=True, limits=(Limit(),),
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
        landing=True,
    ),
)  # fmt: skip
"""Forces and motions for design, until the run ends or the pier leans beyond α for good."""


def _estimates_landings(study: Any) -> bool:
    return study.output.forces and any(
        "contact_stiffness_kN_m" in case.base.parameters(case.pier) for case in study.cases
    )


_LANDING_FORCE = replace(
    _force(
        "landing_force_kN",
        "greatest force of a foot at the hardest impact, by contact_stiffness_kN_m of the case",
        "landing_force",
        "kN",
        "landing foot [kN]",
        ".0f",
        per=lambda pier: pier.mass_t,
        sometimes=True,
        weighed=True,
        more=": an orientation, which was within 30 % of the force on springs in 84 % of random runs with less than 0.6 g of "
        "vertical motion and in 42 % of those with more; no check is made of it",
    ),
    requested=_estimates_landings,
)


_SLIDES_FACT = _fact(
    "slides", "the friction demand, of impacts too, is more than the interface has",
    ", as `friction` of the case; with [output] forces = true", _of_forces("slides"),
    requested=lambda study: study.output.forces and any(case.base.friction is not None for case in study.cases),
)  # fmt: skip


def _energy(term: str, form: str = ".4f") -> Quantity:
    """Return a term of the energy ledger."""

    def value(run: Run) -> float | None:
        return None if run.outcome.energies is None else run.outcome.energies[term]

    words = "energy ledger at the end, per unit mass, and the greatest remainder on the way"
    page = ReportFormat(f"{term.replace('_', '-')} [J/kg]", form)
    return Quantity(f"energy_{term}_J_kg", words, value, "J/kg", page, needs="ledger")


_ROCKING_ERROR = (
    "estimated error of rocking, and of lean, over α: the change when the step was halved; empty with a fixed step"
)


def _bends(study: Any) -> bool:
    return any(case.base.bends for case in study.cases)


_OF_BENDING = (
    Quantity(
        "deflection_max_m", "greatest deflection of the shaft's top, across the shaft", "deflection_max", "m",
        ReportFormat("deflection [mm]", ".1f", 1000, "drift_height_m"), bases=BENDING, error="deflection_error_m",
        limits=_LENGTHS, requested=_bends,
    ),
    Quantity(
        "deflection_error_m", "estimated error of it: the change when the step was halved; empty with a fixed step",
        "deflection_max_error", "m", ReportFormat("±", ".1g", 1000, "deflection_max_m"), bases=BENDING, stood=True,
        requested=_bends,
    ),
    Quantity(
        "top_drift_error_m", "likewise, of the drift of a shaft that bends", "top_drift_max_error", "m",
        bases=BENDING, stood=True, requested=_bends,
    ),
)  # fmt: skip

OPTIONAL = (
    Quantity(
        MIRROR_OF, 'with both polarities, "+" in the rows of "-": the run whose mirror image this is', kind="text",
        sometimes=True, requested=lambda study: len(study.motions.polarity) > 1,
    ),
    Quantity(
        OTHER_LAW,
        "settlement of Bouc–Wen springs by the elastic–perfectly plastic law, the other end of the range; with [output] "
        "both_laws = true, or with a check of a settlement",
        "settlement_other_law", "m", ReportFormat("by the other law [mm]", ".2f", 1000, "settlement_m"), bases=YIELDING,
        stood=True, sometimes=True, suite=OfSuite("Settlement by the other law [mm]", ".2f"),
        requested=lambda study: study.output.both_laws and any(case.base.ratchets for case in study.cases),
    ),
    Quantity(
        ROCKING,
        "greatest rotation over α about the current position of rest on the base",
        "theta_rocking", page=ReportFormat("rocking/α", ".5f", behind="theta_max_is"), over_alpha=True, needs="rocking",
        error="theta_rocking_error", limits=(_rotation("theta_rocking", ROCKING, "", ONE),),
    ),
    Quantity(
        "theta_lean_over_alpha", "rotation over α of that position at the time of the greatest rotation, positive to its side",
        "theta_lean", page=ReportFormat("lean/α", ".5f", behind=ROCKING), over_alpha=True, bases=YIELDING,
        stood=True, needs="rocking",
    ),
    *DEVICES,
    _energy("kinetic"), _energy("potential"), _energy("elastic"), _energy("input"), _energy("plastic"), _energy("impact"),
    _energy("p_delta"), _energy("constraint"), _energy("damping"), _energy("remainder", ".0e"),
    *_FORCES,
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
    Quantity(
        "devices_error",
        "largest relative error among the columns of devices, other than counts (relative to 1 % of the scale of small ones): "
        "the change when the step was halved; empty with a fixed step",
        "devices_error", page=ReportFormat("devices ±", ".0e", behind="deck_spring_energy_J_kg"), stood=True,
        requested=lambda study: any(case.base.restraints for case in study.cases),
    ),
    *_WORK,
    *_OF_BENDING,
    _LANDING_FORCE,
    _SLIDES_FACT,
    *OF_FOOTING,
)  # fmt: skip
"""Quantities at the end of a table, on request of the study."""

COLUMNS = {quantity.name: quantity for quantity in (*FIXED, *TRAILING, *OPTIONAL)}
"""All of them, by name, in the order of the file."""

TEXTS = tuple(quantity.name for quantity in COLUMNS.values() if quantity.kind == "text")
FACTS = tuple(quantity.name for quantity in COLUMNS.values() if quantity.kind == "fact")
COUNTS = tuple(quantity.name for quantity in COLUMNS.values() if quantity.kind in ("count", "fact"))
"""Columns of whole numbers."""
UNBOUNDED = tuple(quantity.name for quantity in COLUMNS.values() if quantity.unbounded)

_OTHERS = (
    event("flight", "both pivots off the ground", lambda runs: ~np.isnan(runs.numbers("flight_s")), "makes the pier fly"),
    event("overturned", "overturned", lambda runs: runs.texts("status") == "overturned", "overturns the pier"),
    event(
        "failed", "not run, or not settled", lambda runs: runs.texts("status") == "failed",
        "has a run that is missing or not settled",
    ),
    parameter(
        "eta", "bearing capacity index, a support's yield force over its static one", "", YIELDING,
        Ceiling(always(MOST_ETA), "is more than any foundation has"),
    ),
    parameter("yield_kN", "yield force of a support", "kN", YIELDING),
    parameter("stiffness_kN_m", "stiffness of a support", "kN/m", TWO_SPRINGS),
    parameter("safety_factor", "strength of a footing's bed over the pier's weight", "", FOOTING),
    parameter(
        "static_deflection_m", "deflection of the supports under the weight at rest, while elastic", "m", SPRINGS, _WIDER,
        "delta_s_m",
    ),
    in_section("section_shear_kN", "greatest shear in a section of the shaft, across its axis"),
    in_section("section_moment_kNm", "greatest moment in a section of the shaft"),
    in_section("section_axial_kN", "greatest compression of a section of the shaft", axial(1.0)),
    in_section("section_tension_kN", "greatest tension of a section of the shaft, 0 if it has none", axial(-1.0)),
)  # fmt: skip
"""Demands that are no column of peaks.csv: events, properties of the foundation, and those in sections of the shaft."""

DEMANDS: dict[str, Demand] = {
    demand.name: demand
    for demand in (*(demand for quantity in COLUMNS.values() for demand in quantity.demands()), *_OTHERS)
}
"""Demands by the name that a rule gives them; signs are dropped."""

DIRECTED = (
    "theta_max_over_alpha", "theta_max_rad", "theta_res_over_alpha", "theta_res_rad", "theta_rocking_over_alpha", "base_tilt_rad",
    "differential_settlement_m", "top_drift_m", "top_drift_mm", "heel_uplift_m", "heel_uplift_mm", "heel_gap_m", "heel_gap_mm",
    "heel_speed_m_s", "omega_max_over_p", "base_shear_m_s2", "base_shear_kN", "base_moment_m2_s2", "base_moment_kNm",
    "key_shear_m_s2", "key_shear_kN", "friction_demand", "deck_acceleration_m_s2", "deck_acceleration_g", "section_shear_kN",
    "section_moment_kNm", "deflection_max_m", "deflection_max_mm",
)  # fmt: skip
"""Demands that an axis of the pier has by itself, so that those of two axes add up. Of others, such as settlements, axial forces
and counts, which have the weight or the whole pier in them on either axis, the greater counts."""

BROUGHT = {
    key: [quantity.name for quantity in COLUMNS.values() if quantity.needs == key]
    for key in ("forces", "rocking", "devices_work")
}
"""By keys of [output], the columns that each brings."""


def names(table: Iterable[Quantity]) -> list[str]:
    """Return the names of quantities."""
    return [quantity.name for quantity in table]


def in_words(name: str, value: Any) -> str:
    """Return a value of a column as the report writes it, in the page's unit; empty if it has none."""
    page = COLUMNS[name].page
    if value is None or value != value or page is None:
        return ""
    return value if isinstance(value, str) else format(page.factor * float(value), page.form)


def report_columns(shown: str = "peaks") -> list[Quantity]:
    """Return the columns in the report's tables of ``shown``, in their order: beside each other what is read together."""
    order: list[str] = []
    for quantity in COLUMNS.values():
        if quantity.page and quantity.page.table == shown:
            place = order.index(quantity.page.behind) + 1 if quantity.page.behind else len(order)
            order.insert(place, quantity.name)
    return [COLUMNS[name] for name in order]


def as_markdown() -> str:
    """Return the table of docs/columns.md; columns with one meaning share a line."""
    lines = ["| column | unit | meaning | where |", "| --- | --- | --- | --- |"]
    for meaning, alike in groupby(COLUMNS.values(), key=lambda quantity: quantity.meaning):
        first, *further = alike
        unit = "" if first.kind == "text" or first.unit == "1" else first.unit
        lines.append(f"| {', '.join(names([first, *further]))} | {unit} | {meaning} | {first.applies} |")
    return "\n".join(lines) + "\n"


def listed() -> dict[str, list[str]]:
    """Return the names of all demands, grouped by what they depend on: the list in the example of checks."""

    def group(name: str) -> str:
        demand = DEMANDS[name]
        return (
            "yes or no, 1 or 0" if demand.event
            else "of the foundation, and not of a run" if demand.per_case
            else "in the section at the height at_m, with [output] sections" if demand.needs == "sections"
            else f"with [output] {demand.needs} = true" if demand.needs
            else f"of a {demand.device}" if demand.device
            else "of a shaft that bends" if demand.bases == BENDING
            else "of a footing" if demand.bases == FOOTING and not demand.per_case
            else "of every run"
        )  # fmt: skip

    return grouped(DEMANDS, group)
