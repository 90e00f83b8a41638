"""Omissions of a verdict: landings, modes, bending and tendons in forces (THEORY.md, Forces), what the model does not follow in
the runs, directions and verticals of records, the error estimate, and what a code asks of motions: independence, and a target
spectrum."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.pier.traits import FLIGHT_LIMIT_MM
from rockbatch.quantities.arrays import Rows, Values
from rockbatch.quantities.cases import (
    Case,
    bends,
    has_device,
    has_light_shaft,
    is_frame,
    lands_by_impulse,
    number_of_modes,
    stops_by_impulse,
)
from rockbatch.quantities.demands import Demand

MODES, POINTS = "modes", "modes at a point"
LANDINGS, LANDINGS_OF_FRAME = "landings", "landings of a frame"
LANDINGS_OF_BENDING = "landings under a bending shaft"
IMPULSES, BENDING, TENDONS = "impulses", "bending", "tendons"
KEYS, SHAKEDOWN, TAIL, YIELDS_ON = "keys", "shakedown", "tail", "yields on"
SLIDES, LINEARISED, FLIGHTS = "slides", "beyond_linearised", "flights"
ERRORS, TARGET = "errors", "target"
NAMED = DIRECTIONS, VERTICALS, EVENTS = ("directions", "verticals", "events")
"""Omissions about records, which a verdict's own remark names."""

HEIGHT = "flight_height_m"
"""Column of the height of flights, and the demand of the same name."""

STILL_ROCKS = "still_rocks"
"""Omission of demands of runs for which the column of the same name is 1: their later landings."""

FOLLOWED = (SLIDES, LINEARISED)
"""Omissions of every demand of runs for which the column of the same name is 1: they moved as the model does not follow."""

SHAKES_DOWN = 2.0
"""Safety factor of a footing above which its bed shakes down under cycles of constant rotation (THEORY.md, A footing)."""

AT_REST = 1e-6
"""Rate of settlement [m/s], where it is read, up to which springs no longer yield."""

FACTORS = "1.6 to 2.9"
"""Base shear by twenty finite elements over that of a rigid shaft, of twice the mass on its top (THEORY.md, Forces)."""


class Omission(NamedTuple):
    """Remark on an omission; ``decides`` is False if the demand without the omitted part has no upper bound."""

    remark: str
    decides: bool = True


_LANDINGS = "landings are left out, which on rigid ground are impulses without a force"

OMISSIONS = {
    MODES: Omission(
        "a force of a shaft that bends is not bounded without what its last mode changes, nor where that has more than a tenth "
        "of critical damping, whose force at a blow grows with every mode: leave flexural_modes, flexural_damping_kind and "
        "substeps out",
        decides=False,
    ),
    POINTS: Omission(
        "the acceleration of a point of a shaft that bends on dashpots may grow with every mode by more than its error states: "
        "take it from a program with finite elements",
        decides=False,
    ),
    LANDINGS: Omission(
        f'{_LANDINGS}: give the feet a stiffness K, base = "elastic" with zeta, and check K/2, K and 2 K', decides=False
    ),
    LANDINGS_OF_BENDING: Omission(
        f'{_LANDINGS}: give the feet a stiffness K, base = "elastic" with zeta and kinematics = "finite", and check K/2, K '
        "and 2 K",
        decides=False,
    ),
    LANDINGS_OF_FRAME: Omission(
        f"{_LANDINGS}: take them from a program with springs under the columns, which a frame cannot have here",
        decides=False,
    ),
    STILL_ROCKS: Omission(
        "a lower bound: runs end so soon after the greatest rotation that the pier may land harder later: give quiet_s = 40/p "
        "under [numerics], with the least p in rad/s that the report states",
        decides=False,
    ),
    IMPULSES: Omission(
        "the part of each landing on springs that epsilon or Housner's factor stops by an impulse, which has no force, is left "
        "out: give zeta in place of epsilon and impact",
        decides=False,
    ),
    BENDING: Omission(
        f"bending of the shaft is left out, with which a heavy one had {FACTORS} times its rigid base shear by finite elements"
    ),
    TENDONS: Omission("the force of a tendon that is anchored above the section is left out"),
    KEYS: Omission(
        "moments with a normal force below [output] least_normal_share of the weight are left out, in which keys carry the "
        "shear: check key_shear_kN, too"
    ),
    SHAKEDOWN: Omission(
        f"a lower bound: above a safety factor of {SHAKES_DOWN:g} the bed settles no further in cycles of constant rotation, "
        "in which ground does"
    ),
    TAIL: Omission(
        "a lower bound: it is counted until the run ends, when its peak is decided, and a pier that still rocks adds to it: "
        "give a longer quiet_s"
    ),
    YIELDS_ON: Omission(
        "a lower bound: springs of the case go on yielding when the run is read, as settlement_drift_m_s says: "
        'those with spring = "epp" and zeta come to rest'
    ),
    SLIDES: Omission("runs would slide by the friction of the case, which is not followed"),
    FLIGHTS: Omission(
        f"runs fly higher than flight_limit_mm ({FLIGHT_LIMIT_MM:g} unless given), to which keys are taken to guide the pier"
    ),
    LINEARISED: Omission('runs rotate too far for linearised kinematics: run kinematics = "finite"'),
    DIRECTIONS: Omission("not every direction counts, and the worst may be another"),
    VERTICALS: Omission("not every motion has a vertical component"),
    EVENTS: Omission("stations of one earthquake count as independent motions, unless per_event limits their number"),
    TARGET: Omission("the motions are not judged by a target spectrum of its code"),
    ERRORS: Omission("no error estimate"),
}
"""Omissions by the names that checks.csv has for them, the gravest first."""


