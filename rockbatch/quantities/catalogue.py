"""The catalogue: all quantities of a run, a row each, and all that a check may ask of them.

The file peaks.csv with its types and units, the report's tables and tooltips, the comparison of two studies, the demands of
checks, docs/columns.md and the list in configs/checks/stepping_pier.toml follow from it. A new quantity is a row at the end of
:data:`TRAILING`, or of :data:`OPTIONAL`, and a number in ``Outcome`` for it.
"""

from collections.abc import Iterable
from itertools import chain, groupby
from typing import Any

import numpy as np

from rockbatch.common.grouping import grouped
from rockbatch.common.observers import parts
from rockbatch.pier import MOST_ETA
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.bed import OF_FOOTING
from rockbatch.quantities.cases import (
    LANDS,
    ONE,
    RESTS_TILTED,
    THOUSAND,
    YIELDS,
    Case,
    Lever,
    alpha,
    always,
    backbone,
    bends,
    capacity_index,
    product,
    static_settlement,
    top,
    width,
)
from rockbatch.quantities.demands import (
    AT_HEIGHTS,
    Ceiling,
    Demand,
    Estimated,
    Evaluate,
    event,
    in_flight,
    largest,
    parameter,
    tilt,
    toe_settlement,
)
from rockbatch.quantities.design import BOUND
from rockbatch.quantities.devices import DEVICES
from rockbatch.quantities.limits import IN_MOTION, IN_MOTION_ERROR, LENGTHS, OVERTURNS, WIDER, greater, rotation
from rockbatch.quantities.quantity import (
    BENDING,
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
    fact,
)

MIRROR_OF = "mirror_of"
"""Column of the polarity of the run whose mirror image a row is; only where a study has both polarities."""

MOST_DUCTILITY = 100.0
"""Greatest over yield deflection of a support, or over the last one of its backbone: soils bear some 2 to 10."""


def _most_ductility(case: Case) -> float:
    points = backbone(case)
    return MOST_DUCTILITY * (points[-1][0] if points else 1.0)


_SPENT = Ceiling(_most_ductility, "is more than any support carries")


_DRIFT_RATIO = rotation("theta_max", "drift_ratio", "1", alpha, "greatest drift over the height at which it is read")


def _displacements(name: str, lever: Lever) -> tuple[Limit, Limit]:
    """Return limits on the greatest rotation times a length, in m and in mm; ``name`` gets the unit at its end."""
    in_metres, in_millimetres = product(lever, alpha), product(product(THOUSAND, lever), alpha)
    return rotation("theta_max", f"{name}_m", "m", in_metres), rotation("theta_max", f"{name}_mm", "mm", in_millimetres)


def _top_drift(run: Run) -> float:
    """Return the greatest drift [m], by the rotation of a rigid shaft, or as recorded for one that bends."""
    bent = run.outcome.top_drift_max
    return run.pier.top * run.outcome.theta_max if bent is None else bent


def _bent_as_well(limit: Limit) -> Limit:
    """Return a limit on drift, or its ratio, that of a shaft that bends takes the recorded drift in place of the rotation's."""
    times = {"m": ONE, "mm": THOUSAND, "1": lambda case: 1.0 / top(case)}[limit.unit]
    bent = largest(("top_drift_m",), times, "top_drift_error_m")

    def bent_or(rigid: Evaluate | None) -> Evaluate | None:
        if rigid is None:
            return None
        return lambda runs, case: bent(runs, case) if bends(case) else rigid(runs, case)

    evaluate, reached = bent_or(limit.evaluate), bent_or(limit.reached)
    return limit._replace(evaluate=evaluate, reached=reached, words=limit.words or "greatest drift", height=top)


def _settlement(runs: Rows, case: Case) -> Estimated:
    """Return the mean settlement of the supports [m] and its error."""
    return Estimated(runs.numbers("settlement_m"), runs.numbers("settlement_error_m"))


