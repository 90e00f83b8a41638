"""The command line: parse arguments, run the command, report mistakes."""
# PYTHON_ARGCOMPLETE_OK: shells with argcomplete's global completion complete it, too

import argparse
import functools
import os
import re
import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import nullcontext, redirect_stdout, suppress
from pathlib import Path
from typing import NoReturn

from rockbatch.commands.arguments import COMMANDS, DISCARDING
from rockbatch.commands.interrupts import answered_interrupts
from rockbatch.common.errors import InputError, PlainRemark
from rockbatch.common.files import is_stdout
from rockbatch.common.grouping import closest
from rockbatch.common.version import full_version
from rockbatch.terminal.streams import is_lost, open_missing, say, show

_COMMANDS_MEANT = {
    "examples": "list ls demo demos samples",
    "init": "new create start",
    "run": "simulate compute solve",
    "motions": "records",
    "check": "verify validate verdicts",
    "design": "optimise optimize size find",
    "report": "plot show view html compare diff sheet pdf",
    "accuracy": "error errors convergence",
    "merge": "join combine",
    "fragility": "ida curves",
    "spectrum": "spectra map",
}
"""Other words for each command."""

_OPTIONS_MEANT = {
    "--version": "-v -V",
    "--jobs": "-j --threads --thread --workers --processes --procs --nproc --cores --cpus --n-jobs --parallel",
    "--out": "-o --output --outdir --output-dir --dir --folder --results",
    "--dry-run": "-n --dry --dryrun --estimate",
    "--motions": "--records --ground-motions --input --path",
    "--all": "-a --full --verbose",
    "--rules": "--checks --check --limits",
    "--csv": "-o --out --output --table",
    "--sheet": "--pdf",
    "--write-manifest": "--manifest --write",
    "--clear": "--clean --delete --empty",
    "--list": "--demands",
}
"""Other words for each option, tried before similar spellings."""

_ALIKE = 0.75
"""Least similarity, with their dashes, of an option to one that it may stand for."""

_NUMBER_OR_TRUTH = re.compile(r"true|false|[-+]?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?", re.ASCII)

EXIT_CODES = """exit codes:
  0    success
  1    a record could not be used, a run failed, or a check did not pass
  2    wrong input; nothing was run
  130  interrupted; finished runs are kept"""


class _Parser(argparse.ArgumentParser):
    """A parser that reports a mistake in one line."""

    def error(self, message: str) -> NoReturn:
        more = "" if message.endswith("?") else f"; see `{self.prog} --help`"
        self.exit(2, f"{self.prog}: {message}{more}\n")


class _Version(argparse.Action):
    """Print the version, which a checkout gets from Git only when needed, and exit."""

    def __call__(self, parser: argparse.ArgumentParser, *values: object) -> None:
        show(f"rockbatch {full_version()}")
        parser.exit()


