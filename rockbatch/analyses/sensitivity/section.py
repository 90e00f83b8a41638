"""Pictures of ``rockbatch sensitivity``: the effect of each input alone, and Sobol's indices."""

from collections.abc import Callable, Mapping
from typing import Any

from rockbatch.analyses.sensitivity.figures import bars, symbol, written
from rockbatch.common.lazy import pd
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.report.finished_analysis import Contents, of_files
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.svg import drawn
from rockbatch.report.table import Head, listed
from rockbatch.report.templates import render
from rockbatch.results.labelled import as_dicts

TORNADO = ("case", "parameter", "low", "base", "high", "answer_low", "answer_base", "answer_high")
SOBOL = ("case", "parameter", "first", "first_error", "total", "total_error")


@of_files("sensitivity")
def section(contents: Contents) -> Markup:
    """Report the inputs one at a time, and all at once; empty if they were not studied."""
    analysis = contents.analysis("sensitivity")
    if analysis is None:
        return Markup("")
    swings, shares = analysis.table("sensitivity.csv", TORNADO), analysis.table("sobol.csv", SOBOL)
    if swings is None or shares is None:
        return Markup("")
    info = analysis.info
    tables = [
        _numbers(part.merge(shares, on=["case", *info["varied"], "parameter"]))
        for _, part in swings.groupby(["case", *info["varied"]], sort=False, dropna=False)
    ]
    picture = tag("figure", drawn(bars(swings, shares, info["varied"])), class_="whole")
    vertical = [motion["vertical"] for motion in info.get("under", [])]
    return render(
        "analyses/sensitivity/section.html", info=info, statistic=STATISTICS[info["statistic"]].words,
        drawn=join(picture, *tables),
        runs=[f"{count} {status}" for status, count in sorted(info["statuses"].items())],
        idle=vertical and not any(vertical) and any(entry.get("name") == "vertical" for entry in info["inputs"]),
        provenance=analysis.provenance(),
    )  # fmt: skip


def _numbers(rows: "pd.DataFrame") -> Markup:
    ends = ("low", "base", "high"), ("low", "study", "high")
    heads = [Head("input", value=lambda row: symbol(row["parameter"]))]
    heads += [Head(label, value=_end(name)) for name, label in zip(*ends, strict=True)]
    heads += [Head(label, ".4f", group="answer at", value=f"answer_{name}") for name, label in zip(*ends, strict=True)]
    for name, label in (("first", "first-order"), ("total", "total")):
        heads += [
            Head(label, ".3f", group="Sobol index", value=name),
            Head("±", ".3f", group="Sobol index", value=f"{name}_error"),
        ]
    return listed(heads, as_dicts(rows), name="Sensitivity in numbers")


def _end(name: str) -> Callable[[Mapping[str, Any]], object]:
    return lambda row: written(row[name])
