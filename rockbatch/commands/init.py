"""``rockbatch init``: a new study to begin with."""

import argparse
import shlex
import shutil
import sys
from pathlib import Path

from rockbatch.commands.messages import show
from rockbatch.examples import CHECKS, FIRST, copy

HELP = "write a study of your own to begin with, and its records"
EXAMPLE = "rockbatch init mypier"
STUDY = "pier.toml"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=Path, nargs="?", default=Path(), metavar="FOLDER", help="where (default: here)")
    parser.add_argument(
        "--example", default=FIRST, metavar="NAME", help="begin with another example; `rockbatch examples` lists them"
    )


def main(arguments: argparse.Namespace) -> int:
    study = STUDY if arguments.example == FIRST else f"{arguments.example}.toml"
    written = copy(arguments.example, arguments.folder, study)
    for path in written:
        show(str(path))
    there = "" if arguments.folder == Path() else f"cd {arguments.folder}\n    "
    limits = f"in {CHECKS}" if arguments.example == FIRST else f"({CHECKS} has many to choose from)"
    show(f"\nNext:\n\n    {there}{_called()} run {study}\n")
    show(
        f"It leaves a report in {Path('reports', Path(study).stem, 'report.html')}. Then put the numbers of your pier and the"
    )
    show(f"folder of your records (path) into {study}, and agree on limits {limits}.")
    return 0


def _called() -> str:
    """Return what a shell needs to find rockbatch from any folder: its name, or its path if the name would not do."""
    here = shutil.which("rockbatch", path=str(Path(sys.executable).parent))
    return "rockbatch" if here is None or shutil.which("rockbatch") == here else shlex.quote(here)
