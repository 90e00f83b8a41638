"""Recognition of components of one recording.

Two components of one direction are of one recording if their samples are equal, or correlate once aligned: well if their headers
name one sensor and event, very well if these do not tell. Headers propose, samples decide. Two whole sets are of one recording
if they are alike in some frame: copies may be cut, rotated, filtered, or labelled otherwise.
"""

import math
from collections.abc import Hashable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.common.grouping import grouped
from rockbatch.motions.alignment import common_factor, correlation, is_significant, same_step
from rockbatch.motions.component import Component
from rockbatch.motions.identity.candidates import Candidates
from rockbatch.motions.motion import Samples

_ALIKE = 0.7  # correlation: real files of one recording have 0.98 and more, other records 0.63 at most, halves 0.46
_CERTAIN = 0.95  # correlation that decides without headers
_IN_COMMON = 0.8  # least share of the energy of one of two sets that lies in their common time
_NO_FACTOR = 0.005  # relative: values of g, and rounding
_COHERENT = 0.995  # median over bands: copies filtered to 1–5 Hz have more, neighbours in an array 0.992 at most
_BAND, _FEWEST_BANDS = 0.5, 6  # width of a band [Hz], and least number of bands for a median
_ENERGETIC = 0.01  # of the largest energy of a band: less is noise, or was filtered out
_TAPER = 0.1  # of a record, at either end
_WINDOWED = (1.5, 4.5)  # Hz: a band that filters leave alone
_PER_SECOND = 16.0
_PEAKS = 12  # of an envelope, the largest
_AROUND = (-1.2, -0.8, -0.4, 0.4, 0.8, 1.2)  # s
_SAME_ENVELOPE = 0.05  # of its peak
_FLAT = 0.8  # of its peak: harmonic waves are alike around all of theirs

Pairs = dict[int, set[int]]


class Recordings(NamedTuple):
    """Components of one recording, by their indices."""

    pairs: Pairs  # the other components of the same recording, by component; only components with others
    scaled: list[tuple[int, int]]  # copies by a factor that only their samples reveal, in order
    denied: list[tuple[int, int]]  # of one recording by headers, but not by samples


def pairs_of_one_recording(components: Sequence[Component]) -> Recordings:
    """Return the pairs of components of one recording by headers and samples, copies by a factor apart, and denied pairs."""
    candidates = Candidates(components)
    pairs: Pairs = {}
    scaled = []

    def join(i: int, j: int) -> None:
        pairs.setdefault(i, set()).add(j)
        pairs.setdefault(j, set()).add(i)

    denied = []
    for i in range(len(components)):
        for j in candidates.copies(i):
            join(i, j)
        for j in candidates.same_by_headers(i):
            if j in pairs.get(i, ()) or likeness_of(components[i], components[j]) >= _ALIKE:
                join(i, j)
            elif candidates.way[i] >= 0 and not candidates.may_be_parts(i, j):  # unknown directions may be two
                denied.append((i, j))
    for i, j in candidates.similar_pairs():
        first, second = components[i], components[j]
        if j in pairs.get(i, ()) or first.sensor.is_distinct_from(second.sensor):
            continue
        factor = factor_between(first, second)
        if factor is not None and abs(abs(factor) - 1.0) > _NO_FACTOR:
            scaled.append((i, j))
        elif _are_one_recording(first, second):
            join(i, j)
    for i, j in _pairs_of_sets(components, pairs, scaled, candidates):
        join(i, j)
    return Recordings(pairs, sorted(scaled), [(i, j) for i, j in denied if j not in pairs.get(i, ())])


def _pairs_of_sets(
    components: Sequence[Component], pairs: Pairs, scaled: Sequence[tuple[int, int]], candidates: Candidates
) -> Iterator[tuple[int, int]]:
    """Yield further pairs from two sets that are of one recording as wholes, each component with its counterpart.

    Two sets with a pair already must correlate or be coherent; others must be coherent wherever both have energy: that
    distinguishes a copy that was cut, rotated and filtered from a neighbour in an array, and a correlation does not. Sets with
    none but a ``scaled`` pair stay two.
    """
    sets = list(sets_of(components))
    set_of = {i: number for number, members in enumerate(sets) for i in members}
    linked = {(set_of[i], set_of[j]) for i, copies in pairs.items() for j in copies if set_of[i] < set_of[j]}
    by_factor = {tuple(sorted((set_of[i], set_of[j]))) for i, j in scaled}
    for pair in sorted(linked | _similar_envelopes(components, sets) - by_factor):
        coherent = pair in linked
        for upright in (False, True):
            first, second = ([i for i in sets[n] if components[i].orientation.vertical is upright] for n in pair)
            joined = all(pairs.get(i, set()).intersection(second) for i in first)
            if joined or len(first) != len(second) or len(first) > 2:
                continue
            if not (coherent or (not upright and candidates.may_be_one(first, second))):
                break
            in_parts = 4 if coherent else 1  # coherence hardly changes with shifts by less than a step
            likeness = _greatest_likeness([components[i] for i in first], [components[i] for i in second], in_parts)
            if likeness.coherence >= _COHERENT or (coherent and likeness.correlation >= _CERTAIN):
                coherent, crossed = True, np.trace(likeness.each[::-1]) > np.trace(likeness.each)
                yield from zip(first, reversed(second) if crossed else second, strict=True)