_OTHER_ENDS = {name: end for ends in parts("quantities.OTHER_ENDS") for name, end in ends.items()}
_SETTLEMENTS = (
    Limit(ceiling=WIDER, evaluate=_settlement, other_end=_OTHER_ENDS.get("settlement_m")),
    Limit(
        "toe_settlement_m",
        ceiling=WIDER,
        words="settlement of the support that settles more",
        evaluate=toe_settlement,
        other_end=_OTHER_ENDS.get("toe_settlement_m"),
    ),
)
_TILTS = (
    Limit(ceiling=Ceiling(alpha, OVERTURNS), evaluate=tilt(ONE)),
    Limit(
        "differential_settlement_m",
        "m",
        ceiling=Ceiling(product(width, alpha), OVERTURNS),
        words="settlement of one support against the other",
        evaluate=tilt(width),
    ),
)

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
        directed=True, suite=OfSuite("Largest rotation θ_max/α", ".4f"),
        error="theta_max_error",
        limits=(
            rotation("theta_max", "theta_max_over_alpha", "", ONE),
            rotation("theta_max", "theta_max_rad", "rad", alpha, "greatest rotation"),
        ),
    ),
    Quantity(
        "theta_max_error",
        "estimated error of the greatest rotation over α: its change when the step was halved, or under a motion 10⁻⁸ stronger "
        "or weaker; empty if it is chaotic, and with a fixed step",
        "theta_max_error", page=ReportFormat("±", ".5f"), over_alpha=True, stood=True,
    ),
    Quantity("t_max_s", "time of the greatest rotation", "t_max", "s", ReportFormat("at t", ".2f")),
    Quantity(
        "theta_res_over_alpha", "residual rotation over α", "theta_res", more=", at rest on the deformed base",
        page=ReportFormat("θ_res/α", ".5f"), over_alpha=True, bases=TILTS, stood=True, directed=True,
        suite=OfSuite("Residual rotation |θ_res|/α", ".5f"), error="theta_res_error", condition=RESTS_TILTED,
        limits=(
            rotation("theta_res", "theta_res_over_alpha", "", ONE),
            rotation("theta_res", "theta_res_rad", "rad", alpha, "residual rotation"),
        ),
    ),
    Quantity(
        "settlement_m", "mean settlement of the supports", "settlement", "m",
        ReportFormat("settlement", ".2f", 1000), " since the start", bases=SPRINGS, stood=True,
        suite=OfSuite("Settlement", ".2f"), error="settlement_error_m", limits=_SETTLEMENTS,
        settlement=True, yielding=True, condition=YIELDS,
    ),
    Quantity("impacts", "number of impacts", "impacts", kind="count", limits=(Limit(),), condition=LANDS, cumulative=True),
    Quantity(
        "separations", "number of separations", "separations", kind="count", limits=(Limit(),), cumulative=True,
        more=", on rigid ground of lift-offs from rest; one in the instant of an impact has no event of its own",
    ),
    Quantity(
        "flight_s", "time at which both pivots first left the ground, also if the run continued", "t_flight",
        "s", sometimes=True,
    ),
    Quantity("substeps", "integration steps per sample", "substeps", kind="count"),
)  # fmt: skip
"""Quantities that every table has, in its order, before the keys that the study varies."""

_CHANGED = "a motion 10⁻⁸ stronger or weaker"
_KNOWN = "; empty with a fixed step, and of a run that failed"


_DUCTILITY = "greatest deflection of {} support over its yield deflection, of a backbone that at its first corner"
_DISSIPATED = "plastic work of each support, per unit mass"

