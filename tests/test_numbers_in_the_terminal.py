"""Lines that commands print, read back: each count, time, size and name in them is that of what they speak of."""

import argparse
import pickle
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from messages import assert_states

import rockbatch as rb
from rockbatch.commands import cache, motions, run, scorecard, summary
from rockbatch.common.errors import NoUnit, UnusableRecord
from rockbatch.motions import MotionSet
from rockbatch.motions.sources.source import Source
from rockbatch.motions.unused import LeftOut, Unusable
from rockbatch.outcome.outcome import Failure
from rockbatch.simulation import kept
from rockbatch.terminal import messages as terminal
from rockbatch.workflow.running import _ranges

A = np.sin(0.1 * np.arange(400))


@pytest.mark.parametrize(
    ("seconds", "expected"),
    [(0.7, [1.0, "s"]), (41.2, [41.0, "s"]), (720.0, [12.0, "min"]), (5399.0, [90.0, "min"]), (12600.0, [3.5, "h"])],
)
def test_a_time_is_printed_in_its_unit(seconds, expected):
    assert_states(run.in_words(seconds), *expected)


def test_numbers_of_rows_are_printed_as_ranges_from_1():
    assert _ranges([0, 1, 2, 11, 16, 17]) == "1 to 3, 12, 17 to 18"
    assert _ranges([0, 2, 4, 6, 8, 10]) == "1, 3, 5, 7, 9, …"


def test_the_cache_names_its_kernels_sizes_and_days(monkeypatch, capsys):
    moments = [time.mktime(time.strptime(day, "%Y-%m-%d")) for day in ("2025-02-03", "2025-04-17")]
    files = [SimpleNamespace(size=size, used=used) for size, used in zip((1.2e6, 3.1e6), moments, strict=True)]
    monkeypatch.setattr(kept, "folder", lambda: Path("/kernels"))
    monkeypatch.setattr(kept, "files", lambda: files)
    monkeypatch.setattr(kept, "clear", lambda: files[:1])
    monkeypatch.setattr(kept, "MOST_BYTES", 750e6)
    assert cache.main(argparse.Namespace(clear=False)) == 0
    size, days = capsys.readouterr().out.splitlines()
    assert_states(size, "/kernels", 2.0, "kernels", 4.3, "MB", 750.0, "MB")
    assert days.startswith("last used between 2025-02-03 and 2025-04-17; ")
    assert_states(days.partition("; ")[2], kept.UNUSED_DAYS)
    assert cache.main(argparse.Namespace(clear=True)) == 0
    assert_states(capsys.readouterr().out, "/kernels", "removed", 1.0, "kernel", 1.2, "MB")


def test_runs_that_failed_later_are_counted_and_those_that_ratchet_among_them():
    rows = {
        "status": ["failed"] * 4 + ["ok"],
        "failure": [Failure.RATCHETS, "", Failure.RATCHETS, "", ""],
        summary.IN_MOTION_ERROR: [1e-5, 1e-5, 1e-5, np.nan, np.nan],
    }
    said = summary.failed_later(pd.DataFrame(rows))
    assert_states(said, 3.0, summary.IN_MOTION, "in 2 the springs", 0.2)


def test_the_worst_runs_are_counted_by_status_and_named():
    runs = pd.DataFrame({"status": ["ok"] * 12 + ["overturned"] * 3, "record": [f"r{i}" for i in range(15)]})
    for name in summary._PEAK:
        runs[name] = 0.01 * np.arange(15.0)
    names = {f"r{i}": f"record {chr(97 + i)}" for i in range(15)}
    said = summary._worst(runs, names, lambda row: f"case of {row['record']}")
    assert_states(said.splitlines()[0], 15.0, 12.0, "ok", 3.0, "overturned")
    assert [line.split()[1] for line in said.splitlines()[3:]] == [chr(97 + i) for i in range(14, 4, -1)]


def suite_of(files=("a", "b", "c"), unusable=2, left_out=1):
    """Return a set of motions of two stations, with files that are not used and left out."""
    shaken = [rb.Motion(name, 0.01, (n + 1.0) * A, source=f"{name}.AT2") for n, name in enumerate(files)]
    wrong = [Unusable(f"x{n}", (f"x{n}.AT2",), "empty") for n in range(unusable)]
    return MotionSet(
        tuple(shaken), tuple(wrong), tuple(LeftOut(f"y{n}", (f"y{n}.AT2",), "a copy") for n in range(left_out))
    )


