"""Figures of sensitivity: the effect of each input alone, and Sobol's indices."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from rockbatch.common.analyses import Entry
from rockbatch.common.figures.description import Area, Axis, Figure, Look, Mark, Panel, Polyline, Rule, Words, spanning
from rockbatch.common.lazy import pd
from rockbatch.quantities.labels import SYMBOLS
from rockbatch.reporting.finished_analysis import named
from rockbatch.reporting.markup import number
from rockbatch.results.labelled import as_dicts

ROW = 30.0
"""Height of an input [px]."""
BAR = 0.4
"""Height of a bar, of which an input has two, over that of the input."""
ENDS = {"low": "at the low end of the range, or the first choice", "high": "at the high end, or the second choice"}
INDICES = {"first": "first-order index", "total": "total index"}


def symbol(name: str) -> str:
    return SYMBOLS.get(name, (name, ""))[0]


def bars(swings: "pd.DataFrame", sobol: "pd.DataFrame", info: Entry) -> Figure:
    """Return a figure with two panels for each case: the answer at both ends of every input, and Sobol's indices.

    The tables are sensitivity.csv and sobol.csv, ``info`` is sensitivity.json.
    """
    keys = ["case", *info["varied"]]
    varying = [name for name in keys if swings[name].nunique(dropna=False) > 1]
    panels = []
    for names, part in swings.groupby(keys, sort=False, dropna=False):
        rows = part.merge(sobol, on=[*keys, "parameter"])
        words = named(info, dict(zip(keys, names, strict=True)), varying)
        panels += [
            _tornado(rows, f"{words}: one input at a time, all others as in the study"),
            _indices(rows, f"{words}: all inputs at once over their ranges"),
        ]
    return Figure(panels, "Sensitivity")


def _tornado(rows: "pd.DataFrame", caption: str) -> Panel:
    ends = rows[["answer_low", "answer_base", "answer_high"]].to_numpy(float)
    low, high = float(ends.min()), float(ends.max())
    room = 0.2 * (high - low) or 0.1 * abs(high) or 1.0
    base = float(ends[0, 1])
    marks: list[Mark] = []
    for place, row in enumerate(as_dicts(rows)):
        for way, (end, words) in enumerate(ENDS.items()):
            answer, y = row[f"answer_{end}"], _height(len(rows), place, way)
            marks.append(_bar(base, answer, y, way, words))
            side = 1 if answer >= base else -1
            marks.append(Words(answer, y, written(row[end]), side, look=Look("", way + 1)))
    study = Rule(
        "x", np.array([base]), look=Look("edge"), label="as in the study", title=f"as in the study: {base:.4f}"
    )
    return _panel(rows, Axis("θ_max/α", max(0.0, low - room), high + room), [*marks, study], caption)


def _indices(rows: "pd.DataFrame", caption: str) -> Panel:
    ordered = rows.sort_values("total", ascending=False, kind="stable")
    whiskers = [ordered[name] + sign * ordered[f"{name}_error"] for name in INDICES for sign in (-1, 1)]
    x = spanning("Sobol index", np.concatenate([np.nan_to_num(column.to_numpy(float)) for column in whiskers]))
    marks = [mark for place, row in enumerate(as_dicts(ordered)) for mark in _of_input(row, len(ordered), place)]
    return _panel(ordered, x, [*marks, Rule("x", np.zeros(1), look=Look("edge"))], caption)


def _of_input(row: Entry, count: int, place: int) -> Iterator[Mark]:
    for way, (name, words) in enumerate(INDICES.items()):
        value, error, y = row[name], row[f"{name}_error"], _height(count, place, way)
        if not np.isnan(value):
            yield _bar(0.0, value, y, way, words)
            ends = np.array([value - error, value + error])
            yield Polyline(ends, np.full(2, y), look=Look("bar"), title=f"{value:.3f} ± {error:.3f}")


def _height(count: int, place: int, way: int) -> float:
    """Return the height of the first or second bar of an input, from the top."""
    return count - place - 0.5 + (0.5 - way) * BAR


def _bar(start: float, end: float, y: float, way: int, label: str) -> Area:
    half = 0.5 * BAR
    outline = np.array([start, end, end, start]), np.array([y - half, y - half, y + half, y + half])
    return Area(*outline, look=Look("filled", way + 1), label=label)


def _panel(rows: "pd.DataFrame", x: Axis, marks: Sequence[Mark], caption: str) -> Panel:
    """Return a panel with a row for each input, from the top."""
    names = {len(rows) - place - 0.5: symbol(name) for place, name in enumerate(rows["parameter"])}
    y = Axis("", 0.0, float(len(rows)), names=names)
    return Panel(replace(x, about=5), y, marks, caption, width=420.0, height=ROW * len(rows))


def written(value: object) -> str:
    """Format an end of a range, which may be text, since columns of the table hold numbers and words."""
    try:
        return number(float(str(value)))
    except ValueError:
        return str(value)
