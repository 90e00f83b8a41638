"""The observers, and the way by which what lies below them finds each without importing it."""

from functools import cache
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from rockbatch.common.slices import ReportPart, from_slice

OBSERVERS = (
    "other_law",
    "rocking",
    "energy_balance",
    "shocks",
    "forces",
    "devices_work",
    "half_cycles",
    "sections",
    "interaction",
    "intensity",
)
"""Each has its folder ``rockbatch/observers/NAME``; in the order in which they add to a run."""


def from_observer(name: str, function: str) -> Any:
    """Return the attribute of an observer, such as "observe.requested", importing its module.

    Raises ``AttributeError`` for an unknown observer or attribute.
    """
    if name not in OBSERVERS:
        raise AttributeError(f"there is no observer {name}")
    return from_slice(f"observers.{name}", function)


def tables() -> list[str]:
    """Return the files beside peaks.csv that observers may write."""
    return [table for _, table in _of_packages("TABLE")]


def report_parts() -> list[tuple[str, ReportPart]]:
    """Return the parts of the report that observers bring, each behind the name of its observer."""
    return _of_packages("REPORT")


def _of_packages(name: str) -> list[tuple[str, Any]]:
    """Return the attribute ``name`` of the observers' packages that have it, each with the observer's name, in their order."""
    homes = [(observer, import_module(f"rockbatch.observers.{observer}")) for observer in OBSERVERS]
    return [(observer, getattr(home, name)) for observer, home in homes if hasattr(home, name)]


@cache
def parts(name: str) -> tuple[Any, ...]:
    """Return the attribute ``name``, "study.OUTPUT", of each observer that has this module and attribute, in their order."""
    module, _, attribute = name.partition(".")
    homes = [f"rockbatch.observers.{observer}.{module}" for observer in OBSERVERS]
    modules = [import_module(home) for home in homes if find_spec(home)]
    return tuple(getattr(home, attribute) for home in modules if hasattr(home, attribute))
