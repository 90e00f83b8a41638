"""Components that may be of one recording, found among many by their headers, growth of energy and Fourier amplitudes.

What these bounds rule out is not aligned with others sample by sample, as ``likeness`` does with the rest.
"""

import hashlib
import math
from collections.abc import Hashable, Iterable, Iterator, Sequence
from itertools import product

import numpy as np
import numpy.typing as npt

from rockbatch.common.grouping import grouped
from rockbatch.motions.alignment import places_of_energy, same_step
from rockbatch.motions.component import UNKNOWN_SENSOR, Component
from rockbatch.motions.identity.stations import is_numbered
from rockbatch.motions.labels.orientation import SAME_AZIMUTH, UNKNOWN
from rockbatch.motions.motion import Samples

_SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)  # of ∫a² dt
_SPREAD, _BLUR = 0.1, 0.05  # of the significant duration, and s: differences of these shares' times between copies
_BANDS = np.concatenate((np.arange(0.0, 12.5, 0.125), np.arange(12.5, 50.0, 0.5), np.arange(50.0, 101.0, 5.0)))  # Hz
_SIMILAR = 0.9  # of amplitudes in bands: below the correlation of copies, 0.95, which it bounds but for bands' edges

Indices = npt.NDArray[np.int64]
Truths = npt.NDArray[np.bool_]


def _codes(values: Iterable[Hashable]) -> Indices:
    """Return integers that are equal for equal values, -1 for None and empty ones, shape (n,)."""
    codes: dict[Hashable, int] = {}
    return np.array([codes.setdefault(value, len(codes)) if value else -1 for value in values], dtype=np.int64)


def _places(codes: Indices) -> dict[int, Indices]:
    """Return the places of each code, ascending."""
    return {code: np.array(places) for code, places in grouped(range(len(codes)), codes.tolist().__getitem__).items()}


