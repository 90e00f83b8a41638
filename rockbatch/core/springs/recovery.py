"""Damped supports: a dashpot beside each spring, viscoelastic recovery without the pivot (THEORY.md, Damped supports).

A massless support without its pivot follows F_y z + C ẇ = 0: z decays with τ = C/K, and the pivot lands on the top of the
support, at the unstressed position plus δ_y z. The decay is computed in closed form, because Runge–Kutta steps that resolve
the springs are unstable for short τ. For an undamped model, functions of ``m`` compile to nothing.
"""

from rockbatch.core.kernel import inlined
from rockbatch.core.table import with_z

_HALVINGS = 6
_LARGEST = 40.0  # e⁻⁴⁰ is less than rounding
_DEGREE = 15  # of the series for arguments up to 40/2⁶, with an error of 3e-17


@inlined
def decay(x):
    """Return e⁻ˣ for x ≥ 0 with an error of about 10⁻¹⁶, hence 0 from x = 38 on, by arithmetic alone.

    A call of ``exp`` would keep loops over lanes from being vectorised.
    """
    part = -min(x, _LARGEST) / 2**_HALVINGS
    series = 1.0 + part / _DEGREE
    for k in range(_DEGREE - 1, 1, -1):
        series = 1.0 + part * series / k
    less = part * series  # e⁻ˣ − 1 for x/2⁶, then for twice that, …, which keeps its digits
    for _ in range(_HALVINGS):
        less = less * (less + 2.0)
    return 1.0 + less


@inlined
def quickness(m):
    """Return 1/τ = K/C [1/s] of damped supports."""
    return m.yield_force * m.stiffness / m.damping


@inlined
def lag(m):
    """Return C/F_y [s/m], the dashpot's force over F_y per velocity."""
    return m.damping / m.yield_force


@inlined
def top(m, unstressed, z):
    """Return the position [m] of the top of a support without its pivot, from its ``unstressed`` position and z (if damped)."""
    return unstressed + m.yield_deflection * z if m.damped is not None else unstressed


@inlined
def velocity_of_top(m, z):
    """Return the velocity [m/s] of the top of a support without its pivot; 0 if undamped."""
    return -m.yield_deflection * z * quickness(m) if m.damped is not None else 0.0


@inlined
def acceleration_of_top(m, z):
    """Return the acceleration [m/s²] of the top of a support without its pivot; 0 if undamped."""
    if m.damped is not None:
        quick = quickness(m)
        return m.yield_deflection * z * quick * quick
    return 0.0


@inlined
def recovery_rate(m, rate, z, on_spring):
    """Return the rate of z [1/s]: ``rate`` in contact or if undamped, else that of recovery without the pivot."""
    return rate if m.damped is None or on_spring != 0.0 else -z * quickness(m)


@inlined
def share_left(m, h):
    """Return the factor by which z decays in ``h`` [s] without the pivot; 1 if undamped."""
    return decay(h * quickness(m)) if m.damped is not None else 1.0


@inlined
def with_recovery(m, y, start, contact, share):
    """Return ``y`` with z of damped supports without their pivots set to ``share`` times that of ``start``."""
    if m.damped is None:
        return y
    left = y.z_left if contact.left != 0.0 else share * start.z_left
    right = y.z_right if contact.right != 0.0 else share * start.z_right
    return with_z(y, left, right)


@inlined
def forces(m, y, contact, at):
    """Return the forces F_L/M and F_R/M [m/s²] of both supports, negative in compression; ``at`` is the Geometry."""
    left, right = m.yield_force * y.z_left, m.yield_force * y.z_right
    if m.damped is not None:
        left = contact.left * (left + m.damping * (y.v_rate + at.arm_left * y.omega))
        right = contact.right * (right + m.damping * (y.v_rate + at.arm_right * y.omega))
    return left, right
