"""Cloud analysis: fragility from unscaled records, by a line of ln demand over ln intensity and a logistic share of overturning.

Of the records that stand, ln D = ln a + b ln x + ε, with ε normal of deviation σ; the share that overturns is logistic in ln x:

    P(x) = Φ((ln a + b ln x − ln d)/σ) (1 − C(x)) + C(x),    C(x) = 1/(1 + exp(−α0 − α1 ln x))

(Jalayer, Ebrahimian, Miano, Manfredi & Sezen 2017, Earthq. Eng. Struct. Dyn. 46(15):2639–2663). A rocking pier that does not lift
off has no demand, or next to none, of which the logarithm says nothing about those near the limit d: demands below a share of d
are censored, known only to be below it (Tobin 1958, Econometrica 26(1):24–36).

Records of one station share a part of ε. Mean squares between and within stations, as of an analysis of variance, give σ² and its
draws; the line, which they share too, scatters as that between stations says.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.special import expit, log_expit, log_ndtr, ndtr, ndtri
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
from rockbatch.analyses.fragility.lognormal import sums_by

DRAWS = 1000
"""Sets of parameters from their joint distribution, from which all intervals come."""

SEED = 2017
"""Seed of the draws, so that the same runs give the same intervals."""

PROPOSALS = 10_000
"""Points from which the draws of a logistic part are chosen."""

BLOCK = 1_000_000
"""Products of points and records that are in memory at a time."""

WIDER = 1.5
"""Width of the distribution of the proposals over that of the information at the maximum."""

LEAST_STEP = 0.02
"""Least step, in standard deviations, of sums over an added dispersion."""

LEAST_RECORDS = 4
"""Demands above the floor that a line needs."""

_WIDEST = 12.0
"""Greatest distance of ln x from the mean of the data at which medians are sought; beyond it a median is 0 or infinite."""


@dataclass(frozen=True)
class Regression:
    """ln D = intercept + slope ln x, deviation sigma; ``draws``, shape (m, 3), of all three."""

    intercept: float
    slope: float
    sigma: float
    draws: Values


@dataclass(frozen=True)
class Logistic:
    """Share 1/(1 + exp(−intercept − slope ln x)); ``draws``, shape (m, 2), of both."""

    intercept: float
    slope: float
    draws: Values


def _dispersion(x_16: Values, x_84: Values) -> Values:
    """Return half of ln(x_84/x_16), shape (n,), infinite where a curve does not reach both."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where((x_16 > 0) & np.isfinite(x_84), 0.5 * np.log(x_84 / x_16), np.inf)


