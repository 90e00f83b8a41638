"""Sampling intervals and rates in headers of tables, as people and programs write them."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from rockbatch.common.errors import InputError
from rockbatch.motions.limits import HUGE, SAME_STEP

SECOND = (
    *("s", "sec", "secs", "second", "seconds", "sek", "sekunde", "sekunden", "seg", "segundo", "segundos"),
    *("seconde", "secondes", "secondo", "secondi", "sn", "saniye", "сек", "秒"),
)
"""Words and signs of a second."""

SECONDS = dict.fromkeys(SECOND, 1.0) | {"ms": 1e-3, "msec": 1e-3}
"""Units of time [s]."""


_SLOWEST = 1.0  # Hz: a lower "rate" is probably an interval
_RATE_UNITS = ("hz", "sps", "samples/sec", "samples/s", "pts/sec", "points/sec", "1/s")
_SAMPLE = r"sampl(?:e|es|ing)[ _-]?"
_INTERVAL = (
    rf"dt|delta ?t|Δt|time[ _-]?(?:step|increment|interval)|{_SAMPLE}(?:interval|period|step|time)|"
    "intervalo? de (?:muestreo|tiempo|amostragem)|paso de tiempo|pas de timp|pas d['e] ?(?:temps|[eé]chantillonnage)|"
    "passo di campionamento|intervallo di campionamento|abtastintervall|zeitschritt|örnekleme aral[iı]ğ[iı]|"
    "采样间隔|サンプリング(?:間隔|周期)"
)
_RATE = (
    rf"{_SAMPLE}(?:rate|freq(?:uency)?)|samples[ _-]per[ _-]sec(?:ond)?|sps|(?:frecuencia|tasa) de muestreo|"
    "muestreo(?=[^A-Za-z]*Hz[^A-Za-z]*$)|"
    "taxa de amostragem|fr[eé]quence d'[eé]chantillonnage|frequenza di campionamento|abtastrate|örnekleme frekans[iı]|"
    "采样(?:率|频率)|サンプリング(?:周波数|レート)"
)
_SPACED = r"(?:equally[ _-])?spaced at|(?:equal|time|sec) intervals? of|at intervals? of"
_STEP_UNITS = "|".join(re.escape(unit) for unit in sorted((*SECONDS, *_RATE_UNITS), key=len, reverse=True))
STEP = re.compile(
    rf"(?<![A-Za-z])(?:(?P<interval>{_INTERVAL}|{_SPACED})|(?P<rate>{_RATE}))(?![A-Za-z])"
    rf"(?:[ _]?(?:[(\[]\s*(?P<before>{_STEP_UNITS})\.?\s*[)\]]|(?P<suffix>s|sec|ms|hz)(?=\s*[:=])))?"
    r"\s*+[:=;]?\s*+(?P<number>[-+]?(?:\d+[.,]?\d*|[.,]\d+)(?:[ed][-+]?\d+)?)"
    rf"(?:\s*[(\[]?\s*(?P<behind>{_STEP_UNITS})(?![A-Za-z]))?",
    re.IGNORECASE,
)
OF_OTHER_DATA = re.compile(
    r"\b(?:original(?:ly)?|raw|recorder|instrument(?![^:=]* correct)|resampled|from|was|were)\b[^:=]*$", re.IGNORECASE
)


@dataclass(frozen=True)
class StatedStep:
    """A sampling interval [s], and the words that state it."""

    dt: float
    words: str


def stated_step(header: Sequence[str]) -> StatedStep | None:
    """Return the interval in a line such as ``dt = 0.01 s``, ``Sampling rate: 200 Hz`` or ``NPTS= 4000, DT= .0050 SEC``.

    ``None`` without one. Intervals of other data ("original dt = 0.005") do not count. Raises ``InputError`` for two that
    differ by over 1 %, and for numbers that are no intervals.
    """
    matches = (match for line in header for match in STEP.finditer(line))
    steps = [_step(match) for match in matches if not OF_OTHER_DATA.search(match.string[: match.start()])]
    for step in steps[1:]:
        if abs(step.dt - steps[0].dt) > SAME_STEP * steps[0].dt:
            raise InputError(
                f'the header says "{steps[0].words}" and "{step.words}", {steps[0].dt:g} s and {step.dt:g} s; '
                "correct the one that is wrong"
            )
    return steps[0] if steps else None


def _step(match: re.Match[str]) -> StatedStep:
    """Return the interval that a match states, in s without a unit, or by a rate; raise ``InputError`` for impossible numbers."""
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
