"""Suites of records fitted to a target spectrum over a range of periods."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import grouped
from rockbatch.motions.design_spectra import Spectrum
from rockbatch.motions.motion import Motion
from rockbatch.motions.pairs import DIRECTIONS, measured, pair_of, squared, station_spectra, unpaired
from rockbatch.motions.spectrum import Samples, spectral_acceleration

Array = npt.NDArray[np.float64]

FACTORS = ("both", "each", "suite", "none")
"""See :class:`SpectrumTarget`."""

PAIRS = {"apart": 0.9, "srss": 1.3, "geomean": 1.0, "rotd50": 1.0, "rotd100": 0.9}
"""Rules by which components of a station count, and the usual share of the target: EN 1998-1, 3.2.3.1.2 (4), EN 1998-2,
3.2.3 (3), and of maximum directions ASCE 7-16, 16.2.3.2, as they are commonly quoted; of the others all of it."""

_A_DECADE = 100  # periods, 2.3 % apart: a peak of 5 % damping is four of them wide

_APART = (
    'pairs = "apart": each of two components of a station counts by itself, though codes judge the pair; if that is not meant, '
    'write pairs = "srss" (EN 1998-2) or "rotd100" (ASCE 7)'
)


@dataclass(frozen=True)
class SpectrumTarget:
    """A spectrum that a suite's records are brought to between two periods.

    Attributes
    ----------
    spectrum : Spectrum
        The target.
    range_s : tuple of two floats
        Least and largest period [s]; a hundred a decade of them count, evenly in ln T, and both ends.
    factors : str
        "each": every record by least squares of ln S_a, so that it exceeds the target as much as it falls below it.
        "suite": one for all records, the least by which the mean of their spectra is nowhere below ``at_least`` of the
        target. "both": each, and then one for all where that mean is below still. "none": as they are, for comparison.
    pairs : str
        "apart": every horizontal component that is run has a spectrum of its own, of which the mean is formed. "srss": two of
        a station that are square to each other make one, the square root of the sum of their squares, whatever directions are
        run. "geomean", "rotd50", "rotd100": likewise their geometric mean, and the median and the greatest over all directions;
        these take both components of a station.
    at_least : float, optional
        Share of the target; by default that of :data:`PAIRS`. It is a check of the suite, with "none" only if it is given.

    Components of one station have one factor, and the vertical one has that of its horizontal.
    """

    spectrum: Spectrum
    range_s: tuple[float, float]
    factors: str = "both"
    pairs: str = "apart"
    at_least: float | None = None

    def __post_init__(self) -> None:
        low, high = self.range_s
        least, largest = self.spectrum.limits
        wrong = []
        if not 0 < low < high < math.inf:
            wrong.append(f"period_range_s = [{low:g}, {high:g}]: must be two periods above 0, the lesser one first")
        elif low < least or high > largest:
            wrong.append(
                f"period_range_s = [{low:g}, {high:g}]: the target ({self.spectrum}) is defined from {least:g} s "
                f"to {largest:g} s"
            )
        if self.factors not in FACTORS:
            wrong.append(f'factors = "{self.factors}": must be one of {", ".join(FACTORS)}')
        if self.pairs not in PAIRS:
            wrong.append(f'pairs = "{self.pairs}": must be one of {", ".join(PAIRS)}')
        if wrong:
            raise InputError(*wrong)

    @property
    def share(self) -> float:
        """Return what the mean is to reach of the target, everywhere in the range."""
        return PAIRS[self.pairs] if self.at_least is None else self.at_least

    def __str__(self) -> str:
        low, high = self.range_s
        return f"the spectrum {self.spectrum} between {low:g} s and {high:g} s"

    @property
    def code(self) -> str:
        """Return the code that sets conditions on such a suite; empty for none. EN 1998-2 is that of pairs, "srss"."""
        return "EN 1998-2" if self.pairs == "srss" and self.spectrum.code == "EN 1998-1" else self.spectrum.code

    @property
    def periods(self) -> Array:
        """Periods that count [s]."""
        low, high = self.range_s
        return np.geomspace(low, high, 1 + max(1, math.ceil(_A_DECADE * math.log10(high / low))))

    def factors_of(self, motions: Sequence[Motion], gravity: float) -> list[float]:
        """Return what each motion is to be multiplied by; infinite for one without motion.

        Raises ``InputError`` if the rule takes pairs, and a station has none (:func:`unpaired`).
        """
        factors = np.array([1.0 if self.factors == "none" or motion.pga > 0 else math.inf for motion in motions])
        moving = [i for i, motion in enumerate(motions) if motion.pga > 0]
        if self.factors == "none" or not moving:
            return factors.tolist()
        stations = _stations(motions, moving)
        members = self._members(stations)
        rows = np.array(self._rows(motions, members, self.periods, gravity))
        target = self.spectrum.at(self.periods)
        if self.factors != "suite":
            row_of = {place: row for row, places in enumerate(members) for place in places}
            for station in stations:
                rows_of_station = rows[sorted({row_of[place] for place in station})]
                factors[station] = math.exp(float(np.log(target / rows_of_station).mean()))
        if self.factors != "each":
            scaled = rows * np.array([factors[places[0]] for places in members])[:, None]
            common = float((self.share * target / scaled.mean(axis=0)).max())
            factors[moving] *= common if self.factors == "suite" else max(1.0, common)
        return factors.tolist()

    def mean(self, motions: Sequence[Motion], periods: Array, gravity: float, spectra: Array | None = None) -> Array:
        """Return the mean [g] of the spectra that count of ``motions``, shape (periods,), at ``periods`` [s]; NaN without any.

        ``spectra``, shape (motions, periods), are those of the components, if they are at hand.
        """
        members = self._counted(motions)
        if not members:
            return np.full(len(periods), math.nan)
        return np.asarray(np.mean(self._rows(motions, members, periods, gravity, spectra), axis=0))

    def _counted(self, motions: Sequence[Motion]) -> list[list[int]]:
        """Return the places of the motions that make each spectrum that counts: none of a station without its pair."""
        stations = _stations(motions)
        if self.pairs in DIRECTIONS:
            stations = [station for station in stations if not unpaired([motions[i] for i in station])]
        return self._members(stations)

    def _members(self, stations: Sequence[Sequence[int]]) -> list[list[int]]:
        """Return the places of the motions that make each spectrum: one component, or those of a station."""
        return [[i] for station in stations for i in station] if self.pairs == "apart" else [list(s) for s in stations]

    def _rows(
        self, motions: Sequence[Motion], members: Sequence[Sequence[int]], periods: Array, gravity: float,
        spectra: Array | None = None,
    ) -> list[Array]:  # fmt: skip
        """Return a spectrum [g] for each of ``members``, shape (periods,)."""

        def spectrum_of(samples: Samples, dt: float) -> Array:
            return spectral_acceleration(samples, dt, periods, self.spectrum.damping) / gravity

        if self.pairs == "apart":
            own = [motions[i] for (i,) in members]
            return list(spectra) if spectra is not None else [spectrum_of(m.horizontal, m.dt) for m in own]
        stations = [[motions[i] for i in places] for places in members]
        if self.pairs == "srss":
            return [
                np.linalg.norm([spectrum_of(*component) for component in squared(station)], axis=0)
                for station in stations
            ]
        return [station_spectra(station, periods, self.spectrum.damping)[self.pairs] / gravity for station in stations]

    def remarks(self, motions: Sequence[Motion]) -> list[str]:
        """Return what to consider about the target of these ``motions``, a sentence each."""
        paired = any(len(station) == 2 for station in _stations(motions))
        apart = self.pairs == "apart" and self.spectrum.code and paired
        return list(filter(None, (self.spectrum.beyond, _APART if apart else "")))

    def described(self, motions: Sequence[Motion], gravity: float) -> dict[str, Any]:
        """Return what run.json says of it: the target, and the mean of the spectra of ``motions`` as they are used, 0 of none."""
        stations = [[motions[i] for i in station] for station in _stations(motions)]
        return {
            "spectrum": str(self.spectrum),
            "code": self.code,
            "stations": len(stations),
            "events": _events(stations),
            "damping": self.spectrum.damping,
            "range_s": list(self.range_s),
            "factors": self.factors,
            "pairs": self.pairs,
            "alone": sum(self._is_alone(station) for station in stations),
            "at_least": self.share,
            "required": self.factors != "none" or self.at_least is not None,
            "remarks": self.remarks(motions),
            "period_s": _short(self.periods),
            "sa_g": _short(self.spectrum.at(self.periods)),
            "mean_sa_g": _short(np.nan_to_num(self.mean(motions, self.periods, gravity))),
            **self._components_mean(motions, gravity),
            **(self._conditions(motions, gravity) if self.code and motions else {}),
        }

    def _conditions(self, motions: Sequence[Motion], gravity: float) -> dict[str, Any]:
        """Return what a code's conditions are about beside the mean spectrum: its end, both spectra at 0 s, and the factors.

        The record factor k₁ of NZS 1170.5 fits a record by least squares of ln S_a; the family factor k₂ is the rest.
        """
        low, high = self.spectrum.limits
        members = [places for places in self._counted(motions) if motions[places[0]].pga > 0]
        found: dict[str, Any] = {"defined_to_s": high} if math.isfinite(high) else {}
        if not members:
            return found
        fitted = [
            math.exp(float(np.log(self.spectrum.at(self.periods) / row).mean()))
            for row in self._rows(motions, members, self.periods, gravity)
        ]
        record = [motions[places[0]].factor * k for places, k in zip(members, fitted, strict=True)]
        found["record_factors"] = _short([min(record), max(record)])
        found["family_factors"] = _short([1.0 / max(fitted), 1.0 / min(fitted)])
        if low == 0.0:
            at_zero = float(self.spectrum.at(np.array([0.0]))[0])
            peaks = [self._peak([motions[i] for i in places]) for places in members]
            found["zero_sa_g"] = _short([at_zero, float(np.mean(peaks)) / gravity])
        return found

    def _peak(self, station: Sequence[Motion]) -> float:
        """Return the peak ground acceleration of what makes a spectrum [m/s²], which that has at 0 s."""
        if self.pairs == "apart" or unpaired(station):
            return station[0].pga
        return measured(*pair_of(station))[self.pairs]

    def _is_alone(self, station: Sequence[Motion]) -> bool:
        """Return whether a station lacks the second component that the rule takes."""
        return bool(unpaired(station)) if self.pairs in DIRECTIONS else len(squared(station)) != 2

    def _components_mean(self, motions: Sequence[Motion], gravity: float) -> dict[str, Any]:
        """Return the mean spectrum of the components that are run, where those of pairs are fitted."""
        if self.pairs not in DIRECTIONS or not motions:
            return {}
        return {"components_sa_g": _short(replace(self, pairs="apart").mean(motions, self.periods, gravity))}


def _stations(motions: Sequence[Motion], among: Sequence[int] | None = None) -> list[list[int]]:
    """Return places of the motions, ``among`` some of them, that are components of one station in one earthquake."""
    places = range(len(motions)) if among is None else among
    return list(grouped(places, lambda i: motions[i].of_station).values())


def _events(stations: Sequence[Sequence[Motion]]) -> int:
    """Return the number of earthquakes that the stations are of; 0 if that of any is not known."""
    events = [next((motion.origin.event for motion in station if motion.origin.event), "") for station in stations]
    return len(set(events)) if all(events) else 0


def _short(values: Array | Sequence[float]) -> list[float]:
    return [float(f"{value:.5g}") for value in values]
