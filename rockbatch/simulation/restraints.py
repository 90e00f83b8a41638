"""Devices of a recorded run: forces, elongations, and the energy balance with them."""

import math
from typing import NamedTuple

import numpy as np

from rockbatch.common.lazy import pd
from rockbatch.core.devices.elongation import attitude, gap_of
from rockbatch.core.devices.laws import (
    CONTACT,
    ELEMENT,
    FRICTION,
    HYSTERETIC,
    SPRING,
    STICKS,
    TENDON,
    Element,
    own_speed,
    stop_force,
)
from rockbatch.core.devices.laws import stored as stored_in
from rockbatch.core.kernel import entry
from rockbatch.core.observe.ledger import LEDGER
from rockbatch.core.observe.peaks import RecordedDevices, recorded_force
from rockbatch.core.observe.rows import contact_of, state_of
from rockbatch.core.types import Result
from rockbatch.motions.motion import Samples
from rockbatch.outcome.device_work import Courses, Work, work_of
from rockbatch.pier import Base, ElasticBase, FootingBase, Pier, RigidBase, place_names
from rockbatch.simulation.elements import elements, prestress
from rockbatch.simulation.models import footing, model, springs
from rockbatch.simulation.starting import start_of

AT_REST = 1e-9
"""Velocity in units of R0 α p that counts as zero in a history."""


def apart(base: Base, rows: np.recarray) -> tuple[np.recarray, Samples]:
    """Return ``rows`` without the columns of devices, and their total force [m/s²] and moment [m²/s²] per row, shape (n, 2).

    Without devices ``rows`` themselves, and zeros.
    """
    if not base.restraints:
        return rows, np.zeros((len(rows), 2))
    names = rows.dtype.names or ()
    plain = np.recarray(len(rows), np.dtype([(name, "f8") for name in names[: names.index("state")]]))
    for name in plain.dtype.names or ():
        plain[name] = rows[name]
    return plain, rows.pull.copy()


def recorded(pier: Pier, base: Base, rows: np.recarray) -> RecordedDevices:
    """Return the devices of ``base`` as the core has them, with their states at the ``rows`` of a history."""
    laws = np.array([tuple(law) for law in elements(pier, base)], ELEMENT).view(np.recarray)
    return RecordedDevices(laws, rows.state.copy(), level_at_rest(pier, base, rows))


def level_at_rest(pier: Pier, base: Base, rows: np.recarray) -> float:
    """Return v of the pier at rest [m], before it was pulled if it was, by the ``rows`` of its history from the start on."""
    level = start_of(pier, base).level
    return float(rows.v[0]) if math.isnan(level) else level


@entry
def _follow(m, devices, rows, moves, elongation, speed, pull, energy):  # type: ignore[no-untyped-def]
    """Write elongation [m], speed without a brace, force [N/kg] and stored energy [J/kg] of each device at each row, shape
    (rows, devices).

    A force is positive in tension; that of friction is 0 below the speed ``moves`` [m/s].
    """
    for i in range(len(rows)):
        y = state_of(m, rows[i])
        pose = attitude(m, y, contact_of(m, rows[i]), devices.level)
        for j in range(len(devices.elements)):
            law, state = devices.elements[j], devices.states[i, j]
            gap = gap_of(m, law, pose, y)
            direction = math.copysign(1.0, gap.speed) if abs(gap.speed) > moves else STICKS
            pull[i, j] = recorded_force(law, gap, state, direction)
            elongation[i, j], speed[i, j] = gap.elongation, own_speed(law, gap.speed, state)
            energy[i, j] = stored_in(law, gap.elongation, state)


class DeviceHistories(NamedTuple):
    """Histories of devices, shape (rows, devices) each; see :func:`_follow`."""

    elongation: Samples
    speed: Samples
    pull: Samples
    energy: Samples

    @property
    def stored(self) -> Samples:
        """The elastic energy [J/kg] stored in all devices at every row, relative to the start."""
        energy: Samples = self.energy.sum(axis=1)
        return energy - energy[0]


def device_histories(pier: Pier, base: Base, rows: np.recarray) -> DeviceHistories:
    """Return elongation, speed without a brace, force and stored energy of each device at each row."""
    devices = recorded(pier, base, rows)
    histories = DeviceHistories(*(np.zeros((len(rows), len(devices.elements))) for _ in DeviceHistories._fields))
    moves = AT_REST * pier.size * pier.alpha * pier.p
    _follow(model(pier, base), devices, apart(base, rows)[0], float(moves), *histories)
    return histories


