"""Annual rates of ``rockbatch fragility``: the worst case, the hazard, which intensities contribute, and a table."""

from collections.abc import Sequence

from rockbatch.analyses.fragility import answer
from rockbatch.analyses.fragility.figures import label, risk
from rockbatch.analyses.fragility.quantities import Curve, level_of, of_rates, power
from rockbatch.reporting.finished_analysis import Contents, of_files
from rockbatch.reporting.markup import Markup, tag
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import Head, listed
from rockbatch.reporting.templates import render


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
    heads = [Head("limit", value="limit_state"), Head("case", value=label), *of_rates(info, power)]
    return render(
        "analyses/fragility/risk_section.html", info=info, answer=answer.of_rates(info), hazard=info["hazard"],
        share=level_of(info), panels=drawn(risk(info, curves)),
        table=listed(heads, curves, prose=True, name="Annual rates and probabilities"), notes=_notes(curves),
    )  # fmt: skip


def _notes(curves: Sequence[Curve]) -> Markup:
    """Return what the numbers do not say by themselves, a line for each curve."""
    notes = [(f"{entry['limit_state']}, {label(entry)}", entry["risk"]["note"]) for entry in curves]
    return tag("ul", *(tag("li", f"{name}: {note}.") for name, note in notes if note))
