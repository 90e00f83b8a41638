"""Damaged records of every format, damaged manifests, and folders that change while they are read: how they end, and how
long the slowest of them takes.

    python benchmarks/broken_files.py [--records 10000] [--manifests 5000] [--changing 500] [FORMAT ...]

The files and the ways to damage them are those of the tests. A file that ends in neither components nor a reason, takes a
second of computing time or asks for 300 MB on top ends the script with a traceback, and its format has no counts.
"""

import argparse
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

TESTS = Path(__file__).resolve().parent.parent / "tests"
sys.path[:0] = [str(TESTS / "helpers"), str(TESTS / "motions")]

import test_fuzz as fuzz  # noqa: E402


def main() -> None:
    parser = argparse.ArgumentParser(description="Damage records and manifests, and read them.")
    parser.add_argument("format", nargs="*", help="formats, by the names that the messages give them")
    parser.add_argument("--records", type=int, default=10_000, help="damaged files of each format")
    parser.add_argument("--manifests", type=int, default=5_000, help="damaged manifests")
    parser.add_argument("--changing", type=int, default=500, help="folders that change while they are read")
    parser.add_argument("--seed", type=int, default=3)
    asked = parser.parse_args()
    print(f"{'format':26}{'files':>8}{'components':>12}{'reasons':>9}{'slowest [ms]':>14}", flush=True)
    for name in asked.format or sorted(fuzz.SAMPLES):
        tell(name, fuzz.read_all_ways_of_damage, name, asked.records, asked.seed)
    if not asked.format:
        names = sorted(fuzz.MANIFESTS)
        for name in names:
            with tempfile.TemporaryDirectory() as folder:
                tell(name, fuzz.read_damaged_manifests, Path(folder), name, asked.manifests // len(names), asked.seed)
        with tempfile.TemporaryDirectory() as folder:
            tell("folders that change", fuzz.read_changing_folders, Path(folder), asked.changing, asked.seed)


def tell(name: str, read: Callable[..., "fuzz.Counts"], *arguments: object) -> None:
    """Print a line of the table: its name, and the counts that ``read(*arguments)`` returns."""
    print(f"{name:25} ", end="", flush=True)
    counts = read(*arguments)
    total = counts.good + counts.refused
    print(f"{total:8}{counts.good:12}{counts.refused:9}{1000 * counts.slowest:14.0f}", flush=True)


if __name__ == "__main__":
    main()
