"""The Taylor series that the survey of the rigid base leans on: zeros of polynomials, known motions, another reference.

Values of motions come from another event-driven solver (known_flights.py).
"""

import importlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from known_flights import KNOWN_PEAKS, MOTIONS, PIER

from rockbatch.motions import Motion, read_motions
from rockbatch.pier import Pier, RigidBase
from rockbatch.simulation import Run, Stop, run_all_to_tolerance

pytestmark = pytest.mark.thorough  # compiles the reference, which hardly ever changes
BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def independent():
    """Imports a module of the references, as a script beside them would."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(BENCHMARKS))
        yield lambda name: importlib.import_module(f"independent.{name}")


@pytest.fixture(scope="module")
def taylor(independent):
    return independent("taylor")


@pytest.mark.parametrize("c", [1e-3, 1e-6, 1e-12])
def test_a_hop_is_seen_however_short_it_is(taylor, c):
    """x (c − x) (½ − x) falls at x = c and rises at ½."""
    poly = np.zeros(taylor.COLUMNS)
    poly[1:4] = 0.5 * c, -(0.5 + c), 1.0
    assert taylor.first_fall(poly, 1.0, taylor.room()) == pytest.approx(c, rel=1e-12)


def test_a_dip_that_stays_above_zero_is_no_fall(taylor):
    poly = np.zeros(taylor.COLUMNS)
    poly[:3] = 0.25 + 1e-12, -1.0, 1.0  # (½ − x)² + 1e-12
    assert taylor.first_fall(poly, 1.0, taylor.room()) == -1.0


@KNOWN_PEAKS
def test_known_flights_reach_their_rotation(taylor, name, height, theta_max, t_max):
    truth = taylor.truth(PIER, RigidBase(), MOTIONS[name])
    assert (truth.status, truth.flights, truth.decided) == ("stands", 1, True)
    assert truth.theta_max / 0.2 == pytest.approx(theta_max, abs=6e-10)
    assert truth.t_max == pytest.approx(t_max, abs=6e-7)


def test_a_lift_off_by_a_hair_is_an_arc_of_cubics(taylor):
    """The ground passes g tan α by 10⁻⁶ of it: weight does not change over so small a tilt."""
    pier, dt, excess = Pier(0.25, 0.5), 0.01, 1e-6
    motion = Motion("hair", dt, pier.gravity * np.tan(pier.alpha) * np.array([0.6, 1.0 + excess, 0.9, 0.5]))
    most = pier.p**2 * np.sin(pier.alpha) * excess  # θ̈ at the sample; from there on it falls
    before, fall = excess / (0.4 + excess) * dt, most / excess * (0.1 + excess) / dt
    omega, theta = 0.5 * most * before, most * before**2 / 6
    t = (most + np.sqrt(most**2 + 2 * fall * omega)) / fall
    peak = theta + omega * t + most * t**2 / 2 - fall * t**3 / 6
    truth = taylor.truth(pier, RigidBase(), motion)
    assert truth.theta_max == pytest.approx(peak, rel=1e-7)


def test_two_references_that_share_no_code_agree(independent, taylor):
    """To 10⁻⁹ α, but where a motion 10⁻¹² stronger moves the peak by more: that is chaos."""
    cases, reference, compared = independent("pool").cases, independent("reference").reference, 0
    for stratum in ("rigid pulses", "rigid noise", "rigid slender noise", "flight pulses", "flight noise"):
        for case in cases(None, 3, stratum)[:10]:
            base, within = replace(case.base, flight="guided"), 1e-9 * case.pier.alpha
            one, near = (taylor.truth(case.pier, base, case.motion, factor) for factor in (1.0, 1.0 + 1e-12))
            if abs(near.theta_max - one.theta_max) <= within:
                other = reference(case.pier, base, case.motion)
                assert one.status == other.status
                assert one.status == "overturned" or abs(one.theta_max - other.theta_max) <= within
                compared += 1
    assert compared > 40


def test_changed_motions_do_not_show_a_window_between_them(taylor):
    """A pier that comes to rest forgets its motion; here it is lifted first, but only under motions 3 to 7·10⁻⁹ stronger."""
    motion = read_motions([], fema=[("LCN", 260.0)]).motions[0]
    pier, base = Pier(0.13, 0.43), RigidBase(0.9375)
    outcome = run_all_to_tolerance([Run(pier, base, motion)], 1e-4, 2.0, Stop())[0]
    assert outcome is not None
    peaks = {change: taylor.truth(pier, base, motion, 1.0 + change).theta_max for change in (-1e-8, 0.0, 3e-9, 1e-8)}
    assert abs(peaks[0.0] - outcome.theta_max) <= outcome.theta_max_error
    assert [abs(peaks[change] / outcome.theta_max - 1.0) < 1e-7 for change in peaks] == [True, True, False, True]
    assert peaks[3e-9] == pytest.approx(0.9 * peaks[0.0], rel=0.01)