class Candidates:
    """Components as arrays of their properties, so that each one is compared with all others at once.

    ``growth`` has the times [s] between the ``_SHARES`` of ∫a² dt, and their sum; ``amplitude`` the Fourier amplitudes in
    ``_BANDS``, of which ``bands`` lie below the Nyquist frequency, and ``energy`` the cumulative sum of their squares. Both
    are NaN until first used. So is ``spectra``, by ``length``, for components with as many samples: the :func:`_spectrum` of
    each, at its ``place`` among them.
    """

    def __init__(self, components: Sequence[Component]) -> None:
        self.components = components
        self.file, self.suffix = _codes(c.path for c in components), _codes(c.suffix for c in components)
        self.numbered = _codes(c.site if is_numbered(c.site) else "" for c in components)
        self.sensor, self.event = _codes(c.sensor.number for c in components), _codes(c.event for c in components)
        digests = (hashlib.sha256(repr(c.dt).encode() + c.acceleration.tobytes()).digest() for c in components)
        self.samples = _codes(digests)
        self.with_samples, self.of_sensor = _places(self.samples), _places(self.sensor)
        self.way = _codes(map(_kind_of_direction, components))
        self.azimuth = np.array([c.orientation.azimuth for c in components], dtype=float)
        self.start = np.array([c.start for c in components], dtype=float)
        self.end = self.start + [c.duration for c in components]
        self.dated = np.array([c.dated for c in components], dtype=bool)
        self.growth = np.array([_growth_times(component) for component in components]).reshape(-1, len(_SHARES))
        self.bands = np.array([np.searchsorted(_BANDS, 0.5 / c.dt, "right") - 1 for c in components], dtype=np.int64)
        self.amplitude = np.full((len(components), len(_BANDS) - 1), math.nan, dtype=np.float32)
        self.energy = np.full((len(components), len(_BANDS)), math.nan, dtype=np.float32)
        self.length = _codes((len(c.acceleration), c.dt) for c in components)
        self.place = np.empty(len(components), dtype=np.int64)
        for of_length in _places(self.length).values():
            self.place[of_length] = np.arange(len(of_length))
        self.spectra: dict[int, npt.NDArray[np.float32]] = {}
        vertical = np.array([c.orientation.vertical for c in components], dtype=bool)
        self.whole_file = np.isin(self.file, self.file[vertical]) & np.isin(self.file, self.file[~vertical])

    @staticmethod
    def _later(places: Indices, i: int) -> Indices:
        """Return the places after ``i``, of ascending ``places``."""
        return places[np.searchsorted(places, i, "right") :]

    def _differ(self, column: Indices, i: int, j: Indices) -> Truths:
        """Return whether the codes ``column[j]`` differ from ``column[i]``, shape of ``j``; False where either is unknown, -1."""
        return (column[i] != column[j]) & (column[i] >= 0) & (column[j] >= 0)

    def _pointing_alike(self, i: int, j: Indices) -> Truths:
        """Return whether components ``j`` point as ``i``: all vertical, to 1° of azimuth, by equal labels, or all unknown."""
        angles = np.abs((self.azimuth[j] - self.azimuth[i] + 180.0) % 360.0 - 180.0)
        return (self.way[j] == self.way[i]) & ~(angles > SAME_AZIMUTH)

    def _overlap(self, i: int, j: Indices) -> Truths:
        """Return whether components overlap in time with ``i``; True where a start is unknown."""
        return ~((self.start[j] >= self.end[i]) | (self.start[i] >= self.end[j]))

    def _joinable(self, i: int, j: Indices) -> Truths:
        """Return whether headers allow that components are of the recording of ``i``, in another file."""
        # events are compared within one format only, since formats word them differently
        differ = self._differ(self.event, i, j) & (self.suffix[j] == self.suffix[i])
        differ |= self._differ(self.numbered, i, j) | (self.file[j] == self.file[i])
        return ~differ & self._overlap(i, j)

    def may_be_one(self, first: Sequence[int], second: Sequence[int]) -> bool:
        """Return whether headers allow that two sets are of one recording; single components must point alike, too."""
        parts, j = self.components, np.array(second)
        distinct = any(parts[i].sensor.is_distinct_from(parts[k].sensor) for i, k in product(first, second))
        turned = len(first) > 1 or bool(self._pointing_alike(first[0], j).all())
        return not distinct and turned and all(self._joinable(i, j).all() for i in first)

    def may_be_parts(self, i: int, j: int) -> bool:
        """Return whether two may be of consecutive parts of a recording: of one step and processing, in whole files."""
        a, b = self.components[i], self.components[j]
        return bool(self.whole_file[[i, j]].all()) and a.processed == b.processed and same_step(a.dt, b.dt)

    def copies(self, i: int) -> list[int]:
        """Return later components with the same samples that may be of the same sensor, event and direction.

        What is unknown may be the same.
        """
        j = self._later(self.with_samples[int(self.samples[i])], i)
        j = j[~self._differ(self.event, i, j)]
        this, copies = self.components[i], []
        for k, alike in zip(j.tolist(), self._pointing_alike(i, j), strict=True):
            other = self.components[k]
            one_sensor = UNKNOWN_SENSOR in (this.sensor, other.sensor) or this.sensor.may_be_same_as(other.sensor)
            if one_sensor and (alike or UNKNOWN in (this.orientation, other.orientation)):
                copies.append(k)
        return copies

    def same_by_headers(self, i: int) -> list[int]:
        """Return later components of the same recording by their headers, never those of one file; [] for an unknown sensor."""
        if self.sensor[i] < 0:
            return []
        j = self._later(self.of_sensor[int(self.sensor[i])], i)
        j = j[(self.event[j] == self.event[i]) | self.dated[j]]
        same_event = (self.event[i] >= 0) & (self.event[j] == self.event[i])
        same_event = np.where(self.dated[i] & self.dated[j], self._overlap(i, j), same_event)
        differ = (self.file[j] == self.file[i]) | self._differ(self.numbered, i, j)
        sensor = self.components[i].sensor
        candidates = j[same_event & ~differ & self._pointing_alike(i, j)].tolist()
        return [k for k in candidates if sensor.may_be_same_as(self.components[k].sensor)]

    def similar_pairs(self) -> Iterator[tuple[int, int]]:
        """Yield pairs of similar growth of ∫a² dt and similar spectra, whatever their scale, start and step.

        They are candidates for copies; their headers allow one recording and direction, in two files.
        """
        order = np.argsort(self.growth[:, -1], kind="stable")
        length = self.growth[order, -1]
        for n, i in enumerate(order.tolist()):
            if self.way[i] < 0:
                continue
            within = _SPREAD * length[n] + _BLUR
            j = order[n + 1 : np.searchsorted(length, length[n] + within, "right")]
            for share in range(len(_SHARES) - 1):
                j = j[np.abs(self.growth[j, share] - self.growth[i, share]) <= within]
            j = j[self._joinable(i, j) & self._pointing_alike(i, j)]
            j = j[self._similar(i, j)]
            yield from ((min(i, k), max(i, k)) for k in j[self._similar_in_full(i, j)].tolist())

    def _similar(self, i: int, j: Indices) -> Truths:
        """Return whether the spectra allow the correlation of copies: at any shift, |Σ AᵢAⱼ e^iφ| ≤ Σ |Aᵢ||Aⱼ|."""
        for k in (i, *j[np.isnan(self.amplitude[j, 0])].tolist()) if len(j) else ():
            if math.isnan(self.amplitude[k, 0]):
                self.amplitude[k] = _amplitudes(self.components[k])
                self.energy[k] = np.concatenate(([0.0], np.cumsum(np.square(self.amplitude[k]))))
        common = np.minimum(self.bands[i], self.bands[j])
        product = self.amplitude[j] @ self.amplitude[i]
        return np.asarray(np.square(product) >= _SIMILAR**2 * self.energy[i, common] * self.energy[j, common])

    def _similar_in_full(self, i: int, j: Indices) -> Truths:
        """Return whether full spectra allow it, too, of components with the steps and samples of ``i``; True for others.

        Random motions of one envelope, as simulated suites have, are alike in bands of many frequencies.
        """
        similar, length = np.ones(len(j), dtype=bool), int(self.length[i])
        same = self.length[j] == length
        if same.any():
            if length not in self.spectra:
                shape = int((self.length == length).sum()), len(_spectrum(self.components[i].acceleration))
                self.spectra[length] = np.full(shape, math.nan, dtype=np.float32)
            spectra, places = self.spectra[length], self.place[j[same]]
            for k in (i, *j[same][np.isnan(spectra[places, 0])].tolist()):
                if math.isnan(spectra[self.place[k], 0]):
                    spectra[self.place[k]] = _spectrum(self.components[k].acceleration)
            # NaN, of a constant one, decides nothing
            similar[same] = ~(spectra[places] @ spectra[self.place[i]] < _SIMILAR)
        return similar


