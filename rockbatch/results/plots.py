"""Figures of finished results with matplotlib, for notebooks and papers; the report draws its own.

The peaks as in Palmeri & Makris (2007), Fig. 7, and their distribution over a suite. Imported when one is drawn.
"""

import math
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatter

from rockbatch.common.figures import figure, line, marks, styled
from rockbatch.common.lazy import pd
from rockbatch.errors import InputError
from rockbatch.results.beside_peaks import case_key
from rockbatch.results.rows import counts_as, simulated, with_case
from rockbatch.results.suite_statistics import NO_PEAK, distribution, worst_records
from rockbatch.study import PIER_KEYS

MOST_PANELS = 24
PANEL_MM = 42.0
"""Least width of a panel, and its height [mm]."""

TITLE = 0.52
"""Letters in a line of a title or of the axis, for each millimetre of a panel."""

INSTEAD = {
    "overturned": ("X", "overturned"),
    "flight": ("^", "left the ground"),
    "failed": ("$?$", "failed, see reason"),
}
"""Markers, and their words, of runs without a largest rotation; they stand above the axis' values."""

SPREAD = 0.4
"""Share of the distance of two foundations, over which marks of different piers and scales are spread."""


@dataclass(frozen=True)
class _Panels:
    """Properties that all panels share: places of foundations, piers and scales, rigid bases with lines, the top of the axis."""

    places: dict[str, int]
    groups: list[str]
    lines: list[str]
    top: float
    without_peak: bool
    crowded: bool

    def draw(self, axes: Axes, runs: "pd.DataFrame") -> None:
        """Draw the runs of one record."""
        if self.without_peak:
            axes.axhspan(self.top, 1.15 * self.top, color="0.9", label="no greatest rotation")
        axes.set(xlim=(-0.7, len(self.places) - 0.3), ylim=(0, (1.15 if self.without_peak else 1.0) * self.top))
        axes.set_xticks(list(self.places.values()), list(self.places), rotation=90 if self.crowded else 0)
        for group, of_group in runs.groupby("group", sort=False):
            place = self.groups.index(str(group))
            shift = SPREAD * ((place + 0.5) / len(self.groups) - 0.5)
            style = marks(place)
            stood = of_group[of_group["status"] == "ok"]
            springs = stood[~stood["rigid"]]
            x, error = (
                springs["foundation"].map(self.places) + shift,
                springs["theta_max_error"].fillna(0.0),
            )
            axes.errorbar(x, springs["theta_max_over_alpha"], error, label=group or None, **style)
            for name, theta in stood[stood["rigid"]][["foundation", "theta_max_over_alpha"]].itertuples(index=False):
                label = ", ".join(filter(None, (name, str(group))))
                axes.axhline(theta, label=label, **line(self.lines.index(name) * len(self.groups) + place))
            for status, (marker, words) in INSTEAD.items():
                places = of_group["foundation"][of_group["status"] == status].map(self.places).fillna(-0.6) + shift
                if len(places):
                    height = [1.07 * self.top] * len(places)
                    axes.plot(places, height, **style | {"marker": marker}, label=words)


@styled
def plot(peaks: "pd.DataFrame", info: Mapping[str, Any], width_mm: float) -> Figure:
    """See :meth:`rockbatch.results.opened.Results.plot`, which hands over peaks.csv and run.json.

    Of many records, the :data:`MOST_PANELS` with the worst runs have a panel, in order of peak ground acceleration. Raises
    ``InputError`` without any runs.
    """
    runs = _runs(peaks, info)
    if runs.empty:
        raise InputError("there are no runs to plot: no record could be used, as the column reason of peaks.csv says")
    records, every = _records(runs, info), runs["record"].nunique()
    columns = max(1, min(int(width_mm / PANEL_MM), len(records)))
    panels = _panels(runs[runs["record"].isin(records)], width_mm / columns)
    rows = math.ceil(len(records) / columns)
    drawn = figure(width_mm, 24.0 + PANEL_MM * rows)
    grid = drawn.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    labels = {record["record"]: record.get("label") for record in info["records"]}
    for axes, name in zip(grid.flat, records, strict=False):
        panels.draw(axes, runs[runs["record"] == name])
        axes.set_title(textwrap.fill(labels.get(name) or name, int(TITLE * width_mm / columns)), fontsize=7.0)
    for axes in grid.flat[len(records) :]:
        axes.set_visible(False)
    for axes in grid.flat[max(len(records) - columns, 0) : len(records)]:
        axes.tick_params(labelbottom=True)
    shown = f" ({len(records)} of {every} records, the worst)" if len(records) < every else ""
    drawn.suptitle(info["study"]["title"] + shown)
    drawn.supylabel(r"$\theta_{\max}/\alpha$")
    _legend(drawn, columns)
    return drawn


