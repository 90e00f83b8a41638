"""A run whose peak is decided may end before the pier's hardest landing: ``still_rocks`` says so (THEORY.md, Forces)."""

import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import rockbatch as rb
from rockbatch.checks.omissions import OMISSIONS, STILL_ROCKS
from rockbatch.common.units import GRAVITY

PIER = rb.Pier(alpha=0.13, p=0.35)
ELASTIC = rb.ElasticBase(60.0, epsilon=0.3)


def half_sine(amplitude: float) -> rb.Motion:
    """Return a half-sine of 1.5 s and ``amplitude`` [g], without zeros behind it."""
    return rb.Motion("half-sine", 0.01, amplitude * GRAVITY * np.sin(np.pi * np.arange(151) / 150.0))


def row(base, amplitude, quiet_s=2.0, pier=PIER):
    return rb.simulate(pier, base, half_sine(amplitude), forces=True, quiet_s=quiet_s).row


def test_a_block_that_has_not_landed_by_the_end_of_its_run_still_rocks():
    """Its landing, in a longer run, is that of free fall from its peak: ½ (I0/M + R0²) θ̇² = g R0 (cos(α − θ) − cos α)."""
    short, long = (row(rb.RigidBase(), 0.38, quiet_s) for quiet_s in (2.0, 20.0))
    assert short["theta_max_over_alpha"] == long["theta_max_over_alpha"] > 0.2
    assert (short["impacts"], short["still_rocks"], long["still_rocks"]) == (0, 1, 0)
    alpha, size = PIER.alpha, PIER.size
    theta = alpha * long["theta_max_over_alpha"]
    speed = math.sqrt(2.0 * GRAVITY * size * (math.cos(alpha - theta) - math.cos(alpha)) / PIER.inertia_about_pivot)
    assert long["landing_velocity_m_s"] == pytest.approx(2.0 * PIER.half_width * speed, rel=1e-7)


def test_a_pier_on_springs_still_rocks_for_a_period_after_its_peak():
    """With ε = 0.3 its second landing is 1.8 times as fast as the first, after which the run of 2 s ends."""
    short, long = (row(ELASTIC, 0.38, quiet_s) for quiet_s in (2.0, 20.0))
    assert (short["impacts"], short["still_rocks"], long["still_rocks"]) == (1, 1, 0)
    assert long["landing_velocity_m_s"] > 1.5 * short["landing_velocity_m_s"]
    assert long["normal_force_m_s2"] > 1.3 * short["normal_force_m_s2"]
    theta = long["theta_max_over_alpha"]
    period = 4.0 / PIER.p * math.acosh(1.0 / (1.0 - theta))
    for share, expected in ((0.99, 1), (1.01, 0)):
        quiet_s = long["t_max_s"] + share * period - 1.5
        assert row(ELASTIC, 0.38, quiet_s)["still_rocks"] == expected


def test_devices_may_bear_more_within_a_period_of_the_peak_of_a_pier_that_landed():
    base = rb.RigidBase(restraints=(rb.Damper("viscous", nu=0.1),))
    long = row(base, 0.38, 20.0)
    period = 4.0 / PIER.p * math.acosh(1.0 / (1.0 - long["theta_max_over_alpha"]))
    for share, expected in ((0.9, 1), (1.1, 0)):
        short = row(base, 0.38, long["t_max_s"] + share * period - 1.5)
        assert (short["impacts"] > 0, short["still_rocks"]) == (True, expected)


@pytest.mark.parametrize(
    ("base", "amplitude"),
    [
        (rb.RigidBase(), 0.05),
        (rb.RigidBase(), 0.26),
        (ELASTIC, 0.05),
        (rb.RigidBase(restraints=(rb.Damper("friction", f=0.7, confirm=("f",)),)), 0.46),
        (rb.YieldingBase(60.0, eta=3.0, spring="epp", epsilon=0.3), 0.38),
    ],
    ids=["at rest", "landed", "never left its springs", "held by friction", "down on yielding springs"],
)
def test_other_piers_do_not(base, amplitude):
    found = row(base, amplitude)
    assert (found["status"], found["still_rocks"]) == ("ok", 0)


@pytest.mark.slow
def test_a_bending_shaft_on_rigid_ground_still_rocks_for_a_period_after_its_peak():
    """It bends most after the landing at which the run of 2 s would end."""
    pier, bending = replace(PIER, flexural_period_s=0.4), rb.RigidBase(shaft="elastic", flexural_modes=1)
    short, long = (row(bending, 0.32, quiet_s, pier) for quiet_s in (2.0, 20.0))
    assert 0 < short["impacts"] < long["impacts"]
    assert (short["still_rocks"], long["still_rocks"]) == (1, 0)
    assert long["deflection_max_m"] > 1.5 * short["deflection_max_m"]


@pytest.mark.slow
def test_a_bending_shaft_still_rocks_with_both_feet_down():
    """The run ends in the landing, which bends the shaft most: by two fifths more."""
    pier, bending = rb.Pier(alpha=0.13, p=0.8, flexural_period_s=1.0), rb.RigidBase(shaft="elastic", flexural_modes=1)
    pulse = rb.Motion("half-sine", 0.01, 0.18 * GRAVITY * np.sin(np.pi * np.arange(101) / 100.0))
    short, long = (rb.simulate(pier, bending, pulse, quiet_s=quiet_s) for quiet_s in (0.5, 20.0))
    assert (short.theta[-1], short.row["still_rocks"], long.row["still_rocks"]) == (0.0, 1, 0)
    assert long.row["deflection_max_m"] > 1.35 * short.row["deflection_max_m"]


@pytest.mark.parametrize("base", [rb.RigidBase(), ELASTIC], ids=["rigid", "springs"])
def test_a_tail_of_40_over_p_decides_as_the_remark_on_checks_says(base):
    assert "quiet_s = 40/p" in OMISSIONS[STILL_ROCKS].remark
    for amplitude in (0.38, 0.405):
        assert row(base, amplitude)["still_rocks"] == 1
        assert row(base, amplitude, 40.0 / PIER.p)["still_rocks"] == 0


def test_an_overturned_pier_has_no_later_landing_to_tell():
    assert pd.isna(row(rb.RigidBase(), 1.0)["still_rocks"])


def test_no_period_longer_than_30_over_p_is_waited_for():
    """That of a free block is 39.6/p at 0.9999 α, and infinite from α on; here a tendon turns the pier back."""
    tied = replace(ELASTIC, restraints=(rb.Tendon(psi=0.1, lam=2.0),))
    pier = replace(PIER, initial_rotation_rad=0.9999 * PIER.alpha)
    found = rb.simulate(pier, tied, rb.Motion("still", 0.01, np.zeros(101)), substeps=8).row
    assert 31.0 < (found["t_end_s"] - found["t_max_s"]) * PIER.p < 39.0
    assert found["still_rocks"] == 0
