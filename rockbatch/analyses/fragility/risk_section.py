"""Annual rates of ``rockbatch fragility``: the hazard, which intensities contribute, and a table of probabilities."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from rockbatch.analyses.fragility.figures import label, risk
from rockbatch.report.finished_analysis import Contents, of_files
from rockbatch.report.markup import Markup, interval, tag
from rockbatch.report.svg import drawn
from rockbatch.report.table import Head, listed
from rockbatch.report.templates import render

Curve = Mapping[str, Any]
"""One of ``curves`` of fragility.json."""


@of_files("fragility")
def section(contents: Contents) -> Markup:
    """Draw the hazard and what the rates come from; empty if the study has no hazard."""
    analysis = contents.analysis("fragility")
    if analysis is None or not analysis.info.get("hazard"):
        return Markup("")
    info = analysis.info
    curves = [entry for entry in info["curves"] if entry["risk"]]
    if not curves:
        return tag("p", "No curve could be fitted, so that there are no rates.")
    share = f"{100 * info['confidence']:g} %"
    return render(
        "analyses/fragility/risk_section.html", info=info, hazard=info["hazard"], share=share, panels=drawn(risk(info, curves)),
        table=_table(info, curves, share), notes=_notes(curves),
    )  # fmt: skip


def _table(info: Mapping[str, Any], curves: Sequence[Curve], share: str) -> Markup:
    heads = [
        Head("limit", value="limit_state"),
        Head("case", value=label),
        Head("dispersion", ".2f", "β with what the study adds", value=lambda entry: entry["risk"]["dispersion_total"]),
        Head("rate [1/year]", note="mean annual rate of exceedance", value=lambda entry: _power(entry["risk"]["rate_per_year"])),
        Head(share, note="what the fit leaves of the rate", value=_pair("rate_low", "rate_high")),
        Head("undecided", note="the rate with all undecided runs within the limit, and with all beyond it",
             value=_pair("rate_if_withstood", "rate_if_exceeded")),
        *(Head(f"in {years:g} years", note=f"probability of at least one exceedance, and what the fit leaves of it ({share})",
               value=_chance(f"p_in_{years:g}_years")) for years in info["hazard"]["years"]),
        Head(f"90 % come from [{info['unit']}]", note="intensities that contribute, but for 5 % at either end",
             value=_contributing),
    ]  # fmt: skip
    return listed(heads, curves, prose=True, name="Annual rates and probabilities")


def _notes(curves: Sequence[Curve]) -> Markup:
    """Return what the numbers do not say by themselves, a line for each curve."""
    notes = [(f"{entry['limit_state']}, {label(entry)}", entry["risk"]["note"]) for entry in curves]
    return tag("ul", *(tag("li", f"{name}: {note}.") for name, note in notes if note))


def _power(value: float) -> str:
    """Return a rate with a power of ten: "7.4·10⁻⁴"."""
    digits, exponent = f"{value:.1e}".split("e")
    return f"{digits}·10{str(int(exponent)).translate(_RAISED)}"


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def _pair(low: str, high: str) -> Callable[[Curve], object]:
    def written(entry: Curve) -> Markup:
        bounds = [entry["risk"][name] for name in (low, high)]
        if bounds == [None, None]:
            return Markup("")
        return interval(*("∞" if bound is None else _power(bound) for bound in bounds))

    return written


def _chance(name: str) -> Callable[[Curve], object]:
    def written(entry: Curve) -> Markup:
        value, low, high = (_percent(entry["risk"][key]) for key in (name, f"{name}_low", f"{name}_high"))
        return Markup(f"{value}\u00a0% ({interval(low, high)})")

    return written


def _percent(p: float) -> str:
    return "100" if p >= 0.995 else f"{100.0 * p:.2g}"


def _contributing(entry: Curve) -> Markup:
    return interval(*(f"{entry['risk'][name]:.2g}" for name in ("contributing_from", "contributing_to")))
