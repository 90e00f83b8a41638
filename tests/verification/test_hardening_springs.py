"""Springs that harden, against solvers that share no code with the core: random hard cases, and a real record.

The loops are held in test_ratchet.py, figures of the paper with this law in test_against_reference.py.
"""

import importlib
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from core_samples import FIG5, TOWER, hard_case, pulse
from reference_solver import TwoSprings, reference

import rockbatch as rb
from rockbatch.motions.motion import Motion
from rockbatch.pier import YieldingBase
from rockbatch.simulation import run_fixed, run_to_tolerance

ROOT = Path(__file__).parents[2]
QUIET_S = 1.0


def settlement(pier, base, motion, quiet_s):
    """Return the settlement [m] at the end by the reference solver."""
    solver = TwoSprings(pier, base, motion, quiet_s)
    unstressed = solver.v0 - solver.dy * solver.z0
    run = solver.run()
    return unstressed - 0.5 * (run.base_left + run.base_right), solver.dy


def hardening_case(seed):
    """Return a random hard case on hardening springs, of odd seeds on damped supports."""
    pier, base, motion = hard_case(seed, npts=250)
    damping = {"epsilon": 0.0, "zeta": (0.02, 0.1, 0.5)[seed // 2 % 3]} if seed % 2 else {}
    return pier, replace(base, spring="hardening", **damping) if isinstance(base, YieldingBase) else base, motion


def drawn(seeds, kinds):
    """Return ``seeds`` of yielding bases whose kernels fast tests compile ("common"), or of the others."""
    found = {"common": [], "others": []}
    for seed in seeds:
        _, base, _ = hardening_case(seed)
        if isinstance(base, YieldingBase):
            other_n, finite = base.n != 5.0, base.kinematics == "finite"
            kind = "others" if other_n or finite else "common"
            found[kind].append(seed)
    return found[kinds]


@pytest.mark.parametrize(
    "seeds",
    [
        pytest.param(drawn(range(20), "common"), id="common"),
        pytest.param(drawn(range(20, 60), "common"), id="common, more", marks=pytest.mark.slow),
        pytest.param(drawn(range(60), "others"), id="others", marks=pytest.mark.thorough),
    ],
)
def test_random_hard_cases_agree_with_the_reference(seeds):
    """Status, peak to the tolerance of 1e-6 α, impacts, and settlement when the core reads it to 1e-5 of itself and of δ_y; every
    other case on damped supports. 1e-9 α is the reference's own error."""
    compared = 0
    for seed in seeds:
        pier, base, motion = hardening_case(seed)
        converged = run_to_tolerance(pier, base, motion, 1e-6, QUIET_S)
        if converged.status != "ok":
            continue  # where an overturning pier stops is a matter of definition
        outcome = run_fixed(pier, base, motion, converged.substeps, QUIET_S, wait=False)
        expected = reference(pier, base, motion, QUIET_S)
        assert outcome.status == expected.status == "ok", seed
        assert outcome.theta_max == pytest.approx(expected.theta_max, rel=0, abs=1e-6 * pier.alpha), seed
        error = abs(converged.theta_max - expected.theta_max)
        assert error <= converged.theta_max_error + 1e-9 * pier.alpha or outcome.theta_max != converged.theta_max, seed
        assert outcome.impacts == expected.impacts, seed
        sunk, yield_deflection = settlement(pier, base, motion, outcome.t_read - (motion.npts - 1) * motion.dt)
        assert outcome.settlement == pytest.approx(sunk, rel=1e-5, abs=1e-5 * yield_deflection), seed
        compared += 1
    assert compared >= len(seeds) / 2


def test_yield_points_go_on_through_flights_and_landings():
    """A vertical pulse that throws the pier up, and half of it again: on hardening springs it yields once.

    At one number of steps: which is enough is a matter of its rotation, here no more than rounding.
    """
    t = np.arange(801) * 0.005
    kick = 14.0 * np.sin(2 * math.pi * t / 0.15) * (t < 0.15)
    found = {}
    for spring in ("bouc-wen", "hardening"):
        base = YieldingBase(50.0, eta=3.0, zeta=0.1, spring=spring)
        for name, vertical in (("once", kick), ("twice", np.concatenate([kick, 0.5 * kick]))):
            motion = Motion(name, 0.005, np.zeros(len(vertical)), vertical)
            found[spring, name] = run_fixed(FIG5, base, motion, 16)
    once, twice = found["hardening", "once"], found["hardening", "twice"]
    assert twice.flights > once.flights > 0
    assert once.settlement > 0.0
    assert twice.settlement == pytest.approx(once.settlement, rel=1e-9)
    assert found["bouc-wen", "twice"].settlement > 1.02 * found["bouc-wen", "once"].settlement


@pytest.mark.thorough
def test_a_real_record_agrees_with_a_solver_of_first_order(monkeypatch):
    """Rinaldi with its vertical, pads of 30 MN: benchmarks/spring_laws.py, whose steps of 20 µs are good to 1e-3."""
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    module = importlib.import_module("spring_laws")
    motion = rb.read_motions(ROOT / "motions" / "near_fault").motions[0]
    base = YieldingBase.from_stiffness(module.PIER, **module.PADS, spring="hardening")
    here = run_to_tolerance(module.PIER, base, motion, 1e-4)
    ground = [np.append(a, np.zeros(round(module.QUIET_S / motion.dt))) for a in (motion.horizontal, motion.vertical)]
    law = module.LAWS.index("hardening")
    sunk, theta = module.settled(module.model(base, law), *ground, float(motion.dt), math.ceil(motion.dt / module.STEP))
    assert here.settlement == pytest.approx(sunk, rel=2e-3)
    assert here.theta_max == pytest.approx(theta, rel=2e-3)


def test_strong_springs_hardly_harden():
    """η = 10⁴: plasticity of order (1/η)⁵, so the peak is that of Bouc–Wen springs to rounding."""
    motion = pulse("sine", 1.5, 0.5, dt=0.01, end=4.0)
    peaks = [
        run_fixed(
            TOWER, YieldingBase(50.0, 0.4, eta=1e4, spring=spring, confirm=("eta",)), motion, 8, 0.0, wait=False
        ).theta_max
        for spring in ("bouc-wen", "hardening")
    ]
    assert peaks[1] == pytest.approx(peaks[0], abs=1e-8 * TOWER.alpha)
