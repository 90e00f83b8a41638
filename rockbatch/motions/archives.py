"""Records in archives: a .zip is read as a folder, a .gz as the file that it holds; nothing is written to the disk.

A file in a .zip has a path that goes on within it, ``motions/peer.zip/RSN6_A_B.AT2``. Everything is bounded: the
archive, what it unpacks to, the number of its files and how far they grow, and an archive within an archive is not
opened.
"""

import gzip
import io
import stat
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path, PurePosixPath

from rockbatch.common.errors import InputError
from rockbatch.common.files import state_of, whole_input

LARGEST = 256 * 2**20
"""Bytes of a file, packed or unpacked; a day of three channels at 200 Hz has a fifth of it."""

_MOST_FILES = 2000
_TOO_MANY = f"lists more than {_MOST_FILES} files; unpack it"
_MOST_UNPACKED = 2**30  # bytes that the files of one archive come to
_GROWTH = 100  # how many times its packed size a file may have: records of text have 3 to 10 times
_NEVER_TOO_LARGE = 2**20  # bytes
_LISTING = 2**20  # bytes of an archive's list of files
_END, _END_64, _END_SIZE, _LONGEST_COMMENT = b"PK\x05\x06", b"PK\x06\x07", 22, 2**16
_PACKED = {".zip", ".gz", ".tar", ".tgz", ".bz2", ".xz", ".7z", ".rar", ".tbz", ".txz", ".zst"}
_MAGIC = (b"PK\x03\x04", b"\x1f\x8b", b"BZh", b"\xfd7zXZ", b"7z\xbc\xaf", b"Rar!")
_READ_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_DAMAGED = (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, ValueError)
"""Errors of the standard library on damaged files: RuntimeError where bits ask for a password or a method that it lacks,
ValueError for places in the file that cannot be."""


def is_zip(path: Path) -> bool:
    """Return whether a path has the name of an archive that is read as a folder."""
    return path.suffix.lower() == ".zip"


def not_read(path: Path) -> str:
    """Return why an archive is not opened, and what to do; empty for what is read, or no archive."""
    inner = bare(path).suffix.lower() if path.suffix.lower() == ".gz" else path.suffix.lower()
    if inner in _PACKED and not is_zip(path):
        return "an archive that is not read (.zip is, and .gz of one record); unpack it"
    return ""


def bare(path: Path) -> Path:
    """Return the path of a record as if it were not packed: without .gz."""
    return path.with_suffix("") if path.suffix.lower() == ".gz" else path


@dataclass(frozen=True)
class Member:
    """A file in an archive: its path, its name there as it was written, and why it is not to be opened ("" if it may)."""

    path: Path
    name: str
    refusal: str


def members(archive: Path) -> Iterator[Member]:
    """Return the files of an archive in order of their names, but hidden and read-me files, as in folders.

    Raises ``InputError`` for what is no archive, or too large.
    """
    total = 0
    visited: set[Path] = set()
    with _opened(archive) as opened:
        listed = opened.infolist()
    for info in sorted(listed, key=_name):
        name = PurePosixPath(_name(info))
        hidden = any(part.startswith(".") and part != ".." for part in name.parts)
        if info.is_dir() or hidden or name.stem.lower() == "readme":
            continue
        total += info.file_size
        path = archive / _within(info)
        refusal = _refusal(info)
        if not refusal and path in visited:
            refusal = "the archive has two files of this name; unpack it"
        elif not refusal and total > _MOST_UNPACKED:
            refusal = f"the archive unpacks to more than {_MOST_UNPACKED // 2**30} GiB; unpack it"
        elif not refusal:
            visited.add(path)
        yield Member(path, _name(info), refusal)


def is_member(path: Path) -> bool:
    """Return whether a path leads to a file in an archive."""
    archive = archive_of(path)
    try:
        return archive is not None and path in _paths_in(archive, state_of(archive.stat()))
    except (InputError, OSError):
        return False


@lru_cache(maxsize=8)
def _paths_in(archive: Path, state: tuple[int, ...]) -> frozenset[Path]:
    """Return paths of the files in an archive; its ``state`` keeps a new one from being taken for the old one."""
    return frozenset(member.path for member in members(archive))


def archive_of(path: Path) -> Path | None:
    """Return the archive that a path goes on within; ``None`` for a path of the disk."""
    return next((above for above in path.parents if is_zip(above) and above.is_file()), None)


def state(path: Path) -> tuple[int, ...]:
    """Return the :func:`state_of` the file on the disk that a path names or lies within; none if it is gone."""
    try:
        return state_of((archive_of(path) or path).stat())
    except OSError:
        return ()


def files_in(folder: Path) -> list[Path]:
    """Return paths of the regular files in a folder, or in a folder of an archive, in order; those that may be opened."""
    archive = folder if is_zip(folder) and folder.is_file() else archive_of(folder)
    if archive is None:
        return sorted(path for path in folder.iterdir() if path.is_file())
    return [member.path for member in members(archive) if member.path.parent == folder and not member.refusal]