@dataclass(frozen=True)
class Cloud:
    """A fragility curve of a cloud analysis."""

    limit: float  # d, in the unit of the demand; 1 of an event
    line: Regression | None  # demands of those that stand; None for an event, such as overturning itself
    overturning: Logistic | None  # share that overturns, or has the event; None if no record did, and it counts as 0
    confidence: float
    centre: float  # mean of ln x
    # number of stations whose records it is of; of fewer than five there are no intervals
    stations: int = STATIONS_OF_INTERVAL
    added: float = 0.0  # dispersion added to that of the records

    def probability(self, x: Values) -> Values:
        """Return P(x), shape of ``x``."""
        return self._probabilities(*self._parameters(), np.log(x))[0]

    def band(self, x: Values) -> tuple[Values, Values] | None:
        """Return the pointwise interval of P(x), each shape (n,); None with fewer than STATIONS_OF_INTERVAL, 5, stations."""
        if not self._has_intervals:
            return None
        low, high = np.quantile(self._of_draws(np.log(x)), self._ends, axis=0)
        return low, high

    @property
    def median(self) -> float:
        """Return x where P = 1/2; 0 or infinite if it is not within a factor exp(12) of the records."""
        return float(self._quantiles(0.5)[0])

    @property
    def dispersion(self) -> float:
        """Return half of ln(x_84/x_16), which is β of a lognormal curve; infinite if it does not reach both."""
        return float(_dispersion(*(self._quantiles(float(ndtr(z))) for z in (-1.0, 1.0)))[0])

    @property
    def median_interval(self) -> Interval | None:
        """Return the interval of the median; None with fewer than STATIONS_OF_INTERVAL, 5, stations."""
        return self._interval(self._quantiles(0.5, drawn=True)) if self._has_intervals else None

    @property
    def dispersion_interval(self) -> Interval | None:
        """Return the interval of the dispersion; None with fewer than STATIONS_OF_INTERVAL, 5, stations."""
        if not self._has_intervals:
            return None
        return self._interval(_dispersion(*(self._quantiles(float(ndtr(z)), drawn=True) for z in (-1.0, 1.0))))

    @property
    def _has_intervals(self) -> bool:
        return self.stations >= STATIONS_OF_INTERVAL

    def _interval(self, of_draws: Values) -> Interval:
        low, high = np.quantile(of_draws, self._ends, method="nearest")
        return float(low), float(high)

    def widened(self, added: float) -> "Cloud":
        """Return the curve with a dispersion ``added`` to ln x at the limit, and to any added before, by the root of squares."""
        return self if added == 0 else replace(self, added=math.hypot(self.added, added))

    def rate(self, x: Values, rates: Values) -> tuple[float, float, float]:
        """Return Σ P(x) times the annual ``rates`` of motions about each x, shape (n,), and its interval.

        The interval is NaN with fewer than STATIONS_OF_INTERVAL, 5, stations. A draw whose probability falls with the intensity
        counts with an infinite rate.
        """
        rate = float(self.probability(x) @ rates)
        if not self._has_intervals:
            return rate, math.nan, math.nan
        of_draws = self._of_draws(np.log(x)) @ rates
        for part in (self.line, self.overturning):
            if part is not None:
                of_draws = np.where(part.draws[:, 1] > 0, of_draws, np.inf)
        return rate, *self._interval(of_draws)

    @property
    def _ends(self) -> tuple[float, float]:
        return 0.5 - 0.5 * self.confidence, 0.5 + 0.5 * self.confidence

    def _parameters(self, *, drawn: bool = False) -> tuple[Values | None, Values | None]:
        """Return the parameters of the line and of the share, of every draw or of the curve, shape (m, k) each."""
        line, share = self.line, self.overturning
        if drawn:
            return None if line is None else line.draws, None if share is None else share.draws
        return (
            None if line is None else np.array([[line.intercept, line.slope, line.sigma]]),
            None if share is None else np.array([[share.intercept, share.slope]]),
        )

    def _of_draws(self, log_x: Values) -> Values:
        """Return P for each draw, shape (m, n)."""
        return self._probabilities(*self._parameters(drawn=True), log_x)

    def _probabilities(self, line: Values | None, share: Values | None, log_x: Values) -> Values:
        """Return P of m sets of parameters at ``log_x``, shape (n,) or (m, n), with the added dispersion: shape (m, n)."""
        if self.added == 0:
            return self._plain(line, share, log_x)
        # The trapezoidal rule, exact to 1e-8 with a step as wide as the rise of P or less
        step = min(max(self._rise / self.added, LEAST_STEP), 0.5)
        places = np.arange(-6.0, 6.0 + step, step)
        weights = np.exp(-0.5 * places**2)
        parts = (w * self._plain(line, share, log_x + self.added * z) for z, w in zip(places, weights, strict=True))
        total: Values = sum(parts) / weights.sum()
        return total

    @property
    def _rise(self) -> float:
        """Return the width in ln x of the steeper part of the curve: σ/b of the line, 1/α1 of the share."""
        line, share = self.line, self.overturning
        widths = [] if line is None else [line.sigma / line.slope]
        return min(widths if share is None else [*widths, 1.0 / share.slope])

    def _plain(self, line: Values | None, share: Values | None, log_x: Values) -> Values:
        beyond = 0.0 if share is None else expit(share[:, :1] + share[:, 1:] * log_x)
        if line is None:
            return np.asarray(beyond)
        standing = ndtr((line[:, :1] + line[:, 1:2] * log_x - math.log(self.limit)) / line[:, 2:])
        return standing * (1.0 - beyond) + beyond

    def _quantiles(self, p: float, *, drawn: bool = False) -> Values:
        """Return x where P = ``p``, of every draw or of the curve, by bisection; 0 or infinite if beyond exp(±12) of the data."""
        line, share = self._parameters(drawn=drawn)
        m = next(len(part) for part in (line, share) if part is not None)
        low, high = np.full((m, 1), self.centre - _WIDEST), np.full((m, 1), self.centre + _WIDEST)
        below, above = (self._probabilities(line, share, end)[:, 0] for end in (low, high))
        for _ in range(50):
            middle = 0.5 * (low + high)
            lower = self._probabilities(line, share, middle) < p
            low, high = np.where(lower, middle, low), np.where(lower, high, middle)
        return np.where(below >= p, 0.0, np.where(above < p, np.inf, np.exp(0.5 * (low + high)[:, 0])))


