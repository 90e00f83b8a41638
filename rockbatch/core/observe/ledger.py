"""Energy balance of a recorded run: its terms, and the residual (THEORY.md, Energy ledger).

An observer: it takes the rows of a history, step by step, and integrates the power of each term by Simpson's rule, with
the state in the middle of a step from the cubic Hermite polynomial through its ends. Other runs pay nothing for it. The
residual tests equations, events and impacts at once.
"""

from typing import NamedTuple

from rockbatch.core.block.equations import lever
from rockbatch.core.block.model import Block
from rockbatch.core.flexure.ending import bending_energy, kinetic_and_potential
from rockbatch.core.flexure.model import FlexibleBlock, Flexing, Shaft
from rockbatch.core.flexure.modes import deflection_rates, deflections, dot, times
from rockbatch.core.flexure.shaft import energies_of_modes
from rockbatch.core.kernel import entry, hook, kernel, optional_hook
from rockbatch.core.observe.rows import contact_of, ground_within, state_of, step_between, within
from rockbatch.core.springs.bending import accelerations, momenta
from rockbatch.core.springs.equations import accelerations_at, geometry
from rockbatch.core.springs.impact import loss
from rockbatch.core.springs.model import BentState, Contact, Springs
from rockbatch.core.springs.recovery import forces
from rockbatch.core.system import ground_power, rates
from rockbatch.core.table import along, record, with_pull
from rockbatch.core.types import IMPACT_BOTH, IMPACT_LEFT, IMPACT_RIGHT, Pull


class Energies(NamedTuple):
    """Terms of the energy balance [J/kg]: stored relative to the start, supplied and dissipated since; the residual."""

    kinetic: float
    potential: float
    elastic: float
    input: float
    plastic: float
    impact: float
    p_delta: float
    constraint: float
    damping: float
    remainder: float


LEDGER = record(Energies)


@kernel
def _lever(at, contact):
    return at.lever + (contact.right - contact.left) * at.swing


@hook
def _stored(m, y, contact):
    """Return the kinetic, potential and elastic energy of the pier, without its devices [J/kg]."""


@_stored.of(Springs)
def _stored_on_springs(m, y, contact):
    lever = _lever(geometry(m, y.theta), contact) if m.finite is not None else m.height
    by_motion, by_height, by_bending = energies_of_modes(m.shaft, m, y, lever)
    kinetic = 0.5 * y.v_rate * y.v_rate + 0.5 * (m.inertia + lever * lever) * y.omega * y.omega
    elastic = 0.5 * m.yield_force * m.yield_deflection * (y.z_left * y.z_left + y.z_right * y.z_right)
    return kinetic + by_motion, m.gravity * y.v + by_height, elastic + by_bending


@_stored.of(Block)
def _stored_of_block(m, y, contact):
    arm = lever(m, y, contact)
    return 0.5 * (y.v_rate * y.v_rate + (m.inertia + arm * arm) * y.omega * y.omega), m.gravity * y.v, 0.0


@_stored.of(FlexibleBlock)
def _stored_of_flexible_block(m, y, contact):
    kinetic, potential = kinetic_and_potential(m, y, contact)
    return kinetic, potential, bending_energy(m, deflections(y))


@entry
def energy_of_rows(m, rows, out):
    """Compute the energy of a pier on springs or on a rigid base, without its devices, relative to the first row.

    Parameters
    ----------
    m : Springs, Block or FlexibleBlock
    rows : recarray of recording.Row, shape (n,)
        Any rows of a history.
    out : ndarray, shape (n,)
        Filled at every row [J/kg].
    """
    kinetic0, potential0, elastic0 = _stored(m, state_of(m, rows[0]), contact_of(m, rows[0]))
    for i in range(len(rows)):
        kinetic, potential, elastic = _stored(m, state_of(m, rows[i]), contact_of(m, rows[i]))
        out[i] = kinetic - kinetic0 + (potential - potential0) + (elastic - elastic0)


@optional_hook
def power_of_damping(y, shaft):
    """Return the power that the damping of the modes of a ``shaft`` takes in state ``y`` [W/kg]; 0 for a rigid one."""
    return 0.0


def _damping_of_modes(y, shaft):
    u_rate = deflection_rates(y)
    return dot(times(shaft.damping, u_rate), u_rate)


