"""Ground motions need nothing of the rest: a copy of their package reads records where there is no pier."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from rockbatch import motions

ROOT = Path(__file__).parents[2]
USED = ("motions", "toml", "common")

SCRIPT = """
import importlib, pkgutil, sys
from pathlib import Path
import rockbatch.motions as motions

assert "numpy" not in sys.modules  # nothing is loaded before it is used
for module in pkgutil.walk_packages(motions.__path__, "rockbatch.motions."):
    importlib.import_module(module.name)
for name in motions.__all__:
    getattr(motions, name)
records = motions.read_motions(sys.argv[1])
assert not records.unusable, records.unusable
print(len(records), round(records["CHAN15"].pga_g, 3), motions.write_manifest(Path(sys.argv[1])).name)
print([name for name in sys.modules if name.partition(".")[0] in ("numba", "llvmlite")])
"""


@pytest.mark.slow
def test_a_copy_of_the_package_alone_reads_records(tmp_path):
    (tmp_path / "rockbatch").mkdir()
    (tmp_path / "rockbatch" / "__init__.py").touch()
    for name in USED:
        shutil.copytree(ROOT / "rockbatch" / name, tmp_path / "rockbatch" / name)
    shutil.copytree(ROOT / "motions" / "near_fault", tmp_path / "records")
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    command = [sys.executable, "-W", "ignore", "-c", SCRIPT, str(tmp_path / "records")]
    done = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.stderr == ""
    assert done.stdout.splitlines() == ["10 0.311 motions.toml", "[]"]


def test_all_public_names_are_loaded_when_they_are_used():
    assert sorted(motions._HOMES) == sorted(motions.__all__) == sorted(dir(motions))
