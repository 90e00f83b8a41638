"""Options that commands share: the folder of the results, and the engine that carries out the runs."""

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockbatch.batch.threads import Engine
    from rockbatch.study import Study


def add_study(parser: argparse.ArgumentParser) -> None:
    """Add the options for the study, its motions and the folder of its results."""
    parser.add_argument("study", type=Path, metavar="STUDY.toml", help="the study file")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for the results (default: reports/STUDY)")
    parser.add_argument(
        "--motions", type=Path, metavar="PATH", help="file or folder of records instead of the study's motions"
    )
    parser.add_argument("--strict", action="store_true", help="run nothing if any record cannot be used")


def study_of(arguments: argparse.Namespace) -> "Study":
    """Return the study that is given, with the changes that the command line makes."""
    from rockbatch.study import load_study

    study = load_study(arguments.study, motions=arguments.motions)
    return replace(study, motions=replace(study.motions, strict=True)) if arguments.strict else study


def add_engine(parser: argparse.ArgumentParser) -> None:
    """Add the options for the engine that carries out the runs, and for starting over."""
    parser.add_argument("--jobs", type=_jobs, metavar="N", help="threads, or processes (default: all processors)")
    parser.add_argument(
        "--fresh", action="store_true", help="start over, instead of going on with what is finished in the folder"
    )
    parser.add_argument(
        "--engine",
        choices=("threads", "dask"),
        help="threads of this process (default), or a dask.distributed cluster",
    )
    parser.add_argument(
        "--scheduler",
        type=_address,
        metavar="ADDRESS",
        help="a dask scheduler that runs already (default: processes of this machine)",
    )


def _address(text: str) -> str:
    if not text.strip():
        raise argparse.ArgumentTypeError("must be an address such as tcp://10.0.0.1:8786; it is empty")
    return text


def _jobs(text: str) -> int:
    jobs = int(text)
    if jobs < 1:
        raise argparse.ArgumentTypeError(f"{text}: must be at least 1")
    return jobs


def folder(arguments: argparse.Namespace) -> Path:
    """Return the folder of the results."""
    return arguments.out or Path("reports") / arguments.study.stem


def engine(arguments: argparse.Namespace) -> "Engine":
    """Return the engine that carries out the runs; a context."""
    from rockbatch.batch.threads import Threads, cores

    if arguments.engine == "dask" or arguments.scheduler:
        from rockbatch.batch.dask import Dask

        return Dask(arguments.scheduler, arguments.jobs)
    return Threads(arguments.jobs or cores())
