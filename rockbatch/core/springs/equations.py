"""Equations of motion of the pier on two springs, once for all contacts and both kinematics (THEORY.md, eqs. 4 to 9)."""

from rockbatch.core import system
from rockbatch.core.clock import Clearances
from rockbatch.core.flexure.shaft import power_of_ground
from rockbatch.core.kernel import hook, inlined, kernel
from rockbatch.core.springs.laws import within_yield, z_rate
from rockbatch.core.springs.model import Contact, Geometry, Springs, State
from rockbatch.core.springs.recovery import acceleration_of_top, forces, recovery_rate, share_left, top, with_recovery
from rockbatch.core.table import with_z
from rockbatch.core.trigonometry import sine_and_cosine
from rockbatch.core.types import LEFT


@inlined
def geometry(m, theta):
    """Return pivots and levers at rotation ``theta`` (THEORY.md, eqs. 5 and 6; finite: THEORY.md, eqs. 8 and 9)."""
    b, h = m.half_width, m.height
    if m.finite is not None:
        s, c = sine_and_cosine(theta)
        drop = h * s * s / (1.0 + c)  # h (1 − cos θ), without the loss of digits
        arm_left, arm_right = b * c + h * s, -b * c + h * s
        lift_left, lift_right, bend_left, bend_right = b * s + drop, -b * s + drop, -b * s + h * c, b * s + h * c
        lever, slope, swing, swing_slope = h * c, -h * s, b * s, b * c
        return Geometry(
            lift_left,
            lift_right,
            arm_left,
            arm_right,
            bend_left,
            bend_right,
            arm_left,
            arm_right,
            lever,
            slope,
            swing,
            swing_slope,
        )
    moment_left, moment_right = b + h * theta, -b + h * theta
    return Geometry(b * theta, -b * theta, b, -b, 0.0, 0.0, moment_left, moment_right, h, 0.0, b * theta, b)


@inlined
def with_forces(pull, force, moment):
    """Return ``force``, upwards, and ``moment``, to the right, less the devices' ``pull``, down and to the left (None: 0)."""
    if pull is None:
        return force, moment
    return force - pull.force, moment - pull.moment


@hook
def accelerations_of(shaft, m, y, contact, at, ground):
    """Return v̈ [m/s²] and θ̈ [rad/s²] of state ``y`` with the Geometry ``at``; ``shaft`` is that of ``m``, None if rigid."""


@inlined
def accelerations_at(m, y, contact, at, ground):
    """Return v̈ [m/s²] and θ̈ [rad/s²] of state ``y`` with the Geometry ``at``."""
    return accelerations_of(m.shaft, m, y, contact, at, ground)


@accelerations_of.of(type(None))
def _rigid_accelerations(shaft, m, y, contact, at, ground):
    force_left, force_right = forces(m, y, contact, at)
    side = contact.right - contact.left
    lever = at.lever + side * at.swing
    moment = -force_left * at.moment_left - force_right * at.moment_right - lever * ground.horizontal
    effective = m.height
    if m.finite is not None:
        effective = lever
        moment -= lever * (at.lever_slope + side * at.swing_slope) * y.omega * y.omega
    v_acceleration, moment = with_forces(m.pull, -m.gravity - ground.vertical - force_left - force_right, moment)
    if contact.held == 0.0:
        return v_acceleration, moment * (1.0 / (m.inertia + effective * effective))
    # A held pivot neither lifts nor presses: it goes with its support (Filippov's sliding mode).
    if contact.held < 0.0:
        free = v_acceleration - acceleration_of_top(m, y.z_left)
        return v_acceleration, -(free + at.bend_left * y.omega * y.omega) / at.arm_left
    free = v_acceleration - acceleration_of_top(m, y.z_right)
    return v_acceleration, -(free + at.bend_right * y.omega * y.omega) / at.arm_right


@hook
def rates_of(shaft, m, y, contact, ground, z_rates):
    """Return the rates of all state variables, with those of both springs' z given."""


@rates_of.of(type(None))
def _rigid_rates(shaft, m, y, contact, ground, z_rates):
    v_acceleration, theta_acceleration = accelerations_at(m, y, contact, geometry(m, y.theta), ground)
    return State(y.v_rate, y.omega, v_acceleration, theta_acceleration, z_rates[0], z_rates[1])


