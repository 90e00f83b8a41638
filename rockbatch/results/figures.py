"""Figures of results: peaks as in Palmeri & Makris (2007), Fig. 7, their distribution, and peaks on self-similar axes."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from rockbatch.common.errors import InputError
from rockbatch.common.figures.description import (
    COLOURS,
    DASHES,
    ENDED,
    Axis,
    Figure,
    Look,
    Mark,
    Panel,
    Points,
    Polyline,
    Rule,
    Span,
    line_of,
    log_spanning,
    marks_of,
    sign_of,
)
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.common.statuses import NO_PEAK
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import is_across
from rockbatch.quantities.labels import record_labels
from rockbatch.quantities.rows import counts_as
from rockbatch.results.labelled import Item, Labelled, Row, as_dicts, by_pga, ceiling, groups_of
from rockbatch.results.labels import Series
from rockbatch.results.suite_statistics import distribution, worst_records

THETA = "θ_max/α"
VISIBLE = 0.015
"""Share of the axis below which an error bar hides behind its marker."""
MOST_PANELS = 24
SPREAD = 0.64
"""Share of the distance between foundations over which the marks of different sides are spread."""
OVER = "overturned, or ended by flight"
_DRAWN = ["record", "series", "polarity", "side", "status", "theta_max_over_alpha", "theta_max_error"]


def peaks(runs: "pd.DataFrame", series: Sequence[Series], records: Mapping[str, tuple[str, str]], top: float) -> Figure:
    """Return a figure of peaks: a panel for each record, a marker for each foundation, a line for rigid ground.

    ``runs`` have a column ``side``, which distinguishes the marks of one foundation; ``records`` maps records, each with a
    run, to caption and note. ``top`` is the end of the common axis of θ_max/α, above which is a band for runs without a peak.
    """
    present = sorted(
        (series[place] for place in runs["series"].unique()),
        key=lambda foundation: (not foundation.rigid, foundation.index),
    )
    ticks = {foundation.index + 1.0: foundation.tick for foundation in present if not foundation.rigid}
    sides = sorted(runs["side"].unique())
    eventful = bool(runs["status"].isin(NO_PEAK).any())
    last = max(ticks, default=0.0)
    x = Axis("", 0.2, last + 0.8 + (last == 0.0), names=ticks, numbered=bool(ticks))
    y = Axis(THETA, 0.0, 1.18 * top if eventful else top, about=4, last=top)
    width = min(max(166.0, 56.0 + 13.0 * (last + 1.0)), 900.0)
    strip = [Span("y", top, y.high, look=Look("band"))] if eventful else []
    by_record = grouped(as_dicts(runs[_DRAWN]), lambda run: run["record"])
    panels = []
    for name, (caption, note) in records.items():
        by_mark = grouped(by_record[name], lambda run: (run["series"], run["side"]))
        order = sorted(by_mark, key=lambda key: (series[key[0]].order, key[1]))
        marks = [mark for key in order for mark in _foundation_marks(series[key[0]], key[1], sides, by_mark[key], top)]
        panels.append(Panel(x, y, [*strip, *marks], caption, note, width, 110.0))
    return Figure(panels, "θmax/α of every foundation")


def _foundation_marks(foundation: Series, side: str, sides: list[str], runs: list[Row], top: float) -> Iterator[Mark]:
    """Yield the marks of one foundation and side in a panel; of two sides one has open marks, three or more have colours."""
    place, label = sides.index(side), foundation.keyed + (f" ({side})" if len(sides) > 1 else "")
    titles = [tooltip(foundation, run, side if len(sides) > 1 else "") for run in runs]
    abscissa = 0.42 if foundation.rigid else foundation.index + 1 + SPREAD * ((place + 0.5) / len(sides) - 0.5)
    x = np.full(len(runs), abscissa)
    theta = np.array([run["theta_max_over_alpha"] for run in runs], dtype=float)
    error = np.array([run["theta_max_error"] for run in runs], dtype=float)
    error = np.where(error > VISIBLE * top, error, 0.0)
    stood = np.array([run["status"] == "ok" for run in runs]) & ~np.isnan(theta)
    if foundation.rigid:
        colour = place + 1 if len(sides) > 2 else 0
        look = Look("rigid", colour % COLOURS, foundation.index % DASHES, open=len(sides) == 2 and place == 1)
        levels = np.where(stood, theta, 1.09 * top)[[run["status"] != "failed" for run in runs]]
        yield Rule("y", levels, look=look, label=label, title="; ".join(titles))
        for low, high in zip(theta - error, theta + error, strict=True):
            if high > low:
                yield Polyline(np.full(2, abscissa), np.array([low, high]), look=Look("bar"))
    else:
        look = marks_of(foundation.index, place == 1) if len(sides) < 3 else marks_of(place)
        titles_of = [title for title, stands in zip(titles, stood, strict=True) if stands]
        yield Points(x[stood], theta[stood], error[stood], titles_of, look=look, label=label)
    for status, words in ENDED.items():
        ended = [i for i, run in enumerate(runs) if run["status"] == status]
        if ended:
            height = 0.05 if status == "failed" else 1.09
            y, of_ended = np.full(len(ended), height * top), [titles[i] for i in ended]
            yield Points(x[ended], y, None, of_ended, look=sign_of(status), label=words)


def tooltip(series: Series, run: Row, side: str) -> str:
    """Return the tooltip of a run's marker: "2: η = 3.5: 0.0617 ± 3e-07", or its status instead of numbers.

    ``side`` is what tells the marks of a foundation apart, and follows the label in brackets; "" for nothing.
    """
    name = series.label + (f" ({side})" if side else "")
    if run["status"] != "ok":
        return f"{name}: {run['status']}"
    error = run["theta_max_error"]
    return f"{name}: {run['theta_max_over_alpha']:.4f}" + (f" ± {error:.0e}" if error == error else "")


def peaks_of_all(results: Labelled, info: Item) -> Figure:
    """Return a figure of the peaks of all piers, scales and polarities: the :data:`MOST_PANELS` worst records, ordered by PGA.

    Raises ``InputError`` without runs.
    """
    runs = _nonempty(results.runs)
    sides = [runs.loc[of_group.index, []].assign(side=words) for words, of_group in groups_of(runs, results.piers)]
    side = pd.concat(sides)["side"]
    if runs["polarity"].nunique() > 1:
        side = side.where(side == "", side + ", ") + runs["polarity"]
    names = by_pga(worst_records(runs, MOST_PANELS), info)
    shown = runs.assign(side=side)[runs["record"].isin(names)]
    labels = record_labels(info)
    figure = peaks(shown, results.series, {name: (labels.get(name, name), "") for name in names}, ceiling(shown))
    every = runs["record"].nunique()
    more = f" ({len(names)} of {every} records, the worst)" if len(names) < every else ""
    return Figure(figure.panels, figure.description, info["study"]["title"] + more)


def peaks_of_cases(results: Labelled) -> Figure:
    """Return a figure of one panel with the peaks of all records and piers: a column of points for each foundation.

    Raises ``InputError`` without runs.
    """
    runs = _nonempty(results.runs)
    ticks = [foundation.tick for foundation in results.series]
    if len(set(ticks)) < len(ticks):  # rigid foundations, which are lines elsewhere, have letters of their own
        ticks = [str(place) for place in range(1, len(ticks) + 1)]
    series = [
        replace(foundation, rigid=False, index=place, tick=tick)
        for place, (foundation, tick) in enumerate(zip(results.series, ticks, strict=True))
    ]
    sides = [runs.loc[of_group.index, []].assign(side=words) for words, of_group in groups_of(runs, results.piers)]
    together = runs.assign(side=pd.concat(sides)["side"], record="")
    return peaks(together, series, {"": ("", "")}, ceiling(runs))


def _nonempty(runs: "pd.DataFrame") -> "pd.DataFrame":
    """Return ``runs``; raise ``InputError`` if there are none."""
    if runs.empty:
        raise InputError("no runs to plot: no record could be used; see the column reason of peaks.csv")
    return runs


def distributions(groups: "Sequence[tuple[str, pd.DataFrame]]", series: Sequence[Series], count: str) -> Figure:
    """Return a figure of the peaks' distributions, a panel for each of ``groups`` and a curve for each foundation.

    ``groups`` are captions and runs; ``count`` is the unit of counting, "station" or "component".
    """
    eventful = any(runs["status"].isin(NO_PEAK).any() for _, runs in groups)
    panels = [_distribution(words, runs, series, count, eventful) for words, runs in groups]
    return Figure(panels, "Distribution of θmax/α")


def distributions_of_all(results: Labelled, count: str) -> Figure:
    """Return a figure of the distributions of all piers and scales; ``InputError`` without runs."""
    return distributions(list(groups_of(_nonempty(results.runs), results.piers)), results.series, count)


def _distribution(words: str, runs: "pd.DataFrame", series: Sequence[Series], count: str, eventful: bool) -> Panel:
    """Return a panel with the distribution of each foundation's peaks; ``eventful`` adds a band for runs without a peak."""
    values, status = runs["theta_max_over_alpha"].to_numpy(np.float64), runs["status"].to_numpy(object)
    counted_as = counts_as(Rows(runs), count)[0]
    top = 1.04 * float(np.nanmax(values[status == "ok"], initial=0.0)) or 1.0
    right = 1.08 * top if eventful else top
    marks: list[Mark] = [Span("x", top, right, look=Look("band"))] if eventful else []
    for place, rows in sorted(runs.groupby("series").indices.items()):
        foundation = series[int(str(place))]
        theta, share = distribution(values[rows], status[rows].tolist(), counted_as[rows].tolist())
        look = Look("level", dash=foundation.index % DASHES) if foundation.rigid else line_of(foundation.index)
        reached = float(share[-1]) if len(share) else 0.0
        x = np.repeat(np.concatenate(([0.0], theta, [right])), 2)[1:-1]
        y = np.repeat(np.concatenate(([0.0], share)), 2)
        marks.append(Polyline(x, y, foundation.label, look=look, label=foundation.label))
        if reached < 1.0 and np.isin(status[rows], NO_PEAK).any():
            note = f"{foundation.label}: {100 * (1 - reached):.0f} % {OVER}"
            middle, centre = np.full(2, 0.5 * (top + right)), np.array([0.5 * (1.0 + reached)])
            marks.append(Polyline(middle, np.array([reached, 1.0]), look=look))
            marks.append(Points(middle[:1], centre, titles=[note], look=sign_of("overturned"), label=OVER))
    axes = Axis(THETA, 0.0, right, last=top), Axis("share of the records", 0.0, 1.0)
    return Panel(*axes, marks, words or "all runs")


