"""The journal: whatever ends its process and however, the rows that it had are there, each once and whole."""

import os
import tracemalloc

import numpy as np
import pytest

from rockbatch.batch.journal import Journal
from rockbatch.common.errors import InputError
from rockbatch.common.files import UNFINISHED, only_writer

COLUMNS = ("record", "theta", "reason")
DIGEST = {"cases": "5f1c", "motions": "09ab"}
ROWS = {
    0: {"record": "a", "theta": 0.1 + 0.2, "reason": ""},
    1: {"record": 'Düzce, "⟂" 地震', "theta": float("nan"), "reason": None},
    2: {"record": "two\nlines\r\n", "theta": 1.0, "reason": "7,b,\n"},
    3: {"record": "not Unicode \udcff", "theta": -1e-300, "reason": "\0"},
    11: {"record": "", "theta": 3, "reason": "'"},
}
TABLE = (
    b"record,theta,reason\n"
    b"a,0.3,\n"
    b'"D\xc3\xbczce, ""\xe2\x9f\x82"" \xe5\x9c\xb0\xe9\x9c\x87",,\n'
    b'"two\nlines\r\n",1,"7,b,\n"\n'
    b"not Unicode \\xff,-1e-300,\\x00\n"
    b",3,'\n"
)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "results" / "peaks.csv.part"


def interrupted(path, rows, **options):
    """A journal that is left by an exception when it has these rows."""
    with pytest.raises(KeyboardInterrupt), Journal(path, COLUMNS, DIGEST, **options) as journal:  # noqa: PT012
        journal.add_all(rows)
        raise KeyboardInterrupt


def ended(path):
    """Whatever is missing is added, and the table is written: its bytes, and the numbers that had been there."""
    with Journal(path, COLUMNS, DIGEST) as journal:
        there = list(journal)
        journal.add_all({number: row for number, row in ROWS.items() if number not in journal})
        journal.write_in_order(path.with_name("peaks.csv"))
    return path.with_name("peaks.csv").read_bytes(), there


def test_a_journal_that_stays_has_the_same_bytes_however_its_runs_finish(path):
    """Those asked for come first, in their order and as often as asked, then all others; numbers begin at 0."""
    texts = set()
    for seed in range(10):
        numbers, asked = np.random.default_rng(seed).permutation(list(ROWS)).tolist(), [11, 2, 0, 2]
        known = dict(zip((11, 2, 0, 1, 3), range(5), strict=True) if seed % 2 else zip(ROWS, ROWS, strict=True))
        with Journal(path, COLUMNS, DIGEST, stays=True) as journal:
            for number in numbers:  # the numbers are in order already in every second one, the lines are not
                journal.add_all({known[number]: ROWS[number]})
            journal.renumber([known[number] for number in asked])
            records = [ROWS[number]["record"].replace("\udcff", "\\xff") for number in (11, 2, 0, 1, 3)]
            assert [(number, row["record"]) for number, row in journal.rows()] == list(enumerate(records))
        texts.add(path.read_bytes())
        inode = path.stat().st_ino
        with Journal(path, COLUMNS, DIGEST, stays=True) as journal:
            journal.renumber(range(len(ROWS)))
            assert [row["record"] for _, row in journal.rows()] == records
        assert path.stat().st_ino == inode  # in order already: not written anew
        path.unlink()
    assert len(texts) == 1


def test_the_table_is_in_the_order_of_the_numbers_however_the_runs_finish(path):
    for seed in range(5):
        numbers = np.random.default_rng(seed).permutation(list(ROWS)).tolist()
        with Journal(path, COLUMNS, DIGEST) as journal:
            for number in numbers:
                journal.add_all({number: ROWS[number]})
            journal.write_in_order(path.with_name("peaks.csv"), [{"reason": "of no run"}])
            assert path.exists()  # until all that belongs to the table is there too
        assert [file.name for file in path.parent.iterdir()] == ["peaks.csv"]
        assert path.with_name("peaks.csv").read_bytes() == TABLE + b",,of no run\n"