power_of_damping.of(Flexing)(_damping_of_modes)
power_of_damping.of(BentState)(_damping_of_modes)


@kernel
def _powers(m, y, k, contact, ground):
    """Return the powers [W/kg] of input, plastic work, P–Δ, constraint and dashpots with the modes' damping.

    Terms that do not occur are 0.
    """
    at = geometry(m, y.theta)
    left, right = y.v_rate + at.arm_left * y.omega, y.v_rate + at.arm_right * y.omega
    shaken = ground_power(m, y, contact, ground)
    plastic = contact.left * m.yield_force * y.z_left * (left - m.yield_deflection * k.z_left)
    plastic += contact.right * m.yield_force * y.z_right * (right - m.yield_deflection * k.z_right)
    damping = m.damping * (contact.left * left * left + contact.right * right * right)
    p_delta = 0.0
    if m.finite is None:
        force_left, force_right = forces(m, y, contact, at)
        p_delta = -m.height * y.theta * (force_left + force_right) * y.omega
    constraint = 0.0
    if contact.held != 0:
        released = Contact(contact.left, contact.right, contact.left_yields, contact.right_yields, 0)
        constraint = _holding(m.shaft, m, y, k, released, ground)
    return shaken, plastic, p_delta, constraint, damping + power_of_damping(y, m.shaft)


@hook
def _holding(shaft, m, y, k, contact, ground):
    """Return the power [W/kg] by which a grazing pivot changes the motion that the pier would have with ``contact`` alone."""


@_holding.of(type(None))
def _holding_rigid_shaft(shaft, m, y, k, contact, ground):
    at = geometry(m, y.theta)
    _, free = accelerations_at(m, y, contact, at, ground)
    lever = _lever(at, contact) if m.finite is not None else m.height
    return (m.inertia + lever * lever) * (k.omega - free) * y.omega


@_holding.of(Shaft)
def _holding_bending_shaft(shaft, m, y, k, contact, ground):
    at = geometry(m, y.theta)
    free, lever = accelerations(m, y, contact, at, ground), _lever(at, contact)
    v, turning, u = momenta(m, y, lever)
    changed = along(deflection_rates(k), free.u, -1.0)
    return v * (k.v_rate - free.v) + turning * (k.omega - free.theta) + dot(u, changed)


@kernel
def _recovered(m, contact, y, y_end):
    """Return the energy [J/kg] that supports without their pivots have lost to their dashpots in a step."""
    left = (1.0 - contact.left) * (y.z_left * y.z_left - y_end.z_left * y_end.z_left)
    right = (1.0 - contact.right) * (y.z_right * y.z_right - y_end.z_right * y_end.z_right)
    return 0.5 * m.yield_force * m.yield_deflection * (left + right)


@kernel
def pulled(m, pulls, i):
    """Return the pier under the ``pulls`` at the start, in the middle (their mean) and at the end of the step to row ``i``."""
    first, last = pulls[i - 1], pulls[i]
    middle = with_pull(m, Pull(0.5 * (first[0] + last[0]), 0.5 * (first[1] + last[1])))
    return with_pull(m, Pull(first[0], first[1])), middle, with_pull(m, Pull(last[0], last[1]))


