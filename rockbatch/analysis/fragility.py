"""Fragility of every case: stripes, or the capacities of an incremental dynamic analysis, and the curves through them."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.analysis.ida import Bracket, bisect, bracket
from rockbatch.analysis.limit_states import EXCEEDED, LEFT_OUT, UNDECIDED, WITHSTOOD, applies, states
from rockbatch.analysis.lognormal import Capacities, Lognormal, fit
from rockbatch.checks.rules import Rule
from rockbatch.errors import InputError
from rockbatch.motions import Motion
from rockbatch.motions.measures import pgv
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.plan import Run, Runs, scaled
from rockbatch.results import describe_case
from rockbatch.study import Case, Output, Study
from rockbatch.study.fragility import FragilitySpec

if TYPE_CHECKING:
    import pandas as pd


class Point(NamedTuple):
    """A run: numbers of the motion and the case, the polarity, and the intensity that the motion is scaled to."""

    motion: int
    polarity: str
    intensity: float
    case: int


class ScaledRuns(Runs):
    """The runs of some points; ``unscaled`` are the intensities of the motions."""

    def __init__(
        self, points: Sequence[Point], motions: Sequence[Motion], unscaled: Sequence[float], cases: Sequence[Case]
    ) -> None:
        self.points, self.motions, self.unscaled, self.cases = points, motions, unscaled, cases
        self._moved = lru_cache(maxsize=1)(self._move)  # neighbours share their motion

    def __len__(self) -> int:
        return len(self.points)

    def run(self, number: int) -> Run:
        """See :class:`rockbatch.plan.Runs`."""
        motion, polarity, intensity, case = self.points[number]
        scale = intensity / self.unscaled[motion]
        return Run(self._moved(motion, polarity, scale), polarity, scale, self.cases[case], self.motions[motion])

    def _move(self, motion: int, polarity: str, scale: float) -> Motion:
        return scaled(self.motions[motion], scale, polarity)


Simulate = Callable[[ScaledRuns], "pd.DataFrame"]
"""From runs to their rows of peaks.csv, in their order."""


class Stripe(NamedTuple):
    """All records at one level: how many count, exceed the limit, or are undecided; overturn, fly or fail."""

    level: float
    records: int
    exceeded: int
    undecided: int
    collapsed: int
    flight: int
    failed: int


@dataclass(frozen=True)
class Curve:
    """Fragility of one case for one limit.

    Attributes
    ----------
    case, limit
        Which.
    stripes : tuple of Stripe
        Counts at every level.
    fitted : Lognormal or str
        The curve, undecided runs counted as beyond the limit, or why there is none.
    otherwise : Lognormal, str or None
        The same with undecided runs counted as within the limit; None where there are none.
    capacities : tuple of (int, Bracket)
        Number of each motion that counts, and its bracket; empty for stripes.
    """

    case: Case
    limit: Rule
    stripes: tuple[Stripe, ...]
    fitted: Lognormal | str
    otherwise: Lognormal | str | None = None
    capacities: tuple[tuple[int, Bracket], ...] = ()


def output(spec: FragilitySpec) -> Output:
    """What the runs have to bring beyond their peaks."""
    return Output(histories="none", both_laws=any(rule.other_law for rule in spec.limits))


def intensities(motions: Iterable[Motion], spec: FragilitySpec, gravity: float) -> list[float]:
    """Intensity measure of every motion as it is, in the unit of the levels; ``InputError`` for one that has none."""
    found, wrong = [], []
    for motion in motions:
        if spec.measure == "PGA":
            value = motion.pga / gravity
        elif spec.measure == "PGV":
            value = pgv(motion.horizontal, motion.dt, motion.initial)
        else:
            value = spectral_acceleration(motion.horizontal, motion.dt, [spec.period_s], spec.damping)[0] / gravity
        if not value > 0:
            wrong.append(
                f"{motion.name}: its horizontal component has {spec.label} = 0, and no scale brings it to a level; "
                "take it out of [motions]"
            )
        found.append(float(value))
    if wrong:
        raise InputError(*wrong)
    return found


def assess(study: Study, spec: FragilitySpec, motions: Sequence[Motion], simulate: Simulate) -> list[Curve]:
    """Fragility curves of every case and every limit that it is asked about.

    Every record is scaled to every level; with method "ida" the first exceedance of every record is then bisected, in
    waves.

    ``simulate`` is called once for the levels and once for every wave, each depending on the rows before.
    """
    gravity = study.cases[0].pier.gravity
    unscaled = intensities(motions, spec, gravity)
    polarities = study.motions.polarity
    cases = [describe_case(case) for case in study.cases]
    asked = [(c, rule) for rule in spec.limits for c, case in enumerate(cases) if applies(rule, case)]

    def run(wanted: Iterable[tuple[int, float, int]]) -> "dict[int, tuple[list[Point], pd.DataFrame]]":
        """The points of each case, for motions at intensities in cases, and their rows."""
        points = [Point(motion, polarity, x, case) for motion, x, case in wanted for polarity in polarities]
        points.sort()  # what shares a motion stands together
        table = simulate(ScaledRuns(points, motions, unscaled, study.cases))
        own: dict[int, list[int]] = {}
        for i, point in enumerate(points):
            own.setdefault(point.case, []).append(i)
        return {case: ([points[i] for i in places], table.iloc[places]) for case, places in own.items()}

    runs = run((m, x, c) for m in range(len(motions)) for x in spec.levels for c in range(len(cases)))
    on_levels = {
        (c, rule): _on_levels(_worst(rule, cases[c], *runs[c]), len(motions), spec.levels) for c, rule in asked
    }
    brackets = {}
    if spec.method == "ida":
        for c, rule in asked:
            for m, found in enumerate(on_levels[c, rule]):
                if (one := bracket(spec.levels, found.tolist())) is not None:
                    brackets[c, rule, m] = one

        def look(wanted: dict[tuple[int, Rule, int], float]) -> dict[tuple[int, Rule, int], int]:
            runs = run(dict.fromkeys((m, x, c) for (c, _, m), x in wanted.items()))
            searched = dict.fromkeys((c, rule) for c, rule, _ in wanted)
            seen = {(c, rule): _worst(rule, cases[c], *runs[c]) for c, rule in searched}
            return {(c, rule, m): seen[c, rule][m, x] for (c, rule, m), x in wanted.items()}

        brackets = bisect(brackets, spec.tolerance, look)
    curves = []
    for c, rule in asked:
        found = on_levels[c, rule]
        stripes = _stripes(found, spec.levels, *runs[c])
        capacities = tuple((m, one) for (case, limit, m), one in brackets.items() if (case, limit) == (c, rule))
        fits = _through_brackets(capacities, spec) if spec.method == "ida" else _through_stripes(found, spec)
        curves.append(Curve(study.cases[c], rule, stripes, *fits, capacities))
    return curves


def _worst(rule: Rule, case: Any, points: Sequence[Point], table: "pd.DataFrame") -> dict[tuple[int, float], int]:
    """State of each motion at each intensity: the worst of its polarities."""
    found: dict[tuple[int, float], int] = {}
    for point, state in zip(points, states(rule, table, case).tolist(), strict=True):
        at = point.motion, point.intensity
        found[at] = max(found.get(at, LEFT_OUT), state)
    return found


def _on_levels(worst: dict[tuple[int, float], int], motions: int, levels: Sequence[float]) -> npt.NDArray[np.int8]:
    """State of each motion at each level, shape (motions, levels)."""
    return np.array([[worst[m, x] for x in levels] for m in range(motions)], dtype=np.int8)


def _stripes(
    found: npt.NDArray[np.int8], levels: Sequence[float], points: Sequence[Point], table: "pd.DataFrame"
) -> tuple[Stripe, ...]:
    ended: dict[tuple[float, str], set[int]] = {}  # the motions that did so, in one polarity at least
    for point, status in zip(points, table["status"], strict=True):
        ended.setdefault((point.intensity, status), set()).add(point.motion)
    return tuple(
        Stripe(
            x,
            *(int(np.count_nonzero(which)) for which in (at != LEFT_OUT, at == EXCEEDED, at == UNDECIDED)),
            *(len(ended.get((x, status), ())) for status in ("overturned", "flight", "failed")),
        )
        for x, at in zip(levels, found.T, strict=True)
    )


Fits = tuple[Lognormal | str, Lognormal | str | None]
"""With undecided runs beyond the limit, and within it; None where there are none."""


def _through_stripes(found: npt.NDArray[np.int8], spec: FragilitySpec) -> Fits:
    levels = np.array(spec.levels)
    within, undecided, beyond = (found == state for state in (WITHSTOOD, UNDECIDED, EXCEEDED))
    fitted = fit(Capacities.of_same_records(levels, within, beyond | undecided), spec.confidence)
    if not undecided.any():
        return fitted, None
    return fitted, fit(Capacities.of_same_records(levels, within | undecided, beyond), spec.confidence)


def _through_brackets(capacities: Sequence[tuple[int, Bracket]], spec: FragilitySpec) -> Fits:
    """Where a bracket ends at an undecided run, all that is known otherwise is that the capacity is above it."""
    low, high = np.array([(one.low, one.high) for _, one in capacities], dtype=np.float64).reshape(-1, 2).T
    undecided = np.array([one.undecided for _, one in capacities], dtype=bool)
    fitted = fit(Capacities(low, high, np.ones(len(low))), spec.confidence)
    if not undecided.any():
        return fitted, None
    high = np.where(undecided, np.inf, high)
    known = (low > 0) | np.isfinite(high)
    return fitted, fit(Capacities(low[known], high[known], np.ones(known.sum())), spec.confidence)
