"""Effects of shocks are read from the history of a run at samples."""

from collections.abc import Sequence
from dataclasses import dataclass

from rockbatch.motions import Motion
from rockbatch.observers.shocks import TABLE
from rockbatch.observers.shocks.effects import OfShocks, of_shocks, with_error
from rockbatch.observers.shocks.outcome import ShockOutcome
from rockbatch.observers.shocks.table import shock_rows
from rockbatch.outcome.outcome import Outcome
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.recording import Recording
from rockbatch.simulation.runs import Run
from rockbatch.study import Output


@dataclass(frozen=True)
class EffectsOfShocks(Observer):
    """What each shock of a sequence does, until a pause after the last."""

    table = TABLE
    every_step = False

    def observes(self, motions: Sequence[Motion]) -> bool:
        """Return True if any of ``motions`` is a sequence of shocks."""
        return any(motion.shocks for motion in motions)

    def reads(self, run: Run, outcome: Outcome) -> bool:
        """Return True for a sequence, unless the run failed."""
        return bool(run.motion.shocks) and outcome.status != "failed"

    def claims_error(self, outcome: Outcome) -> bool:
        """Return True: a run that overturned in a later shock has errors of those before."""
        return True

    def quiet_s(self, run: Run, quiet_s: float) -> float:
        """Return the length [s] of the pause after the last shock, or ``quiet_s`` if that is longer."""
        last = run.motion.shocks[-1]
        return max(quiet_s, last.until - last.end)

    def read(self, recording: Recording, outcome: Outcome) -> OfShocks:
        """Return the effects of each shock, without errors, and the peaks from which errors follow."""
        return of_shocks(recording.run, outcome, recording.rows)

    def add(self, run: Run, outcome: Outcome, fine: OfShocks | None, coarse: OfShocks | None) -> Outcome:
        """Return ``outcome`` with a row of the table for each shock; without ``fine`` they have a status only.

        "failed", or "not read" for a run too long to be held in memory.
        """
        outcomes = [ShockOutcome("failed" if outcome.status == "failed" else "not read")] * len(run.motion.shocks)
        if fine is not None:
            outcomes = fine.outcomes if coarse is None else with_error(fine, coarse)
        return outcome.with_table(self.table, shock_rows(run.motion, run.pier, outcomes))


def requested(output: Output) -> EffectsOfShocks:
    """Return the observer for any study; it reads only runs under a sequence of shocks."""
    return EffectsOfShocks()