@entry
def ledger_on_springs(m, rows, pulls, ground, dt, out):
    """Compute the energy balance of a run on two springs.

    Parameters
    ----------
    m : Springs
    rows : recarray of recording.Row, shape (n,)
        History as the run wrote it, every step.
    pulls : ndarray, shape (n, 2)
        Force [m/s²] and moment [m²/s²] of dampers and tendons at every row; the energy that they take and store is left out.
    ground : ndarray, shape (npts, 4)
        The motion of the run, of :func:`rockbatch.core.ground.ground_rows`.
    dt : float
        Its sampling interval [s].
    out : recarray of Energies, zeros, shape (n,)
        Filled at every row but the first, to which all terms are relative.
    """
    y = state_of(m, rows[0])
    kinetic0, potential0, elastic0 = _stored(m, y, contact_of(m, rows[0]))
    shaken, plastic, impact, p_delta, constraint, damping = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(1, len(rows)):
        y_end = state_of(m, rows[i])
        contact = contact_of(m, rows[i])
        kind = int(rows[i].kind)
        if kind > 0:  # the other side of an event
            at = geometry(m, y.theta)
            if kind in (IMPACT_LEFT, IMPACT_RIGHT, IMPACT_BOTH):
                impact += loss(m, y, contact_of(m, rows[i - 1]), kind)
            if m.finite is not None:
                was, now = _lever(at, contact_of(m, rows[i - 1])), _lever(at, contact)
                both = at.lever * at.lever * (y_end.omega * y_end.omega - y.omega * y.omega)
                constraint += 0.5 * (now * now * y_end.omega * y_end.omega - was * was * y.omega * y.omega - both)
                constraint += energies_of_modes(m.shaft, m, y_end, now)[0] - energies_of_modes(m.shaft, m, y, was)[0]
        else:
            start, half_way, stop = pulled(m, pulls, i)
            step = step_between(start, stop, rows[i - 1], rows[i], ground, dt)
            h, k, k_end = step.length, step.rates, step.rates_end
            middle, ground_middle = within(half_way, step, 0.5), ground_within(step, 0.5)
            k_middle = rates(half_way, middle, contact, ground_middle)
            s0, w0, d0, c0, q0 = _powers(start, y, k, contact, step.ground)
            s1, w1, d1, c1, q1 = _powers(half_way, middle, k_middle, contact, ground_middle)
            s2, w2, d2, c2, q2 = _powers(stop, y_end, k_end, contact, step.ground_end)
            shaken += h / 6.0 * (s0 + 4.0 * s1 + s2)
            plastic += h / 6.0 * (w0 + 4.0 * w1 + w2)
            p_delta += h / 6.0 * (d0 + 4.0 * d1 + d2)
            constraint += h / 6.0 * (c0 + 4.0 * c1 + c2)
            damping += h / 6.0 * (q0 + 4.0 * q1 + q2) + _recovered(m, contact, y, y_end)
        kinetic, potential, elastic = _stored(m, y_end, contact)
        line = out[i]
        line.kinetic, line.potential, line.elastic = kinetic - kinetic0, potential - potential0, elastic - elastic0
        line.input, line.plastic, line.impact = shaken, plastic, impact
        line.p_delta, line.constraint, line.damping = p_delta, constraint, damping
        stored = line.kinetic + line.potential + line.elastic
        line.remainder = stored - shaken + plastic + impact - p_delta - constraint + damping
        y = y_end


@entry
def ledger_on_rigid_base(m, rows, pulls, ground, dt, out):
    """Compute the energy balance of a run of a Block or FlexibleBlock ``m`` with the history ``rows``.

    Otherwise as :func:`ledger_on_springs`, without plastic work, P–Δ and constraint; impact is the kinetic energy lost in events.
    """
    y = state_of(m, rows[0])
    kinetic, potential0, elastic0 = _stored(m, y, contact_of(m, rows[0]))
    kinetic0, shaken, impact, damping = kinetic, 0.0, 0.0, 0.0
    for i in range(1, len(rows)):
        y_end, contact = state_of(m, rows[i]), contact_of(m, rows[i])
        kinetic_end, potential, elastic = _stored(m, y_end, contact)
        if rows[i].kind > 0:  # the other side of an event
            impact += kinetic - kinetic_end
        else:
            start, half_way, stop = pulled(m, pulls, i)
            step = step_between(start, stop, rows[i - 1], rows[i], ground, dt)
            middle = within(half_way, step, 0.5)
            s0 = ground_power(m, y, contact, step.ground)
            s1 = ground_power(m, middle, contact, ground_within(step, 0.5))
            s2 = ground_power(m, y_end, contact, step.ground_end)
            shaken += step.length / 6.0 * (s0 + 4.0 * s1 + s2)
            damping += (
                step.length
                / 6.0
                * (power_of_damping(y, m) + 4.0 * power_of_damping(middle, m) + power_of_damping(y_end, m))
            )
        line = out[i]
        line.kinetic, line.potential, line.elastic = kinetic_end - kinetic0, potential - potential0, elastic - elastic0
        line.input, line.impact, line.damping = shaken, impact, damping
        line.remainder = line.kinetic + line.potential + line.elastic - shaken + impact + damping
        y, kinetic = y_end, kinetic_end
