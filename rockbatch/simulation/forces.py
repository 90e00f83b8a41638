"""Forces of a run that was written down, and what of them a designer sizes: their peaks, the hardest impact, uplift."""

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rockbatch.core import types
from rockbatch.core.forces import FORCES, Outline, forces_on_rigid_base, forces_on_springs
from rockbatch.motions.motion import Samples
from rockbatch.pier import Base, Pier, RigidBase, YieldingBase
from rockbatch.results.outcome import Outcome, PeakForces
from rockbatch.results.response import FORCE_UNITS, IMPACT_UNITS
from rockbatch.simulation.models import block, ground_of, springs
from rockbatch.simulation.runs import Run

if TYPE_CHECKING:
    import pandas as pd

LIFTED = 1e-9
"""Of g: a normal force that is no more than rounding."""

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


def observed(run: Run, rows: np.recarray, steps: bool) -> tuple[np.recarray, np.recarray]:
    """Forces (core.forces.Forces) at every row of a run, and in the middle of every step; ``steps``: the rows have them all."""
    pier, ground, dt = run.pier, ground_of(run.motion), float(run.motion.dt)
    found, middles = np.recarray(len(rows), FORCES), np.recarray(len(rows) if steps else 0, FORCES)
    if isinstance(run.base, RigidBase):
        forces_on_rigid_base(block(pier, run.base), _outline(pier), rows, ground, dt, found, middles)
    else:
        forces_on_springs(springs(pier, run.base), float(pier.deck), rows, ground, dt, found, middles)
    return found, middles


def _outline(pier: Pier) -> Outline:
    """The deck of a frame rests on corners of its columns, twice as far from their pivots as their centres of mass are."""
    size, width = float(pier.size), 2.0 * float(pier.half_width)
    if pier.deck_over_columns is not None:
        return Outline(size, width, width / math.sin(pier.alpha) / size, 0.0)
    return Outline(size, width, 1.0, float(pier.deck - pier.height))


def friction(found: np.recarray, gravity: float) -> Samples:
    """|V|/N at every moment: infinite where nothing presses the pier down."""
    pressed = found.normal > LIFTED * gravity
    return np.where(pressed, np.abs(found.shear) / np.where(pressed, found.normal, 1.0), math.inf)


def impacts(rows: np.recarray, found: np.recarray) -> Impacts:
    """Impacts between neighbouring rows: the speed before, and by how much the momentum changes."""
    after = np.flatnonzero(np.isin(rows.kind, _LANDINGS))
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
    told = [found.shear, found.normal, friction(found, gravity), found.left / half, found.right / half]
    told += [found.gap_left, found.gap_right, found.speed_left, found.speed_right, found.deck]
    return pd.DataFrame({"t": t.copy(), **dict(zip(FORCE_UNITS, told, strict=True))})


def impacts_table(rows: np.recarray, found: np.recarray) -> "pd.DataFrame":
    """:attr:`Response.impacts` of a run with these forces."""
    import pandas as pd

    own = impacts(rows, found)
    numbers = (rows.t[own.after], own.speed, own.horizontal, own.vertical)
    table = pd.DataFrame(dict(zip(IMPACT_UNITS, numbers, strict=True)))
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
    found, middles = observed(run, rows, steps=True)
    steps = rows.kind <= types.SAMPLE

    def most(name: str) -> float:
        return float(_greatest(found[name], middles[name], steps).max())

    asked = _greatest(friction(found, pier.gravity), friction(middles, pier.gravity), steps)
    landings = impacts(rows, found)
    carried = [most(side) / (0.5 * pier.gravity) for side in ("left", "right")]
    if isinstance(base, YieldingBase):
        carried = [min(force, base.eta) for force in carried]  # a parabola may top it
    peaks = PeakForces(
        base_shear=most("shear"),
        normal_force=most("normal"),
        friction_demand=float(asked.max()),
        pivot_left=carried[0],
        pivot_right=carried[1],
        heel_gap_left=most("gap_left"),
        heel_gap_right=most("gap_right"),
        heel_speed_left=most("speed_left"),
        heel_speed_right=most("speed_right"),
        deck_acceleration=most("deck"),
        omega_over_p=most("omega") / pier.p,
        **_hardest(landings),
        **_first_uplift(run, rows),
        **_flown(base, rows, found, middles, steps),
    )
    return peaks, _limits(run, rows, found, asked, peaks)


def _greatest(at_rows: Samples, in_middles: Samples, steps: np.ndarray) -> Samples:
    """Greatest magnitude at each row and, where a step ends there, in its middle and where the parabola through the middle
    and both ends turns; shape (n,)."""
    start = np.concatenate([at_rows[:1], at_rows[:-1]])
    greatest = np.fmax(np.abs(at_rows), np.where(steps, np.abs(in_middles), 0.0))
    with np.errstate(invalid="ignore", divide="ignore"):
        slope, bend = at_rows - start, start + at_rows - 2.0 * in_middles
        between = np.abs(in_middles - slope * slope / (8.0 * bend))
        turns = steps & (np.abs(slope) < 2.0 * np.abs(bend)) & np.isfinite(between)
    return np.where(turns, np.fmax(greatest, between), greatest)


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
    first = np.flatnonzero(np.isin(rows.kind, _UPLIFTS))[:1]
    if len(first) == 0:
        return {}
    t, samples = float(rows.t[first[0]]), np.append(run.motion.horizontal, 0.0)
    shaken = float(np.interp(t, np.arange(len(samples)) * run.motion.dt, samples))
    return {"first_uplift": t, "uplift_ground": abs(shaken)}


def _flown(
    base: Base, rows: np.recarray, found: np.recarray, middles: np.recarray, steps: np.ndarray
) -> dict[str, float]:
    """How long both pivots were in the air, and how high the lower one; nothing without flight that was followed."""
    if isinstance(base, RigidBase):
        return {}
    flying = steps & (rows.left == 0.0) & (rows.right == 0.0) & (rows.held == 0.0)
    lasted = float(np.diff(rows.t, prepend=0.0)[flying].sum())
    if lasted == 0.0:
        return {}
    at_rows, in_middles = (np.minimum(each.gap_left, each.gap_right) for each in (found, middles))
    return {"flight_duration": lasted, "flight_height": float(_greatest(at_rows, in_middles, steps).max())}


def _limits(run: Run, rows: np.recarray, found: np.recarray, asked: Samples, peaks: PeakForces) -> str:
    """What the forces say that the model does not follow: sliding, and a rigid base that would have to pull."""
    notes = []
    if isinstance(run.base, RigidBase):
        pulled = found.normal < -LIFTED * run.pier.gravity
        if pulled.any():
            t = float(rows.t[int(pulled.argmax())])
            notes.append(
                f"at {t:.2f} s the ground would have to hold the pier down: it would leave it, which is not followed"
            )
    has = run.base.friction
    if has is None:
        return "; ".join(notes)
    most = max(peaks.friction_demand, peaks.impact_friction_demand or 0.0)
    if most > has:
        beyond = asked > has
        when = f"at {float(rows.t[int(beyond.argmax())]):.2f} s" if beyond.any() else "at an impact"
        told = f"reaches {most:.3g}" if math.isfinite(most) else "has no limit, as nothing presses the pier down"
        notes.append(
            f"would slide {when}: the friction demand {told}, the interface has {has:g}; sliding is not followed"
        )
    return "; ".join(notes)
