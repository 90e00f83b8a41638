"""Half cycles are read from the history of a run at samples."""

from dataclasses import dataclass

from rockbatch.observers.half_cycles import TABLE
from rockbatch.observers.half_cycles.study import Cycles
from rockbatch.outcome.half_cycles import HALF_CYCLE_COLUMNS, HalfCycles, apparent_restitution
from rockbatch.outcome.outcome import Outcome
from rockbatch.simulation.histories import cycles_of
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.recording import Recording
from rockbatch.simulation.runs import Run
from rockbatch.study import Output


@dataclass(frozen=True)
class CyclesOfRocking(Observer):
    """Half cycles of every run that did not fail; no error."""

    table = TABLE
    every_step = False

    def reads(self, run: Run, outcome: Outcome) -> bool:
        """Return True unless the run failed."""
        return outcome.status != "failed"

    def claims_error(self, outcome: Outcome) -> bool:
        """Return False: half cycles have no error."""
        return False

    def read(self, recording: Recording, outcome: Outcome) -> HalfCycles:
        """Return the half cycles of the whole history."""
        return cycles_of(recording.run.base, recording.rows)

    def add(self, run: Run, outcome: Outcome, fine: HalfCycles | None, coarse: None) -> Outcome:
        """Return ``outcome`` with a row of the table for each half cycle of ``fine``; no rows if it is None."""
        if fine is None:
            return outcome.with_table(self.table, [])
        columns = (*fine, apparent_restitution(run.pier, fine.amplitude))
        rows = [
            {"half_cycle": n} | dict(zip(HALF_CYCLE_COLUMNS, map(float, values), strict=True))
            for n, values in enumerate(zip(*columns, strict=True))
        ]
        return outcome.with_table(self.table, rows)


def requested(output: Output) -> CyclesOfRocking | None:
    """Return the observer if [output] of a study asks for it, else None."""
    return CyclesOfRocking() if output.of(Cycles).half_cycles else None
