"""Piers, pulses and random hard cases that the tests of the numerical core share."""

import importlib
import math
from collections.abc import Iterable
from types import SimpleNamespace
from typing import NamedTuple
from unittest import mock

import numpy as np
import pytest
from core_runs import SYSTEM, devices_of

import rockbatch as rb
from rockbatch.common.units import GRAVITY
from rockbatch.core.block.equations import normal_force
from rockbatch.core.block.events import _change_of_normal
from rockbatch.core.devices.elongation import attitude, gap_of
from rockbatch.core.devices.events import (
    Rounding,
    _is_held,
    _write_functions,
    device_event,
    device_functions,
    reset_device_modes,
    settle_friction,
)
from rockbatch.core.devices.lanes import equipment_of
from rockbatch.core.devices.laws import FRICTION, STICKS
from rockbatch.core.devices.pull import START, device_rates, step_resolving_devices
from rockbatch.core.devices.sticking import judge_grip
from rockbatch.core.springs.lanes import LANE, static_contact, static_state
from rockbatch.core.system import begin, rates, status_at_sample
from rockbatch.core.table import put, table
from rockbatch.core.types import OF_PIER, Ground, Instant, Moment
from rockbatch.motions.motion import Motion, Samples
from rockbatch.pier import Base, ElasticBase, Pier, YieldingBase
from rockbatch.simulation import runs
from rockbatch.simulation.elements import IDLE
from rockbatch.simulation.models import model, springs, system_of
from rockbatch.simulation.sections import InSection, in_body, in_section, recorded

FIG5 = Pier(alpha=0.20, p=1.0)
FIG6 = Pier(alpha=0.15, p=1.0)
TOWER = Pier(alpha=0.13, p=0.38)


def pulse(shape: str, period: float, amplitude_g: float = 1.0, dt: float = 0.005, end: float = 10.0) -> Motion:
    """Return one cycle of a sine or cosine sampled at i dt ≤ ``period`` [s], then zeros until ``end`` [s]."""
    t = np.arange(round(end / dt) + 1) * dt
    wave = {"sine": np.sin, "cosine": np.cos}[shape]
    inside = t <= period + 1e-9
    return Motion(shape, dt, np.where(inside, amplitude_g * GRAVITY * wave(2 * math.pi * t / period), 0.0))


def steady(horizontal: float, vertical: float, dt: float, samples: int) -> Motion:
    """Return constant ground accelerations [m/s²] from the first sample on."""
    return Motion("steady", dt, np.full(samples, float(horizontal)), np.full(samples, float(vertical)))


def broadband(rng: np.random.Generator, dt: float, npts: int, peak: float) -> Samples:
    """Return a sum of twelve sines between 0.3 and 20 Hz under a half-sine envelope, scaled to ``peak`` [m/s²]."""
    t = np.arange(npts) * dt
    total = np.zeros(npts)
    for frequency in np.exp(rng.uniform(math.log(0.3), math.log(20.0), 12)):
        total += np.sin(2 * math.pi * frequency * t + rng.uniform(0.0, 2 * math.pi))
    return peak * total * np.sin(math.pi * t / t[-1]) / np.abs(total).max()


def _log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    return math.exp(rng.uniform(math.log(low), math.log(high)))


EVERY_KIND = pytest.mark.parametrize(
    "kinds",
    ["common", pytest.param("usual n", marks=pytest.mark.slow), pytest.param("all", marks=pytest.mark.thorough)],
)
"""Of hard cases: those whose kernels fast tests compile anyway, or slow ones, and all of them."""


def hard_seeds(seeds: Iterable[int], kinds: str) -> list[int]:
    """Return those ``seeds`` whose hard cases are of these ``kinds``, of EVERY_KIND."""
    belongs = {"common": is_common, "usual n": has_usual_n, "all": lambda base: True}[kinds]
    return [seed for seed in seeds if belongs(hard_case(seed)[1])]


def has_usual_n(base: Base) -> bool:
    """Return whether the springs of a base have no other n than 5, if any: that of the kernels that most tests share."""
    return not base.has_exponent or base.n == 5.0


