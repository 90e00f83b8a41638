"""The table of SECURITY.md: what was damaged, changed while it was read, or killed, how often, and how often it ended badly.

    python benchmarks/troubles.py [--share 1.0]

The counts are those of damage.py, broken_files.py and kills.py, whose heads say what ends badly; ``--share`` of them for a
shorter trial. The exit code is 1 if anything ended badly.
"""

import argparse
import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

MANIFESTS, CHANGING = ("motions.csv", "motions.toml"), "folders that change"


class Row(NamedTuple):
    """What was tried, how often, and how often it ended badly."""

    trouble: str
    times: int
    badly: int


def of_damage(printed: str) -> list[Row]:
    """Return the rows of what damage.py printed."""
    names = {
        "analysis": "tables of analyses",
        "journal": "journals",
        "study": "studies",
        "folder": "folders of results",
    }
    counts = re.findall(r"^(\w+): (\d+) damaged, (\d+) ended badly$", printed, re.MULTILINE)
    return [Row(f"damaged {names.get(name, name)}", int(times), int(badly)) for name, times, badly in counts]


def of_broken_files(printed: str) -> list[Row]:
    """Return the rows of what broken_files.py printed, whose last line is a name without counts if a file of it ended badly."""
    lines = re.findall(r"^(\S.*?) +(?:(\d+) +\d+ +\d+ +\d+)?$", printed, re.MULTILINE)
    files, badly = {name: int(times or 0) for name, times in lines}, {name for name, times in lines if not times}
    formats = [name for name in files if name not in (*MANIFESTS, CHANGING)]
    kinds = {f"damaged records of {len(formats)} formats": formats, "damaged manifests": MANIFESTS}
    kinds["folders of records that change while they are read"] = [CHANGING]
    return [
        Row(kind, sum(files.get(name, 0) for name in names), len(badly.intersection(names)))
        for kind, names in kinds.items()
    ]


def of_kills(printed: str) -> list[Row]:
    """Return the row of what kills.py printed, with the kills before the end of their command."""
    counts = re.findall(r"^\| (\w+) \|.*\| \d+, (\d+) \| (\d+) \|$", printed, re.MULTILINE)
    badly = sum(int(bad) for *_, bad in counts)
    return [
        Row(f"kills of {len(counts)} commands at random instants", sum(int(kills) for _, kills, _ in counts), badly)
    ]


SCRIPTS = {
    "damage.py": (of_damage, {"studies": 1000, "journals": 1000, "folders": 60, "analyses": 30, "rules": 1000}),
    "broken_files.py": (of_broken_files, {"records": 200, "manifests": 1000, "changing": 100}),
    "kills.py": (of_kills, {"kills": 60}),
}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--share", type=float, default=1.0)
    share = parser.parse_args().share
    print("| what | number | ended badly |\n| --- | --- | --- |", flush=True)
    failed = False
    for script, (rows, numbers) in SCRIPTS.items():
        words = [word for name, number in numbers.items() for word in (f"--{name}", str(round(share * number) or 1))]
        path = Path(__file__).parent / script
        done = subprocess.run([sys.executable, str(path), *words, "--seed", "51"], capture_output=True, text=True)
        for trouble, times, badly in rows(done.stdout):
            print(f"| {trouble} | {times:,} | {badly} |", flush=True)
        if done.returncode:
            failed = True
            print(f"{script}:\n{done.stdout}\n{done.stderr}", file=sys.stderr)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
