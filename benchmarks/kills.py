"""Every command that writes, killed at random instants and repeated: it ends with the same bytes, and loses no finished run.

    python benchmarks/kills.py [--kills 60] [--seed 1] [COMMAND ...]

Each command is carried out undisturbed, twice: a file in which the two differ, by a date or a duration, is compared by its
presence alone. Then it is killed (SIGKILL, with its whole process group) at a random instant of its duration and repeated
without a kill, as often as asked in turn over the commands. A kill fails if the repetition ends with another status, other
files, other bytes, or fewer finished rows than were there; it is printed with its instant, and the exit code is 1. A hidden
file that was being written when the process died (``.NAME-….unfinished``) may stay; nothing reads it.
"""

import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import rockbatch
from rockbatch.common.files import UNFINISHED

MOTIONS = Path(__file__).parents[1] / "motions" / "near_fault"

STUDY = f"""
title = "Killed"

[pier]
alpha = 0.15
p = 0.6
mass_t = 900.0

[motions]
path = "{MOTIONS}"
axis_deg = 35

[output]
histories = "worst"
forces = true
sections_m = [4.0]

[[case]]
name = "feet"
base = "elastic"
stiffness_kN_m = 2.0e6
zeta = 0.05

[[case]]
name = "rigid"
base = "rigid"

[[check]]
name = "rotation"
demand = "theta_max_over_alpha"
at_most = 0.4
basis = "judgement"
reason = "made up"

[[bound]]
name = "soft"
"case.stiffness_kN_m" = {{ times = 0.5 }}

[design]
vary = "case.stiffness_kN_m"
between = [1e6, 4e6]
find = "least"
points = 4
width = 2e5

[fragility]
measure = "PGV"
levels_m_s = [0.5, 1.0, 1.5]

[sensitivity]
samples = 8

[sensitivity.uniform]
zeta = [0.02, 0.10]

[spectrum]
alpha = [0.15]
p = [0.5, 1.0]
points = 4
"""


class Command(NamedTuple):
    """Words behind ``rockbatch``, and a command to be carried out before (for its input)."""

    words: tuple[str, ...]
    before: tuple[str, ...] = ()


RUN = ("run", "study.toml", "--out", "out")
COMMANDS = {
    "run": Command(RUN),
    "dask": Command((*RUN, "--engine", "dask", "--jobs", "2")),
    "check": Command(("check", "out"), RUN),
    "report": Command(("report", "out"), RUN),
    "sheet": Command(("report", "out", "--sheet"), RUN),
    "design": Command(("design", "study.toml", "--out", "out")),
    "fragility": Command(("fragility", "study.toml", "--out", "out")),
    "sensitivity": Command(("sensitivity", "study.toml", "--out", "out")),
    "spectrum": Command(("spectrum", "study.toml", "--out", "out")),
    "statics": Command(("statics", "study.toml", "--csv", "out/statics.csv")),
    "motions": Command(("motions", str(MOTIONS), "--csv", "out/motions.csv", "--html", "out/motions.html")),
    "init": Command(("init", "out")),
}


def started(words: tuple[str, ...], folder: Path) -> subprocess.Popen:
    environment = os.environ | {"PYTHONPATH": str(Path(rockbatch.__file__).parents[1])}
    return subprocess.Popen(
        [sys.executable, "-m", "rockbatch", *words],
        cwd=folder,
        env=environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        start_new_session=True,
    )


def carried_out(words: tuple[str, ...], folder: Path) -> tuple[int, str, float]:
    """Return the exit status of a command, its messages and its duration [s]."""
    begin = time.monotonic()
    process = started(words, folder)
    messages = process.communicate()[1].decode()
    return process.returncode, messages, time.monotonic() - begin


def prepared(command: Command, folder: Path) -> None:
    """Put the input of a command into an empty folder."""
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "out").mkdir(parents=True)
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    if command.words[0] == "init":
        (folder / "out").rmdir()
    if command.before:
        carried_out(command.before, folder)


def files(folder: Path) -> dict[str, bytes]:
    paths = (path for path in sorted(folder.rglob("*")) if path.is_file() and path.suffix != UNFINISHED)
    return {str(path.relative_to(folder)): path.read_bytes() for path in paths}


def finished_rows(folder: Path) -> int:
    """Number of rows in tables and journals of ``folder``, but for the headings."""
    return sum(max(path.read_bytes().count(b"\n") - 1, 0) for path in folder.glob("out/*.csv*"))


class Reference(NamedTuple):
    """What a command does without a kill."""

    status: int
    files: dict[str, bytes]
    stable: frozenset[str]  # names of the files that are the same each time
    duration: float  # [s]


def reference(command: Command, folder: Path) -> Reference:
    seen = []
    for _ in range(2):
        prepared(command, folder)
        status, messages, duration = carried_out(command.words, folder)
        assert status in (0, 1), messages
        seen.append(files(folder))
    assert seen[0].keys() == seen[1].keys()
    stable = frozenset(name for name, content in seen[0].items() if seen[1][name] == content)
    return Reference(status, seen[1], stable, duration)


def failures_of_kill(command: Command, folder: Path, wanted: Reference, instant: float) -> tuple[list[str], bool]:
    """Return what is wrong after a kill at ``instant`` [s] and a repetition, and whether the kill came before the end."""
    prepared(command, folder)
    process = started(command.words, folder)
    time.sleep(instant)
    alive = process.poll() is None
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        alive = False
    process.communicate()
    rows = finished_rows(folder)
    status, messages, _ = carried_out(command.words, folder)
    found = files(folder)
    failures = [f"status {status}, not {wanted.status}: {messages[-300:]}"] if status != wanted.status else []
    if found.keys() != wanted.files.keys():
        failures.append(f"other files: {sorted(found.keys() ^ wanted.files.keys())}")
    failures += [
        f"{name} differs" for name in sorted(wanted.stable & found.keys()) if found[name] != wanted.files[name]
    ]
    if finished_rows(folder) < rows:
        failures.append(f"{rows} rows before the repetition, {finished_rows(folder)} after it")
    return failures, alive


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("commands", nargs="*", metavar="COMMAND", help=", ".join(COMMANDS))
    parser.add_argument("--kills", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    chance, failed = random.Random(arguments.seed), 0
    names = arguments.commands or list(COMMANDS)
    print(
        "| command | duration [s] | files, of them compared by bytes | kills, of them before the end | failed |\n"
        "| - | - | - | - | - |"
    )
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "work"
        for place, name in enumerate(names):
            command = COMMANDS[name]
            wanted = reference(command, folder)
            kills, before, bad = len(range(place, arguments.kills, len(names))), 0, 0
            for _ in range(kills):
                instant = chance.uniform(0.0, wanted.duration)
                failures, alive = failures_of_kill(command, folder, wanted, instant)
                before, bad = before + alive, bad + bool(failures)
                for failure in failures:
                    print(f"{name}, killed after {instant:.3f} s: {failure}", file=sys.stderr, flush=True)
            failed += bad
            shown = f"{len(wanted.files)}, {len(wanted.stable)}"
            print(f"| {name} | {wanted.duration:.1f} | {shown} | {kills}, {before} | {bad} |", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
