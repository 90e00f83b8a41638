"""Figures of rocking spectra, as curves, and of overturning maps, as regions."""

import math
from collections.abc import Iterable, Iterator

import numpy as np

from rockbatch.analyses.spectrum.map_regions import (
    FLIGHT,
    OUTRIGHT,
    UNDECIDED,
    WITH_IMPACT,
    Outline,
    areas,
    between,
    inside,
    strips,
)
from rockbatch.common.analyses import Entry
from rockbatch.common.figures.description import COLOURS, Area, Axis, Figure, Look, Mark, Panel, Points, Polyline, Span
from rockbatch.common.lazy import pd
from rockbatch.quantities.labels import quantity
from rockbatch.reporting.finished_analysis import named
from rockbatch.reporting.labels import symbol

ROW = 0.06
"""Height of a row of marks of overturned runs over that of the axes: one for each slenderness, or they would hide each other."""
MOST_RECORDS = 60
"""Most curves of single records in a panel."""
ACROSS = {"size_m": "R_0 [m]", "omega_g_over_p": "ω_g/p,  ω_g = PGA/PGV"}
"""Labels of axes, where they are not symbol and unit."""
QUANTILES = {"median": 0, "p16": 2, "p84": 1}
"""Dashes of the statistics of the suite."""
FELL = "overturned or ended by flight"
FELL_P84 = "likewise, 84 % quantile alone"
REGIONS = {
    WITH_IMPACT: (2, "overturns after an impact or more (mode 1)"),
    OUTRIGHT: (1, "overturns without impact (mode 2)"),
    FLIGHT: (3, "leaves the ground with both pivots: the run ends"),
    UNDECIDED: (4, "not decided: the run did not settle"),
}
"""Colour and words of each region of a map; none where the pier stands."""


def spectra(suite: "pd.DataFrame", records: "pd.DataFrame | None", info: Entry, axis: str | None = None) -> Figure:
    """Return a figure of the largest rotation over the size of the pier, a panel for each case, scale and value but α.

    ``suite`` is spectrum_suite.csv, ``records`` spectrum.csv, whose curves are drawn in suites of several motions; ``info`` is
    spectrum.json, ``axis`` a column in place of its own.
    """
    keys = ("case", *(() if info["axis"] == "omega_g_over_p" else ("scale",)), *info["varied"])
    apart = [name for name in keys if name not in ("alpha", info["axis"])]
    varying = [name for name in apart if name == "case" or suite[name].nunique(dropna=False) > 1]
    many = bool((suite["count"] > 1).any())
    singly = {} if records is None else dict(list(records.groupby(apart, sort=False, dropna=False)))
    panels = []
    for names, runs in suite.groupby(apart, sort=False, dropna=False):
        caption = named(info, dict(zip(apart, names, strict=True)), varying)
        panels.append(_spectrum(runs, singly.get(names) if many else None, axis or info["axis"], many, caption))
    return Figure(panels, "Rocking spectra")


def _spectrum(suite: "pd.DataFrame", records: "pd.DataFrame | None", axis: str, many: bool, caption: str) -> Panel:
    """Return the spectra of a case, a curve for each slenderness."""
    names = list(QUANTILES) if many else ["median"]
    values = suite[names].to_numpy(float)
    top = 1.08 * (float(values[np.isfinite(values)].max(initial=0.0)) or 1.0)
    curves = [] if records is None else list(_of_records(records, axis, top))
    slendernesses = list(suite.groupby("alpha", sort=False))
    y = Axis("θ_max/α", 0.0, top * (1.0 + ROW * (len(slendernesses) + 0.5)), about=6, last=top)
    marks: list[Mark] = [Span("y", top, y.high, look=Look("band")), *curves]
    for place, (alpha, of_alpha) in enumerate(slendernesses):
        colour, words = place % COLOURS + 1, quantity("alpha", float(str(alpha)))
        x = of_alpha[axis].to_numpy(float)
        for name in names:
            up = of_alpha[name].to_numpy(float)
            label = words + ", median" * many if name == "median" else ""
            marks.append(
                Polyline(
                    x, np.where(np.isfinite(up), up, np.nan), look=Look("level", colour, QUANTILES[name]), label=label
                )
            )
        fell = {name: np.isinf(of_alpha[name].to_numpy(float)) for name in names}
        some = fell.get("p84", fell["median"]) & ~fell["median"]
        for which, alone, label in ((fell["median"], False, FELL), (some, True, FELL_P84)):
            if which.any():
                height = np.full(np.count_nonzero(which), top * (1.0 + ROW * (place + 0.75)))
                look = Look("", colour, shape="overturned", open=alone)
                marks.append(Points(x[which], height, title=f"{words}: ∞", look=look, label=label))
    x = suite[axis].to_numpy(float)
    across = Axis(ACROSS.get(axis, symbol(axis)), float(x.min()), float(x.max()), about=8)
    return Panel(across, y, marks, caption, width=420.0, height=190.0)


def _of_records(records: "pd.DataFrame", axis: str, top: float) -> Iterator[Polyline]:
    """Yield a curve for each record up to ``top``, with gaps where the pier overturns; none if they are over MOST_RECORDS."""
    keys = ["alpha", "record", "polarity"]
    groups = records.groupby(keys, sort=False)
    for _, of_record in groups if groups.ngroups <= MOST_RECORDS else ():
        theta = of_record["theta_max_over_alpha"].where(of_record["status"] == "ok").to_numpy(float)
        yield Polyline(
            of_record[axis].to_numpy(float),
            np.where(theta <= top, theta, np.nan),
            look=Look("faint"),
            label="each record",
        )


def maps(regions: "pd.DataFrame", info: Entry) -> Figure:
    """Return a figure of the regions of amplitude over frequency in overturning_map.csv, with their boundaries, as they were
    computed, a panel for each map and case; ``info`` is spectrum.json."""
    apart = ["map", "case", *info["varied_map"]]
    shapes = {pulse["name"]: pulse["shape"] for pulse in info["maps"]}
    panels = []
    for names, of_map in regions.groupby(apart, sort=False, dropna=False):
        values = dict(zip(apart, names, strict=True))
        caption = f"{values['map']} ({shapes[values['map']]}), {named(info, values, apart[1:])}"
        panels.append(_map(of_map, caption, f"{of_map['omega_p_over_p'].nunique()} frequencies"))
    return Figure(panels, "Overturning maps")


def _map(regions: "pd.DataFrame", caption: str, note: str) -> Panel:
    shown = strips(regions)
    marks: list[Mark] = []
    for outcome, (colour, words) in REGIONS.items():
        if any(outcome in strip.outcomes for strip in shown):
            marks.append(Area(*_together(areas(shown, outcome)), look=Look("filled", colour), label=words))
    boundaries = [*inside(shown), *between(shown)]
    marks.append(Polyline(*_together(boundaries), label="boundary; white: the pier stays upright"))
    x = Axis("ω_p/p", float(shown[0].frequencies[0]), float(shown[-1].frequencies[-1]), about=8)
    y = Axis("a_p/(g tan α)", float(regions["low"].min()), float(regions["high"].max()), about=8)
    return Panel(x, y, marks, caption, note, width=420.0, height=256.0)


def _together(lines: Iterable[Outline]) -> Outline:
    """Return lines as one, with gaps, or a hair of background would show where two strips meet."""
    gap = np.array([math.nan])
    pieces = [(np.append(x, gap), np.append(y, gap)) for x, y in lines] or [(gap, gap)]
    x, y = (np.concatenate(coordinates) for coordinates in zip(*pieces, strict=True))
    return x, y
