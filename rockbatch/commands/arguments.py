"""Arguments and help of every command, whose module is loaded when it is called."""

import argparse
from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockbatch.commands.example_studies import FIRST
from rockbatch.common.analyses import Door, doors
from rockbatch.common.argument_values import address, flag, shard, value, whole

if TYPE_CHECKING:
    from rockbatch.study import Study

Arguments = Mapping[str, Mapping[str, Any]]
"""Names of arguments, with the keywords of ``ArgumentParser.add_argument``."""

_PLAIN = argparse.RawDescriptionHelpFormatter


@dataclass(frozen=True)
class Command:
    """A command of the command line.

    Attributes
    ----------
    help, example : str
        What it does, in a line; and a command line that does it.
    function : str
        Module and function of rockbatch that carry it out, ``"commands.run.main"``. It takes the arguments and, of a command
        for a study, the study, and returns the exit code.
    arguments : mapping
        Names of the arguments, with what ``ArgumentParser.add_argument`` takes beside.
    writes : str
        Which files it leaves, in lines; empty for none.
    """

    help: str
    example: str
    function: str
    arguments: Arguments
    writes: str = ""

    def add_to(self, subparsers: Any, name: str, epilog: str) -> None:
        """Add the parser of this command to those of all."""
        writes = f"writes:\n{self.writes}\n\n" if self.writes else ""
        text = f"example:\n  {self.example}\n\n{writes}{epilog}"
        parser = subparsers.add_parser(name, description=self.help, epilog=text, formatter_class=_PLAIN)
        for argument, options in self.arguments.items():
            parser.add_argument(argument, **options)

    def run_command(self, arguments: argparse.Namespace) -> int:
        """Load the command, run it and return its exit code; a study is read first, since mistakes in it need no other module."""
        studies = [_study(arguments)] if "study" in self.arguments else []
        module, _, function = self.function.rpartition(".")
        code: int = getattr(import_module(f"rockbatch.{module}"), function)(arguments, *studies)
        return code


def _study(arguments: argparse.Namespace) -> "Study":
    """Return the given study with the changes of the command line."""
    from rockbatch.study import load_study

    study = load_study(arguments.study, motions=arguments.motions)
    return replace(study, motions=replace(study.motions, strict=True)) if arguments.strict else study


_STUDY: Arguments = {
    "study": value(Path, "STUDY.toml", "the study file"),
    "--out": value(Path, "DIR", "folder for the results (default: reports/STUDY)"),
    "--motions": value(Path, "PATH", "file or folder of records instead of the study's motions"),
    "--strict": flag("run nothing if any record cannot be used"),
}
"""The study, its motions and the folder of its results."""

_ENGINE: Arguments = {
    "--jobs": value(whole, "N", "threads, or processes (default: all processors)"),
    "--fresh": flag("start over instead of continuing with what is finished in the folder"),
    "--engine": value(
        str, None, "threads of this process (default), or a dask.distributed cluster", choices=("threads", "dask")
    ),
    "--scheduler": value(
        address, "ADDRESS", "address of a running dask scheduler (default: processes of this machine)"
    ),
}
"""The engine that carries out the runs."""

DISCARDING = ("--fresh",)
"""Options that discard finished results: never suggested, and never taken from an abbreviation."""

_CSV = {
    "--csv": value(
        str, None, "write peaks_semicolon.csv, too: with semicolons and decimal commas, as Excel opens it in half of Europe",
        choices=("semicolon",),
    )
}  # fmt: skip
_RUN: Arguments = {
    "--shard": value(
        shard, "I/N", "carry out the I-th of N shares only, in a folder of its own, for `rockbatch merge`"
    ),
    "--history": value(
        str, "RECORD", "keep the histories of all runs under this record, too; finished runs are not repeated for it",
        action="append", default=[],
    ),
    "--dry-run": flag("write nothing; say how many runs there are, and the time and disk space they will take"),
}  # fmt: skip
_MOTIONS: Arguments = {
    "path": value(Path, "PATH", "files or folders (recursive)", nargs="+"),
    "--all": flag("list every recording, what was done to it, and every file that is not used"),
    "--csv": value(Path, "FILE", "write the table to FILE too; - is stdout"),
    "--html": value(Path, "FILE", "write a page with the measures, trace and spectrum of each record; - is stdout"),
    "--write-manifest": flag("draft PATH/motions.toml from what was found"),
    "--strict": flag("fail if any file cannot be used"),
    "--unit": {"help": 'acceleration unit of files that do not state theirs, such as "cm/s2"'},
    "--dt": {"type": float, "help": "sampling interval [s] of text columns without a time column"},
    "--columns": {"help": 'names of text columns, such as "time,000,090,up"'},
    "--role": {"choices": ("horizontal",), "help": "role of components whose direction is not stated"},
    "--layout": {"choices": ("columns", "wrapped"), "help": "wrapped: one series continued from line to line"},
    "--sensitivity": {"type": float, "help": "counts per acceleration unit"},
}


