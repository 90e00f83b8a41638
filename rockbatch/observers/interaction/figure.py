"""Envelopes of moment or shear over the axial force of the same moment, and the capacity there."""

from collections.abc import Iterable, Sequence

import numpy as np

from rockbatch.checks import Verdict
from rockbatch.checks.capacity import Curve, resistance
from rockbatch.common.figures.description import Axis, Figure, Look, Mark, Panel, Polyline, line_of, spanning
from rockbatch.common.lazy import pd
from rockbatch.observers.interaction.envelopes import envelope
from rockbatch.quantities.statistics import Values
from rockbatch.results.labels import Series

BEYOND = 0.3
"""Share of the axial forces by which a curve is drawn beyond them."""


def over_axial_force(checks: "Iterable[tuple[Verdict, pd.DataFrame]]", series: Sequence[Series]) -> Figure:
    """Return a panel for each check of a capacity: the capacity, and the envelope of each case over all of its runs.

    ``checks`` are verdicts, of any case, with the rows of interaction.csv of their section or base; the column "series" of these
    rows has indices of ``series``.
    """
    panels = [_panel(verdict, rows, series) for verdict, rows in checks]
    return Figure(panels, "Envelopes of moment or shear over the axial force, and the capacity")


def _panel(verdict: Verdict, rows: "pd.DataFrame", series: Sequence[Series]) -> Panel:
    effect, words = ("shear_kN", "V [kN]") if rows["height_m"].isna().all() else ("moment_kNm", "M [kN m]")
    n, e = _drawn(verdict.curve, rows["axial_kN"].to_numpy(np.float64))
    marks: list[Mark] = [Polyline(n, e, look=Look("limit"), label="capacity", title=f"capacity, {verdict.check}")]
    for place in sorted(rows["series"].unique()):
        own = rows[rows["series"] == place]
        of = envelope(None, own["axial_kN"].to_numpy(np.float64), own[effect].to_numpy(np.float64))
        name = series[place].label
        marks.append(Polyline(of.axial, of.effect, look=line_of(series[place].index), label=name, title=name))
    x, y = (_axis(label, marks, along) for label, along in (("N [kN]", "x"), (words, "y")))
    return Panel(x, y, marks, verdict.check, _place(verdict), 330.0, 220.0)


def _place(verdict: Verdict) -> str:
    """Return where a check reads its demand: "section at 12 m", or "base"."""
    return "base" if np.isnan(verdict.at_m) else f"section at {verdict.at_m:g} m"


def _axis(label: str, marks: Sequence[Mark], along: str) -> Axis:
    return spanning(label, *(getattr(mark, along) for mark in marks))


def _drawn(curve: Curve, axial: Values) -> tuple[Values, Values]:
    """Return N and the resistance of a curve between the least ``axial`` force, or 0 if that is less, and the greatest.

    Both have shape (k,), and go on by BEYOND, 0.3, of the greatest |N|, but not beyond the ends of the curve.
    """
    room = BEYOND * max(float(np.abs(axial).max()), 1.0)
    low, high = max(min(axial.min(), 0.0) - room, curve[0][0]), min(axial.max() + room, curve[-1][0])
    inner = [point[0] for point in curve if low < point[0] < high]
    n = np.array([low, *inner, high])
    return n, resistance(curve, n)