def open_landings(demand: Demand, runs: Rows, case: Case) -> npt.NDArray[np.bool_]:
    """Return True for each run of which landings by impulse are missing in the demand, shape (n,): a lower bound.

    A run without impacts misses none, one with an unknown number (NaN) some. False throughout for demands without landings, on
    bases that stop no part of a landing by an impulse, and where the modes of a bending shaft take up the blow.
    """
    by_impulse = lands_by_impulse(case) or stops_by_impulse(case)
    if not (demand.landing and by_impulse) or _follows_modes(demand, case):
        return np.zeros(len(runs), dtype=bool)
    return runs.numbers("impacts") != 0.0


def open_ends(demand: Demand, runs: Rows, case: Case) -> npt.NDArray[np.bool_]:
    """Return True for each run that ends before landings that may raise the demand, shape (n,): a lower bound."""
    return runs.facts(STILL_ROCKS) & demand.grows_with_landings(case)


def unconverged(demand: Demand, error: Values, case: Case) -> npt.NDArray[np.bool_]:
    """Return True for each run with no estimate of what the modes left out of a bending shaft add to the demand, shape (n,).

    That is: one mode alone, an ``error`` of NaN (that of the demand has the part of the last mode), or the acceleration of a
    point. False throughout for a rigid shaft, and for a demand that landings or bending do not affect.
    """
    alone = number_of_modes(case) == 1
    return (np.isnan(error) | alone | _at_a_point(demand, case)) & _follows_modes(demand, case)


def _at_a_point(demand: Demand, case: Case) -> bool:
    """Return whether the demand is an acceleration of a point of a bending shaft on dashpots, which modes give slowly."""
    return demand.pointwise and bends(case) and not lands_by_impulse(case)


def _follows_modes(demand: Demand, case: Case) -> bool:
    """Return whether the modes of a bending shaft take up the blow of a landing: the demand has landings and bending in it.

    The shaft does not give along its axis, so that what stands on end of it, N and the feet's forces, is an impulse as ever.
    """
    return demand.landing and demand.bending and bends(case)


def omissions(demand: Demand, runs: Rows, error: Values, case: Case) -> list[str]:
    """Return the names in :data:`OMISSIONS` of what the demand, of this ``error``, omits in runs of a case; [] for none."""
    if not demand.of_motion:
        return []
    omitted = [name for name in FOLLOWED if runs.facts(name).any()]
    high = 1000.0 * runs.numbers(HEIGHT) > case["parameters"].get("flight_limit_mm", math.inf)
    if high.any() and demand.name != HEIGHT:  # its own limit says how high keys guide the pier
        omitted.append(FLIGHTS)
    if demand.event:
        return omitted
    if demand.in_section and has_device(case, "tendon"):
        omitted.append(TENDONS)
    if demand.while_pressed and (runs.numbers("key_shear_m_s2") > 0.0).any():
        omitted.append(KEYS)
    if demand.settlement and (case["parameters"].get("safety_factor") or 0.0) > SHAKES_DOWN:
        omitted.append(SHAKEDOWN)
    if demand.cumulative:
        omitted.append(TAIL)
    if demand.yielding and (np.abs(runs.numbers("settlement_drift_m_s")) > AT_REST).any():
        omitted.append(YIELDS_ON)
    if open_ends(demand, runs, case).any():
        omitted.append(STILL_ROCKS)
    return [*_of_blows(demand, runs, error, case), *omitted]


def _of_blows(demand: Demand, runs: Rows, error: Values, case: Case) -> list[str]:
    """Return the names of what a force omits of landings, modes and bending.

    A demand that follows the modes of a bending shaft omits no more than the further modes, or those at a point.
    """
    if _follows_modes(demand, case):
        if _at_a_point(demand, case):
            return [POINTS]
        return [MODES] if unconverged(demand, error, case).any() else []
    omitted = []
    if open_landings(demand, runs, case).any():
        omitted.append(_landings_of(case))
    if demand.bending and not bends(case) and not has_light_shaft(case):
        omitted.append(BENDING)
    return omitted


def _landings_of(case: Case) -> str:
    """Return the name of the omission of landings by impulse, whose remedy depends on the case."""
    if stops_by_impulse(case):
        return IMPULSES
    return LANDINGS_OF_FRAME if is_frame(case) else LANDINGS_OF_BENDING if bends(case) else LANDINGS
