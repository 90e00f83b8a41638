"""The responses that a designer asks for first, checked or not, and whether a check limits them."""

import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.checks.verdicts import DOES_NOT_APPLY, Verdict
from rockbatch.checks.wording import at
from rockbatch.common.lazy import pd
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import Case, bends
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.quantity import SETTLING
from rockbatch.quantities.rows import rows_of_cases

PEAKS = frozenset(name for name, demand in DEMANDS.items() if demand.reached)
"""Demands that are the greatest rotation times a length of the case, known until a motion ends."""
DRIFTS = frozenset(("top_drift_m", "top_drift_mm", "drift_ratio"))
TILTS = frozenset(("theta_res_over_alpha", "theta_res_rad", "base_tilt_rad", "differential_settlement_m"))
_SETTLED = frozenset(("settlement_m", "toe_settlement_m"))


class Response(NamedTuple):
    """Name of a response, the demands whose limits bound it as well, its unit in tables and the factor to it."""

    words: str
    bounded_by: frozenset[str]
    unit: str = "mm"
    factor: float = 1e3

    def named(self, heights: Collection[float]) -> str:
        """Return its name, with the height if all are read at the same one: "drift at 72 m"."""
        return f"{self.words}{at(*heights)}" if len(heights) == 1 else self.words


RESPONSES = {
    "theta_max_over_alpha": Response("rotation", PEAKS, "θ/α", 1.0),
    "top_drift_m": Response("drift", PEAKS),
    "settlement_m": Response("mean settlement", _SETTLED),
    "base_tilt_rad": Response("residual tilt", TILTS | {"toe_settlement_m"}, "mrad"),
    "theta_res_rad": Response("residual rotation", TILTS, "mrad"),
    "heel_uplift_m": Response("uplift of the heel", PEAKS),
    "ductility": Response("ductility", frozenset(("ductility",)), "", 1.0),
}
"""Responses by their demands, in the order of the answer. The settlement of the toe is that of the pier and its tilt, and on
springs the residual rotation follows from the tilt."""

LOST = "runs that do not end standing"
"""Heading of the number of runs without a response, beside the responses of the others."""

PERMANENT = ("settlement_m", "base_tilt_rad")
"""Responses of yielding supports only."""

ROUNDING = 1e-9
"""Settlement [m] or tilt [rad] below which a value is rounding error."""

_HELD = 1e-4
"""Least residual rotation over α on rigid ground that counts."""


class Worst(NamedTuple):
    """The greatest value of a demand among the runs of a case that end standing, at all scales or at one."""

    demand: str
    value: float
    case: Case
    runs: "pd.DataFrame"
    place: int
    scale: float = math.nan

    @property
    def height(self) -> float:
        """Height at which the demand is read [m]; NaN of one without a height."""
        lever = DEMANDS[self.demand].height
        return math.nan if lever is None else lever(self.case)

    def place_among(self, heights: Collection[float]) -> str:
        """Return " at 72 m" if ``heights`` are several; "" for one, which stands in the head of the column."""
        return at(self.height) if len(heights) > 1 else ""

    @property
    def run(self) -> "pd.Series[Any]":
        """Row of peaks.csv of the run, which is at ``place`` among ``runs``."""
        return self.runs.iloc[self.place]


def standing(runs: "pd.DataFrame") -> npt.NDArray[np.bool_]:
    """Return True for each run that ends standing, with a peak, shape (n,)."""
    return ((runs["status"] == "ok") & runs["theta_max_over_alpha"].notna()).to_numpy(bool)


def worst_of_cases(runs: "pd.DataFrame", cases: Sequence[Case], *, at_each_scale: bool = False) -> list[Worst]:
    """Return the worst response of every case, at all scales or at each, for each of :data:`RESPONSES` that it has.

    ``runs`` are rows of peaks.csv of all cases, and ``cases`` as in run.json. A case without a run that ends standing is left
    out.
    """
    worst = []
    stood, table = standing(runs), Rows(runs)
    scale_of = table.numbers("scale") if at_each_scale else np.full(len(runs), math.nan)
    for case, of_case in rows_of_cases(runs, cases):
        places = of_case[stood[of_case]]
        places = places[np.argsort(scale_of[places], kind="stable")]
        scales, firsts = np.unique(scale_of[places], return_index=True)
        responses = [*_greatest(table.at(places), case, firsts)] if len(places) else []
        for number, scale in enumerate(scales.tolist()):
            for name, values, greatest in responses:
                if not math.isnan(value := values[number]):
                    worst.append(Worst(name, value, case, runs, greatest[number], scale))
    return worst


