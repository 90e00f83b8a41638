"""Sequences shock by shock: peaks, and the residuals when the next shock begins."""

import math
from collections import Counter
from collections.abc import Sequence
from typing import Any

from rockbatch.observers.shocks import TABLE
from rockbatch.observers.shocks.table import MEANING, read
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.table import THETA, THETA_FORMAT, Head, alarm, sub, table
from rockbatch.reporting.templates import render
from rockbatch.results.labelled import as_dicts

AT_REST = 0.001
"""Range of θ/α in a pause beyond which the pier is said to move still when the next shock begins."""


def section(finished: Finished) -> Markup:
    """Return the report's section of the response to each shock; empty if no motion is a sequence."""
    directory = finished.directory
    rows = as_dicts(read(directory, finished.info["varied"])) if (directory / TABLE).exists() else []
    if not rows:
        return Markup("")
    moving = [row["moving_over_alpha"] for row in rows if row["moving_over_alpha"] == row["moving_over_alpha"]]
    whole: dict[tuple[Any, ...], list[dict[str, Any]]] = {}
    for row in rows:
        whole.setdefault((row["record"], finished.place(row["case"], row), row["polarity"], row["scale"]), []).append(
            row
        )
    runs = [run for run in whole.values() if run[0]["shock_status"] not in ("failed", "not read")]
    whole_runs = [run for run in runs if all(row["shock_status"] == "ok" for row in run)]
    return render(
        "observers/shocks/section.html",
        runs=len(runs),
        cut_short=len(whole) - len(whole_runs),
        all_runs=len(whole),
        file=TABLE,
        pauses=len(moving),
        still=sum(m > AT_REST for m in moving),
        most=max(moving, default=None),
        at_rest=AT_REST,
        later=sum(max(run, key=_peak) is not run[0] for run in runs),
        fallen=sorted(Counter(row["shock"] for row in rows if row["shock_status"] == "overturned").items()),
        table=_table(finished, rows),
    )


def _peak(row: dict[str, Any]) -> float:
    theta = float(row["theta_max_over_alpha"])
    return -math.inf if theta != theta else theta


def _table(finished: Finished, rows: Sequence[dict[str, Any]]) -> Markup:
    heads = [
        Head("sequence"),
        Head("case"),
        Head("shock", ".0f", MEANING["shock"]),
        Head("record"),
        Head("from", ".2f", MEANING["start_s"], unit="s"),
        Head("PGA", ".3f", MEANING["shock_pga_g"], unit="g"),
        Head("status", note=MEANING["shock_status"]),
        Head(THETA, THETA_FORMAT, MEANING["theta_max_over_alpha"]),
        Head("±", ".0e", MEANING["theta_max_error"]),
        Head("at t", ".2f", MEANING["t_max_s"], unit="s"),
        Head(sub("θ", "res", "/α"), ".5f", MEANING["theta_res_over_alpha"]),
        Head("settlement", ".2f", MEANING["settlement_m"], unit="mm"),
        Head("still moving/α", ".4f", MEANING["moving_over_alpha"]),
    ]
    cells = []
    for row in rows:
        series, pier = finished.place(row["case"], row)
        foundation = finished.case_of(row | {"series": series, "pier": pier, "with_vertical": ""})
        status, moving = row["shock_status"], row["moving_over_alpha"]
        stood = [None] * 5
        if status == "ok":
            stood = [
                row[name] for name in ("theta_max_over_alpha", "theta_max_error", "t_max_s", "theta_res_over_alpha")
            ]
            stood.append(1000.0 * row["settlement_m"])
        cells.append(
            [
                finished.shown(row["record"]),
                foundation,
                row["shock"],
                finished.shown(row["shock_record"]),
                row["start_s"],
                row["shock_pga_g"],
                status if status == "ok" else alarm(status),
                *stood,
                alarm(f"{moving:.4f}") if moving > AT_REST else moving,
            ]
        )
    return table(heads, cells, sortable=True, name="Every shock")
