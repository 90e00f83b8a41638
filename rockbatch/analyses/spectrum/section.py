"""Rocking spectra and overturning maps in the report."""

from rockbatch.analyses.spectrum.figures import QUANTILES, maps, spectra
from rockbatch.common.lazy import pd
from rockbatch.reporting.finished_analysis import Contents, FinishedAnalysis, of_files
from rockbatch.reporting.labels import heading
from rockbatch.reporting.markup import Markup, figure, join, tag
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import sub
from rockbatch.results.labels import plain


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
    lead = "Largest rotation over slenderness against the size of the pier, a curve for each slenderness. "
    if analysis.info["axis"] == "omega_g_over_p":
        lead = _of_self_similar(suite)
    if (suite["count"] > 1).any():
        lead += (
            "Solid: median of the suite; dashed and dotted: 84 % and 16 % quantiles; every component counts by itself. "
        )
    lead += "Above the frame: overturned or ended by flight (∞), which counts as larger than any rotation."
    records = analysis.table("spectrum.csv", ("case", "alpha", "record", "polarity", "status", "theta_max_over_alpha"))
    return [tag("p", heading(lead)), tag("figure", drawn(spectra(suite, records, analysis.info)), class_="whole")]


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


def _maps(analysis: FinishedAnalysis, regions: "pd.DataFrame") -> list[Markup]:
    lead = tag(
        "p",
        "Which amplitudes of a pulse overturn the pier, over the pulse's frequency: ", sub("ω", "p"),
        " = 2π over its period, ", sub("a", "p"), " its peak acceleration.",
    )  # fmt: skip
    captions: dict[str, list[str]] = {}
    for spec in analysis.info["maps"]:
        caption = (
            f"Boundaries are located within {spec['tolerance']:g} along the ordinate, "
            f"and where regions begin, end or change their order within {spec['width']:g} along the abscissa, "
            "where the picture has a step. Islands may be missed that are narrower than a step of the grid both ways."
        )
        captions.setdefault(caption, []).append(spec["name"])
    return [lead] + [
        figure(drawn(maps(regions[regions["map"].isin(names)], analysis.info)), caption)
        for caption, names in captions.items()
    ]
