"""One recording in several files: which set of components is used.

Two components are of one recording if they point alike, and their headers name one sensor and one event, their samples are
the same, or, where headers do not decide, they correlate once aligned. The parts of a long recording, which claim one time
of triggering, are not: each file is a whole set of components, processed alike, and its samples do not correlate.
"""

import hashlib
import math
import re
from collections.abc import Hashable, Iterator, Sequence, Set
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np

from rockbatch.motions.archives import bare
from rockbatch.motions.common_span import overlap
from rockbatch.motions.component import NOWHERE, Component, file_of
from rockbatch.motions.formats import is_usual
from rockbatch.motions.motion import Finding, LeftOut, Samples
from rockbatch.motions.orientation import UNKNOWN, same_azimuth
from rockbatch.motions.plausible import gross_findings, in_a_borehole
from rockbatch.motions.stations import in_one_event, is_numbered

_CORRECTED = {True: 0, None: 1, False: 2}
_ALIKE = 0.7  # correlation: real files of one recording have 0.98 and more, other records 0.63 at most, halves 0.46
_CERTAIN = 0.95  # correlation that decides where headers do not
_SAME_STEP = 1e-3  # relative
_SAME_SHAPE = 1e-3  # of the peak: what printing a scaled copy may cost a sample
_NO_FACTOR, _GROSS_FACTOR = 0.005, 0.05  # relative: values of g, and rounding; what has to be confirmed
_UNEQUAL = 1.5  # ratio of the peaks of two copies that is reported
_SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)  # of ∫a² dt
_SPREAD, _BLUR = 0.1, 0.05  # of the significant duration, and s: how far the times of these shares may differ in copies
_SCALED = re.compile(r"(?<!un)(?<!not_)scaled", re.IGNORECASE)

Pairs = dict[int, set[int]]


def without_boreholes(components: Sequence[Component]) -> tuple[list[Component], list[LeftOut]]:
    """Return the components without those in boreholes below a sensor at the surface that recorded the same earthquake."""
    at_surface: dict[str, list[Component]] = {}
    for component in components:
        if component.seat.number and not in_a_borehole(component):
            at_surface.setdefault(component.seat.number, []).append(component)
    kept: list[Component] = []
    left_out: list[LeftOut] = []
    for component in components:
        above = at_surface.get(component.seat.number, []) if in_a_borehole(component) and not component.wanted else []
        used = next((other for other in above if in_one_event(component, other)), None)
        if used is None:
            kept.append(component)
        else:
            reason = f"in a borehole below {used.source}, which is used; use = true in motions.toml takes it too"
            left_out.append(LeftOut(component.name, component.source, reason))
    return kept, left_out


def without_doubles(components: Sequence[Component]) -> tuple[list[Component], list[LeftOut]]:
    """Return the components that are used, in their order, and the copies that are left out, with the reason.

    Sets are ranked as wholes (:func:`_ranks`), so that the components of a station come from one instrument. What a
    manifest wants (``use = true``) is always used. Copies that differ by a factor, or in their peaks, are named in the
    findings of the one that is used; where neither plausibility nor a file's name tells which factor is right, it has to
    be confirmed. Copies by a factor under other names stay, since suites are scaled on purpose, and say so.
    """
    components, below = without_boreholes(components)
    pairs, scaled = _pairs(components)
    factors = {(i, j): _factor(components[i], components[j]) for i, others in pairs.items() for j in others}
    rank = _ranks(components, pairs, factors)
    used: set[int] = set()
    stands_for: dict[int, int] = {}
    for i in sorted(pairs, key=rank.__getitem__):
        better = [j for j in pairs[i] if j in used]
        if better and not components[i].wanted:
            stands_for[i] = min(better, key=rank.__getitem__)
        else:
            used.add(i)
    odd: dict[int, list[Finding]] = {}
    left_out = []
    for i, j in sorted(stands_for.items()):
        left, kept, factor = components[i], components[j], factors[i, j]
        left_out.append(LeftOut(left.name, left.source, _reason(left, kept, factor)))
        decided = kept.wanted or rank[i][1:4] != rank[j][1:4]
        if finding := _difference(left, kept, factor, decided):
            odd.setdefault(j, []).append(finding)
    for i, j in ((i, j) for i, others in scaled.items() for j in others if not {i, j} & stands_for.keys()):
        for k, other in ((i, components[j]), (j, components[i])):
            factor = _factor(other, components[k])
            text = f"{other.source} has the same samples times {factor:.4g}; both are used, and count as one record"
            odd.setdefault(k, []).append(Finding("factor", text))
    kept_ones = [
        replace(component, odd=(*component.odd, *odd[i])) if i in odd else component
        for i, component in enumerate(components)
        if i not in stands_for
    ]
    return kept_ones, [*below, *left_out]


