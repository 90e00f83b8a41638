"""Suites of records fitted to a target spectrum over a range of periods."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from rockbatch.errors import InputError
from rockbatch.motions.design_spectra import Spectrum
from rockbatch.motions.motion import Motion
from rockbatch.motions.spectrum import spectral_acceleration

Array = npt.NDArray[np.float64]

FACTORS = ("both", "each", "suite", "none")
"""See :class:`SpectrumTarget`."""

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
    at_least : float
        Share of the target.

    Components of one record have one factor, as the vertical one has that of its horizontal.
    """

    spectrum: Spectrum
    range_s: tuple[float, float]
    factors: str = "both"
    at_least: float = 0.9

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
        if wrong:
            raise InputError(*wrong)

    def __str__(self) -> str:
        low, high = self.range_s
        return f"the spectrum {self.spectrum} between {low:g} s and {high:g} s"

    @property
    def periods(self) -> Array:
        """Periods that count [s]."""
        low, high = self.range_s
        return np.geomspace(low, high, 1 + max(1, math.ceil(_A_DECADE * math.log10(high / low))))

    def factors_of(self, motions: Sequence[Motion], gravity: float) -> list[float]:
        """What each motion is to be multiplied by; infinite for one without motion."""
        if self.factors == "none" or not motions:
            return [1.0] * len(motions)
        spectra = self._spectra(motions, gravity)
        moves = np.all(spectra > 0, axis=1)
        target = self.spectrum.at(self.periods)
        factors = np.where(moves, 1.0, math.inf)
        if self.factors != "suite":
            for together in _components(motions):
                of_one = [i for i in together if moves[i]]
                if of_one:
                    factors[of_one] = math.exp(float(np.log(target / spectra[of_one]).mean()))
        if self.factors != "each" and moves.any():
            mean = (factors[moves, None] * spectra[moves]).mean(axis=0)
            common = float((self.at_least * target / mean).max())
            factors[moves] *= common if self.factors == "suite" else max(1.0, common)
        return [float(factor) for factor in factors]

    def described(self, motions: Sequence[Motion], gravity: float) -> dict[str, Any]:
        """What run.json says of it: the target, and the mean of the spectra of ``motions`` as they are used."""
        mean = self._spectra(motions, gravity).mean(axis=0) if motions else self.periods * math.nan
        return {
            "spectrum": str(self.spectrum),
            "damping": self.spectrum.damping,
            "range_s": list(self.range_s),
            "factors": self.factors,
            "at_least": self.at_least,
            "period_s": _short(self.periods),
            "sa_g": _short(self.spectrum.at(self.periods)),
            "mean_sa_g": _short(mean),
        }

    def _spectra(self, motions: Sequence[Motion], gravity: float) -> Array:
        """Spectral accelerations [g], shape (motions, periods)."""
        periods, damping = self.periods, self.spectrum.damping
        return np.array([spectral_acceleration(m.horizontal, m.dt, periods, damping) / gravity for m in motions])


def _components(motions: Sequence[Motion]) -> list[list[int]]:
    """Places of the motions that are components of one record, a station's in one earthquake."""
    places: dict[str, list[int]] = {}
    for i, motion in enumerate(motions):
        places.setdefault(motion.of_station, []).append(i)
    return list(places.values())


def _short(values: Array) -> list[float]:
    return [float(f"{value:.5g}") for value in values]
