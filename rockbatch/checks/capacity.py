"""The capacity of a section: its moment of resistance at each axial force, and the share of it that runs use.

The ratio is taken at the axial force N of the moment, M/M_Rd(N), as EN 1992 and EN 1998 compare them, and its greatest value over
time counts. With a concave M_Rd it is greatest at a corner of the envelope of |M| over N, so that these corners suffice.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from rockbatch.common.lazy import pd
from rockbatch.quantities.demands import OF_INTERACTION
from rockbatch.quantities.statistics import Values

Curve = Sequence[tuple[float, float]]
"""Points (N, M_Rd) [kN, kN m], compression positive, by ascending N."""

_ROUNDING = 1e-9
"""Share of the greatest capacity by which a point may be below a straight line through its neighbours."""


def problems(curve: Curve) -> Iterator[str]:
    """Yield a phrase for each fault of a curve: under two points, M below 0, N not ascending, or not concave."""
    if len(curve) < 2:
        yield "has fewer than two points; write [N, M] pairs from the greatest tension to the greatest compression"
    below = [f"[{n:g}, {m:g}]" for n, m in curve if m < 0.0]
    if below:
        yield (
            f"has a moment below 0 at {', '.join(below)}; write the half with M >= 0, which counts for both directions"
        )
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
    """Return M_Rd [kN m] at axial forces [kN], shape (n,); NaN beyond the ends of the curve."""
    n, m = np.array(curve, dtype=np.float64).T
    return np.asarray(np.interp(axial, n, m, left=np.nan, right=np.nan))


def _share(curve: Curve, axial: Values, moment: Values) -> Values:
    """Return M/M_Rd(N), shape (n,): 0 for M = 0; infinite for N beyond the ends of the curve, and for M > 0 where M_Rd = 0."""
    most = resistance(curve, axial)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(moment > 0.0, moment / most, 0.0)
    return np.where(np.isnan(most), np.inf, share)


def used(curve: Curve, corners: "pd.DataFrame") -> "pd.DataFrame":
    """Return a row for each run with the greatest share of a capacity that it uses, infinite beyond the curve, and its error.

    ``corners`` are the rows of interaction.csv of one section. The share is NaN if the error decides whether N is beyond an
    end of the curve, and so may be any; the error is NaN where none was estimated.
    """
    keys = [name for name in corners if name not in OF_INTERACTION]
    axial, moment, error = (corners[name].to_numpy(np.float64) for name in list(OF_INTERACTION)[1:])
    groups = corners.groupby(keys, sort=False, dropna=False)
    margin = np.nan_to_num(error)
    sizes = [
        margin * groups[name].transform(lambda values: values.abs().max()).to_numpy()
        for name in ("axial_kN", "moment_kNm")
    ]
    of_axial, of_moment = sizes
    ends = [_share(curve, axial + sign * of_axial, moment + of_moment) for sign in (-1.0, 1.0)]
    shares = corners[keys].assign(
        height_m=corners["height_m"],
        over_capacity=_share(curve, axial, moment),
        high=np.maximum(*ends),
        beyond=(axial + of_axial <= curve[0][0]) | (axial - of_axial >= curve[-1][0]),
        known=~np.isnan(error),
    )
    of_runs = shares.groupby(keys, sort=False, dropna=False).max().reset_index()
    value, high = of_runs["over_capacity"].to_numpy(np.float64), of_runs["high"].to_numpy(np.float64)
    beyond, known = of_runs["beyond"].to_numpy(bool), of_runs["known"].to_numpy(bool)
    unknown = np.isinf(high) & ~beyond
    with np.errstate(invalid="ignore"):
        # M_Rd is concave: what it loses by an error of N is more than what it gains by the opposite one
        widest = np.where(beyond, 0.0, high - value)
    return of_runs[[*keys, "height_m"]].assign(
        over_capacity=np.where(unknown, np.nan, value),
        over_capacity_error=np.where(unknown | ~known, np.nan, widest),
    )