def _runs(peaks: "pd.DataFrame", info: Mapping[str, Any]) -> "pd.DataFrame":
    """Return the rows that were simulated, each with its ``foundation`` in words, True for a ``rigid`` one, and its ``group``:
    the varied values of its pier, and its scale."""
    runs = simulated(with_case(peaks))
    varied = info["varied"]
    rigid = {case["case"] for case in info["cases"] if case["base"] == "rigid"}
    if len(rigid) == len({case["case"] for case in info["cases"]}):
        rigid = set()  # no springs to compare with: they are foundations like others
    of_pier = [
        name for name in (*varied, "scale") if name in PIER_KEYS or (name == "scale" and runs[name].nunique() > 1)
    ]
    of_base = [name for name in varied if name not in PIER_KEYS]
    return runs.assign(
        foundation=_words(runs, ["case", *of_base]), rigid=runs["case"].isin(rigid), group=_words(runs, of_pier)
    )


def _words(runs: "pd.DataFrame", names: Sequence[str]) -> list[str]:
    """Return the values of columns ``names`` in words, for each run; those that do not apply are left out."""
    columns = [[_named(name, value) for value in runs[name]] for name in names]
    return [", ".join(filter(None, words)) for words in zip(*columns, strict=True)] if columns else [""] * len(runs)


def _named(name: str, value: object) -> str:
    """Return "beta = 40"; a case without the word, and empty for a value that does not apply."""
    written = f"{value:g}" if isinstance(value, float) else str(value)
    return "" if value != value else written if name == "case" else f"{name} = {written}"


def _records(runs: "pd.DataFrame", info: Mapping[str, Any]) -> list[str]:
    """Return the records that have a panel, in order of their PGA: all, or those with the worst runs."""
    pga = {record["record"]: record["pga_g"] for record in info["records"]}
    return sorted(worst_records(runs, MOST_PANELS), key=lambda name: (pga.get(name, math.inf), name))


def _panels(runs: "pd.DataFrame", panel_mm: float) -> _Panels:
    stood = runs[runs["status"] == "ok"]
    highest = float((stood["theta_max_over_alpha"] + stood["theta_max_error"].fillna(0.0)).max())
    foundations = [str(name) for name in runs["foundation"][~runs["rigid"]].unique()]
    return _Panels(
        places={name: place for place, name in enumerate(foundations)},
        groups=[str(group) for group in runs["group"].unique()],
        lines=list(runs["foundation"][runs["rigid"]].unique()),
        top=1.1 * highest if highest > 0 else 1.0,
        without_peak=bool(runs["status"].isin(INSTEAD).any()),
        crowded=TITLE * panel_mm < sum(map(len, foundations)),
    )


def _legend(figure: Figure, columns: int) -> None:
    """Draw the legend of lines, colours and markers, once for all panels."""
    entries: dict[str, Artist] = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            entries.setdefault(label, handle)
    if entries:
        figure.legend(list(entries.values()), list(entries), loc="outside lower center", ncols=columns)


@styled
def plot_cdf(peaks: "pd.DataFrame", varied: Sequence[str], count: str, width_mm: float) -> Figure:
    """See :meth:`rockbatch.results.opened.Results.plot_cdf`, which hands over the rows of peaks.csv, the varied keys,
    and what counts as one record."""
    runs = simulated(with_case(peaks))
    keys = [name for name in ("case", *varied, "scale") if name == "case" or runs[name].nunique() > 1]
    groups = runs.groupby(keys, sort=False, dropna=False)
    drawn = figure(width_mm, 0.5 * width_mm + 12.0 + 3.6 * math.ceil(len(groups) / 2))
    axes = drawn.subplots()
    largest = float(runs["theta_max_over_alpha"].where(runs["status"] == "ok").max())
    right = 1.06 * largest if largest > 0 else 1.0
    for place, (values, group) in enumerate(groups):
        theta, share = distribution(
            group["theta_max_over_alpha"].to_numpy(dtype=float),
            group["status"].to_list(),
            counts_as(group, count)[0].to_list(),
        )
        label = ", ".join(filter(None, map(_named, keys, values)))
        reached = [0.0, *share, share[-1] if len(share) else 0.0]
        style = line(place)
        axes.step([0.0, *theta, right], reached, where="post", label=label, **style)
        if group["status"].isin(NO_PEAK).any():
            axes.plot(right, reached[-1], "x", color=style["color"], clip_on=False)
    share_of = "share of the records\nthat do not exceed it"
    axes.set(xlabel=r"$\theta_{\max}/\alpha$", ylabel=share_of, xlim=(0, right), ylim=(0, 1.01))
    drawn.legend(loc="outside lower center", ncols=2)
    return drawn