@system.rates.of(Springs)
def rates(m, y, contact, ground):
    """Return the right-hand side: the rates of all state variables."""
    at = geometry(m, y.theta)
    left = contact.left * (y.v_rate + at.arm_left * y.omega)
    right = contact.right * (y.v_rate + at.arm_right * y.omega)
    z_left = recovery_rate(m, z_rate(m, y.z_left, left, contact.left_yields), y.z_left, contact.left)
    z_right = recovery_rate(m, z_rate(m, y.z_right, right, contact.right_yields), y.z_right, contact.right)
    return rates_of(m.shaft, m, y, contact, ground, (z_left, z_right))


@kernel
def pivot_acceleration(m, y, contact, side, ground):
    """Return the upward acceleration [m/s²] of the pivot on ``side`` (LEFT or RIGHT), less that of a free support's top."""
    at = geometry(m, y.theta)
    v_acceleration, theta_acceleration = accelerations_at(m, y, contact, at, ground)
    if side == LEFT:
        away = v_acceleration - acceleration_of_top(m, y.z_left)
        return away + at.arm_left * theta_acceleration + at.bend_left * y.omega * y.omega
    away = v_acceleration - acceleration_of_top(m, y.z_right)
    return away + at.arm_right * theta_acceleration + at.bend_right * y.omega * y.omega


@system.share.of(Springs)
def share(m, h):
    """Return the factor by which z of supports without their pivots decays in ``h`` [s]; 1 if undamped."""
    return share_left(m, h)


@system.stage.of(Springs)
def stage(m, y, start, contact, remaining):
    """Return a stage of a step, with z of supports without their pivots in closed form."""
    return with_recovery(m, y, start, contact, remaining)


@system.end_step.of(Springs)
def end_step(m, y, start, contact, remaining):
    """Return the end of a step, with z :func:`within_yield`, and in closed form for supports without pivots."""
    z_left = within_yield(m.backbone, y.z_left, contact.left_yields)
    z_right = within_yield(m.backbone, y.z_right, contact.right_yields)
    return with_recovery(m, with_z(y, z_left, z_right), start, contact, remaining)


@system.ground_power.of(Springs)
def ground_power(m, y, contact, ground):
    """Return the power of the ground's inertia forces [W/kg]."""
    at = geometry(m, y.theta)
    return power_of_ground(m.shaft, m, y, at.lever + (contact.right - contact.left) * at.swing, ground)


@system.airborne.of(Springs)
def airborne(m, contact):
    """Return True if both pivots are in the air, without grazing contact."""
    return contact.left == 0.0 and contact.right == 0.0 and contact.held == 0.0


@inlined
def clearances(m, y, supports):
    """Return the Clearances of both pivots above their supports; the rates are the pivots' velocities."""
    at = geometry(m, y.theta)
    left, right = top(m, supports.left, y.z_left), top(m, supports.right, y.z_right)
    rate_left, rate_right = y.v_rate + at.arm_left * y.omega, y.v_rate + at.arm_right * y.omega
    return Clearances(y.v + at.lift_left - left, y.v + at.lift_right - right, rate_left, rate_right)


@kernel
def without(contact, side):
    """Return ``contact`` with the pivot on ``side`` free, and not grazing."""
    held = 0.0 if contact.held == side else contact.held
    if side == LEFT:
        return Contact(0.0, contact.right, 0.0, contact.right_yields, held)
    return Contact(contact.left, 0.0, contact.left_yields, 0.0, held)


@kernel
def touching(contact, side, yields):
    """Return ``contact`` with the pivot on ``side`` on its spring, on the inelastic branch ``yields``, elastic if 0."""
    held = 0.0 if contact.held == side else contact.held
    if side == LEFT:
        return Contact(1.0, contact.right, yields, contact.right_yields, held)
    return Contact(contact.left, 1.0, contact.left_yields, yields, held)


@kernel
def holding(contact, side, yields):
    """Return ``contact`` with the pivot on ``side`` grazing its support: free, and ``held``.

    The other pivot, if it grazed, is now on its spring, on the inelastic branch ``yields``, elastic if 0.
    """
    if contact.held == -side:
        contact = touching(contact, -side, yields)
    free = without(contact, side)
    return Contact(free.left, free.right, free.left_yields, free.right_yields, side)


@kernel
def on_ground(contact):
    """Return the number of pivots that are not in the air."""
    return int(contact.left + contact.right + abs(contact.held))