def is_common(base: Base) -> bool:
    """Return whether fast tests compile the kernel of a base without damping and devices anyway."""
    return not base.on_springs or (has_usual_n(base) and base.kinematics == "first-order")


def hard_case(seed: int, npts: int = 400) -> tuple[Pier, Base, Motion]:
    """Return a random pier on springs, within what the input checks accept, and a strong broadband motion.

    α in 0.02..1.2, μ in 0.5..10, β from 1.05 times its least value to 300 (or twice that value), η in 1.01..10,
    n in 1..20, ε in 0..1 with its ends, all laws, both kinematics, both treatments of flight; a horizontal peak of
    0.8 to 4 times g tan α and a vertical one of up to 1.2 g.
    """
    rng = np.random.default_rng(seed)
    pier = Pier(
        alpha=_log_uniform(rng, 0.02, 1.2),
        p=_log_uniform(rng, 0.3, 4.0),
        mu=float(rng.choice([3.0, rng.uniform(0.5, 10.0)])),
    )
    least = 1.05 * pier.least_beta
    common = {
        "beta": _log_uniform(rng, least, max(300.0, 2.0 * least)),
        "epsilon": float(rng.choice([0.0, 1.0, rng.uniform()])),
        "kinematics": str(rng.choice(["first-order", "finite"])),
        "flight": str(rng.choice(["stop", "guided"])),
    }
    law = str(rng.choice(["bouc-wen", "bouc-wen", "epp", "elastic"]))
    if law == "elastic":
        base: Base = ElasticBase(**common)
    else:
        exponent = float(rng.choice([1.0, 2.0, 2.5, 5.0, 20.0, rng.uniform(1.0, 20.0)]))
        base = YieldingBase(**common, eta=1.01 + 8.99 * rng.uniform() ** 2, spring=law, n=exponent)
    dt = 0.01
    horizontal = broadband(rng, dt, npts, GRAVITY * math.tan(pier.alpha) * rng.uniform(0.8, 4.0))
    vertical = broadband(rng, dt, npts, GRAVITY * rng.uniform(0.0, 1.2)) if rng.uniform() < 0.7 else None
    return pier, base, Motion(f"hard-{seed}", dt, horizontal, vertical)


def values_of(calls):
    """Return what functions of the core return: of each call its module below ``rockbatch.core``, its name and arguments.

    Raises ``FloatingPointError`` where uncompiled code makes a NaN, as of inf − inf.
    """
    with np.errstate(invalid="raise"):
        return [
            getattr(importlib.import_module(f"rockbatch.core.{module}"), name)(*given) for module, name, *given in calls
        ]


def filled(call, out):
    """Return ``out`` as a function of the core fills it in, the last argument of such a call as :func:`values_of` makes."""
    values_of([(*call, out)])
    return out


def gaps_of(pier, base, devices, states):
    """Return the Gap of each device in each state of a pier on springs."""
    m = springs(pier, base)
    at = [attitude(m, y, SimpleNamespace(top=0.0), 0.0) for y in states]
    return [[gap_of(m, of, *each) for each in zip(at, states, strict=True)] for of in devices]


def held_pivots(pier, base, states):
    """Return of each pair of a state and its accelerations which event functions are of a pivot that friction holds in place."""
    m, devices = springs(pier, base), SimpleNamespace(level=[0.0])
    moments = [SimpleNamespace(y=y, k=k, contact=SimpleNamespace(top=0.0)) for y, k in states]
    return [tuple(_is_held(m, devices, now, 0.0, i) for i in range(OF_PIER)) for now in moments]


def lane_of_springs(**values):
    """Return lanes of piers on springs of which the first has these values: ``group__name``."""
    lanes = table(LANE)[0][0]
    for name, value in values.items():
        group, field = name.split("__")
        getattr(getattr(lanes, group), field)[0] = value
    return lanes


