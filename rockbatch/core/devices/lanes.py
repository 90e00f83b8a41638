"""Devices of runs side by side: the memory of each run, and the numbers of a lane that the vector pass advances.

Scalar code takes the devices of one run at a time, and writes to the memory of that run. The pass has its own copies, in which
a loop over lanes reads contiguous memory: ``fetch`` copies those of a lane to its run, ``stow`` copies them back.
"""

from typing import NamedTuple

import numpy as np

from rockbatch.core.devices.elongation import GAP, Attitude, Gap, gap_in_pass, put_gap
from rockbatch.core.devices.laws import ELEMENT, FRICTION, USE, Element, Use
from rockbatch.core.devices.pull import END, Devices, bounds_steps
from rockbatch.core.kernel import hook, inlined, kernel
from rockbatch.core.system import in_pass
from rockbatch.core.table import LANES, aligned, get, lanes_of, move, put, taken
from rockbatch.core.types import Pull


class Mode(NamedTuple):
    """Mode and direction of a device."""

    mode: float
    goes: float


class Progress(NamedTuple):
    """State of a device and the energy that it has taken [J/kg]; also their rates."""

    state: float
    lost: float


class Works(NamedTuple):
    """Work of the ground and of the devices' P–Δ moments [J/kg]; also their rates."""

    ground: float
    p_delta: float


class Grip(NamedTuple):
    """Forces [m/s²] of the first two friction dampers that stick at one moment, 0 without any."""

    first: float
    second: float


class Verdict(NamedTuple):
    """Numbers of a lane beside its devices."""

    level: float  # v of the pier at rest [m]
    ended: float  # 1 if the next step continues from the rates at the end of the last one
    doubts: float  # devices that may have an event in the sub-step or ask for shorter steps; 1 more if it is not smooth
    holds: float  # 1 if friction that sticks has a force at the end
    extremes: float  # devices whose Use may have an extreme inside the sub-step
    smooth: (
        float  # negative if the next sub-step is left to scalar code, since it most likely needs several parts again
    )


DEVICE_LANE = lanes_of(
    {
        "element": Element,
        "mode": Mode,
        "use": Use,
        "now": Progress,
        "start_rates": Progress,
        "start_gap": Gap,
        "inner": Progress,
        "rates": Progress,
        "gap": Gap,
        "end": Progress,
        "use_end": Use,
    }
)
"""Numbers of a device in each lane: ``rates`` are those of the last stage, ``inner`` sums those of the two inner ones."""

_SHARED = lanes_of(
    {
        "attitude": Attitude,
        "pull": Pull,
        "start_pull": Pull,
        "works": Works,
        "works_start": Works,
        "works_inner": Works,
        "works_rates": Works,
        "works_end": Works,
        "verdict": Verdict,
    }
)


class Equipment(NamedTuple):
    """The devices of all runs of a call: fields of Devices with a row for each run, and their lanes."""

    elements: np.recarray
    level: np.ndarray
    modes: np.ndarray
    goes: np.ndarray
    x: np.ndarray
    stage: np.ndarray
    end: np.ndarray
    rates: np.ndarray
    gaps: np.recarray
    held: np.ndarray
    use: np.recarray
    ended: np.ndarray
    bound_steps: bool  # some may ask for a shorter step
    passes: bool  # the vector pass takes all of them; else runs are computed event by event throughout
    rubs: np.ndarray  # numbers of one or two friction dampers, of one twice; none of more, which stick in scalar code
    grips: np.recarray  # of lanes of Grip, shape (5,): at the start of a step, in its stages, and at its end
    lanes: np.recarray  # of DEVICE_LANE, shape (devices,)
    shared: np.recarray  # numbers of a lane beside its devices, and the pier's stages, shape (1,)
    cells: np.ndarray  # of ``lanes`` and ``shared``, a column for each lane
    shared_cells: np.ndarray


def signature(elements):
    """Return a tuple that the devices of two runs must have in common for their lanes to go through one pass.

    It has, for each device, its kind and whether it is at the deck, is linear, and is hysteretic on a brace.
    """
    return tuple((of.kind, of.height != 0.0, of.linear_below == np.inf, of.give > 0.0) for of in elements)


def _rubbing(elements):
    """Return the numbers of a run's two friction dampers, the same one twice if there is one; [] for none or more than two."""
    numbers = [j for j, of in enumerate(elements) if of.kind == FRICTION]
    return np.array(numbers[:1] + numbers[-1:] if len(numbers) in (1, 2) else [], np.int64)


def equipment_of(system, starts):
    """Return the Equipment of runs of ``system`` with equal signatures; None without devices.

    ``starts`` are, for each run, its sequence of Element, the states in which these are held, none at rest, and v of the pier at
    rest [m], NaN if it starts there.
    """
    runs, n = len(starts), len(starts[0][0])
    if n == 0:
        return None
    size = 2 * n + 2
    elements = np.array([[tuple(of) for of in elements] for elements, _, _ in starts], ELEMENT).view(np.recarray)
    x = np.zeros((runs, size))
    for number, (_, states, _) in enumerate(starts):
        x[number, : len(states)] = states
    state = system.lane["now"]
    shared = np.dtype(
        [
            *((name, _SHARED[name]) for name in _SHARED.names or ()),
            *((name, state) for name in ("stage", "inner", "rates", "ahead")),
        ]
    )
    lanes, others = aligned(n, DEVICE_LANE), aligned(1, shared)
    others["verdict"]["ended"] = 1.0  # padding never asks for rates
    all_elements = [of for elements, _, _ in starts for of in elements]
    return Equipment(
        elements,
        np.array([[float(level)] for _, _, level in starts]),
        np.zeros((runs, n)),
        np.zeros((runs, n)),
        x,
        np.zeros((runs, size)),
        np.zeros((runs, size)),
        np.zeros((runs, 6, size)),
        np.zeros((runs, 6, n), GAP).view(np.recarray),
        np.zeros((runs, 6, 2)),
        np.zeros((runs, n), USE).view(np.recarray),
        np.zeros((runs, 3)),
        any(map(bounds_steps, all_elements)),
        all(of.kind in system.passed and of.give == 0.0 for of in all_elements),
        _rubbing(starts[0][0]),
        aligned(5, lanes_of({"grip": Grip})["grip"]),
        lanes,
        others,
        lanes.view("f8", np.ndarray).reshape(-1, LANES),
        others.view("f8", np.ndarray).reshape(-1, LANES),
    )


