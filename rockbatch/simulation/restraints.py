"""Dampers and tendons of a run that was written down: forces, elongations, and the energy ledger with them."""

import math
from typing import TYPE_CHECKING

import numpy as np

from rockbatch.core import types
from rockbatch.core.restrained.elements import FRICTION, HYSTERETIC, TENDON, Element
from rockbatch.motions.motion import Samples
from rockbatch.pier import Damper, Pier, RigidBase, offsets
from rockbatch.simulation.models import elements

if TYPE_CHECKING:
    import pandas as pd


def names(pier: Pier, base: RigidBase) -> list[str]:
    """Of all elements, in their order: "damper 1 left", "damper 1 right", "tendon 1"."""
    found, counts = [], {"damper": 0, "tendon": 0}
    for each in base.restraints:
        what = "damper" if isinstance(each, Damper) else "tendon"
        counts[what] += 1
        places = offsets(pier, each)
        sides = [""] if len(places) == 1 else [" left", " right"]
        found += [f"{what} {counts[what]}{side}" for side in sides]
    return found


def _elongation(of: Element, rows: np.recarray) -> tuple[Samples, Samples]:
    """Elongation [m] and its rate [m/s]: 2 d sin(|θ|/2) from the corner about which the block has turned."""
    theta, tilt = rows.theta, np.abs(rows.theta)
    d = np.where(theta > 0.0, of.from_right, of.from_left)
    return 2.0 * d * np.sin(0.5 * tilt), d * np.cos(0.5 * tilt) * np.sign(theta) * rows.omega


def _force(of: Element, rows: np.recarray, j: int) -> Samples:
    """[N/kg], positive in tension; of friction 0 where the block does not move."""
    elongation, speed = _elongation(of, rows)
    state = rows.state[:, j]
    if of.kind == FRICTION:
        return of.strength * np.sign(speed)
    if of.kind == HYSTERETIC:
        return of.strength * state
    if of.kind == TENDON:
        return np.clip(of.prestress + of.stiffness * (elongation - state), 0.0, of.strength)
    return of.coefficient * np.sign(speed) * np.abs(speed) ** of.exponent


def loops(pier: Pier, base: RigidBase, rows: np.recarray) -> "pd.DataFrame":
    """Force [N/kg] and elongation [m] of every element at every row."""
    import pandas as pd

    table = {"t": rows.t}
    for j, (of, name) in enumerate(zip(elements(pier, base), names(pier, base), strict=True)):
        table[f"{name} elongation"] = _elongation(of, rows)[0]
        table[f"{name} force"] = _force(of, rows, j)
    return pd.DataFrame(table)


def _stored(of: Element, rows: np.recarray, j: int) -> Samples:
    """Energy [J/kg] that a tendon gives back until it is slack."""
    if of.stiffness == 0.0:
        return of.prestress * _elongation(of, rows)[0]
    pull = _force(of, rows, j)
    return 0.5 * pull * pull / of.stiffness


def stored(pier: Pier, base: RigidBase, rows: np.recarray) -> Samples:
    """Energy [J/kg] that all tendons store, relative to the start."""
    laws = elements(pier, base)
    found = sum((_stored(of, rows, j) for j, of in enumerate(laws) if of.kind == TENDON), np.zeros(len(rows)))
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
