"""``rockbatch init`` and ``rockbatch examples``: a new study to begin with, and those that come with rockbatch."""

import argparse
import shlex
import shutil
import sys
from pathlib import Path

from rockbatch.commands.example_studies import CHECKS, FIRST, copy, examples
from rockbatch.terminal.streams import show


def init(arguments: argparse.Namespace) -> int:
    """Write a study to begin with, and its records."""
    study = "pier.toml" if arguments.example == FIRST else f"{arguments.example}.toml"
    for path in copy(arguments.example, arguments.folder, study):
        show(str(path))
    change_folder = "" if arguments.folder == Path() else f"cd {arguments.folder}\n    "
    limits = f"in {CHECKS}" if arguments.example == FIRST else f"({CHECKS} has many to choose from)"
    report = Path("reports", Path(study).stem, "report.html")
    show(
        f"\nNext:\n\n    {change_folder}{_called()} run {study}\n\n"
        f"It leaves a report in {report}. Then put the numbers of your pier and the\n"
        f"folder of your records (path) into {study}, and agree on limits {limits}."
    )
    return 0


def _called() -> str:
    """Return the word by which a shell finds rockbatch from any folder: its name, or its path if the name is not on PATH."""
    script = shutil.which("rockbatch", path=str(Path(sys.executable).parent))
    return "rockbatch" if script is None or shutil.which("rockbatch") == script else shlex.quote(script)


def main(arguments: argparse.Namespace) -> int:
    """List the examples."""
    del arguments
    every = examples()
    width = max(len(example.name) for example in every)
    for example in every:
        needs = ' (needs pip install "rockbatch[records]")' if example.package else ""
        show(f"{example.name:<{width}}  {example.title}{needs}")
    show("\nA copy to work on, with its records: rockbatch init FOLDER --example NAME")
    show(f"Or as they are:                      rockbatch {every[0].command} {every[0].path}")
    return 0
