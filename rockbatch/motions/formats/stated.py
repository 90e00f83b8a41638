"""What a header states of its samples beside what its reader needs, and whether the samples bear it out.

A reader hands its header's statements over as they are printed (``Stated``); they are compared here, of whatever format.
A stated value that differs by rounding, or by little, is remarked; by more it is a warning; by much, the record waits to be
confirmed (``QUANTITIES``). A count that differs is an error: nobody can tell which samples are missing.
"""

import math
import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rockbatch.common.errors import Truncated
from rockbatch.common.units import acceleration_factor
from rockbatch.motions.motion import Finding, Samples

_PRINTED = re.compile(r"(?=.*\d)(?P<number>[-+]?\d*\.?(?P<decimals>\d*))(?:[EeDd](?P<power>[-+]?\d{1,3}))?")
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
    """A quantity that headers state, what of it samples have, and what it may differ by rounding, and beyond."""

    words: str
    has: Callable[[Sampled, Stated], Sequence[float]]
    advice: str
    limits: tuple[float, float]  # relative differences up to which it is remarked, and beyond which the record waits
    unit: str = "s"  # "" for that of the samples, of whatever sign
    digits: int = 1  # units of the last digit that is printed
    share: float = 0.0  # of what the samples have
    samples: int = 0


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


def _ranges(sampled: Sampled, stated: Stated) -> list[float]:
    """Return the range from the least to the largest sample."""
    return [float(np.ptp(sampled.as_read))]


def _steps(sampled: Sampled, stated: Stated) -> list[float]:
    """Return the sampling interval."""
    return [sampled.dt]


def _rates(sampled: Sampled, stated: Stated) -> list[float]:
    """Return the sampling rate."""
    return [1.0 / sampled.dt]


_SCALE, _STEP = "check its scale", "check its step"
QUANTITIES = {  # peaks in five digits, of 1.0000; times to a sample, durations to one more or less; steps as times are printed
    "peak": _Quantity("a peak of", _peaks, _SCALE, (0.05, 0.25), unit="", share=1e-4),
    "range": _Quantity("a range of", _ranges, _SCALE, (0.05, 0.25), unit="", share=1e-4),
    "time of the peak": _Quantity("its peak after", _times_of_peak, _STEP, (0.05, 0.25), samples=2),
    "duration": _Quantity("a duration of", _durations, f"{_STEP}, and whether it is cut", (0.01, 0.25), samples=2),
    "step": _Quantity("a step of", _steps, _STEP, (0.01, 0.01), digits=0, share=1e-3),
    "rate": _Quantity("a rate of", _rates, _STEP, (0.01, 0.01), "Hz", digits=0, share=1e-3),
}


def contradictions(statements: Sequence[Stated], sampled: Sampled, gravity: float) -> list[Finding]:
    """Return how the samples differ from what their header states; what is to be remarked only is without ``what``.

    Raises ``InputError`` for a count that is another one.
    """
    findings = [_contradiction(stated, sampled, gravity) for stated in statements]
    return [finding for finding in findings if finding is not None]


def _contradiction(stated: Stated, sampled: Sampled, gravity: float) -> Finding | None:
    """Return how the samples differ from a statement, if they do."""
    printed = stated.text.strip()
    number = _PRINTED.fullmatch(printed)
    if number is None:
        return None
    power = int(number["power"] or 0)
    value, digit = (float(f"{n}e{e}") for n, e in ((number["number"], power), (1, power - len(number["decimals"]))))
    if not math.isfinite(value):  # as of 9e999
        return None
    if stated.quantity == "count":
        if value != (npts := len(sampled.as_read)):
            raise Truncated(f"its header states {printed} samples, and there are {npts}; fetch it again")
        return None
    quantity, scale = QUANTITIES[stated.quantity], 1.0
    if not quantity.unit:
        value = abs(value)
    elif value == 0.0:  # not set
        return None
    if stated.unit:
        try:
            scale = sampled.factor / acceleration_factor(stated.unit, gravity)
        except ValueError:  # a unit that is not understood states nothing
            return None
    has = min((scale * has for has in quantity.has(sampled, stated)), key=lambda has: abs(has - value))
    off = abs(has - value)
    if off <= quantity.digits * digit + quantity.share * has + quantity.samples * sampled.dt + stated.within:
        return None
    unit = f" {quantity.unit or stated.unit or sampled.unit}".rstrip()
    text = f"its header states {quantity.words} {printed}{unit}, and its samples have {has:.6g}{unit}"
    noted, gross = stated.limits or quantity.limits
    apart = off / max(min(abs(has), abs(value)), sys.float_info.min)
    if apart <= noted:
        return Finding("", text)
    cut = stated.quantity == "duration" and gross < math.inf and off > _CUT
    return Finding(stated.quantity, f"{text}: {quantity.advice}", gross=apart > gross or cut)
