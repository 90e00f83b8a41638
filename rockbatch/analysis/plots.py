"""Figures of the analyses, for notebooks and papers; the report draws its own. Loads matplotlib: imported where one is drawn."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from rockbatch.analysis.fragility_curves import Curve
from rockbatch.common.figures import COLOURS, figure, line, marks, styled
from rockbatch.common.lazy import pd
from rockbatch.report.drawing import overturning_map
from rockbatch.study.spectrum import INTENSITY, SELF_SIMILAR

_PLACES = {"overturned without impact": 0, "overturned with impact": 1, "flight": 2, "undecided": 3}
"""Places of the colours of regions of a map, as in the report."""


@styled
def fragility(table: "pd.DataFrame", curves: Sequence[Curve], width_mm: float) -> Figure:
    """See :meth:`rockbatch.analysis.fragility.Fragility.plot`."""
    limits = list(dict.fromkeys(curve.limit.name for curve in curves))
    names = list(dict.fromkeys(map(_case, curves)))
    drawn, grid = _panels(len(limits), width_mm)
    levels = np.linspace(0.0, table["level"].max(), 201)[1:]
    for curve in curves:
        axes, place = grid[limits.index(curve.limit.name)], names.index(_case(curve))
        chosen = {"case": curve.case.name, "limit_state": curve.limit.name} | curve.case.columns
        rows = table[(table[list(chosen)] == pd.Series(chosen)).all(axis=1)]
        share = rows["exceeded"] / (rows["n"] - rows["undecided"])
        axes.plot(rows["level"], share, **marks(place), label=f"{names[place]}, records")
        if not isinstance(curve.fitted, str):
            axes.plot(levels, curve.fitted.probability(levels), label=names[place], **line(place))
        if curve.windows and not isinstance(curve.windows.fitted, str):
            by_shares = line(place) | {"linestyle": "-."}
            axes.plot(levels, curve.windows.fitted.probability(levels), label=f"{names[place]}, by shares", **by_shares)
    for axes, limit in zip(grid, limits, strict=True):
        axes.set(xlabel=f"{table['measure'].iloc[0]} [{table['unit'].iloc[0]}]", ylim=(0, 1.01), title=limit)
    grid[0].set_ylabel("probability that it is exceeded")
    return _with_legend(drawn, grid)


def _case(curve: Curve) -> str:
    return ", ".join([curve.case.name, *(f"{key} = {value}" for key, value in curve.case.columns.items())])


@styled
def spectrum(
    spectra: "pd.DataFrame | None",
    suite: "pd.DataFrame | None",
    maps: "pd.DataFrame | None",
    axis: str,
    width_mm: float,
) -> Figure:
    """See :meth:`rockbatch.analysis.spectrum.Spectrum.plot`."""
    of_spectra: list[Any] = []
    apart = INTENSITY if axis == SELF_SIMILAR else "alpha"
    if spectra is not None and suite is not None:
        lines = dict(list(spectra.groupby(["case", apart], sort=False)))
        of_spectra = [(key, lines[key], median) for key, median in suite.groupby(["case", apart], sort=False)]
    apart_maps = [] if maps is None else list(maps.columns[: list(maps.columns).index("omega_p_over_p")])
    of_maps: list[Any] = [] if maps is None else list(maps.groupby(apart_maps, sort=False, dropna=False))
    drawn, grid = _panels(len(of_spectra) + len(of_maps), width_mm)
    for axes, ((case, value), lines_of_case, median) in zip(grid, of_spectra, strict=False):
        _spectrum(axes, lines_of_case, median, axis)
        axes.set_title(rf"{case}, {SYMBOLS[apart]} = {value:g}")
    for axes, (names, regions) in zip(grid[len(of_spectra) :], of_maps, strict=True):
        _map(axes, regions)
        varied = (f"{key} = {value}" for key, value in zip(apart_maps[2:], names[2:], strict=True) if value == value)
        axes.set_title(", ".join([*names[:2], *varied]))
    return _with_legend(drawn, grid)


SYMBOLS = {
    "two_pi_over_p_s": r"$2\pi/p$ [s]", "p": "$p$ [rad/s]", "size_m": "$R_0$ [m]", "alpha": r"$\alpha$",
    SELF_SIMILAR: r"$\omega_g/p$,  $\omega_g$ = PGA/PGV", INTENSITY: r"PGA/($g\,\tan\alpha$)",
}  # fmt: skip
"""Axes and parameters of spectra as matplotlib writes them."""


def _spectrum(axes: Axes, spectra: "pd.DataFrame", suite: "pd.DataFrame", axis: str) -> None:
    """Draw a line for each record, which ends where the pier overturns, and the median for each slenderness, × where infinite."""
    several = suite["alpha"].nunique() > 1
    for place, (alpha, median) in enumerate(suite.groupby("alpha", sort=False)):
        of_alpha = spectra[spectra["alpha"] == alpha]
        for _, of_record in of_alpha.groupby(["record", "polarity", *_scale(axis)], sort=False):
            stood = of_record["theta_max_over_alpha"].where(of_record["status"] == "ok")
            axes.plot(of_record[axis], stood, color="0.65", linewidth=0.6, label="each record")
        name = rf"median, $\alpha$ = {alpha:g}" if several else "median"
        fell = median.loc[np.isinf(median["median"]), axis]
        if len(fell):
            height = np.full(len(fell), 0.96 - 0.05 * place)  # of the panel: one row for each slenderness
            axes.plot(
                fell, height, transform=axes.get_xaxis_transform(), color=COLOURS[place % len(COLOURS)],
                marker="x", linestyle="", label="overturned or ended by flight",
            )  # fmt: skip
        axes.plot(median[axis], median["median"].replace(math.inf, math.nan), **line(place), label=name)
    axes.set(xlabel=SYMBOLS[axis], ylabel=r"$\theta_{\max}/\alpha$", ylim=(0, 1.1))


def _scale(axis: str) -> list[str]:
    """Return the column "scale" where a curve has one scale, which in a self-similar spectrum follows from the slenderness."""
    return [] if axis == SELF_SIMILAR else ["scale"]


def _map(axes: Axes, regions: "pd.DataFrame") -> None:
    """Draw the regions of a map with their boundaries, as the report does; none where the pier stands."""
    strips = overturning_map.strips(regions)
    for outcome, place in _PLACES.items():
        outlines = [
            Path(np.transpose((np.append(x, x[0]), np.append(y, y[0]))), closed=True)
            for x, y in overturning_map.areas(strips, outcome)
        ]
        if outlines:  # as one path, or a hair of background would show where two strips meet
            together = Path.make_compound_path(*outlines)
            axes.add_patch(PathPatch(together, color=COLOURS[place], alpha=0.35, linewidth=0.0, label=outcome))
    for x, y in (*overturning_map.inside(strips), *overturning_map.between(strips)):
        axes.plot(x, y, color="black", linewidth=0.8)
    low, high = regions["low"].min(), regions["high"].max()
    edges = strips[0].frequencies[0], strips[-1].frequencies[-1]
    axes.set(xlabel=r"$\omega_p/p$", ylabel=r"$a_p/(g\,\tan\alpha)$", xlim=edges, ylim=(low, high))
    axes.grid(False)


@styled
def sensitivity(swings: "pd.DataFrame", sobol: "pd.DataFrame", width_mm: float) -> Figure:
    """See :meth:`rockbatch.analysis.sensitivity.Sensitivity.plot`."""
    cases = list(swings["case"].unique())
    drawn = figure(width_mm, 16.0 + (12.0 + 5.0 * swings["parameter"].nunique()) * len(cases))
    for (tornado, shares), case in zip(drawn.subplots(len(cases), 2, squeeze=False), cases, strict=True):
        bars = swings[swings["case"] == case].drop_duplicates("parameter")[::-1]
        tornado.barh(
            bars["parameter"], bars["answer_high"] - bars["answer_low"], left=bars["answer_low"], color=COLOURS[0]
        )
        tornado.axvline(bars["answer_base"].iloc[0], color="black", linewidth=0.8)
        tornado.set(title=case, xlabel=r"$\theta_{\max}/\alpha$, one at a time")
        of_case = (
            sobol[sobol["case"] == case]
            .drop_duplicates("parameter")
            .set_index("parameter")
            .reindex(bars["parameter"])
            .dropna()
        )
        for place, (index, label) in enumerate((("total", "total"), ("first", "first order"))):
            shares.errorbar(of_case[index], of_case.index, xerr=of_case[f"{index}_error"], label=label, **marks(place))
        shares.set(
            title=case, xlabel="Sobol index", xlim=(min(-0.05, *shares.get_xlim()), max(1.05, *shares.get_xlim()))
        )
    return _with_legend(drawn, [shares])


@styled
def accuracy(table: "pd.DataFrame", width_mm: float) -> Figure:
    """See :meth:`rockbatch.analysis.accuracy.Accuracy.plot`."""
    drawn = figure(width_mm, 0.65 * width_mm + 12.0)
    axes = drawn.subplots()
    for place, (method, rows) in enumerate(table.groupby("method", sort=False)):
        style = marks(place) | {"linestyle": line(place)["linestyle"]}
        axes.loglog(1000.0 * rows["seconds_per_run"], rows["error_95"].clip(lower=1e-16), label=str(method), **style)
        for steps, seconds, error in rows[["substeps", "seconds_per_run", "error_95"]].dropna().to_numpy().tolist():
            axes.annotate(
                f"{steps:g}", (1000.0 * seconds, error), xytext=(4, 4), textcoords="offset points", fontsize=6.0
            )
    axes.set(xlabel="time of a run [ms]; numbers: steps per sample", ylabel=r"error of $\theta_{\max}/\alpha$, 95 %")
    return _with_legend(drawn, [axes])


def _panels(count: int, width_mm: float) -> tuple[Figure, list[Axes]]:
    columns = max(1, min(count, int(width_mm / 70.0)))
    rows = math.ceil(count / columns)
    drawn = figure(width_mm, 10.0 + 60.0 * rows)
    grid = drawn.subplots(rows, columns, squeeze=False).ravel().tolist()
    for axes in grid[count:]:
        axes.set_visible(False)
    return drawn, grid[:count]


def _with_legend(drawn: Figure, panels: Sequence[Axes]) -> Figure:
    """Return the figure with one legend of all panels below."""
    entries = {
        label: handle for axes in panels for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    drawn.legend(list(entries.values()), list(entries), loc="outside lower center", ncols=3)
    return drawn


@styled
def release(fits: "pd.DataFrame", impacts: "pd.DataFrame", history: "pd.DataFrame", width_mm: float) -> Figure:
    """See :meth:`rockbatch.analysis.release.Release.plot`."""
    keys = list(fits.columns[: list(fits.columns).index("parameter")])
    cases = [list(table.groupby(keys, sort=False, dropna=False)) for table in (impacts, history)]
    drawn, grid = _panels(len(fits), width_mm)
    for axes, (_, measured), (names, computed), fit in zip(grid, *cases, fits.to_dict("records"), strict=True):
        axes.plot(computed["t_s"], computed["theta_rad"], label="computed", **line(0))
        axes.plot(measured["t_measured_s"], 0.0 * measured["t_measured_s"], label="measured impacts", **marks(1))
        t_computed, amplitude = measured["t_amplitude_computed_s"], measured["amplitude_measured_rad"]
        side = np.sign(np.interp(t_computed, computed["t_s"], computed["theta_rad"]))
        axes.plot(t_computed, side * amplitude, label="measured amplitudes", **marks(2))
        axes.set(xlabel="t [s]", title=f"{', '.join(map(str, names))}: {fit['parameter']} = {fit['value']:.4g}")
    grid[0].set_ylabel(r"$\theta$ [rad]")
    return _with_legend(drawn, grid)
