"""``rockbatch fragility``: the probability of overturning, and of exceeding every limit of a check, at a given intensity."""

import argparse

from rockbatch.analyses.fragility.analysis import fragility
from rockbatch.analyses.fragility.figures import remarks
from rockbatch.analyses.fragility.limit_states import words
from rockbatch.analyses.fragility.quantities import names_of_curves, of_curves, of_rates
from rockbatch.analyses.fragility.study import FragilitySpec
from rockbatch.batch.listening import count
from rockbatch.common.analyses import Entry
from rockbatch.study import Study
from rockbatch.terminal.analysis import analysis_arguments, finished, in_lines
from rockbatch.terminal.streams import show


def main(arguments: argparse.Namespace, study: Study) -> int:
    """Fit fragility curves, and print them; return the exit code."""
    result = fragility(study, **analysis_arguments(arguments))
    show(table(result.info, result.spec))
    show(result.info["scales"]["said"])
    if result.spec.hazard is not None:
        show(f"\n{risk_lines(result.info)}")
    return finished(result)


def table(info: Entry, spec: FragilitySpec) -> str:
    """Return medians and dispersions with their intervals, a line for each limit and case, with remarks.

    ``info`` is the content of fragility.json.
    """
    limits = [f"{limit.name}: {words(limit)}" for limit in spec.limits if words(limit)]
    method = {"ida": "incremental dynamic analysis", "cloud": "cloud analysis"}.get(spec.method, spec.method)
    title, curves = f"Fragility for {spec.label}, {method}", info["curves"]
    if little := sum(curve["says_little"] for curve in curves):
        share = f"{little} of {count(len(curves), 'curve')} {'says' if little == 1 else 'say'} little"
        title += f"; {share}: too many runs are undecided"
    lines = [
        title,
        in_lines([*names_of_curves(info), *of_curves(info)], curves, 2),
        *limits,
        info["looked_at"],
        info["by_shares"],
        info["drawn"],
        *remarks(info, curves, lambda curve: curve["note"]),
        added(spec),
    ]
    return "\n".join(line for line in lines if line)


def added(spec: FragilitySpec) -> str:
    """Return the study's added dispersions in words: "added to the dispersion …: modelling 0.3, limit 0.2; together 0.361".

    Behind are the drawn inputs, which it does not contain, if any; empty without an added dispersion.
    """
    parts = ", ".join(f"{dispersion.name} {dispersion.value:g}" for dispersion in spec.dispersions)
    if not parts:
        return ""
    drawn = f", not counting {', '.join(spec.uncertain.names)}, which are drawn" if spec.uncertain.inputs else ""
    return f"added to the dispersion of the records, for rates: {parts}; together {spec.added:.3g}{drawn}"


def risk_lines(info: Entry) -> str:
    """Return annual rates and probabilities with their intervals, a line for each limit and case that has one, and remarks.

    If none has a rate, it is a sentence that says so.
    """
    curves = [curve for curve in info["curves"] if curve["risk"]]
    if not curves:
        return "No annual rates: they need a curve, or an upper bound of the median"
    about = "Mean annual rates of exceedance; intervals are those of the fit, with the hazard taken as known"
    notes = remarks(info, curves, lambda curve: curve["risk"]["note"])
    return "\n".join([about, in_lines([*names_of_curves(info), *of_rates(info, "{:.2e}".format)], curves, 2), *notes])
