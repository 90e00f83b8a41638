"""Access to the files of a folder of results, and to texts from elsewhere.

A folder may come from anybody. What is read or continued there is a plain file of that folder (:func:`opened`); what is new
takes its place as a whole (:func:`replacing`); only plain files are replaced or removed (:func:`remove`); and one process at a
time writes (:func:`only_writer`). Where a user says where to write, pipes and terminals will do as well (:func:`write_output`). A
text from elsewhere is :func:`legible` before it is shown, and :func:`csv_safe` in a table.
"""

import csv
import errno
import hashlib
import io
import os
import re
import stat
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import BinaryIO, Literal

from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd

FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
LOCK = "rockbatch.lock"
UNFINISHED = ".unfinished"
NAMES = ("record", "case", "polarity", "status", "reason", "mirror_of", "map", "limit")
"""Columns of tables that hold words from elsewhere."""
MOST_TEXT = 1 << 30
"""Most bytes of a file that is read as a whole: run.json of the largest study takes a third of it."""

CHANGED = "changed while it was read; read it again when nothing writes into it any more"

_AT_ONCE = sum(getattr(os, flag, 0) for flag in ("O_NONBLOCK", "O_CLOEXEC", "O_BINARY", "O_NOCTTY"))
_PLAIN_ONLY = _AT_ONCE | getattr(os, "O_NOFOLLOW", 0)
"""A link is not followed, and a pipe does not keep whoever opens it waiting."""
_KINDS = (
    (stat.S_ISLNK, "a link"),
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a disk"),
)
_STDOUT = ("-", "/dev/stdout")

_FORMULA_AHEAD = r"(?='*[=+\-@＝＋－＠\t\r\n].)"
_FORMULA = re.compile(rf"(?:\A|(?<=;)){_FORMULA_AHEAD}", re.DOTALL)
_SAVED_FORMULA = re.compile(rf"(?:\A|(?<=;))'{_FORMULA_AHEAD}", re.DOTALL)
_JOINING = (
    r"\u0620\u0626\u0628\u062a-\u062e\u0633-\u063f\u0641-\u0647\u0649\u064a"  # Arabic letters that join the next one
    r"\u0678-\u0687\u069a-\u06bf\u06c1\u06c2\u06cc\u06ce\u06d0\u06d1"
)
_VIRAMAS = r"\u094d\u09cd\u0a4d\u0acd\u0b4d\u0bcd\u0c4d\u0ccd\u0d4d\u0dca"
_EMOJI = r"\u2600-\u27bf\U0001f300-\U0001faff"
_UNPRINTABLE = re.compile(
    # signs that join or part letters of Persian and Indian scripts, and emoji, are seen (RFC 5892, appendix A), and stay
    rf"(?!(?<=[{_JOINING}])\u200c[\u0620\u0622-\u064a\u0671-\u0673\u0675-\u06d3]|(?<=[{_VIRAMAS}])[\u200c\u200d][\u0904-\u0dff]"
    rf"|(?<=[{_EMOJI}\ufe0f])\u200d[{_EMOJI}]|(?<=[{_EMOJI}])\ufe0f)"
    r"[\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff"  # controls, line breaks, bytes that are no text
    r"\xad\u034f\u061c\u115f\u1160\u17b4\u17b5\u180b-\u180f\u200b-\u200f\u202a-\u202e\u2060-\u206f\u3164\ufe00-\ufe0f"
    r"\ufeff\uffa0\ufff0-\ufffb\U0001bca0-\U0001bca3\U0001d173-\U0001d17a\U000e0000-\U000e0fff]"
)
"""Characters that are obeyed or not seen: the last two lines are Unicode's Default_Ignorable_Code_Point."""


