"""``rockbatch release``: restitution, or the losses of springs, fitted to a release test."""

import argparse

from rockbatch.analyses.release.analysis import release
from rockbatch.analyses.release.quantities import IMPACTS, in_words
from rockbatch.common.lazy import pd
from rockbatch.results.labelled import as_dicts
from rockbatch.study import Study
from rockbatch.terminal.analysis import in_lines, print_files
from rockbatch.terminal.messages import Terminal
from rockbatch.terminal.naming import named
from rockbatch.terminal.options import folder
from rockbatch.terminal.streams import show


def main(arguments: argparse.Namespace, study: Study) -> int:
    """Fit the test, and print what was fitted and how measured and computed values differ."""
    result = release(study, folder(arguments), progress=Terminal())
    show(shown(result.release, result.release_impacts, study.varied))
    print_files(result)
    return 0


def shown(fits: "pd.DataFrame", impacts: "pd.DataFrame", varied: tuple[str, ...]) -> str:
    """Return a block for each case: the fitted value, how well it describes the test, and a table of impacts."""
    keys, blocks = ["case", *varied], []
    for (names, rows), fit in zip(impacts.groupby(keys, sort=False, dropna=False), as_dicts(fits), strict=True):
        head = f"{names[0]} {named(varied, names[1:])}".rstrip()
        blocks.append(f"{head}: {in_words(fit)}.\n  {fit['remark']}\n{in_lines(IMPACTS, as_dicts(rows))}")
    return "\n\n".join(blocks)
