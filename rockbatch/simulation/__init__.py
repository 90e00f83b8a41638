"""The only access to the core: piers on bases under motions, with fixed steps or to a tolerance."""

from rockbatch.core.kernel import core_digest
from rockbatch.simulation.models import (
    block,
    first_substeps,
    ground_of,
    kernel_of,
    least_substeps,
    springs,
)
from rockbatch.simulation.runs import (
    Run,
    Stop,
    run_all_fixed,
    run_fixed,
    steps_of,
    written_run,
)
from rockbatch.simulation.settling import run_all_to_tolerance, run_to_tolerance

__all__ = [
    "Run",
    "Stop",
    "block",
    "core_digest",
    "first_substeps",
    "ground_of",
    "kernel_of",
    "least_substeps",
    "run_all_fixed",
    "run_all_to_tolerance",
    "run_fixed",
    "run_to_tolerance",
    "springs",
    "steps_of",
    "written_run",
]
