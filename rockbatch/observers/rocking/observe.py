"""Rocking and lean are read from the history of a run at samples."""

from dataclasses import dataclass

from rockbatch.observers.rocking.study import Separation
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import ElasticBase, YieldingBase
from rockbatch.simulation.leaning import Apart, apart, with_error_of_rocking, with_rocking
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.recording import Recording
from rockbatch.simulation.runs import Run
from rockbatch.study import Output


@dataclass(frozen=True)
class Rocking(Observer):
    """Rocking and lean apart; on bases that do not yield, and for a pier that fell, all of θ_max is rocking."""

    every_step = False
    separates_lean = True

    def reads(self, run: Run, outcome: Outcome) -> bool:
        """See :class:`Observer`."""
        return _may_lean(run, outcome)

    def claims_error(self, outcome: Outcome) -> bool:
        """See :class:`Observer`."""
        return outcome.theta_max_error is not None

    def read(self, recording: Recording, outcome: Outcome) -> Apart:
        """See :class:`Observer`."""
        base = recording.run.base
        assert isinstance(base, ElasticBase)
        return apart(recording.run.pier, base, recording.rows)

    def add(self, run: Run, outcome: Outcome, fine: Apart | None, coarse: Apart | None) -> Outcome:
        """See :class:`Observer`."""
        if fine is None:
            if _may_lean(run, outcome) or not outcome.was_run:
                return outcome
            return outcome.changed(theta_rocking=outcome.theta_max, theta_rocking_error=outcome.theta_max_error)
        outcome = with_rocking(outcome, fine, run.pier.alpha)
        return outcome if coarse is None else with_error_of_rocking(outcome, fine, coarse)


def _may_lean(run: Run, outcome: Outcome) -> bool:
    return isinstance(run.base, YieldingBase) and outcome.status != "overturned"


def requested(output: Output) -> Rocking | None:
    """Return the observer that a study asks for, if any."""
    return Rocking() if output.of(Separation).rocking else None
