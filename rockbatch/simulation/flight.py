"""What makes a pier leave the ground with both pivots, in words."""

import math

import numpy as np

from rockbatch.motions.motion import Motion

_ADVICE = 'flight = "guided" goes on, for a pier whose shear keys hold it'


def cause_of_flight(motion: Motion, omega_v: float | None, gravity: float, t_flight: float, t_impact: float) -> str:
    """Why a pier flies at ``t_flight`` [s], and what to do.

    Parameters
    ----------
    omega_v : float or None
        Circular frequency of the vertical vibration [rad/s]; ``None`` on a rigid base.
    gravity : float
        g [m/s²].
    t_impact : float
        Time of the last impact before [s]; NaN without one.
    """
    at = f"both pivots left the ground at {t_flight:.3f} s: "
    until, down = 0.0, 0.0
    if motion.vertical is not None:
        samples = np.append(motion.vertical, 0.0)
        down = float(np.interp(t_flight, np.arange(len(samples)) * motion.dt, samples)) / gravity
        until = float(np.abs(samples[: math.floor(t_flight / motion.dt) + 1]).max()) / gravity
    if omega_v is None or down <= -1.0 + 1e-9:
        return f"{at}the ground fell away under the pier, with a vertical acceleration of {down:.2f} g"
    if t_flight - t_impact <= math.pi / omega_v:
        return f"{at}thrown up {1000 * (t_flight - t_impact):.0f} ms after an impact; {_ADVICE}"
    hertz = omega_v / (2.0 * math.pi)
    if until == 0.0:
        return f"{at}vertical vibration of undamped springs ({hertz:.3g} Hz), excited by rocking; {_ADVICE}"
    return (
        f"{at}vertical vibration of undamped springs ({hertz:.3g} Hz) reached 1 g, {1.0 / until:.1f} times the ground's "
        f"{until:.2f} g until then; {_ADVICE}"
    )
