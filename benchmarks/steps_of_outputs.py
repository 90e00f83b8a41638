"""How many steps a study takes with its optional outputs, over those of its peaks alone; no times.

    python benchmarks/steps_of_outputs.py

Ten runs: two records on five foundations, run into a folder. A step is one of the integrator, of runs that are repeated or
recorded too; halving the step, and trying doubtful runs under changed motions, belong to the peaks. The last row is of both
records as a sequence, which has a table of its shocks, whatever is asked for: these are followed until a pause after the last.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import rockbatch as rb
from rockbatch.simulation import runs as of_runs

YIELDING = {"base": "yielding", "beta": 60.0, "eta": 2.4, "epsilon": 0.05}
PULSE = {"name": "one-sine", "shape": "sine", "amplitude_g": 0.35, "period_s": 1.1, "dt_s": 0.005, "duration_s": 6.0}
STUDY: dict[str, Any] = {
    "title": "Optional outputs",
    "pier": {"width_m": 4.0, "height_m": 24.0, "mass_t": 2000.0},
    "motions": {
        "pulse": [PULSE, PULSE | {"name": "slow", "period_s": 1.4}],
    },
    "case": [
        {"name": "rigid", "base": "rigid"},
        {"name": "elastic", "base": "elastic", "beta": 60.0, "zeta": 0.05},
        {"name": "pads", **YIELDING},
        {"name": "epp", **YIELDING, "spring": "epp"},
        {"name": "damped", "base": "rigid", "damper": [{"kind": "hysteretic", "f": 0.03, "yield_mm": 5.0, "at": "left"}]},
    ],
}  # fmt: skip
SEQUENCE = {"sequence": [{"name": "twice", "records": ["one-sine", "slow"], "pause_s": 5.0}]}
NONE: dict[str, Any] = {"histories": "none", "both_laws": False}
ALL: dict[str, Any] = {
    "histories": "worst", "both_laws": True, "ledger": True, "forces": True, "rocking": True, "intensity": True,
    "half_cycles": True, "sections": 5, "devices_work": True,
}  # fmt: skip
OUTPUTS: dict[str, dict[str, Any]] = {"none": NONE, "default": {}, "all": ALL} | {
    key: NONE | {key: value} for key, value in ALL.items() if key != "histories"
}


class Steps:
    """Numbers of simulations, and of steps in all of them."""

    simulations = 0
    steps = 0.0


@contextmanager
def counted() -> Iterator[Steps]:
    """Count the steps of all simulations of this process meanwhile."""
    steps, march = Steps(), of_runs.march

    def counting(system: Any, lines: Any, ground: Any, stop: Any, substeps: int, *more: Any, **others: Any) -> Any:
        results = march(system, lines, ground, stop, substeps, *more, **others)
        dt = np.array([line.dt for line in lines])
        steps.simulations += len(lines)
        steps.steps += float(np.nansum(results.t_end / dt)) * substeps
        return results

    of_runs.march = counting
    try:
        yield steps
    finally:
        of_runs.march = march


def of_peaks(study: dict[str, Any] = STUDY) -> Steps:
    """Return what the peaks of a study take; kernels are compiled before."""
    loaded = rb.Study.from_dict(study | {"output": NONE})
    rb.run(loaded, jobs=1, progress=False)
    with counted() as steps:
        rb.run(loaded, jobs=1, progress=False)
    return steps


def of_folder(output: dict[str, Any], study: dict[str, Any] = STUDY) -> Steps:
    """Return what a study with this [output] takes that is run into a folder; kernels are compiled before."""
    with TemporaryDirectory() as folder:
        loaded = rb.Study.from_dict(study | {"output": output})
        rb.run(loaded, folder, jobs=1, progress=False)
        with counted() as steps:
            rb.run(loaded, folder, jobs=1, progress=False, fresh=True)
    return steps


def main() -> list[str]:
    """Return the table."""
    lines = ["| outputs | simulations | steps over those of the peaks |", "| --- | --- | --- |"]
    peaks = of_peaks()
    for name, output in OUTPUTS.items():
        steps = of_folder(output)
        lines.append(f"| {name} | {steps.simulations} | {steps.steps / peaks.steps:.2f} |")
    sequence = STUDY | {"motions": STUDY["motions"] | SEQUENCE}
    steps, peaks = of_folder(ALL, sequence), of_peaks(sequence)
    lines.append(f"| all, of a sequence | {steps.simulations} | {steps.steps / peaks.steps:.2f} |")
    return lines


if __name__ == "__main__":
    print("\n".join(main()))