@dataclass(frozen=True)
class Demands:
    """Runs of a cloud: intensities ``x``, shape (n,), ``demand`` of those that stand, and which ``overturned``.

    ``within`` are those of which only this is known: that they do not exceed the limit. ``station``, shape (n,), has the
    number of the station of each; None if each is of a station by itself.
    """

    x: Values
    demand: Values
    overturned: npt.NDArray[np.bool_]
    within: npt.NDArray[np.bool_]
    station: Numbers | None = None

    @property
    def of_station(self) -> Numbers:
        """Return the number of the station of each run, shape (n,): ``station``, else its own for each run."""
        return _alone(self.x) if self.station is None else self.station


def _alone(x: Values) -> Numbers:
    return np.arange(len(x))


def fit(runs: Demands, limit: float, floor: float, confidence: float = 0.95) -> Cloud | NoCurve:
    """Return the curve of a limit above 0, or ``NoCurve`` with the reason; demands up to ``floor`` are censored.

    There is none with fewer than STATIONS_OF_CURVE, 3, stations or LEAST_RECORDS, 4, demands above the floor, if all are of one
    intensity or on one line, if demand or overturning does not grow with the intensity, or if all runs or none exceed the limit
    and the median lies outside them: of that it has a bound, by :func:`outside` or :func:`separated`.

    σ has n − 2 in its denominator, and its draws are those of a χ² variable, so that without censored demands the intervals of
    the line are Student's. The logistic part is penalised as Firth (1993, Biometrika 80(1):27–38) proposes, which
    keeps it finite where intensities part the records that overturned from the others.
    """
    log_x, stands, station = np.log(runs.x), ~runs.overturned, runs.of_station
    if refusal := too_few(len(np.unique(station))):
        return refusal
    if runs.overturned.all():
        return _on_one_side(runs.x, runs.overturned, station, confidence)
    share = _share(log_x, runs.overturned, station)
    if isinstance(share, NoCurve):
        return share
    exact = stands & ~runs.within & (runs.demand > floor)
    if np.count_nonzero(exact) < LEAST_RECORDS:
        return NoCurve(
            f"{np.count_nonzero(exact)} records stand with a demand above {floor:.3g}, where a line needs {LEAST_RECORDS}: more "
            "records, stronger ones, or a smaller censored_below"
        )
    if np.ptp(log_x[exact]) < 1e-6:
        return NoCurve("all records have the same intensity: a line needs a cloud of them")
    log_demand = np.log(runs.demand[exact])
    if np.abs(np.polyval(np.polyfit(log_x[exact], log_demand, 1), log_x[exact]) - log_demand).max() < 1e-7:
        return NoCurve("all demands are on one line over the intensity, so that the dispersion is unknown")
    censored = stands & ~exact
    bounds = np.log(np.where(runs.within, limit, floor))[censored]
    line = _line(log_x[exact], log_demand, log_x[censored], bounds, np.concatenate((station[exact], station[censored])))
    if not line.slope > 0:
        return NoCurve("the demand does not grow with the intensity")
    curve = Cloud(limit, line, share, confidence, float(log_x.mean()), len(np.unique(station)))
    beyond = runs.overturned | (exact & (runs.demand > limit))
    if beyond.any() and not beyond.all():
        return curve
    return outside(curve, float(runs.x.min()), float(runs.x.max())) or curve


def fit_event(
    x: Values, happened: npt.NDArray[np.bool_], confidence: float = 0.95, station: Numbers | None = None
) -> Cloud | NoCurve:
    """Return the curve of an event such as overturning, logistic alone, or ``NoCurve`` with the reason.

    There is none if all records have the event or none has, with fewer than STATIONS_OF_CURVE, 3, stations, for one intensity,
    if the share does not grow with it, and if the median lies outside the intensities: no line of demands leads there.
    """
    log_x, station = np.log(x), _alone(x) if station is None else station
    if refusal := too_few(len(np.unique(station))):
        return refusal
    share = None if happened.all() else _share(log_x, happened, station)
    if share is None:
        return _on_one_side(x, happened, station, confidence)
    if isinstance(share, NoCurve):
        return share
    curve = Cloud(1.0, None, share, confidence, float(log_x.mean()), len(np.unique(station)))
    return outside(curve, float(x.min()), float(x.max())) or curve


def _on_one_side(x: Values, happened: npt.NDArray[np.bool_], station: Numbers, confidence: float) -> NoCurve:
    """Return the bound of the median if all records exceed the limit, or none does; no curve can be fitted then."""
    refusal = separated(*by_station(np.where(happened, 0.0, x), np.where(happened, x, np.inf), station), confidence)
    assert refusal is not None
    return refusal


