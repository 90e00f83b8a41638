"""Journal of finished rows: on disk as soon as they are finished, until the table is written in order."""

import csv
import hashlib
import io
import os
import re
import zlib
from array import array
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Self

from rockbatch.batch.plan import MOST_RUNS
from rockbatch.common.errors import InputError
from rockbatch.common.files import (
    csv_line,
    csv_lines,
    csv_plain,
    made_folder,
    naming_full_disk,
    only_writer,
    opened,
    remove,
    replacing,
)

ABSENT = -1
ROWS_AT_ONCE = 1000

BUFFER = 1 << 16
"""Bytes read at a time when the table is written."""

MOST_OF_A_LINE = 1 << 20
"""Most bytes of a line; longer ones are damaged, and are not held in memory."""


class Written(NamedTuple):
    """A written table: its number of rows, including those of no run, and the digest of its file."""

    rows: int
    sha256: str


class _Rows:
    """Index of the rows in an open journal: the position of each, by the number of its run.

    ``path`` names the file in messages; ``remedy`` ends the message about rows of another digest; those of the digest
    ``outdated`` are forgotten without it. See :class:`Journal`.
    """

    def __init__(
        self,
        path: Path,
        columns: Sequence[str],
        digest: Mapping[str, str],
        runs: int = MOST_RUNS,
        remedy: str = "",
        outdated: Mapping[str, str] | None = None,
    ) -> None:
        self.path, self.columns, self.digest, self.runs, self.remedy = path, list(columns), dict(digest), runs, remedy
        self.outdated = outdated
        digests = " ".join(f"{name}:{value}" for name, value in digest.items())
        self.first = _encoded(csv_line([digests, *self.columns]))[:-1]
        self.seed = zlib.crc32(self.first)
        self.is_outdated = False  # whether the file has rows of ``outdated``, which stay until there are others
        self.file: io.FileIO
        self.forget()

    def forget(self) -> None:
        """Forget all rows."""
        self.starts, self.sizes = array("q"), array("q")  # of each row [bytes], by number
        self.count = 0
        self.head = 0  # bytes of the first line
        self.end = 0

    def __contains__(self, number: object) -> bool:
        return isinstance(number, int) and 0 <= number < len(self.starts) and self.starts[number] != ABSENT

    def __iter__(self) -> Iterator[int]:
        return (number for number, start in enumerate(self.starts) if start != ABSENT)

    def row(self, number: int) -> bytes:
        """Return the row of a finished run as a line of the table, without its number; cells of ``beside`` are at its end."""
        self.file.seek(self.starts[number])
        return _unfolded(self.file.read(self.sizes[number]))

    def remember(self, number: int, start: int, size: int) -> None:
        """Record the position and size of the row of a run."""
        missing = number + 1 - len(self.starts)
        self.starts.extend([ABSENT] * missing)
        self.sizes.extend([0] * missing)
        self.count += self.starts[number] == ABSENT
        self.starts[number], self.sizes[number] = start, size

    def recover(self) -> int:
        """Index the rows of an earlier process; return the number of damaged lines.

        Raises ``InputError`` for rows of another study, or if it is unknown whose they are.
        """
        self.forget()
        lines = _whole_lines(self.file)
        self.head, line = next(lines, (0, b""))
        first = _unsealed(line)
        if first not in (None, self.first):
            self._refuse_rows_of(first, lines)
            return 0
        damaged, rows, self.end = int(self.head > 0 and first is None), 0, self.head
        for self.end, line in lines:
            rows += 1
            number = self._number(_unsealed(line, self.seed))
            if number is None:
                damaged += 1
            else:
                size = _size_of_cells(line)
                self.remember(number, self.end - size, size)
        if rows and first is None and not self.count:
            raise InputError(
                f"{self.path}: its first line is damaged, or of another version, and none of its {rows} rows belong to the "
                "present study; choose another folder with --out, or start over with --fresh"
            )
        if not self.count:
            self.forget()
        return damaged

    def _number(self, body: bytes | None) -> int | None:
        """Return the number of the run of a row; None if ``body`` is not a row of this table, or of no run that it can have."""
        match = _NUMBER.match(body or b"")
        if body is None or not match or int(match[1]) >= self.runs:
            return None
        try:
            (cells,) = csv.reader([body.decode()], strict=True)
        except (csv.Error, UnicodeDecodeError, ValueError):
            return None
        return int(match[1]) if len(cells) == len(self.columns) + 1 else None

    def _refuse_rows_of(self, first: bytes, lines: Iterator[tuple[int, bytes]]) -> None:
        """Raise ``InputError`` with the changes since a journal with another first line; forget it if it has no rows to lose."""
        seed = zlib.crc32(first)
        rows = sum(_unsealed(line, seed) is not None for _, line in lines)
        self.forget()
        head = first.decode(errors="replace").partition(",")[0]
        digests = dict(part.partition(":")[::2] for part in head.split())
        self.is_outdated = rows > 0 and digests == self.outdated
        if not rows or self.is_outdated:
            return
        changed = [name for name, digest in self.digest.items() if digests.get(name) != digest] or ["columns"]
        raise InputError(
            f"{self.path}: holds {rows} finished runs, but something has changed since ({', '.join(changed)}); "
            f"{self.remedy}"
        )