def _pairs(components: Sequence[Component]) -> tuple[Pairs, Pairs]:
    """Return the components that are of the same recording as each component; those without any are missing.

    And, once for each pair, copies by a factor of which nothing but their samples says that they are one recording.
    """
    groups: dict[Hashable, list[int]] = {}
    for i, component in enumerate(components):
        groups.setdefault(_samples(component), []).append(i)
        if component.seat.number:
            groups.setdefault(component.seat.number, []).append(i)
    whole = _whole_files(components)
    pairs: Pairs = {}

    def join(i: int, j: int) -> None:
        pairs.setdefault(i, set()).add(j)
        pairs.setdefault(j, set()).add(i)

    for key, group in groups.items():
        for i, j in combinations(group, 2):
            one, two = components[i], components[j]
            if _may_be_copies(one, two) if isinstance(key, bytes) else _same_recording(one, two, whole):
                join(i, j)
    scaled: Pairs = {}
    for i, j in _alike_in_time(components):
        one, two = components[i], components[j]
        if j in pairs.get(i, ()) or not _may_be_one(one, two):
            continue
        factor = _factor(one, two)
        if factor is not None and abs(abs(factor) - 1.0) > _NO_FACTOR:
            scaled.setdefault(i, set()).add(j)
        elif _correlate(one, two):
            join(i, j)
    return pairs, scaled


def _ranks(
    components: Sequence[Component], pairs: Pairs, factors: dict[tuple[int, int], float | None]
) -> dict[int, tuple[object, ...]]:
    """Return what components of several files are sorted by, the one to use first, each as its whole set.

    In this order: what a manifest wants; sound before grossly odd; corrected before unknown before uncorrected; what is not
    called scaled; two horizontals and a vertical before less; a unit of acceleration before counts; the finer time step; the
    more intense shaking, by powers of two; the suffix of a format; the shorter name; the first.
    """
    sets: dict[int, list[int]] = {}
    for members in _sets(components):
        sets.update(dict.fromkeys(members, members))
    energy = {i: float(c.acceleration @ c.acceleration) * c.dt for i, c in enumerate(components) if i in sets}
    for (i, j), factor in factors.items():
        if factor is not None:
            energy[i] = energy[j] = min(energy[i], energy[j])
    ranks: dict[int, tuple[object, ...]] = {}
    for members in {id(m): m for i, m in sets.items() if i in pairs}.values():
        of_set = [components[i] for i in members]
        first = of_set[0]
        across = sum(not c.orientation.vertical for c in of_set)
        rank = (
            not any(c.wanted for c in of_set),
            any(gross_findings(c) for c in of_set),
            _CORRECTED[first.processed],
            any(_SCALED.search(c.source) for c in of_set),
            -min(2, across) - (across < len(of_set)),
            not first.unit,
            float(f"{first.dt:.3g}"),
            -round(math.log2(sum(energy[i] for i in members) or 1e-300)),
            not is_usual(_suffix(first)),
            min(len(c.source) for c in of_set),
            members[0],
        )
        ranks.update({i: (*rank, i) for i in members})
    return ranks