def self_similar(results: Labelled, info: Item) -> Figure:
    """Return the runs at PGA/(g tan α) over ω_g/p, a panel for each foundation, their θ_max/α as tone.

    Runs across the axis of a pier are left out. Raises ``InputError`` if none is left that has a PGV.
    """
    runs = _with_self_similar_axes(_nonempty(results.runs), results, info)
    theta = runs["theta_max_over_alpha"][(runs["status"] == "ok") & (runs["theta_max_over_alpha"] > 0)]
    low = float(theta.min()) if len(theta) else 0.1
    tone = Axis(THETA, low, max(float(theta.max()), 1.001 * low) if len(theta) else 1.0, log=True)
    x = log_spanning("ω_g/p,  ω_g = PGA/PGV", runs["frequency"].to_numpy())
    y = log_spanning("PGA/(g tan α)", np.append(runs["intensity"].to_numpy(), 1.0))
    panels = []
    for place in runs["series"].unique():
        of_series = runs[runs["series"] == place]
        lifts = Rule("y", np.ones(1), look=Look("edge", dash=1), label="lifts a pier off rigid ground")
        panels.append(Panel(x, y, [lifts, *_scattered(of_series, tone)], results.series[place].label, "", 240.0, 150.0))
    return Figure(panels, "PGA/(g tan α) and ω_g/p of every run", info["study"]["title"])


