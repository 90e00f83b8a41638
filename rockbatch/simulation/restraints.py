"""Dampers and tendons of a run that was written down: forces, elongations, and the energy ledger with them."""

import math
from typing import TYPE_CHECKING

import numpy as np

from rockbatch.core import types
from rockbatch.core.ledger import LEDGER
from rockbatch.core.recording import ROW
from rockbatch.core.restrained.elements import FRICTION, HYSTERETIC, TENDON, Element
from rockbatch.core.restrained_springs.runs import RestrainedOnSprings
from rockbatch.motions.motion import Samples
from rockbatch.pier import Base, Damper, ElasticBase, Pier, RigidBase, offsets
from rockbatch.simulation.models import elements, prestress, springs

if TYPE_CHECKING:
    import pandas as pd


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


def without_notes(rows: np.recarray, kind: np.dtype) -> np.recarray:
    """Rows of a history as those of a pier without dampers and tendons, of this ``kind``."""
    plain = np.recarray(len(rows), kind)
    for name in kind.names or ():
        plain[name] = rows[name]
    return plain


def apart(base: Base, rows: np.recarray) -> tuple[np.recarray, Samples]:
    """Rows of a history on springs as those of a plain pier, and force [m/s²] and moment [m²/s²] of all elements at each."""
    if not base.restraints:
        return rows, np.zeros((len(rows), 2))
    return without_notes(rows, ROW), rows.pull.copy()


def _elongation(of: Element, pier: Pier, base: Base, rows: np.recarray) -> tuple[Samples, Samples]:
    """Elongation [m] and its rate [m/s]: 2 d sin(|θ|/2) from the corner about which the block has turned, or v − s θ."""
    theta, tilt = rows.theta, np.abs(rows.theta)
    if not isinstance(base, RigidBase):
        s, h, rise = of.offset, pier.height, rows.v - rows.v[0]
        if base.kinematics == "finite":
            arm = h * np.sin(theta) - s * np.cos(theta)
            return rise - s * np.sin(theta) + h * (1.0 - np.cos(theta)), rows.v_rate + arm * rows.omega
        return rise - s * theta, rows.v_rate - s * rows.omega
    d = np.where(theta > 0.0, of.from_right, of.from_left)
    return 2.0 * d * np.sin(0.5 * tilt), d * np.cos(0.5 * tilt) * np.sign(theta) * rows.omega


def _force(of: Element, pier: Pier, base: Base, rows: np.recarray, j: int) -> Samples:
    """[N/kg], positive in tension; of friction 0 where the pier does not move."""
    elongation, speed = _elongation(of, pier, base, rows)
    state = rows.state[:, j]
    if of.kind == FRICTION:
        return of.strength * np.sign(speed)
    if of.kind == HYSTERETIC:
        return of.strength * state
    if of.kind == TENDON:
        return np.clip(of.prestress + of.stiffness * (elongation - state), 0.0, of.strength)
    return of.coefficient * np.sign(speed) * np.abs(speed) ** of.exponent


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


def energies(pier: Pier, base: RigidBase, rows: np.recarray) -> Samples:
    """Energy ledger [J/kg] (THEORY.md, Energy ledger): ``elastic`` and ``plastic`` are of tendons, ``damping`` of dampers."""
    inertia = pier.inertia_about_pivot
    laws = elements(pier, base)
    tendons = [j for j, of in enumerate(laws) if of.kind == TENDON]
    dampers = [j for j, of in enumerate(laws) if of.kind != TENDON]
    kinetic = 0.5 * inertia * rows.omega**2
    potential = inertia * pier.p**2 * (np.cos(pier.alpha - np.abs(rows.theta)) - math.cos(pier.alpha))
    plastic, damping = rows.lost[:, tendons].sum(axis=1), rows.lost[:, dampers].sum(axis=1)
    landed = np.isin(rows.kind, (types.IMPACT_LEFT, types.IMPACT_RIGHT, types.REST))
    drop = np.where(landed, np.append(0.0, kinetic[:-1] - kinetic[1:]), 0.0)
    impact, zero = np.cumsum(drop), np.zeros(len(rows))
    parts = [kinetic - kinetic[0], potential - potential[0], stored(pier, base, rows)]
    remainder = sum(parts, zero) - rows.input + plastic + impact + damping
    return np.column_stack([*parts, rows.input, plastic, impact, zero, zero, damping, remainder])


def with_elements(pier: Pier, base: ElasticBase, rows: np.recarray, terms: Samples) -> Samples:
    """Energy ledger [J/kg] of a run on springs, whose ``terms`` say nothing of its dampers and tendons, with these."""
    table = terms.view(LEDGER)[:, 0].view(np.recarray)  # the same memory, by names
    kinds = np.array([of.kind == TENDON for of in elements(pier, base)])
    table.elastic += stored(pier, base, rows)
    table.plastic += rows.lost[:, kinds].sum(axis=1)
    table.damping += rows.lost[:, ~kinds].sum(axis=1)
    table.p_delta += rows.p_delta
    given = table.kinetic + table.potential + table.elastic - table.input - table.p_delta - table.constraint
    table.remainder = given + table.plastic + table.impact + table.damping
    return terms


def rests_at(pier: Pier, base: ElasticBase, found: RestrainedOnSprings, left: float, right: float) -> float:
    """Rotation [rad] at which the pier comes to rest on supports that have sunk by −``left`` and −``right`` [m].

    Static, small, both pivots on their springs; elements give way elastically from where the run has left them, and a friction
    damper that does not move stays where it is.
    """
    m, v, theta = springs(pier, base), found.end.v, found.end.theta
    k, b, h = m.yield_force * m.stiffness, m.half_width, m.height
    unstressed = found.level + 0.5 * (m.gravity + prestress(pier, base)) / k  # at the start
    stiffness = np.array([[2.0 * k, 0.0], [0.0, 2.0 * k * b * b - m.gravity * h]])
    load = np.array([k * (2.0 * unstressed + left + right) - m.gravity, k * b * (left - right)])
    for of, state, holds in zip(elements(pier, base), found.states, found.holds, strict=True):
        now, soft = v - found.level - of.offset * theta, np.array([1.0, -of.offset])
        force, gives = _at_rest(of, now, state, k if holds else 0.0)
        # F = force + gives (u − now), which pulls down by F and turns by −s F
        stiffness += gives * np.outer(soft, soft)
        load -= (force - gives * (now + found.level)) * soft
    return float(np.linalg.solve(stiffness, load)[1])


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
