"""Forces along a recorded run, and design demands: peaks, the hardest impact, uplift."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from rockbatch.common.lazy import pd
from rockbatch.core import types
from rockbatch.core.observe.forces import FORCES, Forces
from rockbatch.core.observe.peaks import NEVER, Noted
from rockbatch.motions.motion import Samples
from rockbatch.outcome.changes import LEAST, Sized, greatest_change
from rockbatch.outcome.response import FORCE_UNITS, IMPACT_UNITS
from rockbatch.pier import Pier, RigidBase, YieldingBase, landing_force
from rockbatch.simulation.base_forces import at_rows, observed
from rockbatch.simulation.coarser import of_model
from rockbatch.simulation.histories import LANDINGS
from rockbatch.simulation.models import acceleration_at, block
from rockbatch.simulation.recording import upright
from rockbatch.simulation.runs import Run

_UPLIFTS = (types.SEPARATION_LEFT, types.SEPARATION_RIGHT, types.LIFT_OFF)


@dataclass(frozen=True)
class PeakForces:
    """Design demands of a run until it ends or the pier leans beyond α for good; SI units, per unit mass of the pier.

    Magnitudes; ``None`` if a demand does not apply (THEORY.md, Results of a run).
    """

    # greatest V/M, and N/M of all supports, without the impulses of impacts [m/s²]
    base_shear: float
    normal_force: float
    # greatest moment over M about the middle of the base, of supports, dampers and tendons, without impulses [m²/s²]
    base_moment: float
    friction_demand: float  # greatest |V|/N while N is above a share of the weight
    # greatest force of each support over half the weight
    pivot_left: float
    pivot_right: float
    # greatest gap between each pivot and its support [m]
    heel_gap_left: float
    heel_gap_right: float
    # greatest speed at which each gap opens or closes [m/s]
    heel_speed_left: float
    heel_speed_right: float
    deck_acceleration: float  # greatest absolute horizontal acceleration of the deck [m/s²]
    omega_over_p: float  # greatest |θ̇|/p
    # speed of the landing pivot, and vertical impulse over M, at the hardest impact [m/s]
    landing_velocity: float | None = None
    impulse: float | None = None
    impact_friction_demand: float | None = None  # greatest horizontal over vertical impulse of an impact
    # time of the first uplift [s], and magnitude of the horizontal ground acceleration then [m/s²]
    first_uplift: float | None = None
    uplift_ground: float | None = None
    # greatest V/M while N is below the share of ``friction_demand``, which shear keys carry [m/s²]
    key_shear: float | None = None
    flight_longest: float | None = None  # longest flight that was followed [s]
    # four times the greatest relative change of a demand by halving the step; ``None`` with a fixed step
    error: float | None = None
    # greatest force of a foot over M at the hardest impact, estimated by a contact stiffness of the base [m/s²]
    landing_force: float | None = None
    # true if the greatest friction demand, impacts included, exceeds the interface's friction; ``None`` if it is not given
    slides: bool | None = None

    def mirrored(self) -> "PeakForces":
        """Return the demands of the mirror image: left and right exchanged."""
        return replace(
            self,
            pivot_left=self.pivot_right,
            pivot_right=self.pivot_left,
            heel_gap_left=self.heel_gap_right,
            heel_gap_right=self.heel_gap_left,
            heel_speed_left=self.heel_speed_right,
            heel_speed_right=self.heel_speed_left,
        )


class Impacts(NamedTuple):
    """Impacts of a run, shape (k,) each: index of the row after it, landing pivot (−1 left, 1 right, 0 both), its greatest speed
    [m/s], and horizontal and vertical impulse on the pier per unit mass [m/s]."""

    after: np.ndarray
    side: np.ndarray
    speed: Samples
    horizontal: Samples
    vertical: Samples


def _events(rows: np.recarray, kinds: Sequence[float]) -> np.ndarray:
    """Return the indices of the rows after events of these ``kinds``, ascending; empty without such events."""
    return np.flatnonzero(np.isin(rows.kind, kinds))


def impacts(rows: np.recarray, forces: np.recarray) -> Impacts:
    """Return the impacts in ``rows``, with landing speeds from the rows before them, and changes of momentum as impulses."""
    landed = _events(rows, LANDINGS)
    before, kind = landed - 1, rows.kind[landed]
    speed_left, speed_right = np.abs(forces.speed_left[before]), np.abs(forces.speed_right[before])
    comes_down = np.where(kind == types.REST, np.where(speed_left > 0.0, types.IMPACT_LEFT, types.IMPACT_RIGHT), kind)
    side = np.where(comes_down == types.IMPACT_LEFT, -1, np.where(comes_down == types.IMPACT_RIGHT, 1, 0))
    speed = np.where(side < 0, speed_left, np.where(side > 0, speed_right, np.maximum(speed_left, speed_right)))
    return Impacts(
        landed, side, speed, forces.along[landed] - forces.along[before], forces.up[landed] - forces.up[before]
    )


def forces_table(t: Samples, forces: np.recarray, gravity: float) -> "pd.DataFrame":
    """Return :attr:`Response.forces` at the times ``t`` [s]."""
    half = 0.5 * gravity
    columns = [forces.shear, forces.normal, forces.moment, forces.friction, forces.left / half, forces.right / half]
    columns += [forces.gap_left, forces.gap_right, forces.speed_left, forces.speed_right, forces.deck]
    return pd.DataFrame({"t": t.copy(), **dict(zip(FORCE_UNITS, columns, strict=True))})


def impacts_table(rows: np.recarray, forces: np.recarray) -> "pd.DataFrame":
    """Return :attr:`Response.impacts` of a run with the ``forces`` at its ``rows``."""
    landings = impacts(rows, forces)
    columns = [rows.t[landings.after], landings.speed, landings.horizontal, landings.vertical]
    table = pd.DataFrame(dict(zip(IMPACT_UNITS, columns, strict=True)))
    table.insert(1, "pivot", np.array(["left", "both", "right"], dtype=object)[landings.side + 1])
    return table.astype({"pivot": "str"})


def peak_forces(run: Run, rows: np.recarray, least_normal: float) -> tuple[PeakForces, str]:
    """Return the design demands of a run, and a note on motion that the model does not follow; "" without.

    ``rows`` are those of a history with every step; demands end when the pier leans beyond α for good. The friction demand is
    taken while N is above the share ``least_normal`` of the weight.
    """
    pier = run.pier
    rows = upright(rows, pier.alpha)
    extremes = np.zeros(len(Forces._fields))
    noted = Noted(*observed(run, rows, least_normal, np.recarray(0, FORCES), extremes).tolist())
    most = Forces(*extremes.tolist())
    events = rows[(rows.kind > 0.0) | (rows.kind == types.BEFORE_EVENT)].view(np.recarray)
    landings = impacts(events, at_rows(run, events))
    # Yield is located up to rounding, which must not exceed the capacity; a dashpot adds to the spring's force
    capacity = math.inf
    if isinstance(run.base, YieldingBase) and not run.base.zeta:
        capacity = run.base.eta * run.base.first_loading.most
    hardest, limit = _hardest(run, events, landings), run.base.friction
    peaks = PeakForces(
        base_shear=most.shear,
        normal_force=most.normal,
        base_moment=most.moment,
        friction_demand=most.friction,
        pivot_left=min(most.left / (0.5 * pier.gravity), capacity),
        pivot_right=min(most.right / (0.5 * pier.gravity), capacity),
        heel_gap_left=most.gap_left,
        heel_gap_right=most.gap_right,
        heel_speed_left=most.speed_left,
        heel_speed_right=most.speed_right,
        deck_acceleration=most.deck,
        omega_over_p=most.omega / pier.p,
        key_shear=noted.key_shear or None,
        flight_longest=noted.longest_flight or None,
        slides=None if limit is None else max(most.friction, hardest.get("impact_friction_demand", 0.0)) > limit,
        **hardest,
        **_first_uplift(run, events),
    )
    return peaks, _not_followed(run, noted, peaks, least_normal)


def _hardest(run: Run, events: np.recarray, landings: Impacts) -> dict[str, float]:
    """Return fields of PeakForces: demands of the fastest landing, and the greatest impact friction; empty without impacts.

    The landing force is among them on a rigid base with a contact stiffness, the friction if an impact presses upwards.
    """
    if len(landings.after) == 0:
        return {}
    hardest = int(landings.speed.argmax())
    speed = float(landings.speed[hardest])
    peaks = {"landing_velocity": speed, "impulse": float(landings.vertical[hardest])}
    if isinstance(run.base, RigidBase) and run.base.contact_stiffness_kN_m is not None:
        peaks["landing_force"] = landing_force(run.pier, run.base.contact_stiffness_kN_m, speed)
    pressed = landings.vertical > 0.0
    if pressed.any():
        shares = np.abs(landings.horizontal[pressed]) / landings.vertical[pressed]
        peaks["impact_friction_demand"] = float((shares * _per_bounce(run, events, landings.after[pressed])).max())
    return peaks


def _per_bounce(run: Run, events: np.recarray, after: np.ndarray) -> Samples | float:
    """Return the factor from J_h/J_v of each impact in total to that of a single bounce; 1 except when coming to rest.

    Rest sums up ever lower bounces, each of which leaves the share e of the velocity: for one, J_h is (1 − e) and J_v (1 + e)
    of the impulses of an immediate stop (THEORY.md, Forces). 1 for all on springs.
    """
    if run.base.on_springs:
        return 1.0
    e = block(run.pier, run.base).restitution
    return np.where(events.kind[after] == types.REST, (1.0 - e) / (1.0 + e), 1.0)


def _first_uplift(run: Run, rows: np.recarray) -> dict[str, float]:
    """Return fields of PeakForces: time and magnitude of the ground acceleration at the first uplift; empty without uplift."""
    lifted = _events(rows, _UPLIFTS)
    if len(lifted) == 0:
        return {}
    t = float(rows.t[lifted[0]])
    return {"first_uplift": t, "uplift_ground": abs(float(acceleration_at(run.motion.horizontal, run.motion.dt, t)))}


def _not_followed(run: Run, noted: Noted, peaks: PeakForces, least_normal: float) -> str:
    """Return a note on tension on rigid ground, sliding and keys that carry the shear, which the model does not follow; else "".

    The last two are only said if the base states its friction.
    """
    notes = []
    if noted.pulls != NEVER and not run.base.on_springs:
        notes.append(
            f"at {noted.pulls:.2f} s the ground would have to hold the pier down: it would leave it, which is not followed"
        )
    limit = run.base.friction
    if limit is None:
        return "; ".join(notes)
    if peaks.slides:
        most = max(peaks.friction_demand, peaks.impact_friction_demand or 0.0)
        time = "at an impact" if noted.slides == NEVER else f"at {noted.slides:.2f} s"
        notes.append(
            f"would slide {time}: the friction demand reaches {most:.3g}, the interface has {limit:g}; sliding is not followed"
        )
    if peaks.key_shear is not None:
        notes.append(
            f"where the normal force is below {least_normal:g} of the weight, friction holds little: keys have to carry a "
            f"base shear of up to {peaks.key_shear / run.pier.gravity:.3g} of the weight"
            f"{_in_kilonewtons(run.pier, peaks.key_shear)}"
        )
    return "; ".join(notes)


def _in_kilonewtons(pier: Pier, force: float) -> str:
    """Return a force per unit mass [m/s²] as text in kN, after a comma: ", 1,234 kN"; "" if the mass is not known."""
    return "" if pier.mass_t is None else f", {pier.mass_t * force:,.0f} kN"


LARGE_ERROR = 0.01
"""Relative error of a force above which a run has a note."""

OF_IMPACTS = "friction demand of impacts"

OF_FORCES = {
    "base shear": Sized(("base_shear",), "force"),
    "normal force": Sized(("normal_force",), "force"),
    "base moment": Sized(("base_moment",), "moment"),
    "friction demand": Sized(("friction_demand",), "friction"),
    "force of a support": Sized(("pivot_left", "pivot_right"), "share"),
    "heel gap": Sized(("heel_gap_left", "heel_gap_right"), "gap"),
    "heel speed": Sized(("heel_speed_left", "heel_speed_right"), "speed"),
    "acceleration of the deck": Sized(("deck_acceleration",), "force"),
    "landing velocity": Sized(("landing_velocity",), "speed"),
    "impulse": Sized(("impulse",), "speed"),
    OF_IMPACTS: Sized(("impact_friction_demand",), "friction"),
    "angular velocity": Sized(("omega_over_p",), "rotation"),
    "base shear on the keys": Sized(("key_shear",), "force"),
}
"""Quantities of PeakForces that have an error, with their fields and scales."""


def with_error(fine: PeakForces, coarse: PeakForces, pier: Pier, chance: float) -> tuple[PeakForces, str]:
    """Return ``fine`` with ``chance`` times the greatest relative change from ``coarse`` added to its error, and a note.

    ``coarse`` are the demands with twice the step; a change counts as LEAST at least. The note is "" unless it is above
    LARGE_ERROR, 1 %.
    """
    worst, most = greatest_change(OF_FORCES, fine, coarse, pier)
    note = f"forces not settled: halving the step still changed the {worst} by {most:.1%}" if most > LARGE_ERROR else ""
    return replace(fine, error=(fine.error or 0.0) + chance * max(most, LEAST)), note


def with_model_error(run: Run, fine: PeakForces, fewer: PeakForces, chance: float) -> PeakForces:
    """Return ``fine`` with ``chance`` times the greatest relative change from ``fewer`` modes or strips added to its error.

    NaN if the last mode has more than :data:`rockbatch.simulation.coarser.MOST_DAMPING`. The friction demand of impacts is
    left out: each further mode takes about half of a landing's horizontal impulse, so that this demand falls to 0 with more
    modes, and is too great with any number of them.
    """
    of_modes = {name: sized for name, sized in OF_FORCES.items() if name != OF_IMPACTS}
    of_fewer = of_model(run, greatest_change(of_modes, fine, fewer, run.pier)[1], chance)
    return replace(fine, error=(fine.error or 0.0) + of_fewer)
