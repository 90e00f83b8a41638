"""The core as the plain Python it is written in gives what its compiled form gives."""

import json
import math
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from core_samples import FIG5, broadband, pulse

from rockbatch.core.clock import include_height
from rockbatch.core.springs.ending import FORESEEN
from rockbatch.core.springs.ending import _foresee as foresee
from rockbatch.core.springs.equations import clearances
from rockbatch.core.springs.free_vibration import rocking_stiffness
from rockbatch.core.springs.lanes import LANE
from rockbatch.core.springs.model import State, Supports
from rockbatch.core.table import table
from rockbatch.core.types import (
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LIFT_OFF,
    REST,
    SAMPLE,
    SEPARATION_LEFT,
    SEPARATION_RIGHT,
    SPRING_LEFT,
    SPRING_RIGHT,
)
from rockbatch.motions.motion import Motion
from rockbatch.pier import ElasticBase, Pier, RigidBase, YieldingBase
from rockbatch.simulation import Run, written_run
from rockbatch.simulation.models import model

DT = 0.02
SINE = pulse("sine", 0.5, dt=DT, end=1.6)
SHAKEN = Motion("shaken", DT, SINE.horizontal, broadband(np.random.default_rng(3), DT, SINE.npts, 12.0))
STOCKY = Motion("stocky", DT, 20.55 * np.sin(2 * math.pi * 1.18 * DT * np.arange(60)))
CASES = {
    "rigid": (FIG5, RigidBase(restitution=0.4), pulse("sine", 0.4, 0.5, dt=DT, end=3.0)),
    "bouc-wen": (FIG5, YieldingBase(50.0, 0.1, eta=2.2), SINE),
    "epp-finite-guided": (FIG5, YieldingBase(40.0, 0.3, "finite", "guided", eta=1.5, spring="epp"), SHAKEN),
    "hardening": (FIG5, YieldingBase(50.0, 0.1, eta=2.2, spring="hardening"), pulse("sine", 0.5, dt=DT, end=3.0)),
    "elastic-epsilon0-guided": (Pier(0.74, 1.0), ElasticBase(7.2, 0.0, flight="guided"), STOCKY),
}
MUST_HAPPEN = {
    "rigid": {LIFT_OFF, IMPACT_LEFT, IMPACT_RIGHT, REST},
    "bouc-wen": {SEPARATION_LEFT, SEPARATION_RIGHT, IMPACT_LEFT, IMPACT_RIGHT, SPRING_LEFT, SPRING_RIGHT},
    "epp-finite-guided": {SEPARATION_LEFT, SEPARATION_RIGHT, IMPACT_LEFT, IMPACT_RIGHT, SPRING_LEFT, SPRING_RIGHT},
    "hardening": {SEPARATION_LEFT, SEPARATION_RIGHT, IMPACT_LEFT, IMPACT_RIGHT, SPRING_LEFT, SPRING_RIGHT},
    "elastic-epsilon0-guided": {SEPARATION_LEFT, SEPARATION_RIGHT, IMPACT_RIGHT},
}


def outcome(name: str, call: Callable[..., Any]) -> dict[str, Any]:
    """Return what the core returns, the kinds of events and the last row of the history of a case."""
    pier, base, motion = CASES[name]
    rocks_on = name == "hardening"  # for 40 s, through events of the same kinds
    run, history = call(written_run, Run(pier, base, motion), 4, 0.0, 5000, wait=not rocks_on)
    rows = history[: run.rows].view(np.recarray)
    return {
        "run": run._asdict(),
        "events": [int(kind) for kind in rows.kind if kind > SAMPLE],
        "end": list(rows[-1]),
        "held": not isinstance(base, RigidBase) and bool(rows.held.any()),
    }


def parts() -> dict[str, Any]:
    """Return what small parts of the core return."""
    found: dict[str, Any] = {}
    lanes, y = table(LANE)[0][0], State(0.01, 0.0, 0.1, 0.0, 0.0, 0.0)
    still = clearances(model(FIG5, ElasticBase(50.0)), y, Supports(0.0, 0.0, -1.0, -1.0))
    include_height(lanes, 0, still, still, 0.0)
    found["height without time"] = float(lanes.tally.flight_height[0])
    m, sunk = model(FIG5, YieldingBase(50.0, 0.1, eta=2.2)), 1e-4
    shared = m.gravity * m.height / rocking_stiffness(m)
    exponent = m.creep * m.height * (1.0 + shared) * sunk / m.half_width**2
    found["exponent of a lean that grows"] = float(exponent)
    waiting, growths = lanes.waiting, []
    waiting.patience[0], lanes.clock.dt[0] = 2.0 / FORESEEN, 1.0  # a second ahead
    for speed in (-sunk, sunk):
        waiting.last_drift_left[0] = waiting.last_drift_right[0] = 0.5 * speed
        foresee(lanes, 0, m)
        growths.append(float(waiting.further_growth[0]))
    found["growth of a lean, its base sinking or rising"] = growths
    return found


@pytest.fixture(scope="module")
def interpreted() -> dict[str, Any]:
    """``parts`` in a process in which Numba compiles nothing."""
    done = subprocess.run(
        [sys.executable, "-c", "import json, test_without_jit as t; print(json.dumps(t.parts()))"],
        cwd=Path(__file__).parent,
        env={**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)


def compiled(function: Callable[..., Any], *given: Any, **named: Any) -> Any:
    return function(*given, **named)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if "finite" in name else name for name in CASES]
)
def test_a_run_without_the_compiler_gives_the_same_results(name, uncompiled):
    """Equal to the bit on x86-64; 1e-9 leaves room for compilers that fuse a product and a sum."""
    assert uncompiled(os.getenv, "NUMBA_DISABLE_JIT") == "1"
    plain, found = outcome(name, uncompiled), outcome(name, compiled)
    assert found["events"] == plain["events"]
    assert MUST_HAPPEN[name] <= set(plain["events"])
    assert found["held"] == plain["held"] == (name == "elastic-epsilon0-guided")
    assert found["end"] == pytest.approx(plain["end"], rel=1e-9, abs=1e-12)
    assert found["run"] == pytest.approx(plain["run"], rel=1e-9, abs=1e-12, nan_ok=True)


@pytest.mark.slow
def test_a_part_of_a_flight_that_takes_no_time_adds_no_height(interpreted):
    assert interpreted["height without time"] == 0.0


def test_a_lean_grows_by_itself_while_its_base_sinks_and_not_while_it_rises(interpreted):
    """exp(n h A s/b²) − 1 for supports that both sink by s, where a lean is A times the tilt of its base, and none for −s."""
    growth = math.expm1(interpreted["exponent of a lean that grows"])
    assert growth > 0.0
    assert interpreted["growth of a lean, its base sinking or rising"] == [pytest.approx(growth, rel=1e-12), 0.0]
