"""The pass over lanes of piers whose shaft bends: all are taken event by event, with deflections that vibrate."""

from rockbatch.core import system
from rockbatch.core.clock import EVENTFUL
from rockbatch.core.flexure.model import FlexibleTraits


@system.one_pass.of(FlexibleTraits)
def one_pass(traits, lanes, count, substep, settings):
    """Leave the first ``count`` lanes to the scalar code."""
    for i in range(count):
        lanes.step_status.kind[i] = EVENTFUL


@system.take_in_step.of(FlexibleTraits)
def take_in_step(traits, lanes, i, substep, history):
    """Do nothing: no sub-step of the pass stands."""
