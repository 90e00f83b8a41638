"""How much settlement is the law's own: rockbatch's three spring laws beside another whose loops close.

    python benchmarks/spring_laws.py

Bouc–Wen springs yield in every reloading. Two laws with the same first loading do not: its curve with elastic unloading and
reloading up to where it was left, as in plasticity with hardening, and an Iwan chain of elastic–plastic elements in parallel,
which follows Masing's rule. The last is here only, in a solver of its own (symplectic Euler, steps of 20 µs, first-order
kinematics, supports with ζ, so that no landing has an impulse), which takes rockbatch's laws too, to be held against it.

The pier of configs/first_study.toml on pads of 30 MN with ζ = 0.05, under the ten components of motions/near_fault; and what a
cycle of ±30 % about the weight adds to the settlement at rest, over δ_s (η = 2.5), which for Bouc–Wen is 0.821 %.
"""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.integrate import solve_ivp

import rockbatch as rb
from rockbatch.pier import YieldingBase, vertical_frequency, yield_deflection

LAWS = ("bouc-wen", "epp", "hardening", "iwan")
BOUC_WEN, EPP, HARDENING, IWAN = range(4)
RECORDS = Path(__file__).parents[1] / "motions" / "near_fault"
PIER = rb.Pier.with_deck(width_m=8.0, height_m=30.0, mass_t=2000.0, deck_mass_t=1000.0)
PADS = {"stiffness_kN_m": 2e6, "yield_kN": 30e3, "zeta": 0.05}
STEP = 2e-5
QUIET_S = 2.0
ELEMENTS = 24
N = 5.0


class Model(NamedTuple):
    """A pier on two damped supports, per unit mass; ``chain`` has the stiffness and the yield deflection of each element."""

    half_width: float
    height: float
    inertia: float
    gravity: float
    yield_deflection: float
    yield_force: float
    damping: float
    law: int
    chain: np.ndarray


def chain() -> np.ndarray:
    """Elements along the first loading of Bouc–Wen, shape (ELEMENTS, 2): shares of the stiffness, and deflections over δ_y."""
    at = np.concatenate(([0.0], np.geomspace(0.3, 3.0, ELEMENTS)))
    curve = solve_ivp(lambda u, z: 1.0 - z**N, (0.0, at[-1]), [0.0], t_eval=at, rtol=1e-10, atol=1e-12).y[0]
    slopes = np.append(np.diff(curve) / np.diff(at), 0.0)
    return np.column_stack((-np.diff(slopes), at[1:]))


@njit
def pressed(m, spring, d):
    """Take a ``spring``, its z, the furthest z and the elements' deflections, by ``d`` δ_y upwards."""
    z = spring[0]
    if m.law == IWAN:
        z = 0.0
        for j in range(len(m.chain)):
            spring[2 + j] = min(max(spring[2 + j] + d, -m.chain[j, 1]), m.chain[j, 1])
            z += m.chain[j, 0] * spring[2 + j]
    elif m.law == EPP:
        z = max(z + d, -1.0)
    elif d > 0.0 or (m.law == HARDENING and z + d > spring[1]):
        z += d
    else:
        elastic = min(spring[1] - z, 0.0) if m.law == HARDENING else 0.0
        z += elastic + (d - elastic) * (1.0 - abs(z + elastic) ** N)
    spring[0], spring[1] = z, min(spring[1], z)


@njit
def at_rest(m, springs):
    """Press both springs until they bear the weight, and return the deflection [m]."""
    sunk = 0.0
    while -springs[0, 0] * m.yield_force < 0.5 * m.gravity:
        pressed(m, springs[0], -1e-4)
        sunk += 1e-4 * m.yield_deflection
    springs[1] = springs[0]
    return sunk


