"""Use of devices in a run: greatest forces, strokes and speeds, energies."""

from rockbatch.core.devices.elongation import lifted
from rockbatch.core.devices.laws import OPENS, TAUT, TENDON, VISCOUS, force
from rockbatch.core.devices.pull import END, START
from rockbatch.core.kernel import inlined, inner
from rockbatch.core.roots import hermite, largest_within


@inner
def _take_in(devices, k, k_end, h):
    n = len(devices.elements)
    for j in range(n):
        of, line = devices.elements[j], devices.use[j]
        was, now = devices.gaps[START, j], devices.gaps[END, j]
        line.stroke = largest_within(was.elongation, was.speed, now.elongation, now.speed, h, line.stroke)[1]
        lift, lift_end = lifted(was, k.v_rate, k.omega), lifted(now, k_end.v_rate, k_end.omega)
        fastest_at, fastest = largest_within(was.speed, lift, now.speed, lift_end, h, line.speed)
        line.speed = fastest
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
