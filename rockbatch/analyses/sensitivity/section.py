"""Pictures of ``rockbatch sensitivity``: the effect of each input alone, and Sobol's indices."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from rockbatch.checks.statistics import STATISTICS
from rockbatch.common.lazy import pd
from rockbatch.report.drawing.axes import Axes, Scale, spanning
from rockbatch.report.drawing.svg import Entry, key, line, lowered, rectangle, svg, text
from rockbatch.report.finished_analysis import Contents, named, of_files
from rockbatch.report.markup import Markup, figure, join, number
from rockbatch.report.table import Head, listed
from rockbatch.report.templates import render
from rockbatch.results.labelled import as_dicts
from rockbatch.results.labels import SYMBOLS

WIDTH, LEFT, TOP, ROW = 440, 84, 20, 30
BAR = 12
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
    keys = ["case", *info["varied"]]
    varying = [name for name in keys if swings[name].nunique(dropna=False) > 1]
    drawn = []
    for names, part in swings.groupby(keys, sort=False, dropna=False):
        rows, words = part.merge(shares, on=[*keys, "parameter"]), named(dict(zip(keys, names, strict=True)), varying)
        drawn += [
            figure(_tornado(rows), f"{words}: one input at a time, all others as in the study."),
            figure(_bars(rows), f"{words}: all inputs at once over their ranges."),
            _numbers(rows),
        ]
    vertical = [motion["vertical"] for motion in info.get("under", [])]
    return render(
        "analyses/sensitivity/section.html", info=info, statistic=STATISTICS[info["statistic"]].words, drawn=join(*drawn),
        runs=[f"{count} {status}" for status, count in sorted(info["statuses"].items())],
        idle=vertical and not any(vertical) and any(entry.get("name") == "vertical" for entry in info["inputs"]),
        provenance=analysis.provenance(),
    )  # fmt: skip


def _symbol(name: str) -> str:
    return SYMBOLS.get(name, (name, ""))[0]


def _frame(inputs: Sequence[str], scale: Scale) -> tuple[Axes, list[Markup]]:
    """Return axes with a row for each input, from the top, and their names."""
    axes = Axes(LEFT, TOP, WIDTH - LEFT - 52, ROW * len(inputs), scale, Scale(0.0, len(inputs)))
    names = [
        text(LEFT - 6, TOP + ROW * (place + 0.5) + 4, _symbol(name), class_="e") for place, name in enumerate(inputs)
    ]
    return axes, [axes.frame(axes.x.ticks(5), []), *names]


def _tornado(rows: "pd.DataFrame") -> Markup:
    ends = rows[["answer_low", "answer_base", "answer_high"]].to_numpy(float)
    low, high = float(ends.min()), float(ends.max())
    room = 0.12 * (high - low) or 0.1 * abs(high) or 1.0
    axes, drawn = _frame(rows["parameter"].tolist(), Scale(max(0.0, low - room), high + room))
    base = float(axes.across(ends[0, 1]))
    for place, row in enumerate(as_dicts(rows)):
        middle = TOP + ROW * (place + 0.5)
        for colour, end, answer in (("s1", row["low"], row["answer_low"]), ("s2", row["high"], row["answer_high"])):
            x = float(axes.across(answer))
            left, right = sorted((base, x))
            shift = -BAR if colour == "s1" else 0
            drawn.append(rectangle(left, middle + shift, right - left, BAR, f"filled {colour}"))
            side, anchor = (3, "") if x >= base else (-3, " e")
            drawn.append(text(x + side, middle + shift + BAR - 2, _written(end), class_=colour + anchor))
    drawn.append(line(base, TOP, base, TOP + axes.height, "edge", f"as in the study: {ends[0, 1]:.4f}"))
    drawn.append(text(LEFT - 2, 12, lowered("θ", "max", "/α"), class_="q e"))
    ends_in_words = "at the low end of the range, or the first choice", "at the high end, or the second choice"
    return _picture("One input at a time", drawn, axes, ends_in_words, (line(11, 0, 11, 14, "edge"), "as in the study"))


def _bars(rows: "pd.DataFrame") -> Markup:
    ordered = rows.sort_values("total", ascending=False, kind="stable")
    whiskers = [ordered[name] + sign * ordered[f"{name}_error"] for name in ("first", "total") for sign in (-1, 1)]
    ends = np.concatenate([np.nan_to_num(column.to_numpy(float)) for column in whiskers])
    axes, drawn = _frame(ordered["parameter"].tolist(), spanning(ends))
    zero = float(axes.across(0.0))
    for place, row in enumerate(as_dicts(ordered)):
        for colour, name, shift in (("s1", "first", -BAR), ("s2", "total", 0)):
            if np.isnan(row[name]):
                continue
            y, value, error = TOP + ROW * (place + 0.5) + shift, row[name], row[f"{name}_error"]
            middle, low, high = (float(x) for x in axes.across(np.array([value, value - error, value + error])))
            left, right = sorted((zero, middle))
            drawn.append(rectangle(left, y, right - left, BAR, f"filled {colour}"))
            drawn.append(line(low, y + BAR / 2, high, y + BAR / 2, "bar", f"{value:.3f} ± {error:.3f}"))
    drawn.append(line(zero, TOP, zero, TOP + axes.height, "edge"))
    return _picture("Sobol indices", drawn, axes, ("first-order index", "total index"))


def _picture(words: str, drawn: Sequence[Markup], axes: Axes, bars: Sequence[str], *more: Entry) -> Markup:
    """Return a picture with its legend; ``bars`` is what the first and the second bar of each input stand for."""
    entries = [(rectangle(1, 3, 20, BAR, f"filled s{i}"), label) for i, label in enumerate(bars, 1)]
    drawing = svg(WIDTH, TOP + axes.height + 20, *drawn, description=words, class_="plot marks alone")
    return join(drawing, key([*entries, *more]))


def _numbers(rows: "pd.DataFrame") -> Markup:
    ends = ("low", "base", "high"), ("low", "study", "high")
    heads = [Head("input", value=lambda row: _symbol(row["parameter"]))]
    heads += [Head(label, value=_end(name)) for name, label in zip(*ends, strict=True)]
    heads += [Head(label, ".4f", group="answer at", value=f"answer_{name}") for name, label in zip(*ends, strict=True)]
    for name, label in (("first", "first-order"), ("total", "total")):
        heads += [
            Head(label, ".3f", group="Sobol index", value=name),
            Head("±", ".3f", group="Sobol index", value=f"{name}_error"),
        ]
    return listed(heads, as_dicts(rows), name="Sensitivity in numbers")


def _end(name: str) -> Callable[[Mapping[str, Any]], object]:
    return lambda row: _written(row[name])


def _written(value: object) -> str:
    """Format an end of a range, which may be text, since columns of the table hold numbers and words."""
    try:
        return number(float(str(value)))
    except ValueError:
        return str(value)