def _sets(components: Sequence[Component]) -> Iterator[list[int]]:
    """Return the components that belong together: of a file with several, or else of one station, step and processing."""
    files: dict[Hashable, list[int]] = {}
    for i, component in enumerate(components):
        files.setdefault(_file(component), []).append(i)
    alone: dict[Hashable, list[int]] = {}
    for members in files.values():
        c = components[members[0]]
        if len(members) > 1:
            yield members
        else:
            place = (c.folder, c.station or c.seat.station or c.site, c.event, c.processed, f"{c.dt:.3g}")
            alone.setdefault(place, []).extend(members)
    for members in alone.values():
        ways = {(o.vertical, o.azimuth, o.label) for o in (components[i].orientation for i in members)}
        if len(ways) == len(members):
            yield members
            continue
        of_name: dict[Hashable, list[int]] = {}
        for i in members:
            of_name.setdefault((components[i].site, _suffix(components[i])), []).append(i)
        yield from of_name.values()


def _file(component: Component) -> str:
    """Its file, by folder and source."""
    return f"{component.folder}/{file_of(component.source)}"


def _suffix(component: Component) -> str:
    """Return its file's suffix, in lower case."""
    return bare(Path(file_of(component.source))).suffix.lower()


def _samples(component: Component) -> bytes:
    """Return a digest of the step and the samples."""
    digest = hashlib.sha256(repr(component.dt).encode())
    digest.update(np.ascontiguousarray(component.acceleration).tobytes())
    return digest.digest()


def _whole_files(components: Sequence[Component]) -> set[str]:
    """Return the files that hold both a vertical and a horizontal component."""
    verticals = {_file(component) for component in components if component.orientation.vertical}
    return verticals & {_file(component) for component in components if not component.orientation.vertical}


def _same_recording(a: Component, b: Component, whole: Set[str]) -> bool:
    """Whether the headers of both say so; those in one file are of different sensors.

    Two ``whole`` files of one step that are processed alike may be parts of one recording; their samples decide.
    """
    if not a.seat.is_that_of(b.seat) or not _pointing_alike(a, b) or _file(a) == _file(b):
        return False
    if _numbers_differ(a, b) or not in_one_event(a, b):
        return False
    may_be_parts = (
        a.processed == b.processed and abs(a.dt - b.dt) <= _SAME_STEP * a.dt and whole >= {_file(a), _file(b)}
    )
    return not may_be_parts or correlation(a.acceleration, b.acceleration) >= _ALIKE


def _alike_in_time(components: Sequence[Component]) -> Iterator[tuple[int, int]]:
    """Return pairs whose ∫a² dt grows alike in time, whatever their scale, start and step: few that are not copies."""
    times = np.array([_growth(component) for component in components]).reshape(-1, len(_SHARES) - 1)
    length = times.sum(axis=1)
    order = np.argsort(length, kind="stable")
    for n, i in enumerate(order):
        within = _SPREAD * length[i] + _BLUR
        others = order[n + 1 : np.searchsorted(length[order], length[i] + within, "right")]
        alike = others[(np.abs(times[others] - times[i]) <= within).all(axis=1)]
        yield from ((int(min(i, j)), int(max(i, j))) for j in alike)


def _growth(component: Component) -> Samples:
    """Return the times [s] between the ``_SHARES`` of ∫a² dt."""
    energy = np.cumsum(np.square(component.acceleration))
    return np.diff(np.searchsorted(energy, np.multiply(_SHARES, energy[-1]))) * component.dt


def _may_be_one(a: Component, b: Component) -> bool:
    """Whether headers do not say that two components are of other files, sensors, times, events or directions."""
    if _file(a) == _file(b) or _numbers_differ(a, b) or not overlap(a, b):
        return False
    if a.event and b.event and a.event != b.event and _suffix(a) == _suffix(b):  # which formats write as they like
        return False
    way = a.orientation
    known = way.vertical or way.azimuth is not None or bool(way.label)
    return known and _pointing_alike(a, b) and not a.seat.is_other(b.seat)


def _correlate(a: Component, b: Component) -> bool:
    """Whether the samples of two components, brought to one step, are those of one recording."""
    coarse, fine = sorted((a, b), key=lambda c: -c.dt)
    return correlation(coarse.acceleration, _at_step(fine, coarse.dt)) >= _CERTAIN


