"""Suites of records fitted to a target spectrum over a range of periods."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from rockbatch.errors import InputError
from rockbatch.grouping import grouped
from rockbatch.motions.design_spectra import Spectrum
from rockbatch.motions.motion import Motion
from rockbatch.motions.spectrum import spectral_acceleration

Array = npt.NDArray[np.float64]

FACTORS = ("both", "each", "suite", "none")
"""See :class:`SpectrumTarget`."""

PAIRS = {"apart": 0.9, "srss": 1.3}
"""Rules by which components of a station count, and the usual share of the target: EN 1998-1, 3.2.3.1.2 (4), and EN 1998-2,
3.2.3 (3), as they are commonly quoted."""

_A_DECADE = 20  # periods


@dataclass(frozen=True)
class SpectrumTarget:
    """A spectrum that a suite's records are brought to between two periods.

    Attributes
    ----------
    spectrum : Spectrum
        The target.
    range_s : tuple of two floats
        Least and largest period [s]; twenty a decade of them count, evenly in ln T, and both ends.
    factors : str
        "each": every record by least squares of ln S_a, so that it exceeds the target as much as it falls below it.
        "suite": one for all records, the least by which the mean of their spectra is nowhere below ``at_least`` of the
        target. "both": each, and then one for all where that mean is below still. "none": as they are, for comparison.
    pairs : str
        "apart": every horizontal component has a spectrum of its own, of which the mean is formed. "srss": a station's two
        make one, the square root of the sum of their squares.
    at_least : float, optional
        Share of the target; by default that of :data:`PAIRS`.

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
    def periods(self) -> Array:
        """Periods that count [s]."""
        low, high = self.range_s
        return np.geomspace(low, high, 1 + max(1, math.ceil(_A_DECADE * math.log10(high / low))))

    def factors_of(self, motions: Sequence[Motion], gravity: float) -> list[float]:
        """Return what each motion is to be multiplied by; infinite for one without motion."""
        if self.factors == "none" or not motions:
            return [1.0] * len(motions)
        spectra = self._spectra(motions, gravity)
        moves = np.all(spectra > 0, axis=1)
        target = self.spectrum.at(self.periods)
        factors = np.where(moves, 1.0, math.inf)
        if self.factors != "suite":
            for together in _stations(motions, moves):
                rows = self._combined(spectra, [together])
                factors[together] = math.exp(float(np.log(target / rows).mean()))
        if self.factors != "each" and moves.any():
            scaled = np.where(moves, factors, 1.0)[:, None] * spectra
            mean = self._combined(scaled, _stations(motions, moves)).mean(axis=0)
            common = float((self.share * target / mean).max())
            factors[moves] *= common if self.factors == "suite" else max(1.0, common)
        return [float(factor) for factor in factors]

    def mean(self, spectra: Array, motions: Sequence[Motion]) -> Array:
        """Return the mean, shape (periods,), of the ``spectra`` of ``motions``, shape (motions, periods)."""
        return np.asarray(self._combined(spectra, _stations(motions)).mean(axis=0))

    def _combined(self, spectra: Array, stations: Sequence[Sequence[int]]) -> Array:
        """Return a row for each component of the stations, or for each station."""
        if self.pairs == "apart":
            return spectra[[i for station in stations for i in station]]
        return np.array([np.sqrt((spectra[list(station)] ** 2).sum(axis=0)) for station in stations])

    def described(self, motions: Sequence[Motion], gravity: float) -> dict[str, Any]:
        """Return what run.json says of it: the target, and the mean of the spectra of ``motions`` as they are used."""
        mean = self.mean(self._spectra(motions, gravity), motions) if motions else self.periods * math.nan
        return {
            "spectrum": str(self.spectrum),
            "damping": self.spectrum.damping,
            "range_s": list(self.range_s),
            "factors": self.factors,
            "pairs": self.pairs,
            "alone": sum(len(station) != 2 for station in _stations(motions)),
            "at_least": self.share,
            "period_s": _short(self.periods),
            "sa_g": _short(self.spectrum.at(self.periods)),
            "mean_sa_g": _short(mean),
        }

    def _spectra(self, motions: Sequence[Motion], gravity: float) -> Array:
        """Return spectral accelerations [g], shape (motions, periods)."""
        periods, damping = self.periods, self.spectrum.damping
        return np.array([spectral_acceleration(m.horizontal, m.dt, periods, damping) / gravity for m in motions])


def _stations(motions: Sequence[Motion], among: npt.NDArray[np.bool_] | None = None) -> list[list[int]]:
    """Return places of the motions, ``among`` some of them, that are components of one station in one earthquake."""
    places = [i for i in range(len(motions)) if among is None or among[i]]
    return list(grouped(places, lambda i: motions[i].of_station).values())


def _short(values: Array) -> list[float]:
    return [float(f"{value:.5g}") for value in values]
