"""Quantities for design: the greatest forces, gaps and velocities of every case, and those of every run."""

from typing import Any

import numpy as np

from rockbatch.checks.omissions import FACTORS
from rockbatch.common.statuses import CUT_SHORT
from rockbatch.quantities.cases import bends, has_light_shaft, is_frame, lands_by_impulse
from rockbatch.quantities.catalogue import report_columns
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import head
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.sections.peaks import every_run, on_scale
from rockbatch.reporting.sections.worst import of_cases
from rockbatch.reporting.table import Head
from rockbatch.reporting.templates import render


def section(finished: Finished) -> Markup:
    """Return the report's section of forces; empty if the study has none."""
    shown = [column for column in report_columns("forces") if column.name in finished.runs]
    if not shown or finished.runs.empty:
        return Markup("")

    def cells(run: dict[str, Any]) -> list[object]:
        return [finished.case_of(run), *(on_scale(column.name, run[column.name]) for column in shown)]

    heads = [Head("record"), Head("case", key=True), *map(head, shown)]
    places = list(zip(finished.runs["series"], finished.runs["pier"], strict=True))
    available = np.array([finished.cases[pair]["parameters"].get("friction", np.inf) for pair in places])
    impulsive = np.array([lands_by_impulse(finished.cases[pair]) for pair in places])
    demands = finished.runs.reindex(columns=["friction_demand", "impact_friction_demand"]).max(axis=1).to_numpy()
    cut_short = finished.runs["status"].isin(CUT_SHORT).to_numpy()
    known = np.isfinite(available) & ~np.isnan(demands) & ~cut_short
    return render(
        "observers/forces/section.html",
        of_cases=of_cases(finished, shown, "Forces of every case"),
        every_run=every_run(finished, heads, cells, "Forces of every run"),
        interfaces=bool(np.isfinite(available).any()),
        slides=int((demands > available).sum()),
        known=int(known.sum()),
        on_interfaces=int(np.isfinite(available).sum()) + finished.not_run,
        frames=any(is_frame(case) for case in finished.info["cases"]),
        bounds=bool(cut_short.any()),
        landings=bool((impulsive & (finished.runs["impacts"] > 0).to_numpy()).any()),
        modes=any(bends(case) for case in finished.info["cases"]),
        factors=FACTORS,
        heavy=any(not bends(case) and not has_light_shaft(case) for case in finished.info["cases"]),
    )
