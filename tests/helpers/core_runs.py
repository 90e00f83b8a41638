"""Runs by the core itself, of blocks that start in motion, which the public interface does not offer."""

import math

import numpy as np

from rockbatch.core.block.lanes import line_of, system_of
from rockbatch.core.block.model import Block
from rockbatch.core.devices.lanes import equipment_of
from rockbatch.core.devices.pull import Devices
from rockbatch.core.history import MOMENT
from rockbatch.core.run import march
from rockbatch.motions.motion import Samples

SYSTEM = system_of(None)


def devices_of(elements, states=(), level=math.nan):
    """Return the Devices of one run, at rest or in the ``states`` in which they are held; None without any."""
    equipment = equipment_of(SYSTEM, [(elements, states, level)])
    if equipment is None:
        return None
    of_run = {name: getattr(equipment, name)[0] for name in Devices._fields if name != "bound_steps"}
    return Devices(**of_run, bound_steps=equipment.bound_steps)


def block_line(m: Block, theta: float, omega: float, dt: float, substeps: int, npts: int, quiet_samples: int = 0):
    """Return the line of a run from ``theta`` [rad] and ``omega`` [rad/s] on, over the first ``npts`` rows of the ground."""
    return line_of(m, theta, omega, dt, substeps, quiet_samples, 0, npts, 0)


def run_blocks(lines, ground: Samples, substeps: int, history: Samples | None = None, stop: int = 0) -> np.recarray:
    """Return the results of the runs with these lines, of the same ``substeps``; a ``stop`` of 1 stops them at once."""
    more = {} if history is None else {"history": history}
    return march(SYSTEM, lines, ground, np.full(1, stop, np.uint8), substeps, **more)


def run_block(
    m: Block, theta: float, omega: float, ground: Samples, dt: float, substeps: int, rows: int = 0
) -> tuple[np.record, np.recarray]:
    """Return the result of one run, and its history of at most ``rows`` rows."""
    row = np.dtype([(name, "f8") for name in (*MOMENT, *SYSTEM.columns)])
    history = np.zeros((min(rows, 1), rows, len(row)))
    result = run_blocks([block_line(m, theta, omega, dt, substeps, len(ground))], ground, substeps, history)[0]
    return result, history.view(row).ravel()[: result.rows].view(np.recarray)
