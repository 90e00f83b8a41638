"""The list of analyses, and access to them by name from the packages below, which do not import them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from typing import Any

from rockbatch.common.slices import ReportPart, from_slice

Entry = Mapping[str, Any]
"""An object in the JSON file of an analysis, by key; the reader of the file has checked its shape."""

ANALYSES = ("design", "fragility", "spectrum", "sensitivity", "release", "accuracy")
"""Each has its folder ``rockbatch/analyses/NAME``; in the order of the help and of the report."""


@dataclass(frozen=True, kw_only=True)
class Door:
    """Command, tables and report parts of an analysis, in ``__init__.py`` of its folder.

    Functions are named, and loaded when they are used.

    Its command, if ``help`` describes one, is ``command.main``, its function in Python ``analysis.NAME``, and its sections of the
    study file, if it has ``tables`` there, are ``study.SECTIONS``.
    """

    parts: tuple[ReportPart, ...]  # its parts of the report
    # of its command: what it does, a command line that does it, and the files that it leaves, in lines; empty without one
    help: str = ""
    example: str = ""
    writes: str = ""
    tables: tuple[str, ...] = ()  # names of its tables at the top of the study file
    # arguments of its command beyond the study, with what ``ArgumentParser.add_argument`` takes beside
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    engine: bool = True  # true if its runs are carried out by an engine that the command line may choose


@cache
def doors() -> dict[str, Door]:
    """Return the doors of all analyses, by their names."""
    return {name: import_module(f"rockbatch.analyses.{name}").DOOR for name in ANALYSES}


def from_analysis(name: str, function: str) -> Any:
    """Return the ``function`` of an analysis, such as "section.section", importing its module."""
    return from_slice(f"analyses.{name}", function)
