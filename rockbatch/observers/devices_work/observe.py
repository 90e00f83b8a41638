"""The work of devices is read from every step of a run."""

from dataclasses import dataclass

import numpy as np

from rockbatch.observers.devices_work.study import DevicesWork
from rockbatch.outcome.changes import LEAST, Sized, greatest_change
from rockbatch.outcome.device_work import Work
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import Base, Damper, Pier, places
from rockbatch.simulation import restraints
from rockbatch.simulation.error_control import CHANCE
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.recording import Recording
from rockbatch.simulation.runs import Run
from rockbatch.study import Output


@dataclass(frozen=True)
class DeviceWork:
    """Work of the devices until the end of a run; ``None`` without such a device."""

    # greatest cumulative travel [m] and greatest energy [J/kg] of a single damper
    damper_travel: float | None = None
    damper_work: float | None = None
    # greatest number of half cycles of a single damper, of at least the study's least stroke
    damper_half_cycles: int | None = None
    tendon_strain: float | None = None  # greatest strain over yield strain of the tendons that can yield


def greatest_of(pier: Pier, base: Base, work: Work) -> DeviceWork:
    """Return the greatest travel, work and half cycles of any damper, each by itself, and strain of any tendon that can yield.

    None for those of dampers, and for the strain, without such a device.
    """
    dampers = np.array([isinstance(device, Damper) for device in base.restraints for _ in places(pier, device)])
    strains = work.strain[np.isfinite(work.strain)]
    strain = float(strains.max()) if len(strains) else None
    if not dampers.any():
        return DeviceWork(tendon_strain=strain)
    travel, lost, half_cycles = (float(of_each[dampers].max()) for of_each in work[:3])
    return DeviceWork(travel, lost, int(half_cycles), strain)


OF_WORK = {
    "travel of a damper": Sized(("damper_travel",), "gap"),
    "work of a damper": Sized(("damper_work",), "energy"),
    "strain of a tendon": Sized(("tendon_strain",), "share"),
}
"""Fields of DeviceWork that have an error, with the scale of each."""


def with_work(outcome: Outcome, fine: DeviceWork, coarse: DeviceWork | None, pier: Pier, chance: float) -> Outcome:
    """Return ``outcome`` with the ``fine`` work of its devices.

    Its ``devices_error``, unless None, becomes at least ``chance`` times the greatest relative change of the fields in OF_WORK
    from ``coarse``, by twice the step, LEAST at least; it stays without ``coarse``.
    """
    worked = outcome.with_observed("devices_work", fine)
    if coarse is None or outcome.devices_error is None:
        return worked
    change = max(greatest_change(OF_WORK, fine, coarse, pier)[1], LEAST)
    return worked.changed(devices_error=max(outcome.devices_error, chance * change))


@dataclass(frozen=True)
class WorkOfDevices(Observer):
    """The work of dampers and tendons; half cycles count from ``least_stroke`` [m] up."""

    least_stroke: float

    def reads(self, run: Run, outcome: Outcome) -> bool:
        """Return True if the base has devices."""
        return bool(run.base.restraints)

    def read(self, recording: Recording, outcome: Outcome) -> DeviceWork:
        """Return the greatest work of any damper, and strain of any tendon that can yield."""
        run = recording.run
        work = restraints.device_work(run.pier, run.base, recording.rows, self.least_stroke)
        return greatest_of(run.pier, run.base, work)

    def add(self, run: Run, outcome: Outcome, fine: DeviceWork | None, coarse: DeviceWork | None) -> Outcome:
        """Return :func:`with_work` of ``fine``; ``outcome`` unchanged if that is None."""
        return outcome if fine is None else with_work(outcome, fine, coarse, run.pier, CHANCE)


def requested(output: Output) -> WorkOfDevices | None:
    """Return the observer if [output] of a study asks for it, else None."""
    settings = output.of(DevicesWork)
    return WorkOfDevices(0.001 * settings.least_stroke_mm) if settings.devices_work else None