def _similar_envelopes(components: Sequence[Component], sets: Sequence[Sequence[int]]) -> set[tuple[int, int]]:
    """Return pairs of sets (i < j) whose horizontals have similar envelopes around a peak, however they were rotated and cut."""
    shapes, owners = [np.empty((0, len(_AROUND)))], list[int]()
    for number, members in enumerate(sets):
        horizontals = [components[i] for i in members if not components[i].orientation.vertical]
        if 1 <= len(horizontals) <= 2 and horizontals[0].dt < 0.5 / _WINDOWED[1]:
            shapes.append(_shapes(horizontals))
            owners += [number] * len(shapes[-1])
    shape, owner = np.concatenate(shapes), np.array(owners, dtype=np.int64)
    order = np.argsort(shape[:, 0])  # so that similar shapes are neighbours by their first value
    shape, owner = shape[order], owner[order]
    ends = np.searchsorted(shape[:, 0], shape[:, 0] + _SAME_ENVELOPE)
    similar: set[tuple[int, int]] = set()
    for k, end in enumerate(ends.tolist()):
        near = k + 1 + np.flatnonzero((np.abs(shape[k + 1 : end] - shape[k]) <= _SAME_ENVELOPE).all(axis=1))
        similar.update((min(owner[k], n), max(owner[k], n)) for n in owner[near].tolist() if n != owner[k])
    return similar


def _shapes(horizontals: Sequence[Component]) -> Samples:
    """Return the band-passed envelope of horizontals around its largest peaks, over each peak, shape (peaks, times).

    The times are :data:`_AROUND`. Peaks amid a flat envelope are left out.
    """
    dt, longest = horizontals[0].dt, max(len(c.acceleration) for c in horizontals)
    n = 1 << (longest + math.ceil(2.0 / dt)).bit_length()
    low, high = (math.ceil(f * n * dt) for f in _WINDOWED)
    spectra = (np.fft.rfft(c.acceleration, n)[low:high] for c in horizontals)
    count = max(round(n * dt * _PER_SECOND), high - low)
    energy = sum(np.square(np.abs(np.fft.ifft(spectrum * np.hanning(high - low), count))) for spectrum in spectra)
    envelope = np.sqrt(energy)[: math.ceil(longest * dt * _PER_SECOND)]
    steps = np.round(np.multiply(_AROUND, _PER_SECOND)).astype(int)
    inside = envelope[-steps[0] : -steps[-1]]
    peaks = 1 + np.flatnonzero((inside[1:-1] > inside[:-2]) & (inside[1:-1] >= inside[2:])) - steps[0]
    peaks = peaks[np.argsort(-envelope[peaks])[:_PEAKS]]
    shape = envelope[peaks[:, None] + steps] / envelope[peaks, None]
    return np.asarray(shape[shape.min(axis=1) < _FLAT])


class _Likeness(NamedTuple):
    """Likeness of two sets in the frame and at the shift of their greatest correlation."""

    correlation: float
    coherence: float
    each: Samples  # absolute covariances of each component with each, shape (n, n)


def _greatest_likeness(first: Sequence[Component], second: Sequence[Component], parts: int) -> _Likeness:
    """Return the likeness of two sets of one or two components each, over all shifts by 1/``parts`` of a step.

    At each shift, the greatest trace of their covariances after a rotation or reflection is the sum of the singular values;
    it is divided by the energies in the common time, where most of the energy of one of them must lie.
    """
    dt = max(c.dt for c in (*first, *second))
    a, b = _centred(first, dt), _centred(second, dt)
    n = 1 << (a.shape[1] + b.shape[1] - 1).bit_length()
    spectra = np.einsum("if,jf->ijf", np.fft.rfft(a, n), np.conj(np.fft.rfft(b, n)))
    covariances = parts * np.fft.irfft(spectra, parts * n)
    norms = np.square(covariances).sum(axis=(0, 1))
    if len(a) == 2:
        norms += 2.0 * np.abs(covariances[0, 0] * covariances[1, 1] - covariances[0, 1] * covariances[1, 0])
    shift = np.arange(parts * n) // parts
    shift[shift >= a.shape[1]] -= n
    from_a, to_a = np.maximum(shift, 0), np.clip(b.shape[1] + shift, 0, a.shape[1])
    energy = [np.concatenate(([0.0], np.cumsum(np.square(x).sum(axis=0)))) for x in (a, b)]
    from_b, to_b = (np.clip(ends - shift, 0, b.shape[1]) for ends in (from_a, to_a))
    shared = [energy[0][to_a] - energy[0][from_a], energy[1][to_b] - energy[1][from_b]]
    enough = np.maximum(shared[0] / (energy[0][-1] or 1.0), shared[1] / (energy[1][-1] or 1.0)) >= _IN_COMMON
    with np.errstate(divide="ignore", invalid="ignore"):
        r = np.nan_to_num(np.where(enough, np.sqrt(norms / (shared[0] * shared[1])), 0.0))
    best = int(r.argmax())
    left, _, right = np.linalg.svd(covariances[:, :, best])
    common = a[:, from_a[best] : to_a[best]], (left @ right @ b)[:, from_b[best] : to_b[best]]
    return _Likeness(float(r[best]), _coherence(*common, dt), np.abs(covariances[:, :, best]))


