"""Use of devices in a run: greatest forces, strokes and speeds, energies."""

import math

from rockbatch.core.devices.laws import TENDON, VISCOUS, force
from rockbatch.core.devices.pull import gap, lifted
from rockbatch.core.kernel import inlined, inner
from rockbatch.core.roots import largest_within


@inner
def _take_in(m, devices, y, k, end, k_end, h):
    n, level = len(devices.elements), devices.level[0]
    for j in range(n):
        of, line = devices.elements[j], devices.use[j]
        was, now = gap(m, of, y, level), gap(m, of, end, level)
        line.stroke = largest_within(was.elongation, was.speed, now.elongation, now.speed, h, line.stroke)[1]
        lift, lift_end = lifted(was, k.v_rate, k.omega), lifted(now, k_end.v_rate, k_end.omega)
        fastest_at, fastest = largest_within(was.speed, lift, now.speed, lift_end, h, line.speed)
        line.speed = fastest
        pull = force(of, now.elongation, now.speed, devices.end[j], devices.modes[j], devices.goes[j])
        if of.kind == VISCOUS and fastest_at >= 0.0:
            pull = math.copysign(of.coefficient * fastest**of.exponent, devices.goes[j])
        line.most, line.least = max(line.most, pull), min(line.least, pull)
        line.lost = devices.end[n + j]
        line.yielded = devices.end[j] if of.kind == TENDON else 0.0


@inlined
def take_in(m, devices, y, k, end, k_end, h):
    """Bring the use of all devices up to a smooth part of ``h`` [s] from ``y``, with rates ``k``, to ``end``."""
    if devices is not None:
        _take_in(m, devices, y, k, end, k_end, h)
