"""Compiled kernels on disk never outlive the physics they were compiled from."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numba
import pytest

import rockbatch
from rockbatch.core.kernel import core_digest, entry, inlined_once, kernel

SCRIPT = """
import numpy as np
from rockbatch.core.block.model import Rocking, Stance
from rockbatch.core.history import MOMENT
from rockbatch.motions.motion import Motion
from rockbatch.pier import Pier, RigidBase
from rockbatch.outcome.outcome import TERMS
from rockbatch.simulation import Run
from rockbatch.observers.energy_balance.observe import energies
rows = np.zeros(2, [(name, "f8") for name in (*MOMENT, *Rocking._fields, *Stance._fields)]).view(np.recarray)
rows.t, rows.theta, rows.omega, rows.right = (0.0, 0.01), 0.1, 0.2, 1.0
motion = Motion("push", 0.01, np.full(50, -3.0))
print(repr(float(abs(energies(Run(Pier(0.2, 1.0), RigidBase(), motion), rows)[1, TERMS.index("input")]))))
"""


def run_copy(folder: Path) -> float:
    """Return the work of the ground in a step, as the copy of the package in ``folder`` computes, in a process of its own.

    Its kernel takes two seconds to compile; the driver of all runs is cached alike, and takes ten.
    """
    environment = {**os.environ, "PYTHONPATH": str(folder), "HOME": str(folder)}
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], cwd=folder, env=environment, capture_output=True, text=True, check=True
    )
    return float(done.stdout)


@pytest.mark.slow
def test_an_edit_in_a_called_kernel_changes_the_next_run(tmp_path):
    """Numba's own cache looks at the caller's file only. Without the arm, which that calls, the ground does no work."""
    package = tmp_path / "rockbatch"
    shutil.copytree(Path(rockbatch.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
    before = run_copy(tmp_path)
    assert run_copy(tmp_path) == before  # from the cache
    source = package / "core" / "block" / "equations.py"
    text = source.read_text(encoding="utf-8")
    line = "return arms_about(m, y.theta, side if side != 0.0 else key_of(m, contact))[1]\n"
    assert text.count(line) == 1
    source.write_text(text.replace(line, line.replace("return ", "return 0.0 * ")), encoding="utf-8")
    assert run_copy(tmp_path) == 0.0 < before


def test_the_digest_depends_on_every_source_of_the_core(tmp_path):
    core = tmp_path / "core"
    shutil.copytree(Path(rockbatch.__file__).parent / "core", core, ignore=shutil.ignore_patterns("__pycache__"))
    digest = core_digest(core)
    sources = sorted(core.rglob("*.py"))
    assert {source.parent for source in sources} > {core}
    for source in sources:
        text = source.read_bytes()
        source.write_bytes(text + b"\n")
        assert core_digest(core) != digest, source.name
        source.write_bytes(text)
    assert core_digest(core) == digest


def test_no_two_processes_write_one_file_of_machine_code():
    """Numba numbers the files of a function: processes that compile at one time could run each other's code."""

    def twice(x):
        return 2.0 * x

    names = {entry(twice)._cache._cache_file._data_name(1) for _ in range(2)}
    assert len(names) == 2


@pytest.mark.parametrize("building_block", [kernel, inlined_once])
def test_a_building_block_is_part_of_its_callers_only_and_python_may_call_it_too(building_block):
    """Machine code of its own would take a quarter of all compilation, and nobody would run it."""

    @building_block
    def twice(x):
        return 2.0 * x

    @numba.njit
    def caller(x):
        return twice(x) + 1.0

    assert caller(3.0) == 7.0
    compiled = twice.overloads[(numba.float64,)]
    assert compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name) == 0
    assert not compiled.library._codegen._engine.is_symbol_defined(compiled.fndesc.llvm_func_name)
    assert twice(4.0) == 8.0
