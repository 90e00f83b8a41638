"""Reasons and notes of runs, read back: each time, step and rotation in them is that of the runs of which they speak."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from messages import assert_states, said_by

import rockbatch as rb
from rockbatch.core.clock import WINDOWS
from rockbatch.outcome.outcome import Outcome
from rockbatch.simulation.agreement import Agreement
from rockbatch.simulation.chaos import without_error
from rockbatch.simulation.error_control import _not_converged, _with_notes
from rockbatch.simulation.leaning import noted_lean
from rockbatch.simulation.runs import Trial, cause_of_flight

G = 9.81
A = 3.0 * np.sin(0.05 * np.arange(400))
FALLING = rb.Motion("down", 0.01, A, -1.02 * G * np.sin(0.05 * np.arange(400)))
LIFTED = rb.Motion("up", 0.01, A, 0.4 * G * np.sin(0.05 * np.arange(400)))
LEVEL = rb.Motion("level", 0.01, A)


def flown(motion, omega_v, t_flight, t_impact, zeta=0.0):
    """Return why a pier left the ground, without the advice."""
    return lambda: cause_of_flight(motion, omega_v, G, t_flight, t_impact, zeta).partition("; ")[0]


def trial(status, substeps, **fields):
    """Return a run that came to this, the peak of which is in its first window."""
    fields = {"theta_max": 0.1, "t_end": 5.0, "impacts": 4, "separations": 4, "t_flight": None} | fields
    fields |= {"status": status, "reason": "", "t_max": 1.0, "theta_max_in_motion": fields["theta_max"]}
    peaks = fields.pop("peaks", [fields["theta_max"]])
    return Trial(Outcome(substeps=substeps, **fields), np.array([*peaks, *[0.0] * (WINDOWS - len(peaks))]))


def refused(coarse, fine, tolerance=1e-3, more="; longer"):
    """Return why a run has not settled."""
    return lambda: _not_converged(PIER, [coarse, fine], tolerance, more).reason


def noted(coarse, fine):
    """Return notes on what has not settled of a run that has."""
    return lambda: _with_notes(fine, coarse, Agreement.APART, np.full(WINDOWS, 1e-4), 0).note


PIER = rb.Pier(0.25, 1.0)
LEANT = SimpleNamespace(leans=True, lean=0.02, rocking_then=0.005, rocking=0.0075, t=3.456)
MESSAGES = {
    "a peak that has not settled": (
        refused(trial("ok", 4), trial("ok", 8, theta_max_error=3.4e-3, theta_res_error=2.1e-4), tolerance=4e-3),
        ["theta_max", 3.4e-3, "rad", 8.0, "substeps", "ok"],
    ),
    "peak and tilt that have not settled": (
        refused(trial("ok", 4), trial("ok", 16, theta_max_error=3.4e-3, theta_res_error=1.7e-3)),
        ["theta_max", 3.4e-3, "rad", "theta_res", 1.7e-3, "rad", 16.0, "substeps", "ok"],
    ),
    "a time of overturning": (
        refused(trial("overturned", 4, t_end=7.12), trial("overturned", 8, t_end=6.45)),
        ["overturning", 7.12, 6.45, "s", 8.0, "substeps", "overturned"],
    ),
    "a time of flight": (
        refused(trial("flight", 4, t_flight=2.125), trial("flight", 8, t_flight=3.375)),
        ["flight", 2.125, 3.375, "s", 8.0, "substeps", "flight"],
    ),
    "an outcome": (
        refused(trial("overturned", 4), trial("ok", 8)),
        ["from overturned to ok", 8.0, "substeps", "ok"],
    ),
    "counts": (
        noted(trial("ok", 4, impacts=9, separations=3), trial("ok", 8, impacts=7, separations=5)),
        ["impacts", 7.0, 9.0, "separations", 3.0, 5.0],
    ),
    "a first flight": (noted(trial("ok", 4), trial("ok", 8, t_flight=2.345)), ["flight", "none", 2.345, "s"]),
    "lesser rotations": (
        noted(trial("ok", 4, peaks=[0.1, 0.021, 0.033]), trial("ok", 8, peaks=[0.1, 0.02, 0.047])),
        [0.047, "rad"],
    ),
    "a peak that is lean": (
        lambda: noted_lean(trial("ok", 4).outcome, LEANT, 0.25).note,
        [0.08, "alpha", 0.02, "alpha", 0.03, "alpha", 3.46, "s"],
    ),
    "a chaotic peak": (
        lambda: without_error(trial("ok", 4, theta_max_error=1e-5).outcome, "a motion 1e-08 weaker overturns it").note,
        [1e-8, "weaker"],
    ),
    "ground that falls": (flown(FALLING, None, math.pi / 10.0, math.nan), [0.314, -1.02, "g"]),
    "flight after an impact": (flown(LEVEL, 40.0, 1.234, 1.2), [1.234, "s", 34.0, "ms"]),
    "flight by rocking": (flown(LEVEL, 40.0, 1.5, 1.2, 0.07), [1.5, "s", 40.0 / (2.0 * math.pi), "Hz", 7.0, "%"]),
    "flight by the ground": (
        flown(LIFTED, 40.0, 1.5, 1.2, 0.03),
        [1.5, "s", 40.0 / (2.0 * math.pi), "Hz", 3.0, "%", 1.0, "g", 2.5, "times", 0.4, "g"],
    ),
}


@pytest.mark.parametrize("name", MESSAGES)
def test_what_a_reason_names_is_what_it_speaks_of(name):
    call, expected = MESSAGES[name]
    assert_states(said_by(call), *expected)


def test_the_least_substeps_that_a_message_names_are_enough_and_one_less_is_not():
    pier, base = rb.Pier(0.2, 1.0), rb.ElasticBase(2000.0)
    said = said_by(lambda: rb.simulate(pier, base, LEVEL, substeps=3))
    least = int(said.partition("at least ")[2].split()[0])
    assert_states(said, "substeps", 3.0, least)
    assert "must be a whole number" in said_by(lambda: rb.simulate(pier, base, LEVEL, substeps=least - 1))
    assert rb.simulate(pier, base, LEVEL, substeps=least).status
