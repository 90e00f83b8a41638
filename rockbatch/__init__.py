"""rockbatch: peak rotations of stepping bridge piers under a folder of ground motions."""

from typing import TYPE_CHECKING, Any

from rockbatch._version import __version__ as __version__

if TYPE_CHECKING:
    from rockbatch.analysis.accuracy import accuracy
    from rockbatch.analysis.fragility import fragility
    from rockbatch.analysis.sensitivity import sensitivity
    from rockbatch.analysis.spectrum import spectrum
    from rockbatch.batch.running import run
    from rockbatch.batch.single import simulate
    from rockbatch.checks import Rule
    from rockbatch.errors import InputError
    from rockbatch.motions import Motion, MotionSet, ReadOptions, pulse, read_motions
    from rockbatch.pier import Damper, ElasticBase, Part, Pier, RigidBase, Tendon, YieldingBase
    from rockbatch.report import report
    from rockbatch.results.checking import check
    from rockbatch.results.opened import open_results
    from rockbatch.simulation.response import Response
    from rockbatch.study import Study, load_study

_HOMES = {
    "Damper": "rockbatch.pier",
    "ElasticBase": "rockbatch.pier",
    "InputError": "rockbatch.errors",
    "Motion": "rockbatch.motions",
    "MotionSet": "rockbatch.motions",
    "Part": "rockbatch.pier",
    "Pier": "rockbatch.pier",
    "ReadOptions": "rockbatch.motions",
    "Response": "rockbatch.simulation.response",
    "RigidBase": "rockbatch.pier",
    "Rule": "rockbatch.checks",
    "Study": "rockbatch.study",
    "Tendon": "rockbatch.pier",
    "YieldingBase": "rockbatch.pier",
    "accuracy": "rockbatch.analysis.accuracy",
    "check": "rockbatch.results.checking",
    "fragility": "rockbatch.analysis.fragility",
    "load_study": "rockbatch.study",
    "open_results": "rockbatch.results.opened",
    "pulse": "rockbatch.motions",
    "read_motions": "rockbatch.motions",
    "report": "rockbatch.report",
    "run": "rockbatch.batch.running",
    "sensitivity": "rockbatch.analysis.sensitivity",
    "simulate": "rockbatch.batch.single",
    "spectrum": "rockbatch.analysis.spectrum",
}

__all__ = [
    "Damper",
    "ElasticBase",
    "InputError",
    "Motion",
    "MotionSet",
    "Part",
    "Pier",
    "ReadOptions",
    "Response",
    "RigidBase",
    "Rule",
    "Study",
    "Tendon",
    "YieldingBase",
    "accuracy",
    "check",
    "fragility",
    "load_study",
    "open_results",
    "pulse",
    "read_motions",
    "report",
    "run",
    "sensitivity",
    "simulate",
    "spectrum",
]


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used: the compiler costs 0.4 s, and a report needs none."""
    if name in _HOMES:
        from importlib import import_module

        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'rockbatch' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
