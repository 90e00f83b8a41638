"""Figures of a design: demand over limit of every check against the value, and the map of what passes."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np

from rockbatch.analyses.design.answer import by_design, plain
from rockbatch.analyses.design.search import REFUSED
from rockbatch.checks.verdicts import FAIL, NOT_DECIDED, PASS
from rockbatch.checks.wording import percent
from rockbatch.common.analyses import Entry
from rockbatch.common.figures.description import (
    COLOURS,
    Area,
    Axis,
    Figure,
    Look,
    Mark,
    Panel,
    Points,
    Polyline,
    Rule,
    Span,
    marks_of,
)
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.quantities.cases import Case
from rockbatch.quantities.labels import OfDevice, symbol_of
from rockbatch.reporting.finished_analysis import case_of
from rockbatch.results.labelled import as_dicts
from rockbatch.study.design_bounds import parted

HIGHEST = 2.0
"""Greatest demand over limit on the axis; greater ones are drawn above it."""
ROW = 0.05
"""Height of a row of marks above the axis, over that of the axis."""

ROOM = 0.03
"""Room beside both ends of the scan, over its range."""

OTHER = {NOT_DECIDED: "not decided", REFUSED: "the study is refused"}
"""Words of what neither passes nor fails in a map."""


def figure_of(info: Entry, intervals: "pd.DataFrame", values: "pd.DataFrame", checks: "pd.DataFrame") -> Figure:
    """Return the figure of a design with one key, or the map of one with two."""
    rows, tried = as_dicts(intervals), as_dicts(values)
    return maps(info, tried) if len(info["vary"]) > 1 else ratios(info, rows, as_dicts(checks))


def axis_label(path: str, case: Case | None = None) -> str:
    """Return the label of the axis of a key: "damper: F [kN]" of "case.damper.force_kN".

    ``case`` supplies the exponent in a viscous damper's unit.
    """
    _, *tables, name = path.split(".")
    kind, number = parted(tables[0]) if tables else ("", "")
    letter, unit = OfDevice(kind, int(number or 1), name).symbol(case) if kind else symbol_of(name, case)
    words = f"{' '.join(filter(None, (kind.replace('_', ' '), number)))}: " if kind else ""
    return words + (f"{letter} [{unit}]" if unit else letter.replace("_", " ") if letter == name else letter)


def axis_of(varied: Entry, case: Case | None) -> Axis:
    """Return the axis of a key of a case over its scan, with room for marks at its ends."""
    room = ROOM * (varied["high"] - varied["low"])
    return Axis(axis_label(varied["path"], case), varied["low"] - room, varied["high"] + room, about=6)


def _case(info: Entry, rows: Sequence[Entry]) -> Case | None:
    """Return the case of a design by its rows; None without rows, or if an exponent in units is itself varied."""
    if not rows or any(varied["path"].endswith(".exponent") for varied in info["vary"]):
        return None
    columns = {name: rows[0][name] for name in info["varied"] if rows[0][name] == rows[0][name]}
    return case_of(info, rows[0]["case"], columns)


def ratios(info: Entry, intervals: Sequence[Entry], checks: Sequence[Entry]) -> Figure:
    """Return a figure of demand over limit of every check, the worst of its bounds, against the value: a panel each design."""
    judged = by_design(info, [row for row in checks if row["ratio"] == row["ratio"]])
    finite = [row["ratio"] for rows in judged.values() for row in rows if np.isfinite(row["ratio"])]
    top = min(1.08 * max(finite, default=1.0), HIGHEST)
    panels = [
        _ratios(info, label, rows, judged[label], max(top, 1.2)) for label, rows in by_design(info, intervals).items()
    ]
    return Figure(panels, "Demand over limit of every check against the value")


def _ratios(info: Entry, label: str, intervals: Sequence[Entry], checks: Sequence[Entry], top: float) -> Panel:
    """Return the panel of a design: a line for each check, over strips where all pass."""
    vary, by_check = info["vary"][0], grouped(checks, lambda row: row["check"])
    high = top * (1.0 + ROW * (len(by_check) + 0.5))
    marks: list[Mark] = [Span("y", top, high, look=Look("band"))]
    for row in (row for row in intervals if row["verdict"] == PASS):
        words = f"all checks pass from {plain(row['low'])} to {plain(row['high'])}"
        x, y = np.array([row["low"], row["high"]]), np.zeros(2)
        marks.append(
            Area(
                x[[0, 1, 1, 0]],
                np.array([0.0, 0.0, top, top]),
                look=Look("area", 3),
                label="all checks pass",
                title=words,
            )
        )
        marks.append(Points(x, y, titles=[words] * 2, look=Look("", 3, shape="square")))
    for place, (check, rows) in enumerate(by_check.items()):
        marks += _of_check(vary["path"], place, check, rows, top)
    marks.append(Rule("y", np.ones(1), look=Look("limit"), label="limit", title="limit"))
    x_axis = axis_of(vary, _case(info, intervals))
    return Panel(
        x_axis, Axis("demand over limit", 0.0, high, about=5, last=top), marks, label, width=460.0, height=210.0
    )


def _of_check(path: str, place: int, check: str, rows: Sequence[Entry], top: float) -> Iterator[Mark]:
    """Yield the line of a check with its marks, open where it is not decided; those beyond the axis in a row above it."""
    worst = {
        value: max(of_value, key=lambda row: row["ratio"])
        for value, of_value in grouped(rows, lambda row: row[path]).items()
    }
    x = np.array(sorted(worst))
    ratio = np.array([worst[value]["ratio"] for value in x.tolist()])
    titles = [f"{plain(value)}: {_in_words(worst[value])}" for value in x.tolist()]
    within = ratio <= top
    colour = place % COLOURS + 1
    yield Polyline(x, np.where(within, ratio, np.nan), look=Look("level", colour, place // COLOURS), label=check)
    height = np.where(within, ratio, top * (1.0 + ROW * (place + 0.75)))
    open_ = np.array([worst[value]["verdict"] == NOT_DECIDED for value in x.tolist()])
    for is_open in (False, True):
        chosen = open_ == is_open
        if chosen.any():
            shown = [title for title, one in zip(titles, chosen.tolist(), strict=True) if one]
            yield Points(x[chosen], height[chosen], titles=shown, look=marks_of(place, is_open), label=check)


def _in_words(row: Entry) -> str:
    """Return a verdict in words, for a tooltip: "drift 101 % under soft ground, fail"; without its bound if it has none."""
    bound = f" under {row['bound']}" if row.get("bound") and row["bound"] == row["bound"] else ""
    return f"{row['check']} {percent(row['ratio'])}{bound}, {row['verdict']}".replace("\u00a0", " ")


def maps(info: Entry, values: Sequence[Entry]) -> Figure:
    """Return a figure of what passes over two keys: a panel for each design, with the check that governs as colour."""
    checks = {name: place for place, name in enumerate(info["checks"])}
    panels = [_map(info, label, rows, checks) for label, rows in by_design(info, values).items()]
    return Figure(panels, "Passing values, and the check that governs")


def _map(info: Entry, label: str, values: Sequence[Entry], checks: Mapping[str, int]) -> Panel:
    """Return the map of a design: points where all checks pass, filled cells about all other values that were run."""
    up, across = info["vary"]
    cells: dict[tuple[str, str], list[tuple[float, float, float, float]]] = {}
    points: dict[str, list[Entry]] = {}
    for middle, rows in grouped(values, lambda row: row[across["path"]]).items():
        left, right = max(middle - across["step"] / 2, across["low"]), min(middle + across["step"] / 2, across["high"])
        edges = [up["low"], *(0.5 * (one[up["path"]] + next_[up["path"]]) for one, next_ in pairwise(rows)), up["high"]]
        for row, (low, high) in zip(rows, pairwise(edges), strict=True):
            if row["verdict"] == PASS:
                points.setdefault(row["check"], []).append(row)
            else:
                named = row["check"] if row["verdict"] == FAIL else ""
                cells.setdefault((row["verdict"], named), []).append((left, right, low, high))
    marks: list[Mark] = []
    for (verdict, check), boxes in cells.items():
        look = (
            Look("filled", checks[check] % COLOURS + 1)
            if check in checks
            else Look("band" if verdict == REFUSED else "unsure")
        )
        words = f"{check} fails" if verdict == FAIL else OTHER[verdict]
        marks.append(Area(*_outlines(boxes), look=look, label=words, title=words))
    for check, rows in points.items():
        x, y = (np.array([row[axis["path"]] for row in rows]) for axis in (across, up))
        titles = [f"passes, {check} at {percent(row['ratio'])} of its limit".replace("\u00a0", " ") for row in rows]
        marks.append(
            Points(
                x,
                y,
                titles=titles,
                look=Look("", checks.get(check, 0) % COLOURS + 1),
                label=f"passes, closest: {check}",
            )
        )
    case = _case(info, values)
    return Panel(axis_of(across, case), axis_of(up, case), marks, label, width=460.0, height=260.0)


def _outlines(boxes: Sequence[tuple[float, float, float, float]]) -> tuple[np.ndarray, np.ndarray]:
    """Return x and y of the outlines of boxes (left, right, low, high), with NaN after each."""
    x = [value for left, right, *_ in boxes for value in (left, right, right, left, np.nan)]
    y = [value for *_, low, high in boxes for value in (low, low, high, high, np.nan)]
    return np.array(x), np.array(y)
