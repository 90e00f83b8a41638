"""Files written whole or not at all, by one process at a time, and texts from elsewhere that do no harm in them."""

import csv
import errno
import io
import os
import re
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from rockbatch.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
LOCK = "rockbatch.lock"
UNFINISHED = ".unfinished"
NAMES = ("record", "case", "polarity", "status", "reason", "mirror_of", "map", "limit")
"""Columns of tables that hold words from elsewhere."""
_FORMULA = re.compile(r"'*[=+\-@\t\r\n].", re.DOTALL)
_UNPRINTABLE = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069\ud800-\udfff]")


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A temporary file beside ``path`` that takes its place at the end of the ``with`` block, or goes with an error.

    Whoever looks finds the earlier file or the new one, never a part.
    """
    with told_when_full(path):
        handle, name = tempfile.mkstemp(prefix=f".{path.name}-", suffix=UNFINISHED, dir=path.parent)
        os.close(handle)
        temporary = Path(name)
        try:
            yield temporary
            # mkstemp keeps its file private; results are made to be shared as any other file
            umask = os.umask(0)
            os.umask(umask)
            temporary.chmod(0o666 & ~umask)
            with temporary.open("rb+") as file:
                os.fsync(file.fileno())  # else a power cut might leave the name without the contents
            temporary.replace(path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise


def write_whole(path: Path, text: str) -> None:
    """Write UTF-8 ``text`` to ``path``, whole or not at all."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="")


@contextmanager
def told_when_full(path: Path, kept: str = "what was finished before is kept") -> Iterator[None]:
    """Turns the operating system's error for a full disk, or a quota, into an ``InputError`` about ``path``."""
    try:
        yield
    except OSError as error:
        if error.errno not in FULL:
            raise
        raise InputError(
            f"{path}: cannot be written: {os.strerror(error.errno)}; {kept}: make room and give the same command again"
        ) from error


@contextmanager
def only_writer(folder: Path) -> Iterator[None]:
    """Nobody else may write into ``folder`` meanwhile; ``InputError`` if another process does already.

    The operating system gives the lock back when its process ends, however it ends.
    """
    from filelock import FileLock, Timeout

    lock = FileLock(folder / LOCK)
    try:
        lock.acquire(blocking=False)
    except Timeout:
        raise InputError(
            f"{folder}: another process is writing its results there; wait for it, or choose another folder with --out"
        ) from None
    try:
        for left in folder.glob(f".*{UNFINISHED}"):  # by a process that was killed
            left.unlink(missing_ok=True)
        yield
    finally:
        with suppress(OSError):  # Windows keeps files that are open
            Path(lock.lock_file).unlink()
        lock.release()


def legible(text: str) -> str:
    """``text`` with control characters, and bytes of a file's name that are no text, written as ``\\x1b``: it can be
    printed, stays on its line, and goes into UTF-8."""

    def escaped(found: re.Match[str]) -> str:
        code = ord(found[0])
        byte = code - 0xDC00 if 0xDC80 <= code <= 0xDCFF else code  # how Python carries such a byte
        return f"\\x{byte:02x}" if byte <= 0xFF else f"\\u{byte:04x}"

    return _UNPRINTABLE.sub(escaped, text)


def csv_safe(text: str) -> str:
    """``text`` as a cell that no spreadsheet takes for a formula (OWASP, "CSV injection").

    Where it begins with = + - @, a tab or a line break, an apostrophe goes before it; also before apostrophes that
    are followed by one of these, so that :func:`csv_plain` gives the text back. A sign alone stays as it is.
    """
    return f"'{text}" if _FORMULA.match(text) else text


def csv_plain(cell: str) -> str:
    """The text that :func:`csv_safe` made ``cell`` of."""
    return cell[1:] if cell.startswith("'") and _FORMULA.match(cell) else cell


def csv_text(columns: Sequence[str], rows: Iterable[Mapping[str, object]]) -> str:
    """A CSV file: empty cells where a row has nothing or NaN, floats to ten digits, texts that are :func:`csv_safe`."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([csv_cell(row.get(name)) for name in columns] for row in rows)
    return buffer.getvalue()


def read_table(path: Path) -> "pd.DataFrame":
    """A table that was written so; names in it that look like numbers stay names."""
    import pandas as pd

    table = pd.read_csv(path, keep_default_na=False, na_values=[""], dtype=dict.fromkeys(NAMES, "str"))
    for name in table.columns.intersection(list(NAMES)):
        table[name] = table[name].fillna("").map(csv_plain)
    return table


def csv_cell(value: object) -> object:
    """What a CSV writer is given for ``value``: nothing for None and NaN, ten digits of a float, a text that is safe."""
    if value is None or value != value:
        return ""
    if isinstance(value, float):
        return f"{value:.10g}"
    return csv_safe(value) if isinstance(value, str) else value
