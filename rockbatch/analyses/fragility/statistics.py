"""Fragility curves of arrays, without a study: counts at levels, and clouds of demands."""

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from rockbatch.analyses.fragility import cloud as clouds
from rockbatch.analyses.fragility import lognormal
from rockbatch.analyses.fragility.cloud import Cloud
from rockbatch.analyses.fragility.lognormal import Capacities, Lognormal
from rockbatch.common.errors import InputError

Curve = TypeVar("Curve", Lognormal, Cloud)

CENSORED_BELOW = 0.01
"""Demands below this share of the limit are known only to be below it: a pier that hardly lifts off has none."""


def fragility(
    levels: npt.ArrayLike, exceeded: npt.ArrayLike, n: npt.ArrayLike, *, confidence: float = 0.95
) -> Lognormal:
    """Fit a lognormal fragility curve to counts at levels: multiple stripe analysis (Baker 2015).

    Parameters
    ----------
    levels : array_like, shape (k,)
        Intensities of the stripes, above 0, in any unit.
    exceeded, n : array_like, shape (k,)
        How many of ``n`` records exceeded the limit at each level; one ``n`` may serve all levels.
    confidence : float
        Of the intervals.

    Returns
    -------
    Lognormal
        Median, dispersion, their intervals, ``probability(x)`` and ``band(x)``.

    Raises
    ------
    InputError
        If counts are impossible, or if they determine no curve, with the reason.

    Examples
    --------
    >>> from rockbatch.analyses.fragility.statistics import fragility
    >>> curve = fragility([0.2, 0.4, 0.6, 0.8], exceeded=[0, 3, 11, 18], n=20)
    >>> round(curve.median, 3), round(curve.dispersion, 3)
    (0.56, 0.303)
    """
    x, beyond = np.asarray(levels, dtype=np.float64), np.asarray(exceeded, dtype=np.float64)
    counted = np.broadcast_to(np.asarray(n, dtype=np.float64), x.shape)
    if x.ndim != 1 or beyond.shape != x.shape:
        raise InputError("levels and exceeded: must be as long as each other")
    _refuse(x > 0, "levels", "above 0")
    _refuse((beyond >= 0) & (beyond <= counted), "exceeded", "from 0 to n")
    within = counted - beyond
    low, high = np.concatenate((np.zeros(len(x)), x)), np.concatenate((x, np.full(len(x), np.inf)))
    count = np.concatenate((beyond, within))
    used = count > 0
    return _curve(lognormal.fit(Capacities(low[used], high[used], count[used]), confidence))


def cloud(
    im: npt.ArrayLike,
    demand: npt.ArrayLike,
    limit: float,
    *,
    overturned: Sequence[bool] | npt.NDArray[np.bool_] | None = None,
    censored_below: float = CENSORED_BELOW,
    confidence: float = 0.95,
) -> Cloud:
    """Fit a fragility curve to a cloud of demands: a line in logarithms, and a share that overturns (Jalayer et al. 2017).

    Parameters
    ----------
    im, demand : array_like, shape (n,)
        Intensity of each record, above 0, and the demand under it, in the unit of ``limit``; demands of those that overturned
        do not matter.
    limit : float
        Above 0.
    overturned : array_like of bool, shape (n,), optional
        Which runs overturned, and so exceed any limit.
    censored_below : float
        Share of the limit below which a demand is known only to be below it.
    confidence : float
        Of the intervals.

    Returns
    -------
    Cloud
        Median, dispersion, their intervals, ``probability(x)`` and ``band(x)``.

    Raises
    ------
    InputError
        If the arrays are impossible, or if they determine no curve, with the reason.

    Examples
    --------
    >>> from rockbatch.analyses.fragility.statistics import cloud
    >>> im = [0.2, 0.3, 0.4, 0.5, 0.6, 0.8]
    >>> curve = cloud(im, [0.010, 0.016, 0.019, 0.027, 0.029, 0.042], limit=0.03)
    >>> round(curve.median, 3)
    0.588
    """
    x, d = np.asarray(im, dtype=np.float64), np.asarray(demand, dtype=np.float64)
    fell = np.zeros(x.shape, dtype=np.bool_) if overturned is None else np.asarray(overturned, dtype=np.bool_)
    if x.ndim != 1 or d.shape != x.shape or fell.shape != x.shape:
        raise InputError("im, demand and overturned: must be as long as each other")
    _refuse(x > 0, "im", "above 0")
    _refuse(fell | (d >= 0), "demand", "0 or above")
    if not limit > 0:
        raise InputError(f"limit = {limit:g}: must be above 0")
    runs = clouds.Demands(x, np.where(fell, 0.0, d), fell, np.zeros(x.shape, dtype=np.bool_))
    return _curve(clouds.fit(runs, limit, censored_below * limit, confidence))


def _refuse(right: npt.NDArray[np.bool_], name: str, bounds: str) -> None:
    """Raise ``InputError`` for the first value that is not right; NaN never is."""
    if not right.all():
        raise InputError(f"{name}[{int(np.argmin(right))}]: must be {bounds}")


def _curve(fitted: Curve | str) -> Curve:
    if isinstance(fitted, str):
        raise InputError(f"no curve: {fitted}")
    return fitted
