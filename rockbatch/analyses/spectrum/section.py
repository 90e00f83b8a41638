"""Rocking spectra and overturning maps in the report."""

from rockbatch.analyses.spectrum.answer import answer, of_maps, of_spectra
from rockbatch.analyses.spectrum.figures import QUANTILES, maps, spectra
from rockbatch.common.lazy import pd
from rockbatch.common.statuses import NOT_STANDING
from rockbatch.quantities.labels import plain
from rockbatch.quantities.statistics import FRACTILES_FROM
from rockbatch.reporting.finished_analysis import FinishedAnalysis, of_analysis
from rockbatch.reporting.labels import heading
from rockbatch.reporting.markup import Markup, figure, join, paragraphs, tag
from rockbatch.reporting.svg import drawn


@of_analysis("spectrum")
def section(analysis: FinishedAnalysis) -> Markup:
    """Return the report's section of rocking spectra and overturning maps, with its answer; empty without them."""
    answers: list[tuple[list[str], list[str]]] = []
    figures: list[Markup] = []
    methods: list[str] = []
    suite = analysis.table("spectrum_suite.csv", ("case", "alpha", "count", *QUANTILES, *NOT_STANDING))
    if suite is not None:
        answers.append(of_spectra(analysis.info, suite))
        figures.append(_spectra(analysis, suite))
        methods.append(_of_spectra(analysis, suite))
    regions = analysis.table("overturning_map.csv", ("map", "case", "omega_p_over_p", "outcome", "low", "high"))
    if regions is not None:
        answers.append(of_maps(analysis.info, regions))
        figures.append(figure(drawn(maps(regions, analysis.info)), heading(MAPS)))
        methods += _of_maps(analysis)
    if not figures:
        return Markup("")
    computed = tag("details", tag("summary", "How this was computed"), paragraphs(*methods), analysis.provenance())
    return join(*(answer(*said) for said in answers), *figures, computed)


MAPS = "Amplitudes of a pulse over its frequency: ω_p = 2π over its period, a_p its peak acceleration."


def _spectra(analysis: FinishedAnalysis, suite: "pd.DataFrame") -> Markup:
    caption = "Largest rotation over slenderness, a curve for each slenderness. "
    if (suite["count"] > 1).any():
        caption += "Solid: median of the motions. "
        few = f"where motions of {FRACTILES_FROM} stations or more have an outcome"
        caption += f"Dashed and dotted: 84 % and 16 % quantiles, {few}. " if suite["p84"].notna().any() else ""
    caption += "Above the frame: overturned, or ended by flight."
    records = analysis.table("spectrum.csv", ("case", "alpha", "record", "polarity", "status", "theta_max_over_alpha"))
    return figure(drawn(spectra(suite, records, analysis.info)), heading(caption))


def _of_spectra(analysis: FinishedAnalysis, suite: "pd.DataFrame") -> Markup:
    """Return the remark on the spectra's method; for self-similar ones also their axes, and the ranges of sizes and scales."""
    words = "Overturning and flight count as larger than any rotation; every component counts by itself."
    if analysis.info["axis"] != "omega_g_over_p":
        return heading(words)
    size, scale = (
        f"{plain(suite[f'least_{name}'].min(), 3)} to {plain(suite[f'greatest_{name}'].max(), 3)}"
        for name in ("size_m", "scale")
    )
    return heading(
        "Self-similar spectra: largest rotation over slenderness against ω_g/p, with ω_g = PGA/PGV of each record. Each record "
        f"is scaled to the PGA/(g tan α) of the picture, by {scale}, and acts on piers of its own sizes, R0 from {size} m. "
        "Slender piers on rigid ground with one restitution and without vertical motion share one curve: what parts the curves "
        f"of several slendernesses is restitution, vertical motion, large rotations, and springs. {words}"
    )


def _of_maps(analysis: FinishedAnalysis) -> list[str]:
    """Return a remark on the accuracy of the maps, one for each different setting."""
    settings = dict.fromkeys((spec["tolerance"], spec["width"]) for spec in analysis.info["maps"])
    return [
        f"Boundaries of maps are located within {tolerance:g} along the ordinate, and beginnings, ends and changes of order of "
        f"regions within {width:g} along the abscissa, where the picture has a step. Islands narrower than one grid step may "
        "be missed."
        for tolerance, width in settings
    ]
