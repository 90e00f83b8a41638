"""A pier on a footing against what does not share its code: two springs, another solver on random cases, OpenSees, energy."""

import importlib.util
import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from footing_reference import Foot, solve
from footing_runs import model_of, run

import rockbatch as rb
from rockbatch.observers.energy_balance.observe import energies
from rockbatch.simulation import Run, run_fixed
from rockbatch.simulation.recording import recorded

DT = 0.01
BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
SPEC = importlib.util.spec_from_file_location("opensees_footing", BENCHMARKS / "opensees_footing.py")
assert SPEC is not None
assert SPEC.loader is not None
OPENSEES = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(OPENSEES)
TABLE = pd.read_csv(BENCHMARKS / "opensees_footing.csv", index_col="case")


def one_sine(amplitude, period, seconds):
    """One cycle of a sine, then nothing."""
    return rb.pulse("sine", name="one-sine", amplitude=amplitude, period=period, dt=DT, duration=seconds)


@pytest.mark.thorough
@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
@pytest.mark.parametrize("law", ["elastic", "yielding", "damped"])
def test_two_strips_at_the_pivots_do_what_two_springs_do(kinematics, law):
    """With the lever of two springs; strips of a millionth of the width, small steps for there are no events.

    The lever follows the strips that push. If it followed those with a deflection, it would shift 2ζ/ω_v late at a lift-off from
    dashpots, the term H H′ ω² of finite kinematics with it, and the damped peak would be off by 5e-7 α at ζ = 0.1, as ζ.
    """
    pier, beta = rb.Pier.from_size(0.2, 15.3, 3.0), 40.0
    bases = {
        "elastic": rb.ElasticBase(beta, 1.0, kinematics),
        "yielding": rb.YieldingBase(beta, 1.0, kinematics, eta=2.5, spring="epp"),
        "damped": rb.ElasticBase(beta, kinematics=kinematics, zeta=0.1),
    }
    motion, omega_v = one_sine(3.0, 0.5, 1.2), beta * pier.p
    springs = run_fixed(pier, bases[law], motion, 64, quiet_s=0.0, wait=False)
    foot = Foot(
        2.0 * pier.half_width, pier.height, pier.inertia, pier.gravity / omega_v**2, 2.5 if law == "yielding" else math.inf,
        0.1 if law == "damped" else 0.0, finite=kinematics == "finite",
    )  # fmt: skip
    strips = model_of(foot, shifting=True, gap=1e-6)
    result = run(strips, motion.horizontal, DT, 256)[0]
    assert abs(result.theta_max - springs.theta_max) < 1e-9 * pier.alpha
    assert result.t_max == pytest.approx(springs.t_max, abs=1e-6)


def random_case(number):
    """A Foot and its motion: one to three half sines of random strength, sometimes with a vertical one."""
    random = np.random.default_rng(number)
    height = random.uniform(8.0, 30.0)
    width = height * random.uniform(0.25, 0.6)
    inertia = height**2 * random.uniform(0.25, 0.5)
    stiff = 12.0 * height / width**2  # 1/δ_s below which it topples
    foot = Foot(
        width, height, inertia, random.uniform(0.05, 0.6) / stiff, random.choice([1.5, 2.0, 3.0, 10.0, math.inf]),
        random.choice([0.0, 0.05, 0.2]), 8, bool(random.integers(2)),
    )  # fmt: skip
    t, period = np.arange(0.0, 1.5, DT), random.uniform(0.3, 1.0)
    horizontal = 9.81 * width / height * random.uniform(0.5, 5.0) * np.sin(2.0 * np.pi * t / period) * (t < period)
    vertical = random.choice([0.0, 4.0, 12.0]) * np.sin(2.0 * np.pi * t / (0.3 * period)) * (t < period)
    return foot, horizontal, vertical


@pytest.mark.thorough
@pytest.mark.parametrize("number", range(60))
def test_random_cases_come_to_what_another_solver_does(number):
    """Status, peak, end, sets: relative to the peak and to the settlement at rest, by steps of ω_v h below 0.02."""
    foot, horizontal, vertical = random_case(number)
    substeps = max(4, math.ceil(math.sqrt(foot.stiffness) * DT / 0.02))
    reference = solve(foot, horizontal, vertical, DT, rtol=1e-9)
    result = run(model_of(foot), horizontal, DT, substeps, vertical)[0]
    assert (result.status == 1) == reference.overturned
    if reference.overturned:
        return
    assert result.theta_max == pytest.approx(reference.theta_max, rel=1e-4)
    assert result.theta_end == pytest.approx(reference.y[1], abs=1e-4 * reference.theta_max)
    for edge, plastic in ((result.base_left, reference.plastic[0]), (result.base_right, reference.plastic[-1])):
        assert edge == pytest.approx(plastic, abs=1e-4 * max(foot.settlement, plastic))
    assert result.bed_force == pytest.approx(reference.force_max, rel=0.02)


@pytest.mark.sweep(slow=3)
@pytest.mark.slow
@pytest.mark.parametrize("name", list(TABLE.index))
def test_peaks_on_a_bed_are_those_of_opensees(name):
    """What parts them: OpenSees has 80 points for strips, and Newmark's steps, extrapolated."""
    case = OPENSEES.cases()[name]
    outcome = run_fixed(case.pier, case.base, case.motion, 16, quiet_s=0.0, wait=False)
    peak = TABLE.loc[name, "theta_max_over_alpha"]
    assert outcome.theta_max_in_motion / case.pier.alpha == pytest.approx(peak, rel=2e-3)


def remainder(base, amplitude, substeps):
    """Greatest remainder of the energy balance over the greatest kinetic energy."""
    pier = rb.Pier.from_size(0.25, 15.0, 3.0)
    case = Run(pier, base, one_sine(amplitude, 0.7, 2.0))
    outcome = run_fixed(pier, base, case.motion, substeps, quiet_s=0.5)
    terms = energies(case, recorded(case, outcome, 0.5, True).rows)
    return np.abs(terms[:, -1]).max() / terms[:, 0].max()


@pytest.mark.sweep(slow=3)
@pytest.mark.slow
@pytest.mark.parametrize("zeta", [0.0, 0.05])
@pytest.mark.parametrize("safety", [1.5, 3.0, None])
def test_energy_balance_closes_with_smaller_steps_through_uplift_and_yield(zeta, safety):
    """What remains is of the steps, without location of where a node begins to yield; the plastic work adds nothing."""
    base = rb.FootingBase(60.0, safety, zeta=zeta)
    assert remainder(base, 4.0, 2) < 1e-5
    assert remainder(base, 4.0, 64) < 5e-9
    assert remainder(base, 4.0, 1024) < (1e-11 if zeta == 0.0 else 2e-11)


@pytest.mark.slow
@pytest.mark.parametrize("zeta", [0.0, 0.05])
def test_energy_balance_of_an_elastic_bed_in_full_contact_closes_to_rounding(zeta):
    assert remainder(rb.FootingBase(60.0, zeta=zeta), 0.1, 32) < 1e-12