@functools.cache
def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    commands = "\n".join(f"  {name:<13}{command.help}" for name, command in COMMANDS.items())
    first = "first steps:\n  rockbatch init mypier\n  cd mypier\n  rockbatch run pier.toml"
    root = _Parser(
        prog="rockbatch",
        allow_abbrev=False,
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
    """Run the command line and return the exit code (:data:`EXIT_CODES`); without a command, list the commands and return 2.

    0 becomes 1 if the output could not be printed. Wrong arguments end the process (``SystemExit``) with 2.
    """
    open_missing()
    root = parser()
    if "_ARGCOMPLETE" in os.environ:  # called by the shell for completion
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
    """Return the arguments, with "help run" as "run --help", "version" as --version.

    Exits with 2 for an unknown command, with one that may be meant, and for options before the command.
    """
    word, *rest = arguments or [""]
    if word in COMMANDS or not word:
        return arguments
    if word.startswith("-"):
        command = next((each for each in rest if each in COMMANDS), "")
        if command and word not in ("-h", "--help", "--version"):
            others = " ".join(each for each in arguments if each != command)
            root.error(f"options stand behind the command; did you mean {command} {others}?")
        return arguments
    if word.lower() == "version":
        return ["--version"]
    if word.lower() == "help":
        return [*_with_command(rest[:1], root), "--help"] if rest else ["--help"]
    if word in ("rockbatch", "python") and (command := next((each for each in rest if each in COMMANDS), "")):
        root.error(f"words before the command are not allowed; did you mean {' '.join(rest[rest.index(command) :])}?")
    if word.endswith(".toml"):
        root.error(f"there is no command {word}; did you mean run {word}?")
    synonyms = (name for name, words in _COMMANDS_MEANT.items() if word.lower() in words.split())
    meant = next(synonyms, None) or closest(word, COMMANDS)
    root.error(f"there is no command {word}" + (f"; did you mean {meant}?" if meant else ""))


def _options_meant(command: str | None, unknown: Sequence[str]) -> str:
    """Return the end of a message on ``unknown`` arguments: "; did you mean --jobs?", or that the command takes no options.

    A word without "--" after a study may be meant for --out or --motions, an option that is a key of the study for that key, or
    it is an option of other commands; "" if nothing is similar.
    """
    options = [name for name in COMMANDS[command].arguments if name.startswith("-")] if command else ["--version"]
    if not options:
        return f"; `rockbatch {command}` takes none"
    if mended := _with_dashes(unknown[0], options):
        return f"; did you mean {mended}?"
    words = [word.partition("=")[0] for word in unknown if word.startswith("-")]
    of_study = command is not None and "study" in COMMANDS[command].arguments
    if not words and unknown[0].endswith(".toml"):
        return f"; did you mean --rules {unknown[0]}?" if "--rules" in options else "; one study at a time"
    if of_study and not words:
        return f"; did you mean --out {unknown[0]} for the results, or --motions {unknown[0]} for the records?"
    other = [name for word in words if (name := _other_word(word, options))]
    if not other and (homes := [name for name, each in COMMANDS.items() if words and words[0] in each.arguments]):
        return f"; {words[0]} is an option of {' and '.join(f'`rockbatch {name}`' for name in homes[:2])}"
    if of_study and not other and (key := _key_meant(unknown)):
        return key
    known = ", ".join(other or [name for word in words if (name := _similar(word, options))])
    return f"; did you mean {known}?" if known else ""


def _with_dashes(word: str, options: Sequence[str]) -> str:
    """Return an option as it has to be written: "--out=DIR" of "out=DIR", "--out" of "/out" or "—out", "--jobs 4" of "-j4".

    "" for another word, and for one that begins with "--".
    """
    joined = re.fullmatch(r"(-[a-z])([0-9]+)", word)
    if joined and (name := _other_word(joined[1], options)):
        return f"{name} {joined[2]}"
    match = re.fullmatch(r"(?:—|–|−|/|-)?-?([a-z][a-z-]*)(=.*)?", word)
    name = f"--{match[1]}" if match else ""
    return f"{name}{match[2] or ''}" if match and name in options and not word.startswith("--") else ""


def _key_meant(unknown: Sequence[str]) -> str:
    """Return the end of a message on an option that is a key of a study: "; it is a key of the study: write p = 1 under [pier]".

    "" if the first of the ``unknown`` is no such key, or one of a text. A value that is neither a number nor a truth value
    becomes an example.
    """
    from rockbatch.study.load import SECTIONS
    from rockbatch.toml.kinds import text

    option, _, given = unknown[0].partition("=")
    name, value = option.lstrip("-").replace("-", "_"), given or "".join(unknown[1:2])
    home = next((section for section in SECTIONS if name in section), None)
    if home is None or not option.startswith("--") or home[name].kind is text:
        return ""
    if not _NUMBER_OR_TRUTH.fullmatch(value):
        value = home[name].example
    table = ".".join(home.at)
    place = (f"under [[{table}]]" if home.many else f"under [{table}]") if table else "at its top"
    return f"; it is a key of the study: write {name} = {value} {place}"


def _other_word(word: str, options: Sequence[str]) -> str | None:
    """Return the option for which ``word`` is another name by :data:`_OPTIONS_MEANT`, if the command has it; else None."""
    meant = (name for name, words in _OPTIONS_MEANT.items() if word in words.split())
    return next((name for name in meant if name in options), None)


def _similar(word: str, options: Sequence[str]) -> str | None:
    """Return the most similar of the options that discard no results; None if none is, or ``word`` is another name for one."""
    if any(word in words.split() for words in _OPTIONS_MEANT.values()):
        return None
    return closest(word, [name for name in options if name not in DISCARDING], _ALIKE)


def _exit_code(parsed: argparse.Namespace) -> int:
    """Run a command and return its exit code; 2 after wrong input, errors of files or lack of memory, 130 after Ctrl-C.

    These are said on stderr.
    """
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
        say(f"rockbatch: {str(error) or f'out of memory: {_more_memory(parsed)}'}")
        return 2
    except ImportError as error:
        if "failed to map segment" not in str(error):  # message of the loader if memory is limited
            raise
        say(f"rockbatch: {error}: is memory limited (ulimit -v, or a job's limit)? Allow more, and repeat the command")
        return 2
    except KeyboardInterrupt:
        say("rockbatch: interrupted")
        return 130


def _more_memory(parsed: argparse.Namespace) -> str:
    """Return what helps a command that is out of memory: fewer jobs if it has them, and to go on if it keeps finished runs."""
    fewer = "run fewer at a time (--jobs), keep fewer histories, or " if "jobs" in parsed else ""
    again = f"the same command again{', without --fresh' if parsed.fresh else ''}" if "fresh" in parsed else ""
    return f"{fewer}allow more" + (f"; what is finished is kept: give {again}" if again else "")


def _plainly(otherwise: Callable[..., None]) -> Callable[..., None]:
    """Return a ``warnings.showwarning`` that prints plain remarks, once each, and passes others to ``otherwise``."""
    shown = set()

    def show(message: Warning | str, category: type[Warning], *place: object) -> None:
        if not issubclass(category, PlainRemark):
            otherwise(message, category, *place)
        elif str(message) not in shown:
            shown.add(str(message))
            say(f"rockbatch: {message}")

    return show


if __name__ == "__main__":
    sys.exit(main())