def test_wherever_the_file_is_cut_the_table_ends_with_the_same_bytes(path):
    interrupted(path, ROWS)
    whole = path.read_bytes()
    _, *ends = (
        at + 1 for at, byte in enumerate(whole) if byte == ord("\n")
    )  # a row is a line, whatever its cells hold
    assert len(ends) == len(ROWS)
    kept = {}
    for length in sorted({*range(0, len(whole), 4), *(end - 1 for end in ends), *ends}):
        path.write_bytes(whole[:length])
        table, there = ended(path)
        assert table == TABLE
        assert there == list(ROWS)[: len(there)]
        kept[length] = len(there)
    assert [*kept.values()] == sorted(kept.values())
    assert kept[len(whole)] == len(ROWS)
    assert kept[ends[0] - 1] == 0
    assert kept[ends[0]] == 1  # a row counts once its last byte is there


@pytest.mark.parametrize(
    "torn", [b"\0" * 100, b"\0\0\n4,x,1,\n", b"4,x,1\n", b"\xff\xff,\n5,x,1,\n", b'4,"x,1,\n', b"\n"]
)
def test_what_a_power_cut_leaves_behind_the_last_row_is_dropped_for_good(path, torn):
    interrupted(path, {0: ROWS[0]})
    before = path.read_bytes()
    path.write_bytes(before + torn)
    told = []
    with pytest.raises(KeyboardInterrupt), Journal(path, COLUMNS, DIGEST, tell=told.append) as journal:
        raise KeyboardInterrupt
    assert list(journal) == [0]
    assert path.read_bytes() == before
    assert len(told) == (b"\n" in torn)  # a last line without its end is what every kill may leave


# Damage


def reopened(path, runs=12):
    """What is found there, and what is told of it."""
    told = []
    with pytest.raises(KeyboardInterrupt), Journal(path, COLUMNS, DIGEST, runs=runs, tell=told.append) as journal:  # noqa: PT012
        found = {number: journal[number] for number in journal}
        raise KeyboardInterrupt
    return found, told


