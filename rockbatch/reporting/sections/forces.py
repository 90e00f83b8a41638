"""Quantities for design: the greatest forces, gaps and velocities of every case, and those of every run."""

from typing import Any

import numpy as np

from rockbatch.checks.omissions import FACTORS
from rockbatch.common.lazy import pd
from rockbatch.quantities.cases import bends, has_light_shaft, is_frame, lands_by_impulse
from rockbatch.quantities.catalogue import report_columns
from rockbatch.quantities.quantity import Quantity
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import head
from rockbatch.reporting.markup import Markup, join, number
from rockbatch.reporting.sections.peaks import every_run, on_scale
from rockbatch.reporting.table import Head, alarm, table
from rockbatch.reporting.templates import render

_LEAST = ("first_uplift_s", "first_uplift_g")
"""Columns of which the smallest value is the worst."""

CUT_SHORT = ("flight", "failed")
"""Statuses of runs that ended early: their values are only bounds."""


def section(finished: Finished) -> Markup:
    """Report forces if the study asks for them."""
    shown = [column for column in report_columns("forces") if column.name in finished.runs]
    if not shown or finished.runs.empty:
        return Markup("")

    def cells(run: dict[str, Any]) -> list[object]:
        return [finished.case_of(run), *(on_scale(column.name, run[column.name]) for column in shown)]

    heads = [Head("record"), Head("case"), *map(head, shown)]
    places = list(zip(finished.runs["series"], finished.runs["pier"], strict=True))
    available = np.array([finished.cases[pair]["parameters"].get("friction", np.inf) for pair in places])
    impulsive = np.array([lands_by_impulse(finished.cases[pair]) for pair in places])
    demands = finished.runs.reindex(columns=["friction_demand", "impact_friction_demand"]).max(axis=1).to_numpy()
    cut_short = finished.runs["status"].isin(CUT_SHORT).to_numpy()
    known = np.isfinite(available) & ~np.isnan(demands) & ~cut_short
    return render(
        "reporting/sections/forces.html", of_cases=of_cases(finished, shown, "Forces of every case"),
        every_run=every_run(finished, heads, cells, "Forces of every run"),
        interfaces=bool(np.isfinite(available).any()), slides=int((demands > available).sum()),
        known=int(known.sum()), on_interfaces=int(np.isfinite(available).sum()) + finished.not_run,
        frames=any(is_frame(case) for case in finished.info["cases"]),
        bounds=bool(cut_short.any()),
        landings=bool((impulsive & (finished.runs["impacts"] > 0).to_numpy()).any()),
        modes=any(bends(case) for case in finished.info["cases"]), factors=FACTORS,
        heavy=any(not bends(case) and not has_light_shaft(case) for case in finished.info["cases"]),
    )  # fmt: skip


def of_cases(finished: Finished, shown: list[Quantity], name: str) -> Markup:
    """Return a table with a row for each case: the worst of its runs, column by column."""
    rows: list[list[object]] = []
    for words, group in finished.groups():
        for place in group["series"].unique():
            runs, label = group[group["series"] == place], finished.series[int(place)].label
            ended = int(runs["status"].isin(CUT_SHORT).sum())
            counts = f"{len(runs) - ended} of {len(runs)}"
            cells = (_worst(column, runs, bool(ended)) for column in shown)
            rows.append([f"{label} ({words})" if words else label, alarm(counts) if ended else counts, *cells])
    runs_head = Head(
        "runs", note="that went through, of all; where some did not, the others bound the values from one side"
    )
    return table([Head("case"), runs_head, *map(head, shown)], rows, sortable=True, name=name)


def _worst(column: Quantity, runs: "pd.DataFrame", cut_short: bool) -> object:
    """Return the worst of the runs, with ≥ or ≤ if it is only a bound."""
    values = runs[column.name].dropna()
    if values.empty:
        return None
    least = column.name in _LEAST
    value = on_scale(column.name, float(values.min() if least else values.max()))
    shown = number(value, head(column).form)
    return join(f"{'≤' if least else '≥'}\u00a0", shown) if cut_short else value