class _Demands(argparse.Action):
    """Lists what checks may ask for."""

    def __call__(self, parser: argparse.ArgumentParser, *values: object) -> None:
        from rockbatch.quantities.catalogue import listed
        from rockbatch.terminal.streams import filled, show

        for group, names in listed().items():
            show(filled(f"{group}: {', '.join(names)}"))
        parser.exit()


_FOLDER = value(Path, "DIR", "folder that `rockbatch run` has written")

_FILES = """\
  peaks.csv      a row for each run: docs/columns.md explains the columns
  report.html    tables and pictures, for any browser
  run.json       what was run, under which motions, with what
  histories.h5   histories of the worst runs, or as [output] histories asks
  checks.csv     verdicts, if the study has checks
  intensity.csv, half_cycles.csv, sections.csv   if [output] asks for them
  peaks_semicolon.csv           with --csv semicolon: decimal commas, and 9,99E+307 for infinity"""


def _of_analysis(name: str, door: Door) -> Command:
    """Return the command of an analysis, all of which take a study."""
    arguments = {**_STUDY, **(_ENGINE if door.engine else {}), **door.options}
    return Command(door.help, door.example, f"analyses.{name}.command.main", arguments, door.writes)


COMMANDS = {
    "init": Command(
        "write a study of your own to begin with, and its records", "rockbatch init mypier", "commands.examples.init",
        {
            "folder": value(Path, "FOLDER", "where (default: here)", nargs="?", default=Path()),
            "--example": value(
                str, "NAME", "begin with another example; `rockbatch examples` lists them", default=FIRST
            ),
        },
        "  pier.toml      the study\n  checks.toml    design checks\n  records        a folder of records, if the study has one",
    ),
    "examples": Command("list the studies that come with rockbatch", "rockbatch examples", "commands.examples.main", {}),
    "statics": Command(
        "show what each pier bears and how it swings, without a run", "rockbatch statics pier.toml --csv statics.csv",
        "commands.statics.main",
        {
            "file": value(Path, "STUDY.toml", "the study file; its records are not read, and need not be there"),
            "--csv": value(Path, "FILE", "write the sheet to FILE too, a row for each case; - is stdout"),
            "--curves": value(Path, "FILE", "write the moment-rotation curves to FILE, a row for each rotation; - is stdout"),
        },
    ),
    "run": Command(
        "run every record on every foundation; table and report", "rockbatch run pier.toml --out reports/pier",
        "commands.run.main",
        {**_STUDY, **_ENGINE, **_RUN, **_CSV}, _FILES,
    ),
    "merge": Command(
        "join the shares of `rockbatch run --shard`", "rockbatch merge pier.toml one two", "commands.run.merge_shares",
        {**_STUDY, "shares": value(Path, "DIR", "folders of the shares", nargs="+"), **_CSV}, _FILES,
    ),
    "motions": Command(
        "list the records of a folder, and the files that are not used", "rockbatch motions records --csv records.csv",
        "commands.motions.main", _MOTIONS,
        "  FILE           the table, with --csv, or the page, with --html\n  motions.toml   with --write-manifest",
    ),
    "check": Command(
        "hold finished results against design checks", "rockbatch check reports/pier", "commands.check.main",
        {
            "directory": _FOLDER,
            "--list": {"action": _Demands, "nargs": 0, "help": "list the demands that a check can make, and exit"},
            "--rules": value(Path, "RULES.toml", "file with [[check]] tables, instead of the study's own"),
            "--all": flag("print every verdict with its numbers, and what each check asks"),
        },
        "  checks.csv     a row for each verdict\n  report.html    again, with the verdicts",
    ),
    "report": Command(
        "make the report again, or compare two studies", "rockbatch report reports/pier reports/other", "commands.check.report",
        {
            "directory": _FOLDER,
            "other": value(Path, "OTHER", "a second folder, to compare with the first", nargs="?"),
            "--out": value(Path, "FILE", "file to write (default: DIR/report.html, or DIR/compare-OTHER.html); - is stdout"),
            "--all": flag("unfold every section, so that all of them are printed"),
        },
    ),
    **{name: _of_analysis(name, door) for name, door in doors().items() if door.help},
    "cache": Command(
        "show where compiled kernels are kept, or remove them", "rockbatch cache --clear", "commands.cache.main",
        {"--clear": flag("remove all of them: the next run of each kind of pier compiles its own again")},
    ),
}  # fmt: skip
"""All commands, in the order of the help."""
