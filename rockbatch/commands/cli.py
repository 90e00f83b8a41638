"""The command line: subcommands, and how mistakes are reported."""
# PYTHON_ARGCOMPLETE_OK: shells with argcomplete's global completion complete it, too

import argparse
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import nullcontext, redirect_stdout, suppress
from pathlib import Path
from typing import Any, NoReturn

from rockbatch.commands.arguments import COMMANDS, DISCARDING
from rockbatch.commands.interrupts import answered_interrupts
from rockbatch.common.errors import InputError, PlainRemark
from rockbatch.common.files import is_stdout
from rockbatch.common.grouping import closest
from rockbatch.common.version import full_version
from rockbatch.terminal.streams import is_lost, open_missing, say, show

_COMMANDS_MEANT = {word: name for name, words in {
    "examples": "list ls demo demos samples", "init": "new create start", "run": "simulate compute solve", "motions": "records",
    "check": "verify", "report": "plot show view html", "fragility": "ida curves", "spectrum": "spectra map",
}.items() for word in words.split()}  # fmt: skip
"""Commands by other words for what they do."""

_OPTIONS_MEANT = {
    "--version": "-v -V",
    "--jobs": "-j --threads --thread --workers --processes --procs --nproc --cores --cpus --n-jobs --parallel",
    "--out": "-o --output --outdir --output-dir --dir --folder --results",
    "--dry-run": "-n --dry --dryrun --estimate",
    "--motions": "--records --ground-motions --input --path",
    "--all": "-a --full --verbose",
    "--rules": "--checks --limits",
}
"""Other words for what an option does; they come before words that are spelt alike."""

EXIT_CODES = """exit codes:
  0    all is fine
  1    a record could not be used, a run failed, or a check did not pass
  2    the input is wrong, and nothing was run
  130  interrupted; what is finished is kept"""


class _Parser(argparse.ArgumentParser):
    """A parser that answers a mistake in one line, and takes options by their whole names: "--f" is not "--fresh"."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        more = "" if message.endswith("?") else f"; `{self.prog} --help` says more"
        self.exit(2, f"{self.prog}: {message}{more}\n")


class _Version(argparse.Action):
    """Prints the version, for which a checkout asks Git, when it is called."""

    def __call__(self, parser: argparse.ArgumentParser, *values: object) -> None:
        show(f"rockbatch {full_version()}")
        parser.exit()


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    commands = "\n".join(f"  {name:<13}{command.help}" for name, command in COMMANDS.items())
    first = "first steps:\n  rockbatch init mypier\n  cd mypier\n  rockbatch run pier.toml"
    root = _Parser(
        prog="rockbatch",
        usage="rockbatch [-h] [--version] COMMAND ...",
        description="Peak rotations of stepping bridge piers under a folder of ground motions.",
        epilog=f"commands:\n{commands}\n\n{first}\n\n{EXIT_CODES}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    root.add_argument("--version", action=_Version, nargs=0)
    subparsers = root.add_subparsers(dest="command", metavar="COMMAND", prog="rockbatch", help=argparse.SUPPRESS)
    for name, command in COMMANDS.items():
        command.add_to(subparsers, name, EXIT_CODES)
    return root


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit code (:data:`EXIT_CODES`); without a command, list the commands."""
    open_missing()
    root = parser()
    if "_ARGCOMPLETE" in os.environ:  # the shell asks what may come next
        with suppress(ImportError):
            import argcomplete

            argcomplete.autocomplete(root)
    parsed, unknown = root.parse_known_args(_with_command(sys.argv[1:] if arguments is None else arguments, root))
    if unknown:
        root.error(f"unrecognized arguments: {' '.join(unknown)}{_options_meant(parsed.command, unknown)}")
    if parsed.command is None:
        root.print_help()
        return 2
    with answered_interrupts():
        code = _exit_code(parsed)
    return code or int(is_lost(sys.stdout))


def _with_command(arguments: Sequence[str], root: argparse.ArgumentParser) -> Sequence[str]:
    """Return the arguments, with "help" as the option that it means; a word that is no command ends with the one meant."""
    word, *rest = arguments or [""]
    if word in COMMANDS or not word or word.startswith("-"):
        return arguments
    if word.lower() in ("help", "version"):
        return [*rest[:1], "--help"] if word.lower() == "help" else ["--version"]
    meant = _COMMANDS_MEANT.get(word.lower()) or closest(word, COMMANDS)
    root.error(f"there is no command {word}" + (f"; did you mean {meant}?" if meant else ""))


def _options_meant(command: str | None, unknown: Sequence[str]) -> str:
    """Return which options of a command, or of rockbatch without one, were probably meant, to follow a message."""
    options = [name for name in COMMANDS[command].arguments if name.startswith("-")] if command else ["--version"]
    if not options:
        return f"; `rockbatch {command}` takes none"
    words = [word.partition("=")[0] for word in unknown if word.startswith("-")]
    known = ", ".join(match for match in (_option_meant(word, options) for word in words) if match)
    return f"; did you mean {known}?" if known else ""


def _option_meant(word: str, options: Sequence[str]) -> str | None:
    """Return the option that a word means, or that is spelt alike; never one that discards results."""
    meant = [name for name, words in _OPTIONS_MEANT.items() if word in words.split()]
    if meant:
        return next((name for name in meant if name in options), None)
    return closest(word, [name for name in options if name not in DISCARDING])


def _exit_code(parsed: argparse.Namespace) -> int:
    """Run a command and return its exit code; report what went wrong in words."""
    is_taken = any(isinstance(value, Path) and is_stdout(value) for value in vars(parsed).values())
    try:
        with redirect_stdout(sys.stderr) if is_taken else nullcontext(), warnings.catch_warnings():
            warnings.simplefilter("always", PlainRemark)
            warnings.showwarning = _plainly(warnings.showwarning)
            return COMMANDS[parsed.command].run_command(parsed)
    except InputError as error:
        for problem in error.messages:
            say(f"rockbatch: {problem}")
        return 2
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        say(f"rockbatch: {place}{error.strerror or error}; choose another folder, or make this one writable")
        return 2
    except MemoryError as error:
        say(
            f"rockbatch: {str(error) or 'out of memory: run fewer at a time (--jobs), keep fewer histories, or allow more'}"
        )
        return 2
    except ImportError as error:
        if "failed to map segment" not in str(error):  # as the loader says it where memory is limited
            raise
        say(f"rockbatch: {error}: is memory limited (ulimit -v, or a job's limit)? Allow more, and repeat the command")
        return 2
    except KeyboardInterrupt:
        say("rockbatch: interrupted")
        return 130


def _plainly(otherwise: Callable[..., None]) -> Callable[..., None]:
    """Return how warnings are shown: plain remarks once and in plain words, others ``otherwise``."""
    shown = set()

    def show(message: Warning | str, category: type[Warning], *place: Any) -> None:
        if not issubclass(category, PlainRemark):
            otherwise(message, category, *place)
        elif str(message) not in shown:
            shown.add(str(message))
            say(f"rockbatch: {message}")

    return show


if __name__ == "__main__":
    sys.exit(main())
