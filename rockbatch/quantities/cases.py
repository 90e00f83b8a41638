"""A case of run.json, and the values of it that demands take: lengths, weight, devices, parameters."""

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

from rockbatch.pier.backbones import Points, greatest
from rockbatch.pier.bases import IMPULSIVE
from rockbatch.pier.block import share_of_shaft
from rockbatch.pier.first_loading import Polyline
from rockbatch.pier.laws import RATCHETING
from rockbatch.pier.restraints import YIELDING_TENDON, kinds_of
from rockbatch.pier.traits import ASKING_TENSION

Case = Mapping[str, Any]
"""``case``, ``columns``, ``pier``, ``base``, ``parameters``, and ``across_of`` of one across the axis of another."""

Lever = Callable[[Case], float]
"""Factor of a case, such as a length by which a rotation becomes a displacement."""


class Condition(NamedTuple):
    """What a case must have for a quantity to be anything but 0 in its model, and the words for its lack."""

    holds: Callable[[Case], bool]
    lack: str


def is_across(case: Case) -> bool:
    """Return whether a case is the one across the axis of its pier."""
    return bool(case.get("across_of"))


def name_along(case: Case) -> str:
    """Return the name of the case along the axis of the same pier, which is its own unless it is across the axis."""
    return str(case.get("across_of") or case["case"])


def names_along(cases: Iterable[Case]) -> list[str]:
    """Return the names of cases along the axis of their pier, each once, in order."""
    return list(dict.fromkeys(str(case["case"]) for case in cases if not is_across(case)))


def names_across(cases: Iterable[Case]) -> set[str]:
    """Return the names of cases across the axis of their pier."""
    return {str(case["case"]) for case in cases if is_across(case)}


def of_pier(case: Case) -> tuple[object, ...]:
    """Return a key that the cases of both axes of a pier share: the name of the case along the axis, and (key, value) pairs."""
    return name_along(case), *case["columns"].items()


def always(value: float) -> Lever:
    """Return a function that returns ``value`` for every case."""
    return lambda case: value


ONE, THOUSAND = always(1.0), always(1000.0)


def product(first: Lever, second: Lever) -> Lever:
    """Return a function that returns the product of two factors of a case."""
    return lambda case: first(case) * second(case)


def alpha(case: Case) -> float:
    """Return α [rad]."""
    return float(case["pier"]["alpha"])


def width(case: Case) -> float:
    """Return the width between the pivots [m]."""
    return 2.0 * float(case["pier"]["half_width_m"])


def top(case: Case) -> float:
    """Return the height at which drift is read [m], by default twice that of the centre of mass."""
    pier = case["pier"]
    return float(pier.get("top_m", 2.0 * pier["height_m"]))


def weight(case: Case) -> float:
    """Return the weight of the pier [kN]; its mass must be known."""
    return float(case["pier"]["mass_t"]) * float(case["pier"]["gravity"])


def bearing(case: Case) -> float:
    """Return the bearing strength of a footing [MPa]; infinite of a bed that does not yield, or with a mass that is not known."""
    factor, length = (case["parameters"].get(name) for name in ("safety_factor", "length_m"))
    known = factor is not None and length is not None and "mass_t" in case["pier"]
    return 1e-3 * factor * weight(case) / (width(case) * length) if known else math.inf


def per_gravity(case: Case) -> float:
    """Return 1/g [s²/m]."""
    return 1.0 / float(case["pier"]["gravity"])


def backbone(case: Case) -> Points:
    """Return the points (δ/δ_y, F/F_y) of the supports' backbone; () without one."""
    return tuple((x, force) for x, force in case["parameters"].get("backbone", ()))


def capacity_index(case: Case) -> float:
    """Return a support's greatest force over its static one, η without a backbone; infinite if that has no greatest force.

    NaN for supports that do not yield.
    """
    points = backbone(case)
    return float(case["parameters"].get("eta", math.nan)) * (greatest(points) if points else 1.0)


def static_settlement(case: Case) -> float:
    """Return the deflection of the supports under the weight at rest [m]: elastic, or along their backbone; NaN without any."""
    parameters, points = case["parameters"], backbone(case)
    if not points:
        return float(parameters.get("delta_s_m", math.nan))
    return float(parameters["delta_y_m"]) * Polyline(points).deflection(1.0 / float(parameters["eta"]))


