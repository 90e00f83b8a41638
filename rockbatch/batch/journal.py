"""The rows of finished runs, on disk from the moment they are finished, until the table is written in its order."""

import csv
import io
import os
from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self

from rockbatch.errors import InputError
from rockbatch.files import csv_cell, csv_plain, only_writer, replacing, told_when_full

ABSENT = -1
ROWS_AT_ONCE = 1000


class Journal:
    """Rows of a table that is under way, in a file beside it, each written down for good once its run is finished.

    The file survives whatever ends the process. Its first line says what is run and names the columns; then comes a
    line for each finished run, in whatever order they finish: its number, and its cells as they will be in the table.
    What a crash has left of a last line is dropped by whoever goes on. Memory holds only where each row stands.

    Use it as a context; meanwhile no other process can write into its folder. At the end of the context the file goes
    if the table was written or no run is finished; else it stays.

    Parameters
    ----------
    path : Path
        The file, such as ``peaks.csv.part``; its folder is made.
    columns : sequence of str
        Columns of the table.
    digest : mapping of str to str
        What the rows depend on, in plural words, each with its digest: ``{"cases": "5f1c…", "motions": "09ab…"}``.
    fresh : bool
        Whether to drop what an earlier process has left there.

    Raises
    ------
    InputError
        On entry, if the file holds runs of another digest, or if another process is writing into the folder; from
        whatever writes, if the disk is full.
    """

    def __init__(self, path: Path, columns: Sequence[str], digest: Mapping[str, str], fresh: bool = False) -> None:
        self.path = path
        self.columns = list(columns)
        self.digest = dict(digest)
        self._fresh = fresh
        self._starts, self._sizes = array("q"), array("q")  # of each row [bytes], by the number of its run
        self._count = 0
        self._head = 0  # bytes of the first line
        self._end = 0
        self._written = False
        self._remedy = "undo that to go on, choose another folder with --out, or start over with --fresh"

    def __enter__(self) -> Self:
        with ExitStack() as opened, told_when_full(self.path):
            self.path.parent.mkdir(parents=True, exist_ok=True)
            opened.enter_context(only_writer(self.path.parent))
            if self._fresh:
                self.path.unlink(missing_ok=True)
            self.path.touch()
            self._file = opened.enter_context(self.path.open("r+b", buffering=0))
            self._recover()
            self._file.truncate(self._end)
            if self._end == 0:
                self._append(_line([_told(self.digest), *self.columns]))
                self._head = self._end
            self._opened = opened.pop_all()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._opened:
            empty = os.fstat(self._file.fileno()).st_size <= self._head
            self._file.close()
            if empty or (self._written and kind is None):
                self.path.unlink()

    def __len__(self) -> int:
        """Number of finished runs."""
        return self._count

    def __contains__(self, number: object) -> bool:
        return isinstance(number, int) and 0 <= number < len(self._starts) and self._starts[number] != ABSENT

    def __iter__(self) -> Iterator[int]:
        """Numbers of the finished runs, from the lowest."""
        return (number for number, start in enumerate(self._starts) if start != ABSENT)

    def __getitem__(self, number: int) -> dict[str, str]:
        """Cells of a finished run, as the table will have them: texts, "" where a column does not apply."""
        if number not in self:
            raise KeyError(number)
        (cells,) = csv.reader(io.StringIO(self._row(number).decode(), newline=""))
        return dict(zip(self.columns, map(csv_plain, cells), strict=True))

    def rows(self) -> Iterator[tuple[int, dict[str, str]]]:
        """Number and cells of every finished run, from the lowest number."""
        return ((number, self[number]) for number in self)

    def add_all(self, rows: Mapping[int, Mapping[str, Any]]) -> None:
        """Write down the rows of finished runs by their numbers, once for good: on return the disk has them."""
        self._add((number, _line(self._cells(row))) for number, row in rows.items())

    def add_from(self, path: Path) -> None:
        """Take over what is in another journal of the same digest and columns, such as that of another machine.

        Raises ``InputError`` if it is of another digest, or if the same run has another row there.
        """
        other = Journal(path, self.columns, self.digest)
        other._remedy = "undo that, or have its share run again"
        with path.open("rb", buffering=0) as other._file:
            other._recover()
            for number in other:
                if number in self and other._row(number) != self._row(number):
                    raise InputError(f"{path}: run {number} has come to something else than elsewhere; leave one out")
            news = [number for number in other if number not in self]
            for first in range(0, len(news), ROWS_AT_ONCE):
                self._add((number, other._row(number)) for number in news[first : first + ROWS_AT_ONCE])

    def write_in_order(self, path: Path, extra_rows: Iterable[Mapping[str, Any]] = ()) -> None:
        """Write the table, whole or not at all: finished runs by their numbers, then rows that belong to no run.

        The journal has then served its purpose and goes at the end of the context.
        """
        with replacing(path) as temporary, temporary.open("wb") as file:
            file.write(_line(self.columns))
            file.writelines(map(self._row, self))
            file.writelines(_line(self._cells(row)) for row in extra_rows)
        self._written = True

    def _cells(self, row: Mapping[str, Any]) -> list[Any]:
        return [csv_cell(row.get(name)) for name in self.columns]

    def _row(self, number: int) -> bytes:
        self._file.seek(self._starts[number])
        return self._file.read(self._sizes[number])

    def _add(self, rows: Iterable[tuple[int, bytes]]) -> None:
        block = bytearray()
        places = []
        for number, row in rows:
            block += b"%d," % number
            places.append((number, self._end + len(block), len(row)))
            block += row
        self._append(block)
        for place in places:
            self._remember(*place)

    def _append(self, block: bytes | bytearray) -> None:
        with told_when_full(self.path, f"the {self._count} runs that are finished are kept"):
            self._file.seek(self._end)
            rest = memoryview(block)
            while rest:  # of a disk that is almost full, a write may take a part
                rest = rest[self._file.write(rest) :]
            os.fsync(self._file.fileno())
        self._end += len(block)

    def _remember(self, number: int, start: int, size: int) -> None:
        missing = number + 1 - len(self._starts)
        self._starts.extend([ABSENT] * missing)
        self._sizes.extend([0] * missing)
        self._count += self._starts[number] == ABSENT
        self._starts[number], self._sizes[number] = start, size

    def _recover(self) -> None:
        """Find the rows that an earlier process has finished, up to a damaged one."""
        with self.path.open("rb") as file:
            places = _places(file)
            _, self._head, head = next(places, (0, 0, []))
            self._end = self._head
            for start, end, (number, *cells) in places:
                if len(cells) != len(head) - 1 or not number.isdecimal():
                    break
                first = start + len(number) + 1
                self._remember(int(number), first, end - first)
                self._end = end
        if self._end and head != [_told(self.digest), *self.columns]:
            if self._count:
                raise InputError(self._refusal(head[0]))
            self._end = 0

    def _refusal(self, told: str) -> str:
        """What to do about a journal with another first line, that begins with ``told``."""
        there = dict(part.partition(":")[::2] for part in told.split())
        others = [name for name, digest in self.digest.items() if there.get(name) != digest] or ["columns"]
        return (
            f"{self.path}: holds {self._count} finished runs, but since then something has changed ({', '.join(others)}); "
            f"{self._remedy}"
        )


def _places(file: BinaryIO) -> Iterator[tuple[int, int, list[str]]]:
    """First byte of each row, the byte after its last, and its cells, until one is torn or is no row."""
    end = 0

    def whole_lines() -> Iterator[str]:
        nonlocal end
        for line in file:
            if not line.endswith(b"\n"):
                return
            end += len(line)
            yield line.decode()

    start = 0
    try:
        for cells in csv.reader(whole_lines(), strict=True):
            if not cells:
                return
            yield start, end, cells
            start = end
    except (csv.Error, UnicodeDecodeError):
        return


def _line(cells: Iterable[Any]) -> bytes:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(cells)
    return text.getvalue().encode(errors="backslashreplace")


def _told(digest: Mapping[str, str]) -> str:
    return " ".join(f"{name}:{value}" for name, value in digest.items())
