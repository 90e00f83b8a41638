"""Arguments and printing shared by the commands of analyses."""

import argparse
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TypedDict

from rockbatch.batch.listening import Listener, count
from rockbatch.batch.threads import Engine
from rockbatch.common.units import with_unit
from rockbatch.reporting.markup import number
from rockbatch.reporting.table import Head
from rockbatch.results.labelled import Item
from rockbatch.terminal.messages import Terminal
from rockbatch.terminal.options import engine, folder
from rockbatch.terminal.streams import in_width, say
from rockbatch.workflow.analysis import Analysis


class AnalysisArguments(TypedDict):
    """Arguments that every analysis takes."""

    out: Path
    jobs: Engine
    fresh: bool
    progress: Listener


def analysis_arguments(arguments: argparse.Namespace) -> AnalysisArguments:
    """Return the folder, engine, --fresh and a listener for an analysis, by the names of its parameters."""
    return {"out": folder(arguments), "jobs": engine(arguments), "fresh": arguments.fresh, "progress": Terminal()}


def finished(analysis: Analysis) -> int:
    """Print the paths of the files that were written, and how many runs failed, on stderr; return the exit code.

    It is 1 if a record is unusable or a run failed, of all that were carried out, else 0.
    """
    for path in analysis.files:
        say(str(path))
    code = 1 if analysis.unusable else 0
    for name, runs in analysis.tables.items():
        if name in analysis.RUNS and (failed := int((runs["status"] == "failed").sum())):
            say(f"{failed} of {count(len(runs), 'run')} failed: see the column reason of {name}.csv")
            code = 1
    return code


def in_lines(heads: Sequence[Head], items: Iterable[Item], names: int = 1) -> str:
    """Return a table as text, with the heads and cells of :func:`rockbatch.reporting.table.listed`.

    The first ``names`` columns identify a row; other columns are left out if empty, as all are without items. A head over
    several columns is printed above the first of them.
    """
    rows = [[cell(head, item) for head in heads] for item in items]
    used = [place for place in range(len(heads)) if place < names or any(row[place] for row in rows)]
    groups = [heads[place].group for place in used]
    lines = [
        [with_unit(heads[place].text, heads[place].unit) for place in used],
        *([row[place] for place in used] for row in rows),
    ]
    if any(groups):
        pairs = zip(["", *groups], groups, strict=False)
        lines.insert(0, ["" if group == previous else group for previous, group in pairs])
    return in_width(lines[0], lines[1:], names)


def cell(head: Head, item: Item) -> str:
    """Return the cell of an item as plain text, in the form of its head; "" for None and NaN."""
    return number(head.value_in(item), head.form).replace("\u00a0", " ").replace("\u2060", "")
