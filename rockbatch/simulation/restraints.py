"""Dampers and tendons of a run that was written down: forces, elongations, and the energy ledger with them."""

import math
from typing import TYPE_CHECKING

import numpy as np

from rockbatch.core.devices.laws import FRICTION, HYSTERETIC, TENDON, Element
from rockbatch.core.observe.ledger import LEDGER
from rockbatch.core.types import Result
from rockbatch.motions.motion import Samples
from rockbatch.pier import Base, Damper, ElasticBase, Pier, RigidBase, offsets
from rockbatch.simulation.models import elements, prestress, springs

if TYPE_CHECKING:
    import pandas as pd


AT_REST = 1e-9
"""Of R0 α p: velocity that counts as none in a history."""


def names(pier: Pier, base: Base) -> list[str]:
    """Of all elements, in their order: "damper 1 left", "damper 1 right", "tendon 1"."""
    found, counts = [], {"damper": 0, "tendon": 0}
    for each in base.restraints:
        what = "damper" if isinstance(each, Damper) else "tendon"
        counts[what] += 1
        places = offsets(pier, each)
        sides = [""] if len(places) == 1 else [" left", " right"]
        found += [f"{what} {counts[what]}{side}" for side in sides]
    return found


def apart(base: Base, rows: np.recarray) -> tuple[np.recarray, Samples]:
    """Return rows of a history as those of a plain pier, and force [m/s²] and moment [m²/s²] of all devices at each."""
    if not base.restraints:
        return rows, np.zeros((len(rows), 2))
    names = rows.dtype.names or ()
    plain = np.recarray(len(rows), np.dtype([(name, "f8") for name in names[: names.index("state")]]))
    for name in plain.dtype.names or ():
        plain[name] = rows[name]
    return plain, rows.pull.copy()


def _elongation(of: Element, pier: Pier, base: Base, rows: np.recarray) -> tuple[Samples, Samples]:
    """Return elongation [m] and its rate [m/s]: u/cos(θ/2), where u is the rise of the place; first-order u itself."""
    theta, s, h, rise = rows.theta, of.offset, pier.height, rows.v - rows.v[0]
    if base.kinematics != "finite":
        return rise - s * theta, rows.v_rate - s * rows.omega
    up = rise - s * np.sin(theta) + h * (1.0 - np.cos(theta))
    speed = rows.v_rate + (h * np.sin(theta) - s * np.cos(theta)) * rows.omega
    cosine = np.cos(0.5 * theta)
    return up / cosine, (speed + 0.5 * up * np.tan(0.5 * theta) * rows.omega) / cosine


def _force(of: Element, pier: Pier, base: Base, rows: np.recarray, j: int) -> Samples:
    """[N/kg], positive in tension; of friction 0 where the pier does not move."""
    elongation, speed = _elongation(of, pier, base, rows)
    state = rows.state[:, j]
    if of.kind == FRICTION:
        moves = np.abs(speed) > AT_REST * pier.size * pier.alpha * pier.p
        return np.where(moves, of.strength * np.sign(speed), 0.0)
    if of.kind == HYSTERETIC:
        return of.strength * state
    if of.kind == TENDON:
        return np.clip(of.prestress + of.stiffness * (elongation - state), 0.0, of.strength)
    size = np.abs(speed)
    return np.where(size < of.linear_below, of.slope * speed, of.coefficient * np.sign(speed) * size**of.exponent)


def loops(pier: Pier, base: Base, rows: np.recarray) -> "pd.DataFrame":
    """Force [N/kg] and elongation [m] of every element at every row."""
    import pandas as pd

    table = {"t": rows.t}
    for j, (of, name) in enumerate(zip(elements(pier, base), names(pier, base), strict=True)):
        table[f"{name} elongation"] = _elongation(of, pier, base, rows)[0]
        table[f"{name} force"] = _force(of, pier, base, rows, j)
    return pd.DataFrame(table)


def _stored(of: Element, pier: Pier, base: Base, rows: np.recarray, j: int) -> Samples:
    """Energy [J/kg] that a tendon gives back until it is slack."""
    if of.stiffness == 0.0:
        return of.prestress * _elongation(of, pier, base, rows)[0]
    pull = _force(of, pier, base, rows, j)
    return 0.5 * pull * pull / of.stiffness


def stored(pier: Pier, base: Base, rows: np.recarray) -> Samples:
    """Energy [J/kg] that all tendons store, relative to the start."""
    laws = elements(pier, base)
    found = sum(
        (_stored(of, pier, base, rows, j) for j, of in enumerate(laws) if of.kind == TENDON), np.zeros(len(rows))
    )
    return found - found[0]


