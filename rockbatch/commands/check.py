"""``rockbatch check``: design checks on finished results, as a table, as checks.csv and in the report."""

import argparse
import textwrap
from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

from rockbatch.commands.messages import say, show

if TYPE_CHECKING:
    from rockbatch.checks import Verdict
    from rockbatch.checks.wording import Notes
    from rockbatch.results.reading import Saved

HELP = "hold finished results against design checks"
EXAMPLE = "rockbatch check reports/pier"
WIDTH = 100
WORST = 10
"""Verdicts that are printed in full if there are too many for all."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("directory", type=Path, metavar="DIR", help="folder that `rockbatch run` has written")
    parser.add_argument(
        "--rules", type=Path, metavar="RULES.toml", help="file with [[check]] tables, instead of the study's own"
    )


def main(arguments: argparse.Namespace) -> int:
    from rockbatch.checks import write_verdicts
    from rockbatch.results.checking import verdicts
    from rockbatch.results.opened import open_results

    saved = open_results(arguments.directory)
    results = verdicts(saved, arguments.rules)
    if unusable := len(saved.info["unusable"]):
        say(f"files that are no usable records, and in no suite: {unusable}")
    code = tell(results, write_verdicts(arguments.directory, results), saved)
    from rockbatch.files import is_plain

    if is_plain(arguments.directory / "report.html"):
        from rockbatch.report import write_report

        say(str(write_report(arguments.directory, saved=saved)))
    return code


def tell(verdicts: Sequence["Verdict"], path: Path, saved: "Saved") -> int:
    """Print the verdicts, which are in ``path``, and the answer; return 1 if a check fails or is not decided, else 0."""
    from rockbatch.checks import wording

    many = len(verdicts) > wording.MOST
    show(summed_up(verdicts) if many else table(verdicts))
    show("\n" + answered(verdicts, saved))
    count = wording.count_of(verdicts)
    say(", ".join(f"{n} {way}" for way, n in count.items() if n))
    say(f"{path}{': all of them' if many else ''}")
    if not (count["pass"] or count["fail"] or count["not decided"]):
        say("none of the checks applies to these cases")
    return 0 if count["pass"] and not (count["fail"] or count["not decided"]) else 1


def answered(verdicts: Sequence["Verdict"], saved: "Saved") -> str:
    """Return the answer as the report begins with it, and the worst responses, whatever is checked."""
    from rockbatch.checks.answer import answer
    from rockbatch.checks.responses import RESPONSES, in_words, worst_of_all, worst_of_cases
    from rockbatch.checks.suite import simulated, suites
    from rockbatch.commands.marks import coloured, mark
    from rockbatch.commands.summary import named

    labels = {record["record"]: record.get("label") or record["record"] for record in saved.info["records"]}
    scaled = len({verdict.scale for verdict in verdicts}) > 1

    def case_of(verdict: "Verdict") -> str:
        values = verdict.columns | ({"scale": verdict.scale} if scaled else {})
        return f"{verdict.case} {named(values, values.values())}".rstrip()

    runs = simulated(saved.peaks[saved.peaks["case"] != ""])
    worst = worst_of_cases(suites(runs, saved.info["cases"]))
    lines = []
    for line in answer(verdicts, worst, case_of, lambda verdict: labels.get(verdict.record, verdict.record)):
        words = f"{line.says}: {line.which}." if line.which else f"{line.says}."
        lines.append(coloured(_filled(f"{mark(line.verdict).split()[0]} {words}", 0, 2), line.verdict))
        lines += [_filled(_plain(detail), 4, 6) for detail in line.details]
    if not verdicts:
        lines.append("No limits were set: nothing here passes or fails.")
    responses = {RESPONSES[name].words: response for name, response in worst_of_all(worst).items()}
    width = max(map(len, responses), default=0)
    for words, response in responses.items():
        columns = response.case["columns"]
        where = (
            f"{labels.get(response.run['record'], response.run['record'])}, {response.case['case']} "
            f"{named(columns, columns.values())}"
        )
        lines.append(_filled(f"{words:<{width}}  {in_words(response)}: {where.rstrip()}", 2, width + 6))
    return "\n".join(lines)


def table(verdicts: Sequence["Verdict"]) -> str:
    """Return a block of lines for each case and scale, then what each check asks."""
    from rockbatch.checks.wording import Notes

    notes = Notes(verdicts)
    return "\n\n".join([*_blocks(verdicts, notes), _checks(verdicts, notes)])


def summed_up(verdicts: Sequence["Verdict"]) -> str:
    """Return how many verdicts of each kind every check has, the worst of them, and what each check asks."""
    from rockbatch.checks import wording

    by_check: dict[str, list[Verdict]] = {}
    for verdict in verdicts:
        by_check.setdefault(verdict.check, []).append(verdict)
    rows = [(name, *map(str, wording.count_of(same).values())) for name, same in by_check.items()]
    head = ("check", *wording.WAYS)
    widths = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
    counts = "\n".join(
        "  ".join([row[0].ljust(widths[0]), *(n.rjust(w) for n, w in zip(row[1:], widths[1:], strict=True))])
        for row in (head, *rows)
    )
    parts = [f"{len(verdicts)} verdicts\n{counts}"]
    notes = wording.Notes(verdicts)
    if worst := wording.worst_first(verdicts)[:WORST]:
        parts += ["The worst", *_blocks(worst, notes)]
    return "\n\n".join([*parts, _checks(verdicts, notes)])


def _blocks(verdicts: Sequence["Verdict"], notes: "Notes") -> list[str]:
    """Return a block of lines for verdicts beside each other of one case and scale."""
    from rockbatch.checks import wording
    from rockbatch.commands.summary import named

    head = ("check", wording.records_of(verdicts), "demand", "limit", "ratio", "margin", "unit", "verdict")
    widths = [max(map(len, column)) for column in zip(head, *map(_cells, verdicts), strict=True)]
    many_scales = len({verdict.scale for verdict in verdicts}) > 1
    blocks = []
    for (case, columns, scale), block in groupby(verdicts, key=lambda v: (v.case, v.columns, v.scale)):
        values = columns | ({"scale": scale} if many_scales else {})
        lines = [f"{case}  {named(values, values.values())}".rstrip(), _line(head, widths)]
        for verdict in block:
            lines += _lines(verdict, widths, notes)
        blocks.append("\n".join(lines))
    return blocks


def _lines(verdict: "Verdict", widths: list[int], notes: "Notes") -> list[str]:
    """Return the numbers of a verdict, then remarks on them: the run that governs first."""
    from rockbatch.checks import wording
    from rockbatch.commands.marks import coloured

    lines = [coloured(_line(_cells(verdict), widths), verdict.verdict)]
    if verdict.verdict == "does not apply":
        return lines
    remarks = (wording.governing(verdict), verdict.counted, notes.of(verdict))
    if any(remarks):
        lines.append(_filled("; ".join(filter(None, remarks)), 6, 6))
    return lines


def _line(cells: Sequence[str], widths: list[int]) -> str:
    numbers = "  ".join(cell.rjust(width) for cell, width in zip(cells[1:-2], widths[1:-2], strict=True))
    return f"  {cells[0].ljust(widths[0])}  {numbers}  {cells[-2].ljust(widths[-2])}  {cells[-1]}"


def _cells(verdict: "Verdict") -> tuple[str, ...]:
    from rockbatch.checks import wording
    from rockbatch.commands.marks import mark

    return (
        verdict.check,
        str(verdict.records) if verdict.records else "",
        _plain(wording.demanded(verdict)),
        _plain(wording.limit(verdict, ("<=", ">="))),
        _plain(wording.ratio(verdict)),
        _plain(wording.margin(verdict)),
        verdict.unit,
        mark(verdict.verdict),
    )


def _plain(text: str) -> str:
    for sign, instead in {"\u00a0": " ", "∞": "inf", "≥": ">=", "≤": "<="}.items():
        text = text.replace(sign, instead)
    return text


def _checks(verdicts: Sequence["Verdict"], notes: "Notes") -> str:
    """Return what each check asks, and why; what a record is, and the basis of the statistics of codes."""
    from rockbatch.checks import wording

    first = {verdict.check: verdict for verdict in reversed(verdicts)}
    names = dict.fromkeys(verdict.check for verdict in verdicts)
    rests = {verdict.statistic: verdict for verdict in reversed(verdicts) if wording.unchecked(verdict)}
    lines = [_asked(first[name]) for name in names]
    lines += [_filled(note, 2, 6) for note in (*notes.common(), *wording.counting(verdicts))]
    lines += [_filled(f"{name}: {wording.unchecked(verdict)}.", 2, 6) for name, verdict in rests.items()]
    return "\n".join(["Checks", *lines])


def _asked(verdict: "Verdict") -> str:
    """Return what a check asks, and why."""
    from rockbatch.checks import wording

    asked = f"{verdict.check}: {wording.asked(verdict)} [{verdict.basis}] {verdict.reason}"
    return _filled(asked.rstrip(), 2, 6)


def _filled(text: str, first: int, rest: int) -> str:
    from rockbatch.commands.marks import shown

    filled = textwrap.fill(text, WIDTH, initial_indent=" " * first, subsequent_indent=" " * rest)
    return shown(filled, filled.encode("ascii", "replace").decode())
