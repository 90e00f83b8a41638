"""Forces of a run that was written down, and what of them a designer sizes: their peaks, the hardest impact, uplift."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rockbatch.core import types
from rockbatch.core.devices.laws import FRICTION
from rockbatch.core.observe.forces import FORCES, NEVER, Forces, Hold, Outline, forces_on_rigid_base, forces_on_springs
from rockbatch.motions.motion import Samples
from rockbatch.pier import Pier, RigidBase, YieldingBase
from rockbatch.results.outcome import WOULD_SLIDE, Outcome, PeakForces
from rockbatch.results.response import FORCE_UNITS, IMPACT_UNITS
from rockbatch.simulation.models import block, elements, ground_of, springs
from rockbatch.simulation.restraints import apart
from rockbatch.simulation.runs import Run

if TYPE_CHECKING:
    import pandas as pd

_UPLIFTS = (types.SEPARATION_LEFT, types.SEPARATION_RIGHT, types.LIFT_OFF)
_LANDINGS = (types.IMPACT_LEFT, types.IMPACT_RIGHT, types.IMPACT_BOTH, types.REST)


class Impacts(NamedTuple):
    """The impacts of a run, each shape (k,): the place of the row after it, what lands (−1 left, 1 right, 0 both), the
    greatest speed of what lands [m/s], and the impulse on the pier per unit mass [m/s], horizontal and vertical."""

    after: np.ndarray
    side: np.ndarray
    speed: Samples
    horizontal: Samples
    vertical: Samples


class Greatest(NamedTuple):
    """The greatest magnitudes of a run; when |V|/N first exceeds the interface's friction, and N is first negative [s]."""

    forces: Forces
    slides: float | None
    pulls: float | None


def at_rows(run: Run, rows: np.recarray) -> np.recarray:
    """Forces (core.forces.Forces) at every row of a run that has both sides of every event."""
    found = np.recarray(len(rows), FORCES)
    _observe(run, rows, found, np.zeros(0), np.full(2, NEVER))
    return found


def greatest(run: Run, rows: np.recarray) -> Greatest:
    """The greatest forces of a run, ``rows`` of which are all its steps."""
    extremes, firsts = np.zeros(len(Forces._fields)), np.full(2, NEVER)
    _observe(run, rows, np.recarray(0, FORCES), extremes, firsts)
    slides, pulls = (None if t == NEVER else float(t) for t in firsts)
    return Greatest(Forces(*extremes.tolist()), slides, pulls)


def _observe(run: Run, rows: np.recarray, found: np.recarray, extremes: Samples, firsts: Samples) -> None:
    if len(rows) == 0:
        return
    pier, base = run.pier, run.base
    has = math.inf if base.friction is None else float(base.friction)
    rest = (ground_of(run.motion), float(run.motion.dt), has, found, extremes, firsts)
    plain, pulls = apart(base, rows)
    if isinstance(base, RigidBase):
        forces_on_rigid_base(block(pier, base), _outline(pier), _hold(pier, base), plain, pulls, *rest)
    else:
        forces_on_springs(springs(pier, base), float(pier.deck), plain, pulls, *rest)


def _hold(pier: Pier, base: RigidBase) -> Hold:
    """Return what friction dampers can do against a pier at rest that begins to turn about its left or right pivot."""
    found = []
    for side in (-1.0, 1.0):
        rubs = [(of.strength, pier.half_width - side * of.offset) for of in elements(pier, base) if of.kind == FRICTION]
        found.append(sum(math.copysign(strength, d) for strength, d in rubs if d != 0.0))
        found.append(sum(strength * abs(d) for strength, d in rubs) / pier.inertia_about_pivot)
    return Hold(*map(float, found))


def _outline(pier: Pier) -> Outline:
    """The deck of a frame rests on corners of its columns, twice as far from their pivots as their centres of mass are."""
    size, width = float(pier.size), 2.0 * float(pier.half_width)
    if pier.deck_over_columns is not None:
        return Outline(size, width, width / math.sin(pier.alpha) / size, 0.0)
    return Outline(size, width, 1.0, float(pier.deck - pier.height))


def _events(rows: np.recarray, kinds: Sequence[float]) -> np.ndarray:
    """Places of the rows behind events of these ``kinds``."""
    events = np.flatnonzero(rows.kind > 0.0)
    return events[np.isin(rows.kind[events], kinds)]


def impacts(rows: np.recarray, found: np.recarray) -> Impacts:
    """Impacts between neighbouring rows: the speed before, and by how much the momentum changes."""
    after = _events(rows, _LANDINGS)
    before, kind = after - 1, rows.kind[after]
    left, right = np.abs(found.speed_left[before]), np.abs(found.speed_right[before])
    comes_down = np.where(kind == types.REST, np.where(left > 0.0, types.IMPACT_LEFT, types.IMPACT_RIGHT), kind)
    side = np.where(comes_down == types.IMPACT_LEFT, -1, np.where(comes_down == types.IMPACT_RIGHT, 1, 0))
    speed = np.where(side < 0, left, np.where(side > 0, right, np.maximum(left, right)))
    return Impacts(after, side, speed, found.along[after] - found.along[before], found.up[after] - found.up[before])


