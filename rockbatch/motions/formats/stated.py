"""What a header states of its samples beside what its reader needs, and whether the samples bear it out.

A reader hands its header's statements over as they are printed (``Stated``); they are compared here, of whatever format.
A stated value that differs by rounding, or by little, is remarked; by more it is a warning; by much, the record waits to be
confirmed (``_LIMITS``). A count that differs is an error: nobody can tell which samples are missing.
"""

import math
import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rockbatch.common.errors import InputError
from rockbatch.common.units import acceleration_factor
from rockbatch.motions.motion import Finding, Samples

_PRINTED = re.compile(r"(?=.*\d)(?P<number>[-+]?\d*\.?(?P<decimals>\d*))(?:[EeDd](?P<power>[-+]?\d{1,3}))?")
_FIVE_DIGITS = 1e-4  # relative: half of the last of five digits, of 1.0000
_SAME_STEP = 1e-3  # relative: what printing of times may cost their mean step
_ENDS = 2  # samples: that a duration may count more, or less; and what times may be off
_NEARLY = 0.95  # of the peak: samples beyond may have been it before they were rounded, or filtered
_CUT = 1.0  # s: what a stated duration that is rounded may differ, in whatever digits it is printed


@dataclass(frozen=True)
class Stated:
    """A statement of a header about its samples; without a number in its text it states nothing."""

    quantity: str  # of QUANTITIES
    text: str  # as it is printed, of any sign
    unit: str = ""  # of a peak or a range; "" for that of the samples
    begins: float = 0.0  # time of the first sample [s], where times count from another one
    within: float = 0.0  # what it may be off besides its last digit, where its writer lost more
    limits: tuple[float, float] | None = None  # instead of those of the quantity


@dataclass(frozen=True)
class Sampled:
    """The samples that statements are about."""

    values: Samples  # in unit, shape (npts,)
    dt: float  # [s]
    unit: str
    factor: float  # m/s² per unit
    as_read: Samples  # values before they were interpolated


@dataclass(frozen=True)
class _Quantity:
    """A quantity that headers state: its words, what of it samples have, and what it may differ.

    ``limits`` are relative differences up to which it is remarked, and beyond which the record waits.
    """

    words: str
    has: Callable[[Sampled, Stated], Sequence[float]]
    allowed: Callable[
        [Sampled, float, float], float
    ]  # of the samples, what they have, and the last digit that is printed
    limits: tuple[float, float]
    advice: str
    unit: str = "s"  # "" for that of the samples


def _peaks(sampled: Sampled, stated: Stated) -> list[float]:
    """Return the peak of the samples with their offset and without it."""
    return [_largest(sampled.as_read - offset) for offset in (0.0, sampled.as_read.mean())]


def _largest(samples: Samples) -> float:
    return float(np.abs(samples).max(initial=0.0))


def _times_of_peak(sampled: Sampled, stated: Stated) -> list[float]:
    """Return the times of all samples that may have been the peak."""
    either = [np.abs(sampled.values - offset) for offset in (0.0, sampled.values.mean())]
    places = np.flatnonzero(np.logical_or(*(samples >= _NEARLY * samples.max() for samples in either)))
    return list(stated.begins + sampled.dt * places)


def _durations(sampled: Sampled, stated: Stated) -> list[float]:
    """Return the duration, and the time of the end."""
    duration = sampled.dt * len(sampled.values)
    return [duration, stated.begins + duration]


def _rounded(sampled: Sampled, has: float, printed: float) -> float:
    return printed + _FIVE_DIGITS * has


def _in_samples(sampled: Sampled, has: float, printed: float) -> float:
    return printed + _ENDS * sampled.dt


def _same_step(sampled: Sampled, has: float, printed: float) -> float:
    return _SAME_STEP * has


_SCALE, _STEP = "check its scale", "check its step"
QUANTITIES = {
    "peak": _Quantity("a peak of", _peaks, _rounded, (0.05, 0.25), _SCALE, unit=""),
    "range": _Quantity(
        "a range of", lambda sampled, _: [float(np.ptp(sampled.as_read))], _rounded, (0.05, 0.25), _SCALE, ""
    ),
    "time of the peak": _Quantity("its peak after", _times_of_peak, _in_samples, (0.05, 0.25), _STEP),
    "duration": _Quantity("a duration of", _durations, _in_samples, (0.01, 0.25), f"{_STEP}, and whether it is cut"),
    "step": _Quantity("a step of", lambda sampled, _: [sampled.dt], _same_step, (0.01, 0.01), _STEP),
    "rate": _Quantity("a rate of", lambda sampled, _: [1.0 / sampled.dt], _same_step, (0.01, 0.01), _STEP, "Hz"),
}


def contradictions(statements: Sequence[Stated], sampled: Sampled, gravity: float) -> list[Finding]:
    """Return how the samples differ from what their header states; what is to be remarked only is without ``what``.

    Raises ``InputError`` for a count that is another one.
    """
    findings = [_contradiction(stated, sampled, gravity) for stated in statements]
    return [finding for finding in findings if finding is not None]


def _contradiction(stated: Stated, sampled: Sampled, gravity: float) -> Finding | None:
    number = _PRINTED.fullmatch(stated.text.strip())
    if number is None:
        return None
    power = int(number["power"] or 0)
    value, printed = (
        float(f"{digits}e{exponent}")  # as 10.0**999 is an error
        for digits, exponent in ((number["number"].lstrip("+-"), power), (1, power - len(number["decimals"])))
    )
    if not math.isfinite(value):
        return None
    if stated.quantity == "count":
        if value != len(sampled.as_read):
            raise InputError(
                f"its header states {stated.text.strip()} samples, and there are {len(sampled.as_read)}; fetch it again"
            )
        return None
    quantity = QUANTITIES[stated.quantity]
    scale = 1.0
    if stated.unit:
        try:
            scale = acceleration_factor(stated.unit, gravity) / sampled.factor
        except ValueError:  # a unit that is not understood states nothing
            return None
    elif quantity.unit and value == 0.0:  # not set
        return None
    has = min((has / scale for has in quantity.has(sampled, stated)), key=lambda has: abs(has - value))
    off = abs(has - value)
    if off <= stated.within + quantity.allowed(sampled, has, printed):
        return None
    unit = quantity.unit or stated.unit or sampled.unit
    text = " ".join(
        f"its header states {quantity.words} {stated.text.strip()} {unit}, and its samples have {has:.6g} {unit}".split()
    )
    return _judged(stated, quantity, off, off / max(min(has, value), sys.float_info.min), text.replace(" ,", ","))


def _judged(stated: Stated, quantity: _Quantity, off: float, apart: float, text: str) -> Finding:
    """Return the finding of a statement that is ``off``, or relatively ``apart``."""
    noted, gross = stated.limits or quantity.limits
    if apart <= noted:
        return Finding("", text)
    cut = stated.quantity == "duration" and gross < math.inf and off > _CUT
    return Finding(stated.quantity, f"{text}: {quantity.advice}", gross=apart > gross or cut)