def _share(log_x: Values, happened: npt.NDArray[np.bool_], station: Numbers) -> Logistic | NoCurve | None:
    """Return the logistic share that overturns, of records of which some did not; None if no record did, ``NoCurve`` if their
    intensities are the same, or the share does not grow.
    """
    if not happened.any():
        return None
    if np.ptp(log_x) < 1e-6:
        return NoCurve("all records have the same intensity: a share over it needs a cloud of them")
    share = _logistic(log_x, happened, station)
    return share if share.slope > 0 else NoCurve("the share of records that overturn does not grow with the intensity")


def _line(log_x: Values, log_d: Values, censored_x: Values, bounds: Values, station: Numbers) -> Regression:
    """Return the censored regression by maximum likelihood, by Newton's method; ``station`` has the censored ones last.

    σ² and its draws are then by the mean squares of stations, with n − 2 in the denominator of independent demands.
    In δ = β/σ and γ = 1/σ the likelihood is concave (Olsen 1978, Econometrica 46(5):1211–1215).
    """
    centre = log_x.mean()
    x = np.column_stack((np.ones(len(log_x)), log_x - centre))
    xc = np.column_stack((np.ones(len(censored_x)), censored_x - centre))
    beta = np.linalg.lstsq(x, log_d, rcond=None)[0]
    sigma = max(float(np.sqrt(np.mean((log_d - x @ beta) ** 2))), 1e-9)
    point = np.append(beta, 1.0) / sigma

    def value(point: Values) -> float:
        if point[2] <= 0:
            return -math.inf
        z = point[2] * log_d - x @ point[:2]
        return float(len(z) * math.log(point[2]) - 0.5 * z @ z + log_ndtr(point[2] * bounds - xc @ point[:2]).sum())

    for _ in range(100):
        score, hessian = _derivatives(point, x, log_d, xc, bounds)
        step, current = np.linalg.solve(-hessian, score), value(point)
        while value(point + step) < current and np.abs(step).max() > 1e-14 * np.abs(point).max():
            step = 0.5 * step
        point = point + step
        if np.abs(step).max() < 1e-12 * np.abs(point).max():
            break
    _, hessian = _derivatives(point, x, log_d, xc, bounds)
    # From δ, γ to β and ln σ: at the maximum information changes by the Jacobian alone
    turned = np.column_stack((np.vstack((np.eye(2), np.zeros(2))) * point[2], -point))
    covariance = np.linalg.inv(-turned.T @ hessian @ turned)[:2, :2]
    beta, sigma = point[:2] / point[2], 1.0 / point[2]
    rng = np.random.default_rng(SEED)
    z, w = point[2] * log_d - x @ point[:2], point[2] * bounds - xc @ point[:2]
    squares = _mean_squares(np.concatenate((z, -_mills(w))), len(log_x), station)
    of_draws = squares.drawn(rng)
    spread = rng.standard_normal((DRAWS, 2)) @ np.linalg.cholesky(covariance).T
    betas = beta + spread * np.sqrt(of_draws[:, :1])
    sigmas = sigma * np.sqrt(of_draws @ squares.shares)
    sigma *= math.sqrt(squares.values @ squares.shares)
    draws = np.column_stack((betas[:, 0] - betas[:, 1] * centre, betas[:, 1], sigmas))
    return Regression(float(beta[0] - beta[1] * centre), float(beta[1]), float(sigma), draws)


@dataclass(frozen=True)
class _MeanSquares:
    """Mean squares of residuals between stations and within them, each with its degrees of freedom, and their shares of σ²."""

    values: Values
    free: Values
    shares: Values

    def drawn(self, rng: np.random.Generator) -> Values:
        """Return draws of the two variances, shape (DRAWS, 2): mean squares over χ² variables of their degrees of freedom."""
        return self.values * self.free / rng.chisquare(self.free, (DRAWS, 2))


def _mean_squares(residuals: Values, exact: int, station: Numbers) -> _MeanSquares:
    """Return the mean squares of residuals over σ between and within stations; the first ``exact`` are of known demands.

    The two parameters of the line are taken off the degrees of freedom between stations. If each record is of a station by
    itself, the first is exact/(exact − 2), as σ is that of the maximum likelihood, and the second 0.
    """
    sums = sums_by(station, np.column_stack((residuals, np.ones(len(station)))))
    of_station, numbers = sums.T
    n, k = len(station), len(numbers)
    if k == n:
        alone = max(exact - 2, 1)
        return _MeanSquares(np.array([exact / alone, 0.0]), np.array([alone, 1.0]), np.array([1.0, 0.0]))
    between = float((of_station**2 / numbers).sum())
    within = max(float(residuals @ residuals) - between, 0.0)
    together = float(numbers @ numbers) / n
    free = np.array([k - 2.0, n - k])
    return _MeanSquares(np.array([between, within]) / free, free, np.array([1.0, together - 1.0]) / together)


