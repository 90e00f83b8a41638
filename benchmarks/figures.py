"""Measure again what the pages state: `python benchmarks/figures.py [--long] [--only WORD]`, or `make figures [LONG=1]`.

figures.toml has the commands, what they print, and the sentences and tables of the pages that state it. Prints each that is
stated otherwise than measured; ends with 1 if there is one. Commands above five minutes run with --long only, and those that
need files of others where the variable in `needs` names their folder.
"""

import argparse
import os
import re
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
LONG = 5  # minutes
SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
STATED = re.compile(r"\{(.+?)\}")

Entry = dict[str, Any]


def commands() -> list[Entry]:
    """Return the commands, each with its `figure`s (sentences) and `table`s."""
    listed: list[Entry] = tomllib.loads((Path(__file__).parent / "figures.toml").read_text(encoding="utf-8"))["command"]
    return listed


def number(text: str) -> tuple[float, float]:
    """Return a number as pages or programs write it, and half a unit of its last digit."""
    plain = text.replace(",", "").replace("−", "-").replace(" × ", "·")
    digits, _, power = plain.partition("·10") if "·10" in plain else plain.lower().partition("e")
    scale = 10.0 ** int(power.translate(SUPERSCRIPTS) or 0)
    return float(digits) * scale, 0.5 * scale * 10.0 ** -len(digits.partition(".")[2])


def squashed(text: str) -> str:
    """Return a text with all its white space alike."""
    return " ".join(text.split())


def sentence(figure: Entry) -> str:
    """Return the words of a page in which a figure stands."""
    return squashed(STATED.sub(r"\1", figure["says"]))


def rows(page: str, head: str) -> list[str]:
    """Return the rows of the table of a page whose head begins so."""
    lines = (ROOT / page).read_text(encoding="utf-8").splitlines()
    first = next((k for k, line in enumerate(lines) if line.startswith(head)), len(lines)) + 2
    last = next((k for k in range(first, len(lines)) if not lines[k].startswith("|")), len(lines))
    return [squashed(line) for line in lines[first:last]]


def differing(command: Entry, printed: str) -> Iterator[str]:
    """Yield what pages state otherwise than the command has printed."""
    for figure in command.get("figure", ()):
        match = re.search(figure["prints"], printed, re.MULTILINE)
        measured = match.groups() if match else ()
        factor = figure.get("factor")
        for stated, found in zip(STATED.findall(figure["says"]), measured, strict=bool(match)):
            (here, half), (there, _) = number(stated), number(found)
            if not (here / factor <= there <= here * factor if factor else abs(here - there) <= half * (1.0 + 1e-9)):
                yield f"{figure['page']}: {sentence(figure)!r}: {stated} is now {found}"
        if match is None:
            yield f"{figure['page']}: {sentence(figure)!r}: not printed any more"
    lines = {squashed(line) for line in printed.splitlines()}
    for table in command.get("table", ()):
        yield from (f"{table['page']}: not so any more: {row}" for row in rows(**table) if row not in lines)


def measure(command: Entry) -> str:
    """Run a command in the repository and return what it prints."""
    path = os.pathsep.join((str(Path(sys.executable).parent), os.environ.get("PATH", "")))
    environment = os.environ | {"PATH": path, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(["bash", "-c", command["run"]], cwd=ROOT, env=environment, capture_output=True, text=True)
    return done.stdout + (f"\n{done.stderr}" if done.returncode > 1 else "")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--long", action="store_true", help=f"commands above {LONG} minutes, too")
    parser.add_argument("--only", default="", metavar="WORD", help="commands that contain this")
    arguments = parser.parse_args()
    wrong = 0
    for command in commands():
        run, minutes = command["run"], command["minutes"]
        missing = command.get("needs", "PATH") not in os.environ
        if arguments.only not in run:
            continue
        if missing or (minutes > LONG and not arguments.long):
            print(
                f"not run ({command['needs'] + ' is not set' if missing else f'{minutes} minutes'}): {run}", flush=True
            )
            continue
        start = time.monotonic()
        told = list(differing(command, measure(command)))
        wrong += len(told)
        print(
            "\n".join([f"{(time.monotonic() - start) / 60.0:.1f} minutes: {run}", *(f"  {line}" for line in told)]),
            flush=True,
        )
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