def _scattered(runs: "pd.DataFrame", tone: Axis) -> Iterator[Mark]:
    """Yield the points of one foundation: runs that rocked, runs that did not, and runs without a peak."""
    theta, stood = runs["theta_max_over_alpha"], runs["status"] == "ok"
    kinds = [(stood & (theta > 0), Look(), ""), (stood & ~(theta > 0), Look("faint", open=True), "did not move")]
    kinds += [(runs["status"] == status, sign_of(status), words) for status, words in ENDED.items()]
    for chosen, look, label in kinds:
        columns = ("frequency", "intensity", "theta_max_over_alpha")
        x, y, values = (runs.loc[chosen, name].to_numpy(float) for name in columns)
        if len(x):
            yield Points(x, y, look=look, label=label, shade=None if label else (tone, values))


def _with_self_similar_axes(runs: "pd.DataFrame", results: Labelled, info: Item) -> "pd.DataFrame":
    """Return the runs with ω_g/p (``frequency``) and PGA/(g tan α) (``intensity``); those without a PGV above 0 are left out.

    Runs across the axis of a pier are left out, too: run.json has only the PGV along it. Raises ``InputError`` if none is left.
    """
    along = [not is_across(results.cases[place]) for place in zip(runs["series"], runs["pier"], strict=True)]
    runs = runs[along]
    piers = [results.cases[place]["pier"] for place in zip(runs["series"], runs["pier"], strict=True)]
    pgv = runs["record"].map({record["record"]: record["pgv_m_s"] for record in info["records"]}).replace(0.0, math.nan)
    size = [pier["gravity"] / pier["p"] for pier in piers]
    frequency, intensity = size * runs["pga"] / (runs["scale"] * pgv), runs["pga"] / np.tan(runs["alpha"])
    table = runs.assign(frequency=frequency, intensity=intensity)
    return _nonempty(table[table["frequency"] > 0])
