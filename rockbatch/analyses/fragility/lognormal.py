"""Lognormal fragility P(x) = Φ(ln(x/θ)/β) by maximum likelihood, with its confidence region.

A record has a capacity, the intensity that it takes to exceed a limit, of which an analysis gives the interval: up to x
if the limit is exceeded at x, above x if it is not, or the bracket of a bisection. One likelihood serves all,

    ℓ = Σ n ln[Φ(z(high)) − Φ(z(low))],    z(x) = ln(x/θ)/β = a + b ln x.

For stripes, whose intervals are one-sided, it is the binomial likelihood of multiple stripe analysis; for the brackets of an
incremental dynamic analysis, with records that never exceeded the limit as censored ones, that of a truncated one (both in
Baker 2015, Earthquake Spectra 31(1):579–599). It is concave in (a, b), as Φ is log-concave and so is its difference over an
interval: there is one maximum at most.

β of its maximum is low at few records, as a standard deviation with n in its denominator is: the spread about the records' own
mean lacks that of the mean. The curve has β² = β_ML² + Var(ln θ), the variance by stations: of independent capacities this is
the sample's, with n − 1, and of the components of stations the unbiased one of an analysis of variance.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize
from scipy.special import log_ndtr, ndtr, ndtri
from scipy.stats import t as student

from rockbatch.analyses.fragility.bounds import (
    STATIONS_OF_INTERVAL,
    Interval,
    NoCurve,
    Numbers,
    Values,
    by_station,
    outside,
    separated,
    too_few,
)

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
    shape (m, n), holds what each of m records contributes to ``count``; None if each interval is of one record, or of fresh ones.
    ``station``, shape (m,), is the number of the station of each; None for fresh records, each of a station by itself.
    """

    low: Values
    high: Values
    count: Values
    of_record: Values | None = None
    station: Numbers | None = None

    def __post_init__(self) -> None:
        if self.of_record is not None and self.station is None:
            object.__setattr__(self, "station", np.arange(len(self.of_record)))

    @classmethod
    def of_same_records(
        cls, levels: Values, within: Values, beyond: Values, station: Numbers | None = None
    ) -> "Capacities":
        """Return the capacities of m records by the share, 0 to 1, of each ``within`` and ``beyond`` the limit at n levels.

        Both have the shape (m, n). Records with neither at any level are left out, and so are intervals without a record.
        ``station`` has the number of each record's station; by default each is of one by itself.
        """
        of_record = np.hstack((beyond, within)).astype(np.float64)
        low = np.concatenate((np.zeros(len(levels)), levels))
        high = np.concatenate((levels, np.full(len(levels), np.inf)))
        used, counting = of_record.any(axis=0), of_record.any(axis=1)
        of_record = of_record[counting][:, used]
        numbers = np.arange(len(within)) if station is None else station
        return cls(low[used], high[used], of_record.sum(axis=0), of_record, numbers[counting])

    @classmethod
    def of_brackets(cls, low: Values, high: Values, station: Numbers | None = None) -> "Capacities":
        """Return the capacities of m records with one bracket each, shape (m,), without those between 0 and infinity.

        ``station`` has the number of each record's station; by default each is of one by itself.
        """
        known = (low > 0) | np.isfinite(high)
        station = np.arange(len(low)) if station is None else station
        return cls(low[known], high[known], np.ones(known.sum()), None, station[known])

    @property
    def records(self) -> float:
        """Return the number of records."""
        return float(self.count.sum()) if self.station is None else len(self.station)

    def by_record(self, scores: Values) -> Values:
        """Return the sums of the ``scores`` of intervals, shape (n, k), of each of the m records, shape (m, k)."""
        return scores if self.of_record is None else self.of_record @ scores

    @property
    def stations(self) -> int:
        """Return the number of stations."""
        return int(self.records) if self.station is None else len(np.unique(self.station))

    def of_stations(self) -> tuple[Values, Values, Values]:
        """Return the ends of stations by :func:`by_station`, and how many stations have each, shape (k,) each."""
        if self.station is None:
            return self.low, self.high, self.count
        low, high = self.low, self.high
        if self.of_record is not None:
            low = np.where(self.of_record > 0, low, 0.0).max(axis=1, initial=0.0)
            high = np.where(self.of_record > 0, high, np.inf).min(axis=1, initial=np.inf)
        low, high = by_station(low, high, self.station)
        return low, high, np.ones(len(low))


