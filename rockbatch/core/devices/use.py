"""Demands on devices in a run: greatest forces, strokes and speeds, and energies."""

from rockbatch.core.devices.elongation import lifted
from rockbatch.core.devices.laws import HYSTERETIC, MAXWELL, OPENS, SPRING, TAUT, TENDON, VISCOUS, force, slip_rate
from rockbatch.core.devices.pull import END, START
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.roots import highest_within, largest_within, steepest_within


@inlined
def _greatest(f0, d0, f1, d1, h, best):
    """Return the greater of ``best`` and the greatest |f| of the Hermite cubic in a part of ``h`` [s], its start included."""
    return largest_within(f0, d0, f1, d1, h, max(best, abs(f0)))[1]


@kernel
def _include_braced_viscous(devices, j, h):
    """Include a smooth part of ``h`` [s] in stroke and speed of a braced viscous damper; return the greatest |force| [m/s²].

    Stroke and speed are those of the damper itself, without its brace.
    """
    of, line = devices.elements[j], devices.use[j]
    was, now = devices.x[j], devices.end[j]
    slips, slips_end = slip_rate(of, was), slip_rate(of, now)
    way = devices.gaps[START, j].elongation - was / of.stiffness
    way_end = devices.gaps[END, j].elongation - now / of.stiffness
    line.stroke = _greatest(way, slips, way_end, slips_end, h, line.stroke)
    pull = _greatest(was, devices.rates[START, j], now, devices.rates[END, j], h, 0.0)
    line.speed = max(line.speed, slip_rate(of, pull))
    return pull


@kernel
def _include_braced_hysteretic(devices, j, h):
    """Include a smooth part of ``h`` [s] in stroke and speed of a hysteretic damper, without its brace."""
    of, line = devices.elements[j], devices.use[j]
    brace = of.give / of.stiffness
    was, now = devices.gaps[START, j], devices.gaps[END, j]
    speed, speed_end = was.speed - brace * devices.rates[START, j], now.speed - brace * devices.rates[END, j]
    way, way_end = was.elongation - brace * devices.x[j], now.elongation - brace * devices.end[j]
    line.stroke = _greatest(way, speed, way_end, speed_end, h, line.stroke)
    line.speed = max(line.speed, abs(speed), abs(speed_end), steepest_within(way, speed, way_end, speed_end, h))


@kernel
def _include_unbraced(devices, j, k, k_end, h):
    """Include a smooth part of ``h`` [s] in stroke and speed of a device without a brace."""
    line, was, now = devices.use[j], devices.gaps[START, j], devices.gaps[END, j]
    line.stroke = _greatest(was.elongation, was.speed, now.elongation, now.speed, h, line.stroke)
    lift, lift_end = lifted(was, k), lifted(now, k_end)
    line.speed = _greatest(was.speed, lift, now.speed, lift_end, h, line.speed)


@kernel
def _greatest_force(devices, j, h):
    """Return the greatest |force| [m/s²] of a device in a smooth part of ``h`` [s], which its stroke and speed already include.

    For viscous dampers and springs it is that of the run so far, for stops and friction that at the end of the part.
    """
    of, line, was, now = devices.elements[j], devices.use[j], devices.gaps[START, j], devices.gaps[END, j]
    if of.kind == VISCOUS:
        return force(of, 0.0, line.speed, 0.0, TAUT, OPENS)
    if of.kind == SPRING:
        return of.stiffness * line.stroke
    if of.kind == HYSTERETIC:
        return of.strength * max(abs(devices.x[j]), abs(devices.end[j]))
    longest = now.elongation
    if of.kind == TENDON:
        longest = highest_within(was.elongation, was.speed, now.elongation, now.speed, h)
    return abs(force(of, longest, now.speed, devices.end[j], devices.modes[j], devices.goes[j]))


@kernel
def _take_in(devices, k, k_end, h):
    n = len(devices.elements)
    for j in range(n):
        of, line = devices.elements[j], devices.use[j]
        if of.kind == MAXWELL:
            pull = _include_braced_viscous(devices, j, h)
        elif of.give > 0.0:
            _include_braced_hysteretic(devices, j, h)
            pull = _greatest_force(devices, j, h)
        else:
            _include_unbraced(devices, j, k, k_end, h)
            pull = _greatest_force(devices, j, h)
        line.most, line.lost = max(line.most, pull), devices.end[n + j]
        line.yielded = devices.end[j] if of.kind == TENDON else 0.0


@inlined
def take_in(devices, k, k_end, h):
    """Include a smooth part of ``h`` [s] in the Use of all devices; ``k`` and ``k_end`` are the pier's rates at its ends."""
    if devices is not None:
        _take_in(devices, k, k_end, h)
