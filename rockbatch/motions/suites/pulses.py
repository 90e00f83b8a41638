"""Ground motions by formulas: pulses.

Each pulse starts at t = 0 and lasts T_p; with T = ``period``, f = 1/T, ω = 2π/T and a = ``amplitude``:

=======================  ======  ============================================================================
shape                    T_p     acceleration, 0 ≤ t ≤ T_p
=======================  ======  ============================================================================
sine                     T       a sin ωt (type A: the ground moves once forward)
cosine                   T       a cos ωt (type B: forward and back); starts and ends at a
half-sine                T/2     a sin ωt
ricker                   8T/3    a (1 − 2x) exp(−x), x = (πf(t − t0))², t0 = 4T/3, below 1e-6 a at both ends;
                                 f is where its Fourier spectrum peaks
mavroeidis-papageorgiou  γT      derivative of v(t) = A/2 [1 + cos(2πf/γ τ)] cos(2πf τ + ν), τ = t − γT/2,
                                 with A such that the largest absolute value of the formula is a
=======================  ======  ============================================================================

Sine and cosine: Palmeri & Makris (2007), Figs. 5 and 6. Mavroeidis & Papageorgiou (2003), BSSA 93(3),
1099–1131, eq. 3.
"""

import math
from collections.abc import Callable, Collection
from functools import partial

import numpy as np

from rockbatch.common.arguments import checked
from rockbatch.common.errors import Contradiction, MissingKey, OutOfRange, Problem, Unusual, WrongType, refuse
from rockbatch.common.grouping import closest
from rockbatch.common.units import GRAVITY
from rockbatch.motions.motion import MOST_SAMPLES, Initial, Motion, Samples

SHAPES = ("sine", "cosine", "half-sine", "ricker", "mavroeidis-papageorgiou")

MOST_PULSE = 3.0
"""Amplitude [g] beyond which a wrong unit is likely; pulses of near-fault records have 0.1 to 1 g."""

LEAST_SAMPLES = 5.0
"""Samples in a period; with fewer a sine loses a fifth of its peak and more."""

_ON_A_SAMPLE = 1e-9  # of dt: a pulse whose end falls on a sample includes it, whatever the rounding


@checked
def pulse(
    shape: str,
    *,
    name: str,
    amplitude: float,
    period: float,
    dt: float,
    duration: float,
    gamma: float | None = None,
    nu: float | None = None,
    confirm: Collection[str] = (),
) -> Motion:
    """Return a pulse, sampled: its formula at t_i = i·dt up to its end, then zeros up to ``duration``.

    Parameters
    ----------
    shape : str
        One of ``SHAPES``; formulas at the head of this module.
    name : str
        Name in tables.
    amplitude : float
        Peak acceleration a of the formula [m/s²]; samples may miss the peak itself.
    period : float
        T [s].
    dt, duration : float
        Sampling interval and length of the motion [s]; it has round(duration/dt) + 1 samples.
    gamma, nu : float
        Number of oscillations γ > 1 and phase ν [rad], for "mavroeidis-papageorgiou" only.
    confirm : collection of str
        "amplitude" and "dt", if unusual values are correct.

    Raises
    ------
    InputError
        With every impossible value, and every unusual one that is not confirmed.

    Examples
    --------
    >>> motion = rb.pulse("sine", name="one-sine", amplitude=9.81, period=0.5, dt=0.005, duration=2.0)
    >>> motion
    <ground motion one-sine>
      samples  401 at 0.005 s: 2.00 s
      PGA      1.000 g
      from     pulse
    """
    problems = _problems(shape, amplitude, period, dt, duration, gamma, nu)
    if not name.strip():
        problems.append(Problem("name", name, "write the name that the pulse shall have in tables", kind=MissingKey))
    refuse(problems)
    doubts = unlikely(abs(amplitude) / GRAVITY, period, dt)
    values = {"amplitude": amplitude, "dt": dt}
    refuse(
        Problem(key, values[key], text, confirm=key, kind=Unusual) for key, text in doubts.items() if key not in confirm
    )
    formula, length = _formula(shape, amplitude, period, gamma, nu)
    t = np.arange(round(duration / dt) + 1, dtype=np.float64) * dt
    acceleration = np.zeros_like(t)
    inside = t <= length + _ON_A_SAMPLE * dt
    acceleration[inside] = formula(t[inside])
    note = f"{shape} pulse, peak {amplitude:g} m/s², T = {period:g} s"
    if gamma is not None and nu is not None:
        note += f", gamma = {gamma:g}, nu = {nu:g} rad"
    return Motion(
        name, dt, acceleration, source="pulse", notes=(note,), initial=Initial(), confirm=("dt",), recorded=False
    )


