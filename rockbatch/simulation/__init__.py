"""Runs of a pier on a base under a motion: the only access to the core, which is loaded with the first name that needs it."""

from importlib import import_module
from typing import Any

_HOMES = {
    "rockbatch.core.kernel": ("core_digest",),
    "rockbatch.simulation.models": ("block", "ground_of", "springs"),
    "rockbatch.simulation.runs": ("Run", "Stop", "run_all_fixed", "run_fixed", "steps_of", "written_run"),
    "rockbatch.simulation.steps": ("first_substeps", "least_substeps"),
    "rockbatch.simulation.error_control": ("run_all_to_tolerance", "run_to_tolerance"),
}


def __getattr__(name: str) -> Any:
    """Return a public name from its module; for "kept" the module of compiled kernels on disk. ``AttributeError`` for others."""
    if name == "kept":
        return import_module("rockbatch.core.kept")
    for module, names in _HOMES.items():
        if name in names:
            return getattr(import_module(module), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
