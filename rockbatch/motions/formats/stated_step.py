"""The sampling interval that the header of a text file states, in the ways that people and programs write it."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from rockbatch.errors import InputError
from rockbatch.motions.limits import HUGE

SECONDS = {"s": 1.0, "sec": 1.0, "secs": 1.0, "second": 1.0, "seconds": 1.0, "ms": 1e-3, "msec": 1e-3}
"""Units of time [s]."""

SAME_STEP = 0.01
"""Relative: intervals that differ by less are the same one, printed with few decimals (1/256 s as .0039)."""

_SLOWEST = 1.0  # Hz: a number below it that is called a rate is rather an interval
_RATE_UNITS = ("hz", "sps", "samples/sec", "samples/s", "pts/sec", "points/sec", "1/s")
_SAMPLE = r"sampl(?:e|es|ing)[ _-]?"
_INTERVAL = rf"dt|delta ?t|Δt|time[ _-]?(?:step|increment|interval)|{_SAMPLE}(?:interval|period|step|time)"
_RATE = rf"{_SAMPLE}(?:rate|freq(?:uency)?)|samples[ _-]per[ _-]sec(?:ond)?|sps"
_SPACED = r"(?:equally[ _-])?spaced at|(?:equal|time|sec) intervals? of|at intervals? of"
_UNITS = "|".join(re.escape(unit) for unit in sorted((*SECONDS, *_RATE_UNITS), key=len, reverse=True))
_STATED = re.compile(
    rf"(?<![A-Za-z])(?:(?P<interval>{_INTERVAL}|{_SPACED})|(?P<rate>{_RATE}))(?![A-Za-z])"
    rf"(?:[ _]?(?:[(\[]\s*(?P<before>{_UNITS})\.?\s*[)\]]|(?P<suffix>s|sec|ms|hz)(?=\s*[:=])))?"
    r"\s*[:=]?\s*(?P<number>[-+]?(?:\d+[.,]?\d*|[.,]\d+)(?:[ed][-+]?\d+)?)"
    rf"(?:\s*[(\[]?\s*(?P<behind>{_UNITS})(?![A-Za-z]))?",
    re.IGNORECASE,
)
_OF_ANOTHER = re.compile(r"\b(?:original|raw|recorder|instrument|resampled|from|was|were)\b[^:=]*$", re.IGNORECASE)


@dataclass(frozen=True)
class StatedStep:
    """A sampling interval [s], and the words that state it."""

    dt: float
    words: str


def stated_step(header: Sequence[str]) -> StatedStep | None:
    """The interval of a line such as ``dt = 0.01 s``, ``Sampling rate: 200 Hz`` or ``NPTS= 4000, DT= .0050 SEC``.

    Raises ``InputError`` where a header states two, and for numbers that are no intervals.
    """
    found = [_step(match) for line in header for match in _STATED.finditer(line) if not _of_another(match)]
    for other in found[1:]:
        if abs(other.dt - found[0].dt) > SAME_STEP * found[0].dt:
            raise InputError(
                f'the header says "{found[0].words}" and "{other.words}", {found[0].dt:g} s and {other.dt:g} s; '
                "correct the one that is wrong"
            )
    return found[0] if found else None


def states_a_step(line: str) -> bool:
    """Whether a line has a sampling interval or rate in it, of whatever data."""
    return _STATED.search(line) is not None


def _of_another(match: re.Match[str]) -> bool:
    """Whether a statement is about data that these were made of."""
    return _OF_ANOTHER.search(match.string[: match.start()]) is not None


def _step(match: re.Match[str]) -> StatedStep:
    words = match[0].strip()
    unit = (match["behind"] or match["before"] or match["suffix"] or "").lower()
    try:
        number = float(match["number"].lower().replace(",", ".").replace("d", "e"))
    except ValueError:
        number = 0.0
    is_rate = unit in _RATE_UNITS or (match["rate"] is not None and unit not in SECONDS)
    if is_rate and not unit and number < _SLOWEST:
        raise InputError(
            f'header: found "{words}", which is no rate; expected e.g. dt = 0.01 s, or sampling rate: 100 Hz'
        )
    dt = (1.0 / number if number else 0.0) if is_rate else number * SECONDS.get(unit, 1.0)
    if not 0 < dt < HUGE:
        raise InputError(f'header: found "{words}"; expected e.g. dt = 0.01 s')
    return StatedStep(float(f"{dt:.12g}"), words)