def _greatest(rows: Rows, case: Case, firsts: npt.NDArray[np.intp]) -> Iterator[tuple[str, list[float], list[int]]]:
    """Yield each response of a case, with its greatest value in each suite, and the place of that row in the whole table.

    ``firsts`` are the first of the ``rows`` of each suite. Responses that the case does not have are left out; the value is NaN
    for a suite without a finite one, and 0 for settlements and tilts below :data:`ROUNDING`.
    """
    for name in RESPONSES:
        if not DEMANDS[name].applies_to(case) or (name == "theta_res_rad" and case["base"] != "rigid"):
            continue
        if name in PERMANENT and case["base"] not in SETTLING:
            continue
        values = DEMANDS[name].evaluate(rows, case).value
        known = np.where(np.isnan(values), -math.inf, values)
        greatest = np.maximum.reduceat(known, firsts)
        reached = np.flatnonzero(known == np.repeat(greatest, np.diff(firsts, append=len(rows))))
        least = ROUNDING if name in PERMANENT else -math.inf
        greatest = np.where(greatest < least, 0.0, greatest)
        greatest[~np.logical_or.reduceat(np.isfinite(values), firsts)] = math.nan
        yield name, greatest.tolist(), rows.places[reached[np.searchsorted(reached, firsts)]].tolist()


def heights_of(worst: Iterable[Worst]) -> dict[str, set[float]]:
    """Return by demand the heights of all cases at which it is read [m]; empty for a demand without a height."""
    heights: dict[str, set[float]] = {}
    for peak in worst:
        of_demand = heights.setdefault(peak.demand, set())
        if not math.isnan(peak.height):
            of_demand.add(peak.height)
    return heights


def worst_of_all(worst: Iterable[Worst]) -> dict[str, Worst]:
    """Return the worst of all cases for each demand, in the order of :data:`RESPONSES`."""
    greatest: dict[str, Worst] = {}
    for peak in worst:
        if peak.demand not in greatest or peak.value > greatest[peak.demand].value:
            greatest[peak.demand] = peak
    return {name: greatest[name] for name in RESPONSES if name in greatest}


def unlimited(worst: Sequence[Worst], verdicts: Sequence[Verdict]) -> list[Worst]:
    """Return the worst responses of a case that govern its design and that no check bounds; [] if all are bounded.

    Rotation always governs, and is bounded by a check of drift or uplift, too; the drift of a shaft that bends governs beside it;
    settlement, tilt and ductility do if the ductility is above 1, the residual rotation on rigid ground above 10⁻⁴ α.
    ``worst`` and ``verdicts`` are those of the case; a check that does not apply bounds nothing.
    """
    checked = {verdict.demand for verdict in verdicts if verdict.verdict != DOES_NOT_APPLY}
    yielded = any(peak.demand == "ductility" and peak.value > 1.0 for peak in worst)
    governing = ["theta_max_over_alpha", *(("settlement_m", "base_tilt_rad", "ductility") if yielded else ())]
    residual = (peak for peak in worst if peak.demand == "theta_res_rad")
    governing += [peak.demand for peak in residual if peak.value > _HELD * peak.case["pier"]["alpha"]]
    free = [peak for peak in worst if peak.demand in governing and not checked & RESPONSES[peak.demand].bounded_by]
    bent = [peak for peak in worst if peak.demand == "top_drift_m" and bends(peak.case) and not checked & DRIFTS]
    return free + bent


def in_words(worst: Worst) -> str:
    """Return the value of a response with its units: a drift "1.49 m (1486 mm) at 30 m", a rotation in α, degrees and rad.

    A settlement of two models is a range in mm; other lengths are in mm, tilts in mrad and degrees, a ductility is a number.
    """
    value, pier = worst.value, worst.case["pier"]
    if worst.demand == "theta_max_over_alpha":
        theta = value * float(pier["alpha"])
        return f"{value:.4g} α = {math.degrees(theta):.3g}° ({theta:.3g} rad)"
    if worst.demand in ("base_tilt_rad", "theta_res_rad"):
        return f"{1000 * value:.3g} mrad ({math.degrees(value):.2g}°)"
    if worst.demand == "top_drift_m":
        return f"{value:.3g} m ({_millimetres(value)} mm){at(worst.height)}"
    end = DEMANDS[worst.demand].other_end
    if end and not math.isnan(other := float(worst.run.get(end.column, math.nan))):
        low, high = sorted((value, other))
        return f"{_millimetres(low)} to {_millimetres(high)} mm, by both {end.models}"
    return f"{_millimetres(value)} mm" if DEMANDS[worst.demand].unit == "m" else f"{value:.3g}"


def _millimetres(metres: float) -> str:
    """Return a length [m] as text in mm, without unit: whole mm from 0.1 m on, else three significant digits."""
    return f"{1000 * metres:,.0f}" if metres >= 0.1 else f"{1000 * metres:.3g}"