def _kind_of_direction(component: Component) -> tuple[str, ...]:
    """Return a key that components of one direction share, besides their azimuth; () for an unknown direction."""
    orientation = component.orientation
    if orientation.vertical:
        return ("vertical",)
    if orientation.azimuth is not None:
        return ("azimuth",)
    return ("label", orientation.label.upper()) if orientation.label else ()


def _growth_times(component: Component) -> Samples:
    """Return the times [s] between neighbouring ``_SHARES`` of ∫a² dt, then their sum, shape (5,)."""
    times = places_of_energy(component.acceleration, _SHARES) * component.dt
    return np.append(np.diff(times), times[-1] - times[0])


def _amplitudes(component: Component) -> Samples:
    """Return the Fourier amplitude in each of ``_BANDS`` over the root of the energy at all frequencies; 0 for a still record."""
    a, dt = component.acceleration - component.acceleration.mean(), component.dt
    n = 1 << max(2 * len(a), math.ceil(2.0 / (dt * _BANDS[1]))).bit_length()
    energy = np.concatenate(([0.0], np.cumsum(np.square(np.abs(np.fft.rfft(a, n))))))
    ends = np.minimum(np.ceil(_BANDS * n * dt).astype(int), len(energy) - 1)
    return np.asarray(np.sqrt(np.maximum(np.diff(energy[ends]), 0.0) / (energy[-1] or 1.0)))


def _spectrum(values: Samples) -> Samples:
    """Return the Fourier amplitudes of a series less its mean, of unit energy, each two in one; NaN for a constant one.

    Those of two series of one length have a product that is no less than their correlation at any shift, since each of them
    is long enough for both, one behind the other.
    """
    deviation = values - values.mean()
    n = 1 << max(2 * len(values) - 1, 2).bit_length()
    amplitudes = np.abs(np.fft.rfft(deviation, n)[1:]).reshape(-1, 2)
    with np.errstate(invalid="ignore"):
        return np.asarray(math.sqrt(2.0 / n) * np.hypot(*amplitudes.T) / np.linalg.norm(deviation))
