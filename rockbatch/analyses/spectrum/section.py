"""Pictures of ``rockbatch spectrum``: rocking spectra as curves, overturning maps as regions."""

import numpy as np

from rockbatch.analyses.spectrum import map_drawing as overturning_map
from rockbatch.common.lazy import pd
from rockbatch.report.drawing.axes import Axes, Scale
from rockbatch.report.drawing.svg import (
    COLOURS,
    Entry,
    curve,
    line,
    lowered,
    marker,
    rectangle,
    side_by_side,
    svg,
    text,
)
from rockbatch.report.finished_analysis import Contents, FinishedAnalysis, named, of_files
from rockbatch.report.labels import heading, symbol
from rockbatch.report.markup import Markup, figure, join, tag
from rockbatch.report.table import sub
from rockbatch.results.labels import plain, quantity

WIDTH, HEIGHT = 420.0, 250.0
ROW = 10.0
"""Height of a row of marks of overturned runs [px]: one for each slenderness, or they would hide each other."""

ACROSS = {"two_pi_over_p_s": "2π/p [s]", "omega_g_over_p": lowered("ω", "g", "/p")}
QUANTILES = {"median": "", "p16": " d2", "p84": " d1"}


@of_files("spectrum")
def section(contents: Contents) -> Markup:
    """Draw rocking spectra and overturning maps; empty if there are none."""
    analysis = contents.analysis("spectrum")
    if analysis is None:
        return Markup("")
    parts = []
    suite = analysis.table("spectrum_suite.csv", ("case", "alpha", "count", *QUANTILES))
    if suite is not None:
        parts += _spectra(analysis, suite)
    regions = analysis.table("overturning_map.csv", ("map", "case", "omega_p_over_p", "outcome", "low", "high"))
    if regions is not None:
        parts += _maps(analysis, regions)
    return join(*parts, analysis.provenance()) if parts else Markup("")


def _spectra(analysis: FinishedAnalysis, suite: "pd.DataFrame") -> list[Markup]:
    axis, many = analysis.info["axis"], bool((suite["count"] > 1).any())
    self_similar = axis == "omega_g_over_p"
    keys = ("case", *(() if self_similar else ("scale",)), *analysis.info["varied"])
    apart = [name for name in keys if name not in ("alpha", axis)]
    varying = [name for name in apart if name == "case" or suite[name].nunique(dropna=False) > 1]
    lead = "Largest rotation over slenderness against the size of the pier, a curve for each slenderness. "
    if self_similar:
        lead = _of_self_similar(suite)
    if many:
        lead += (
            "Solid: median of the suite; dashed and dotted: 84 % and 16 % quantiles; every component counts by itself. "
        )
    lead += "Above the frame: overturned or ended by flight (∞), which counts as larger than any rotation."
    drawn = [
        (named(dict(zip(apart, names, strict=True)), varying), *_curves(runs, axis, many))
        for names, runs in suite.groupby(apart, sort=False, dropna=False)
    ]
    return [tag("p", heading(lead)), tag("figure", side_by_side(drawn, WIDTH), class_="whole")]


def _of_self_similar(suite: "pd.DataFrame") -> str:
    """Return what the axes of self-similar spectra are, and which piers and scales are behind them."""
    size, scale = (
        f"{plain(suite[f'least_{name}'].min(), 3)} to {plain(suite[f'greatest_{name}'].max(), 3)}"
        for name in ("size_m", "scale")
    )
    return (
        "Self-similar spectra: largest rotation over slenderness against ω_g/p, with ω_g = PGA/PGV of each record. Each record "
        f"is scaled to the PGA/(g tan α) of the picture, by {scale}, and acts on piers of its own sizes, R0 from {size} m. "
        "Slender piers on rigid ground with one restitution and without vertical motion share one curve: what parts the curves "
        "of several slendernesses is restitution, vertical motion, large rotations, and springs. "
    )


def _curves(points: "pd.DataFrame", axis: str, many: bool) -> tuple[Markup, list[Entry]]:
    """Draw the rocking spectra of a case; return the picture and its legend."""
    names = list(QUANTILES) if many else ["median"]
    finite = points[names].to_numpy(float)
    top = 1.08 * (float(finite[np.isfinite(finite)].max(initial=0.0)) or 1.0)
    x = points[axis].to_numpy(float)
    height_above = ROW * points["alpha"].nunique() + 4.0
    axes = Axes(36, 20 + height_above, WIDTH - 48, HEIGHT - 58, Scale(x.min(), x.max()), Scale(0.0, top))
    height = HEIGHT + height_above
    drawn = [
        rectangle(axes.left, axes.top - height_above, axes.width, height_above, "band"),
        axes.frame(axes.x.ticks(8), axes.y.ticks(6)),
        text(axes.left + axes.width / 2, height - 6, ACROSS.get(axis, symbol(axis)), class_="m q"),
        text(axes.left - 30, 12, lowered("θ", "max", "/α"), class_="q"),
    ]
    entries: list[Entry] = []
    for place, (alpha, of_alpha) in enumerate(points.groupby("alpha", sort=False)):
        colour = f"s{place % COLOURS + 1}"
        across = axes.across(of_alpha[axis].to_numpy(float))
        for name in names:
            y = of_alpha[name].to_numpy(float)
            drawn.append(
                curve(across, axes.down(np.where(np.isfinite(y), y, np.nan)), f"level {colour}{QUANTILES[name]}")
            )
        fell = np.isinf(of_alpha["median"].to_numpy(float))
        high = axes.top - height_above + 2.0 + ROW * (place + 0.5)
        drawn += [
            marker("overturned", x_fell, high, colour=colour, title=f"{quantity('alpha', float(str(alpha)))}: ∞")
            for x_fell in across[fell]
        ]
        entries.append((line(0, 7, 22, 7, f"level {colour}"), quantity("alpha", float(str(alpha)))))
    if np.isinf(points["median"].to_numpy(float)).any():
        entries.append((marker("overturned", 11, 7, colour="ink"), "overturned or ended by flight" + ", median" * many))
    return svg(WIDTH, height, *drawn, description="Rocking spectrum", class_="plot marks"), entries


def _maps(analysis: FinishedAnalysis, regions: "pd.DataFrame") -> list[Markup]:
    apart = ["map", "case", *analysis.info["varied_map"]]
    drawn = [
        tag(
            "p",
            "Which amplitudes of a pulse overturn the pier, over the pulse's frequency: ", sub("ω", "p"),
            " = 2π over its period, ", sub("a", "p"), " its peak acceleration.",
        )
    ]  # fmt: skip
    pulses = {pulse["name"]: pulse for pulse in analysis.info["maps"]}
    pictures: dict[str, list[tuple[str, Markup, list[Entry]]]] = {}
    for names, of_map in regions.groupby(apart, sort=False, dropna=False):
        values = dict(zip(apart, names, strict=True))
        spec = pulses[values["map"]]
        title = f"{values['map']} ({spec['shape']}), {named(values, apart[1:])}; {of_map['omega_p_over_p'].nunique()} frequencies"
        caption = (
            f"Boundaries are located within {spec['tolerance']:g} along the ordinate, "
            f"and where regions begin, end or change their order within {spec['width']:g} along the abscissa, "
            "where the picture has a step. Islands may be missed that are narrower than a step of the grid both ways."
        )
        pictures.setdefault(caption, []).append((title, *overturning_map.draw(of_map)))
    drawn += [figure(side_by_side(drawings, WIDTH), caption) for caption, drawings in pictures.items()]
    return drawn
