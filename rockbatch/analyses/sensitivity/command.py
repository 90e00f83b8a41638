"""``rockbatch sensitivity``: the sensitivity of the peak rotation, one at a time and by Sobol's indices."""

import argparse

from rockbatch.analyses.sensitivity.analysis import sensitivity
from rockbatch.analyses.sensitivity.answer import on_coverage
from rockbatch.analyses.sensitivity.quantities import of_inputs
from rockbatch.batch.listening import count
from rockbatch.common.analyses import Entry
from rockbatch.common.lazy import pd
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.reporting.finished_analysis import named
from rockbatch.reporting.table import Head
from rockbatch.results.labelled import as_dicts
from rockbatch.study import Study
from rockbatch.terminal.analysis import analysis_arguments, finished, in_lines
from rockbatch.terminal.streams import say, show


def main(arguments: argparse.Namespace, study: Study) -> int:
    """Compute and print the sensitivity of the peak rotation; return the exit code."""
    result = sensitivity(study, **analysis_arguments(arguments))
    show(shown(result.info, result.sensitivity, result.sobol))
    ended = ", ".join(f"{number} {status}" for status, number in sorted(result.info["statuses"].items()))
    cut = f"theta_max/alpha = {result.spec.overturned:g}"
    say(f"{ended}; runs that overturned or were ended by flight count as {cut}")
    if coverage := on_coverage(result.info):
        say(coverage)
    return finished(result)


def shown(info: Entry, swings: "pd.DataFrame", shares: "pd.DataFrame") -> str:
    """Return both tables for a terminal, a block for each case: the answer at both ends, and the indices with their errors."""
    keys = ["case", *info["varied"]]
    heads, blocks = [Head("input", value="parameter"), *of_inputs(info)], []
    statistic = STATISTICS[info["statistic"]].words
    for names, of_case in swings.groupby(keys, sort=False, dropna=False):
        rows = as_dicts(of_case.merge(shares, on=[*keys, "parameter"]))
        title = named(info, dict(zip(keys, names, strict=True)), keys)
        suite = f"{statistic} of theta_max/alpha over {count(info['motions'], 'motion')}"
        blocks.append(f"{title}: {suite}, one at a time, and Sobol indices\n{in_lines(heads, rows)}")
    return "\n\n".join(blocks)
