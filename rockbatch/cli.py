"""The command line: subcommands, and how mistakes are reported."""
# PYTHON_ARGCOMPLETE_OK: shells with argcomplete's global completion complete it, too

import argparse
import os
import re
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


EXIT_CODES = """exit codes:
  0    all is fine
  1    a record could not be used, a run failed, or a check did not pass
  2    the input is wrong, and nothing was run
  130  interrupted; what is finished is kept"""


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    plain = argparse.RawDescriptionHelpFormatter
    commands = "\n".join(f"  {name:<13}{command.HELP}" for name, command in COMMANDS.items())
    first = "first steps:\n  rockbatch init mypier\n  cd mypier\n  rockbatch run pier.toml"
    root = argparse.ArgumentParser(
        prog="rockbatch",
        usage="rockbatch [-h] [--version] COMMAND ...",
        description="Peak rotations of stepping bridge piers under a folder of ground motions.",
        epilog=f"commands:\n{commands}\n\n{first}\n\n{EXIT_CODES}",
        formatter_class=plain,
    )
    root.add_argument("--version", action="version", version=f"rockbatch {__version__}")
    subparsers = root.add_subparsers(dest="command", metavar="COMMAND", prog="rockbatch", help=argparse.SUPPRESS)
    for name, command in COMMANDS.items():
        epilog = f"example:\n  {command.EXAMPLE}\n\n{EXIT_CODES}"
        command.add_arguments(
            subparsers.add_parser(name, description=command.HELP, epilog=epilog, formatter_class=plain)
        )
    return root


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit code (:data:`EXIT_CODES`); without a command, list the commands."""
    open_missing()
    root = parser()
    if "_ARGCOMPLETE" in os.environ:  # the shell asks what may come next
        with suppress(ImportError):
            import argcomplete

            argcomplete.autocomplete(root)
    parsed, unknown = root.parse_known_args(arguments)
    if unknown:
        root.error(f"unrecognized arguments: {' '.join(unknown)}{_meant(parsed.command, unknown)}")
    if parsed.command is None:
        root.print_help()
        return 2
    code = _carried_out(parsed)
    return code or int(is_lost(sys.stdout))


def _meant(command: str | None, unknown: Sequence[str]) -> str:
    """Return which options of the command were probably meant; empty if none is like them."""
    from rockbatch.toml.kinds import closest

    if command is None:
        return ""
    known = argparse.ArgumentParser()
    COMMANDS[command].add_arguments(known)
    options = re.findall(r"--[\w-]+", known.format_usage())
    meant = [closest(word.partition("=")[0], options) for word in unknown if word.startswith("--")]
    return f"; did you mean {', '.join(filter(None, meant))}?" if any(meant) else ""


def _carried_out(parsed: argparse.Namespace) -> int:
    """Run a command and return its exit code; report what went wrong in words."""
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
    """Return how warnings are shown: those about a folder of results once and in plain words, others ``otherwise``."""
    shown = set()

    def show(message: Warning | str, category: type[Warning], *place: Any) -> None:
        if not issubclass(category, AboutResults):
            otherwise(message, category, *place)
        elif str(message) not in shown:
            shown.add(str(message))
            say(f"rockbatch: {message}")

    return show


if __name__ == "__main__":
    sys.exit(main())
