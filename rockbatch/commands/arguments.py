"""Arguments and help of every command; a command's module is loaded when it is called."""

import argparse
from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockbatch.commands.example_studies import FIRST
from rockbatch.common.analyses import Door, doors
from rockbatch.common.argument_values import address, case_pair, file, flag, number, place, shard, value, whole, word

if TYPE_CHECKING:
    from rockbatch.study import Study

Arguments = Mapping[str, Mapping[str, Any]]
"""Names of arguments with keywords of ``ArgumentParser.add_argument``."""

_PLAIN = argparse.RawDescriptionHelpFormatter


@dataclass(frozen=True)
class Command:
    """A command of the command line."""

    # its purpose in a line, and an example command line
    help: str
    example: str
    # Module and function in rockbatch, such as ``"commands.run.main"``. The function takes the parsed arguments and, if the
    # command takes a study, the study; it returns the exit code.
    function: str
    arguments: Arguments  # names of the arguments with keywords of ``ArgumentParser.add_argument``
    writes: str = ""  # the files it writes, a line each; empty for none

    def add_to(self, subparsers: "argparse._SubParsersAction[Any]", name: str, epilog: str) -> None:
        """Add the parser of this command to ``subparsers``."""
        writes = f"writes:\n{self.writes}\n\n" if self.writes else ""
        text = f"example:\n  {self.example}\n\n{writes}{epilog}"
        parser = subparsers.add_parser(
            name, description=self.help, epilog=text, formatter_class=_PLAIN, allow_abbrev=False
        )
        for argument, options in self.arguments.items():
            parser.add_argument(argument, **options)

    def run_command(self, arguments: argparse.Namespace) -> int:
        """Load the command, run it and return its exit code.

        A study is read first, so that mistakes in it are reported without loading the command.
        """
        studies = [_study(arguments)] if "study" in self.arguments else []
        module, _, function = self.function.rpartition(".")
        code: int = getattr(import_module(f"rockbatch.{module}"), function)(arguments, *studies)
        return code


def _study(arguments: argparse.Namespace) -> "Study":
    """Return the study, read from its file, with --motions and --strict applied. Raises ``InputError`` with its mistakes."""
    from rockbatch.study import load_study

    study = load_study(arguments.study, motions=arguments.motions)
    return replace(study, motions=replace(study.motions, strict=True)) if arguments.strict else study


_STUDY: Arguments = {
    "study": value(Path, "STUDY.toml", "the study file"),
    "--out": value(place, "DIR", "folder for the results (default: reports/STUDY)"),
    "--motions": value(Path, "PATH", "file or folder of records instead of the study's motions"),
    "--strict": flag("run nothing if any record cannot be used"),
}
"""Arguments of commands that take a study."""

_ENGINE: Arguments = {
    "--jobs": value(whole, "N", "threads, or processes (default: all processors)"),
    "--fresh": flag("start over instead of continuing from finished runs in the folder"),
    "--engine": {
        **word("threads", "dask"),
        "help": "threads of this process (default), or a dask.distributed cluster",
    },
    "--scheduler": value(
        address, "ADDRESS", "address of a running dask scheduler (default: processes of this machine)"
    ),
}
"""Arguments on the execution of runs."""

DISCARDING = ("--fresh",)
"""Options that discard finished results: never suggested for a misspelt option."""

_CSV = {
    "--csv": {**word("semicolon"), "help": "also write peaks_semicolon.csv, for Excel with decimal commas"},
}
_RUN: Arguments = {
    "--shard": value(
        shard, "I/N", "carry out the I-th of N shares only, in a folder of its own, for `rockbatch merge`"
    ),
    "--history": value(
        str,
        "RECORD",
        "also keep the histories of all runs under this record; finished runs are not repeated",
        action="append",
        default=[],
    ),
    "--dry-run": flag("write nothing; print the number of runs and the time and disk space they will take"),
}
_MOTIONS: Arguments = {
    "path": value(Path, "PATH", "files or folders (recursive)", nargs="+"),
    "--all": flag("list every recording, its processing, and every file that is not used"),
    "--csv": value(file, "FILE", "also write the table to FILE; - is stdout"),
    "--html": value(file, "FILE", "write a page with the measures, trace and spectrum of each record; - is stdout"),
    "--write-manifest": flag("draft PATH/motions.toml from the records found"),
    "--strict": flag("fail if any file cannot be used"),
    "--unit": {"help": 'acceleration unit of files that do not state theirs, such as "cm/s2"'},
    "--dt": {"type": number, "help": "sampling interval [s] of text columns without a time column"},
    "--columns": {"help": 'names of text columns, such as "time,000,090,up"'},
    "--role": {**word("horizontal"), "help": "role of components whose direction is not stated"},
    "--layout": {**word("columns", "wrapped"), "help": "wrapped: one series continued from line to line"},
    "--sensitivity": {"type": number, "help": "counts per acceleration unit"},
}


class _Demands(argparse.Action):
    """Print the demands that checks can limit, and exit."""

    def __call__(self, parser: argparse.ArgumentParser, *values: object) -> None:
        from rockbatch.quantities.catalogue import listed
        from rockbatch.terminal.streams import filled, show

        for group, names in listed().items():
            show(filled(f"{group}: {', '.join(names)}"))
        parser.exit()


