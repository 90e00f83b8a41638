"""Estimates of design practice: the rocking pier as an elastic oscillator whose period grows with its rotation.

Priestley, Evison & Carr (1978, Bull. NZ Nat. Soc. Earthq. Eng. 11(3), 141–150) take the period of free rocking (Housner 1963),

    T(φ) = (4/p) arcosh(1/(1 − φ)),   φ = θ/α,

and a constant damping that stands for the impacts, read the displacement of the centre of mass off the elastic spectrum,
and go on from the rotation S_d(T, ζ)/R0 until it repeats itself. FEMA 356 (2000) took the method over. Of r, the share of the
energy that an impact leaves,

    ζ = −0.34 ln r        (Makris & Konstantinidis 2003, for the decay of Priestley et al.),
    ζ = 0.4 (1 − √r)      (FEMA 356).

Makris & Konstantinidis (2003, Earthq. Eng. Struct. Dyn. 32(2), 265–289) show why a rocking block is no such oscillator: what
comes out here is there to be compared, not to design by. None of these formulas could be checked against the text of its source.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.common.lazy import pd
from rockbatch.motions import Motion
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.pier import Pier
from rockbatch.results import beside_peaks
from rockbatch.study import Study

ESTIMATE = "estimate.csv"

START = 0.5
"""φ at which the iteration begins."""

_LEAST, _LARGEST = 1e-3, 0.999  # φ between which the spectrum is tabulated
_PERIODS = 120
_ITERATIONS, _CONVERGED = 200, 1e-4

Array = npt.NDArray[np.float64]


def _priestley(pier: Pier) -> float:
    return -0.34 * math.log(pier.restitution**2) if pier.restitution > 0 else math.inf


def _fema_356(pier: Pier) -> float:
    return 0.4 * (1.0 - pier.restitution)


DAMPING: Mapping[str, Callable[[Pier], float]] = {"priestley": _priestley, "fema_356": _fema_356}
"""Equivalent damping ζ of each method, of a pier on rigid ground: r = e²."""

_MOST_DAMPING = 0.99  # a pier so stocky is no oscillator at all


class Estimate(NamedTuple):
    """The estimate by an equivalent oscillator.

    Attributes
    ----------
    theta_over_alpha : float
        φ; 0 where the pier stays, NaN if there is no answer.
    outcome : str
        "stays", "rocks", "overturns" (the rotation reached α), or "no convergence".
    """

    theta_over_alpha: float
    outcome: str


def rocking_period(share: Array | float, p: float) -> Array:
    """Return the period of free rocking [s] with amplitudes φ = θ/α, below 1, of a slender block (Housner 1963)."""
    return 4.0 / p * np.arccosh(1.0 / (1.0 - np.asarray(share, dtype=np.float64)))


def estimate(rotation: Callable[[float], float]) -> Estimate:
    """Return the fixed point of ``rotation``, which gives φ of the period at another φ; begun at :data:`START`."""
    share = START
    for _ in range(_ITERATIONS):
        following = rotation(share)
        if following >= 1.0:
            return Estimate(math.nan, "overturns")
        if following <= _LEAST:
            return Estimate(0.0, "stays")
        if abs(following - share) <= _CONVERGED * following:
            return Estimate(following, "rocks")
        share = following
    return Estimate(math.nan, "no convergence")


def estimates(peaks: "pd.DataFrame", study: Study, motions: Sequence[Motion]) -> Iterator[dict[str, Any]]:
    """Yield the rows of estimate.csv, one for each run of ``peaks`` that was simulated."""

    @cache
    def displacements(motion: Motion, p: float, damping: float) -> tuple[Array, Array]:
        """Return periods [s] and spectral displacements [m] of a motion, before the study's scale."""
        ends = rocking_period(np.array([_LEAST, _LARGEST]), p)
        periods = np.geomspace(ends[0], ends[1], _PERIODS)
        sa = spectral_acceleration(motion.horizontal, motion.dt, periods, damping)
        return periods, sa * (periods / (2.0 * math.pi)) ** 2

    @cache
    def of_pier(motion: Motion, scale: float, pier: Pier, method: str) -> tuple[float, Estimate]:
        damping = DAMPING[method](pier)
        if scale * motion.pga <= pier.gravity * math.tan(pier.alpha):
            return damping, Estimate(0.0, "stays")
        if damping > _MOST_DAMPING:
            return damping, Estimate(math.nan, "no convergence")
        periods, moved = displacements(motion, pier.p, damping)

        def rotation(share: float) -> float:
            period = float(rocking_period(min(share, _LARGEST), pier.p))
            return scale * float(np.interp(period, periods, moved)) / (pier.size * pier.alpha)

        return damping, estimate(rotation)

    for row, motion, scale, pier in beside_peaks.runs(peaks, study, motions):
        row["pga_over_g_tan_alpha"] = scale * motion.pga / (pier.gravity * math.tan(pier.alpha))
        for method in DAMPING:
            row[f"{method}_damping"], oscillator = of_pier(motion, scale, pier, method)
            row[f"{method}_theta_over_alpha"], row[f"{method}_outcome"] = oscillator
        yield row
