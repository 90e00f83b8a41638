"""``rockbatch check`` and ``rockbatch report``: check finished results, and rewrite their report."""

import argparse
import math
import shlex
from collections.abc import Callable, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

from rockbatch.checks import Verdict, wording, write_verdicts
from rockbatch.checks.answer import answer
from rockbatch.checks.coverage import CaseRuns, runs_of_cases, stations_of
from rockbatch.checks.remarks import bounds_in_words, pulled_supports, undamped_settlement, weak_supports
from rockbatch.checks.responses import worst_of_cases
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS
from rockbatch.checks.wording import SIGNS, Notes
from rockbatch.commands import scorecard
from rockbatch.common.files import is_plain
from rockbatch.quantities.labels import record_labels
from rockbatch.reporting import report as make_report
from rockbatch.reporting import write_report
from rockbatch.results.checking import verdicts
from rockbatch.results.labelled import Labelled, labelled
from rockbatch.results.opened import open_results
from rockbatch.results.reading import Saved
from rockbatch.terminal.streams import aligned, coloured, filled, say, show, shown, width
from rockbatch.toml.reader import TomlFile

WORST = 10
"""Number of verdicts printed in full if there are too many to print all."""


class Called(NamedTuple):
    """Functions that name the case and the record of a verdict."""

    case_of: Callable[[Verdict | CaseRuns], str]
    record_of: Callable[[Verdict], str]


_COLOURS = {PASS: "32", FAIL: "31", NOT_DECIDED: "33"}  # green, red, amber
_COUNTED = {DOES_NOT_APPLY: "not applicable"}
_LOUD = {FAIL: "FAIL", NOT_DECIDED: "NOT DECIDED"}
_PLAIN = {PASS: "+", FAIL: "x", NOT_DECIDED: "?", DOES_NOT_APPLY: "-"}
_LEFT_OUT = (5, 4, 1)
"""Columns of verdicts omitted in a narrow terminal, in this order: margin, ratio, records."""


def main(arguments: argparse.Namespace) -> int:
    """Check results against rules; print and write the verdicts, rewrite an existing report; return the code of :func:`tell`."""
    saved = open_results(arguments.directory)
    results = verdicts(saved, arguments.rules)
    code = tell(results, write_verdicts(arguments.directory, results), saved, arguments.all)
    if is_plain(arguments.directory / "report.html"):
        say(str(write_report(arguments.directory, saved=saved)))
    study = saved.info["study"]
    edited = [file["path"] for file in (study, *study.get("checks", ())) if not _is_as_run(file)]
    # A run mostly starts at or above its results: elsewhere a relative path may lead to another file.
    is_below = arguments.directory.resolve().is_relative_to(Path.cwd())
    if edited and arguments.rules is None and is_below:
        again = shlex.join(["rockbatch", "run", study["path"], "--out", str(arguments.directory)])
        say(f"{', '.join(edited)}: edited since the run, whose limits these are; {again} applies the new ones")
    return code


def _is_as_run(file: Mapping[str, str]) -> bool:
    """Return whether a file of run.json has the text that it had then; True if it cannot be read where it was."""
    try:
        return TomlFile.text_of(Path(file["path"])) == file["text"]
    except ValueError:  # an InputError, or a path with a NUL
        return True


def report(arguments: argparse.Namespace) -> int:
    """Rewrite the report of results, write their calculation sheet, or compare two studies; return 0.

    The paths are printed on stderr, after the answer of a comparison, which is left out if the page goes to stdout.
    """
    made = make_report(
        arguments.directory,
        arguments.other,
        out=arguments.out,
        whole=arguments.all,
        sheet=arguments.sheet,
        paper=arguments.paper,
        pairs=dict(arguments.pair),
    )
    if str(arguments.out) == "-":
        return 0
    if made.answer:
        show(filled(_plain(made.answer)))
    say(str(made.path))
    if made.pdf and made.pdf != made.path:
        say(str(made.pdf))
    elif made.is_sheet and arguments.out is None:
        say('no PDF was written: install typst with pip install "rockbatch[pdf]"')
    return 0


def sign(verdict: str) -> str:
    """Return the sign of a verdict, "✓" or "✗"; an ASCII one, "+" or "x", if stdout cannot show it."""
    return shown(SIGNS[verdict], _PLAIN[verdict])


