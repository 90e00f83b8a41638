"""Seismic hazard: mean annual rates of exceedance of an intensity at a site, as a table or a parabola in logarithms."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from rockbatch.common.arguments import checked
from rockbatch.common.errors import refuse
from rockbatch.motions.spectrum import Samples

REACH = 10.0
"""Extrapolation of a curve beyond its table with its end slope, in ln x: a factor of 22,000 either way."""

STEP = 0.05
"""Widest piece of the quadrature in ln x; with three Gauss points each, rates are exact to 1e-7 for dispersions from 0.05."""

STEEPEST = 30.0
"""Greatest k of a rate that falls as 1/x^k: sites have 1 to 10, and of steeper curves the rates far below the points overflow."""

MOST_RATE = 100.0
"""Greatest rate per year; larger numbers are probably return periods."""


@checked
@dataclass(frozen=True)
class HazardCurve:
    """Mean annual rate ν(x) at which an intensity x is exceeded.

    Between the points, and beyond them with the slope of the last two, ν is a power law: straight lines over ln x. As
    "quadratic" it is one parabola ln ν = −k0 − k1 ln x − k2 ln² x by least squares (Vamvatsikos 2013, Earthq. Eng. Struct.
    Dyn. 42(8):1171–1188), which goes through three points.

    Attributes
    ----------
    levels : tuple of float
        Intensities, rising, in the unit of the levels of [fragility].
    rates : tuple of float
        Their annual rates of exceedance, falling.
    slope : float or None
        k of ν ∝ x^−k through a single point; of ground accelerations it is of the order of 3 (EN 1998-1, 2.1(4)).
    shape : "points" or "quadratic"
        Curve through the points: a power law between each two, or one parabola.

    Raises ``InputError`` with all mistakes in the points.

    Examples
    --------
    >>> curve = rb.HazardCurve(levels=[0.1, 0.2, 0.4], rates=[1 / 100, 1 / 475, 1 / 2475])
    >>> [round(1 / rate) for rate in curve.rate([0.2, 0.3, 0.8])]
    [475, 1248, 12896]
    """

    levels: tuple[float, ...]
    rates: tuple[float, ...]
    slope: float | None = None
    shape: Literal["points", "quadratic"] = "points"

    def __post_init__(self) -> None:
        refuse(message for _, message in problems(self.levels, self.rates, self.slope, self.shape))

    @property
    def ends(self) -> tuple[float, float]:
        """Return the lowest and the highest intensity of the points; rates beyond them are extrapolated."""
        return self.levels[0], self.levels[-1]

    def rate(self, x: "Sequence[float] | Samples") -> Samples:
        """Return the annual rate at which each intensity ``x`` above 0 is exceeded, in its shape; extrapolated beyond the points.

        Below the summit of a parabola it is the rate of the summit, and beyond its bottom the rate of the bottom.
        """
        log_x = np.log(np.asarray(x, dtype=np.float64))
        if self.shape == "quadratic":
            return np.exp(np.polyval(self._parabola, np.clip(log_x, *self._falling)))
        logs, k = np.log(self.levels), self._slopes
        segment = np.clip(np.searchsorted(logs, log_x) - 1, 0, len(k) - 1)
        return np.exp(np.log(np.array(self.rates))[segment] - k[segment] * (log_x - logs[segment]))

    def log_slope(self, x: Samples) -> Samples:
        """Return k(x) = −d ln ν/d ln x, shape of ``x``, 0 on the rising side of a parabola."""
        log_x = np.log(x)
        if self.shape == "quadratic":
            return np.maximum(-np.polyval(np.polyder(self._parabola), log_x), 0.0)
        k = self._slopes
        return k[np.clip(np.searchsorted(np.log(self.levels), log_x) - 1, 0, len(k) - 1)]

    def quadrature(self) -> tuple[Samples, Samples]:
        """Return rising intensities x and weights w [1/year], shape (n,): ∑ P(x) w = ∫ P(x) |dν(x)|, the mean annual rate.

        P is a fragility. The last weight stands for all stronger motions.
        """
        logs = np.log(self.levels)
        ends = [logs[0] - REACH, *logs, logs[-1] + REACH]
        edges = np.unique(np.concatenate([np.linspace(a, b, 1 + math.ceil((b - a) / STEP)) for a, b in pairwise(ends)]))
        places, weights = np.polynomial.legendre.leggauss(3)
        half, middle = np.diff(edges)[:, None] / 2, (edges[1:] + edges[:-1])[:, None] / 2
        x = np.exp(middle + half * places).ravel()
        rates = self.log_slope(x) * self.rate(x) * (half * weights).ravel()
        last = np.exp(edges[-1:])
        return np.concatenate((x, last)), np.concatenate((rates, self.rate(last)))

    @property
    def misfit(self) -> float:
        """Return the greatest relative distance of the curve from its points: 0 except for a parabola of more than three."""
        return float(np.abs(self.rate(self.levels) / np.array(self.rates) - 1.0).max())

    @property
    def _slopes(self) -> Samples:
        """Return the slopes k between the points, shape (points − 1,); the slope alone, shape (1,), if it is given."""
        if self.slope is not None:
            return np.array([self.slope])
        return -np.diff(np.log(self.rates)) / np.diff(np.log(self.levels))

    @property
    def _parabola(self) -> Samples:
        """Return the coefficients of ln ν as a polynomial of ln x, of the square first."""
        return np.polyfit(np.log(self.levels), np.log(self.rates), 2)

    @property
    def _falling(self) -> tuple[float, float]:
        """Return the ln x between which a parabola falls, and beyond which its rate is kept constant; ±inf without a turn."""
        a, b, _ = self._parabola
        turn = float(-b / (2.0 * a)) if a else math.inf
        return (turn, math.inf) if a < 0 else (-math.inf, turn)


def problems(
    levels: Sequence[float], rates: Sequence[float], slope: float | None, shape: str
) -> Iterator[tuple[int | None, str]]:
    """Yield each mistake in the points of a curve: the index of the point, or None, and a message; nothing for a sound curve.

    Unequal numbers of levels and rates, no point, and an impossible point end the search.
    """
    if shape not in ("points", "quadratic"):
        yield None, f'shape = "{shape}": write "points" or "quadratic"'
    if len(levels) != len(rates):
        yield None, f"levels and rates: {len(levels)} and {len(rates)}; write a rate for each level"
        return
    if not levels:
        yield None, "there is no point: write levels and their rates"
        return
    for place, (level, rate) in enumerate(zip(levels, rates, strict=True)):
        if not (level > 0 and rate > 0 and math.isfinite(level) and math.isfinite(rate)):
            yield place, f"level {level:g} with the rate {rate:g}: both are above 0"
            return
    for place, ((low, more), (high, less)) in enumerate(pairwise(zip(levels, rates, strict=True)), 1):
        if high <= low:
            yield place, f"level {high:g} after {low:g}: write them in rising order"
        elif less >= more:
            yield place, f"rate {less:g} per year at {high:g} after {more:g} at {low:g}: a stronger motion is rarer"
        elif place == 1 and math.log(more / less) > STEEPEST * math.log(high / low):  # of rates below the points
            yield place, f"the rate falls from {more:g} to {less:g} per year between {low:g} and {high:g}, {_TOO_STEEP}"
    if max(rates) > MOST_RATE:
        yield None, f"a rate of {max(rates):g} per year: is it a return period in years? Its rate is one over it"
    yield from _about_shape(levels, rates, slope, shape)


_TOO_STEEP = f"steeper than 1/x^{STEEPEST:g}: sites have powers of 1 to 10"


def _about_shape(
    levels: Sequence[float], rates: Sequence[float], slope: float | None, shape: str
) -> Iterator[tuple[int | None, str]]:
    """Yield the mistakes of ``slope`` and ``shape`` for the number of points."""
    if slope is not None and not slope > 0:
        yield None, f"slope = {slope:g}: it is k of a rate that falls as 1/x^k, above 0"
    elif slope is not None and slope > STEEPEST:
        yield None, f"slope = {slope:g}: {_TOO_STEEP}"
    if slope is not None and len(levels) > 1:
        yield None, f"slope and {len(levels)} points: the points say the slope; keep one point, or leave slope out"
    if slope is None and len(levels) == 1 and shape == "points":
        yield None, "one point says no slope: write a second one, or slope, such as 3.0"
    if shape == "quadratic" and len(levels) < 3:
        yield None, f"a parabola needs three points, and there {'are' if len(levels) == 2 else 'is'} {len(levels)}"
    elif shape == "quadratic" and all(b > a > 0 for a, b in pairwise(levels)):
        a, b, _ = np.polyfit(np.log(levels), np.log(rates), 2)
        if not max(2.0 * a * math.log(x) + b for x in (levels[0], levels[-1])) < 0:
            yield None, 'the parabola does not fall all over its points: write shape = "points", or other points'
