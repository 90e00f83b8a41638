"""``rockbatch fragility``: how probable overturning, and every limit of a check, is at a given intensity."""

import argparse
import math
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rockbatch.commands.analyses import end, journal_of
from rockbatch.commands.messages import count, make_ready, once, say, tell_motions
from rockbatch.commands.options import add_engine, add_study, engine, folder, study_of

if TYPE_CHECKING:
    from rockbatch.analysis.fragility import Curve
    from rockbatch.study.fragility import FragilitySpec

HELP = "fragility curves for overturning and the limits of the checks, from stripes or incremental dynamic analysis"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_study(parser)
    add_engine(parser)


def main(arguments: argparse.Namespace) -> int:
    from dataclasses import replace

    from rockbatch.study.fragility import read_fragility

    started = time.monotonic()
    study = study_of(arguments)
    spec = read_fragility(study)
    directory = folder(arguments)

    from rockbatch.analysis.folder import AnalysisFolder
    from rockbatch.analysis.fragility import assess, intensities, output
    from rockbatch.analysis.fragility_tables import CAPACITIES, POINTS, RUNS, capacities, described, points
    from rockbatch.analysis.waves import Waves
    from rockbatch.batch.digests import digests
    from rockbatch.commands.progress import Progress
    from rockbatch.results.columns import columns
    from rockbatch.study.suite import ground_motions

    study = replace(study, output=output(spec))
    found = ground_motions(study)
    tell_motions(found)
    motions = found.motions
    unscaled = intensities(motions, spec, study.cases[0].pier.gravity)
    if study.motions.scale != (1.0,):
        say("scale of [motions] is not used: the levels of [fragility] take its place")
    digest = digests(
        motions,
        cases=study.cases,
        polarity=study.motions.simulated,
        numerics=(study.numerics, study.output),
        fragility=replace(spec, confidence=0.0),  # which no run depends on
    )
    results = AnalysisFolder(directory, "fragility", study, arguments.fresh)
    with journal_of(results, RUNS, columns(study), digest) as journal, engine(arguments) as carrier:
        runs = len(motions) * len(spec.levels) * len(study.cases)
        then = f"; then first exceedances are bisected to {spec.tolerance:g}" if spec.method == "ida" else ""
        levels = f"{count(len(motions), 'record')} at {len(spec.levels)} levels of {spec.label}"
        say(f"{levels}: {count(runs, 'run')}{once(study)} on {carrier}{then}")
        make_ready(study)
        waves = Waves(study, journal, carrier, Progress)
        curves = assess(study, spec, motions, waves)
        results.info |= described(curves, spec, study, len(motions))
        results.keep_table(POINTS, points(curves, spec, study.varied))
        if spec.method == "ida":
            names = [motion.name for motion in motions]
            results.keep_table(CAPACITIES, capacities(curves, spec, study.varied, names, unscaled))
        else:
            (directory / CAPACITIES).unlink(missing_ok=True)  # of an earlier analysis
        journal.write_in_order(directory / RUNS)
        results.keep(RUNS, digest)
        print(table(curves, spec))
        end(results, runs=waves.finished, wall_s=round(time.monotonic() - started, 3))
    failed = any(stripe.failed for curve in curves for stripe in curve.stripes)
    if failed:
        say(f"some runs failed and are undecided; the column reason of {directory / RUNS} says why")
    return 1 if found.unusable or failed else 0


def table(curves: Sequence["Curve"], spec: "FragilitySpec") -> str:
    """Medians and dispersions with their intervals, a line for each limit and case, and what to know about them."""
    import pandas as pd

    from rockbatch.analysis.fragility_tables import note
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
        if told := note(curve, spec):
            notes.append(f"{curve.limit.name}, {case}: {told}")
        rows.append(row)
    level = f"{100 * spec.confidence:g} %"
    heads = ["limit", "case", f"median [{spec.unit}]", level, "undecided", "dispersion", level]
    found = pd.DataFrame(rows)
    found.columns = pd.Index(heads)
    if not any(curve.readings for curve in curves):
        found = found.drop(columns="undecided")
    limits = [f"{limit.name}: {words(limit)}" for limit in spec.limits if words(limit)]
    title = f"Fragility for {spec.label}, {'incremental dynamic analysis' if spec.method == 'ida' else 'stripes'}"
    if little := sum(curve.says_little for curve in curves):
        some = f"{little} of {count(len(curves), 'curve')} {'says' if little == 1 else 'say'} little"
        title += f"; {some}: too many runs are undecided"
    return "\n".join([title, found.to_string(index=False), *limits, *notes])


def _interval(bounds: tuple[float, float]) -> str:
    low, high = bounds
    return f"{low:.3g} – {'∞' if math.isinf(high) else f'{high:.3g}'}"