def loops(pier: Pier, base: Base, t: Samples, histories: DeviceHistories) -> "pd.DataFrame":
    """Return a table of elongation [m] and force [N/kg] of every device at every time ``t`` [s]."""
    table = {"t": t}
    for j, name in enumerate(place_names(pier, base.restraints)):
        table |= {f"{name} elongation": histories.elongation[:, j], f"{name} force": histories.pull[:, j]}
    return pd.DataFrame(table)


def device_work(pier: Pier, base: Base, rows: np.recarray, least_stroke: float) -> Work:
    """Return the work of each device in a run with ``rows`` at every step; half cycles from ``least_stroke`` [m] up."""
    histories = device_histories(pier, base, rows)
    courses = Courses(histories.elongation, histories.pull, rows.lost, rows.t, histories.speed)
    return work_of(pier, base, courses, least_stroke)


def with_devices(pier: Pier, base: Base, rows: np.recarray, terms: Samples) -> Samples:
    """Add the devices to the energy balance [J/kg] of a run, ``terms``, which are changed in place and returned."""
    table = terms.view(LEDGER)[:, 0].view(np.recarray)  # the same memory, by names
    kinds = np.array([law.kind == TENDON for law in elements(pier, base)])
    table.elastic += device_histories(pier, base, rows).stored
    table.plastic += rows.lost[:, kinds].sum(axis=1)
    table.damping += rows.lost[:, ~kinds].sum(axis=1)
    table.p_delta += rows.p_delta
    gain = table.kinetic + table.potential + table.elastic - table.input - table.p_delta - table.constraint
    table.remainder = gain + table.plastic + table.impact + table.damping
    return terms


def static_position(
    pier: Pier, base: Base, result: Result, level: float, states: Samples, sticks: np.ndarray
) -> Samples:
    """Return v [m] and θ [rad] at rest under devices after a run: :func:`rests_at` on supports, else as rigid ground allows.

    There a pier that came to rest stands upright, and devices may hold any other (:func:`rests_on_rigid_base`).
    """
    if isinstance(base, ElasticBase | FootingBase):
        return rests_at(pier, base, result, level, states, sticks)
    upright = not math.isnan(result.t_rest)
    return np.array([result.v_end, 0.0 if upright else rests_on_rigid_base(pier, base, result, states, sticks)])


def rests_at(
    pier: Pier, base: ElasticBase | FootingBase, result: Result, level: float, states: Samples, sticks: np.ndarray
) -> Samples:
    """Return v [m] and the static rotation [rad] of the pier on its supports after a run with this ``result``.

    Rotations are small, both springs or the whole bed of a footing bear, and the P–Δ moment of the weight adds to the tilt;
    devices deform elastically from their state at the end of the run, and a sticking friction damper holds its place. ``level``
    is v of the pier at rest at the start [m]; ``states`` and ``sticks``, shape (devices,), are the state of each device at the
    end, and True for a friction damper that sticks then.
    """
    v, theta, stiffness = result.v_end, result.theta_end, stiffness_at_rest(pier, base, 0.0)
    whole, rocking = stiffness_of_supports(pier, base)
    k = 0.5 * whole
    if isinstance(base, FootingBase):
        load = np.array([-whole * result.settled - pier.gravity, rocking * result.bed_tilt])
    else:
        unstressed = level + 0.5 * (pier.gravity + prestress(pier, base)) / k  # at the start
        left, right = result.base_left, result.base_right
        load = np.array([k * (2.0 * unstressed + left + right) - pier.gravity, k * pier.half_width * (left - right)])
    for law, state, holding in zip(elements(pier, base), states, sticks, strict=True):
        reach = reach_at_rest(pier, base, law, 0.0)
        u = float(reach[0] * (v - level) + reach[1] * theta)
        force, tangent = at_rest(law, u, state, k if holding else 0.0)
        # F = force + tangent (x − u) pulls down by F, and turns by F times the arm
        stiffness += tangent * np.outer(reach, reach)
        load -= (force - tangent * (u + reach[0] * level)) * reach
    position: Samples = np.linalg.solve(stiffness, load)
    return position


def stiffness_at_rest(pier: Pier, base: Base, theta: float) -> Samples:
    """Return the stiffness in v [1/s²] and θ [m²/s²] of a pier at rest without devices, shape (2, 2), less the weight's moment.

    On rigid ground the pier stands on one pivot at ``theta`` [rad], which leaves v no part: its stiffness is 1.
    """
    if isinstance(base, ElasticBase | FootingBase):
        whole, rocking = stiffness_of_supports(pier, base)
        return np.diag([whole, rocking - pier.gravity * base.leaning_height(pier)])
    return np.diag([1.0, -pier.gravity * pier.size * math.cos(pier.alpha - abs(theta))])