def mark(verdict: str) -> str:
    """Return sign and word of a verdict: "✓ pass", "✗ FAIL"."""
    return f"{sign(verdict)} {_LOUD.get(verdict, verdict)}"


def tell(verdicts: Sequence[Verdict], path: Path, saved: Saved, whole: bool = False) -> int:
    """Print the scorecard and the answer; return the exit code.

    It is 0 if a verdict passes, none fails or is undecided, a check applies to the cases, and every file could be used; else 1.
    ``path`` is the file of verdicts; with ``whole`` their numbers and the checks' requirements are printed first.
    """
    many = len(verdicts) > wording.MOST
    applicable = [verdict.verdict != DOES_NOT_APPLY for verdict in verdicts if verdict.case]
    idle = bool(applicable) and not any(applicable)
    if whole:
        names = called(saved, labelled(saved.peaks, saved.info, saved.directory), bounds=True)
        show((summed_up if many else table)(verdicts, names) + "\n")
    show(answered(verdicts, saved))
    count = wording.count_of(verdicts)
    say(", ".join(f"{n} {_COUNTED.get(kind, kind)}" for kind, n in count.items() if n))
    say(f"{path}{': all of them' if whole and many else ''}")
    if idle:
        say("no check applies to these cases")
    decided = count["pass"] and not (count["fail"] or count["not decided"] or idle)
    return 0 if decided and not saved.info["unusable"] else 1


def answered(verdicts: Sequence[Verdict], saved: Saved) -> str:
    """Return the scorecard, or without verdicts on cases the greatest responses, and the sentences at the top of the report."""
    results, varied = labelled(saved.peaks, saved.info, saved.directory), saved.info["varied"]
    suites = runs_of_cases(results.runs, saved.info["cases"], len(saved.info["records"]))
    checked = any(verdict.case for verdict in verdicts)
    case_of, record_of = called(saved, results)
    cases = saved.info["cases"]
    worst, at_scales = (worst_of_cases(results.runs, cases, at_each_scale=each) for each in (False, True))
    if checked:
        table = scorecard.of_checks(verdicts, case_of, suites, at_scales, record_of)
    else:
        table = scorecard.of_responses(
            worst, results.runs, cases, lambda case: results.named_runs(case["case"], case["columns"], varied)
        )
    lines = [table, ""] if table else []
    lines += [filled(words) for words in (weak_supports(cases), pulled_supports(cases)) if words]
    stations = stations_of(saved.info)
    for line in answer(verdicts, at_scales, case_of, record_of, suites, stations):
        words = " ".join((f"{line.text}: {line.cases}." if line.cases else f"{line.text}.", *line.details))
        lines.append(_coloured(filled(f"{sign(line.verdict)} {_plain(words)}"), line.verdict))
    ended, planned = (sum(counts) for counts in zip(*((sum(s.ended.values()), s.runs) for s in suites), strict=True))
    if not checked:
        lines.append("No limits were set, so nothing was checked. Add some: rockbatch check DIR --rules FILE.")
        if ended:
            lines.append(f"Largest values over {planned - ended} of {planned} runs, those that end standing.")
    lines += [filled(words) for words in (wording.both_axes(verdicts), *bounds_in_words(saved.info)) if words]
    if undamped := undamped_settlement(worst):
        lines.append(filled(undamped))
    return "\n".join(lines)


def called(saved: Saved, results: Labelled, *, bounds: bool = False) -> Called:
    """Return the functions that name cases and records of ``saved``, which ``results`` label.

    Cases are named without the bounds under which they ran, unless ``bounds``.
    """
    labels, varied = record_labels(saved.info), saved.info["varied"]
    named = results.named_runs if bounds else results.named_design

    def case_of(row: Verdict | CaseRuns) -> str:
        return named(row.case, row.columns, varied, row.scale)

    return Called(case_of, lambda verdict: labels.get(verdict.record, verdict.record))


def table(verdicts: Sequence[Verdict], names: Called) -> str:
    """Return a block of lines for each case and scale, then each check's requirement."""
    notes = Notes(verdicts)
    return "\n\n".join([*_blocks(verdicts, notes, names), _checks(verdicts, notes)])


