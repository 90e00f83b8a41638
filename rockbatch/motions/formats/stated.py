"""Statements of headers about their samples beyond those a reader needs, and their comparison with the samples.

Readers pass them on as printed (``Stated``). A stated value that differs by more than rounding gives a note if the difference is
small, a warning if it is larger, and holds the record back until confirmed if it is gross (``QUANTITIES``). A different count is
an error, since the missing samples are unknown.
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
_NEARLY = 0.95  # of the peak: larger samples may have been the peak before rounding or filtering
_CUT = 1.0  # s: difference of a rounded duration, in whatever digits it is printed


@dataclass(frozen=True)
class Stated:
    """A statement of a header about its samples; ignored if its text is no number."""

    quantity: str  # key of QUANTITIES, or "count"
    text: str  # as printed, of any sign
    unit: str = ""  # of a peak or a range; "" for the unit of the samples
    begins: float = 0.0  # time of the first sample [s], from the origin of its times
    within: float = 0.0  # tolerance beyond its last digit, if its writer lost more
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
    """A quantity in headers, its values in samples, and its tolerances by rounding and beyond."""

    words: str
    values: Callable[[Sampled, Stated], Sequence[float]]  # possible values, the closest of which is compared
    advice: str
    limits: tuple[float, float]  # relative differences: greatest for a note, least to hold the record back
    unit: str = "s"  # "" for the unit of the samples, compared without sign
    digits: int = 1  # tolerance in units of the last printed digit
    share: float = 0.0  # tolerance relative to the value of the samples
    samples: int = 0  # tolerance in sampling intervals


def _peaks(sampled: Sampled, stated: Stated) -> list[float]:
    """Return the largest absolute sample as it is, and less the mean of the samples, in their unit."""
    offsets = (0.0, sampled.as_read.mean())
    return [float(np.abs(sampled.as_read - offset).max(initial=0.0)) for offset in offsets]


def _times_of_peak(sampled: Sampled, stated: Stated) -> list[float]:
    """Return the times of all samples of 95 % of the peak or more, with or without offset."""
    either = [np.abs(sampled.values - offset) for offset in (0.0, sampled.values.mean())]
    places = np.flatnonzero(np.logical_or(*(samples >= _NEARLY * samples.max() for samples in either)))
    return list(stated.begins + sampled.dt * places)


def _durations(sampled: Sampled, stated: Stated) -> list[float]:
    """Return the number of samples times the interval [s], and that plus the time of the first sample."""
    duration = sampled.dt * len(sampled.values)
    return [duration, stated.begins + duration]


_SCALE, _STEP = "check its scale", "check its step"
QUANTITIES = {  # peaks in five digits, of 1.0000; times to a sample, durations to one more or less; steps as times are printed
    "peak": _Quantity("a peak of", _peaks, _SCALE, (0.05, 0.25), unit="", share=1e-4),
    "range": _Quantity("a range of", lambda s, _: [np.ptp(s.as_read)], _SCALE, (0.05, 0.25), unit="", share=1e-4),
    "time of the peak": _Quantity("its peak after", _times_of_peak, _STEP, (0.05, 0.25), samples=2),
    "duration": _Quantity("a duration of", _durations, f"{_STEP}, and whether it is cut", (0.01, 0.25), samples=2),
    "step": _Quantity("a step of", lambda s, _: [s.dt], _STEP, (0.01, 0.01), digits=0, share=1e-3),
    "rate": _Quantity("a rate of", lambda s, _: [1.0 / s.dt], _STEP, (0.01, 0.01), "Hz", digits=0, share=1e-3),
}


def contradictions(
    statements: Sequence[Stated], sampled: Sampled, gravity: float
) -> tuple[tuple[Finding, ...], tuple[str, ...]]:
    """Return findings on statements that the samples contradict, and notes on small differences.

    Raises ``Truncated`` for another count of samples.
    """
    found = [_contradiction(stated, sampled, gravity) for stated in statements]
    return tuple(one for one in found if isinstance(one, Finding)), tuple(one for one in found if isinstance(one, str))


def _contradiction(stated: Stated, sampled: Sampled, gravity: float) -> Finding | str | None:
    """Return the finding on a statement that the samples contradict, a note on a small difference; None within its tolerances."""
    printed = stated.text.strip()
    number = _PRINTED.fullmatch(printed)
    if number is None:
        return None
    power = int(number["power"] or 0)
    value, digit = float(f"{number['number']}e{power}"), float(f"1e{power - len(number['decimals'])}")
    if not math.isfinite(value):  # 9e999
        return None
    if stated.quantity == "count":
        if value != (npts := len(sampled.as_read)):
            raise Truncated(f"its header states {printed} samples, and there are {npts}; fetch it again")
        return None
    quantity, scale = QUANTITIES[stated.quantity], 1.0
    if not quantity.unit:
        value = abs(value)
    elif value == 0.0:  # programs write 0 for an unknown time
        return None
    if stated.unit:
        try:
            scale = sampled.factor / acceleration_factor(stated.unit, gravity)
        except ValueError:  # in an unknown unit there is nothing to compare
            return None
    nearest = min((scale * x for x in quantity.values(sampled, stated)), key=lambda x: abs(x - value))
    difference = abs(nearest - value)
    rounding = quantity.digits * digit + quantity.share * nearest + quantity.samples * sampled.dt + stated.within
    if difference <= rounding:
        return None
    unit = f" {quantity.unit or stated.unit or sampled.unit}".rstrip()
    text = f"its header states {quantity.words} {printed}{unit}, and its samples have {nearest:.6g}{unit}"
    noted, gross = stated.limits or quantity.limits
    relative = difference / max(min(abs(nearest), abs(value)), sys.float_info.min)
    if relative <= noted:
        return text
    cut = stated.quantity == "duration" and gross < math.inf and difference > _CUT
    return Finding(stated.quantity, f"{text}: {quantity.advice}", gross=relative > gross or cut)
