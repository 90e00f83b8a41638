"""Values of arguments shared by several commands: the results' folder, and the engine for runs."""

import argparse
from pathlib import Path

from rockbatch.batch.dask import Dask
from rockbatch.batch.threads import Engine, Threads, cores


def folder(arguments: argparse.Namespace) -> Path:
    """Return the folder of --out, or by default reports/ and the name of the study file without its suffix."""
    return arguments.out or Path("reports") / arguments.study.stem


def engine(arguments: argparse.Namespace) -> Engine:
    """Return the engine of --engine, --scheduler and --jobs, a context: Dask if either asks for it, else threads.

    Without --jobs there is a thread for each processor.
    """
    if arguments.engine == "dask" or arguments.scheduler:
        return Dask(arguments.scheduler, arguments.jobs)
    return Threads(arguments.jobs or cores())