def creeps(case: Case) -> bool:
    """Return whether the springs of a case have a law of RATCHETING, by which they settle further in each cycle.

    Their settlement then depends on the law. False for other laws, elastic springs and footings.
    """
    return case["parameters"].get("spring") in RATCHETING


def asks_tension(case: Case) -> bool:
    """Return whether the impacts of a case need a support to pull."""
    return case["parameters"].get("impact") in ASKING_TENSION


def has_device(case: Case, device: str) -> bool:
    """Return whether the pier has a device of this kind, such as "damper" or "yielding tendon"."""
    return any(device in kinds_of(restraint) for restraint in devices(case))


def holds_a_tilt(case: Case) -> bool:
    """Return whether a friction or hysteretic damper, whose f is not 0, keeps a force at rest, and so may hold a tilt."""
    holding = ("friction", "hysteretic")
    return any(damper.get("kind") in holding and damper.get("f") != 0.0 for damper in devices(case))


def devices(case: Case) -> Iterable[Mapping[str, Any]]:
    """Return the devices of a case, as run.json has them; none without parameters."""
    return case["parameters"].get("restraints", ()) if "parameters" in case else ()


def bends(case: Case) -> bool:
    """Return whether the shaft of a case bends."""
    return bool(case.get("parameters", {}).get("shaft") == "elastic")


def number_of_modes(case: Case) -> int:
    """Return the number of modes in which the shaft of a case bends; 0 if it is rigid, 1 if run.json does not say."""
    return int(case["parameters"].get("flexural_modes", 1)) if bends(case) else 0


LIGHT_SHAFT = 1.0 / 6.0
"""Share of the mass below which a shaft is light: it has less than a fifth of the mass that it carries."""


def has_light_shaft(case: Case) -> bool:
    """Return whether the shaft of a case has less than a sixth of the mass, by its parts, or by its shape without these."""
    pier = case["pier"]
    share = pier.get("shaft_share")
    if share is None:  # a pier without parts: its shape gives it
        share = share_of_shaft(pier["alpha"], pier["mu"], pier.get("deck_over_columns"))
    return float(share) < LIGHT_SHAFT


def lands_by_impulse(case: Case) -> bool:
    """Return whether each landing is an impulse, without a force, as on rigid ground."""
    return case["base"] in IMPULSIVE


def gives_way(case: Case) -> bool:
    """Return whether the ground of a case gives way, so that a gap has the vertical motion of the pier in it, too."""
    return not lands_by_impulse(case)


def stops_by_impulse(case: Case) -> bool:
    """Return whether an impulse takes part of the speed of every landing on springs: by ε < 1, or by Housner's factor."""
    return asks_tension(case) or float(case["parameters"].get("epsilon", 1.0)) < 1.0


def supports_yield(case: Case) -> bool:
    """Return whether the supports of a case yield: yielding springs, or a footing on a bed with a strength."""
    return case["base"] == "yielding" or case["parameters"].get("safety_factor") is not None


def may_rest_tilted(case: Case) -> bool:
    """Return whether a pier may stay at a tilt: on supports that yield, by dampers that hold it, or by tendons."""
    return supports_yield(case) or holds_a_tilt(case) or has_device(case, "tendon")


YIELDS = Condition(supports_yield, "the supports of the case do not yield")
RESTS_TILTED = Condition(may_rest_tilted, "nothing in the case keeps the pier at a tilt")
TENDON_YIELDS = Condition(lambda case: has_device(case, YIELDING_TENDON), f"the pier has no {YIELDING_TENDON}")
LANDS = Condition(lambda case: case["base"] != "footing", "on a bed of strips a landing is a force, and no impact")
LANDS_BY_IMPULSE = Condition(
    lambda case: lands_by_impulse(case) or stops_by_impulse(case), "a landing is a force in this case, and no impulse"
)


def is_frame(case: Case) -> bool:
    """Return whether a case is a rocking frame, which stands on rigid ground only."""
    return "deck_over_columns" in case["pier"]