TRAILING = (
    Quantity(
        "theta_res_error",
        "estimated error of the residual rotation over α, including its drift between readings, its further change as "
        "dampers slip and what a bed yields after the run; empty if it is chaotic, and with a fixed step",
        "theta_res_error", over_alpha=True, bases=TILTS,
        stood=True,
    ),
    Quantity("t_end_s", "end of the run", "t_end", "s"),
    Quantity(
        "base_tilt_rad", "residual tilt of the base", "base_tilt", "rad",
        ReportFormat("base tilt", ".3f", 1000, "theta_res_over_alpha"), bases=SPRINGS, stood=True,
        limits=_TILTS, directed=True, condition=YIELDS,
    ),
    Quantity(
        "ductility_left", _DUCTILITY.format("each"), "ductility_left",
        page=ReportFormat("ductility L", ".2f", behind="settlement_m"), bases=YIELDING,
    ),
    Quantity(
        "ductility_right", _DUCTILITY.format("each"), "ductility_right",
        page=ReportFormat("ductility R", ".2f", behind="ductility_left"),
        bases=YIELDING, limits=greater("ductility", _DUCTILITY, Limit(ceiling=_SPENT)), yielding=True,
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
        _top_drift, "m", ReportFormat("drift", ".1f", 1000, "t_max_s"),
        ": that height times the greatest rotation; of a shaft that bends its greatest horizontal way",
        limits=tuple(map(_bent_as_well, (*_displacements("top_drift", top), _DRIFT_RATIO))), directed=True,
        later=bends,
    ),
    Quantity(
        "heel_uplift_m", "greatest rise of the heel above the toe",
        lambda run: 2.0 * run.pier.half_width * run.outcome.theta_max, "m",
        ReportFormat("heel uplift", ".1f", 1000, "top_drift_m"),
        ": the width between the pivots times the greatest rotation", limits=_displacements("heel_uplift", width),
        directed=True,
    ),
    Quantity(
        "pga_g", "peak horizontal acceleration of the scaled motion, over g",
        lambda run: run.pga / run.pier.gravity, "standard_gravity", ReportFormat("PGA", ".3f", behind="scale"),
    ),
    Quantity(
        "flights", "number of flights, with both pivots off the ground", "flights",
        kind="count", more="; includes a flight that ended the run",
        limits=(Limit(evaluate=in_flight("flights")),), cumulative=True,
    ),
    Quantity(
        "flight_duration_s", "time with both pivots in the air",
        lambda run: run.outcome.flight_duration or None, "s",
        more=", in all flights together", sometimes=True, cumulative=True,
        limits=(Limit(evaluate=in_flight("flight_duration_s")),),
    ),
    Quantity(
        "flight_height_m", "greatest height of the lower pivot above the ground",
        lambda run: run.outcome.flight_height or None, "m",
        ReportFormat("flight height", ".2f", 1000, "ductility_right"),
        ", or above its support, in these flights", sometimes=True,
        limits=(Limit(evaluate=in_flight("flight_height_m"), ceiling=WIDER),),
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
        "estimated error of the settlement, including its drift between readings and what a bed yields after the run; empty if "
        "it is chaotic, and with a fixed step",
        "settlement_error", "m", bases=SETTLING, stood=True, sometimes=True,
    ),
    Quantity(
        "drift_height_m", "height above the pivots at which drift is read", lambda run: run.pier.top, "m",
        ReportFormat("drift at", ".6g", behind="top_drift_m"), ": `top_m` of the pier, or its highest point",
    ),
    Quantity(
        "failure",
        "kind of failure of a run: contacts, blew up, undecided, ratchets, not settled, large step, many steps; of a record: "
        "unusable; see reason",
        lambda run: run.outcome.failure.value if run.outcome.failure else "", kind="text", sometimes=True,
    ),
    fact("chaotic", f"{_CHANGED}, or another step, changes the peak or the residuals beyond the tolerance", _KNOWN),
    fact("may_overturn", f"{_CHANGED} overturns the pier, and this one does not", _KNOWN),
    fact(
        "beyond_linearised", "the rotations are too large for linearised kinematics",
        '; empty with kinematics = "finite"',
    ),
    fact(
        "still_rocks", "the run ends so soon after the greatest rotation that the pier may land harder later",
        "; forces, counts and demands of devices are then lower bounds, which a longer `quiet_s` may raise",
    ),
)  # fmt: skip
"""Quantities that every table has behind the varied keys. A table of an earlier version may lack the last of them."""


