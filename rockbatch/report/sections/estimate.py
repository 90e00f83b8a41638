"""Estimates by the equivalent oscillators of design practice beside the computed peaks, as a comparison."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from rockbatch.files import read_table
from rockbatch.report.finished import Finished, as_dicts
from rockbatch.report.labels import counted, heading
from rockbatch.report.markup import Markup, join, paragraphs, tag
from rockbatch.report.table import THETA_FORMAT, Head, alarm, table
from rockbatch.results.estimate import DAMPING, ESTIMATE, START

METHODS = {"priestley": "Priestley et al. (1978)", "fema_356": "FEMA 356"}

OUTCOMES = {
    "rocks": "converges in",
    "no convergence": "does not converge in",
    "overturns": "reaches α in",
    "stays": "below the threshold",
}

WORDS = (
    "A comparison, not a result of this study, and nothing to design by: a rigid block on rigid ground under the "
    "horizontal component alone, taken for an elastic oscillator. Its period is that of free rocking, T = (4/p) "
    f"arcosh(1/(1 − θ/α)) (Housner 1963); from θ/α = {START:g} on, the rotation S_d(T, ζ)/R_0 that the record's own "
    "elastic spectrum gives is put in again until it repeats itself. With r = e², what an impact leaves of the energy, "
    "ζ = −0.34 ln r stands for Priestley et al. (1978), by Makris & Konstantinidis (2003), and ζ = 0.4 (1 − √r) for "
    "FEMA 356 (2000). These formulas are known from later literature; they could not be checked against the text of "
    "their sources.",
    "The iteration need not converge: spectra of single records are jagged, and it then goes to and fro between "
    "several rotations. Makris & Konstantinidis (2003, Earthq. Eng. Struct. Dyn. 32(2), 265–289) show why a rocking "
    "block is no such oscillator, and that the method should not be used.",
    "Housner's threshold: below PGA = g tan α a block on rigid ground does not lift off; it stays. A vertical "
    "component, which lowers the threshold while it points down, is not in it.",
)


def section(finished: Finished) -> Markup:
    """Return the estimates of every run; None if the study does not ask for them."""
    path = finished.directory / ESTIMATE
    runs = as_dicts(read_table(path)) if path.exists() else []
    if not runs:
        return Markup("")
    return join(paragraphs(*map(heading, WORDS)), _summary(finished, runs), _table(finished, runs))


def _summary(finished: Finished, runs: list[dict[str, Any]]) -> Markup:
    """Report how often each method has an answer, motion by motion, and its error on rigid ground alone."""
    on_rigid = [run for run in runs if _is_rigid_block(finished, run)]
    once = list({(run["record"], finished.place(run["case"], run)[1], run["scale"]): run for run in runs}.values())
    sentences = []
    for method, name in METHODS.items():
        outcomes = [run[f"{method}_outcome"] for run in once]
        ratios = [
            run[f"{method}_theta_over_alpha"] / run["theta_max_over_alpha"]
            for run in on_rigid
            if run[f"{method}_outcome"] == "rocks" and run["status"] == "ok" and run["theta_max_over_alpha"] > 0
        ]
        counts = ", ".join(f"{words} {outcomes.count(kind)}" for kind, words in OUTCOMES.items() if kind in outcomes)
        sentence = f"{name} (ζ = {_dampings(runs, method)}), of {counted(len(once), 'motion')}: {counts}"
        if ratios:
            low, middle, high = np.percentile(ratios, [0, 50, 100])
            sentence += f"; where it gives a rotation, that is {low:.2f} to {high:.2f} times the computed one"
            sentence += f" on rigid ground, {middle:.2f} in the median of {counted(len(ratios), 'run')}"
        sentences.append(f"{sentence}.")
    if not on_rigid:
        sentences.append("No case stands on rigid ground without devices, so that nothing computed compares with them.")
    return paragraphs(*sentences)


def _is_rigid_block(finished: Finished, run: Mapping[str, Any]) -> bool:
    """Return whether a run is of the system that is estimated: a block on rigid ground alone."""
    return finished.series[finished.place(run["case"], run)[0]].rigid


def _dampings(runs: list[dict[str, Any]], method: str) -> str:
    """Return the equivalent damping of the piers, in percent."""
    dampings = sorted({round(100 * run[f"{method}_damping"], 2) for run in runs})
    return f"{dampings[0]:g} %" if len(dampings) == 1 else f"{dampings[0]:g} to {dampings[-1]:g} %"


def _table(finished: Finished, runs: list[dict[str, Any]]) -> Markup:
    """Return a row for each motion and pier: the estimates, and the peaks computed on rigid ground alone."""
    rows: dict[tuple[str, int, float, str], dict[int, dict[str, Any]]] = {}
    for run in runs:
        series, pier = finished.place(run["case"], run)
        rows.setdefault((run["record"], pier, run["scale"], run["polarity"]), {})[series] = run
    signs, scales = {key[3] for key in rows}, {key[2] for key in rows}
    places = sorted({place for same in rows.values() for place in same if finished.series[place].rigid})
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
    for (record, place_of_pier, scale, sign), same in rows.items():
        first = next(iter(same.values()))
        peaks = [_computed(same.get(place)) for place in places]
        names = [finished.shown(record), finished.piers[place_of_pier] or None, scale if len(scales) > 1 else None]
        estimates = (_estimate(first, method) for method in DAMPING)
        row = [*names, sign if len(signs) > 1 else None, first["pga_over_g_tan_alpha"], *estimates, *peaks]
        written.append(row)
    where = tag("p", "Every run: ", tag("code", ESTIMATE), class_="muted")
    return join(table(heads, written, sortable=True, name="Code estimates"), where)


def _estimate(run: Mapping[str, Any], method: str) -> object:
    outcome = run[f"{method}_outcome"]
    return run[f"{method}_theta_over_alpha"] if outcome == "rocks" else outcome


def _computed(run: Mapping[str, Any] | None) -> object:
    if run is None:
        return None
    return run["theta_max_over_alpha"] if run["status"] == "ok" else alarm(run["status"])
