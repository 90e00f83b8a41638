"""Two components of one station on common samples, over their common time."""

import math
from dataclasses import dataclass

import numpy as np

from rockbatch.motions.component import Component
from rockbatch.motions.limits import MOST_SAMPLES, MOST_STEPS
from rockbatch.motions.motion import Samples

_SAME_STEP = 1e-6  # relative: steps that differ by less are the same, printed otherwise
_SAME_SAMPLE = 0.01  # of dt: greatest error of a sample's time by its printing
_SIMULTANEOUS = 0.1  # of dt: starts that jitter by less count as simultaneous
_CLOCK = 1e-6  # s: times since 1970 are no better than this


@dataclass(frozen=True)
class Common:
    """Two components on common samples."""

    dt: float  # sampling interval [s]
    first: Samples  # accelerations [m/s²], shape (npts,)
    second: Samples
    begins: tuple[float, float]  # first common sample [s after the first sample of each component]
    notes: list[str]  # on interpolation and the common span


def overlap(a: Component, b: Component) -> bool:
    """Return whether two components overlap in time; True if one has no start time."""
    if a.start is None or b.start is None:
        return True
    return a.start < b.start + b.duration and b.start < a.start + a.duration


def too_unlike(a: Component, b: Component) -> str:
    """Return why steps or lengths of two components forbid common samples: a ratio or number of samples too large; else ""."""
    if max(a.dt, b.dt) > MOST_STEPS * min(a.dt, b.dt):
        return f"dt = {b.dt:g} s beside {a.dt:g} s of {a.name}, more than {MOST_STEPS} times apart"
    if min(a.duration, b.duration) > MOST_SAMPLES * min(a.dt, b.dt):
        return f"it and {a.name} would take more than {MOST_SAMPLES:,} common samples"
    return ""


def on_common_samples(first: Component, second: Component, names: tuple[str, str]) -> Common:
    """Return both components on common samples, over their common time; notes call them by ``names``.

    Components without absolute times start together. Where samples do not coincide, the first component keeps
    its own, with as many between them as make it no coarser than the second one, and both are interpolated
    linearly: exact for the first one, and for the second one where its samples are met.

    Starts that jitter by up to a tenth of the finer step count as simultaneous: as motions are linear between their
    samples, the second one is then off by less than a tenth of the largest difference of two neighbouring samples,
    and neither loses of its peak as it would by interpolation.
    """
    a, b = first.acceleration, second.acceleration
    offset, notes = _offset(first, second, names[1])
    same_step = abs(first.dt - second.dt) <= _SAME_STEP * first.dt
    shift = round(offset / first.dt)
    if same_step and abs(offset / first.dt - shift) <= _SAME_SAMPLE:
        start, end = max(0, shift), min(len(a), len(b) + shift)
        dt, a, b = first.dt, a[start:end], b[start - shift : end - shift]
        begin, offset = start * dt, shift * dt
    else:
        parts = math.ceil(first.dt / second.dt * (1 - _SAME_STEP))
        dt = first.dt / parts
        slack = _SAME_SAMPLE * dt
        earliest = max(0, math.ceil((offset - slack) / dt))
        latest = min((len(a) - 1) * parts, math.floor((offset + second.duration + slack) / dt))
        times: Samples = np.arange(float(earliest), latest + 1.0) * dt
        begin = float(times[0]) if len(times) else 0.0
        a = _interpolated(a, times / first.dt)
        b = _interpolated(b, (times - offset) / second.dt)
        moved = [names[0]] * (parts > 1) + [names[1]] * (abs(dt - second.dt) > _SAME_STEP * dt or offset != 0)
        notes.append(
            f"{' and '.join(moved)} interpolated linearly to dt = {dt:g} s, from {first.dt:g} s {names[0]} and "
            f"{second.dt:g} s {names[1]}"
        )
    span = (len(a) - 1) * dt
    if span < max(first.duration, second.duration) - 0.5 * dt:
        whole = f"{first.duration:g} s {names[0]} and {second.duration:g} s {names[1]}"
        notes.append(f"common span: {span:g} s of {whole}")
    return Common(dt, a, b, (begin, max(0.0, begin - offset)), notes)


def _interpolated(samples: Samples, places: Samples) -> Samples:
    """Return ``samples`` interpolated linearly at rising ``places`` [steps], shape of ``places``; beyond its ends as at them."""
    begin, end = (max(0, int(place)) for place in places[[0, -1]]) if len(places) else (0, 0)
    return np.interp(places, np.arange(begin, min(end + 2, len(samples))), samples[begin : end + 2])


def _offset(first: Component, second: Component, name: str) -> tuple[float, list[str]]:
    """Return the delay of the second component [s], whole steps if nearly so, with a note; 0 if a start time is unknown."""
    if first.start is None or second.start is None:
        return 0.0, []
    offset, step = second.start - first.start, min(first.dt, second.dt)
    even = round(offset / step) * step
    jitter = offset - even
    if abs(jitter) > _SIMULTANEOUS * step:
        return offset, []
    if abs(jitter) <= _CLOCK:
        return even, []
    side = "late" if jitter > 0 else "early"
    return even, [f"{name} {abs(jitter) * 1e3:.2g} ms {side}, {abs(jitter) / step:.2g} of dt: taken as simultaneous"]
