"""``rockbatch init``: a study of one's own to begin with."""

import argparse
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
    show(f"\nNext:\n\n    {there}rockbatch run {study}\n")
    show(
        f"It leaves a report in {Path('reports', Path(study).stem, 'report.html')}. Then put in the numbers of your pier and a"
    )
    show(f"folder of your records ({study} says where), and agree on limits ({CHECKS} has many to choose from).")
    return 0