def waiting_after(module_and_name, values, *given):
    """Return what a function of the first lane and ``given`` returns, and what is in the lane's ``waiting`` then."""
    lanes = lane_of_springs(**values)
    (found,) = values_of([(*module_and_name, lanes, 0, *given)])
    return found, {name: float(getattr(lanes.waiting, name)[0]) for name in lanes.waiting.dtype.names}


def device_signals(of, mode, goes, at):
    """Return the event functions of a device, three values and three slopes: ``at`` is its elongation, ė, ë and its state."""
    elongation, speed, acceleration, state = at
    devices = SimpleNamespace(elements=[of], modes=[mode], goes=[goes])
    functions = SimpleNamespace(values=np.full(OF_PIER + 3, -9.0), slopes=np.full(OF_PIER + 3, -9.0))
    motion = SimpleNamespace(
        gap=SimpleNamespace(elongation=elongation, speed=speed), acceleration=acceleration, state=state
    )
    _write_functions(devices, 0, motion, Rounding(1e-9, 1e-12), functions)
    return functions.values[OF_PIER:].tolist(), functions.slopes[OF_PIER:].tolist()


def after_event(m, now, of, mode, goes, state, what):
    """Return mode, direction, state and count of a device behind its event ``what``, None for a contact of the pier."""
    devices = devices_of([of], [state], 0.0)
    devices.modes[0], devices.goes[0], still = mode, goes, Ground(0.0, 0.0, 0.0, 0.0)
    if what is None:
        reset_device_modes(m, devices, now, still)
    else:
        device_event(m, devices, now, still, 0.01, OF_PIER + what)
    return tuple(map(float, (devices.modes[0], devices.goes[0], devices.x[0], devices.use[0].times)))


def longest_step(m, now, of, dt):
    """Return the longest step [s] of a block with a device that is drawn out, of the samples' interval ``dt`` at most."""
    devices, still = devices_of([of], (), 0.0), Ground(0.0, 0.0, 0.0, 0.0)
    devices.goes[0] = 1.0
    under, *_ = device_rates(m, devices, now, devices.x, still, START)
    start = Instant(now.y, rates(under, now.y, now.contact, still), now.contact, None, still)
    return float(step_resolving_devices(under, devices, start, dt, dt))


class HeldMotion(NamedTuple):
    """Rates of a pier without and with friction that sticks, and the forces [m/s²] of the first two such dampers."""

    free: tuple[float, ...]
    held: tuple[float, ...]
    forces: tuple[float, float]


def held_motion(m, y, contact, ground, rubs):
    """Return the HeldMotion of a pier in state ``y``, all of whose friction dampers ``rubs`` stick."""
    devices, now = devices_of(rubs, (), 0.0), Moment(y, contact, None)
    devices.goes[:] = STICKS
    under, *forces = device_rates(m, devices, now, devices.x, ground, START)
    return HeldMotion(rates(m, y, contact, ground), rates(under, y, contact, ground), tuple(map(float, forces)))


def doubts_of_grips(lanes):
    """Return by lane whether the pass doubts that friction of strength 1 sticks, and whether it has a force at the end.

    ``lanes`` are the direction of each damper and its force at the start, in three stages and at the end of a sub-step.
    """
    equipment = equipment_of(SYSTEM, [([IDLE._replace(kind=FRICTION)], (), 0.0)])
    line, verdict = equipment.lanes[0], equipment.shared[0].verdict
    line.element.strength[:] = 1.0
    for i, (goes, forces) in enumerate(lanes):
        line.mode.goes[i] = goes
        equipment.grips.first[:, i] = forces
    judge_grip(equipment, equipment.shared[0], len(lanes))
    return [(bool(verdict.doubts[i]), bool(verdict.holds[i])) for i in range(len(lanes))]


def rows_by_pass_and_by_events(found, substeps):
    """Return histories of runs as bytes and the sub-steps repeated in all, by the pass and event by event throughout."""
    made, results = runs.equipment_of, []
    for passes in (True, False):
        with mock.patch.object(runs, "equipment_of", lambda *given: made(*given)._replace(passes=passes)):  # noqa: B023
            written = runs.written_runs(found, substeps, 0.0, 100, wait=False)
        histories = [rows[: result.rows].tobytes() for result, rows in written]
        results.append((histories, sum(int(result.repeated) for result, _ in written)))
    return results