def test_a_flipped_bit_costs_the_rows_of_its_line_alone_and_is_reported_once(path):
    """Never a wrong row, wherever it is; and not the rows behind it, nor all of them where the first line is hit."""
    interrupted(path, ROWS)
    whole = path.read_bytes()
    right, _ = reopened(path)
    assert list(right) == list(ROWS)
    lines = whole.count(b"\n")
    ends_of_lines = {8 * at + at % 8 for at, byte in enumerate(whole) if byte == ord("\n")}
    for bit in sorted({*range(0, 8 * len(whole), 31), *ends_of_lines}):  # each place of a byte in turn
        damaged = bytearray(whole)
        damaged[bit // 8] ^= 1 << bit % 8
        path.write_bytes(damaged)
        found, told = reopened(path)
        assert found == {number: right[number] for number in found}
        line = whole.count(b"\n", 0, bit // 8)
        joined = whole[bit // 8] == ord("\n")  # with the next line, or torn off as the last one
        assert len(right) - len(found) == (line > 0) + (joined and line + 1 < lines)
        assert len(told) == (not (joined and line + 1 == lines))
        assert reopened(path) == (found, [])


def test_damaged_rows_alone_are_reported_dropped_and_run_again(path):
    interrupted(path, ROWS)
    lines = path.read_bytes().splitlines(keepends=True)
    lines[2] = lines[2].replace(b"zce", b"zca")
    path.write_bytes(b"".join(lines))
    found, told = reopened(path)
    assert list(found) == [0, 2, 3, 11]
    assert told == [f"{path}: 1 line is damaged; the 4 undamaged runs are kept, the others are carried out again"]
    assert ended(path) == (TABLE, [0, 2, 3, 11])


def test_a_row_of_a_run_that_the_plan_does_not_have_is_none(path):
    """It would be one more in the table, and a number of 900 million asks for memory to remember it by."""
    interrupted(path, ROWS)
    found, told = reopened(path, runs=11)
    assert list(found) == [0, 1, 2, 3]
    assert "1 line is damaged" in told[0]


def test_rows_of_an_unknown_study_are_refused_as_those_of_another(path):
    """A first line that is gone, with rows that do not belong to this study; and a journal without checksums."""
    interrupted(path, ROWS)
    lines = path.read_bytes().splitlines(keepends=True)
    for there in ([b"x" + lines[0], *lines[1:]], [b"cases:5f1c motions:09ab,record,theta,reason\n", b"0,a,0.3,\n"]):
        path.write_bytes(b"".join(there))
        with pytest.raises(InputError, match=r"first line is damaged, or of another version, and none of its \d rows"):
            Journal(path, COLUMNS, DIGEST | {"cases": "0000"}).__enter__()
        assert path.read_bytes() == b"".join(there)
    with Journal(path, COLUMNS, DIGEST, fresh=True) as journal:
        assert len(journal) == 0


def test_a_line_without_end_is_not_held_in_memory(path):
    interrupted(path, ROWS)
    with path.open("ab") as file:
        file.write(b"1" * 20_000_000 + b"\n")
    tracemalloc.start()
    try:
        found, told = reopened(path)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert list(found) == list(ROWS)
    assert "1 line is damaged" in told[0]
    assert peak < 5_000_000


# Files that lead elsewhere


@pytest.mark.parametrize("kind", ["link", "pipe", "folder", "second name"])
def test_a_journal_that_is_no_plain_file_is_refused_and_its_target_stays(path, tmp_path, kind):
    path.parent.mkdir()
    notes = tmp_path / "notes.txt"
    notes.write_text("precious\n")
    {"link": lambda: path.symlink_to(notes), "pipe": lambda: os.mkfifo(path), "folder": path.mkdir,
     "second name": lambda: os.link(notes, path)}[kind]()  # fmt: skip
    for fresh in (False, True) if kind == "folder" else (False,):
        with pytest.raises((InputError, OSError)):
            Journal(path, COLUMNS, DIGEST, fresh).__enter__()
    with Journal(tmp_path / "new" / "peaks.csv.part", COLUMNS, DIGEST) as journal, pytest.raises((InputError, OSError)):
        journal.add_from(path) if kind != "second name" else Journal(path, COLUMNS, DIGEST).__enter__()
    assert notes.read_text() == "precious\n"


def test_finished_rows_are_read_back_as_the_texts_of_the_table(path):
    with Journal(path, COLUMNS, DIGEST) as journal:
        journal.add_all(ROWS)
        assert len(journal) == 5
        assert 11 in journal
        assert 10 not in journal
        assert 12 not in journal
        assert journal[1] == {"record": 'Düzce, "⟂" 地震', "theta": "", "reason": ""}
        assert journal[2]["record"] == "two\nlines\r\n"
        assert dict(journal.rows()) == {number: journal[number] for number in ROWS}
        with pytest.raises(KeyError):
            journal[10]


def test_other_runs_are_not_mixed_in_and_the_change_is_named(path):
    interrupted(path, ROWS)
    before = path.read_bytes()
    changed = Journal(path, COLUMNS, DIGEST | {"motions": "ffff"})
    with pytest.raises(
        InputError, match=r"5 finished runs, but .* changed since \(motions\); .* start over with --fresh"
    ):
        changed.__enter__()
    with pytest.raises(InputError, match=r"changed since \(columns\)"):
        Journal(path, COLUMNS[:2], DIGEST).__enter__()
    assert path.read_bytes() == before
    with Journal(path, COLUMNS, {"cases": "0"}, fresh=True) as journal:
        assert len(journal) == 0


def test_a_journal_without_a_finished_run_holds_nobody_up_and_goes(path):
    interrupted(path, {})
    assert not path.exists()
    path.write_bytes(b"cases:0000,record,theta,reason\n")
    with Journal(path, COLUMNS, DIGEST) as journal:
        assert len(journal) == 0
    assert not path.exists()


def test_only_one_writes_into_a_folder_at_a_time(path):
    with Journal(path, COLUMNS, DIGEST):
        with pytest.raises(InputError, match=f"{path.parent}: another process is writing"):
            Journal(path.with_name("fragility.csv.part"), COLUMNS, DIGEST).__enter__()
        with only_writer(path.parent.parent):
            pass
    with only_writer(path.parent):
        pass
    assert list(path.parent.iterdir()) == []


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no processes are forked here")
def test_a_forked_process_that_leaves_takes_neither_lock_nor_journal_along(path):
    with Journal(path, COLUMNS, DIGEST) as journal:
        assert path.exists()  # and has no rows: its own process would remove it
        child = os.fork()
        if not child:  # which leaves the context on its own, as an exception or sys.exit does
            try:
                journal.__exit__(SystemExit, SystemExit(), None)
            finally:
                os._exit(0)
        os.waitpid(child, 0)
        assert path.exists()
        with pytest.raises(InputError, match="another process is writing"):
            Journal(path, COLUMNS, DIGEST).__enter__()
        journal.add_all(ROWS)
    assert ended(path)[0] == TABLE


def test_what_a_killed_process_had_not_finished_writing_is_swept_up(path):
    path.parent.mkdir()
    (path.parent / f".peaks.csv-abc{UNFINISHED}").touch()
    with Journal(path, COLUMNS, DIGEST) as journal:
        assert [file.name for file in path.parent.iterdir()] != []
        assert not list(path.parent.glob(f".*{UNFINISHED}"))
        assert len(journal) == 0


def test_an_error_while_writing_leaves_the_journal_and_the_earlier_table(path):
    interrupted(path, ROWS)
    path.with_name("peaks.csv").write_text("earlier")

    def broken():
        yield {"reason": "of no run"}
        raise OSError("broken")

    with pytest.raises(OSError, match="broken"), Journal(path, COLUMNS, DIGEST) as journal:
        journal.write_in_order(path.with_name("peaks.csv"), broken())
    assert path.with_name("peaks.csv").read_text() == "earlier"
    assert sorted(file.name for file in path.parent.iterdir()) == ["peaks.csv", "peaks.csv.part"]
    assert ended(path) == (TABLE, list(ROWS))


# Shares of several machines


def test_shares_are_joined_to_the_bytes_of_one_run(path, tmp_path):
    numbers = list(ROWS)
    parts = [tmp_path / name / "peaks.csv.part" for name in ("1", "2", "3")]
    for part, share in zip(parts, (numbers[:2], numbers[1:4], numbers[3:]), strict=True):  # some in two of them
        interrupted(part, {number: ROWS[number] for number in share})
    with Journal(path, COLUMNS, DIGEST) as journal:
        for part in parts[::-1]:
            journal.add_from(part)
        journal.write_in_order(path.with_name("peaks.csv"))
    assert path.with_name("peaks.csv").read_bytes() == TABLE
    assert all(part.exists() for part in parts)


def test_a_share_of_another_study_or_with_another_row_for_the_same_run_is_refused(path, tmp_path):
    other = tmp_path / "other" / "peaks.csv.part"
    interrupted(other, {0: ROWS[1]})
    with Journal(path, COLUMNS, DIGEST) as journal:
        journal.add_all({0: ROWS[0]})
        with pytest.raises(InputError, match="run 0 differs from the same run"):
            journal.add_from(other)
    with (
        Journal(path, COLUMNS, {"cases": "other"}, fresh=True) as journal,
        pytest.raises(InputError, match=r"changed since \(cases\)"),
    ):
        journal.add_from(other)


# What it costs


def test_memory_holds_where_the_rows_are_and_not_the_rows(path):
    """16 bytes a run, in arrays that grow by an eighth at a time, beside a group; all rows of this one are 2.4 MB."""
    many, group = 4_000, 100
    row = {"record": "x" * 600, "theta": 0.5, "reason": ""}
    tracemalloc.start()
    try:
        with Journal(path, COLUMNS, DIGEST) as journal:
            for first in range(0, many, group):
                journal.add_all(dict.fromkeys(range(first, first + group), row))
            journal.write_in_order(path.with_name("peaks.csv"))
            _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 2 * 16 * many + 4 * 600 * group


def test_cells_beside_a_row_outlast_the_process_and_are_not_in_the_table(path):
    beside = {"beside": ("first", "second")}
    kept = {0: ROWS[0] | {"first": "eJw="}, 1: ROWS[1] | {"second": "a/+"}}
    interrupted(path, kept, **beside)
    with Journal(path, COLUMNS, DIGEST, **beside) as journal:
        assert journal.cells_beside(0) == {"first": "eJw=", "second": ""}
        assert journal.cells_beside(1) == {"first": "", "second": "a/+"}
        assert journal.cells_beside(7) == {}
        journal.add_all({number: row for number, row in ROWS.items() if number > 1})
        journal.write_in_order(path.with_name("peaks.csv"), [{"reason": "of no run"}])
        assert journal.cells_beside(1) == {"first": "", "second": "a/+"}
    assert path.with_name("peaks.csv").read_bytes() == TABLE + b",,of no run\n"
