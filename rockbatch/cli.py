"""The command line: subcommands, and how mistakes are told."""

import argparse
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
from rockbatch.commands.messages import say
from rockbatch.commands.streams import is_lost, open_missing
from rockbatch.errors import AboutResults, InputError

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
    open_missing()
    parser = argparse.ArgumentParser(
        prog="rockbatch", description="Peak rotations of stepping bridge piers under a folder of ground motions."
    )
    parser.add_argument("--version", action="version", version=f"rockbatch {__version__}")
    subparsers = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, command in COMMANDS.items():
        command.add_arguments(subparsers.add_parser(name, help=command.HELP, description=command.HELP))
    code = _carried_out(parser.parse_args(arguments))
    return code or int(is_lost(sys.stdout))


def _carried_out(parsed: argparse.Namespace) -> int:
    """The exit code of a command; what went wrong is told in words."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("always", AboutResults)
            warnings.showwarning = _plainly(warnings.showwarning)
            return COMMANDS[parsed.command].main(parsed)
    except InputError as error:
        for problem in error.problems:
            say(f"rockbatch: {problem}")
        return 2
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        say(f"rockbatch: {place}{error.strerror or error}; choose another place, or make this one usable")
        return 2
    except KeyboardInterrupt:
        say("rockbatch: interrupted")
        return 130


def _plainly(otherwise: Callable[..., None]) -> Callable[..., None]:
    """How warnings are shown: what there is to say of a folder of results once and in plain words, others ``otherwise``."""
    said = set()

    def show(message: Warning | str, category: type[Warning], *place: Any) -> None:
        if not issubclass(category, AboutResults):
            otherwise(message, category, *place)
        elif str(message) not in said:
            said.add(str(message))
            say(f"rockbatch: {message}")

    return show


if __name__ == "__main__":
    sys.exit(main())