class Journal:
    """Rows of an unfinished table, in a file beside it, each saved once its run is finished.

    The file survives the end of the process. Its first line has the digests and the columns; then follows a line for each
    finished run, in the order of finishing: its number, and its cells as in the table. Each line begins with a checksum
    (CRC-32), which for rows also covers the first line, so that a row counts for its own study only. An incomplete last
    line is dropped when a later process continues; other damaged lines are reported and dropped one by one, and their runs
    are carried out again. Memory holds only the position of each row.

    Use it as a context; meanwhile no other process can write into its folder. At the end of the context the file is removed
    if the table was written or no run is finished; one that ``stays`` only if no run is.

    Parameters
    ----------
    path : Path
        The file, such as ``peaks.csv.part``; its folder is made.
    columns : sequence of str
        Columns of the table.
    beside : sequence of str
        Names of further cells kept with each row but not written to the table: texts without commas.
    digest : mapping of str to str
        Digests of everything that the rows depend on, by plural nouns: ``{"cases": "5f1c…", "motions": "09ab…"}``.
    fresh : bool
        Whether to drop the rows of an earlier process.
    runs : int
        Number of runs, if known: rows with higher numbers are invalid.
    tell : function, optional
        Called with a sentence about damaged lines.
    stays : bool
        Whether the file outlives its table, with its rows for a later command that asks for others, too.
    outdated : mapping of str to str, optional
        Digest of a table that was finished, whose rows the first new one replaces: no error is raised for them.

    Raises
    ------
    InputError
        On entry, if the file has runs of another digest or is not a regular file, or if another process is writing into the
        folder; while writing, if the disk is full.
    """

    def __init__(
        self,
        path: Path,
        columns: Sequence[str],
        digest: Mapping[str, str],
        fresh: bool = False,
        *,
        runs: int = MOST_RUNS,
        tell: Callable[[str], object] | None = None,
        beside: Sequence[str] = (),
        stays: bool = False,
        outdated: Mapping[str, str] | None = None,
    ) -> None:
        self.path, self._stays = path, stays
        self.columns, self.beside = [*columns, *beside], list(beside)
        self._fresh = fresh
        self._tell = tell or (lambda _: None)
        remedy = "undo that to continue, choose another folder with --out, or start over with --fresh"
        self._rows = _Rows(path, self.columns, digest, runs, remedy, outdated)
        self._written = False

    def __enter__(self) -> Self:
        with ExitStack() as entered, naming_full_disk(self.path):
            made_folder(self.path.parent)
            entered.enter_context(only_writer(self.path.parent))
            if self._fresh:
                remove(self.path)
            self._rows.file = opened(self.path, "r+b")
            entered.callback(lambda: self._rows.file.close())
            if damaged := self._rows.recover():
                remark = f"the {self._rows.count} undamaged runs are kept, the others are carried out again"
                self._tell(f"{self.path}: {_damaged(damaged)}; {remark}")
                self._rewrite(self)  # so that they are reported only once
            if not self._rows.is_outdated:
                self._begin()
            self._opened = entered.pop_all()
        self._process = os.getpid()
        return self

    def _begin(self) -> None:
        """Cut the file behind its last whole row, and give an empty one its first line."""
        self._rows.file.truncate(self._rows.end)
        if self._rows.end == 0:
            self._append(_sealed(self._rows.first))
            self._rows.head = self._rows.end

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._opened:
            empty = os.fstat(self._rows.file.fileno()).st_size <= self._rows.head
            self._rows.file.close()
            if os.getpid() == self._process and (empty or (self._written and kind is None and not self._stays)):
                remove(self.path)

    def __len__(self) -> int:
        """Return the number of finished runs."""
        return self._rows.count

    def __contains__(self, number: object) -> bool:
        return number in self._rows

    def __iter__(self) -> Iterator[int]:
        """Yield the numbers of the finished runs in rising order."""
        return iter(self._rows)

    def __getitem__(self, number: int) -> dict[str, str]:
        """Return all cells of a finished run as texts, "" for None, also those that ``beside`` names.

        Raises ``KeyError`` for an unfinished run.
        """
        if number not in self:
            raise KeyError(number)
        (cells,) = csv.reader(io.StringIO(self._rows.row(number).decode(), newline=""))
        return dict(zip(self.columns, map(csv_plain, cells), strict=True))

    def cells_beside(self, number: int) -> dict[str, str]:
        """Return the cells beside the row of a run by name; {} for an unfinished run, or a journal without such cells."""
        if not self.beside or number not in self:
            return {}
        cells = self._rows.row(number).rstrip(b"\n").decode().rsplit(",", len(self.beside))[1:]
        return dict(zip(self.beside, cells, strict=True))

    def rows(self) -> Iterator[tuple[int, dict[str, str]]]:
        """Yield number and cells of every finished run in rising order."""
        return ((number, self[number]) for number in self)

    def add_all(self, rows: Mapping[int, Mapping[str, object]]) -> None:
        """Save rows by the numbers of their runs; they are on disk on return.

        Columns that a row lacks are empty; its further keys are left out.
        """
        self.add_columns(list(rows), {name: [row.get(name) for row in rows.values()] for name in self.columns})

    def add_columns(self, numbers: Sequence[int], columns: Mapping[str, Sequence[object]]) -> None:
        """Save, as :meth:`add_all`, columns of the rows of n runs, each of length n; missing columns are empty."""
        self._add(zip(numbers, self._lines(len(numbers), columns), strict=True))

    def add_from(self, path: Path) -> None:
        """Add the rows of another journal of the same digest and columns, for example of another machine.

        Raises ``InputError`` for rows of another digest, or if a run has different rows in both; damaged lines are reported and
        skipped.
        """
        mine = self._rows
        source = _Rows(path, mine.columns, mine.digest, mine.runs, "undo that, or have its share run again")
        with opened(path) as source.file:
            if damaged := source.recover():
                self._tell(f"{path}: {_damaged(damaged)}; they are skipped")
            for number in source:
                if number in mine and source.row(number) != mine.row(number):
                    raise InputError(f"{path}: run {number} differs from the same run in another folder; leave one out")
            missing = [number for number in source if number not in mine]
            for first in range(0, len(missing), ROWS_AT_ONCE):
                self._add((number, source.row(number)) for number in missing[first : first + ROWS_AT_ONCE])

    def write_in_order(
        self, path: Path, extra_rows: Iterable[Mapping[str, object]] = (), numbers: Iterable[int] | None = None
    ) -> Written:
        """Write the table completely or not at all: finished runs, then rows of no run.

        Runs are those of ``numbers``, in their order, by default all in rising order.
        The journal is then removed at the end of the ``with``, unless an error ends it.
        """
        digest, rows = hashlib.sha256(), -1
        with replacing(path) as temporary, temporary.open("wb") as file:
            for line in self._lines_in_order(extra_rows, self if numbers is None else numbers):
                file.write(line)
                digest.update(line)
                rows += 1
        self._written = True
        return Written(rows, digest.hexdigest())

    def renumber(self, first: Iterable[int]) -> None:
        """Number the runs anew, the ``first`` in their order and then all others, and put the file into that order.

        The file of a search is then the same in whatever order its runs were finished.
        """
        order = [*dict.fromkeys(first), *sorted({*self}.difference(first))]
        starts = [self._rows.starts[number] for number in order]
        if order != list(range(len(order))) or starts != sorted(starts):
            self._rewrite(order, range(len(order)))

    def _lines_in_order(self, extra_rows: Iterable[Mapping[str, object]], numbers: Iterable[int]) -> Iterator[bytes]:
        """Yield the lines of the table: head, finished runs, extra rows."""
        yield _encoded(csv_line(self.columns[: len(self.columns) - len(self.beside)]))
        with os.fdopen(os.dup(self._rows.file.fileno()), "rb", BUFFER) as buffered:
            for number in numbers:
                buffered.seek(self._rows.starts[number])
                yield self._without_beside(_unfolded(buffered.read(self._rows.sizes[number])))
        for row in extra_rows:
            yield from map(self._without_beside, self._lines(1, {name: [cell] for name, cell in row.items()}))

    def _without_beside(self, line: bytes) -> bytes:
        return line.rsplit(b",", len(self.beside))[0] + b"\n" if self.beside else line

    def _lines(self, rows: int, columns: Mapping[str, Sequence[object]]) -> Iterator[bytes]:
        empty = [None] * rows
        return (_encoded(f"{line}\n") for line in csv_lines([columns.get(name, empty) for name in self.columns]))

    def _add(self, rows: Iterable[tuple[int, bytes]]) -> None:
        """Append rows as one block, and index them; the first replace those of an outdated table."""
        if self._rows.end == 0:
            self._begin()
        block = bytearray()
        places = []
        for number, row in rows:
            line = _sealed(b"%d," % number + row[:-1], self._rows.seed)
            block += line
            size = _size_of_cells(line)
            places.append((number, self._rows.end + len(block) - size, size))
        self._append(block)
        for place in places:
            self._rows.remember(*place)

    def _append(self, block: bytes | bytearray) -> None:
        """Write a block at the end of the file and onto the disk."""
        with naming_full_disk(self.path, f"the {self._rows.count} rows that are finished are kept"):
            self._rows.file.seek(self._rows.end)
            rest = memoryview(block)
            while rest:  # on an almost full disk a write may be partial
                rest = rest[self._rows.file.write(rest) :]
            os.fsync(self._rows.file.fileno())
        self._rows.end += len(block)

    def _rewrite(self, order: Iterable[int], numbers: Iterable[int] | None = None) -> None:
        """Rewrite the file with the rows in ``order``, under new ``numbers`` if these are given."""
        order = list(order)
        with replacing(self.path) as temporary, temporary.open("wb") as file:
            file.write(_sealed(self._rows.first))
            for number, old in zip(order if numbers is None else numbers, order, strict=True):
                file.write(_sealed(b"%d," % number + self._rows.row(old)[:-1], self._rows.seed))
        self._rows.file.close()
        self._rows.file = opened(self.path, "r+b")
        self._rows.recover()


