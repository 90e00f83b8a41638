"""``rockbatch init`` and ``rockbatch examples``: write a starter study, and list the examples."""

import argparse
import shlex
import shutil
import sys
from pathlib import Path

from rockbatch.commands.example_studies import CHECKS, FIRST, copy, examples
from rockbatch.common.errors import InputError
from rockbatch.terminal.streams import show


def init(arguments: argparse.Namespace) -> int:
    """Copy an example study with its records and checks, print the paths and the next steps, and return 0.

    Raises ``InputError`` if the folder has the name of an example and none is chosen.
    """
    word = str(arguments.folder)
    if arguments.example == FIRST != word and word in {example.name for example in examples()}:
        raise InputError(f"{word}: is an example; write rockbatch init {word} --example {word}, or give another folder")
    study = "pier.toml" if arguments.example == FIRST else f"{arguments.example}.toml"
    for path in copy(arguments.example, arguments.folder, study):
        show(str(path))
    change_folder = "" if arguments.folder == Path() else f"cd {arguments.folder}\n    "
    limits = f"in {CHECKS}" if arguments.example == FIRST else f"({CHECKS} has many to choose from)"
    report = Path("reports", Path(study).stem, "report.html")
    show(
        f"\nNext:\n\n    {change_folder}{_called()} run {study}\n\n"
        f"It writes a report to {report}. Then enter your pier's numbers and the\n"
        f"folder of your records (path) in {study}, and set limits {limits}."
    )
    return 0


def _called() -> str:
    """Return the command for rockbatch in a shell: its name, or its path if the name is not on PATH."""
    script = shutil.which("rockbatch", path=str(Path(sys.executable).parent))
    return "rockbatch" if script is None or shutil.which("rockbatch") == script else shlex.quote(script)


def main(arguments: argparse.Namespace) -> int:
    """List the examples, with how to copy and run them; return 0."""
    del arguments
    every = examples()
    width = max(len(example.name) for example in every)
    for example in every:
        needs = ' (needs pip install "rockbatch[records]")' if example.package else ""
        show(f"{example.name:<{width}}  {example.title}{needs}")
    show("\nA copy to work on, with its records: rockbatch init FOLDER --example NAME")
    show(f"Or as they are:                      rockbatch {every[0].command} {every[0].path}")
    return 0
