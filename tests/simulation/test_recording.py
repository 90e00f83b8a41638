"""One history of a run serves all observers: that of every step has in it those at samples, and that of a longer quiet time."""

import numpy as np
import pytest

from rockbatch.motions import Motion
from rockbatch.pier import Damper, ElasticBase, Pier, RigidBase, YieldingBase
from rockbatch.simulation import Run, run_fixed
from rockbatch.simulation.recording import recorded

PIER = Pier(0.2, 1.0)
BASES = {
    "rigid": RigidBase(),
    "damped": RigidBase(restraints=(Damper("friction", f=0.1, at="left"),)),
    "elastic": ElasticBase(60.0, 0.2, flight="guided"),
    "yielding": YieldingBase(50.0, 0.1, eta=2.0, flight="guided"),
}


@pytest.fixture(params=BASES)
def run(request):
    noise = np.random.default_rng(3).normal(size=(2, 300))
    return Run(PIER, BASES[request.param], Motion("noise", 0.01, 5.0 * noise[0], 3.0 * noise[1]))


def test_the_history_of_every_step_without_its_steps_is_that_at_samples_to_the_bit(run):
    outcome = run_fixed(run.pier, run.base, run.motion, 8, 1.0)
    every, samples = (recorded(run, outcome, 1.0, every_step=steps) for steps in (True, False))
    assert len(every.rows) > 2 * len(samples.rows)
    assert every.at_samples.rows.tobytes() == samples.rows.tobytes() == samples.at_samples.rows.tobytes()


def test_a_longer_quiet_time_leaves_the_history_of_a_run_the_same_to_the_bit(run):
    outcome = run_fixed(run.pier, run.base, run.motion, 8, 1.0)
    own, longer = (recorded(run, outcome, quiet_s, every_step=True) for quiet_s in (1.0, 30.0))
    assert longer.rows.t[-1] > own.rows.t[-1]
    assert longer.until(outcome.t_end).rows.tobytes() == own.rows.tobytes()
