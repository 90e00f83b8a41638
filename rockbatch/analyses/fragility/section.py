"""Results of ``rockbatch fragility``: for each limit points, curves and bands; annual rates and what contributes to them."""

from collections.abc import Callable, Iterable, Sequence

from rockbatch.analyses.fragility import answer
from rockbatch.analyses.fragility.figures import clouds, curves, intensity, remarks, risk
from rockbatch.analyses.fragility.quantities import Curve, level_of, names_of_curves, of_curves, of_rates, power
from rockbatch.common.analyses import Entry
from rockbatch.reporting.finished_analysis import FinishedAnalysis, named, of_analysis, of_earlier_version
from rockbatch.reporting.markup import Markup, tag
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import Head, listed, table
from rockbatch.reporting.templates import render

CAPACITIES = ("record", "case", "limit_state", "at_most", "scale_at_most", "widest_step")


@of_analysis("fragility")
def section(analysis: FinishedAnalysis) -> Markup:
    """Return the report's section of fragility curves; empty without any."""
    if not analysis.info["curves"]:
        return Markup("")
    if _is_earlier(analysis.info):
        return of_earlier_version("fragility")
    info = analysis.info
    entries, of_clouds = info["curves"], clouds(info)
    return render(
        "analyses/fragility/section.html",
        info=info,
        answer=answer.of_curves(info),
        share=level_of(info),
        panels=drawn(curves(info)),
        table=_table(info),
        notes=_notes(info, entries),
        open=any("open" in entry for entry in entries),
        looked=any(entry.get("looked") for entry in entries),
        clouds=drawn(of_clouds) if of_clouds.panels else "",
        factors=_factors(info),
        own=any(None in row for row in info.get("scales", {}).get("factors", ())),
        capacities=_capacities(analysis),
        provenance=analysis.provenance(),
    )


def _is_earlier(info: Entry) -> bool:
    """Return whether an earlier version wrote fragility.json, in which bounds of medians had no confidence."""
    bounds = (curve.get("median_bound") for curve in info["curves"])
    return any("confidence" not in bound for bound in bounds if bound)


def _table(info: Entry) -> Markup:
    heads = [
        *names_of_curves(info),
        *of_curves(info),
        Head("records", ".0f", "that count", value=_greatest("records")),
        Head("overturned", ".0f", "largest number of records that overturn at one level", value=_greatest("collapsed")),
        Head("no curve", value=lambda entry: entry["note"] if entry["median"] is None else None),
    ]
    return listed(heads, info["curves"], prose=True, name="Medians and dispersions")


def _notes(info: Entry, entries: Iterable[Curve]) -> Markup:
    """Return a folded list of notes on single curves; empty without any."""
    lines = _lines(remarks(info, entries, lambda entry: entry["note"]))
    return tag("details", tag("summary", "Notes on the curves"), lines) if lines else lines


def _lines(sentences: Iterable[str]) -> Markup:
    """Return sentences as a list, empty without any."""
    points = [tag("li", f"{sentence}.") for sentence in sentences]
    return tag("ul", *points) if points else Markup("")


def _factors(info: Entry) -> Markup:
    """Return a folded table of the factors on every record at every level, unused ones in brackets; empty without factors."""
    scales = info.get("scales")
    if not scales or not scales["records"]:
        return Markup("")
    heads = [Head("record"), *(Head(f"{level:g}", group=intensity(info)) for level in info["levels"])]
    rows = []
    for name, factors, used in zip(scales["records"], scales["factors"], scales["used"], strict=True):
        rows.append([name, *map(_factor, factors, used)])
    words = "Factors on the records as they were recorded; in brackets: beyond the limits, not used"
    return tag("details", tag("summary", words), table(heads, rows, name="Factors on the records"))


def _capacities(analysis: FinishedAnalysis) -> Markup:
    """Return a folded table of the capacity of every record; empty for another method."""
    capacities = analysis.table("fragility_capacities.csv", CAPACITIES)
    if capacities is None:
        return Markup("")
    varied = list(dict.fromkeys(name for entry in analysis.info["curves"] for name in entry["columns"]))

    def case(row: Entry) -> str:
        return named(analysis.info, row, varied)

    heads = [
        Head("record", value="record"),
        Head("limit", value="limit_state"),
        Head("case", value=case),
        Head(
            "exceeded from",
            ".4g",
            "empty: not up to the highest level",
            unit=analysis.info["unit"],
            value="at_most",
        ),
        Head("as scale", ".4g", value="scale_at_most"),
        Head(
            "widest step below",
            ".3g",
            "an island of exceedance that is narrower may lie below",
            unit="%",
            value=lambda row: 100.0 * float(row["widest_step"]),
        ),
    ]
    rows = ({str(name): value for name, value in row.items()} for row in capacities.to_dict("records"))
    return tag("details", tag("summary", "Capacities of the records"), listed(heads, rows, name="Capacities"))


def _factor(factor: float | None, used: bool) -> str:
    if factor is None:
        return ""
    return f"{factor:.2f}" if used else f"({factor:.2f})"


def _greatest(name: str) -> Callable[[Curve], object]:
    """Return a function from a curve to the greatest of its counts ``name`` over the levels, or of a cloud to their sum."""
    return lambda entry: (sum if "cloud" in entry else max)([point[name] for point in entry["points"]])


@of_analysis("fragility")
def rates(analysis: FinishedAnalysis) -> Markup:
    """Return the report's section of hazard and annual rates, a sentence if no curve has a rate; empty without a hazard.

    It is empty for files of an earlier version, too, of which the section of curves says so.
    """
    if not analysis.info.get("hazard") or _is_earlier(analysis.info):
        return Markup("")
    info = analysis.info
    curves = [entry for entry in info["curves"] if entry["risk"]]
    if not curves:
        return tag("p", "No annual rates: they need a curve, or an upper bound of the median.")
    heads = [
        *names_of_curves(info),
        *of_rates(info, power),
    ]
    return render(
        "analyses/fragility/risk_section.html",
        info=info,
        answer=answer.of_rates(info),
        hazard=info["hazard"],
        share=level_of(info),
        panels=drawn(risk(info, curves)),
        table=listed(heads, curves, prose=True, name="Annual rates and probabilities"),
        notes=_notes_on_rates(info, curves),
    )


def _notes_on_rates(info: Entry, curves: Sequence[Curve]) -> Markup:
    """Return the remarks on annual rates, a line for each with the curves that have it."""
    return _lines(remarks(info, curves, lambda entry: entry["risk"]["note"]))
