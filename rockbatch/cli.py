"""The command line: subcommands, and how mistakes are told."""

import argparse
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from typing import Any

from rockbatch._version import __version__
from rockbatch.commands import (
    accuracy,
    check,
    examples,
    fragility,
    init,
    merge,
    motions,
    report,
    run,
    sensitivity,
    spectrum,
)
from rockbatch.errors import InputError, MissingColumns

COMMANDS = {
    "init": init,
    "examples": examples,
    "run": run,
    "merge": merge,
    "motions": motions,
    "check": check,
    "report": report,
    "accuracy": accuracy,
    "fragility": fragility,
    "spectrum": spectrum,
    "sensitivity": sensitivity,
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code (0 fine, 1 some record or check failed, 2 wrong input, 130)."""
    parser = argparse.ArgumentParser(
        prog="rockbatch", description="Peak rotations of stepping bridge piers under a folder of ground motions."
    )
    parser.add_argument("--version", action="version", version=f"rockbatch {__version__}")
    subparsers = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, command in COMMANDS.items():
        command.add_arguments(subparsers.add_parser(name, help=command.HELP, description=command.HELP))
    parsed = parser.parse_args(arguments)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("always", MissingColumns)
            warnings.showwarning = _plainly(warnings.showwarning)
            return COMMANDS[parsed.command].main(parsed)
    except InputError as error:
        for problem in error.problems:
            print(f"rockbatch: {problem}", file=sys.stderr)
        return 2
    except BrokenPipeError:  # whoever reads has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        print(
            f"rockbatch: {place}{error.strerror or error}; choose another place, or make this one usable",
            file=sys.stderr,
        )
        return 2
    except KeyboardInterrupt:
        print("rockbatch: interrupted", file=sys.stderr)
        return 130


def _plainly(otherwise: Callable[..., None]) -> Callable[..., None]:
    """How warnings are shown: what there is to say of a folder of results once and in plain words, others ``otherwise``."""
    said = set()

    def show(message: Warning | str, category: type[Warning], *place: Any) -> None:
        if not issubclass(category, MissingColumns):
            otherwise(message, category, *place)
        elif str(message) not in said:
            said.add(str(message))
            print(f"rockbatch: {message}", file=sys.stderr)

    return show


if __name__ == "__main__":
    sys.exit(main())