def forces_table(t: Samples, found: np.recarray, gravity: float) -> "pd.DataFrame":
    """:attr:`Response.forces` at the times ``t`` [s]."""
    import pandas as pd

    half = 0.5 * gravity
    told = [found.shear, found.normal, found.friction, found.left / half, found.right / half]
    told += [found.gap_left, found.gap_right, found.speed_left, found.speed_right, found.deck]
    return pd.DataFrame({"t": t.copy(), **dict(zip(FORCE_UNITS, told, strict=True))})


def impacts_table(rows: np.recarray, found: np.recarray) -> "pd.DataFrame":
    """:attr:`Response.impacts` of a run with these forces."""
    import pandas as pd

    own = impacts(rows, found)
    told = [rows.t[own.after], own.speed, own.horizontal, own.vertical]
    table = pd.DataFrame(dict(zip(IMPACT_UNITS, told, strict=True)))
    table.insert(1, "pivot", np.array(["left", "both", "right"], dtype=object)[own.side + 1])
    return table.astype({"pivot": "str"})


def peak_forces(run: Run, outcome: Outcome, rows: np.recarray) -> tuple[PeakForces, str]:
    """What a run asks of the design, and a note on what it tells that the model does not follow; empty where there is none.

    ``rows`` are those of a history with every step. An overturned pier counts until it leans beyond α for good.
    """
    pier, base = run.pier, run.base
    if outcome.status == "overturned":
        standing = np.flatnonzero(np.abs(rows.theta) <= pier.alpha)
        rows = rows[: standing[-1] + 1].view(np.recarray)
    whole = greatest(run, rows)
    most = whole.forces
    events = rows[(rows.kind > 0.0) | (rows.kind == types.BEFORE_EVENT)].view(np.recarray)
    landings = impacts(events, at_rows(run, events))
    carried = [force / (0.5 * pier.gravity) for force in (most.left, most.right)]
    if isinstance(base, YieldingBase):
        carried = [min(force, base.eta) for force in carried]  # a parabola may top it
    peaks = PeakForces(
        base_shear=most.shear,
        normal_force=most.normal,
        friction_demand=most.friction,
        pivot_left=carried[0],
        pivot_right=carried[1],
        heel_gap_left=most.gap_left,
        heel_gap_right=most.gap_right,
        heel_speed_left=most.speed_left,
        heel_speed_right=most.speed_right,
        deck_acceleration=most.deck,
        omega_over_p=most.omega / pier.p,
        **_hardest(landings),
        **_first_uplift(run, events),
    )
    return peaks, _limits(run, whole, peaks)


def _hardest(landings: Impacts) -> dict[str, float]:
    """The hardest impact, that of the greatest landing velocity; nothing without one."""
    if len(landings.after) == 0:
        return {}
    hardest = int(landings.speed.argmax())
    told = {"landing_velocity": float(landings.speed[hardest]), "impulse": float(landings.vertical[hardest])}
    pressed = landings.vertical > 0.0
    if pressed.any():
        shares = np.abs(landings.horizontal[pressed]) / landings.vertical[pressed]
        told["impact_friction_demand"] = float(shares.max())
    return told


def _first_uplift(run: Run, rows: np.recarray) -> dict[str, float]:
    """When a pivot first lifts, and the magnitude of the horizontal ground acceleration then; nothing if none does."""
    lifted = _events(rows, _UPLIFTS)
    if len(lifted) == 0:
        return {}
    t, samples = float(rows.t[lifted[0]]), np.append(run.motion.horizontal, 0.0)
    shaken = float(np.interp(t, np.arange(len(samples)) * run.motion.dt, samples))
    return {"first_uplift": t, "uplift_ground": abs(shaken)}


def _limits(run: Run, whole: Greatest, peaks: PeakForces) -> str:
    """What the forces say that the model does not follow: sliding, and a rigid base that would have to pull."""
    notes = []
    if whole.pulls is not None and not run.base.on_springs:
        notes.append(
            f"at {whole.pulls:.2f} s the ground would have to hold the pier down: it would leave it, which is not followed"
        )
    has = run.base.friction
    most = max(peaks.friction_demand, peaks.impact_friction_demand or 0.0)
    if has is not None and most > has:
        when = "at an impact" if whole.slides is None else f"at {whole.slides:.2f} s"
        told = f"reaches {most:.3g}" if math.isfinite(most) else "has no limit, as nothing presses the pier down"
        notes.append(
            f"{WOULD_SLIDE} {when}: the friction demand {told}, the interface has {has:g}; sliding is not followed"
        )
    return "; ".join(notes)