def opened(path: Path, mode: Literal["rb", "r+b"] = "rb") -> io.FileIO:
    """Open a file of a folder of results, unbuffered; "r+b" creates a missing one.

    Raises ``InputError`` for whatever is no plain file of that folder: a link, which could lead anywhere, a pipe, a
    device, a folder, and for writing a file that has a second name elsewhere. ``FileNotFoundError`` as ``open`` does.
    """
    path = Path(path)
    if path.is_symlink():
        raise _not_plain(path, "a link")
    try:
        handle = os.open(path, (os.O_RDONLY if mode == "rb" else os.O_RDWR | os.O_CREAT) | _PLAIN_ONLY, 0o666)
    except OSError as error:
        if error.errno in (errno.ELOOP, errno.EISDIR, errno.ENXIO):
            raise _not_plain(path, "no plain file") from None
        raise
    status = os.fstat(handle)
    if not stat.S_ISREG(status.st_mode) or (mode == "r+b" and status.st_nlink > 1):
        os.close(handle)
        raise _not_plain(path, _kind(status) or "a file with several names")
    return io.FileIO(handle, mode)


def opened_input(path: Path) -> io.FileIO:
    """Open a file that a user or a folder of records names, without a buffer; links are followed.

    A named pipe that nobody writes into is empty, instead of keeping whoever opens it waiting for ever. Raises ``OSError`` for
    a folder, or if there is no such file.
    """
    handle = _open_at_once(path, os.O_RDONLY)
    try:
        return io.FileIO(handle)
    except OSError:  # of a folder
        os.close(handle)
        raise


def _open_at_once(path: Path, flags: int) -> int:
    """Return the descriptor of a file, opened without waiting for the other end of a pipe; reading then waits for data."""
    handle = os.open(path, flags | _AT_ONCE)
    if hasattr(os, "O_NONBLOCK"):
        os.set_blocking(handle, True)
    return handle


@contextmanager
def whole_input(path: Path) -> Iterator[tuple[BinaryIO, int]]:
    """Context manager: yield a regular file, opened as by :func:`opened_input`, and its size [bytes].

    Raises ``InputError`` for a pipe, a device, or a file that changes within the block.
    """
    with io.BufferedReader(opened_input(path)) as file:
        status = os.fstat(file.fileno())
        if not stat.S_ISREG(status.st_mode):
            raise InputError("not a regular file")
        yield file, status.st_size
        if state_of(os.fstat(file.fileno())) != state_of(status):
            raise InputError(CHANGED)


def state_of(status: os.stat_result) -> tuple[int, ...]:
    """Return the identity of a file's contents: inode, device, size [bytes] and time of modification [ns].

    A time alone would not do: files are copied with theirs, and clocks are set back.
    """
    return status.st_ino, status.st_dev, status.st_size, status.st_mtime_ns


def _not_plain(path: Path, kind: str) -> InputError:
    return InputError(
        f"{path}: {kind}, which is neither read nor written in a folder of results; remove it, or put a plain file there"
    )


def _kind(status: os.stat_result) -> str:
    """Return the kind of an irregular file in words, "a link"; "" for a regular one."""
    return next((words for is_kind, words in _KINDS if is_kind(status.st_mode)), "")


def _is_stream(mode: int) -> bool:
    """Return whether a file of this mode is a pipe or a character device, which take output as it comes."""
    return stat.S_ISFIFO(mode) or stat.S_ISCHR(mode)


def is_plain(path: Path) -> bool:
    """Return whether ``path`` is a regular file itself; False for a link, a folder, or if it does not exist."""
    try:
        return stat.S_ISREG(os.lstat(path).st_mode)
    except (OSError, ValueError):
        return False


def opened_text(path: Path) -> io.TextIOWrapper:
    """Open a table as :func:`opened` does: UTF-8, with its line breaks as they are."""
    return io.TextIOWrapper(io.BufferedReader(opened(path)), encoding="utf-8", newline="")


def read_text(path: Path) -> str:
    """Return the whole of a UTF-8 file of a folder of results; ``InputError`` as :func:`opened`, and for one too large."""
    with opened(path) as file:
        size = os.fstat(file.fileno()).st_size
        if size > MOST_TEXT:
            raise InputError(f"{path}: {size / 1e9:.1f} GB, more than `rockbatch` ever writes into such a file")
        return file.read(size).decode()


def sha256_of(path: Path) -> str:
    """Return the SHA-256 of a file of a folder of results, in hexadecimal digits. Raises ``InputError`` as :func:`opened`."""
    with opened(path) as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def sha256_of_lines(path: Path) -> str:
    """Return the SHA-256 of a table of a folder of results with "\\n" at the ends of its lines, whatever they are in the file.

    Raises ``InputError`` as :func:`opened`.
    """
    digest = hashlib.sha256()
    with io.BufferedReader(opened(path)) as file:
        for line in file:
            digest.update(line.rstrip(b"\r\n") + b"\n")
    return digest.hexdigest()


