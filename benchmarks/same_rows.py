"""Whether a change of the code leaves every table of every study in configs/ as it was, to the byte.

    python benchmarks/same_rows.py REVISION [--only near_fault fig7]

Both trees run each study and its analyses in one thread: this one, and a copy of REVISION in a temporary folder. CSV files are
compared as they are; that of ``rockbatch accuracy`` holds times, and is not made. Ends with 1 if any file differs.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path

TOP = Path(__file__).parents[1]
ANALYSES = ("fragility", "spectrum", "sensitivity")


def commands(study: Path) -> Iterator[list[str]]:
    """Yield the commands that a study is for: its runs and its analyses."""
    tables = tomllib.loads(study.read_text(encoding="utf-8"))
    yield ["run", str(study), "--jobs", "1"]
    for name in (name for name in ANALYSES if name in tables):
        yield [name, str(study), "--jobs", "1"]


def tables_of(tree: Path, study: Path, out: Path) -> dict[str, bytes]:
    """Return the CSV files that a tree makes of a study, by their names."""
    environment = os.environ | {"PYTHONPATH": str(tree), "OMP_NUM_THREADS": "1"}
    for command in commands(study):
        done = subprocess.run(
            [sys.executable, "-m", "rockbatch", *command, "--out", str(out)], cwd=tree, env=environment, capture_output=True,
            text=True, check=False,
        )  # fmt: skip
        if done.returncode not in (0, 1):
            raise SystemExit(f"rockbatch {' '.join(command)} in {tree}:\n{done.stderr}")
    return {path.name: path.read_bytes() for path in sorted(out.glob("*.csv"))}


def differences(before: Path, after: Path, studies: Sequence[str]) -> Iterator[str]:
    """Yield a line for each study: how many of its tables are the same, and which are not."""
    for name in studies:
        study = Path("configs", f"{name}.toml")
        with tempfile.TemporaryDirectory() as folder:
            old, new = (tables_of(tree, study, Path(folder, side)) for tree, side in ((before, "a"), (after, "b")))
        changed = [file for file in {**old, **new} if old.get(file) != new.get(file)]
        yield f"{name}: {len(old)} tables, " + (f"of which differ: {', '.join(changed)}" if changed else "all the same")


def main(revision: str, only: Sequence[str] = ()) -> int:
    """Compare this tree with ``revision``, study by study; return the exit code."""
    studies = only or [path.stem for path in sorted((TOP / "configs").glob("*.toml"))]
    with tempfile.TemporaryDirectory() as folder:
        before = Path(folder, "before")
        subprocess.run(["git", "worktree", "add", "--quiet", "--detach", str(before), revision], cwd=TOP, check=True)
        try:
            lines = []
            for line in differences(before, TOP, studies):
                print(line, flush=True)
                lines.append(line)
        finally:
            subprocess.run(["git", "worktree", "remove", "--force", str(before)], cwd=TOP, check=True)
    return int(any("differ" in line for line in lines))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("revision", metavar="REVISION")
    parser.add_argument("--only", nargs="+", default=(), metavar="NAME")
    arguments = parser.parse_args()
    sys.exit(main(arguments.revision, arguments.only))
