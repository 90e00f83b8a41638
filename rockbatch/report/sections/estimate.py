"""Estimates by the equivalent oscillators of design practice beside the computed peaks, as a comparison."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rockbatch.common.files import read_table
from rockbatch.report.finished import Finished
from rockbatch.report.markup import Markup
from rockbatch.report.table import THETA_FORMAT, Head, alarm, table
from rockbatch.report.templates import render
from rockbatch.results.estimate import DAMPING, ESTIMATE, START
from rockbatch.results.labelled import as_dicts

Run = Mapping[str, Any]
METHODS = {"priestley": "Priestley et al. (1978)", "fema_356": "FEMA 356"}

OUTCOMES = {
    "rocks": "converges in",
    "no convergence": "does not converge in",
    "overturns": "reaches α in",
    "stays": "below the threshold",
}


def section(finished: Finished) -> Markup:
    """Return the estimates of every run; empty if the study does not ask for them."""
    path = finished.directory / ESTIMATE
    runs = as_dicts(read_table(path)) if path.exists() else []
    if not runs:
        return Markup("")
    once = list({(run["record"], finished.place(run["case"], run)[1], run["scale"]): run for run in runs}.values())
    on_rigid = [run for run in runs if finished.series[finished.place(run["case"], run)[0]].rigid]
    return render(
        "report/sections/estimate.html", start=START, motions=len(once), on_rigid=on_rigid, file=ESTIMATE,
        methods=[_outcomes(method, once, on_rigid) for method in METHODS], table=_table(finished, runs),
    )  # fmt: skip


def _outcomes(method: str, once: Sequence[Run], on_rigid: Sequence[Run]) -> dict[str, Any]:
    """Return how often a method has an answer, motion by motion, and its ratios to the peaks on rigid ground alone."""
    outcomes = [run[f"{method}_outcome"] for run in once]
    ratios = [
        run[f"{method}_theta_over_alpha"] / run["theta_max_over_alpha"]
        for run in on_rigid
        if run[f"{method}_outcome"] == "rocks" and run["status"] == "ok" and run["theta_max_over_alpha"] > 0
    ]
    return {
        "name": METHODS[method],
        "dampings": sorted({round(100 * run[f"{method}_damping"], 2) for run in once}),
        "counts": [f"{words} {outcomes.count(kind)}" for kind, words in OUTCOMES.items() if kind in outcomes],
        "ratios": [*np.percentile(ratios, [0, 50, 100]), len(ratios)] if ratios else None,
    }


def _table(finished: Finished, runs: Sequence[Run]) -> Markup:
    """Return a row for each motion and pier: the estimates, and the peaks computed on rigid ground alone."""
    rows: dict[tuple[str, int, float, str], dict[int, Run]] = {}
    for run in runs:
        series, pier = finished.place(run["case"], run)
        rows.setdefault((run["record"], pier, run["scale"], run["polarity"]), {})[series] = run
    signs, scales = {key[3] for key in rows}, {key[2] for key in rows}
    places = sorted({place for of_row in rows.values() for place in of_row if finished.series[place].rigid})
    computed = [finished.series[place].label for place in places]
    heads = [
        Head("record"),
        Head("pier"),
        Head("scale"),
        Head("polarity"),
        Head("PGA/(g tan α)", ".2f", "pga_over_g_tan_alpha: up to 1 a block on rigid ground stays"),
        *(Head(name, THETA_FORMAT, f"{method}_theta_over_alpha", "estimated θ/α") for method, name in METHODS.items()),
        *(Head(name, THETA_FORMAT, "theta_max_over_alpha", "computed θ/α") for name in computed),
    ]
    written = []
    for (record, place_of_pier, scale, sign), of_row in rows.items():
        first = next(iter(of_row.values()))
        peaks = [_computed(of_row.get(place)) for place in places]
        names = [finished.shown(record), finished.piers[place_of_pier] or None, scale if len(scales) > 1 else None]
        estimates = (_estimate(first, method) for method in DAMPING)
        row = [*names, sign if len(signs) > 1 else None, first["pga_over_g_tan_alpha"], *estimates, *peaks]
        written.append(row)
    return table(heads, written, sortable=True, name="Code estimates")


def _estimate(run: Run, method: str) -> object:
    outcome = run[f"{method}_outcome"]
    return run[f"{method}_theta_over_alpha"] if outcome == "rocks" else outcome


def _computed(run: Run | None) -> object:
    if run is None:
        return None
    return run["theta_max_over_alpha"] if run["status"] == "ok" else alarm(run["status"])
