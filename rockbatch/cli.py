"""The command line: subcommands, and how mistakes are told."""
# PYTHON_ARGCOMPLETE_OK: shells with argcomplete's global completion complete it, too

import argparse
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
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


EXIT_CODES = """exit codes:
  0    all is fine
  1    a record could not be used, a run failed, or a check did not pass
  2    the input is wrong, and nothing was run
  130  interrupted; what is finished is kept"""


def parser() -> argparse.ArgumentParser:
    """What the command line understands."""
    plain = argparse.RawDescriptionHelpFormatter
    commands = "\n".join(f"  {name:<13}{command.HELP}" for name, command in COMMANDS.items())
    first = "first steps:\n  rockbatch init mypier\n  cd mypier\n  rockbatch run pier.toml"
    found = argparse.ArgumentParser(
        prog="rockbatch",
        usage="rockbatch [-h] [--version] COMMAND ...",
        description="Peak rotations of stepping bridge piers under a folder of ground motions.",
        epilog=f"commands:\n{commands}\n\n{first}\n\n{EXIT_CODES}",
        formatter_class=plain,
    )
    found.add_argument("--version", action="version", version=f"rockbatch {__version__}")
    subparsers = found.add_subparsers(dest="command", metavar="COMMAND", prog="rockbatch", help=argparse.SUPPRESS)
    for name, command in COMMANDS.items():
        epilog = f"example:\n  {command.EXAMPLE}\n\n{EXIT_CODES}"
        command.add_arguments(
            subparsers.add_parser(name, description=command.HELP, epilog=epilog, formatter_class=plain)
        )
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code: :data:`EXIT_CODES`. Without a command it lists those that there are."""
    understood = parser()
    if "_ARGCOMPLETE" in os.environ:  # the shell asks what may come next
        with suppress(ImportError):
            import argcomplete

            argcomplete.autocomplete(understood)
    parsed = understood.parse_args(arguments)
    if parsed.command is None:
        understood.print_help()
        return 2
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
