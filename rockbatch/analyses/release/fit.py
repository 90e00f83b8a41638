"""Fit of one parameter to a release test: times of impacts, amplitudes between them, or both (THEORY.md, Release tests)."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from rockbatch.motions.motion import Samples

EXACT = 1e-7
"""Least misfit of a value over the greatest of its kind, so that the misfit to exact ones has a logarithm."""

NEAR = 1e-4
"""Change of the parameter by which slopes are taken."""

ROUNDS = 8
"""Steps of the fit with unknown scatters; a few are enough."""

RATIOS, UNLIKELY = 24.0, 12.0
"""Greatest ln of a ratio of variances, and what ln of the posterior density may fall short of the greatest to count."""

LEAST_TIMES = 4
"""Times with which it is looked whether all of them are too long or too short."""


class Passages(NamedTuple):
    """Impacts of a release: ``t`` [s] of each, and the ``amplitude`` [rad] after it; NaN where not measured. Shape (n,) each."""

    t: Samples
    amplitude: Samples


class Fit(NamedTuple):
    """A fitted parameter.

    ``low`` and ``high`` are its interval; ``scatter`` its standard deviation from impact to impact, as far as the measured values
    tell it from errors of reading; ``t_rms`` [s] and ``amplitude_rms`` [rad] the root mean square of measured less computed
    values, NaN without any; ``at_end`` whether the fit lies at an end of the possible values. ``stretch`` is the factor on all
    computed times that would describe the measured ones best, beside the parameter, and ``stretch_error`` how far its interval
    reaches; NaN with few times.
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

    ``kinds`` is 0 for times and 1 for amplitudes; ``shared`` says that all times have the error of the first impact, from which
    they count.
    """

    misses: Samples
    slopes: Samples
    by_impact: Samples
    kinds: Samples
    shared: bool


def fitted(measured: Passages, model: Model, grid: Samples, confidence: float, shared: bool = False) -> Fit:
    """Return the fit of the parameter of ``model`` to ``measured`` values.

    Times and amplitudes have errors of measurement, independent and normal, each kind with a scatter that is not known; and the
    parameter itself scatters from impact to impact, which all later values keep (THEORY.md, Release tests). The value is the
    median of its posterior distribution, the interval holds the middle of that with a probability of ``confidence``; both stay
    between the ends of ``grid``, values at the best of which the fit begins. If times count from the first impact they have its
    error, too: ``shared``.
    """
    bounds = float(grid[0]), float(grid[-1])
    value = _least_squares(measured, model, grid)
    for _ in range(ROUNDS):
        linear = _linear(measured, model, value, bounds)._replace(shared=shared)
        posterior, centre = _posterior(linear), value
        value = min(max(centre + posterior.quantile(0.5), bounds[0]), bounds[1])
        if abs(value - centre) <= 1e-9:
            break
    low, high = (centre + posterior.quantile(0.5 + side * confidence) for side in (-0.5, 0.5))
    t_rms, amplitude_rms = map(_rms, measured, model(value))
    low, high = (min(max(end, bounds[0]), bounds[1]) for end in (low, high))
    scatter = float(posterior.weights @ posterior.spread)
    stretch = _stretch(linear, np.concatenate([model(value).t, 0.0 * measured.t]), measured, confidence)
    return Fit(value, low, high, scatter, t_rms, amplitude_rms, value in bounds, *stretch)


def _rms(data: Samples, modelled: Samples) -> float:
    """Return the root mean square of differences where ``data`` are not NaN; NaN without any."""
    return math.nan if np.isnan(data).all() else math.sqrt(float(np.nanmean((data - modelled) ** 2)))


def _stretch(linear: _Linear, t: Samples, measured: Passages, confidence: float) -> tuple[float, float]:
    """Return the factor on computed times that fits measured ones best, and its error; NaN with fewer than LEAST_TIMES, 4.

    ``t`` has the computed times, then 0 for each amplitude.
    """
    known = ~np.isnan(np.concatenate(measured))
    if np.count_nonzero(linear.kinds == 0) < LEAST_TIMES:
        return math.nan, math.nan
    posterior = _posterior(linear._replace(slopes=np.column_stack([linear.slopes, np.nan_to_num(t[known])])))
    low, middle, high = (posterior.quantile(0.5 + side * confidence, 1) for side in (-0.5, 0.0, 0.5))
    return 1.0 + middle, max(high - middle, middle - low)


def _least_squares(measured: Passages, model: Model, grid: Samples) -> float:
    """Return the value of ``grid`` at which n_t ln S_t + n_a ln S_a is least, S being sums of squares of either kind."""

    def misfit(value: float) -> float:
        total = 0.0
        for data, modelled in zip(measured, model(value), strict=True):
            known = ~np.isnan(data)
            if known.any():
                misses, least = data[known] - modelled[known], EXACT * float(np.abs(data[known]).max())
                total += 0.5 * misses.size * math.log(float(misses @ misses) + misses.size * least**2)
        return total

    return float(min(grid, key=misfit))


def _linear(measured: Passages, model: Model, value: float, bounds: tuple[float, float]) -> _Linear:
    """Return differences and slopes of the model linearised at a value of the parameter.

    Each impact before it has the same part in the energy of a half cycle, hence in its amplitude and its duration.
    """
    below, above = max(value - NEAR, bounds[0]), min(value + NEAR, bounds[1])
    first, centre, last = model(below), model(value), model(above)
    n = len(measured.t)
    earlier = np.tril(np.ones((n, n)))  # amplitude k has impacts 1 to k before it
    number = np.arange(1.0, n + 1.0)
    t_slopes, slopes = ((b - a) / (above - below) for a, b in zip(first, last, strict=True))
    of_amplitudes = earlier * (slopes / number)[:, None]
    durations = earlier * (np.diff(t_slopes, append=t_slopes[-1:]) / number)[:, None]  # of the half cycle after each
    of_times = np.vstack([np.zeros(n), np.cumsum(durations, axis=0)[:-1]])
    known = np.concatenate([~np.isnan(measured.t), ~np.isnan(measured.amplitude)])
    kinds = np.repeat([0, 1], n)[known]
    misses = np.concatenate([data - modelled for data, modelled in zip(measured, centre, strict=True)])[known]
    all_slopes = np.concatenate([t_slopes, slopes])[known][:, None]
    return _Linear(misses, all_slopes, np.vstack([of_times, of_amplitudes])[known], kinds, False)


class _Posterior(NamedTuple):
    """Posterior distribution of the changes of k parameters: a mixture of Student's t with ``freedom`` degrees of freedom.

    ``weights`` (q,), ``centres`` and ``scales`` (q, k) are of its parts, ``spread`` (q,) the scatter from impact to impact.
    """

    weights: Samples
    centres: Samples
    scales: Samples
    freedom: int
    spread: Samples

    def quantile(self, share: float, parameter: int = 0) -> float:
        """Return the value below which ``parameter`` lies with a probability of ``share``."""
        from scipy.optimize import brentq
        from scipy.special import stdtr

        centres, scales = self.centres[:, parameter], self.scales[:, parameter]

        def excess(value: float) -> float:
            return float(self.weights @ stdtr(self.freedom, (value - centres) / scales)) - share

        low, high = float((centres - scales).min()), float((centres + scales).max())
        while excess(low) > 0.0 or excess(high) < 0.0:
            low, high = 2.0 * low - high, 2.0 * high - low
        return float(brentq(excess, low, high, xtol=1e-6 * float(scales.min())))


def _posterior(linear: _Linear) -> _Posterior:
    """Return the posterior distribution when nothing is known of the scatters but what the values show.

    Given the ratios of the scatters it is Student's t; the ratios have Jeffreys' prior, and are summed over a grid.
    """
    kinds = np.unique(linear.kinds)
    ends = np.tile([-RATIOS, RATIOS], (len(kinds), 1))
    coarse = _grid(ends, 2.0)
    logs = _evaluated(linear, kinds, coarse)[0]
    likely = coarse[logs > logs.max() - UNLIKELY]
    ends = np.column_stack([likely.min(axis=0) - 2.0, likely.max(axis=0) + 2.0])
    logs, centres, scales, freedom, spread = _evaluated(linear, kinds, _grid(ends, 1.0))
    weights = np.exp(logs - logs.max())
    return _Posterior(weights / weights.sum(), centres, scales, freedom, spread)


def _grid(ends: Samples, step: float) -> Samples:
    """Return the points of a grid, shape (q, k), ``step`` apart on each axis from its lower end on, ``ends`` being (k, 2)."""
    axes = [np.arange(low, high + 0.5 * step, step) for low, high in ends]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))


def _evaluated(linear: _Linear, kinds: Samples, ratios: Samples) -> tuple[Samples, Samples, Samples, int, Samples]:
    """Return ln of the posterior density, and the parts of :class:`_Posterior`, for ``ratios`` of scatters, shape (q, kinds).

    They are ln of the variance that reading leaves over the mean of what impacts leave in values of that kind.
    """
    by_impacts = linear.by_impact @ linear.by_impact.T
    sources = [by_impacts]
    for kind in kinds:
        members = (linear.kinds == kind).astype(float)
        read = np.diag(members) + (np.outer(members, members) if linear.shared and kind == 0 else 0.0)
        sources.append(read * (members @ np.diag(by_impacts) / members.sum() or 1.0))
    logs = np.column_stack([np.zeros(len(ratios)), ratios])
    shares = np.exp(logs - logs.max(axis=1, keepdims=True)).T[:, :, None, None]
    parts = shares * np.stack(sources)[:, None]
    inverse = np.linalg.inv(parts.sum(axis=0))
    weighted = inverse @ linear.slopes
    covariance = np.linalg.inv(linear.slopes.T @ weighted)
    centres = np.einsum("qij,qmj,m->qi", covariance, weighted, linear.misses)
    unexplained = inverse - weighted @ covariance @ weighted.swapaxes(1, 2)
    squares = np.maximum(np.einsum("i,qij,j->q", linear.misses, unexplained, linear.misses), np.finfo(float).tiny)
    freedom = max(len(linear.misses) - linear.slopes.shape[1], 1)
    influences = unexplained @ parts
    information = np.einsum("aqij,bqji->qab", influences, influences)
    density = sum(0.5 * np.linalg.slogdet(matrix)[1] for matrix in (inverse, covariance, information))
    scale = np.sqrt(squares / freedom)
    scales = scale[:, None] * np.sqrt(np.einsum("qii->qi", covariance))
    return density - 0.5 * freedom * np.log(squares), centres, scales, freedom, scale * np.sqrt(shares[0, :, 0, 0])
