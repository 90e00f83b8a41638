"""Arguments of several commands: the folder of the results, and the engine that carries out the runs."""

import argparse
from pathlib import Path

from rockbatch.batch.dask import Dask
from rockbatch.batch.threads import Engine, Threads, cores


def folder(arguments: argparse.Namespace) -> Path:
    """Return the folder of the results."""
    return arguments.out or Path("reports") / arguments.study.stem


def engine(arguments: argparse.Namespace) -> Engine:
    """Return the engine that carries out the runs; a context."""
    if arguments.engine == "dask" or arguments.scheduler:
        return Dask(arguments.scheduler, arguments.jobs)
    return Threads(arguments.jobs or cores())