def _centred(components: Sequence[Component], dt: float) -> Samples:
    """Return accelerations at a step ``dt`` [s] less their means, cut to the shortest, shape (components, npts)."""
    series = [_at_step(component, dt) for component in components]
    shortest = min(map(len, series))
    return np.array([x[:shortest] - x[:shortest].mean() for x in series])


def _coherence(a: Samples, b: Samples, dt: float) -> float:
    """Return the median coherence of two sets, shape (components, npts), over bands with energy in both; 0 for fewer than six.

    A filter, whose phase and amplitude are nearly constant in a band, does not change it.
    """
    n = a.shape[1]
    place = np.arange(n) + 0.5
    taper = np.square(np.sin(0.5 * np.pi * np.minimum(1.0, np.minimum(place, n - place) / max(_TAPER * n, 1.0))))
    first, second = np.fft.rfft(a * taper), np.fft.rfft(b * taper)
    band = (np.fft.rfftfreq(max(n, 1), dt) / _BAND).astype(int)

    def in_bands(p: npt.NDArray[np.complex128], q: npt.NDArray[np.complex128]) -> npt.NDArray[np.complex128]:
        """Return the cross-spectrum, summed over components and over each band."""
        products = (p * np.conj(q)).sum(axis=0)
        return np.asarray(np.bincount(band, products.real) + 1j * np.bincount(band, products.imag))

    energy, other_energy = in_bands(first, first).real, in_bands(second, second).real
    both = (energy > _ENERGETIC * energy.max()) & (other_energy > _ENERGETIC * other_energy.max())
    if both.sum() < _FEWEST_BANDS:
        return 0.0
    coherence = np.abs(in_bands(first, second)[both]) / np.sqrt(energy[both] * other_energy[both])
    return float(np.median(coherence))


def sets_of(components: Sequence[Component]) -> Iterator[list[int]]:
    """Yield sets of components that belong together, by index: all of a file with several, else of one station, event and step.

    These are of one folder and processing, too; if two share a direction, those of one site and suffix are a set. Each component
    is in one set, perhaps alone.
    """

    def place(i: int) -> Hashable:
        c = components[i]
        return c.folder, c.station or c.sensor.station or c.site, c.event, c.processed, f"{c.dt:.3g}"

    files = grouped(range(len(components)), lambda i: components[i].path).values()
    yield from (members for members in files if len(members) > 1)
    for members in grouped((members[0] for members in files if len(members) == 1), place).values():
        directions = {(o.vertical, o.azimuth, o.label) for o in (components[i].orientation for i in members)}
        if len(directions) == len(members):
            yield members
        else:
            yield from grouped(members, lambda i: (components[i].site, components[i].suffix)).values()


def likeness_of(a: Component, b: Component) -> float:
    """Return the largest absolute correlation of two components, at the coarser of their steps, over all shifts."""
    dt = max(a.dt, b.dt)
    return correlation(_at_step(a, dt), _at_step(b, dt))


def _are_one_recording(a: Component, b: Component) -> bool:
    """Return whether two components, at the coarser of their steps, have a significant absolute correlation of 0.95 or more."""
    coarse, fine = sorted((a, b), key=lambda c: -c.dt)
    first, second = coarse.acceleration, _at_step(fine, coarse.dt)
    r = correlation(first, second)
    return r >= _CERTAIN and is_significant(r, first, second)


def _at_step(component: Component, dt: float) -> Samples:
    """Return the accelerations at a coarser step ``dt`` [s], without frequencies above its Nyquist frequency."""
    a = component.acceleration
    if same_step(component.dt, dt):
        return a
    spectrum = np.fft.rfft(a)
    spectrum[np.fft.rfftfreq(len(a), component.dt) > 0.5 / dt] = 0.0
    times = np.arange(0.0, component.duration + 0.5 * component.dt, dt)
    return np.interp(times, np.arange(len(a)) * component.dt, np.fft.irfft(spectrum, len(a)))


def factor_between(a: Component, b: Component) -> float | None:
    """Return the factor that makes samples of ``b`` those of ``a``; ``None`` if there is none, or it is within 0.5 % of 1."""
    factor = common_factor(a.acceleration, b.acceleration) if same_step(a.dt, b.dt) else 0.0
    return None if not factor or abs(factor - 1.0) <= _NO_FACTOR else factor
