"""Processor time [s] of a first study in a second copy of rockbatch, after another copy has compiled its kernels.

Two copies in folders of their own, without bytecode, and a cache of kernels that is empty at first. The first copy compiles;
the second and third run of the second one differ by what a fresh copy costs beside its study.

    python benchmarks/second_copy.py [STUDY.toml]
"""

import os
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import rockbatch

TOP = Path(__file__).parents[1]
RUN = """
import sys
from numba.core import event
from rockbatch.commands.cli import main

class Compilations(event.Listener):
    count = 0
    def on_start(self, _):
        self.count += 1
    def on_end(self, _):
        pass

compilations = Compilations()
with event.install_listener("numba:compile", compilations):
    code = main(["run", *sys.argv[1:], "--fresh"])
print(compilations.count)
sys.exit(code)
"""


def run(copy: Path, study: Path, kernels: Path) -> tuple[int, float]:
    """Return the number of functions that a run of the study compiles, and its processor time [s] with its processes'."""
    environment = os.environ | {"PYTHONPATH": str(copy), "ROCKBATCH_CACHE": str(kernels)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [sys.executable, "-P", "-c", RUN, str(study), "--out", str(copy / "out")]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return int(done.stdout.split()[-1]), seconds


def main() -> None:
    """Print a line for each run."""
    study = Path(sys.argv[1]) if len(sys.argv) > 1 else TOP / "configs" / "near_fault.toml"
    print("| run | compiled functions | processor time [s] |\n| --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        kernels, copies = Path(folder, "kernels"), [Path(folder, name) for name in ("one", "two")]
        for copy in copies:
            ignored = shutil.ignore_patterns("__pycache__")
            shutil.copytree(Path(rockbatch.__file__).parent, copy / "rockbatch", ignore=ignored)
        taken = []
        for words, copy in (("first copy", copies[0]), ("second copy", copies[1]), ("again", copies[1])):
            count, seconds = run(copy, study.resolve(), kernels)
            print(f"| {words} | {count} | {seconds:.1f} |", flush=True)
            taken.append((count, seconds))
    (_, _), (compiled, fresh), (_, study_alone) = taken
    print(f"| second copy, beside the study | {compiled} | {fresh - study_alone:.1f} |")


if __name__ == "__main__":
    main()
