"""``rockbatch accuracy``: error against time per run for a study on this machine."""

import argparse

from rockbatch.analyses.accuracy.analysis import accuracy
from rockbatch.analyses.accuracy.levels import NO_ERROR, chosen, of_table
from rockbatch.analyses.accuracy.quantities import QUANTITIES, rows
from rockbatch.common.lazy import pd
from rockbatch.study import Study
from rockbatch.terminal.analysis import finished, in_lines
from rockbatch.terminal.messages import Terminal
from rockbatch.terminal.options import folder
from rockbatch.terminal.streams import show


def main(arguments: argparse.Namespace, study: Study) -> int:
    """Measure errors against times, and print them; return the exit code."""
    result = accuracy(study, folder(arguments), runs=arguments.runs, seconds=arguments.seconds, progress=Terminal())
    show(shown(result.accuracy))
    return finished(result)


def shown(table: "pd.DataFrame") -> str:
    """Return the table for the terminal: errors of θ_max/α, and times per run; with a line if there is no error."""
    change, levels = table["reference_change"].max(), of_table(table)
    lines = [f"Error of theta_max/alpha (references known to {change:.0e})", in_lines(QUANTITIES, rows(levels))]
    return "\n".join(lines if chosen(levels) else [*lines, NO_ERROR])