def rate_of_normal(m, now, of):
    """Return N/M of a block that rocks [m/s²] and its rate, with devices ``of`` that are at rest until the Instant ``now``."""
    devices, (y, _, contact, supports, ground) = devices_of(of, (), 0.0), now
    devices.goes[:] = math.copysign(1.0, y.omega)
    under, *_ = device_rates(m, devices, Moment(y, contact, supports), devices.x, ground, START)
    devices.stage[:] = devices.x
    k = rates(under, y, contact, ground)
    normal = normal_force(under, y, k, ground.vertical)
    return float(normal), float(_change_of_normal(under, devices, now._replace(k=k)))


def friction_signals(m, y, contact, ground, offset, strength):
    """Return value and slope of the event function of a friction damper that holds a block, and what it does then."""
    devices = devices_of([IDLE._replace(kind=FRICTION, strength=strength, offset=offset)], (), 0.0)
    now, functions = (
        Moment(y, contact, None),
        SimpleNamespace(values=np.ones(OF_PIER + 3), slopes=np.zeros(OF_PIER + 3)),
    )
    under, *_ = device_rates(m, devices, now, devices.x, ground, START)
    k = rates(under, y, contact, ground)
    device_functions(m, devices, Instant(y, k, contact, None, ground), START, 0.01, functions)
    settle_friction(m, devices, now, devices.x, ground)
    return functions.values.tolist(), functions.slopes.tolist(), float(devices.goes[0])


def status_of(m, now, values, devices=()):
    """Return the status of a run at a sample, when it is looked at next, and what its lane then has.

    ``now`` is its Moment, None at rest on springs; ``values`` are what the lane has else: ``group__name``.
    """
    of = system_of(m)
    lanes, module = table(of.lane)[0][0], importlib.import_module(type(m).__module__)
    numbers = module.numbers_of(m) if hasattr(module, "numbers_of") else m[: len(module.Numbers._fields)]
    put(lanes.model, 0, module.Numbers(*numbers))
    if now is None:
        y = static_state(m, m.gravity)
        now = Moment(y, *static_contact(m, y))
    put(lanes.now, 0, now.y)
    put(lanes.contact, 0, now.contact)
    if now.supports is not None:
        put(lanes.supports, 0, now.supports)
    places = {name: getattr(lanes, name.split("__")[0])[name.split("__")[1]] for name in values}
    for name, value in values.items():
        places[name][0] = value
    held = devices_of(list(devices), (), 0.0)
    if held is not None:
        held.goes[:] = 0.0
    found = status_at_sample(of.traits, lanes, 0, held)
    return *map(float, found), {name: float(place[0]) for name, place in places.items()}


def half_sine(amplitude_g: float, period: float, duration: float) -> Motion:
    return rb.pulse(
        "half-sine", name="half-sine", amplitude=amplitude_g * 9.81, period=period, dt=0.01, duration=duration
    )


def sections_at(run, rows, samples, heights):
    """Return the forces in sections at rows, of each sample in all heights."""
    body = in_body(recorded(run, rows), samples, np.ones(len(samples)))
    forces = [in_section(run.pier, body, height) for height in heights]
    return [[InSection(*(float(values[i]) for values in each)) for each in forces] for i in range(len(samples))]


def displaced_at_start(run, stale):
    """Return the greatest displacements that a run begins with in a lane where another had left ``stale`` ones."""
    system = system_of(model(run.pier, run.base))
    lanes, line = table(system.lane)[0][0], runs._line(run.pier, run.base, float(run.motion.dt), 4, 0.0, True)
    lanes.displaced.deflection[0] = lanes.displaced.drift[0] = stale
    begin(
        system.traits, lanes, 0, np.array([tuple(line)], [(name, "f8") for name in line._fields]).view(np.recarray)[0]
    )
    return float(lanes.displaced.deflection[0]), float(lanes.displaced.drift[0])