def content(path: Path, first: int | None = None) -> bytes:
    """Return what a file holds, or its ``first`` bytes, unpacked where it is a .gz or lies in an archive.

    Raises ``InputError`` for what is damaged, or larger than allowed, ``OSError`` for what cannot be read.
    """
    archive = archive_of(path)
    if archive is not None:
        return _from_zip(archive, path, first)
    packed = path.suffix.lower() == ".gz"
    with whole_input(path) as (file, size):
        if size > LARGEST:
            raise InputError(f"larger than {LARGEST // 2**20} MiB")
        data = file.read(size if first is None or packed else min(first, size))  # what is asked for is allocated
    return _from_gzip(data, first) if packed else data


def _from_gzip(data: bytes, first: int | None) -> bytes:
    most = min(LARGEST, max(_NEVER_TOO_LARGE, _GROWTH * len(data)))
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as file:
            unpacked = file.read(most + 1 if first is None else first)
    except (*_DAMAGED, OSError):  # gzip's own errors are OSErrors
        raise InputError("not a gzip file, or a damaged one; fetch it again") from None
    if len(unpacked) > most:
        raise InputError(_too_large(len(data), most))
    if unpacked.startswith(_MAGIC) or unpacked[257:262] == b"ustar":
        raise InputError("an archive within an archive; unpack it")
    return unpacked


def _from_zip(archive: Path, path: Path, first: int | None) -> bytes:
    with _opened(archive) as opened:
        allowed = (info for info in opened.infolist() if archive / _within(info) == path and not _refusal(info))
        info = next(allowed, None)
        if info is None:
            raise InputError("no longer in the archive")
        try:
            with opened.open(info) as file:
                data = file.read(info.file_size if first is None else first)
        except _DAMAGED:
            raise InputError("damaged within its archive; fetch the archive again") from None
    if data.startswith(_MAGIC):
        raise InputError("an archive within an archive; unpack it")
    return data


@contextmanager
def _opened(archive: Path) -> Iterator[zipfile.ZipFile]:
    """Yield a .zip, after a look at how much it lists; ``InputError`` where it is too much, or no .zip."""
    with whole_input(archive) as (file, size):
        if not size:
            raise InputError("the file is empty")
        if size > LARGEST:
            raise InputError(f"larger than {LARGEST // 2**20} MiB; unpack it")
        file.seek(max(0, size - _END_SIZE - _LONGEST_COMMENT))
        _refuse_long_lists(file.read(_END_SIZE + _LONGEST_COMMENT))
        try:
            opened = zipfile.ZipFile(file)
        except _DAMAGED:
            raise InputError("not a zip archive, or a damaged one; fetch it again") from None
        if len(opened.infolist()) > _MOST_FILES:
            raise InputError(_TOO_MANY)
        yield opened


def _refuse_long_lists(tail: bytes) -> None:
    """Raise ``InputError`` where the end of an archive says that it lists too many files, or is missing."""
    start = tail.rfind(_END)
    if start < 0:
        raise InputError("not a zip archive, or a cut one; fetch it again")
    listing = int.from_bytes(tail[start + 12 : start + 16], "little")
    if listing > _LISTING or _END_64 in tail[max(0, start - 20) : start]:
        raise InputError(_TOO_MANY)


def _refusal(info: zipfile.ZipInfo) -> str:
    """Return why a file of an archive is not to be opened; empty where it may be."""
    name = PurePosixPath(_name(info))
    if name.is_absolute() or not name.parts or ".." in name.parts or ":" in name.parts[0]:
        return "its name leads out of the archive; unpack it where that does no harm"
    if info.flag_bits & 1:
        return "encrypted; unpack it with its password"
    if stat.S_ISLNK(info.external_attr >> 16):
        return "a link; unpack the archive"
    if name.suffix.lower() in _PACKED:
        return "an archive within an archive; unpack it"
    if info.compress_type not in _READ_METHODS:
        return f"packed by method {info.compress_type}, which is not read; unpack it"
    most = min(LARGEST, max(_NEVER_TOO_LARGE, _GROWTH * info.compress_size))
    return _too_large(info.compress_size, most) if info.file_size > most else ""


def _too_large(packed: int, most: int) -> str:
    if most == LARGEST:
        return f"unpacks to more than {LARGEST // 2**20} MiB"
    return f"unpacks to more than {_GROWTH} times its {packed} bytes, as no record does; unpack it if it is one"


def _name(info: zipfile.ZipInfo) -> str:
    """Return the name in an archive, with / between folders as some programs for Windows do not write it."""
    return info.filename.replace("\\", "/")


def _within(info: zipfile.ZipInfo) -> PurePosixPath:
    """Return a name in the archive that does not lead out of it."""
    inside = [part for part in PurePosixPath(_name(info)).parts if part not in ("/", "//", "..")]
    return PurePosixPath(*inside) if inside else PurePosixPath("?")
