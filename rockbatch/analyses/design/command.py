"""``rockbatch design``: the values of a key that pass every check."""

import argparse

from rockbatch.analyses.design.analysis import design
from rockbatch.analyses.design.answer import answer
from rockbatch.analyses.design.quantities import heads
from rockbatch.checks.verdicts import PASS
from rockbatch.checks.wording import SIGNS
from rockbatch.results.labelled import as_dicts
from rockbatch.study import Study
from rockbatch.terminal.analysis import analysis_arguments, finished, in_lines
from rockbatch.terminal.streams import filled, show


def main(arguments: argparse.Namespace, study: Study) -> int:
    """Find the values that pass, and print them: the answer, then the intervals.

    Return the exit code, 1 also if no value passes in some case.
    """
    result = design(study, **analysis_arguments(arguments))
    said = answer(result.info, result.design, result.design_values)
    show("\n".join(filled(f"{SIGNS.get(verdict, '')} {words}".lstrip()) for verdict, words in said))
    show(f"\n{in_lines(heads(result.info), as_dicts(result.design))}")
    passing = set(result.design.loc[result.design["verdict"] == PASS, "case"])
    every = {entry["case"] for entry in result.info["designs"]}
    return max(finished(result), passing != every)
