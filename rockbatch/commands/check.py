"""``rockbatch check``: design checks on finished results, as a table, as checks.csv and in the report."""

import argparse
import math
import textwrap
from collections.abc import Iterable, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

from rockbatch.commands.messages import say

if TYPE_CHECKING:
    from rockbatch.checks import Verdict

HELP = "hold finished results against design checks"
EXAMPLE = "rockbatch check reports/pier"
WIDTH = 100
HEAD = ("check", "records", "demand", "limit", "ratio", "margin", "verdict")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("directory", type=Path, metavar="DIR", help="folder that `rockbatch run` has written")
    parser.add_argument(
        "--rules", type=Path, metavar="RULES.toml", help="file with [[check]] tables, instead of the study's own"
    )


def main(arguments: argparse.Namespace) -> int:
    from rockbatch.checks import write_verdicts
    from rockbatch.results.checking import verdicts
    from rockbatch.results.reading import read_saved

    saved = read_saved(arguments.directory)
    found = verdicts(saved, arguments.rules)
    if unusable := len(saved.info["unusable"]):
        say(f"files that are no usable records, and in no suite: {unusable}")
    code = tell(found, write_verdicts(arguments.directory, found))
    if (arguments.directory / "report.html").exists():
        from rockbatch.report import write_report

        say(str(write_report(arguments.directory)))
    return code


def tell(verdicts: Sequence["Verdict"], path: Path) -> int:
    """Print the verdicts, which are in ``path``; returns 1 if a check fails or is not decided, else 0."""
    print(table(verdicts))
    ways = ("pass", "fail", "not decided", "does not apply")
    count = {way: sum(verdict.verdict == way for verdict in verdicts) for way in ways}
    say(", ".join(f"{n} {way}" for way, n in count.items() if n))
    say(str(path))
    if not (count["pass"] or count["fail"] or count["not decided"]):
        say("none of the checks applies to these cases")
    return 0 if count["pass"] and not (count["fail"] or count["not decided"]) else 1


def table(verdicts: Iterable["Verdict"]) -> str:
    """A block of lines for each case and scale, then what each check asks."""
    from rockbatch.commands.summary import named

    verdicts = list(verdicts)
    widths = [max(map(len, column)) for column in zip(HEAD, *map(_cells, verdicts), strict=True)]
    many_scales = len({verdict.scale for verdict in verdicts}) > 1
    blocks = []
    for (case, columns, scale), block in groupby(verdicts, key=lambda v: (v.case, v.columns, v.scale)):
        values = columns | ({"scale": scale} if many_scales else {})
        blocks.append("\n".join([f"{case}  {named(values, values.values())}".rstrip(), *_lines(list(block), widths)]))
    asked = {verdict.check: verdict for verdict in verdicts}
    return "\n\n".join([*blocks, "\n".join(["Checks", *map(_asked, asked.values())])])


def _lines(verdicts: list["Verdict"], widths: list[int]) -> list[str]:
    lines = [_line(HEAD, widths)]
    for verdict in verdicts:
        lines.append(_line(_cells(verdict), widths))
        if verdict.verdict == "does not apply":
            continue
        if told := "; ".join(filter(None, (verdict.counted, verdict.note))):
            lines.append(textwrap.fill(told, WIDTH, initial_indent=" " * 6, subsequent_indent=" " * 6))
    return lines


def _line(cells: Sequence[str], widths: list[int]) -> str:
    numbers = "  ".join(cell.rjust(width) for cell, width in zip(cells[1:-1], widths[1:-1], strict=True))
    return f"  {cells[0].ljust(widths[0])}  {numbers}  {cells[-1]}"


def _cells(verdict: "Verdict") -> tuple[str, ...]:
    at_least = ">= " if math.isinf(verdict.high) and math.isfinite(verdict.value) else ""
    sign = "<=" if verdict.sense == "at most" else ">="
    loud = {"fail": "FAIL", "not decided": "NOT DECIDED"}
    return (
        verdict.check,
        str(verdict.records) if verdict.records else "",
        at_least + _number(verdict.value, ".4g"),
        f"{sign} {verdict.limit:.4g}",
        _number(verdict.ratio, ".4f" if 0.995 <= verdict.ratio < 1.005 and verdict.ratio != 1 else ".2f"),
        _number(verdict.margin, ".3g"),
        loud.get(verdict.verdict, verdict.verdict),
    )


def _number(value: float, form: str) -> str:
    return "" if math.isnan(value) else f"{value:{form}}"


def _asked(verdict: "Verdict") -> str:
    """What a check asks, and why."""
    asked = f"{verdict.check}: {verdict.words} {verdict.sense} {verdict.limit:g} [{verdict.basis}] {verdict.reason}"
    counting = f" ({verdict.counting})" if verdict.counting else ""
    return textwrap.fill(asked.rstrip() + counting, WIDTH, initial_indent="  ", subsequent_indent=" " * 6)