@dataclass(frozen=True)
class Lognormal:
    """A fitted fragility curve."""

    # θ, in the unit of the levels, and β of the sample, β² unbiased
    median: float
    dispersion: float
    # profile-likelihood intervals by stations; a bound is 0 or infinite where the data leave it open; None with fewer than
    # STATIONS_OF_INTERVAL, 5, stations
    median_interval: Interval | None
    dispersion_interval: Interval | None
    region: Values | None  # edge of the region of (a, b) from which all intervals come, shape (m, 2)
    most_likely_dispersion: float = math.nan  # β of the maximum of the likelihood, which is low at few records
    stations: int = 0  # number of stations whose records it is of

    def probability(self, x: Values) -> Values:
        """Return P(x), shape of ``x``."""
        return ndtr(np.log(x / self.median) / self.dispersion)

    def band(self, x: Values) -> tuple[Values, Values] | None:
        """Return the pointwise profile-likelihood interval of P(x), each shape (n,); None without intervals."""
        if self.region is None:
            return None
        a, b = self.region.T
        z = a + b * np.log(x)[:, None]
        return ndtr(z.min(axis=1)), ndtr(z.max(axis=1))

    def widened(self, added: float) -> "Lognormal":
        """Return the curve with the dispersion √(β² + added²), also in its interval and region, and the median as it is."""
        if added == 0:
            return self
        wide, interval = self.region, self.dispersion_interval
        if wide is not None and interval is not None:
            wide = wide / np.sqrt(1.0 + (added * wide[:, 1:]) ** 2)
            interval = math.hypot(interval[0], added), math.hypot(interval[1], added)
        return replace(self, dispersion=math.hypot(self.dispersion, added), dispersion_interval=interval, region=wide)

    def rate(self, x: Values, rates: Values) -> tuple[float, float, float]:
        """Return Σ P(x) times the annual ``rates`` of motions about each x, shape (n,), and its profile-likelihood interval.

        It rises with a everywhere, so that its extremes over the region are on the edge; the upper bound is infinite where
        the data leave the dispersion open. Both are NaN without intervals.
        """
        rate = float(self.probability(x) @ rates)
        if self.region is None:
            return rate, math.nan, math.nan
        a, b = self.region.T
        sums = ndtr(a[:, None] + b[:, None] * np.log(x)) @ rates
        return rate, float(sums.min()), float(sums.max()) if (b > 0).all() else math.inf


