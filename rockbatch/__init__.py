"""rockbatch: peak rotations of stepping bridge piers under a folder of ground motions."""

from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from rockbatch.batch import run
    from rockbatch.checks import Rule
    from rockbatch.design import check
    from rockbatch.errors import InputError
    from rockbatch.histories import simulate
    from rockbatch.motions import Motion, pulse, read_motions
    from rockbatch.response import Response
    from rockbatch.store import open_results
    from rockbatch.structure import ElasticBase, Pier, RigidBase, YieldingBase
    from rockbatch.study import load_study

_HOMES = {
    "ElasticBase": "rockbatch.structure",
    "InputError": "rockbatch.errors",
    "Motion": "rockbatch.motions",
    "Pier": "rockbatch.structure",
    "Response": "rockbatch.response",
    "RigidBase": "rockbatch.structure",
    "Rule": "rockbatch.checks",
    "YieldingBase": "rockbatch.structure",
    "check": "rockbatch.design",
    "load_study": "rockbatch.study",
    "open_results": "rockbatch.store",
    "pulse": "rockbatch.motions",
    "read_motions": "rockbatch.motions",
    "run": "rockbatch.batch",
    "simulate": "rockbatch.histories",
}

__all__ = [
    "ElasticBase",
    "InputError",
    "Motion",
    "Pier",
    "Response",
    "RigidBase",
    "Rule",
    "YieldingBase",
    "check",
    "load_study",
    "open_results",
    "pulse",
    "read_motions",
    "run",
    "simulate",
]


def __getattr__(name: str) -> Any:
    """Public names are loaded when first used: the compiler costs 0.4 s, and a report needs none."""
    if name in _HOMES:
        from importlib import import_module

        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'rockbatch' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