@hook
def devices_in(equipment, lanes, i):
    """Return the Devices of the run in lane ``i``; None without any."""


@devices_in.of(type(None))
def _none_in(equipment, lanes, i):
    return None


@devices_in.of(Equipment)
def _devices_in(equipment, lanes, i):
    run = int(lanes.clock.number[i])
    return Devices(
        equipment.elements[run],
        equipment.level[run],
        equipment.modes[run],
        equipment.goes[run],
        equipment.x[run],
        equipment.stage[run],
        equipment.end[run],
        equipment.rates[run],
        equipment.gaps[run],
        equipment.held[run],
        equipment.use[run],
        equipment.bound_steps,
        equipment.ended[run],
    )


@hook
def fetch(equipment, devices, i):
    """Copy the numbers of lane ``i`` that the pass advances to the ``devices`` of its run; nothing if no pass takes these."""


@fetch.of(type(None))
def _fetch_nothing(equipment, devices, i):
    pass


@fetch.of(Equipment)
def _fetch(equipment, devices, i):
    if equipment.passes:
        _copy_to_run(devices, equipment.lanes, equipment.shared[0], i)
        devices.held[END, 0], devices.held[END, 1] = equipment.grips[0].first[i], equipment.grips[0].second[i]


@kernel
def _copy_to_run(devices, each, shared, i):
    n, x, ends = len(each), devices.x, devices.rates[END]
    for j in range(n):
        line, use = each[j], devices.use[j]
        x[j], x[n + j] = line.now.state[i], line.now.lost[i]
        ends[j], ends[n + j] = line.start_rates.state[i], line.start_rates.lost[i]
        put_gap(devices.gaps[END, j], get(line.start_gap, i, Gap))
        use.most, use.stroke, use.speed = line.use.most[i], line.use.stroke[i], line.use.speed[i]
        use.lost, use.yielded = line.use.lost[i], line.use.yielded[i]
    x[2 * n], x[2 * n + 1] = shared.works.ground[i], shared.works.p_delta[i]
    ends[2 * n], ends[2 * n + 1] = shared.works_start.ground[i], shared.works_start.p_delta[i]
    devices.ended[0], devices.ended[1] = shared.verdict.ended[i], shared.start_pull.force[i]
    devices.ended[2] = shared.start_pull.moment[i]
    for k in range(len(x)):
        devices.stage[k] = x[k]


@hook
def stow(equipment, devices, i, smooth, event):
    """Copy the ``devices`` of a run to its lane ``i`` after scalar code, which ended with an ``event`` or not.

    The pass takes the next sub-step if that may be ``smooth`` and there was an event, no friction holds with a force, or the run
    has one or two friction dampers. Nothing is copied for devices that no pass takes.
    """


@stow.of(type(None))
def _stow_nothing(equipment, devices, i, smooth, event):
    pass


@stow.of(Equipment)
def _stow(equipment, devices, i, smooth, event):
    if equipment.passes:
        goes_on = event or devices.ended[0] != 0.0 or len(equipment.rubs) == 2
        equipment.shared[0].verdict.smooth[i] = 1.0 if smooth and goes_on else -1.0
        _copy_to_lane(devices, equipment.lanes, equipment.shared[0], i)
        put(equipment.grips[0], i, Grip(0.0, 0.0))


@kernel
def _copy_to_lane(devices, each, shared, i):
    n, x, ends = len(each), devices.x, devices.rates[END]
    for j in range(n):
        line = each[j]
        put(line.element, i, taken(devices.elements[j], Element))
        put(line.use, i, taken(devices.use[j], Use))
        put(line.mode, i, Mode(devices.modes[j], devices.goes[j]))
        put(line.now, i, Progress(x[j], x[n + j]))
        put(line.start_rates, i, Progress(ends[j], ends[n + j]))
        put(line.rates, i, Progress(ends[j], ends[n + j]))
        put(line.start_gap, i, taken(devices.gaps[END, j], Gap))
    put(shared.works, i, Works(x[2 * n], x[2 * n + 1]))
    put(shared.works_start, i, Works(ends[2 * n], ends[2 * n + 1]))
    put(shared.start_pull, i, Pull(devices.ended[1], devices.ended[2]))
    shared.verdict.level[i], shared.verdict.ended[i] = devices.level[0], devices.ended[0]


@hook
def move_devices(equipment, i, j):
    """Copy the devices of lane ``i`` to lane ``j``."""


@move_devices.of(type(None))
def _move_nothing(equipment, i, j):
    pass


@move_devices.of(Equipment)
def _move(equipment, i, j):
    move(equipment.cells, i, j)
    move(equipment.shared_cells, i, j)
    put(equipment.grips[0], j, get(equipment.grips[0], i, Grip))


@inlined
def gap_in_stage(traits, lanes, line, shared, i):
    """Return the Gap of a device of lane ``i`` in the stage of the pass."""
    m, now, _ = in_pass(traits, lanes, i)
    return gap_in_pass(m, get(line.element, i, Element), get(shared.attitude, i, Attitude), get(shared.stage, i, now))