def stiffness_of_supports(pier: Pier, base: ElasticBase | FootingBase) -> tuple[float, float]:
    """Return the stiffness of both springs, or of the whole bed, in v [1/s²] and θ [m²/s²]."""
    if isinstance(base, FootingBase):
        bed = footing(pier, base)
        return bed.stiffness, bed.stiffness * base.rocking_share * bed.half_width**2
    m = springs(pier, base)
    whole = 2.0 * (m.yield_force * m.stiffness)
    return whole, whole * m.half_width * m.half_width


def reach_at_rest(pier: Pier, base: Base, law: Element, theta: float) -> Samples:
    """Return ∂e/∂v and ∂e/∂θ [m] of a device, at small rotations on supports, on rigid ground at ``theta`` [rad]."""
    if base.on_springs:
        return np.array([0.0, law.way * law.height] if law.height != 0.0 else [1.0, -law.offset])
    side = math.copysign(1.0, theta)
    return np.array([0.0, side * _reach(law, pier.half_width, abs(theta), side)[1]])


def rests_on_rigid_base(pier: Pier, base: RigidBase, result: Result, states: Samples, sticks: np.ndarray) -> float:
    """Return the rotation [rad] at which devices hold a pier that is not at rest upright; 0 if they do not hold it.

    Friction that sticks off the pivot holds the final rotation. Other devices deform elastically until weight and devices
    balance, between 0 and the final rotation, which is returned if devices still outweigh the weight there.
    """
    theta, b = result.theta_end, pier.half_width
    laws = elements(pier, base)
    for law, holding in zip(laws, sticks, strict=True):
        if holding and abs(law.offset - math.copysign(b, theta)) > 1e-9 * b:  # at the pivot friction has no arm
            return theta
    side = math.copysign(1.0, theta)

    def excess(tilt: float) -> float:
        """Return the righting moment [m²/s²] of weight and devices at ``tilt`` [rad]."""
        righting = pier.gravity * pier.size * math.sin(pier.alpha - tilt)
        for law, state in zip(laws, states, strict=True):
            u, arm = _reach(law, b, tilt, side)
            final, _ = _reach(law, b, abs(theta), side)
            force, tangent = at_rest(law, final, state, 0.0)
            force = stop_force(law, u, state) if law.kind == CONTACT else force + tangent * (u - final)
            righting += force * arm
        return righting

    low, high = 0.0, abs(theta)
    if excess(low) >= 0.0 or excess(high) < 0.0:
        return 0.0 if excess(low) >= 0.0 else theta
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) < 0.0 else (low, middle)
    return side * 0.5 * (low + high)


def _reach(law: Element, b: float, tilt: float, side: float) -> tuple[float, float]:
    """Return the elongation [m] of a device of a block on the pivot at ``side``, and its derivative by the ``tilt`` [m]."""
    if law.height != 0.0:
        direction = side * law.way
        return direction * (law.height * math.sin(tilt) + b * (1.0 - math.cos(tilt))), direction * (
            law.height * math.cos(tilt) + b * math.sin(tilt)
        )
    distance = b - side * law.offset
    return 2.0 * distance * math.sin(0.5 * tilt), distance * math.cos(0.5 * tilt)


def at_rest(law: Element, elongation: float, state: float, support: float) -> tuple[float, float]:
    """Return force [N/kg] and tangent stiffness [1/s²] of a device at rest.

    ``support`` is the stiffness of a support if a friction damper sticks, which is then much stiffer; 0 if it slides.
    """
    if law.kind == FRICTION:
        return 0.0, 1e6 * support
    if law.kind == HYSTERETIC:
        return law.strength * state, law.strength * law.stiffness / (1.0 + law.give)
    if law.kind == CONTACT:
        force = stop_force(law, elongation, state)
        return force, law.stiffness / law.returned if force > 0.0 else 0.0
    if law.kind == SPRING:
        return law.stiffness * elongation, law.stiffness
    if law.kind != TENDON:
        return 0.0, 0.0
    pull = law.prestress + law.stiffness * (elongation - state)
    return min(max(pull, 0.0), law.strength), law.stiffness if 0.0 < pull < law.strength else 0.0