def made_folder(path: Path) -> Path:
    """Create a folder with its parents and return it; raise ``InputError`` if a file is in its place."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError) as error:
        raise InputError(f"{path}: a file stands in the place of the folder; choose another") from error
    return path


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Context manager: yield a temporary file that takes the place of ``path`` at the block's end, or is removed on an error.

    A reader finds the earlier file or the new one, never a part. Raises ``InputError`` if something else than a regular file
    stands there, or the disk is full.
    """
    refuse_irregular(path)
    with naming_full_disk(path):
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
            refuse_irregular(path)  # something else may have taken the name meanwhile
            temporary.replace(path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise


def refuse_irregular(*paths: Path) -> None:
    """Raise ``InputError`` with all of these paths that exist but are no regular files."""
    kinds = {path: _kind(os.lstat(path)) for path in paths if os.path.lexists(path)}
    advice = "which is not replaced; move it away, or name another"
    if any(kinds.values()):
        raise InputError(*(f"{path}: {kind}, {advice}" for path, kind in kinds.items() if kind))


def remove(path: Path) -> None:
    """Remove a file of a folder of results, if it is there; ``InputError`` for what is no regular file."""
    refuse_irregular(path)
    path.unlink(missing_ok=True)


def write_whole(path: Path, content: str | bytes) -> None:
    """Write bytes, or text as UTF-8, to ``path``, whole or not at all."""
    written = content.encode() if isinstance(content, str) else content
    with replacing(path) as temporary:
        temporary.write_bytes(written)


def write_output(path: Path, content: str | bytes) -> None:
    """Write bytes, or text as UTF-8, where a user asks for it: as :func:`write_whole`, or to a pipe, a device or stdout (``-``).

    Raises ``InputError`` for all else that is no regular file, and for what cannot be written.
    """
    try:
        with naming_full_disk(path):
            if is_stdout(path):
                handle = os.dup(1)
            elif path.exists() and _is_stream(path.stat().st_mode):
                handle = _open_at_once(path, os.O_WRONLY)
            else:
                write_whole(path, content)
                return
            with os.fdopen(handle, "wb") as file:
                file.write(content.encode() if isinstance(content, str) else content)
    except OSError as error:
        advice = "; if it is a pipe, start its reader first" if error.errno == errno.ENXIO else ""
        raise InputError(f"{path}: cannot be written: {error.strerror or error}{advice}") from None


def is_stdout(path: Path) -> bool:
    """Return whether a user means the standard output by ``path``: "-" or "/dev/stdout"."""
    return path.as_posix() in _STDOUT


@contextmanager
def naming_full_disk(path: Path, assurance: str = "what was finished before is kept") -> Iterator[None]:
    """Context manager: turn the error for a full disk, a quota or a limit on sizes into an ``InputError`` about ``path``."""
    try:
        yield
    except OSError as error:
        if error.errno not in FULL:
            raise
        raise InputError(
            f"{path}: cannot be written: {os.strerror(error.errno)}; {assurance}: make room and give the same command again"
        ) from error


@contextmanager
def only_writer(folder: Path) -> Iterator[None]:
    """Context manager: lock ``folder`` for writing; raise ``InputError`` if another process holds the lock.

    Unfinished files of a process that was killed are removed first. The operating system gives the lock back when its process
    ends, however it ends. What is forked meanwhile does not.
    """
    from filelock import FileLock, Timeout

    refuse_irregular(folder / LOCK)
    process = os.getpid()
    lock = FileLock(folder / LOCK)
    try:
        lock.acquire(blocking=False)
    except Timeout:
        if not (folder / LOCK).exists():  # the file system has no such files, as that of /proc
            raise InputError(f"{folder}: no file can be written there; choose another folder with --out") from None
        raise InputError(
            f"{folder}: another process is writing its results there; wait for it, or choose another folder with --out"
        ) from None
    try:
        for leftover in folder.glob(f".*{UNFINISHED}"):  # by a process that was killed
            if is_plain(leftover):
                leftover.unlink(missing_ok=True)
        yield
    finally:
        if os.getpid() == process:
            with suppress(OSError, InputError):  # Windows keeps files that are open
                remove(folder / LOCK)
            lock.release()


def legible(text: str, keep: str = "") -> str:
    """Return ``text`` with control and invisible characters, and bytes of a file's name that are no text, written as ``\\x1b``.

    Signs that join letters or emoji stay. It can be printed, stays on its line and goes into UTF-8. ``keep`` are characters
    that stay, such as line breaks of a text of several lines.
    """

    def escaped(match: re.Match[str]) -> str:
        if match[0] in keep:
            return match[0]
        code = ord(match[0])
        byte = code - 0xDC00 if 0xDC80 <= code <= 0xDCFF else code  # how Python carries a byte that is no text
        return f"\\x{byte:02x}" if byte <= 0xFF else f"\\u{byte:04x}" if byte <= 0xFFFF else f"\\U{byte:08x}"

    return text if text.isascii() and text.isprintable() else _UNPRINTABLE.sub(escaped, text)


def csv_safe(text: str) -> str:
    """Return ``text`` as a cell that no spreadsheet takes for a formula (OWASP, "CSV injection").

    Where it, or what follows a semicolon in it (which separates cells in half of the world), begins with = + - @, of full
    width too, a tab or a line break, an apostrophe goes before that; also before apostrophes that are followed by one of
    these, so that :func:`csv_plain` gives the text back. A sign alone stays as it is.
    """
    return _FORMULA.sub("'", text)


def csv_plain(cell: str) -> str:
    """Return the text that :func:`csv_safe` turned into ``cell``."""
    return _SAVED_FORMULA.sub("", cell) if "'" in cell else cell


def csv_text(columns: Sequence[str], rows: Iterable[Mapping[str, object]]) -> str:
    """Return the text of a CSV file with a header, and of ``rows`` their values in these ``columns``, as by :func:`csv_lines`."""
    rows = list(rows)
    lines = csv_lines([[row.get(name) for row in rows] for name in columns])
    return csv_line(columns) + "".join(f"{line}\n" for line in lines)


def csv_line(cells: Iterable[object]) -> str:
    """Return a line of a CSV file, with its line break, of ``cells`` as they are."""
    buffer = io.StringIO()
    csv.writer(buffer, lineterminator="\n").writerow(cells)
    return buffer.getvalue()


def csv_lines(columns: Sequence[Sequence[object]]) -> list[str]:
    """Return the rows of a CSV file, without their line breaks, made a column at a time.

    Cells of None and NaN are empty, floats have ten digits, and texts are legible and :func:`csv_safe`.
    """
    return [",".join(cells) or '""' for cells in zip(*map(_cells, columns), strict=True)]


def _cells(column: Sequence[object]) -> Sequence[str]:
    kinds = set(map(type, column))
    if kinds == {type(None)}:  # many are
        return [""] * len(column)
    if kinds == {float}:
        return [f"{value:.10g}" if value == value else "" for value in column]
    return list(map(_cell, column))


def _cell(value: object) -> str:
    """Return a value as a cell: floats with ten digits, "" for None and NaN, texts legible and :func:`csv_safe`, else its str."""
    if value is None or value != value:
        return ""
    if isinstance(value, float):
        return f"{value:.10g}"
    return _text_cell(value) if isinstance(value, str) else str(value)


@lru_cache(maxsize=1024)
def _text_cell(text: str) -> str:
    return csv_line([csv_safe(legible(text, keep="\t\r\n")), None])[:-2]


def read_table(path: Path, texts: Iterable[str] = ()) -> "pd.DataFrame":
    """Return a table that :func:`csv_text` wrote; in :data:`NAMES` and ``texts`` numbers stay words, and missing ones are ""."""
    words = [*NAMES, *texts]
    with opened(path) as file:
        table = pd.read_csv(file, keep_default_na=False, na_values=[""], dtype=dict.fromkeys(words, "str"))
    for name in table.columns.intersection(words):
        table[name] = table[name].fillna("").map(csv_plain)
    return table