@styled
def plot_self_similar(peaks: "pd.DataFrame", info: Mapping[str, Any], width_mm: float) -> Figure:
    """See :meth:`rockbatch.results.opened.Results.plot`, which hands over peaks.csv and run.json.

    Raises ``InputError`` without any runs under ground that moves.
    """
    runs = _with_groups(_runs(peaks, info), info)
    if runs.empty:
        raise InputError("there are no runs to plot: no record could be used, as the column reason of peaks.csv says")
    names = list(runs["foundation"].unique())
    columns = max(1, min(int(width_mm / (1.5 * PANEL_MM)), len(names)))
    rows = math.ceil(len(names) / columns)
    drawn = figure(width_mm, 24.0 + 1.3 * PANEL_MM * rows)
    grid = drawn.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    moved = runs[(runs["status"] == "ok") & (runs["theta_max_over_alpha"] > 0)]["theta_max_over_alpha"]
    norm = LogNorm(*((moved.min(), max(moved.max(), 1.001 * moved.min())) if len(moved) else (0.1, 1.0)))
    for axes, name in zip(grid.flat, names, strict=False):
        _scatter(axes, runs[runs["foundation"] == name], norm)
        axes.set_title(textwrap.fill(name, int(TITLE * width_mm / columns)), fontsize=7.0)
    for axes in grid.flat[len(names) :]:
        axes.set_visible(False)
    for axes in grid.flat[max(len(names) - columns, 0) : len(names)]:
        axes.tick_params(which="both", labelbottom=True)
        axes.set_xlabel(r"$\omega_g/p$,  $\omega_g$ = PGA/PGV")
    drawn.suptitle(info["study"]["title"])
    drawn.supylabel(r"PGA/($g\,\tan\alpha$)")
    if len(moved):
        drawn.colorbar(ScalarMappable(norm, "cividis"), ax=list(grid.flat), label=r"$\theta_{\max}/\alpha$")
    _legend(drawn, columns)
    return drawn


def _scatter(axes: Axes, runs: "pd.DataFrame", norm: LogNorm) -> None:
    """Draw the runs of one foundation."""
    axes.axhline(1.0, color="0.5", linewidth=0.8, linestyle="--", label="lifts a pier off rigid ground")
    stood = runs["status"] == "ok"
    still = stood & ~(runs["theta_max_over_alpha"] > 0)
    moved = runs[stood & ~still]
    axes.scatter(moved["frequency"], moved["intensity"], 14.0, moved["theta_max_over_alpha"], norm=norm, cmap="cividis")
    if still.any():
        axes.plot(
            runs["frequency"][still], runs["intensity"][still], "o", color="0.6", mfc="none", label="did not move"
        )
    for status, (marker, words) in INSTEAD.items():
        of_status = runs[runs["status"] == status]
        if len(of_status):
            axes.plot(of_status["frequency"], of_status["intensity"], marker, color="#D55E00", label=words)
    axes.set(xscale="log", yscale="log")
    for along in (axes.xaxis, axes.yaxis):
        along.set_major_formatter(LogFormatter(labelOnlyBase=False))
        along.set_minor_formatter(LogFormatter(minor_thresholds=(1.5, 0.8)))


def _to_12_digits(value: float) -> float:
    return float(f"{value:.12g}")


def _with_groups(runs: "pd.DataFrame", info: Mapping[str, Any]) -> "pd.DataFrame":
    """Return the runs with ω_g/p (``frequency``) and PGA/(g tan α) (``intensity``), of those under ground that moves.

    To 12 digits: an axis cannot be as narrow as rounding.
    """
    varied = info["varied"]
    piers = {case_key(case["case"], case["columns"], varied): case["pier"] for case in info["cases"]}
    ground = {record["record"]: (record["pga_g"], record["pgv_m_s"]) for record in info["records"]}
    frequency, intensity = [], []
    for cells in runs[["case", "record", "scale", *varied]].to_dict("records"):
        row = {str(name): value for name, value in cells.items()}
        pier = piers[case_key(row["case"], row, varied)]
        pga, pgv = ground[row["record"]]
        frequency.append(pga * pier["gravity"] / (pgv * pier["p"]) if pgv else math.nan)
        intensity.append(row["scale"] * pga / math.tan(pier["alpha"]))
    table = runs.assign(
        frequency=[_to_12_digits(x) for x in frequency], intensity=[_to_12_digits(x) for x in intensity]
    )
    return table[table["frequency"] > 0]