def fit(capacities: Capacities, confidence: float = 0.95) -> Lognormal | NoCurve:
    """Return the curve of maximum likelihood, with an unbiased β², or ``NoCurve`` with the reason.

    There is none with fewer than STATIONS_OF_CURVE, 3, stations, if no level or bracket tells the dispersion, if the share
    beyond the limit does not grow, or with a median outside the intensities that were run. With fewer than
    STATIONS_OF_INTERVAL, 5, stations the curve has no intervals.

    The intervals are those of the profile likelihood: extremes over a region of (a, b). Unlike a bootstrap they need no luck:
    with a few records many resampled suites cannot be fitted. Unlike the delta method they keep to θ > 0, β > 0 and
    0 ≤ P ≤ 1, and are as skew as the data are few.

    The likelihood takes all records, and those of every level, as independent. Where they are not, the curve remains, but
    says much less than as many suites would: the region is stretched to the covariance of the scores of stations
    (Chandler & Bate 2007, Biometrika 94(1):167–183), and reaches to Student's quantile of their number.
    """
    stations = capacities.stations
    if refusal := too_few(stations) or _degenerate(capacities, confidence):
        return refusal
    likelihood = _Likelihood(capacities)
    best = likelihood.maximum()
    if best is None:
        return NoCurve(NOT_RISING)
    a, b = likelihood.plain(best)
    median, most_likely = math.exp(min(max(-a / b, -700.0), 700.0)), float(1.0 / b)
    scatter = _Scatter(likelihood, best)
    dispersion = math.hypot(most_likely, scatter.of_median)
    curve = Lognormal(median, dispersion, None, None, None, most_likely, stations)
    if stations >= STATIONS_OF_INTERVAL:
        edge = likelihood.region(best, scatter, confidence) * (most_likely / dispersion)
        median_interval, dispersion_interval = _intervals(edge)
        curve = replace(curve, median_interval=median_interval, dispersion_interval=dispersion_interval, region=edge)
    ends = np.concatenate((capacities.low, capacities.high))
    ends = ends[(ends > 0) & np.isfinite(ends)]
    return outside(curve, float(ends.min()), float(ends.max())) or curve


@dataclass(frozen=True)
class Contribution:
    """Contribution of drawn inputs to the dispersion of capacities."""

    dispersion: float  # standard deviation of ln x that goes with them
    interval: tuple[float, float]  # its interval, by the standard error of the square
    # change of ln x with a standard deviation of each, and its standard error
    effects: tuple[float, ...]
    errors: tuple[float, ...]


def contribution(
    capacities: Capacities, scores: Values, correlation: Values, confidence: float = 0.95
) -> Contribution | NoCurve:
    """Return the contribution of k inputs, drawn with normal ``scores`` of shape (n, k), or why it is unknown.

    It is unknown if the capacities have no curve, if they are fewer than LEAST_PER_PARAMETER, 5, for each of k + 2 parameters,
    or if the scores separate those beyond the limit from the others. It is 0 at least, and exact, with errors of 0, if
    brackets leave nothing to chance.

    The likelihood is that of :func:`fit` with a factor for each of the scores, z = a + b ln x + Σ c_j s_j, so that an input
    changes ln x by −c_j/b. Of the square that the changes make with their ``correlation``, shape (k, k), the share that
    chance gives to any input is taken off: that of their covariance, which is stretched as the region of :func:`fit`.
    """
    assert capacities.station is not None
    n, k = scores.shape
    if refusal := _degenerate(capacities, confidence):
        return refusal
    if n < LEAST_PER_PARAMETER * (k + 2):
        return NoCurve(f"{n} runs or capacities are too few to fit {k + 2} parameters")
    likelihood = _Likelihood(capacities, scores)
    best = likelihood.maximum()
    if best is None:
        return NoCurve(NOT_RISING)
    _, b, *factors = best
    effects = -likelihood.width * np.array(factors) / b
    if likelihood.value(*best)[0] > -SEPARATED * n:  # nothing is left to chance
        brackets = (capacities.low > 0) & np.isfinite(capacities.high)
        if brackets.sum() < LEAST_PER_PARAMETER * (k + 2):
            return NoCurve("with them the runs beyond the limit are separated from the others: more of both are needed")
        whole = math.sqrt(effects @ correlation @ effects)
        return Contribution(whole, (whole, whole), tuple(effects.tolist()), k * (0.0,))
    slopes, hessian = likelihood.derivatives(best)
    informations, axes = np.linalg.eigh(-hessian)
    known = informations > 1e-9 * informations[-1]  # the factors of two inputs that go together are not known apart
    roots = axes[:, known] / np.sqrt(informations[known])
    spread = roots @ _stretch(roots.T @ sums_by(capacities.station, capacities.by_record(slopes)).T)
    spread = np.column_stack((np.zeros(k), -effects / b, -likelihood.width / b * np.eye(k))) @ spread
    together = correlation @ spread @ spread.T
    square = float(effects @ correlation @ effects - np.trace(together))
    of_square = math.sqrt(4.0 * effects @ together @ correlation @ effects + 2.0 * np.trace(together @ together))
    reach = float(ndtri(0.5 + 0.5 * confidence)) * of_square
    least, middle, most = (math.sqrt(max(value, 0.0)) for value in (square - reach, square, square + reach))
    errors = np.sqrt((spread**2).sum(axis=1))
    return Contribution(middle, (least, most), tuple(effects.tolist()), tuple(errors.tolist()))


