"""The work of devices is read from every step of a run."""

from dataclasses import dataclass

from rockbatch.observers.devices_work.study import DevicesWork
from rockbatch.outcome.device_work import with_work
from rockbatch.outcome.outcome import DeviceWork, Outcome
from rockbatch.simulation import restraints
from rockbatch.simulation.error_control import CHANCE
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.recording import Recording
from rockbatch.simulation.runs import Run
from rockbatch.study import Output


@dataclass(frozen=True)
class WorkOfDevices(Observer):
    """The work of dampers and tendons; half cycles count from ``least_stroke`` [m] up."""

    least_stroke: float

    def reads(self, run: Run, outcome: Outcome) -> bool:
        """See :class:`Observer`."""
        return bool(run.base.restraints)

    def read(self, recording: Recording, outcome: Outcome) -> DeviceWork:
        """See :class:`Observer`."""
        run = recording.run
        return restraints.device_work(run.pier, run.base, recording.rows, self.least_stroke)

    def add(self, run: Run, outcome: Outcome, fine: DeviceWork | None, coarse: DeviceWork | None) -> Outcome:
        """See :class:`Observer`."""
        return outcome if fine is None else with_work(outcome, fine, coarse, run.pier, CHANCE)


def requested(output: Output) -> WorkOfDevices | None:
    """Return the observer that a study asks for, if any."""
    settings = output.of(DevicesWork)
    return WorkOfDevices(0.001 * settings.least_stroke_mm) if settings.devices_work else None
