"""A flight is found at its moment and states its cause."""

import math

import numpy as np
import pytest
from core_samples import FIG5, half_sine

import rockbatch as rb
from rockbatch.motions.motion import Motion
from rockbatch.pier import ElasticBase, RigidBase
from rockbatch.simulation import run_fixed, run_to_tolerance
from rockbatch.simulation.runs import cause_of_flight


def test_flight_says_that_the_ground_fell_away():
    t = np.arange(101) * 0.01
    drop = Motion("drop", 0.01, np.zeros(101), np.where(t >= 0.2, -20.0, 0.0))
    for base in (RigidBase(flight="stop"), ElasticBase(50.0, flight="stop")):
        outcome = run_to_tolerance(FIG5, base, drop, 1e-4)
        assert outcome.status == "flight"
        assert "the ground fell away under the pier" in outcome.reason


def test_a_rigid_base_is_followed_to_the_moment_at_which_the_ground_falls_away():
    """v̈_g falls from 0 to −2 g between 0.4 and 0.5 s: flight near 0.45 s, where (F1) has no normal force left, in the middle
    of a sampling interval of one motion and close to a sample of the other, with the rotation of then."""
    peaks, times = [], []
    for dt in (0.1, 0.0125):
        t = np.arange(round(1.0 / dt) + 1) * dt
        vertical = -2.0 * 9.81 * np.clip((t - 0.4) / 0.1, 0.0, 1.0)
        motion = Motion("drop", dt, np.full(len(t), -0.5 * 9.81), vertical)
        outcome = run_fixed(FIG5, RigidBase(flight="stop"), motion, 8)
        end = rb.simulate(FIG5, RigidBase(flight="stop"), motion, substeps=8).history.iloc[-1]
        assert (outcome.status, outcome.t_flight) == ("flight", pytest.approx(0.45, abs=0.005))
        assert outcome.t_end == outcome.t_max == outcome.t_flight == end["t"]
        share, tilt, side = FIG5.mu / (1.0 + FIG5.mu), FIG5.alpha - abs(end["theta"]), math.copysign(1.0, end["theta"])
        pressed = (9.81 + end["ag_v"]) * (1.0 - share * math.sin(tilt) ** 2)
        pressed -= share * side * end["ag_h"] * math.sin(tilt) * math.cos(tilt)
        assert pressed == pytest.approx(FIG5.size * math.cos(tilt) * end["omega"] ** 2, abs=1e-9 * 9.81)
        peaks.append(outcome.theta_max)
        times.append(outcome.t_flight)
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-6)
    assert times[0] == pytest.approx(times[1], rel=1e-6)


def test_flight_says_that_the_undamped_oscillator_made_it_of_a_small_vertical_motion():
    """Resonance: 0.2 g at ω_v grows by π/2 times 0.2 g per half cycle until it lifts."""
    omega_v = 20.0
    t = np.arange(801) * 0.005
    shake = Motion("resonance", 0.005, np.zeros(801), 0.2 * 9.81 * np.sin(omega_v * t))
    outcome = run_to_tolerance(FIG5, ElasticBase(omega_v, flight="stop"), shake, 1e-4)
    assert outcome.status == "flight"
    assert (
        "vertical oscillator of 3.18 Hz, damping 0 %, reached 1 g, 5.0 times the ground's 0.20 g until then; see zeta"
        in outcome.reason
    )
    assert 'flight = "guided"' in outcome.reason


def test_flight_says_that_an_impact_threw_the_pier_up():
    """Within half a period of the vertical vibration, π/ω_v; a longer time after the impact it is the vibration."""
    still = Motion("still", 0.01, np.zeros(101))
    assert "thrown up 40 ms after an impact" in cause_of_flight(still, 20.0, 9.81, 0.54, 0.5)
    for t_impact in (0.3, math.nan):
        assert "vertical oscillator of 3.18 Hz, damping 0 %, excited by rocking" in cause_of_flight(
            still, 20.0, 9.81, 0.54, t_impact
        )


def test_a_flight_after_the_peak_is_final_changes_no_outcome():
    """Undamped vibration goes on after the record and may lift the pier at last: the longer the run, the likelier."""
    base, motion = ElasticBase(50.0, 0.2, flight="stop"), half_sine(0.3, 1.0, 0.5)
    short, long = (run_to_tolerance(FIG5, base, motion, 1e-4, quiet_s) for quiet_s in (0.5, 60.0))
    assert (short.status, long.status) == ("ok", "ok")
    assert long.theta_max == short.theta_max
    assert (long.t_flight is None) == ("flew at" not in long.note)