def _degenerate(capacities: Capacities, confidence: float) -> NoCurve | None:
    """Return ``NoCurve``, with any bounds of the median, if the data determine no median or no dispersion; None if they do."""
    low, high, stations = capacities.of_stations()
    if refusal := separated(low, high, confidence, stations):
        return refusal
    highest = float(capacities.low.max())
    if highest == float(capacities.high.min()):
        return NoCurve(
            f"{highest:.4g} is the only level at which some records exceed the limit and others do not: levels nearer to it "
            "would show the dispersion"
        )
    return None


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
        self.count, self.capacities = capacities.count, capacities
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
        log_d[np.isneginf(log_d)] = (
            np.inf
        )  # a point without probability, which the search tries and leaves: no derivatives
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
        """Return (a, b, …) over standardised ln x at the maximum; None if b is not above LEAST_SLOPE, 0.001, there."""
        optimum = minimize(
            lambda point: -self.value(*point)[0],
            np.array([0.0, 1.0, *np.zeros(self.inputs.shape[1])]),
            jac=lambda point: -self.count @ self.derivatives(point)[0],
            hess=lambda point: -self.derivatives(point)[1],
            method="trust-exact",
            options={"gtol": 1e-9 * self.count.sum()},
        )
        return np.asarray(optimum.x) if optimum.x[1] > LEAST_SLOPE else None

    def region(self, best: Values, scatter: "_Scatter", confidence: float) -> Values:
        """Return RAYS points on the edge of the region of (a, b) over ln x, from which all intervals come, shape (RAYS, 2).

        ℓ is there n/2 ln(1 + t²/n) below its maximum, with n records and Student's quantile t of the number of stations less
        1: of n independent capacities, the interval of ln θ is then Student's. Where records contribute several times it is
        t²/2 below. That edge is then stretched about the maximum as ``scatter`` says.
        """
        t, n = float(student.ppf(0.5 + 0.5 * confidence, scatter.stations - 1)), scatter.records
        least = self.value(*best)[0] - 0.5 * (t * t if scatter.repeated else n * math.log1p(t * t / n))
        # Rays that would be evenly spread if ℓ were quadratic; ℓ is concave, so each leaves the region once
        angles = np.linspace(0.0, 2.0 * math.pi, RAYS, endpoint=False)
        directions = np.array([np.cos(angles), np.sin(angles)])
        rays = scatter.roots @ directions

        def inside(reach: Values) -> npt.NDArray[np.bool_]:
            return self.value(*(best[:, None] + reach * rays)) >= least

        near, far = np.zeros(RAYS), np.ones(RAYS)
        while (still := inside(far)).any():
            near, far = np.where(still, far, near), np.where(still, 2.0 * far, far)
        for _ in range(HALVINGS):
            middle = 0.5 * (near + far)
            within = inside(middle)
            near, far = np.where(within, middle, near), np.where(within, far, middle)
        plain = best[:, None] + near * rays
        a, b = best[:, None] + scatter.roots @ (scatter.stretch[:, None] * near * directions)
        if (plain[1] > 0).all() and (b > 0).all():  # medians by the first factor alone, whatever the second does to b
            middle = -best[0] / best[1]
            a = -b * (middle + scatter.stretch[0] * (-plain[0] / plain[1] - middle))
        return self.plain(np.array([a, b])).T

    def plain(self, ab: Values) -> Values:
        """Return (a, b) over ln x, converted from standardised ln x."""
        b = ab[1] / self.width
        return np.array([ab[0] - b * self.centre, b])


