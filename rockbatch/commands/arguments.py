"""Arguments and help of every command, whose module is loaded when it is called."""

import argparse
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockbatch.examples import FIRST

if TYPE_CHECKING:
    from rockbatch.study import Study

RUNS, SECONDS = 24, 60.0
"""Default number of runs that ``rockbatch accuracy`` measures, and its time limit [s]."""

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
        Module and function of this package that carry it out, ``"run.main"``. It takes the arguments and, of a command for a
        study, the study, and returns the exit code.
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

    def carry_out(self, arguments: argparse.Namespace) -> int:
        """Load the command, run it and return its exit code; a study is read first, since mistakes in it need no other module."""
        studies = [_study(arguments)] if "study" in self.arguments else []
        module, _, function = self.function.partition(".")
        code: int = getattr(import_module(f"rockbatch.commands.{module}"), function)(arguments, *studies)
        return code


def _study(arguments: argparse.Namespace) -> "Study":
    """Return the given study with the changes of the command line."""
    from rockbatch.study import load_study

    study = load_study(arguments.study, motions=arguments.motions)
    return replace(study, motions=replace(study.motions, strict=True)) if arguments.strict else study


def _positive(kind: Callable[[str], float], least: str) -> Callable[[str], float]:
    """Return the type of numbers above 0, of which the smallest is in words ``least``."""

    def number(text: str) -> float:
        value = kind(text)
        if not value > 0:
            raise argparse.ArgumentTypeError(f"{text}: must be {least}")
        return value

    number.__name__ = kind.__name__  # of which argparse says "invalid int value"
    return number


_whole, _seconds = _positive(int, "at least 1"), _positive(float, "above 0")


def _address(text: str) -> str:
    if not text.strip():
        raise argparse.ArgumentTypeError("must be an address such as tcp://10.0.0.1:8786; it is empty")
    return text


def _shard(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d+)/(\d+)", text, re.ASCII)
    share, shares = map(int, match.groups()) if match else (0, 0)
    if not 1 <= share <= shares:
        raise argparse.ArgumentTypeError(f"{text}: must be such as 2/4, the second of four shares")
    return share, shares


def _flag(text: str) -> dict[str, Any]:
    return {"action": "store_true", "help": text}


def _value(kind: Callable[[str], Any], metavar: str | None, text: str, **more: Any) -> dict[str, Any]:
    return {"type": kind, "metavar": metavar, "help": text, **more}


_STUDY: Arguments = {
    "study": _value(Path, "STUDY.toml", "the study file"),
    "--out": _value(Path, "DIR", "folder for the results (default: reports/STUDY)"),
    "--motions": _value(Path, "PATH", "file or folder of records instead of the study's motions"),
    "--strict": _flag("run nothing if any record cannot be used"),
}
"""The study, its motions and the folder of its results."""

_ENGINE: Arguments = {
    "--jobs": _value(_whole, "N", "threads, or processes (default: all processors)"),
    "--fresh": _flag("start over instead of continuing with what is finished in the folder"),
    "--engine": _value(
        str, None, "threads of this process (default), or a dask.distributed cluster", choices=("threads", "dask")
    ),
    "--scheduler": _value(
        _address, "ADDRESS", "address of a running dask scheduler (default: processes of this machine)"
    ),
}
"""The engine that carries out the runs."""

_CSV = {
    "--csv": _value(
        str, None, "write peaks_semicolon.csv, too: with semicolons and decimal commas, as Excel opens it in half of Europe",
        choices=("semicolon",),
    )
}  # fmt: skip
_RUN: Arguments = {
    "--shard": _value(
        _shard, "I/N", "carry out the I-th of N shares only, in a folder of its own, for `rockbatch merge`"
    ),
    "--history": _value(
        str, "RECORD", "keep the histories of all runs under this record, too; finished runs are not repeated for it",
        action="append", default=[],
    ),
    "--dry-run": _flag("write nothing; say how many runs there are, and the time and disk space they will take"),
}  # fmt: skip
_MOTIONS: Arguments = {
    "path": _value(Path, "PATH", "files or folders (recursive)", nargs="+"),
    "--csv": _value(Path, "FILE", "write the table to FILE too"),
    "--write-manifest": _flag("draft PATH/motions.toml from what was found"),
    "--strict": _flag("fail if any file cannot be used"),
    "--unit": {"help": 'acceleration unit of files that do not state theirs, such as "cm/s2"'},
    "--dt": {"type": float, "help": "sampling interval [s] of text columns without a time column"},
    "--columns": {"help": 'names of text columns, such as "time,000,090,up"'},
    "--role": {"choices": ("horizontal",), "help": "role of components whose direction is not stated"},
    "--layout": {"choices": ("columns", "wrapped"), "help": "wrapped: one series continued from line to line"},
    "--sensitivity": {"type": float, "help": "counts per acceleration unit"},
}
_ACCURACY: Arguments = {
    "--runs": _value(_whole, "N", f"runs to measure, spread over the study (default: {RUNS})", default=RUNS),
    "--seconds": _value(
        _seconds, "S", f"time limit; measurements that do not fit are left out (default: {SECONDS:g})", default=SECONDS
    ),
    "--no-scipy": _flag("leave out SciPy's solvers, which are slow"),
}  # fmt: skip
_FOLDER = _value(Path, "DIR", "folder that `rockbatch run` has written")

