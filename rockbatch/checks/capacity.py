"""Capacities that depend on the axial force, and the share of them that runs use.

The ratio of an effect E, such as the moment, is taken at the axial force N of its own moment, E/E_Rd(N), as EN 1992 and EN 1998
compare them, and its greatest value over time counts. With a concave E_Rd it is greatest at a corner of the envelope of |E| over
N, so that these corners suffice.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from rockbatch.common.lazy import pd
from rockbatch.quantities.demands import OF_INTERACTION
from rockbatch.quantities.statistics import Values

Curve = Sequence[tuple[float, float]]
"""Points (N, E_Rd) by ascending N, compression positive: [kN, kN m] for a moment, [kN, kN] for a shear."""

Capacity = float | tuple[tuple[float, float], ...]
"""A number in the unit of the effect, or a curve."""

FARTHEST = 1e9
"""Axial force [kN] to which a straight line of capacity goes."""

_ROUNDING = 1e-9
"""Share of the greatest capacity by which a point may be below a straight line through its neighbours."""


def line(constant: float, per_axial: float = 0.0) -> tuple[tuple[float, float], ...]:
    """Return both ends of the line ``constant`` + ``per_axial`` N: from where it is 0, or −10⁹ kN if it is level, to 10⁹ kN."""
    first = (-constant / per_axial, 0.0) if per_axial else (-FARTHEST, constant)
    return first, (FARTHEST, constant + per_axial * FARTHEST)


def whole(parts: Sequence[Capacity]) -> Capacity | tuple[object, ...]:
    """Return the capacity that was written in ``parts``: a single number as it is, else all points in order.

    A number among several parts stays a number, which is no point.
    """
    if len(parts) == 1 and isinstance(parts[0], float):
        return parts[0]
    return tuple(point for part in parts for point in (part if isinstance(part, tuple) else (part,)))


def problems(curve: Curve) -> Iterator[str]:
    """Yield a phrase for each fault of a curve: under two points, below 0, 0 at every N, N not ascending, or not concave.

    Where N does not ascend, concavity is not looked at.
    """
    if len(curve) < 2:
        yield "has fewer than two points; write [N, M] pairs from the greatest tension to the greatest compression"
    below = [f"[{n:g}, {m:g}]" for n, m in curve if m < 0.0]
    if below:
        yield (
            f"has a moment below 0 at {', '.join(below)}; write the half with M >= 0, which counts for both directions"
        )
    if all(m == 0.0 for _, m in curve):
        yield "is 0 at every N"
    for (n, m), (n2, m2) in pairwise(curve):
        if n2 <= n:
            yield (
                f"does not go by ascending N from [{n:g}, {m:g}] to [{n2:g}, {m2:g}]; write it from the greatest tension, "
                "negative, to the greatest compression, and the half with M >= 0 alone"
            )
            return
    most = max((m for _, m in curve), default=0.0)
    for (n, m), (n2, m2), (n3, m3) in zip(curve, curve[1:], curve[2:], strict=False):
        chord = m + (m3 - m) * (n2 - n) / (n3 - n)
        if m2 < chord - _ROUNDING * most:
            yield (
                f"is not convex: [{n2:g}, {m2:g}] is below the line from [{n:g}, {m:g}] to [{n3:g}, {m3:g}], {chord:.5g} kN m at "
                "this N; leave it out, or correct it"
            )


def resistance(curve: Curve, axial: Values) -> Values:
    """Return E_Rd at axial forces [kN], shape (n,); NaN beyond the ends of the curve."""
    n, e = np.array(curve, dtype=np.float64).T
    return np.asarray(np.interp(axial, n, e, left=np.nan, right=np.nan))


def _share(effect: Values, most: Values) -> Values:
    """Return E/E_Rd, shape (n,): infinite where ``most``, E_Rd, is NaN, else 0 for E ≤ 0, and infinite for E > 0 over 0."""
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(effect > 0.0, effect / most, 0.0)
    return np.where(np.isnan(most), np.inf, share)


def _most_within(curve: Curve, low: Values, high: Values) -> Values:
    """Return the greatest E_Rd between two axial forces [kN], shape (n,) each; NaN if all between is beyond the curve."""
    n, e = max(curve, key=lambda point: point[1])
    within = np.where((low <= n) & (n <= high), e, np.nan)
    return np.fmax(within, np.fmax(resistance(curve, low), resistance(curve, high)))


def used(curve: Curve, corners: "pd.DataFrame") -> "pd.DataFrame":
    """Return a row for each run with the greatest share of a capacity that it uses, infinite beyond the curve, and its error.

    ``corners`` are the rows of interaction.csv of one section, or of the base. If the error decides whether N is beyond an end of
    the curve, the share may be any from the one returned upwards, and its error is infinite; it is NaN where none was estimated.
    """
    keys = [name for name in corners if name not in OF_INTERACTION]
    rows = corners.assign(effect=corners["moment_kNm"].fillna(corners["shear_kN"]))
    axial, effect, error = (rows[name].to_numpy(np.float64) for name in ("axial_kN", "effect", "interaction_error"))
    groups = rows.groupby(keys, sort=False, dropna=False)
    margin = np.nan_to_num(error)
    of_axial, of_effect = (
        margin * groups[name].transform(lambda values: values.abs().max()).to_numpy() for name in ("axial_kN", "effect")
    )
    low, high = axial - of_axial, axial + of_axial
    shares = rows[keys].assign(
        height_m=rows["height_m"],
        over_capacity=_share(effect, resistance(curve, axial)),
        least=_share(effect - of_effect, _most_within(curve, low, high)),
        high=np.maximum(*(_share(effect + of_effect, resistance(curve, end)) for end in (low, high))),
        known=~np.isnan(error),
    )
    of_runs = shares.groupby(keys, sort=False, dropna=False).max().reset_index()
    value, least, most = (of_runs[name].to_numpy(np.float64) for name in ("over_capacity", "least", "high"))
    unbounded = np.isinf(most)
    with np.errstate(invalid="ignore"):
        # E_Rd is concave: what it loses by an error of N is more than what it gains by the opposite one
        widest = np.where(unbounded, np.inf, most - value)
    return of_runs[[*keys, "height_m"]].assign(
        over_capacity=np.where(unbounded, least, value),
        over_capacity_error=np.where(of_runs["known"].to_numpy(bool), widest, np.nan),
    )
