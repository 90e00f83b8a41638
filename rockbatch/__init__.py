"""rockbatch: peak rotations of stepping bridge piers under a folder of ground motions."""

from typing import TYPE_CHECKING

from rockbatch._version import __version__ as __version__
from rockbatch.common.lazy import loading

if TYPE_CHECKING:
    from rockbatch.analysis.accuracy import accuracy
    from rockbatch.analysis.fragility import fragility
    from rockbatch.analysis.release import release
    from rockbatch.analysis.sensitivity import sensitivity
    from rockbatch.analysis.spectrum import spectrum
    from rockbatch.batch.running import run
    from rockbatch.batch.single import simulate
    from rockbatch.checks import Rule
    from rockbatch.errors import InputError
    from rockbatch.motions import Motion, MotionSet, ReadOptions, pair_spectrum, pulse, read_motions, sequence
    from rockbatch.motions.hazard import HazardCurve
    from rockbatch.pier import Damper, DeckSpring, ElasticBase, Part, Pier, RigidBase, Stop, Tendon, YieldingBase
    from rockbatch.pier.statics import Statics, statics
    from rockbatch.report import report
    from rockbatch.results.checking import check
    from rockbatch.results.opened import open_results
    from rockbatch.simulation.response import Response
    from rockbatch.study import Study, load_study

_NAMES = {
    "analysis.accuracy": "accuracy",
    "analysis.fragility": "fragility",
    "analysis.release": "release",
    "analysis.sensitivity": "sensitivity",
    "analysis.spectrum": "spectrum",
    "batch.running": "run",
    "batch.single": "simulate",
    "checks": "Rule",
    "errors": "InputError",
    "motions": "Motion MotionSet ReadOptions pair_spectrum pulse read_motions sequence",
    "motions.hazard": "HazardCurve",
    "pier": "Damper DeckSpring ElasticBase Part Pier RigidBase Stop Tendon YieldingBase",
    "pier.statics": "Statics statics",
    "report": "report",
    "results.checking": "check",
    "results.opened": "open_results",
    "simulation.response": "Response",
    "study": "Study load_study",
}
_HOMES = {name: f"rockbatch.{home}" for home, names in _NAMES.items() for name in names.split()}

__all__ = [
    "Damper",
    "DeckSpring",
    "ElasticBase",
    "HazardCurve",
    "InputError",
    "Motion",
    "MotionSet",
    "Part",
    "Pier",
    "ReadOptions",
    "Response",
    "RigidBase",
    "Rule",
    "Statics",
    "Stop",
    "Study",
    "Tendon",
    "YieldingBase",
    "accuracy",
    "check",
    "fragility",
    "load_study",
    "open_results",
    "pair_spectrum",
    "pulse",
    "read_motions",
    "release",
    "report",
    "run",
    "sensitivity",
    "sequence",
    "simulate",
    "spectrum",
    "statics",
]


__getattr__ = loading(__name__, _HOMES)
"""The compiler costs 0.4 s, and a report needs none."""


def __dir__() -> list[str]:
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])