_FILES = """\
  peaks.csv      a row for each run: docs/columns.md explains the columns
  report.html    tables and pictures, for any browser
  run.json       what was run, under which motions, with what
  histories.h5   histories of the worst runs, or as [output] histories asks
  checks.csv     verdicts, if the study has checks
  intensity.csv, estimate.csv, half_cycles.csv   if [output] asks for them
  peaks_semicolon.csv           with --csv semicolon: decimal commas, and 9,99E+307 for infinity"""

COMMANDS = {
    "init": Command(
        "write a study of your own to begin with, and its records", "rockbatch init mypier", "examples.init",
        {
            "folder": _value(Path, "FOLDER", "where (default: here)", nargs="?", default=Path()),
            "--example": _value(
                str, "NAME", "begin with another example; `rockbatch examples` lists them", default=FIRST
            ),
        },
        "  pier.toml      the study\n  checks.toml    design checks\n  records        a folder of records, if the study has one",
    ),
    "examples": Command("list the studies that come with rockbatch", "rockbatch examples", "examples.main", {}),
    "statics": Command(
        "show what each pier bears and how it swings, without a run", "rockbatch statics pier.toml --csv statics.csv",
        "statics.main",
        {
            "file": _value(Path, "STUDY.toml", "the study file; its records are not read, and need not be there"),
            "--csv": _value(Path, "FILE", "write the sheet to FILE too, a row for each case"),
            "--curves": _value(Path, "FILE", "write the moment-rotation curves to FILE, a row for each rotation"),
        },
    ),
    "run": Command(
        "run every record on every foundation; table and report", "rockbatch run pier.toml --out reports/pier", "run.main",
        {**_STUDY, **_ENGINE, **_RUN, **_CSV}, _FILES,
    ),
    "merge": Command(
        "join the shares of `rockbatch run --shard`", "rockbatch merge pier.toml one two", "run.merge_shares",
        {**_STUDY, "shares": _value(Path, "DIR", "folders of the shares", nargs="+"), **_CSV}, _FILES,
    ),
    "motions": Command(
        "list the records of a folder, and the files that are not used", "rockbatch motions records --csv records.csv",
        "motions.main", _MOTIONS, "  FILE           the table, with --csv\n  motions.toml   with --write-manifest",
    ),
    "check": Command(
        "hold finished results against design checks", "rockbatch check reports/pier", "check.main",
        {
            "directory": _FOLDER,
            "--rules": _value(Path, "RULES.toml", "file with [[check]] tables, instead of the study's own"),
        },
        "  checks.csv     a row for each verdict\n  report.html    again, with the verdicts",
    ),
    "report": Command(
        "make the report again, or compare two studies", "rockbatch report reports/pier reports/other", "check.report",
        {
            "directory": _FOLDER,
            "other": _value(Path, "OTHER", "a second folder, to compare with the first", nargs="?"),
            "--out": _value(Path, "FILE", "file to write (default: DIR/report.html, or DIR/compare-OTHER.html)"),
        },
    ),
    "accuracy": Command(
        "measure error against time of a study on this machine", "rockbatch accuracy pier.toml --no-scipy", "accuracy.main",
        {**_STUDY, **_ACCURACY}, "  accuracy.csv, accuracy.json, and a section of report.html",
    ),
    "fragility": Command(
        "fragility curves for overturning and for design checks", "rockbatch fragility pier.toml --jobs 4", "fragility.main",
        {**_STUDY, **_ENGINE},
        "  fragility.csv  shares of the records that exceed each limit\n"
        "  fragility_capacities.csv, fragility_runs.csv, fragility.json, and a section of report.html",
    ),
    "spectrum": Command(
        "rocking spectra, and maps of the pulses that overturn", "rockbatch spectrum pier.toml", "spectrum.main",
        {**_STUDY, **_ENGINE},
        "  spectrum.csv, spectrum_suite.csv, overturning_map.csv, overturning_runs.csv, as the study asks,\n"
        "  spectrum.json, and a section of report.html",
    ),
    "sensitivity": Command(
        "which parameters the peak rotation depends on most", "rockbatch sensitivity pier.toml", "sensitivity.main",
        {**_STUDY, **_ENGINE},
        "  sensitivity.csv   peaks at both ends of each parameter\n"
        "  sobol.csv, sensitivity_runs.csv, sensitivity.json, and a section of report.html",
    ),
    "release": Command(
        "fit restitution or damping to a release test", "rockbatch release test.toml", "release.main",
        _STUDY,
        "  release.csv          what was fitted, and its interval\n"
        "  release_impacts.csv  times and amplitudes, measured and computed\n"
        "  release_history.csv, release.json, and a section of report.html",
    ),
}  # fmt: skip
"""All commands, in the order of the help."""
