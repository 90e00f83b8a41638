"""Explain in words why both pivots of a pier leave the ground."""

import math

import numpy as np

from rockbatch.motions.motion import Motion
from rockbatch.simulation.models import acceleration_at

_ADVICE = 'flight = "guided" goes on, for a pier whose shear keys hold it'
_DAMP = f"see zeta, the damping of the supports; or {_ADVICE}"


def cause_of_flight(
    motion: Motion, omega_v: float | None, gravity: float, t_flight: float, t_impact: float, zeta: float = 0.0
) -> str:
    """Return why a pier flies at ``t_flight`` [s], and what to do, in words.

    Parameters
    ----------
    omega_v : float or None
        Circular frequency of the vertical vibration [rad/s]; ``None`` on a rigid base.
    gravity : float
        g [m/s²].
    t_impact : float
        Time of the last impact before [s]; NaN without one.
    zeta : float
        Damping of the vertical vibration, as a share of critical.
    """
    opening = f"both pivots left the ground at {t_flight:.3f} s: "
    peak, down = 0.0, 0.0
    if motion.vertical is not None:
        down = float(acceleration_at(motion.vertical, motion.dt, t_flight)) / gravity
        peak = float(np.abs(motion.vertical[: math.floor(t_flight / motion.dt) + 1]).max()) / gravity
    if omega_v is None or down <= -1.0 + 1e-9:
        return f"{opening}the ground fell away under the pier, with a vertical acceleration of {down:.2f} g"
    if t_flight - t_impact <= math.pi / omega_v:
        return f"{opening}thrown up {1000 * (t_flight - t_impact):.0f} ms after an impact; {_ADVICE}"
    oscillator = f"vertical oscillator of {omega_v / (2.0 * math.pi):.3g} Hz, damping {100.0 * zeta:.3g} %"
    if peak == 0.0:
        return f"{opening}{oscillator}, excited by rocking; {_DAMP}"
    times = f"{1.0 / peak:.1f} times the ground's {peak:.2f} g until then"
    return f"{opening}{oscillator}, reached 1 g, {times}; {_DAMP}"