def _of_observers(group: str) -> list[Quantity]:
    """Return the quantities that all observers list under ``group``, a place in the table such as "FIRST"; [] for none."""
    return [quantity for quantities in parts(f"quantities.{group}") for quantity in quantities]


def _bends(study: Any) -> bool:
    """Return whether a case of the study has a shaft that bends."""
    return any(case.base.bends for case in study.cases)


def _both_polarities(study: Any) -> bool:
    return len(study.motions.polarity) > 1


def _has_devices(study: Any) -> bool:
    return any(case.base.restraints for case in study.cases)


_MIRROR = Quantity(
    MIRROR_OF,
    'with both polarities, "+" in the rows of "-": the run whose mirror image this is',
    kind="text",
    sometimes=True,
    requested=_both_polarities,
)
_DEVICES_ERROR = Quantity(
    "devices_error",
    "largest relative error among the columns of devices, other than counts (relative to 1 % of the scale of small ones): "
    "four times the change when the step was halved; empty with a fixed step",
    "devices_error",
    page=ReportFormat("devices ±", ".0e", behind="deck_spring_energy_J_kg"),
    stood=True,
    requested=_has_devices,
)
_OF_BENDING = (
    Quantity(
        "deflection_max_m",
        "greatest deflection of the shaft's top, across the shaft",
        "deflection_max",
        "m",
        ReportFormat("deflection", ".1f", 1000, "drift_height_m"),
        bases=BENDING,
        error="deflection_error_m",
        limits=LENGTHS,
        requested=_bends,
        directed=True,
        later=bends,
    ),
    Quantity(
        "deflection_error_m",
        "estimated error of it: the change when the step was halved, and four times that by a mode fewer; empty with a "
        "fixed step",
        "deflection_max_error",
        "m",
        ReportFormat("±", ".1g", 1000, "deflection_max_m"),
        bases=BENDING,
        stood=True,
        requested=_bends,
    ),
    Quantity(
        "top_drift_error_m",
        "likewise, of the drift of a shaft that bends",
        "top_drift_max_error",
        "m",
        bases=BENDING,
        stood=True,
        requested=_bends,
    ),
)

OPTIONAL = (
    _MIRROR,
    *_of_observers("FIRST"),
    *DEVICES,
    *_of_observers("QUANTITIES"),
    *_of_observers("ERRORS"),
    _DEVICES_ERROR,
    *_of_observers("FURTHER"),
    *_OF_BENDING,
    *_of_observers("LAST"),
    *OF_FOOTING,
)
"""Quantities at the end of a table, on request of the study, in the order in which they came to it."""

COLUMNS = {quantity.name: quantity for quantity in (*FIXED, *TRAILING, *OPTIONAL)}
"""All quantities by name, in the order of the file."""

TEXTS = (*(quantity.name for quantity in COLUMNS.values() if quantity.kind == "text"), BOUND)
FACTS = tuple(quantity.name for quantity in COLUMNS.values() if quantity.kind == "fact")
COUNTS = tuple(quantity.name for quantity in COLUMNS.values() if quantity.kind in ("count", "fact"))
"""Columns of whole numbers."""
UNBOUNDED = tuple(quantity.name for quantity in COLUMNS.values() if quantity.unbounded)

