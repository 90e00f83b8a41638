"""``rockbatch sensitivity``: what the peak rotation hangs on, one at a time and by Sobol's indices."""

import argparse
import csv
import time
from dataclasses import asdict, replace
from typing import TYPE_CHECKING

from rockbatch.commands.analyses import end, journal_of
from rockbatch.commands.messages import count, make_ready, once, say, tell_motions
from rockbatch.commands.options import add_engine, add_study, engine, folder, study_of

if TYPE_CHECKING:
    import pandas as pd

HELP = "which parameters the peak rotation hangs on: one at a time, and Sobol indices over stated ranges"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_study(parser)
    add_engine(parser)


def main(arguments: argparse.Namespace) -> int:
    from rockbatch.study.sensitivity import read_sensitivity

    started = time.monotonic()
    study = study_of(arguments)
    spec = read_sensitivity(study)

    from rockbatch.analysis import sensitivity as analysis
    from rockbatch.analysis.folder import AnalysisFolder
    from rockbatch.analysis.sampled import COLUMNS, RUNS, Points, Suite, row_of
    from rockbatch.batch.carrying_out import carry_out
    from rockbatch.batch.digests import digests
    from rockbatch.commands.progress import Progress
    from rockbatch.study.suite import ground_motions

    results = AnalysisFolder(folder(arguments), "sensitivity", study, arguments.fresh)
    wanted = study
    if any(each.name == "vertical" for each in spec.inputs):  # read it, whatever the study does with it
        wanted = replace(study, motions=replace(study.motions, vertical=study.motions.vertical or True))
    motions = ground_motions(wanted)
    tell_motions(motions)
    points = Points(study, spec)
    suite = Suite(study, points, motions.motions)
    runs = suite.runs()
    digest = digests(
        motions.motions,
        cases=study.cases,
        inputs=[(point.case, sorted(point.values.items())) for point in points.all],
        scales=(study.motions.vertical, study.motions.polarity, study.motions.scale),
        numerics=study.numerics,
    )
    results.info |= {
        "varied": list(study.varied),
        **{name: value for name, value in asdict(spec).items() if name != "inputs"},
        "inputs": [asdict(each) for each in spec.inputs],
        "motions": len(suite.members),
    }
    path = results.directory / RUNS
    with engine(arguments) as carrier:
        say(
            f"{count(len(points), 'point')} × {count(len(suite.members), 'motion')} = {len(runs)} runs{once(study)} on {carrier}"
        )
        if results.has(RUNS, digest):
            results.keep(RUNS, digest)
        else:
            make_ready(replace(study, cases=suite.some_cases()))
            with journal_of(results, RUNS, COLUMNS, digest) as journal:
                with Progress(len(runs) - len(journal)) as progress:
                    carry_out(runs, study.numerics, journal, carrier, row=row_of, progress=progress)
                journal.write_in_order(path)
                results.keep(RUNS, digest)
        told = str(carrier)
    with path.open(encoding="utf-8", newline="") as rows:
        statuses, values = analysis.values_of(csv.DictReader(rows), len(points), spec.overturned)
    results.info["statuses"] = statuses
    swings, shares = analysis.tables(study, spec, points, values)
    results.keep_table(analysis.ONE_AT_A_TIME, swings)
    results.keep_table(analysis.SOBOL, shares)
    print(shown(swings, shares, study.varied))
    ended = ", ".join(f"{number} {status}" for status, number in sorted(statuses.items()))
    say(f"{ended}; runs that overturned or were ended by flight count as theta_max/alpha = {spec.overturned:g}")
    end(results, engine=told, wall_s=round(time.monotonic() - started, 3))
    return 1 if motions.unusable else 0  # what failed counts, as the report says


def shown(swings: "pd.DataFrame", shares: "pd.DataFrame", varied: tuple[str, ...]) -> str:
    """Both tables for a terminal, a block for each case: the answer at both ends, and the indices with their errors."""
    from rockbatch.commands.summary import named

    keys = ["case", *varied]
    blocks = []
    for names, own in swings.groupby(keys, sort=False, dropna=False):
        both = own.merge(shares, on=[*keys, "parameter"])
        cells = {
            "": both["parameter"],
            "low": both["low"].map(_value),
            "base": both["base"].map(_value),
            "high": both["high"].map(_value),
            **{f"at {end}": both[f"answer_{end}"].map("{:.4f}".format) for end in ("low", "base", "high")},
            "first-order": both["first"].map("{:z.2f}".format) + both["first_error"].map(" ± {:.2f}".format),
            "total": both["total"].map("{:z.2f}".format) + both["total_error"].map(" ± {:.2f}".format),
        }
        head = f"{names[0]} {named(varied, names[1:])}".rstrip()
        blocks.append(f"{head}: theta_max/alpha one at a time, and Sobol indices\n{_aligned(cells)}")
    return "\n\n".join(blocks)


def _aligned(cells: "dict[str, pd.Series]") -> str:
    import pandas as pd

    return pd.DataFrame(cells).to_string(index=False)


def _value(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
