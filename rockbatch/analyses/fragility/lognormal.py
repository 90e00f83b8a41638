"""Lognormal fragility P(x) = Φ(ln(x/θ)/β) by maximum likelihood, with its confidence region.

A record has a capacity, the intensity that it takes to exceed a limit, of which an analysis gives the interval: up to x
if the limit is exceeded at x, above x if it is not, or the bracket of a bisection. One likelihood serves all,

    ℓ = Σ n ln[Φ(z(high)) − Φ(z(low))],    z(x) = ln(x/θ)/β = a + b ln x.

For stripes, whose intervals are one-sided, it is the binomial likelihood of multiple stripe analysis; for the brackets of an
incremental dynamic analysis, with records that never exceeded the limit as censored ones, that of a truncated one (both in
Baker 2015, Earthquake Spectra 31(1):579–599). It is concave in (a, b), as Φ is log-concave and so is its difference over an
interval: there is one maximum at most.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize
from scipy.special import log_ndtr, ndtr, ndtri

Values = npt.NDArray[np.float64]

RAYS = 360
"""Directions in which the edge of the confidence region is sought; between two it is off by 4e-5 of its width."""

HALVINGS = 30
"""Bisections of a ray around the edge."""

NOT_RISING = "the share of records beyond the limit does not grow with the intensity"

LEAST_PER_PARAMETER = 5
"""Runs or capacities by which a parameter can be distinguished from chance."""

SEPARATED = 1e-3
"""ℓ of an interval, below which (in magnitude) the inputs leave nothing open: a probability of 0.999."""

LEAST_SLOPE = 1e-3
"""Least slope of z over standardised ln x; below, the capacity would spread over more than a thousand times what was sampled."""


@dataclass(frozen=True)
class Capacities:
    """Intervals of capacities, low < x ≤ high, each with the number of records in it; shape (n,).

    ``low`` is 0 if the limit was exceeded at the lowest level, ``high`` infinite if it never was. ``of_record``,
    shape (m, n), holds what each of m records contributes to ``count`` where a record contributes several times.
    """

    low: Values
    high: Values
    count: Values
    of_record: Values | None = None

    @classmethod
    def of_same_records(cls, levels: Values, within: Values, beyond: Values) -> "Capacities":
        """Return those of m records, each ``within`` or ``beyond`` the limit at each level, shape (m, n), or neither."""
        of_record = np.hstack((beyond, within)).astype(np.float64)
        low = np.concatenate((np.zeros(len(levels)), levels))
        high = np.concatenate((levels, np.full(len(levels), np.inf)))
        used = of_record.any(axis=0)
        of_record = of_record[of_record.any(axis=1)][:, used]
        return cls(low[used], high[used], of_record.sum(axis=0), of_record)


@dataclass(frozen=True)
class Lognormal:
    """A fitted fragility curve.

    Attributes
    ----------
    median, dispersion : float
        θ, in the unit of the levels, and β.
    median_interval, dispersion_interval : tuple of two floats
        Profile-likelihood intervals; a bound is 0 or infinite where the data leave it open.
    region : ndarray, shape (m, 2)
        Edge of the region of (a, b) from which all intervals come.
    """

    median: float
    dispersion: float
    median_interval: tuple[float, float]
    dispersion_interval: tuple[float, float]
    region: Values

    def probability(self, x: Values) -> Values:
        """Return P(x), shape of ``x``."""
        return ndtr(np.log(x / self.median) / self.dispersion)

    def band(self, x: Values) -> tuple[Values, Values]:
        """Return the pointwise profile-likelihood interval of P(x), each shape (n,)."""
        a, b = self.region.T
        z = a + b * np.log(x)[:, None]
        return ndtr(z.min(axis=1)), ndtr(z.max(axis=1))

    def widened(self, added: float) -> "Lognormal":
        """Return the curve with a dispersion ``added`` to its own, independent of it, by the root of the squares."""
        if added == 0:
            return self
        wide = self.region / np.sqrt(1.0 + (added * self.region[:, 1:]) ** 2)
        low, high = (math.hypot(bound, added) for bound in self.dispersion_interval)
        return replace(
            self, dispersion=math.hypot(self.dispersion, added), dispersion_interval=(low, high), region=wide
        )

    def rate(self, x: Values, rates: Values) -> tuple[float, float, float]:
        """Return Σ P(x) times the annual ``rates`` of motions about each x, shape (n,), and its profile-likelihood interval.

        It rises with a everywhere, so that its extremes over the region are on the edge; the upper bound is infinite where
        the data leave the dispersion open.
        """
        a, b = self.region.T
        sums = ndtr(a[:, None] + b[:, None] * np.log(x)) @ rates
        return float(self.probability(x) @ rates), float(sums.min()), float(sums.max()) if (b > 0).all() else math.inf


def fit(capacities: Capacities, confidence: float = 0.95) -> Lognormal | str:
    """Return the maximum-likelihood curve, or why the data do not have one, in words.

    The intervals are those of the profile likelihood: extremes over all (a, b) whose ℓ is within half the χ²₁ quantile of
    the maximum. Unlike a bootstrap they need no luck: with a few records many resampled suites cannot be fitted. Unlike
    the delta method they keep to θ > 0, β > 0 and 0 ≤ P ≤ 1, and are as skew as the data are few.

    The binomial likelihood takes the records of every level as fresh ones. Where they are the same, the curve remains, but
    levels say much less than as many suites would: the region is stretched to the covariance of the records' own scores
    (Chandler & Bate 2007, Biometrika 94(1):167–183), and never shrunk.
    """
    refusal = _degenerate(capacities)
    if refusal:
        return refusal
    likelihood = _Likelihood(capacities)
    best = likelihood.maximum()
    if best is None:
        return NOT_RISING
    edge = likelihood.region(best, confidence)
    a, b = likelihood.plain(best)
    return Lognormal(math.exp(-a / b), float(1.0 / b), *_intervals(edge), edge)


@dataclass(frozen=True)
class Contribution:
    """Contribution of drawn inputs to the dispersion of capacities.

    Attributes
    ----------
    dispersion : float
        Standard deviation of ln x that goes with them.
    interval : tuple of two floats
        Its interval, by the standard error of the square.
    effects, errors : tuple of float
        Change of ln x with a standard deviation of each, and its standard error.
    """

    dispersion: float
    interval: tuple[float, float]
    effects: tuple[float, ...]
    errors: tuple[float, ...]


def contribution(
    capacities: Capacities, scores: Values, correlation: Values, confidence: float = 0.95
) -> Contribution | str:
    """Return what k inputs contribute that were drawn with normal ``scores``, shape (n, k), or why that is not known, in words.

    The likelihood is that of :func:`fit` with a factor for each of the scores, z = a + b ln x + Σ c_j s_j, so that an input
    changes ln x by −c_j/b. Of the square that the changes make with their ``correlation``, shape (k, k), the share that
    chance gives to any input is taken off: that of their covariance, which is stretched as the region of :func:`fit`.
    """
    assert capacities.of_record is not None
    n, k = scores.shape
    if refusal := _degenerate(capacities):
        return refusal
    if n < LEAST_PER_PARAMETER * (k + 2):
        return f"{n} runs or capacities are too few to tell {k + 2} parameters"
    likelihood = _Likelihood(capacities, scores)
    best = likelihood.maximum()
    if best is None:
        return NOT_RISING
    _, b, *factors = best
    effects = -likelihood.width * np.array(factors) / b
    if likelihood.value(*best)[0] > -SEPARATED * n:  # nothing is left to chance
        brackets = (capacities.low > 0) & np.isfinite(capacities.high)
        if brackets.sum() < LEAST_PER_PARAMETER * (k + 2):
            return "with them the runs beyond the limit are separated from the others: more of both would tell"
        whole = math.sqrt(effects @ correlation @ effects)
        return Contribution(whole, (whole, whole), tuple(effects.tolist()), k * (0.0,))
    slopes, hessian = likelihood.derivatives(best)
    informations, axes = np.linalg.eigh(-hessian)
    known = informations > 1e-9 * informations[-1]  # the factors of two inputs that go together are not known apart
    roots = axes[:, known] / np.sqrt(informations[known])
    spread = roots @ _stretch(roots.T @ (capacities.of_record @ slopes).T)
    spread = np.column_stack((np.zeros(k), -effects / b, -likelihood.width / b * np.eye(k))) @ spread
    together = correlation @ spread @ spread.T
    square = float(effects @ correlation @ effects - np.trace(together))
    of_square = math.sqrt(4.0 * effects @ together @ correlation @ effects + 2.0 * np.trace(together @ together))
    reach = float(ndtri(0.5 + 0.5 * confidence)) * of_square
    least, middle, most = (math.sqrt(max(value, 0.0)) for value in (square - reach, square, square + reach))
    errors = np.sqrt((spread**2).sum(axis=1))
    return Contribution(middle, (least, most), tuple(effects.tolist()), tuple(errors.tolist()))


def _degenerate(capacities: Capacities) -> str:
    """Return why the data give no dispersion, or nothing at all; empty if they do."""
    low, high = capacities.low, capacities.high
    if len(low) == 0:
        return "no record counts"
    highest, lowest = float(low.max()), float(high.min())
    if np.isinf(high).all():
        return f"no record exceeds the limit up to {highest:.4g}: the median is beyond"
    if (low == 0).all():
        return f"every record exceeds the limit from {lowest:.4g} on: the median is below"
    if highest < lowest:
        return (
            f"no record exceeds the limit at {highest:.4g}, every one at {lowest:.4g}: the median is between, and levels "
            "between them would tell the dispersion"
        )
    if highest == lowest:
        return (
            f"some records exceed the limit at {highest:.4g}, none below and all above: levels nearer to it would tell the "
            "dispersion"
        )
    return ""


class _Likelihood:
    """ℓ of (a, b), with its scores and Hessian, over ln x brought to mean 0 and deviation 1.

    There may be further parameters: factors on ``inputs``, shape (n, k).
    """

    def __init__(self, capacities: Capacities, inputs: Values | None = None) -> None:
        with np.errstate(divide="ignore"):
            low, high = np.log(capacities.low), np.log(capacities.high)
        finite = np.concatenate((low[np.isfinite(low)], high[np.isfinite(high)]))
        self.centre, self.width = float(finite.mean()), float(finite.std())
        self.low, self.high = (low - self.centre) / self.width, (high - self.centre) / self.width
        self.count, self.of_record = capacities.count, capacities.of_record
        self.inputs = np.empty((len(low), 0)) if inputs is None else inputs

    def value(self, *parameters: Values) -> Values:
        """Return ℓ of a, b and the factors on the inputs, each shape (m,); −∞ where a bracket has no probability."""
        points = np.array(parameters).reshape(len(parameters), -1).T
        z1, z2 = self._z(points)
        return (self.count * _log_difference(z1, z2)).sum(axis=-1)

    def _z(self, points: Values) -> tuple[Values, Values]:
        """Return z at both ends of every interval, shape (m, n), for ``points`` of shape (m, 2 + k)."""
        a, b = points.T[:2, :, None]
        a = a + points[:, 2:] @ self.inputs.T
        z1 = np.where(np.isinf(self.low), -np.inf, a + b * np.where(np.isinf(self.low), 0.0, self.low))
        z2 = np.where(np.isinf(self.high), np.inf, a + b * np.where(np.isinf(self.high), 0.0, self.high))
        return z1, z2

    def derivatives(self, point: Values) -> tuple[Values, Values]:
        """Return the score of one record in each interval, shape (n, 2 + k), and the Hessian, shape (2 + k, 2 + k), of ℓ."""
        z1, z2 = (z[0] for z in self._z(point[None]))
        log_d = _log_difference(z1, z2)
        g1, g2 = (np.exp(-0.5 * z**2 - 0.5 * math.log(2.0 * math.pi) - log_d) for z in (z1, z2))
        z1, x1 = np.where(np.isinf(z1), 0.0, z1), np.where(np.isinf(self.low), 0.0, self.low)
        z2, x2 = np.where(np.isinf(z2), 0.0, z2), np.where(np.isinf(self.high), 0.0, self.high)
        n, inputs = self.count, self.inputs
        scores = np.column_stack((g2 - g1, g2 * x2 - g1 * x1, (g2 - g1)[:, None] * inputs))
        h22, h11, h12 = -g2 * (z2 + g2), g1 * (z1 - g1), g1 * g2
        aa, ab = n * (h22 + 2 * h12 + h11), n * (h22 * x2 + h12 * (x1 + x2) + h11 * x1)
        bb = n * (h22 * x2**2 + 2 * h12 * x1 * x2 + h11 * x1**2)
        of_ab = np.array([[aa.sum(), ab.sum()], [ab.sum(), bb.sum()]])
        mixed = np.array([aa, ab]) @ inputs  # an input is the same at both ends of an interval, as a is
        return scores, np.block([[of_ab, mixed], [mixed.T, inputs.T @ (aa[:, None] * inputs)]])

    def maximum(self) -> Values | None:
        """Return (a, b, …) over standardised ln x at the maximum; None if b > 0 does not hold there."""
        optimum = minimize(
            lambda point: -self.value(*point)[0],
            np.array([0.0, 1.0, *np.zeros(self.inputs.shape[1])]),
            jac=lambda point: -self.count @ self.derivatives(point)[0],
            hess=lambda point: -self.derivatives(point)[1],
            method="trust-exact",
            options={"gtol": 1e-9 * self.count.sum()},
        )
        return np.asarray(optimum.x) if optimum.x[1] > LEAST_SLOPE else None

    def region(self, best: Values, confidence: float) -> Values:
        """Return the edge of the region where ℓ is within half the χ²₁ quantile of its maximum, in (a, b) over ln x."""
        least = self.value(*best)[0] - 0.5 * ndtri(0.5 + 0.5 * confidence) ** 2
        # Rays that would be evenly spread if ℓ were quadratic; ℓ is concave, so each leaves the region once
        scores, hessian = self.derivatives(best)
        lower = np.linalg.cholesky(-hessian)
        roots = np.linalg.inv(lower).T
        angles = np.linspace(0.0, 2.0 * math.pi, RAYS, endpoint=False)
        rays = roots @ np.array([np.cos(angles), np.sin(angles)])

        def inside(reach: Values) -> npt.NDArray[np.bool_]:
            return self.value(*(best[:, None] + reach * rays)) >= least

        near, far = np.zeros(RAYS), np.ones(RAYS)
        while (still := inside(far)).any():
            near, far = np.where(still, far, near), np.where(still, 2.0 * far, far)
        for _ in range(HALVINGS):
            middle = 0.5 * (near + far)
            within = inside(middle)
            near, far = np.where(within, middle, near), np.where(within, far, middle)
        edge = near * rays
        if self.of_record is not None:
            edge = roots @ _stretch(roots.T @ (self.of_record @ scores).T) @ lower.T @ edge
        return self.plain(best[:, None] + edge).T

    def plain(self, ab: Values) -> Values:
        """Return (a, b) over ln x from those over what was standardised."""
        b = ab[1] / self.width
        return np.array([ab[0] - b * self.centre, b])


def _stretch(scores: Values) -> Values:
    """Return factors on deviations, shape (2, 2), from the scores of m records, shape (2, m), scaled to an information of 1."""
    m = scores.shape[1]
    variances, axes = np.linalg.eigh(scores @ scores.T * (m / max(m - 1, 1)))
    return (axes * np.sqrt(np.maximum(variances, 1.0))) @ axes.T


def _log_difference(z1: Values, z2: Values) -> Values:
    """Return ln[Φ(z2) − Φ(z1)] without cancellation in either tail; −∞ where z2 ≤ z1."""
    upper = z1 > 0  # Φ(z2) − Φ(z1) = Φ(−z1) − Φ(−z2)
    small, large = log_ndtr(np.where(upper, -z2, z1)), log_ndtr(np.where(upper, -z1, z2))
    with np.errstate(divide="ignore", invalid="ignore"):
        difference = large + np.log(-np.expm1(small - large))
    return np.where(z2 > z1, difference, -np.inf)


def _intervals(edge: Values) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the intervals of θ = exp(−a/b) and β = 1/b over the region; open where it reaches b ≤ 0."""
    a, b = edge.T
    rising = b > 0
    medians = np.exp(np.clip(-a[rising] / b[rising], -700.0, 700.0))
    low, high = float(medians.min()), float(medians.max())
    least, most = float(1.0 / b[rising].max()), float(1.0 / b[rising].min())
    if not rising.all():
        at_zero = _crossings(a, b)
        low, high = (0.0 if max(at_zero) > 0 else low), (math.inf if min(at_zero) < 0 else high)
        most = math.inf
    return (low, high), (least, most)


def _crossings(a: Values, b: Values) -> list[float]:
    """Return a where the closed edge crosses b = 0."""
    a2, b2 = np.roll(a, -1), np.roll(b, -1)
    crosses = (b > 0) != (b2 > 0)
    return list((a * b2 - a2 * b)[crosses] / (b2 - b)[crosses])
