"""Processor time [s] of the first run of a combination of pier and devices, which compiles its kernel.

Each in a process and a folder of its own, so that no cache helps; less that of the same run when its kernel is there.

    python benchmarks/first_compilation.py
"""

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

PIERS = ("rigid", "bouc-wen", "rigid with devices", "bouc-wen with devices")


def compile_and_run(pier: str, folder: str) -> float:
    """Return the processor time [s] of a first run, with kernels kept in ``folder``, over that of a second one."""
    from rockbatch.common.garbage import collect_rarely

    collect_rarely()  # as the command
    os.environ["ROCKBATCH_CACHE"] = folder
    import numpy as np

    from rockbatch.motions.motion import Motion
    from rockbatch.pier import Damper, Pier, RigidBase, Tendon, YieldingBase
    from rockbatch.simulation import run_fixed

    base = RigidBase() if pier.startswith("rigid") else YieldingBase(50.0, eta=3.0)
    if pier.endswith("devices"):
        base = replace(
            base, restraints=(Damper("viscous", nu=1.0), Damper("viscous", nu=0.3, exponent=0.5), Tendon(0.3))
        )
    motion = Motion("sine", 0.01, 4.0 * np.sin(np.arange(200) * 0.03))
    times = []
    for _ in range(2):
        start = time.process_time()
        run_fixed(Pier(0.2, 0.5), base, motion, 1)
        times.append(time.process_time() - start)
    return times[0] - times[1]


def main() -> None:
    """Print a line for each pier, or with its name and a folder the time alone."""
    if len(sys.argv) > 1:
        print(compile_and_run(*sys.argv[1:]))
        return
    print("| run | processor time of its compilation [s] |\n| --- | --- |")
    for pier in PIERS:
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, str(Path(__file__)), pier, folder]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
        print(f"| {pier} | {float(done.stdout):.1f} |", flush=True)


if __name__ == "__main__":
    main()