_FOLDER = value(Path, "DIR", "folder of results of `rockbatch run`")

_FILES = """\
  peaks.csv      a row for each run: docs/columns.md explains the columns
  report.html    tables and pictures, for any browser
  run.json       inputs, records and versions
  histories.h5   histories of the worst runs, or as set by [output] histories
  checks.csv     verdicts, if the study has checks
  intensity.csv, half_cycles.csv, sections.csv, interaction.csv   if set in [output]
  peaks_semicolon.csv           with --csv semicolon: decimal commas, and 9,99E+307 for infinity"""


def _of_analysis(name: str, door: Door) -> Command:
    """Return the command ``name`` of an analysis, with the arguments of studies, of its engine if it has runs, and its own."""
    arguments = {**_STUDY, **(_ENGINE if door.engine else {}), **door.options}
    return Command(door.help, door.example, f"analyses.{name}.command.main", arguments, door.writes)


COMMANDS = {
    "init": Command(
        "write a starter study with example records",
        "rockbatch init mypier",
        "commands.examples.init",
        {
            "folder": value(Path, "FOLDER", "folder to write to (default: current folder)", nargs="?", default=Path()),
            "--example": value(
                str, "NAME", "start from another example; `rockbatch examples` lists them", default=FIRST
            ),
        },
        "  pier.toml      the study\n  checks.toml    design checks\n  records        a folder of records, if the study has one",
    ),
    "examples": Command(
        "list the studies that come with rockbatch", "rockbatch examples", "commands.examples.main", {}
    ),
    "statics": Command(
        "print static strength and rocking periods; no records needed",
        "rockbatch statics pier.toml --csv statics.csv",
        "commands.statics.main",
        {
            "file": value(Path, "STUDY.toml", "the study file; its records are not read and may be missing"),
            "--csv": value(file, "FILE", "also write the sheet to FILE, a row for each case; - is stdout"),
            "--curves": value(
                file, "FILE", "write the moment-rotation curves to FILE, a row for each rotation; - is stdout"
            ),
        },
    ),
    "run": Command(
        "run every record on every foundation; write table and report",
        "rockbatch run pier.toml --out reports/pier",
        "commands.run.main",
        {**_STUDY, **_ENGINE, **_RUN, **_CSV},
        _FILES,
    ),
    "merge": Command(
        "join the shares of `rockbatch run --shard`",
        "rockbatch merge pier.toml one two",
        "commands.run.merge_shares",
        {**_STUDY, "shares": value(Path, "DIR", "folders of the shares", nargs="+"), **_CSV},
        _FILES,
    ),
    "motions": Command(
        "list the records of a folder and the files that are not used",
        "rockbatch motions records --csv records.csv",
        "commands.motions.main",
        _MOTIONS,
        "  FILE           the table, with --csv, or the page, with --html\n  motions.toml   with --write-manifest",
    ),
    "check": Command(
        "check finished results against design limits",
        "rockbatch check reports/pier",
        "commands.check.main",
        {
            "directory": _FOLDER,
            "--list": {"action": _Demands, "nargs": 0, "help": "list the demands that checks can limit, and exit"},
            "--rules": value(Path, "RULES.toml", "file with [[check]] tables, instead of the study's own"),
            "--all": flag("print every verdict with its numbers, and each check's requirement"),
        },
        "  checks.csv     a row for each verdict\n  report.html    updated with the verdicts",
    ),
    "report": Command(
        "rewrite the report, or the calculation sheet, or compare two",
        "rockbatch report reports/pier reports/other",
        "commands.check.report",
        {
            "directory": _FOLDER,
            "other": value(Path, "OTHER", "a second folder, to compare with the first", nargs="?"),
            "--out": value(
                file, "FILE", "file to write (default: DIR/report.html, or DIR/compare-OTHER.html); - is stdout"
            ),
            "--pair": value(
                case_pair,
                "A=B",
                "compare the case A of the first folder with B of the second; by default cases of one name, and those "
                "remaining ones by the inputs that differ least",
                action="append",
                default=[],
            ),
            "--all": flag("unfold every section, so that all are printed"),
            "--sheet": flag(
                "write the calculation sheet instead, for paper: DIR/sheet.html and, where typst is installed, DIR/sheet.pdf; "
                "or FILE alone, a PDF if its name ends in .pdf"
            ),
            "--paper": {
                **word("A4", "Letter"),
                "metavar": "A4|Letter",
                "help": "size of the PDF's pages (default: A4)",
                "default": "A4",
            },
        },
    ),
    "statement": Command(
        "print a paragraph on each case, for a calculation file",
        "rockbatch statement reports/pier --case pads",
        "commands.statement.main",
        {
            "directory": _FOLDER,
            "--case": value(str, "NAME", "only the case of this name, or the cases that match a pattern with * and ?"),
        },
    ),
    **{name: _of_analysis(name, door) for name, door in doors().items() if door.help},
    "cache": Command(
        "show the cache of compiled kernels, or clear it",
        "rockbatch cache --clear",
        "commands.cache.main",
        {"--clear": flag("remove all kernels; the next runs compile them again")},
    ),
}
"""All commands, in the order of the help."""
