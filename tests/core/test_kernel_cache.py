"""Compiled kernels on disk never outlive the physics they were compiled from."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import rockbatch
from rockbatch.core.kernel import core_digest

SCRIPT = """
import numpy as np
from rockbatch.motions.motion import Motion
from rockbatch.simulation import run_fixed
from rockbatch.pier import ElasticBase, Pier
motion = Motion("push", 0.01, np.full(50, -3.0))
print(repr(run_fixed(Pier(0.2, 1.0), ElasticBase(50.0, 0.5), motion, 4, 0.0).theta_max))
"""


def run_copy(folder: Path) -> float:
    """Greatest rotation that the copy of the package in ``folder`` computes, in a process of its own."""
    environment = {**os.environ, "PYTHONPATH": str(folder), "HOME": str(folder)}
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], cwd=folder, env=environment, capture_output=True, text=True, check=True
    )
    return float(done.stdout)


def test_an_edit_in_a_called_kernel_changes_the_next_run(tmp_path):
    """Numba's own cache looks at the caller's file only. ż is doubled in laws.py, which the entry merely calls."""
    package = tmp_path / "rockbatch"
    shutil.copytree(Path(rockbatch.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
    before = run_copy(tmp_path)
    assert run_copy(tmp_path) == before  # from the cache
    source = package / "core" / "laws.py"
    text = source.read_text(encoding="utf-8")
    assert text.count("rate = velocity * m.stiffness") == 1
    source.write_text(
        text.replace("rate = velocity * m.stiffness", "rate = 2.0 * velocity * m.stiffness"),
        encoding="utf-8",
    )
    assert abs(run_copy(tmp_path) / before - 1.0) > 0.01


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
