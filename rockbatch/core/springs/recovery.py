"""Damped supports: a dashpot beside each spring, viscoelastic recovery without the pivot (THEORY.md, Damped supports).

A support without mass and without its pivot follows F_y z + C ẇ = 0: z decays with τ = C/K, and what bears the pivot
again is the top of the support, at the unstressed position plus δ_y z. The decay is had in closed form, because
Runge–Kutta steps that resolve the springs are unstable where τ is short. Functions that take ``m`` do nothing where the
model is not damped, and cost nothing there.
"""

from rockbatch.core.kernel import inlined
from rockbatch.core.springs.model import State

_HALVINGS = 6
_LARGEST = 40.0  # e⁻⁴⁰ is less than rounding
_DEGREE = 15  # of the series for arguments up to 40/2⁶: what is left is 3e-17


@inlined
def decay(x):
    """Return e⁻ˣ for x ≥ 0, by arithmetic alone: a call of ``exp`` would keep loops over lanes from becoming vector code."""
    part = -min(x, _LARGEST) / 2**_HALVINGS
    series = 1.0 + part / _DEGREE
    for k in range(_DEGREE - 1, 1, -1):
        series = 1.0 + part * series / k
    less = part * series  # e⁻ˣ − 1, of a share of x, then of twice the share, and so on
    for _ in range(_HALVINGS):
        less = less * (less + 2.0)
    return 1.0 + less


@inlined
def quickness(m):
    """Return 1/τ = K/C [1/s] of damped supports."""
    return m.yield_force * m.stiffness / m.damping


@inlined
def lag(m):
    """Return C/F_y [s/m]: force over F_y of a damped support's dashpot, per velocity."""
    return m.damping / m.yield_force


@inlined
def top(m, unstressed, z):
    """Return the position [m] of the top of a support that is ``unstressed`` there, without its pivot."""
    return unstressed + m.yield_deflection * z if m.damped is not None else unstressed


@inlined
def velocity_of_top(m, z):
    """Return the velocity [m/s] of the top of a support without its pivot."""
    return -m.yield_deflection * z * quickness(m) if m.damped is not None else 0.0


@inlined
def acceleration_of_top(m, z):
    """Return the acceleration [m/s²] of the top of a support without its pivot."""
    if m.damped is not None:
        quick = quickness(m)
        return m.yield_deflection * z * quick * quick
    return 0.0


@inlined
def recovery_rate(m, rate, z, on_spring):
    """Return the rate of z [1/s]: ``rate`` on the spring, that of the recovery without its pivot."""
    return rate if m.damped is None or on_spring != 0.0 else -z * quickness(m)


@inlined
def share_left(m, h):
    """Return the share of z that is left after ``h`` [s] without the pivot."""
    return decay(h * quickness(m)) if m.damped is not None else 1.0


@inlined
def with_recovery(m, y, start, contact, share):
    """Return ``y``, some time after ``start``, with the ``share`` of z that is left to supports without their pivots."""
    if m.damped is None:
        return y
    left = y.z_left if contact.left != 0.0 else share * start.z_left
    right = y.z_right if contact.right != 0.0 else share * start.z_right
    return State(y.v, y.theta, y.v_rate, y.omega, left, right)


@inlined
def forces(m, y, contact, at):
    """Return the forces F_L/M and F_R/M [m/s²] of both supports on their pivots, whose geometry is ``at``."""
    left, right = m.yield_force * y.z_left, m.yield_force * y.z_right
    if m.damped is not None:
        left = contact.left * (left + m.damping * (y.v_rate + at.arm_left * y.omega))
        right = contact.right * (right + m.damping * (y.v_rate + at.arm_right * y.omega))
    return left, right
