"""Rocking and lean are read from the history of a run at samples."""

from dataclasses import dataclass
from typing import NamedTuple

from rockbatch.observers.rocking.study import Separation
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import ElasticBase, YieldingBase
from rockbatch.simulation.leaning import Apart, apart, noted_lean
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.recording import Recording
from rockbatch.simulation.runs import Run
from rockbatch.study import Output


class Parts(NamedTuple):
    """Greatest rotation about the rest position on the base as deformed then, and that rest position at the peak [rad].

    The lean is positive to the side of the peak, and None for a run that ended in flight; errors are None if not known.
    """

    rocking: float
    lean: float | None = None
    rocking_error: float | None = None
    lean_error: float | None = None


@dataclass(frozen=True)
class Rocking(Observer):
    """Rocking and lean apart; on bases that do not yield, and for a pier that fell, all of θ_max is rocking."""

    every_step = False
    separates_lean = True

    def reads(self, run: Run, outcome: Outcome) -> bool:
        """Return True on yielding springs, unless the pier overturned."""
        return _may_lean(run, outcome)

    def claims_error(self, outcome: Outcome) -> bool:
        """Return True if θ_max has an error."""
        return outcome.theta_max_error is not None

    def read(self, recording: Recording, outcome: Outcome) -> Apart:
        """Return the greatest rocking about the lean, and lean and rocking at the peak [rad]."""
        base = recording.run.base
        assert isinstance(base, ElasticBase)
        return apart(recording.run.pier, base, recording.rows)

    def add(self, run: Run, outcome: Outcome, fine: Apart | None, coarse: Apart | None) -> Outcome:
        """Return ``outcome`` with the Parts and a note of ``fine``; unchanged for a run that was refused, or not read.

        Where nothing was to be read, on a base that does not yield or of a pier that overturned, all of θ_max is rocking.
        """
        if fine is not None:
            lean = None if outcome.status == "flight" else fine.lean
            parts = Parts(fine.rocking, lean)
            if coarse is not None:
                lean_error = None if lean is None else abs(fine.lean - coarse.lean)
                parts = parts._replace(rocking_error=abs(fine.rocking - coarse.rocking), lean_error=lean_error)
            outcome = noted_lean(outcome, fine, run.pier.alpha)
        elif outcome.was_run and not _may_lean(run, outcome):
            parts = Parts(outcome.theta_max, rocking_error=outcome.theta_max_error)
        else:
            return outcome
        return outcome.with_observed("rocking", parts)


def _may_lean(run: Run, outcome: Outcome) -> bool:
    return isinstance(run.base, YieldingBase) and outcome.status != "overturned"


def requested(output: Output) -> Rocking | None:
    """Return the observer if [output] of a study asks for it, else None."""
    return Rocking() if output.of(Separation).rocking else None
