"""``rockbatch fragility``: the probability of overturning, and of exceeding every limit of a check, at a given intensity."""

import argparse
import math
from collections.abc import Sequence

from rockbatch.analyses.fragility.analysis import fragility
from rockbatch.analyses.fragility.curves import Curve
from rockbatch.analyses.fragility.limit_states import words
from rockbatch.analyses.fragility.risk import Risk, percent, probability, risks
from rockbatch.analyses.fragility.risk import note as note_on_risk
from rockbatch.analyses.fragility.study import FragilitySpec
from rockbatch.analyses.fragility.tables import RUNS, by_shares, looked_at, note
from rockbatch.batch.listening import count
from rockbatch.commands.analysis import analysis_arguments, print_files
from rockbatch.commands.options import folder
from rockbatch.commands.streams import in_width, say, show
from rockbatch.commands.summary import named
from rockbatch.study import Study


def main(arguments: argparse.Namespace, study: Study) -> int:
    """Fit fragility curves, and print them."""
    result = fragility(study, **analysis_arguments(arguments))
    show(table(result.curves, result.spec))
    show(result.info["scales"]["said"])
    if result.spec.hazard is not None:
        show(f"\n{risk_lines(risks(result.curves, result.spec), result.spec)}")
    print_files(result)
    failed = any(stripe.failed for curve in result.curves for stripe in curve.stripes)
    if failed:
        say(f"some runs failed and are undecided; the column reason of {folder(arguments) / RUNS} says why")
    return 1 if result.unusable or failed else 0


def table(curves: Sequence[Curve], spec: FragilitySpec) -> str:
    """Return medians and dispersions with their intervals, a line for each limit and case, with remarks."""
    rows, notes = [], []
    for curve in curves:
        case = _case(curve)
        fitted = None if isinstance(curve.fitted, str) else curve.fitted
        rows.append([
            curve.limit.name,
            case,
            f"{fitted.median:.3g}" if fitted else "",
            _interval(fitted.median_interval) if fitted else "",
            _interval(curve.readings.medians) if curve.readings else "",
            f"{fitted.dispersion:.2f}" if fitted else "",
            _interval(fitted.dispersion_interval) if fitted else "",
            *_by_shares(curve),
        ])  # fmt: skip
        if remark := note(curve, spec):
            notes.append(f"{curve.limit.name}, {case}: {remark}")
    level = f"{100 * spec.confidence:g} %"
    heads = ["limit", "case", f"median [{spec.unit}]", level, "undecided", "dispersion", level, "by shares", "apart"]
    if not any(curve.windows for curve in curves):
        heads, *rows = (line[:-2] for line in (heads, *rows))
    if not any(curve.readings for curve in curves):
        heads, *rows = ([*line[:4], *line[5:]] for line in (heads, *rows))
    limits = [f"{limit.name}: {words(limit)}" for limit in spec.limits if words(limit)]
    method = {"ida": "incremental dynamic analysis", "cloud": "cloud analysis"}.get(spec.method, spec.method)
    title = f"Fragility for {spec.label}, {method}"
    if little := sum(curve.inconclusive for curve in curves):
        share = f"{little} of {count(len(curves), 'curve')} {'says' if little == 1 else 'say'} little"
        title += f"; {share}: too many runs are undecided"
    lines = [
        title,
        in_width(heads, rows, names=2),
        *limits,
        looked_at(curves, spec),
        by_shares(curves),
        *notes,
        added(spec),
    ]
    return "\n".join(line for line in lines if line)


def _by_shares(curve: Curve) -> list[str]:
    """Return the median by shares, and how far it is above that of the first exceedances."""
    if curve.windows is None or isinstance(curve.windows.fitted, str):
        return ["", ""]
    above = curve.windows.above(curve.fitted)
    return [f"{curve.windows.fitted.median:.3g}", "" if above is None else f"{100 * above:+.1f} %"]


def added(spec: FragilitySpec) -> str:
    """Return the dispersion that the study adds, in words; empty if it adds none."""
    parts = ", ".join(f"{dispersion.name} {dispersion.value:g}" for dispersion in spec.dispersions)
    return f"added to the dispersion of the records, for rates: {parts}; together {spec.added:.3g}" if parts else ""


def risk_lines(rates: Sequence[Risk], spec: FragilitySpec) -> str:
    """Return annual rates and probabilities with their intervals, a line for each limit and case, with their basis."""
    years = spec.hazard.years if spec.hazard else ()
    level = f"{100 * spec.confidence:g} %"
    heads = [
        "limit",
        "case",
        "dispersion",
        "rate per year",
        level,
        *(f"in {t:g} years" for t in years),
        "90 % come from",
    ]
    rows, notes = [], []
    for risk in rates:
        chances = [_chance(risk, t) for t in years]
        rate = f"{risk.rate:.2e}"
        interval = " – ".join(f"{bound:.2e}" if math.isfinite(bound) else "∞" for bound in risk.interval)
        rows.append([
            risk.curve.limit.name, _case(risk.curve), f"{risk.total.dispersion:.2f}", rate, interval, *chances,
            f"{risk.contributing[0]:.2g} – {risk.contributing[1]:.2g} {spec.unit}",
        ])  # fmt: skip
        if remark := note_on_risk(risk, spec):
            notes.append(f"{risk.curve.limit.name}, {_case(risk.curve)}: {remark}")
    if not rows:
        return "No annual rates: no curve could be fitted"
    about = "Mean annual rates of exceedance; intervals are those that the fit leaves, with the hazard taken as known"
    return "\n".join([about, in_width(heads, rows, names=2), *notes])


def _chance(risk: Risk, years: float) -> str:
    low, high = (percent(probability(bound, years)) for bound in risk.interval)
    return f"{percent(risk.probability(years))} % ({low} – {high})"


def _case(curve: Curve) -> str:
    return f"{curve.case.name} {named(curve.case.columns, curve.case.columns.values())}".strip()


def _interval(bounds: tuple[float, float]) -> str:
    low, high = bounds
    return f"{low:.3g} – {'∞' if math.isinf(high) else f'{high:.3g}'}"
