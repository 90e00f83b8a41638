"""Fit of one parameter to a release test: times of impacts, amplitudes between them, or both (THEORY.md, Release tests)."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from rockbatch.motions.motion import Samples

EXACT = 1e-7
"""Of the greatest value: least scatter that measurements are taken to have, so that no weight is infinite."""

NEAR = 1e-4
"""Of its range: change of the parameter by which slopes are taken."""

ROUNDS = 6
"""Steps of the fit with estimated scatters; a few are enough."""


LEAST_TIMES = 4
"""Times with which it is looked whether all of them are too long or too short."""


class Passages(NamedTuple):
    """Impacts of a release: ``t`` [s] of each, and the ``amplitude`` [rad] after it; NaN where not measured. Shape (n,) each."""

    t: Samples
    amplitude: Samples


class Fit(NamedTuple):
    """A fitted parameter.

    ``low`` and ``high`` are its interval; ``scatter`` its standard deviation from impact to impact, as far as the measured values
    show one; ``t_rms`` [s] and ``amplitude_rms`` [rad] the root mean square of measured less computed values, NaN without any;
    ``at_end`` whether the fit lies at an end of the possible values. ``stretch`` is the factor on all computed times that would
    describe the measured ones best, beside the parameter, and ``stretch_error`` half of its interval; NaN with few times.
    """

    value: float
    low: float
    high: float
    scatter: float
    t_rms: float
    amplitude_rms: float
    at_end: bool
    stretch: float
    stretch_error: float


Model = Callable[[float], Passages]


class _Linear(NamedTuple):
    """Measured less computed values, shape (m,), their slopes with what is fitted, (m, 1 or 2), and with the parameter's value
    at each impact, (m, n).

    ``kinds`` is 0 for times and 1 for amplitudes, ``scales`` the greatest measured of each kind; ``shared`` says that all times
    have the error of the first impact, from which they count.
    """

    misses: Samples
    slopes: Samples
    by_impact: Samples
    kinds: Samples
    scales: Samples
    shared: bool


def fitted(measured: Passages, model: Model, grid: Samples, confidence: float, shared: bool = False) -> Fit:
    """Return the parameter of ``model`` that makes ``measured`` values likeliest, and its interval.

    Times and amplitudes have errors of measurement, independent and normal, each kind with a scatter that is not known; and the
    parameter itself scatters from impact to impact, which all later values keep (THEORY.md, Release tests). The scatters are
    those of the greatest restricted likelihood. ``grid`` are values between which the fit begins, at that of least squares. Times
    that count from the first impact have its error, ``shared``.
    """
    bounds = float(grid[0]), float(grid[-1])
    value = _least_squares(measured, model, grid)
    for _ in range(ROUNDS):
        at = _linear(measured, model, value, bounds)._replace(shared=shared)
        spread = _scatters(at)
        changes, variances = _generalised(at, spread)
        before, value = value, min(max(value + float(changes[0]), bounds[0]), bounds[1])
        if abs(value - before) <= 1e-9 * (bounds[1] - bounds[0]):
            break
    half = _quantile(confidence, len(at.misses) - 1) * math.sqrt(variances[0])
    t_rms, amplitude_rms = (
        math.sqrt(float(np.nanmean((own - other) ** 2))) if not np.isnan(own).all() else math.nan
        for own, other in zip(measured, model(value), strict=True)
    )
    near = 1e-6 * (bounds[1] - bounds[0])
    at_end = min(value - bounds[0], bounds[1] - value) <= near
    low, high = max(value - half, bounds[0]), min(value + half, bounds[1])
    stretch = _stretch(at, np.concatenate([model(value).t, 0.0 * measured.t]), measured, confidence)
    return Fit(value, low, high, float(spread[2]), t_rms, amplitude_rms, at_end, *stretch)


def _stretch(at: _Linear, t: Samples, measured: Passages, confidence: float) -> tuple[float, float]:
    """Return the factor on all computed times, ``t``, 0 for amplitudes, that measured ones ask for, and half its interval."""
    given = ~np.isnan(np.concatenate(measured))
    if np.count_nonzero(at.kinds == 0) < LEAST_TIMES:
        return math.nan, math.nan
    both = at._replace(slopes=np.column_stack([at.slopes, np.nan_to_num(t[given])]))
    changes, variances = _generalised(both, _scatters(both))
    return 1.0 + float(changes[1]), _quantile(confidence, len(at.misses) - 2) * math.sqrt(variances[1])


def _quantile(confidence: float, freedom: int) -> float:
    from scipy.stats import t

    return float(t.ppf(0.5 + 0.5 * confidence, max(freedom, 1)))


def _least_squares(measured: Passages, model: Model, grid: Samples) -> float:
    """Return the parameter at which n_t ln S_t + n_a ln S_a is least, S being sums of squared differences of either kind."""
    from scipy.optimize import minimize_scalar

    def misfit(value: float) -> float:
        total = 0.0
        for own, other in zip(measured, model(value), strict=True):
            given = ~np.isnan(own)
            if given.any():
                misses, least = own[given] - other[given], EXACT * float(np.abs(own[given]).max())
                total += 0.5 * misses.size * math.log(float(misses @ misses) + misses.size * least**2)
        return total

    best = int(np.argmin([misfit(float(value)) for value in grid]))
    low, high = float(grid[max(best - 1, 0)]), float(grid[min(best + 1, len(grid) - 1)])
    result = minimize_scalar(misfit, bounds=(low, high), method="bounded", options={"xatol": 1e-7 * (high - low)})
    return float(result.x) if result.fun < misfit(float(grid[best])) else float(grid[best])


def _linear(measured: Passages, model: Model, value: float, bounds: tuple[float, float]) -> _Linear:
    """Return how the differences change with the parameter.

    Each impact before it has the same part in the energy of a half cycle, hence in its amplitude and its duration.
    """
    step = NEAR * (bounds[1] - bounds[0])
    below, above = max(value - step, bounds[0]), min(value + step, bounds[1])
    first, now, last = model(below), model(value), model(above)
    n = len(measured.t)
    earlier = np.tril(np.ones((n, n)))  # amplitude k has impacts 1 to k before it
    number = np.arange(1.0, n + 1.0)
    t_slopes, slopes = ((b - a) / (above - below) for a, b in zip(first, last, strict=True))
    of_amplitudes = earlier * (slopes / number)[:, None]
    durations = earlier * (np.diff(t_slopes, append=t_slopes[-1:]) / number)[:, None]  # of the half cycle after each
    of_times = np.vstack([np.zeros(n), np.cumsum(durations, axis=0)[:-1]])
    given = np.concatenate([~np.isnan(measured.t), ~np.isnan(measured.amplitude)])
    kinds = np.repeat([0, 1], n)[given]
    misses = np.concatenate([own - other for own, other in zip(measured, now, strict=True)])[given]
    scales = np.array([np.nan_to_num(own).max(initial=0.0) for own in measured])
    both = np.concatenate([t_slopes, slopes])[given][:, None]
    return _Linear(misses, both, np.vstack([of_times, of_amplitudes])[given], kinds, scales, False)


def _scatters(at: _Linear) -> Samples:
    """Return the scatters of times [s], amplitudes [rad] and of the parameter itself, of the greatest restricted likelihood."""
    from scipy.optimize import minimize

    rms = np.array([np.sqrt(np.mean(at.misses[at.kinds == k] ** 2)) if (at.kinds == k).any() else 1.0 for k in (0, 1)])
    least = np.maximum(EXACT * at.scales, 1e-300)
    rms = np.maximum(rms, least)
    own = np.sqrt(np.mean(at.by_impact**2, axis=1))
    typical = float(np.median(np.abs(at.misses) / np.maximum(own, 1e-12 * own.max(initial=1e-300)))) or 1e-6

    def unlikely(logs: Samples) -> float:
        spread = np.exp(np.clip(logs, -40.0, 10.0)) * np.array([*rms, typical])
        covariance = _covariance(at, np.maximum(spread, [*least, 0.0]))
        factor = np.linalg.cholesky(covariance)
        misses, slopes = np.linalg.solve(factor, at.misses), np.linalg.solve(factor, at.slopes)
        information = slopes.T @ slopes
        part = slopes.T @ misses
        rest = float(misses @ misses) - float(part @ np.linalg.solve(information, part))
        return 2.0 * float(np.log(np.diag(factor)).sum()) + rest + float(np.linalg.slogdet(information)[1])

    starts = ([0.0, 0.0, -6.0], [-3.0, -3.0, 0.0], [-1.0, -1.0, -1.0])
    options = {"xatol": 1e-3, "fatol": 1e-6, "maxiter": 400}
    results = [minimize(unlikely, start, method="Nelder-Mead", options=options) for start in starts]
    logs = min(results, key=lambda result: result.fun).x
    return np.maximum(np.exp(np.clip(logs, -40.0, 10.0)) * np.array([*rms, typical]), [*least, 0.0])


def _covariance(at: _Linear, spread: Samples) -> Samples:
    """Return the covariance of the differences: errors of measurement, and what impacts leave to all later values."""
    covariance = np.diag(spread[at.kinds] ** 2) + spread[2] ** 2 * at.by_impact @ at.by_impact.T
    if at.shared:
        times = at.kinds == 0
        covariance += spread[0] ** 2 * np.outer(times, times)
    return covariance


def _generalised(at: _Linear, spread: Samples) -> tuple[Samples, Samples]:
    """Return the changes of what is fitted by generalised least squares, and their variances."""
    factor = np.linalg.cholesky(_covariance(at, spread))
    misses, slopes = np.linalg.solve(factor, at.misses), np.linalg.solve(factor, at.slopes)
    covariance = np.linalg.inv(slopes.T @ slopes)
    return covariance @ (slopes.T @ misses), np.diag(covariance)