@njit
def settled(m, horizontal, vertical, dt, parts):
    """Return the settlement [m] and the greatest |θ| [rad] after a motion given at samples ``dt`` s apart."""
    springs, free, where = np.zeros((2, 2 + len(m.chain))), np.zeros(2), np.zeros(2)
    sunk = at_rest(m, springs)
    where[:] = -sunk
    start = -sunk - m.yield_deflection * springs[0, 0]
    v, v_rate, theta, omega, most, h = -sunk, 0.0, 0.0, 0.0, 0.0, dt / parts
    decay = 1.0 - math.exp(-h * m.yield_force / (m.damping * m.yield_deflection))
    for s in range((len(horizontal) - 1) * parts):
        i, w = s // parts, (s % parts + 0.5) / parts
        force, moment = 0.0, 0.0
        for k in range(2):
            side = 1.0 - 2.0 * k
            if free[k] == 0.0:
                f = min(m.yield_force * springs[k, 0] + m.damping * (v_rate + side * m.half_width * omega), 0.0)
                force += f
                moment -= f * (side * m.half_width + m.height * theta)
        lever = m.height + m.half_width * theta * (free[0] - free[1])
        v_rate -= h * (m.gravity + (1.0 - w) * vertical[i] + w * vertical[i + 1] + force)
        omega += h * (moment - lever * ((1.0 - w) * horizontal[i] + w * horizontal[i + 1])) / (m.inertia + m.height**2)
        v, theta = v + h * v_rate, theta + h * omega
        most = max(most, abs(theta))
        for k in range(2):
            side = 1.0 - 2.0 * k
            pivot = v + side * m.half_width * theta
            if free[k] == 0.0:
                pressed(m, springs[k], (pivot - where[k]) / m.yield_deflection)
                where[k] = pivot
                leaves = m.yield_force * springs[k, 0] + m.damping * (v_rate + side * m.half_width * omega) >= 0.0
                free[k] = 1.0 if leaves else 0.0
            else:  # the support creeps back, and meets its pivot
                back = -springs[k, 0] * decay
                pressed(m, springs[k], back)
                where[k] += back * m.yield_deflection
                free[k] = 0.0 if pivot <= where[k] else 1.0
    unstressed = where - m.yield_deflection * springs[:, 0]
    return start - 0.5 * (unstressed[0] + unstressed[1]), most


def model(base: YieldingBase, law: int) -> Model:
    """Return ``PIER`` on pads like ``base`` with another law."""
    assert base.zeta
    return Model(
        float(PIER.half_width), float(PIER.height), float(PIER.inertia), PIER.gravity, float(yield_deflection(PIER, base)),
        0.5 * base.eta * PIER.gravity, base.zeta * vertical_frequency(PIER, base), law, chain(),
    )  # fmt: skip


def per_cycle(law: int, eta: float = 2.5, swing: float = 0.3, cycles: int = 10) -> float:
    """Return what a slow cycle of the force about the weight adds to the settlement, over δ_s: the last of some."""
    m = model(YieldingBase(50.0, eta=eta, zeta=0.05), law)
    spring, at, turns = np.zeros(2 + ELEMENTS), 0.0, []
    for target in [-(1.0 + swing) / eta, *[-(1.0 - swing) / eta, -(1.0 + swing) / eta] * cycles]:
        d = -1e-5 if target < spring[0] else 1e-5
        while (spring[0] - target) * d < 0.0:
            pressed(m, spring, d)
            at += d
        turns.append(at - (spring[0] - target))
    return (turns[-3] - turns[-1]) * eta


def main() -> None:
    """Print both tables."""
    print("| law | a cycle of ±30 % |\n| --- | --- |")
    for law, name in enumerate(LAWS):
        print(f"| {name} | {100.0 * per_cycle(law):.3f} % |")
    print("\nSettlement [mm] and θ_max/α\n\n| record | " + " | ".join(("rockbatch", "", "", *LAWS)) + " |")
    print("| --- |" + " --- |" * 7)
    for motion in rb.read_motions(RECORDS).motions:
        cells = []
        for law in LAWS[:IWAN]:
            base = YieldingBase.from_stiffness(PIER, **PADS, spring=law)
            row = rb.simulate(PIER, base, motion).row
            cells.append((row["settlement_m"], row["theta_max_over_alpha"]))
        ground = [np.append(a, np.zeros(int(QUIET_S / motion.dt))) for a in (motion.horizontal, motion.vertical)]
        for law in range(4):
            found = settled(model(base, law), *ground, float(motion.dt), math.ceil(motion.dt / STEP))
            cells.append((found[0], found[1] / PIER.alpha))
        print(
            f"| {motion.name} | " + " | ".join(f"{1000 * s:.1f} ({theta:.4f})" for s, theta in cells) + " |", flush=True
        )


if __name__ == "__main__":
    main()
