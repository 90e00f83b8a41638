"""Pictures of ``rockbatch sensitivity``: the effect of each input alone, and Sobol's indices."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rockbatch.checks.statistics import STATISTICS
from rockbatch.lazy import pd
from rockbatch.report.drawing.axes import Axes, Scale, spanning
from rockbatch.report.drawing.svg import key, line, lowered, rectangle, svg, text
from rockbatch.report.finished_analysis import Contents, named, of_files
from rockbatch.report.labels import SYMBOLS
from rockbatch.report.markup import Markup, figure, join, number, tag
from rockbatch.report.table import Head, alarm, table

WIDTH, LEFT, TOP, ROW = 440, 84, 20, 30
BAR = 12
TORNADO = ("case", "parameter", "low", "base", "high", "answer_low", "answer_base", "answer_high")
SOBOL = ("case", "parameter", "first", "first_error", "total", "total_error")


@of_files("sensitivity")
def section(contents: Contents) -> Markup:
    """Report the inputs one at a time, and all at once; None if they were not studied."""
    analysis = contents.analysis("sensitivity")
    if analysis is None:
        return Markup("")
    swings, shares = analysis.table("sensitivity.csv", TORNADO), analysis.table("sobol.csv", SOBOL)
    if swings is None or shares is None:
        return Markup("")
    keys = ["case", *analysis.info["varied"]]
    parts = [_lead(analysis.info), _without_vertical(analysis.info)]
    for names, own in swings.groupby(keys, sort=False, dropna=False):
        both = own.merge(shares, on=[*keys, "parameter"])
        values = dict(zip(keys, names, strict=True))
        varying = [name for name in keys if swings[name].nunique(dropna=False) > 1]
        words = named(values, varying)
        parts.append(figure(_tornado(both), f"{words}: one input at a time, all others as in the study."))
        parts.append(figure(_bars(both), f"{words}: all inputs at once over their ranges."))
        parts.append(_numbers(both))
    parts.append(analysis.provenance())
    return join(*parts)


def _lead(info: dict[str, Any]) -> Markup:
    runs = ", ".join(f"{count} {status}" for status, count in sorted(info["statuses"].items()))
    return tag(
        "p",
        f"The answer is the {STATISTICS[info['statistic']].words} of the suite of ", _peak(),
        ", every component by itself. A run that overturned, or was ended by flight, counts as "
        f"{info['overturned']:g}, and so does any larger rotation; a failed one with its best value. Of all runs: {runs}. Of the "
        "answer's variance, the first-order index is the share that goes with the input alone, the total index what would be "
        "left if only it were unknown; the difference is its part in interactions. "
        f"Whiskers: {100 * info['confidence']:g} % intervals.",
    )  # fmt: skip


def _without_vertical(info: dict[str, Any]) -> Markup:
    """Warn that the input "vertical" has no effect if no record has a vertical component."""
    motions = info.get("under", [])
    studied = any(entry.get("name") == "vertical" for entry in info["inputs"])
    if not studied or not motions or any(motion["vertical"] for motion in motions):
        return Markup("")
    return tag(
        "p",
        alarm("No record has a vertical component"),
        ": the input vertical is without effect here, whatever it would do.",
    )


def _peak() -> Markup:
    return join("θ", tag("sub", "max"), "/α")


def _symbol(name: str) -> str:
    return SYMBOLS.get(name, (name, ""))[0]


def _frame(inputs: Sequence[str], scale: Scale) -> tuple[Axes, list[Markup]]:
    """Return axes with a row for each input, from the top, and their names."""
    axes = Axes(LEFT, TOP, WIDTH - LEFT - 52, ROW * len(inputs), scale, Scale(0.0, len(inputs)))
    names = [
        text(LEFT - 6, TOP + ROW * (place + 0.5) + 4, _symbol(name), class_="e") for place, name in enumerate(inputs)
    ]
    return axes, [axes.frame(axes.x.ticks(5), []), *names]


def _tornado(both: "pd.DataFrame") -> Markup:
    ends = both[["answer_low", "answer_base", "answer_high"]].to_numpy(float)
    low, high = float(ends.min()), float(ends.max())
    room = 0.12 * (high - low) or 0.1 * abs(high) or 1.0
    axes, drawn = _frame(both["parameter"].tolist(), Scale(max(0.0, low - room), high + room))
    base = float(axes.across(ends[0, 1]))
    for place, row in enumerate(both.to_dict("records")):
        middle = TOP + ROW * (place + 0.5)
        for colour, end, answer in (("s1", row["low"], row["answer_low"]), ("s2", row["high"], row["answer_high"])):
            at = float(axes.across(answer))
            left, right = sorted((base, at))
            shift = -BAR if colour == "s1" else 0
            drawn.append(rectangle(left, middle + shift, right - left, BAR, f"filled {colour}"))
            side, anchor = (3, "") if at >= base else (-3, " e")
            drawn.append(text(at + side, middle + shift + BAR - 2, _written(end), class_=colour + anchor))
    drawn.append(line(base, TOP, base, TOP + axes.height, "edge", f"as in the study: {ends[0, 1]:.4f}"))
    drawn.append(text(LEFT - 2, 12, lowered("θ", "max", "/α"), class_="q e"))
    entries = [
        (rectangle(1, 3, 20, BAR, "filled s1"), "at the low end of the range, or the first choice"),
        (rectangle(1, 3, 20, BAR, "filled s2"), "at the high end, or the second choice"),
        (line(11, 0, 11, 14, "edge"), "as in the study"),
    ]
    drawing = svg(WIDTH, TOP + axes.height + 20, *drawn, description="One input at a time", class_="plot marks alone")
    return join(drawing, key(entries))


def _bars(both: "pd.DataFrame") -> Markup:
    own = both.sort_values("total", ascending=False, kind="stable")
    whiskers = [own[name] + sign * own[f"{name}_error"] for name in ("first", "total") for sign in (-1, 1)]
    ends = np.concatenate([np.nan_to_num(column.to_numpy(float)) for column in whiskers])
    axes, drawn = _frame(own["parameter"].tolist(), spanning(ends))
    zero = float(axes.across(0.0))
    for place, row in enumerate(own.to_dict("records")):
        for colour, name, shift in (("s1", "first", -BAR), ("s2", "total", 0)):
            if np.isnan(row[name]):
                continue
            y, value, error = TOP + ROW * (place + 0.5) + shift, row[name], row[f"{name}_error"]
            at, low, high = (float(x) for x in axes.across(np.array([value, value - error, value + error])))
            left, right = sorted((zero, at))
            drawn.append(rectangle(left, y, right - left, BAR, f"filled {colour}"))
            drawn.append(line(low, y + BAR / 2, high, y + BAR / 2, "bar", f"{value:.3f} ± {error:.3f}"))
    drawn.append(line(zero, TOP, zero, TOP + axes.height, "edge"))
    entries = [
        (rectangle(1, 3, 20, BAR, "filled s1"), "first-order index"),
        (rectangle(1, 3, 20, BAR, "filled s2"), "total index"),
    ]
    drawing = svg(WIDTH, TOP + axes.height + 20, *drawn, description="Sobol indices", class_="plot marks alone")
    return join(drawing, key(entries))


def _numbers(both: "pd.DataFrame") -> Markup:
    heads = [
        Head("input"),
        *(Head(name) for name in ("low", "study", "high")),
        *(Head(name, ".4f", over="answer at") for name in ("low", "study", "high")),
        Head("first-order", ".3f", over="Sobol index"),
        Head("±", ".3f", over="Sobol index"),
        Head("total", ".3f", over="Sobol index"),
        Head("±", ".3f", over="Sobol index"),
    ]
    names = (
        "answer_low", "answer_base", "answer_high", "first", "first_error", "total", "total_error",
    )  # fmt: skip
    rows = [
        [_symbol(row["parameter"]), *(_written(row[end]) for end in ("low", "base", "high")),
         *(float(row[name]) for name in names)]
        for row in both.to_dict("records")
    ]  # fmt: skip
    return table(heads, rows, name="Sensitivity in numbers")


def _written(value: object) -> str:
    """Format an end of a range, which may be text, since columns of the table hold numbers and words."""
    try:
        return number(float(str(value)))
    except ValueError:
        return str(value)
