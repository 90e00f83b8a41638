"""``rockbatch fragility``: the probability of overturning, and of exceeding every limit of a check, at a given intensity."""

import argparse
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rockbatch.batch.listening import count
from rockbatch.commands.analyses import asked, tell_files
from rockbatch.commands.messages import in_width, say, show
from rockbatch.commands.options import add_engine, add_study, study_of
from rockbatch.lazy import pd

if TYPE_CHECKING:
    from rockbatch.analysis.fragility_curves import Curve
    from rockbatch.study.fragility import FragilitySpec

HELP = "fragility curves for overturning and for design checks"
EXAMPLE = "rockbatch fragility pier.toml --jobs 4"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_study(parser)
    add_engine(parser)


def main(arguments: argparse.Namespace) -> int:
    study = study_of(arguments)

    from rockbatch.analysis.fragility import fragility
    from rockbatch.analysis.fragility_tables import RUNS

    options = asked(arguments)
    result = fragility(study, **options)
    show(table(result.curves, result.spec))
    tell_files(result)
    failed = any(stripe.failed for curve in result.curves for stripe in curve.stripes)
    if failed:
        say(f"some runs failed and are undecided; the column reason of {options['out'] / RUNS} says why")
    return 1 if result.unusable or failed else 0


def table(curves: Sequence["Curve"], spec: "FragilitySpec") -> str:
    """Return medians and dispersions with their intervals, a line for each limit and case, and what to know about them."""
    from rockbatch.analysis.fragility_tables import looked_at, note
    from rockbatch.analysis.limit_states import words
    from rockbatch.analysis.lognormal import Lognormal
    from rockbatch.commands.summary import named

    rows, notes = [], []
    for curve in curves:
        case = f"{curve.case.name} {named(curve.case.columns, curve.case.columns.values())}".strip()
        row: dict[str, Any] = {
            "limit": curve.limit.name,
            "case": case,
            "median": "",
            "theta": "",
            "open": "",
            "beta": "",
            "b": "",
        }
        if isinstance(curve.fitted, Lognormal):
            fitted = curve.fitted
            row |= {
                "median": f"{fitted.median:.3g}",
                "theta": _interval(fitted.median_interval),
                "beta": f"{fitted.dispersion:.2f}",
                "b": _interval(fitted.dispersion_interval),
            }
        if curve.readings:
            row["open"] = _interval(curve.readings.medians)
        if remark := note(curve, spec):
            notes.append(f"{curve.limit.name}, {case}: {remark}")
        rows.append(row)
    level = f"{100 * spec.confidence:g} %"
    heads = ["limit", "case", f"median [{spec.unit}]", level, "undecided", "dispersion", level]
    cells = pd.DataFrame(rows)
    cells.columns = pd.Index(heads)
    if not any(curve.readings for curve in curves):
        cells = cells.drop(columns="undecided")
    limits = [f"{limit.name}: {words(limit)}" for limit in spec.limits if words(limit)]
    title = f"Fragility for {spec.label}, {'incremental dynamic analysis' if spec.method == 'ida' else 'stripes'}"
    if little := sum(curve.says_little for curve in curves):
        some = f"{little} of {count(len(curves), 'curve')} {'says' if little == 1 else 'say'} little"
        title += f"; {some}: too many runs are undecided"
    return "\n".join(filter(None, [title, in_width(cells, index=False), *limits, looked_at(curves, spec), *notes]))


def _interval(bounds: tuple[float, float]) -> str:
    low, high = bounds
    return f"{low:.3g} – {'∞' if math.isinf(high) else f'{high:.3g}'}"
