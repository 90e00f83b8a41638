"""Arguments and printing that the commands of analyses share."""

import argparse
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from rockbatch.reporting.markup import number
from rockbatch.reporting.table import Head
from rockbatch.terminal.messages import Terminal
from rockbatch.terminal.options import engine, folder
from rockbatch.terminal.streams import in_width, say
from rockbatch.workflow.analysis import Analysis


def analysis_arguments(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the arguments of every analysis: its folder, its engine, and the listener for its messages."""
    return {"out": folder(arguments), "jobs": engine(arguments), "fresh": arguments.fresh, "progress": Terminal()}


def print_files(analysis: Analysis) -> None:
    """Print the paths of the files that were written."""
    for path in analysis.files:
        say(str(path))


def in_lines(heads: Sequence[Head], items: Iterable[Mapping[str, Any]], names: int = 1) -> str:
    """Return a table for the terminal, with the heads and cells of the page's (:func:`rockbatch.reporting.table.listed`).

    The first ``names`` columns name a row; others without a value are left out. A head over several columns stands above the
    first of them.
    """
    rows = [[cell(head, item) for head in heads] for item in items]
    used = [place for place in range(len(heads)) if place < names or any(row[place] for row in rows)]
    groups = [heads[place].group for place in used]
    lines = [[heads[place].text for place in used], *([row[place] for place in used] for row in rows)]
    if any(groups):
        pairs = zip(["", *groups], groups, strict=False)
        lines.insert(0, ["" if group == previous else group for previous, group in pairs])
    return in_width(lines[0], lines[1:], names)


def cell(head: Head, item: Mapping[str, Any]) -> str:
    """Return a value of an item as the terminal shows it."""
    return number(head.value_in(item), head.form).replace("\u00a0", " ").replace("\u2060", "")