def _at_step(component: Component, dt: float) -> Samples:
    """Return the accelerations at a step ``dt`` [s], as coarse or coarser, without what it cannot show."""
    a = component.acceleration
    if abs(component.dt - dt) <= _SAME_STEP * dt:
        return a
    spectrum = np.fft.rfft(a)
    spectrum[np.fft.rfftfreq(len(a), component.dt) > 0.5 / dt] = 0.0
    times = np.arange(0.0, component.duration + 0.5 * component.dt, dt)
    return np.interp(times, np.arange(len(a)) * component.dt, np.fft.irfft(spectrum, len(a)))


def correlation(one: Samples, two: Samples) -> float:
    """Return the largest correlation of two series of one step, either way up, over all shifts of one against the other.

    Shifts are by quarters of a step. It is 1 where one of them never moves.
    """
    one, two = ((x - x.mean()) / (np.abs(x).max() or 1.0) for x in (one, two))
    n = len(one) + len(two)
    shifted = 4.0 * np.fft.irfft(np.fft.rfft(one, n) * np.conj(np.fft.rfft(two, n)), 4 * n)
    norm = float(np.linalg.norm(one) * np.linalg.norm(two))
    return float(np.abs(shifted).max()) / norm if norm > 0 else 1.0


def _factor(a: Component, b: Component) -> float | None:
    """Return how many times larger ``a`` is than ``b``, if their samples are the same but for that; ``None`` if not."""
    one, two = a.acceleration, b.acceleration
    if len(one) != len(two) or abs(a.dt - b.dt) > _SAME_STEP * a.dt or not two.any():
        return None
    factor = float(one @ two) / float(two @ two)
    if abs(factor - 1.0) <= _NO_FACTOR or np.abs(one - factor * two).max() > _SAME_SHAPE * np.abs(one).max():
        return None
    return factor or None


def _numbers_differ(a: Component, b: Component) -> bool:
    """Whether PEER's numbers say that they are other records."""
    return is_numbered(a.site) and is_numbered(b.site) and a.site != b.site


def _pointing_alike(a: Component, b: Component) -> bool:
    """Whether both point the same way, by azimuths, or else by their labels."""
    one, two = a.orientation, b.orientation
    if one.vertical or two.vertical:
        return one.vertical and two.vertical
    if one.azimuth is None or two.azimuth is None:
        return one.azimuth is None and two.azimuth is None and one.label.upper() == two.label.upper()
    return same_azimuth(one.azimuth, two.azimuth)


def _may_be_copies(a: Component, b: Component) -> bool:
    """Whether components with the same samples do not say that they are of other sensors, events or directions."""
    if NOWHERE not in (a.seat, b.seat) and not a.seat.is_that_of(b.seat):
        return False
    if a.event and b.event and a.event != b.event:
        return False
    return UNKNOWN in (a.orientation, b.orientation) or _pointing_alike(a, b)


def _reason(left: Component, used: Component, factor: float | None) -> str:
    """Why ``left`` is left out: which other one is used, and what it has that this one does not."""
    why = "a copy of" if _samples(left) == _samples(used) else "the same recording as"
    if _CORRECTED[used.processed] < _CORRECTED[left.processed]:
        why = "the same recording, less corrected, as"
    if factor is not None:
        why = f"{why.removesuffix(' as')}, {factor:.4g} times as large, as"
    return f"{why} {used.source}, which is used; write use = true in motions.toml to use this one"


def _difference(left: Component, used: Component, factor: float | None, decided: bool) -> Finding | None:
    """Return what the copy that is left out has otherwise: a factor, which must be ``decided``, or another peak."""
    if factor is not None:
        text = f"{left.source}, left out, has the same samples times {factor:.4g}: check which of them is right"
        return Finding("factor", text, gross=not decided and abs(abs(factor) - 1.0) > _GROSS_FACTOR)
    ratio = left.pga / max(used.pga, 1e-300)
    if 1.0 / _UNEQUAL <= ratio <= _UNEQUAL:
        return None
    return Finding("other peak", f"{left.source}, the same recording, left out, has {ratio:.3g} times its peak")