def unlikely(amplitude_g: float, period: float, dt: float) -> dict[str, str]:
    """Return messages by key: "amplitude" if above 3 g, and "dt" [s] if above a fifth of the period [s]; {} for usual values."""
    doubts = {}
    if amplitude_g > MOST_PULSE:
        doubts["amplitude"] = (
            f"{amplitude_g:.3g} g are more than {MOST_PULSE:g} g, where pulses of near-fault records have 0.1 to 1 g"
        )
    if dt * LEAST_SAMPLES > period * (1.0 + _ON_A_SAMPLE):
        doubts["dt"] = f"{period / dt:.2g} samples in a period of {period:g} s, which miss the pulse's peak; 50 do well"
    return doubts


def pulse_length(shape: str, period: float, gamma: float | None = None) -> float:
    """Return the duration T_p [s] of a pulse of ``period`` [s], by the table at the head of this module."""
    return _formula(shape, 1.0, period, gamma, 0.0)[1]


def _problems(
    shape: str, amplitude: float, period: float, dt: float, duration: float, gamma: float | None, nu: float | None
) -> list[Problem]:
    """Return the problems of impossible values of a pulse; [] if all are possible."""
    impossible = partial(Problem, kind=OutOfRange)
    times = {"period": period, "dt": dt, "duration": duration}
    wrong = [impossible(key, t, "must be a number above 0 [s]") for key, t in times.items() if not 0.0 < t < math.inf]
    if not wrong and duration / dt > MOST_SAMPLES:
        wrong.append(impossible("dt", dt, f"more than {MOST_SAMPLES:,} samples in {duration:g} s; take a larger one"))
    times_are_sound = not wrong
    if not math.isfinite(amplitude) or amplitude == 0:
        wrong.append(impossible("amplitude", amplitude, "must be a number other than 0 [m/s²]"))
    if shape not in SHAPES:
        nearest = closest(shape, SHAPES)
        hint = f'; did you mean "{nearest}"?' if nearest else ""
        wrong.append(Problem("shape", shape, f"must be one of {', '.join(SHAPES)}{hint}", kind=WrongType))
    elif shape == "mavroeidis-papageorgiou":
        if gamma is None or not 1.0 < gamma < math.inf:
            wrong.append(impossible("gamma", gamma, f"a {shape} pulse needs its number of oscillations, above 1"))
        if nu is None or not math.isfinite(nu):
            wrong.append(impossible("nu", nu, f"a {shape} pulse needs its phase [rad]"))
    elif gamma is not None or nu is not None:
        text = f'gamma and nu have no meaning for shape = "{shape}": leave them out'
        wrong.append(Problem("gamma", gamma, text, kind=Contradiction, named=False))
    if times_are_sound and dt >= period:
        wrong.append(impossible("dt", dt, f"must be below the period, {period:g} s (a fiftieth of it is usual)"))
    if not wrong and duration < (length := pulse_length(shape, period, gamma)) * (1 - 1e-9):
        wrong.append(impossible("duration", duration, f"the pulse lasts {length:g} s; write that or more"))
    return wrong


def _formula(
    shape: str, a: float, period: float, gamma: float | None, nu: float | None
) -> tuple[Callable[[Samples], Samples], float]:
    """Return the acceleration [m/s²] as a function of time [s], and its duration [s]."""
    omega = 2.0 * math.pi / period
    if shape in ("sine", "half-sine"):
        return lambda t: a * np.sin(omega * t), period if shape == "sine" else period / 2
    if shape == "cosine":
        return lambda t: a * np.cos(omega * t), period
    if shape == "ricker":
        t0 = 4.0 * period / 3.0

        def ricker(t: Samples) -> Samples:
            x = (math.pi * (t - t0) / period) ** 2
            return a * (1.0 - 2.0 * x) * np.exp(-x)

        return ricker, 2.0 * t0
    assert gamma is not None
    assert nu is not None
    length = gamma * period
    factor = a / _peak(gamma, nu)
    return lambda t: factor * _mavroeidis_papageorgiou(t / period, gamma, nu), length


def _mavroeidis_papageorgiou(cycles: Samples, gamma: float, nu: float) -> Samples:
    """Return the dimensionless acceleration (dv/dt)/(A ω/2) of the velocity pulse at t/T = ``cycles``; 0 at both ends."""
    tau = 2.0 * np.pi * (cycles - gamma / 2.0)
    return -(np.sin(tau / gamma) * np.cos(tau + nu) / gamma + np.sin(tau + nu) * (1.0 + np.cos(tau / gamma)))


def _peak(gamma: float, nu: float) -> float:
    """Return the largest absolute value of the dimensionless acceleration, to 1e-9, by a grid and a finer one at its peak."""
    cycles = np.linspace(0.0, gamma, math.ceil(2000 * gamma) + 1)
    i = int(np.abs(_mavroeidis_papageorgiou(cycles, gamma, nu)).argmax())
    fine = np.linspace(cycles[max(i - 1, 0)], cycles[min(i + 1, len(cycles) - 1)], 2001)
    return float(np.abs(_mavroeidis_papageorgiou(fine, gamma, nu)).max())