def test_a_folder_of_records_is_counted_by_files_recordings_and_stations():
    suite = suite_of()
    assert_states(
        motions.counts(suite),
        6.0,
        "files",
        3.0,
        "usable recordings",
        float(len(suite.stations())),
        "stations",
        2.0,
        "not used",
        1.0,
    )


@pytest.mark.parametrize(
    ("sources", "files"),
    [
        (("x.V1 (1)", "x.V1 (2)"), "2 files"),
        ((Source("x.V1", "NS"), Source("x.V1", "Up (a)")), "1 file"),
        ((Source("x (1)", "NS"), "x (2)"), "2 files"),
    ],
)
def test_a_file_is_counted_once_with_all_its_parts_and_by_its_whole_name(sources, files):
    wrong = pickle.loads(pickle.dumps([Unusable(source, (source,), "empty") for source in sources]))
    assert motions.counts(MotionSet((), wrong)).startswith(f"{files}: ")


def test_faults_are_listed_by_reason_the_rarest_first_and_the_rest_counted():
    faults = (
        [("unit", "a", "no unit")] * 3
        + [("cut", "b", "line 3: cut")] * 2
        + [("empty", "c", "empty")]
        + [("spectra", "d", "spectra")] * 4
        + [("clock", "e", "clock")] * 5
    )
    lines = motions._by_cause("Not used", faults, 3)
    assert lines[:2] == ["", "Not used"]
    assert_states(lines[2], 1.0, "empty", "c")
    assert lines[3].startswith("  2 ×: line 3: cut (such as b")
    assert_states(lines[4], 3.0, "no unit", "such as a")
    assert_states(lines[5], 9.0, 2.0, "other reasons")


def test_the_records_that_govern_a_check_are_counted_over_its_cases():
    cells = [
        SimpleNamespace(verdict=SimpleNamespace(record=name, is_ban=True)) for name in ("a", "b", "a", "", "a")
    ] + [None]
    (line,) = scorecard._governing([("drift", cells)], lambda verdict: f"record {verdict.record}")
    assert_states(line, "governs drift", "record a", 3.0, 4.0, "record b", 1.0, 4.0)


def test_a_long_table_of_cases_says_how_many_of_them_it_has():
    rows = [[f"case {chr(97 + i % 26)}{i // 26}"] for i in range(scorecard.MOST_CASES + 3)]
    head, *shown, last = scorecard._table([["drift"]], [[*row, "1"] for row in rows]).splitlines()
    assert head.split() == ["drift"]
    names = [line.split()[1] for line in shown if line.startswith("case")]
    assert names == [row[0].split()[1] for row in rows[: scorecard.OPEN_CASES]]
    assert_states(last, scorecard.OPEN_CASES, scorecard.MOST_CASES + 3)


def test_progress_in_lines_states_what_is_done_and_the_time_left(monkeypatch):
    moments, told = iter([0.0, 1.0, 6.0]), []
    monkeypatch.setattr(terminal.time, "monotonic", lambda: next(moments))
    monkeypatch.setattr(terminal, "tell", lambda stream, text: told.append(text))
    advance = terminal._lines(40, None)
    advance(3)
    advance(7)
    (line,) = told
    assert_states(line, 10.0, 40.0, "runs", 18.0, "s left")


def test_files_that_are_not_used_for_one_reason_have_one_line(monkeypatch):
    told = []
    monkeypatch.setattr(terminal, "say", told.append)
    reasons = [f'column 2 has no unit; write unit = "g" (PGA {peak} g)' for peak in (2.5, 4.7, 1.8)]
    unusable = tuple(
        Unusable(f"{place}", (f"{place}.acc",), reason, kind=UnusableRecord if reason == "empty" else NoUnit)
        for place, reason in enumerate([reasons[0], "empty", *reasons[1:]])
    )
    terminal.Terminal().motions(MotionSet((), unusable, ()))
    assert told == [f"not used: 0.acc and 2 others: {reasons[0]}", "not used: 1.acc: empty"]


def test_files_that_are_not_used_repeated_and_left_out_are_named(monkeypatch):
    told = []
    monkeypatch.setattr(terminal, "say", told.append)
    suite = suite_of(unusable=1, left_out=3)
    again = rb.Motion("again", 0.01, 2.0 * A, source="again.AT2")
    terminal.Terminal().motions(MotionSet((*suite.motions, again), suite.unusable, suite.left_out))
    assert told[0] == "not used: x0.AT2: empty"
    assert_states(told[1], "b and again")
    assert_states(told[-1], 3.0, "files")
