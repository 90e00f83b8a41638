"""Suites of records fitted to a target spectrum over a range of periods."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rockbatch.common.errors import refuse
from rockbatch.common.grouping import grouped
from rockbatch.motions.intensity.pairs import (
    TWO_COMPONENT_RULES,
    pair_measures,
    pair_of,
    pairing_obstacle,
    srss_components,
    station_spectra,
)
from rockbatch.motions.motion import Motion
from rockbatch.motions.spectrum import Samples, spectral_acceleration
from rockbatch.motions.suites.design_spectra import Spectrum

FACTORS = ("both", "each", "suite", "none")
"""See :class:`SpectrumTarget`."""

PAIRS = {"apart": 0.9, "srss": 1.3, "geomean": 1.0, "rotd50": 1.0, "rotd100": 0.9}
"""Rules for the components of a station, and the usual share of the target that their mean must reach: EN 1998-1,
3.2.3.1.2 (4), EN 1998-2, 3.2.3 (3), and for maximum directions ASCE 7-16, 16.2.3.2, as commonly quoted; 1 for the others."""

_A_DECADE = 100  # periods, 2.3 % apart: a peak at 5 % damping is four of them wide

_APART = (
    'pairs = "apart": each of two components of a station counts by itself, though codes judge the pair; if unintended, '
    'write pairs = "srss" (EN 1998-2) or "rotd100" (ASCE 7)'
)


@dataclass(frozen=True)
class SpectrumTarget:
    """A spectrum to which a suite's records are scaled between two periods.

    Attributes
    ----------
    spectrum : Spectrum
        The target.
    range_s : tuple of two floats
        Least and largest period [s]; the fit uses a hundred a decade between them, evenly in ln T, with both ends.
    factors : str
        "each": a factor for every record by least squares of ln S_a, so that it exceeds the target as much as it falls below.
        "suite": one for all records, the least for which the mean of their spectra is nowhere below ``at_least`` of the
        target. "both": first each, then one for all if that mean is still below. "none": no factors, for comparison.
    pairs : str
        "apart": the mean is over the spectra of all horizontal components that are run. "srss": a station has one spectrum, the
        square root of the sum of squares of two components square to each other, whatever directions are run. "geomean",
        "rotd50", "rotd100": likewise the geometric mean, and the median and the maximum over all directions, which need both
        components of a station.
    at_least : float, optional
        Share of the target; by default that of :data:`PAIRS`. It is a check of the suite, with "none" only if it is given.

    Components of one station have one factor, and the vertical component has the factor of its horizontal.
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
        refuse(wrong)

    @property
    def share(self) -> float:
        """Return the share of the target that the mean must reach in the whole range: ``at_least``, or that of PAIRS."""
        return PAIRS[self.pairs] if self.at_least is None else self.at_least

    def __str__(self) -> str:
        low, high = self.range_s
        return f"the spectrum {self.spectrum} between {low:g} s and {high:g} s"

    @property
    def code(self) -> str:
        """Return the code with conditions on such a suite, EN 1998-2 instead of EN 1998-1 for "srss"; empty for none."""
        return "EN 1998-2" if self.pairs == "srss" and self.spectrum.code == "EN 1998-1" else self.spectrum.code

    @property
    def periods(self) -> Samples:
        """Return the periods of the fit [s], shape (n,): a hundred a decade, evenly in ln T, from the least to the largest."""
        low, high = self.range_s
        return np.geomspace(low, high, 1 + max(1, math.ceil(_A_DECADE * math.log10(high / low))))

    def factors_of(self, motions: Sequence[Motion], gravity: float) -> list[float]:
        """Return the factor for each motion; infinite for motions at rest, and 1 for all if ``factors`` is "none".

        Raises ``InputError`` if the rule takes pairs, and a station has none (:func:`pairing_obstacle`).
        """
        factors = np.array([1.0 if self.factors == "none" or motion.pga > 0 else math.inf for motion in motions])
        moving = [i for i, motion in enumerate(motions) if motion.pga > 0]
        if self.factors == "none" or not moving:
            return factors.tolist()
        stations = list(grouped(moving, lambda i: motions[i].of_station).values())
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

    def mean(
        self, motions: Sequence[Motion], periods: Samples, gravity: float, spectra: Samples | None = None
    ) -> Samples:
        """Return the suite's mean spectrum [g] at ``periods`` [s], shape (periods,); NaN without motions.

        ``spectra``, shape (motions, periods), are those of the components, if already computed; only "apart" uses them. Stations
        without the pair that a rule takes are left out.
        """
        members = self._counted(motions)
        if not members:
            return np.full(len(periods), math.nan)
        return np.asarray(np.mean(self._rows(motions, members, periods, gravity, spectra), axis=0))

    def _counted(self, motions: Sequence[Motion]) -> list[list[int]]:
        """Return the indices of the motions for each spectrum of the mean, without stations that lack a pair."""
        stations = _stations(motions)
        if self.pairs in TWO_COMPONENT_RULES:
            stations = [station for station in stations if not pairing_obstacle([motions[i] for i in station])]
        return self._members(stations)

    def _members(self, stations: Sequence[Sequence[int]]) -> list[list[int]]:
        """Return the indices of the motions for each spectrum: one component, or all of a station."""
        return [[i] for station in stations for i in station] if self.pairs == "apart" else [list(s) for s in stations]

    def _rows(
        self,
        motions: Sequence[Motion],
        members: Sequence[Sequence[int]],
        periods: Samples,
        gravity: float,
        spectra: Samples | None = None,
    ) -> list[Samples]:
        """Return a spectrum [g] for each of ``members``, shape (periods,)."""

        def spectrum_of(samples: Samples, dt: float) -> Samples:
            return spectral_acceleration(samples, dt, periods, self.spectrum.damping) / gravity

        if self.pairs == "apart":
            own = [motions[i] for (i,) in members]
            return list(spectra) if spectra is not None else [spectrum_of(m.horizontal, m.dt) for m in own]
        stations = [[motions[i] for i in places] for places in members]
        if self.pairs == "srss":
            pairs = ([spectrum_of(*component) for component in srss_components(station)] for station in stations)
            return [np.linalg.norm(pair, axis=0) for pair in pairs]
        return [station_spectra(station, periods, self.spectrum.damping)[self.pairs] / gravity for station in stations]

    def remarks(self, motions: Sequence[Motion]) -> list[str]:
        """Return a sentence on a limit of the code that the target exceeds, and on pairs judged apart by a code; [] for none."""
        paired = any(len(station) == 2 for station in _stations(motions))
        apart = self.pairs == "apart" and self.spectrum.code and paired
        return list(filter(None, (self.spectrum.beyond, _APART if apart else "")))

    def run_json_entry(self, motions: Sequence[Motion], gravity: float) -> dict[str, object]:
        """Return its entry of run.json: the target, and the mean spectrum of ``motions`` as used, 0 without any."""
        stations = [[motions[i] for i in station] for station in _stations(motions)]
        entry = {
            "spectrum": str(self.spectrum),
            "code": self.code,
            "stations": min(len(stations), len({station for motion in motions for station in motion.stations})),
            "events": _events(stations),
            "damping": self.spectrum.damping,
            "range_s": list(self.range_s),
            "factors": self.factors,
            "pairs": self.pairs,
            "alone": sum(self._is_alone(station) for station in stations),
            "at_least": self.share,
            "required": self.factors != "none" or self.at_least is not None,
            "remarks": self.remarks(motions),
            "period_s": _rounded(self.periods),
            "sa_g": _rounded(self.spectrum.at(self.periods)),
            "mean_sa_g": _rounded(np.nan_to_num(self.mean(motions, self.periods, gravity))),
        }
        if motions and self.pairs in TWO_COMPONENT_RULES:
            entry["components_sa_g"] = _rounded(replace(self, pairs="apart").mean(motions, self.periods, gravity))
        return entry | (self._conditions(motions, gravity) if self.code and motions else {})

    def _conditions(self, motions: Sequence[Motion], gravity: float) -> dict[str, object]:
        """Return the values for a code's further conditions: longest period, both spectra at 0 s [g], and ranges of factors.

        The record factor k₁ of NZS 1170.5 fits a record by least squares of ln S_a; the family factor k₂ is the rest.
        """
        low, high = self.spectrum.limits
        members = [places for places in self._counted(motions) if motions[places[0]].pga > 0]
        values: dict[str, object] = {"defined_to_s": high} if math.isfinite(high) else {}
        if not members:
            return values
        target, rows = self.spectrum.at(self.periods), self._rows(motions, members, self.periods, gravity)
        fitted = [math.exp(float(np.log(target / row).mean())) for row in rows]
        record = [motions[places[0]].factor * k for places, k in zip(members, fitted, strict=True)]
        values["record_factors"] = _rounded([min(record), max(record)])
        values["family_factors"] = _rounded([1.0 / max(fitted), 1.0 / min(fitted)])
        if low == 0.0:
            at_zero = float(self.spectrum.at(np.array([0.0]))[0])
            peaks = [self._peak([motions[i] for i in places]) for places in members]
            values["zero_sa_g"] = _rounded([at_zero, float(np.mean(peaks)) / gravity])
        return values

    def _peak(self, station: Sequence[Motion]) -> float:
        """Return the value at 0 s of a station's spectrum [m/s²]: by the rule of its pair, else the PGA of its first motion."""
        if self.pairs == "apart" or pairing_obstacle(station):
            return station[0].pga
        return pair_measures(*pair_of(station)[:2])[self.pairs]

    def _is_alone(self, station: Sequence[Motion]) -> bool:
        """Return whether a station lacks the second component that the rule needs."""
        two = not pairing_obstacle(station) if self.pairs in TWO_COMPONENT_RULES else len(srss_components(station)) == 2
        return not two


def _stations(motions: Sequence[Motion]) -> list[list[int]]:
    """Return the indices of ``motions`` grouped by station and earthquake."""
    return list(grouped(range(len(motions)), lambda i: motions[i].of_station).values())


def _events(stations: Sequence[Sequence[Motion]]) -> int:
    """Return the number of earthquakes of the stations; 0 if one is unknown."""
    events = [next((motion.origin.event for motion in station if motion.origin.event), "") for station in stations]
    return len(set(events)) if all(events) else 0


def _rounded(values: Samples | Sequence[float]) -> list[float]:
    """Return values rounded to five significant digits."""
    return [float(f"{value:.5g}") for value in values]
