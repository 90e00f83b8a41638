"""Arguments of several commands: the folder of the results, and the engine that carries out the runs."""

import argparse
from pathlib import Path
from typing import Any

from rockbatch.analysis.folder import Analysis
from rockbatch.batch.dask import Dask
from rockbatch.batch.threads import Engine, Threads, cores
from rockbatch.commands.messages import Terminal
from rockbatch.commands.streams import say


def folder(arguments: argparse.Namespace) -> Path:
    """Return the folder of the results."""
    return arguments.out or Path("reports") / arguments.study.stem


def engine(arguments: argparse.Namespace) -> Engine:
    """Return the engine that carries out the runs; a context."""
    if arguments.engine == "dask" or arguments.scheduler:
        return Dask(arguments.scheduler, arguments.jobs)
    return Threads(arguments.jobs or cores())


def analysis_arguments(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the arguments of every analysis: its folder, its engine, and the listener for its messages."""
    return {"out": folder(arguments), "jobs": engine(arguments), "fresh": arguments.fresh, "progress": Terminal()}


def tell_files(analysis: Analysis) -> None:
    """Print the paths of the files that were written."""
    for path in analysis.files:
        say(str(path))
