"""How long a command takes to answer Ctrl-C, and then to end, wherever it is: clock time.

    python benchmarks/interrupts.py [--times 3]

Each place is a time [s] behind a line that the command prints, behind its start, or behind the beginning of a file. Cold ones
find no compiled kernels. A command that ends without a word answers by ending.
"""

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import NamedTuple

from around import CONFIGS, study

import rockbatch

STUDIES = {
    "many": study("19,200 runs to the tolerance", 12, 16, 10, 10, "tolerance = 1e-4"),
    "histories": study("192 runs with their histories", 12, 16, 1, 1, "substeps = 4").replace('"none"', '"all"'),
    "fig7": (CONFIGS / "fig7.toml").read_text(encoding="utf-8"),
}


class Place(NamedTuple):
    """Where a command is interrupted: ``after`` seconds behind the ``line``, the start ("") or the beginning of ``file``."""

    study: str
    words: tuple[str, ...] = ()
    line: str = ""
    file: str = ""
    after: float = 0.0
    cold: bool = False


PLACES = {
    "start": Place("many", after=0.1),
    "loading": Place("many", after=0.6),
    "compilation begins": Place("many", line="compiling", after=0.5, cold=True),
    "compilation goes on": Place("many", line="compiling", after=6.0, cold=True),
    "first group": Place("many", line="12 records", after=0.5),
    "in the middle": Place("many", line="12 records", after=6.0),
    "histories": Place("histories", file="histories.h5", after=0.2),
    "report": Place("histories", file="run.json", after=0.3),
    "workers of dask start": Place("many", ("--engine", "dask"), after=2.5),
    "workers of dask": Place("many", ("--engine", "dask"), line="12 records", after=5.0),
}


def interrupted(place: Place, folder: Path) -> tuple[float, float, int]:
    """Seconds from the signal to the next line and to the end, and the exit status."""
    path = folder / "study.toml"
    path.write_text(STUDIES[place.study], encoding="utf-8")
    out = folder / "out"
    environment = os.environ | {"PYTHONPATH": str(Path(rockbatch.__file__).parents[1])}
    if place.cold:
        environment["ROCKBATCH_CACHE"] = str(folder / "kernels")
    command = [sys.executable, "-m", "rockbatch", "run", str(path), "--out", str(out), "--fresh", *place.words]
    with subprocess.Popen(
        command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, env=environment, cwd=folder, text=True
    ) as process:
        lines: list[tuple[float, str]] = []
        reader = threading.Thread(target=lambda: lines.extend((time.monotonic(), line) for line in process.stderr))
        reader.start()
        _wait(lambda: any(text.startswith(place.line) for _, text in lines) or not place.line, process)
        _wait(lambda: not place.file or any(out.glob(f"*{place.file}*")), process)
        time.sleep(place.after)
        sent = time.monotonic()
        process.send_signal(signal.SIGINT)
        status = process.wait()
        ended = time.monotonic()
        reader.join()
    return next((t for t, _ in lines if t > sent), ended) - sent, ended - sent, status


def _wait(until: Callable[[], bool], process: subprocess.Popen) -> None:
    while not until() and process.poll() is None:
        time.sleep(0.01)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("places", nargs="*", metavar="PLACE", help=", ".join(PLACES))
    parser.add_argument("--times", type=int, default=3)
    arguments = parser.parse_args()
    print("| place | first line [s] | end [s] | exit status |\n| --- | --- | --- | --- |")
    for name in arguments.places or PLACES:
        taken = []
        for _ in range(arguments.times):
            with tempfile.TemporaryDirectory() as folder:
                taken.append(interrupted(PLACES[name], Path(folder)))
        answers, ends, statuses = zip(*taken, strict=True)
        print(
            f"| {name} | {median(answers):.2f} | {median(ends):.2f} | {', '.join(map(str, sorted(set(statuses))))} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