_OTHERS = (
    event(
        "flight", "both pivots off the ground", lambda runs: ~np.isnan(runs.numbers("flight_s")), "makes the pier fly"
    ),
    event("overturned", "overturned", lambda runs: runs.texts("status") == "overturned", "overturns the pier"),
    event(
        "failed",
        "not run, or not settled",
        lambda runs: runs.texts("status") == "failed",
        "has a run that is missing or not settled",
    ),
    parameter(
        "eta",
        "bearing capacity index, a support's yield force, or the greatest of its backbone, over its static one",
        "",
        YIELDING,
        Ceiling(always(MOST_ETA), "is more than any foundation has"),
        capacity_index,
    ),
    parameter("yield_kN", "yield force of a support, of a backbone that at its first corner", "kN", YIELDING),
    parameter("stiffness_kN_m", "stiffness of a support", "kN/m", TWO_SPRINGS),
    parameter("safety_factor", "strength of a footing's bed over the pier's weight", "", FOOTING, condition=YIELDS),
    parameter(
        "static_deflection_m",
        "deflection of the supports under the weight at rest, elastic or along a backbone",
        "m",
        SPRINGS,
        WIDER,
        static_settlement,
    ),
)
"""Demands that are no column of peaks.csv: events, and properties of the foundation."""

_OF_COLUMNS = chain.from_iterable(quantity.demands() for quantity in COLUMNS.values())
_OF_PARTS = chain.from_iterable(parts("quantities.DEMANDS"))
DEMANDS: dict[str, Demand] = {demand.name: demand for demand in chain(_OF_COLUMNS, _OTHERS, _OF_PARTS)}
"""Demands by the name that a rule gives them; signs are dropped."""

BROUGHT = {
    key: [quantity.name for quantity in COLUMNS.values() if quantity.needs == key]
    for key in dict.fromkeys(quantity.needs for quantity in COLUMNS.values() if quantity.needs and quantity.limits)
}
"""Columns that each key of [output] adds."""


def names(table: Iterable[Quantity]) -> list[str]:
    """Return the names of quantities."""
    return [quantity.name for quantity in table]


def in_words(name: str, value: Any) -> str:
    """Return a value of a column as text, in the report's unit and format; empty for None, NaN, or a column without one."""
    page = COLUMNS[name].page
    if value is None or value != value or page is None:
        return ""
    return value if isinstance(value, str) else format(page.factor * float(value), page.form)


def report_columns(shown: str = "peaks") -> list[Quantity]:
    """Return the columns of the report's tables of peaks or forces (``shown``), each behind the column that it belongs to."""
    order: list[str] = []
    for quantity in COLUMNS.values():
        if quantity.page and quantity.page.table == shown:
            place = order.index(quantity.page.behind) + 1 if quantity.page.behind else len(order)
            order.insert(place, quantity.name)
    return [COLUMNS[name] for name in order]


def as_markdown() -> str:
    """Return the table of docs/columns.md; neighbouring columns with the same meaning share a line."""
    lines = ["| column | unit | meaning | where |", "| --- | --- | --- | --- |"]
    for meaning, alike in groupby(COLUMNS.values(), key=lambda quantity: quantity.meaning):
        first, *further = alike
        unit = "" if first.kind == "text" or first.unit == "1" else first.unit
        lines.append(f"| {', '.join(names([first, *further]))} | {unit} | {meaning} | {first.applies} |")
    return "\n".join(lines) + "\n"


def listed() -> dict[str, list[str]]:
    """Return the names of all demands by the heading of what they depend on: {"of every run": ["theta_max_over_alpha", …], …}."""
    return grouped(DEMANDS, _dependence)


def _dependence(name: str) -> str:
    """Return the heading of a demand in the list: the key of [output], device or base on which it depends, or its kind.

    The first that applies: events, properties of the case, section, [output], device, footing, bending; else "of every run".
    """
    demand = DEMANDS[name]
    if demand.event:
        return "yes or no, 1 or 0"
    if demand.per_case:
        return "of the foundation, and not of a run"
    if demand.in_section:
        return f"in the section at the height at_m, with [output] {AT_HEIGHTS[demand.needs]}"
    if demand.needs:
        return f"with [output] {demand.needs} = true"
    if demand.device:
        return f"of a {demand.device}"
    if demand.bases == FOOTING:
        return "of a footing"
    return "of a shaft that bends" if demand.bases == BENDING else "of every run"
