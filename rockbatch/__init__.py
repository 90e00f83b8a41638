"""rockbatch: peak rotations of stepping bridge piers under a folder of ground motions."""

from importlib import import_module
from typing import Any

from rockbatch.common.lazy import loading
from rockbatch.common.version import __version__ as __version__

_NAMES = {
    "workflow.running": "run",
    "workflow.statics": "statics",
    "batch.dask": "Dask",
    "batch.single": "simulate",
    "checks": "Rule",
    "results.checking": "check",
    "common.errors": (
        "BadSyntax Contradiction InputError MissingKey NoDirection NoRecord NoStep NoUnit NotFound "
        "OutOfRange Problem Truncated UnknownFormat UnknownKey Unstated Unusual UnusableRecord WrongType"
    ),
    "motions": "HazardCurve Motion MotionSet ReadOptions pair_spectrum pulse read_motions sequence",
    "pier": "Damper DeckSpring ElasticBase FootingBase Part Pier RigidBase Stop Tendon YieldingBase",
    "pier.statics": "Statics",
    "reporting": "report statement",
    "results.opened": "open_results",
    "outcome.response": "Response",
    "study": "Study load_study",
}
"""Public names by their modules, beside those of the analyses; ``__init__.pyi`` has all of them for type checkers."""


def _homes() -> dict[str, str]:
    """Return the module of each public name."""
    from rockbatch.common.analyses import ANALYSES

    homes = {name: f"rockbatch.{module}" for module, names in _NAMES.items() for name in names.split()}
    return homes | {name: f"rockbatch.analyses.{name}.analysis" for name in ANALYSES}


def __getattr__(name: str) -> Any:
    """Return a public name, or the package of motions, loaded when first used: the compiler costs 0.4 s, and a report needs none.

    Raises ``AttributeError`` for another name.
    """
    if name == "__all__":
        return sorted(_homes())
    if name == "motions":
        return import_module("rockbatch.motions")
    return loading(__name__, {} if name.startswith("_") else _homes())(name)


def __dir__() -> list[str]:
    return sorted([*_homes(), *(name for name in globals() if name.startswith("__"))])
