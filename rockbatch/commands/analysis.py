"""What the commands of analyses share: their arguments, and the paths that they print."""

import argparse
from typing import Any

from rockbatch.batch.analysis import Analysis
from rockbatch.commands.messages import Terminal
from rockbatch.commands.options import engine, folder
from rockbatch.commands.streams import say


def analysis_arguments(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the arguments of every analysis: its folder, its engine, and the listener for its messages."""
    return {"out": folder(arguments), "jobs": engine(arguments), "fresh": arguments.fresh, "progress": Terminal()}


def print_files(analysis: Analysis) -> None:
    """Print the paths of the files that were written."""
    for path in analysis.files:
        say(str(path))