class _Scatter:
    """Scatter of the scores of stations over that assumed by the likelihood.

    ``roots`` bring directions with an information of 1 to (a, b): the first changes the median, the second does not.
    ``stretch``, shape (2,), are factors on deviations along them; ``of_median`` is the standard error of ln θ by stations.

    Along the first, the variance of the scores of k stations is that of their sums, times k/(k − 1). Along the second, the
    spread, such a variance would say little at few stations; but where m components of a station have the correlation ρ,
    their squares have ρ², so that the first, 1 + (m − 1)ρ times the information, tells the second, 1 + (m − 1)ρ² times. From
    level to level, of records that contribute at several, the scatter is that of the records' scores, times k/(k − 2).
    """

    def __init__(self, likelihood: _Likelihood, best: Values) -> None:
        capacities = likelihood.capacities
        a, b = best
        scores, hessian = likelihood.derivatives(best)
        whitened = np.linalg.inv(np.linalg.cholesky(-hessian)).T
        gradient = whitened.T @ np.array([-1.0 / b, a / b**2])
        error = float(np.linalg.norm(gradient))
        along = gradient / error
        self.roots = whitened @ np.array([[along[0], -along[1]], [along[1], along[0]]])
        self.records, self.stations = capacities.records, capacities.stations
        k, station = self.stations, capacities.station
        self.repeated = False
        first, self.stretch = k / (k - 1), np.ones(2)
        if station is not None:
            of_record = capacities.of_record
            self.repeated = of_record is not None and bool((of_record.sum(axis=1) > 1.5).any())
            of_records = capacities.by_record(scores) @ self.roots
            first *= float((sums_by(station, of_records)[:, 0] ** 2).sum())
            alone = float((of_records[:, 0] ** 2).sum()) if self.repeated else 1.0
            shared = float((sums_by(station, np.ones((len(station), 1))) ** 2).sum()) / len(station) - 1.0
            second = 1.0 + (max(first / alone - 1.0, 0.0) ** 2 / shared if shared > 0 else 0.0)
            if self.repeated:
                second *= k / (k - 2) * float((of_records[:, 1] ** 2).sum())
                first, second = (
                    max(first, 1.0),
                    max(second, 1.0),
                )  # records that are the same say no more than fresh ones
            self.stretch = np.sqrt([first, second])
        self.of_median = math.sqrt(first) * error * likelihood.width


def sums_by(station: Numbers, values: Values) -> Values:
    """Return the sums of ``values``, shape (m, k), over the records of each station, by its number, shape (stations, k)."""
    _, places = np.unique(station, return_inverse=True)
    sums = np.zeros((places.max() + 1, values.shape[1]))
    np.add.at(sums, places, values)
    return sums


def _stretch(scores: Values) -> Values:
    """Return the matrix, shape (q, q), that stretches deviations to the scatter of the scores of m stations, shape (q, m).

    The scores are scaled to an information of 1; no deviation is shortened.
    """
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
    """Return the intervals of θ = exp(−a/b) and β = 1/b over a region's ``edge``.

    If it reaches b ≤ 0, the upper bound of β is infinite, and where it crosses b = 0, with a > 0 the lower bound of θ is 0, with
    a < 0 the upper one infinite.
    """
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
    """Return the values of ``a`` at which the closed polygon of points (a, b) crosses b = 0."""
    a2, b2 = np.roll(a, -1), np.roll(b, -1)
    crosses = (b > 0) != (b2 > 0)
    return list((a * b2 - a2 * b)[crosses] / (b2 - b)[crosses])