def summed_up(verdicts: Sequence[Verdict], names: Called) -> str:
    """Return each check's counts of verdicts, the :data:`WORST` verdicts, and each check's requirement."""
    rows = [(name, *map(str, count.values())) for name, count in wording.count_by_check(verdicts).items()]
    parts = ["\n".join([f"{len(verdicts)} verdicts", *aligned([("check", *wording.WAYS), *rows])])]
    notes = Notes(verdicts)
    if worst := wording.worst_first(verdicts)[:WORST]:
        parts += ["The worst", *_blocks(worst, notes, names)]
    return "\n\n".join([*parts, _checks(verdicts, notes)])


def _blocks(verdicts: Sequence[Verdict], notes: Notes, names: Called) -> list[str]:
    """Return a block of lines, numbers and remarks, for consecutive verdicts of one case and scale."""
    head, *lines = _numbers(verdicts)
    blocks = []
    of_verdicts = zip(verdicts, lines, strict=True)
    by_case = groupby(of_verdicts, key=lambda pair: (pair[0].case, pair[0].columns, pair[0].scale))
    for (case, _, _), block in by_case:
        of_case = list(block)
        parts = [names.case_of(of_case[0][0]) if case else wording.SUITE, head]
        for verdict, line in of_case:
            parts.append(_coloured(line, verdict.verdict))
            remarks = (wording.governing(verdict, names.record_of(verdict)), verdict.counted, notes.about(verdict))
            if verdict.verdict != DOES_NOT_APPLY and any(remarks):
                parts.append(filled("; ".join(filter(None, remarks)), 6, 6))
        blocks.append("\n".join(parts))
    return blocks


def _numbers(verdicts: Sequence[Verdict]) -> list[str]:
    """Return the head and a line for each verdict; in a narrow terminal without margin, then ratio, then records."""
    head = ("check", wording.records_of(verdicts), "demand", "limit", "ratio", "margin", "unit", "verdict")
    lines, places, edge = [head, *map(_cells, verdicts)], list(range(len(head))), width() or math.inf
    for place in (None, *_LEFT_OUT):
        places = [column for column in places if column != place]
        flush_left = [places.index(column) for column in (0, 6, 7)]
        text = [f"  {line}".rstrip() for line in aligned([[line[i] for i in places] for line in lines], flush_left)]
        if max(map(len, text)) <= edge:
            break
    return text


def _cells(verdict: Verdict) -> tuple[str, ...]:
    """Return the cells of a verdict under the heads of :func:`_numbers`."""
    return (
        wording.name_of(verdict),
        str(verdict.records) if verdict.records else "",
        _plain(wording.demanded(verdict)),
        _plain(wording.limit(verdict, ("<=", ">="))),
        _plain(wording.ratio(verdict)),
        _plain(wording.margin(verdict)),
        verdict.unit,
        mark(verdict.verdict),
    )


def _plain(text: str) -> str:
    """Return text with "inf", ">=", "<=" and plain spaces for "∞", "≥", "≤" and no-break spaces, which many terminals lack."""
    for sign, instead in {"\u00a0": " ", "∞": "inf", "≥": ">=", "≤": "<="}.items():
        text = text.replace(sign, instead)
    return text


def _checks(verdicts: Sequence[Verdict], notes: Notes) -> str:
    """Return each check's requirement and reason, the unit of counting, and the basis of the codes' statistics."""
    first = {wording.name_of(verdict): verdict for verdict in reversed(verdicts)}
    rests = {verdict.statistic: verdict for verdict in reversed(verdicts) if wording.unchecked(verdict)}
    lines = []
    for name, asked in wording.requirements(verdicts).items():
        lines.append(f"{name}: {'; '.join(asked)} [{first[name].basis}] {first[name].reason}".rstrip())
    lines += [*notes.common(), *wording.counting(verdicts)]
    lines += [f"{name}: {wording.unchecked(verdict)}." for name, verdict in rests.items()]
    return "\n".join(["Checks", *(filled(line, 2, 6) for line in lines)])


def _coloured(text: str, verdict: str) -> str:
    return coloured(text, _COLOURS.get(verdict))