def _mills(w: Values) -> Values:
    """Return φ(w)/Φ(w)."""
    return np.exp(-0.5 * w**2 - 0.5 * math.log(2.0 * math.pi) - log_ndtr(w))


def _derivatives(point: Values, x: Values, log_d: Values, xc: Values, bounds: Values) -> tuple[Values, Values]:
    """Return score, shape (3,), and Hessian, shape (3, 3), over δ and γ."""
    rows = np.column_stack((-x, log_d))
    z = rows @ point
    score = -rows.T @ z
    score[2] += len(z) / point[2]
    hessian = -rows.T @ rows
    hessian[2, 2] -= len(z) / point[2] ** 2
    if len(bounds):
        rows = np.column_stack((-xc, bounds))
        w = rows @ point
        ratio = _mills(w)
        score += rows.T @ ratio
        hessian -= rows.T @ (rows * (ratio * (w + ratio))[:, None])
    return score, hessian


def _logistic(log_x: Values, happened: npt.NDArray[np.bool_], station: Numbers) -> Logistic:
    """Return Firth's logistic regression, by Newton's method on its penalised score, with draws widened for shared stations."""
    centre, width = log_x.mean(), log_x.std()
    x = np.column_stack((np.ones(len(log_x)), (log_x - centre) / width))
    coefficients = np.zeros(2)
    for _ in range(200):
        p = expit(x @ coefficients)
        weight = p * (1.0 - p)
        covariance = np.linalg.inv(x.T @ (x * weight[:, None]))
        leverage = weight * np.einsum("ij,jk,ik->i", x, covariance, x)
        step = covariance @ (x.T @ (happened - p + leverage * (0.5 - p)))
        coefficients = coefficients + step * min(1.0, 2.0 / max(np.abs(step).max(), 1e-300))
        if np.abs(step).max() < 1e-11:
            break
    posterior = _posterior(coefficients, covariance, x, happened)
    posterior = coefficients + math.sqrt(_design_effect(happened - p, station)) * (posterior - coefficients)
    draws = np.vstack((coefficients, posterior))
    slopes = draws[:, 1] / width
    plain = np.column_stack((draws[:, 0] - slopes * centre, slopes))
    return Logistic(float(plain[0, 0]), float(plain[0, 1]), plain[1:])


def _design_effect(residuals: Values, station: Numbers) -> float:
    """Return the factor on the variance of draws by stations, 1 if each record is of a station by itself.

    It is the variance of the sums of residuals over that of independent records, 1 at least, times the square of Student's
    quantile of the number of stations over the normal one.
    """
    of_station = sums_by(station, residuals[:, None])
    k = len(of_station)
    if k == len(station):
        return 1.0
    together = k / (k - 2) * float((of_station**2).sum()) / float(residuals @ residuals)
    return max(1.0, together) * float(student.ppf(0.975, k - 1) / ndtri(0.975)) ** 2


def _posterior(mode: Values, covariance: Values, x: Values, happened: npt.NDArray[np.bool_]) -> Values:
    """Return draws, shape (DRAWS, 2), from the penalised likelihood, which is the posterior with Jeffreys' prior.

    They are chosen by their weights from many of Student's distribution with three degrees of freedom about the maximum: a normal
    one would be too narrow where few records overturn.
    """
    rng = np.random.default_rng(SEED + 1)
    normal = rng.standard_normal((PROPOSALS, 2))
    far = rng.chisquare(3, PROPOSALS) / 3
    proposed = mode + normal @ np.linalg.cholesky(covariance).T * (WIDER / np.sqrt(far))[:, None]
    products = np.column_stack((x[:, 0] ** 2, x[:, 0] * x[:, 1], x[:, 1] ** 2))
    likelihood = np.empty(PROPOSALS)
    block = max(1, BLOCK // len(x))
    for some in (slice(k, k + block) for k in range(0, PROPOSALS, block)):
        z = proposed[some] @ x.T
        p = expit(z)
        first, mixed, last = ((p * (1.0 - p)) @ products).T  # of the information, whose determinant is Jeffreys' prior
        with np.errstate(divide="ignore"):
            prior = 0.5 * np.log(np.maximum(first * last - mixed**2, 0.0))
        likelihood[some] = z @ happened + log_expit(-z).sum(axis=1) + prior
    of_proposal = -2.5 * np.log1p((normal**2).sum(axis=1) / far / 3)
    logs = likelihood - of_proposal
    weights = np.exp(logs - logs.max())
    return proposed[rng.choice(PROPOSALS, DRAWS, p=weights / weights.sum())]