def with_devices(pier: Pier, base: Base, rows: np.recarray, terms: Samples) -> Samples:
    """Return the energy balance [J/kg] of a run, whose ``terms`` say nothing of its dampers and tendons, with these."""
    table = terms.view(LEDGER)[:, 0].view(np.recarray)  # the same memory, by names
    kinds = np.array([of.kind == TENDON for of in elements(pier, base)])
    table.elastic += stored(pier, base, rows)
    table.plastic += rows.lost[:, kinds].sum(axis=1)
    table.damping += rows.lost[:, ~kinds].sum(axis=1)
    table.p_delta += rows.p_delta
    given = table.kinetic + table.potential + table.elastic - table.input - table.p_delta - table.constraint
    table.remainder = given + table.plastic + table.impact + table.damping
    return terms


def rests_at(pier: Pier, base: ElasticBase, found: Result, level: float, states: Samples, holds: np.ndarray) -> float:
    """Return the rotation [rad] at which the pier comes to rest on its supports as the run has ``found`` them.

    Static, small, both pivots on their springs; devices give way elastically from where the run has left them, and a friction
    damper that does not move stays where it is.

    Parameters
    ----------
    level : float
        v of the pier at rest at the start [m].
    states, holds : ndarray, shape (devices,)
        State of each device at the end, and whether it is a friction damper that does not move then.
    """
    m, v, theta = springs(pier, base), found.v_end, found.theta_end
    k, b, h = m.yield_force * m.stiffness, m.half_width, m.height
    unstressed = level + 0.5 * (m.gravity + prestress(pier, base)) / k  # at the start
    stiffness = np.array([[2.0 * k, 0.0], [0.0, 2.0 * k * b * b - m.gravity * h]])
    left, right = found.base_left, found.base_right
    load = np.array([k * (2.0 * unstressed + left + right) - m.gravity, k * b * (left - right)])
    for of, state, holding in zip(elements(pier, base), states, holds, strict=True):
        now, soft = v - level - of.offset * theta, np.array([1.0, -of.offset])
        force, gives = _at_rest(of, now, state, k if holding else 0.0)
        # F = force + gives (u − now), which pulls down by F and turns by −s F
        stiffness += gives * np.outer(soft, soft)
        load -= (force - gives * (now + level)) * soft
    return float(np.linalg.solve(stiffness, load)[1])


def rests_on_rigid_base(pier: Pier, base: RigidBase, found: Result, states: Samples, holds: np.ndarray) -> float:
    """Return the rotation [rad] at which devices hold a pier that has not come to rest upright, 0 if they do not.

    Friction holds it where it is; other devices give way elastically until weight and devices balance.
    """
    theta, b = found.theta_end, pier.half_width
    laws = elements(pier, base)
    if any(
        holding and abs(of.offset - math.copysign(b, theta)) > 1e-9 * b for of, holding in zip(laws, holds, strict=True)
    ):
        return theta
    side = math.copysign(1.0, theta)

    def excess(tilt: float) -> float:
        """Return the moment [m²/s²] that rights the pier at rest at ``tilt``."""
        righting = pier.gravity * pier.size * math.sin(pier.alpha - tilt)
        for of, state in zip(laws, states, strict=True):
            distance = b - side * of.offset
            now, then = 2.0 * distance * math.sin(0.5 * tilt), 2.0 * distance * math.sin(0.5 * abs(theta))
            force, gives = _at_rest(of, then, state, 0.0)
            righting += (force + gives * (now - then)) * distance * math.cos(0.5 * tilt)
        return righting

    low, high = 0.0, abs(theta)
    if excess(low) >= 0.0 or excess(high) < 0.0:
        return 0.0 if excess(low) >= 0.0 else theta
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) < 0.0 else (low, middle)
    return side * 0.5 * (low + high)


def _at_rest(of: Element, elongation: float, state: float, support: float) -> tuple[float, float]:
    """Force [N/kg] and stiffness [1/s²] of an element at rest; ``support`` is that of a spring where friction holds, else 0."""
    if of.kind == FRICTION:
        return 0.0, 1e6 * support
    if of.kind == HYSTERETIC:
        return of.strength * state, of.strength * of.stiffness
    if of.kind != TENDON:
        return 0.0, 0.0
    pull = of.prestress + of.stiffness * (elongation - state)
    return min(max(pull, 0.0), of.strength), of.stiffness if 0.0 < pull < of.strength else 0.0
