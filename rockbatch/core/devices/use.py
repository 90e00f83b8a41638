"""Use of devices in a run: greatest forces, strokes and speeds, energies."""

from rockbatch.core.devices.elongation import lifted
from rockbatch.core.devices.laws import MAXWELL, OPENS, TAUT, TENDON, VISCOUS, force, slip_rate
from rockbatch.core.devices.pull import END, START
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.roots import hermite, largest_within


@kernel
def _of_braced(devices, j, h):
    """Bring the use of a braced viscous damper up to a smooth part of ``h`` [s]; return its greatest |force| there [m/s²].

    Stroke and speed are those of the damper itself, without its brace.
    """
    of, line = devices.elements[j], devices.use[j]
    was, now = devices.x[j], devices.end[j]
    slips, slips_end = slip_rate(of, was), slip_rate(of, now)
    way = devices.gaps[START, j].elongation - was / of.stiffness
    way_end = devices.gaps[END, j].elongation - now / of.stiffness
    line.stroke = largest_within(way, slips, way_end, slips_end, h, line.stroke)[1]
    pull = largest_within(was, devices.rates[START, j], now, devices.rates[END, j], h, 0.0)[1]
    line.speed = max(line.speed, slip_rate(of, pull))
    return pull


@kernel
def _of_braced_steel(devices, j, h):
    """Bring stroke and speed of a hysteretic damper, without its brace, up to a smooth part of ``h`` [s]."""
    of, line = devices.elements[j], devices.use[j]
    brace = of.give / of.stiffness
    was, now = devices.gaps[START, j], devices.gaps[END, j]
    speed, speed_end = was.speed - brace * devices.rates[START, j], now.speed - brace * devices.rates[END, j]
    way, way_end = was.elongation - brace * devices.x[j], now.elongation - brace * devices.end[j]
    line.stroke = largest_within(way, speed, way_end, speed_end, h, line.stroke)[1]
    line.speed = max(line.speed, abs(speed), abs(speed_end))


@kernel
def _take_in(devices, k, k_end, h):
    n = len(devices.elements)
    for j in range(n):
        of, line = devices.elements[j], devices.use[j]
        if of.kind == MAXWELL:
            pull = _of_braced(devices, j, h)
            line.most, line.lost = max(line.most, pull), devices.end[n + j]
            continue
        was, now = devices.gaps[START, j], devices.gaps[END, j]
        if of.give > 0.0:
            _of_braced_steel(devices, j, h)
        else:
            line.stroke = largest_within(was.elongation, was.speed, now.elongation, now.speed, h, line.stroke)[1]
        lift, lift_end = lifted(was, k.v_rate, k.omega), lifted(now, k_end.v_rate, k_end.omega)
        fastest_at, fastest = largest_within(was.speed, lift, now.speed, lift_end, h, line.speed)
        line.speed = fastest if of.give == 0.0 else line.speed
        pull = force(of, now.elongation, now.speed, devices.end[j], devices.modes[j], devices.goes[j])
        if of.kind == VISCOUS and fastest_at >= 0.0:
            pull = force(of, 0.0, hermite(was.speed, lift, now.speed, lift_end, h, fastest_at), 0.0, TAUT, OPENS)
        line.most, line.least = max(line.most, pull), min(line.least, pull)
        line.lost = devices.end[n + j]
        line.yielded = devices.end[j] if of.kind == TENDON else 0.0


@inlined
def take_in(devices, k, k_end, h):
    """Bring the use of all devices up to a smooth part of ``h`` [s], by the pier's rates and their own gaps at both ends."""
    if devices is not None:
        _take_in(devices, k, k_end, h)