_NUMBER = re.compile(rb"(\d{1,15}),")


def _whole_lines(file: io.FileIO) -> Iterator[tuple[int, bytes]]:
    """Yield the end [bytes] of each line, and the line with its line break, b"" if it is over MOST_OF_A_LINE, 1 MiB.

    An incomplete last line is left out.
    """
    end, whole = 0, True
    with os.fdopen(os.dup(file.fileno()), "rb") as buffered:
        buffered.seek(0)
        while part := buffered.readline(MOST_OF_A_LINE):
            end += len(part)
            ended = part.endswith(b"\n")
            if ended:
                yield end, part if whole else b""
            whole = ended


def _sealed(body: bytes, seed: int = 0) -> bytes:
    """Return a line of the file: a checksum and ``body``, its line breaks and backslashes escaped."""
    folded = body.replace(b"\\", b"\\\\").replace(b"\n", b"\\n")
    return b"%08x %b\n" % (zlib.crc32(folded, seed), folded)


def _unsealed(line: bytes, seed: int = 0) -> bytes | None:
    """Return the body of a line; None if the line is damaged."""
    folded = line[9:-1]
    return _unfolded(folded) if line[:9] == b"%08x " % zlib.crc32(folded, seed) else None


def _unfolded(body: bytes) -> bytes:
    """Restore the line breaks and backslashes that :func:`_sealed` escaped."""
    if b"\\" not in body:
        return body
    return re.sub(rb"\\(.)", lambda escape: b"\n" if escape[1] == b"n" else escape[1], body)


def _size_of_cells(line: bytes) -> int:
    """Return the number of bytes of a line after the run's number."""
    return len(line) - line.index(b",") - 1


def _damaged(lines: int) -> str:
    return f"{lines} line{'s are' if lines > 1 else ' is'} damaged"


def _encoded(line: str) -> bytes:
    return line.encode(errors="backslashreplace")
