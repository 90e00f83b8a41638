"""Whole rows of piers with devices on rigid ground against a simulator in plain Python, within the errors that rows claim.

Random piers under one motion or three with pauses between them, with vertical components, near overturning, flying, sticking.
"""

import math

import numpy as np
import pytest
from tied_block_reference import TiedBlock

import rockbatch as rb
from rockbatch.common.units import GRAVITY
from rockbatch.motions.motion import Motion

pytestmark = pytest.mark.thorough


def power(rng, low, high):
    """A random number, uniform in its logarithm."""
    return float(10.0 ** rng.uniform(low, high))


DRAWN = {
    "oil": lambda rng, at: rb.Damper(
        "viscous", nu=power(rng, -1.5, -0.5), exponent=float(rng.uniform(0.3, 1.8)), at=at
    ),
    "steel": lambda rng, at: rb.Damper(
        "hysteretic", f=float(rng.uniform(0.02, 0.3)), yield_m=power(rng, -3.0, -2.0), at=at
    ),
    "rubs": lambda rng, at: rb.Damper("friction", f=power(rng, -1.7, -0.3), at=at),
    "braced steel": lambda rng, at: rb.Damper(
        "hysteretic",
        f=float(rng.uniform(0.02, 0.3)),
        yield_m=power(rng, -3.0, -2.0),
        brace=power(rng, -1.0, 0.7),
        at=at,
    ),
    "braced oil": lambda rng, at: rb.Damper("viscous", nu=power(rng, -1.0, -0.3), brace=power(rng, -1.5, -0.5), at=at),
    "tendon": lambda rng, at: rb.Tendon(psi=float(rng.uniform(0.0, 0.2)), lam=power(rng, -1.0, 0.3), strength=0.3),
    "stop": lambda rng, at: rb.Stop(
        power(rng, -2.5, -1.2), lam=power(rng, 0.0, 1.2), restitution=float(rng.uniform(0.3, 1))
    ),
    "abutment": lambda rng, at: rb.DeckSpring(lam=power(rng, -1.5, 0.0), gap_m=power(rng, -2.5, -1.2), restitution=0.6),
    "band": lambda rng, at: rb.DeckSpring(lam=power(rng, -1.5, -0.3)),
}
"""Devices at random; "at" says where dampers are."""

FAMILIES = {
    "bare": ((), 0.3), "oil": (("oil",), 0.2), "steel": (("steel",), 0.2), "friction": (("rubs",), -0.3),
    "friction and stop": (("rubs", "stop"), -0.3), "braced steel": (("braced steel",), 0.1), "braced oil": (("braced oil",), 0.1),
    "tendon": (("tendon",), 0.2), "stop": (("stop",), 0.1), "deck": (("abutment", "steel"), 0.1), "band": (("band",), 0.2),
}  # fmt: skip
"""Kinds of devices, and the logarithm of the greatest vertical acceleration over g."""


def shaken(rng, alpha, upwards, shocks):
    """Shocks of 3 s, of a single sine or of many, with 2 s between them."""
    dt, t = 0.01, np.arange(300) * 0.01
    horizontal, vertical = [], []
    for _ in range(shocks):
        packet, many = np.exp(-(((t - 1.2) / 0.7) ** 2)), rng.random() < 0.5
        rates = 10.0 ** rng.uniform(-0.4, 0.7 if many else 0.3, 10 if many else 1)
        wave = sum(np.sin(2.0 * math.pi * (f * t + rng.random())) for f in rates) / (3.0 if many else 1.0)
        rises = sum(np.sin(2.0 * math.pi * (f * t + rng.random())) for f in 10.0 ** rng.uniform(0.0, 1.0, 8)) / 3.0
        horizontal += [GRAVITY * math.tan(alpha) * power(rng, 0.0, 0.5) * wave * packet, np.zeros(200)]
        vertical += [GRAVITY * power(rng, -1.0, upwards) * rises * packet, np.zeros(200)]
    return Motion("shaken", dt, np.concatenate(horizontal), np.concatenate(vertical))


def drawn(family, seed):
    """A pier, its base and a motion; every third motion has three shocks."""
    kinds, upwards = FAMILIES[family]
    rng = np.random.default_rng([sum(map(ord, family)), seed])
    alpha, mu = float(rng.uniform(0.1, 0.3)), float(rng.uniform(2.5, 4.5))
    pier = rb.Pier(alpha=alpha, p=float(rng.uniform(0.6, 1.8)), mu=mu, confirm=("mu", "p"))
    at = [None, "left", 0.0][seed % 3]
    base = rb.RigidBase(restraints=tuple(DRAWN[kind](rng, at) for kind in kinds))
    return pier, base, shaken(rng, alpha, upwards, 3 if seed % 3 == 2 else 1)


def allowed(row, name, value):
    """Greatest difference from the reference, whose steps err by 3·10⁻⁴ of a work and miss as much of a force between them.

    Bounces before a rest are counted to a twentieth.
    """
    if name in ("theta_max_over_alpha", "t_max_s"):
        return 1e-3 if name == "t_max_s" else row["theta_max_error"] + 1e-7
    if name == "impacts":
        return 0.05 * value + 0.5
    if name in ("separations", "flights", "tendon_slack") or name.endswith("_blows"):
        return 0.0
    if name.startswith("flight"):
        return 1e-5 if name.endswith("_s") else 1e-5 * value + 1e-8
    claimed = row.get("forces_error" if name.endswith("m_s2") else "devices_error", math.inf)
    return (claimed + (5e-4 if name.endswith("m_s2") else 3e-4)) * value + 1e-6 + 0.01 * claimed


@pytest.mark.parametrize("family", FAMILIES)
def test_rows_are_those_of_plain_python_within_their_errors(family):
    compared = 0
    for seed in range(9):
        pier, base, motion = drawn(family, seed)
        row = rb.simulate(pier, base, motion, forces=True, devices_work=bool(base.restraints), quiet_s=1.0).row
        if row["chaotic"] == 1 or row["status"] == "failed":
            continue
        expected = TiedBlock(pier, base, motion, row["t_end_s"]).row
        assert row["status"] == expected.pop("status"), seed
        compared += 1
        for name, value in expected.items() if row["status"] == "ok" else ():
            if name in row and np.isfinite(row[name]):
                difference = abs(row[name] - value)
                assert difference <= allowed(row, name, abs(value)), f"{seed}, {name}: {row[name]}, there {value}"
    assert compared >= 6
