"""The observers, and the way by which what lies below them finds each without importing it."""

from importlib import import_module
from importlib.util import find_spec
from typing import Any

OBSERVERS = (
    "other_law",
    "rocking",
    "energy_balance",
    "forces",
    "devices_work",
    "shocks",
    "half_cycles",
    "sections",
)
"""Each has its folder ``rockbatch/observers/NAME``; in the order in which they add to a run."""


def from_observer(name: str, function: str) -> Any:
    """Return what an observer names ``function``, such as "observe.requested", loading its module."""
    module, _, attribute = function.partition(".")
    return getattr(import_module(f"rockbatch.observers.{name}.{module}"), attribute)


def tables() -> list[str]:
    """Return the files beside peaks.csv that observers may write."""
    homes = (import_module(f"rockbatch.observers.{name}") for name in OBSERVERS)
    return [home.TABLE for home in homes if hasattr(home, "TABLE")]


def parts(name: str) -> list[Any]:
    """Return what observers name so, such as "study.OUTPUT", in their order; of those that have it."""
    module, _, attribute = name.partition(".")
    homes = [f"rockbatch.observers.{observer}.{module}" for observer in OBSERVERS]
    modules = [import_module(home) for home in homes if find_spec(home)]
    return [getattr(home, attribute) for home in modules if hasattr(home, attribute)]
