"""Records in archives: a .zip or .tar.gz is read as a folder, a .gz as the file in it; nothing is written to the disk.

The path of a file in an archive continues within it, ``motions/peer.zip/RSN6_A_B.AT2``, also in an archive in another,
``all.zip/peer.zip/RSN6_A_B.AT2``; a third level is not opened. The size of an archive, its unpacked size, the number of its
files and their growth are bounded.
"""

import gzip
import io
import re
import stat
import tarfile
import zipfile
import zlib
from collections.abc import Callable, Iterator
from functools import lru_cache, partial
from itertools import islice
from pathlib import Path, PurePosixPath
from typing import IO, NamedTuple

from rockbatch.common.errors import InputError
from rockbatch.common.files import state_of, whole_input

LARGEST = 256 * 2**20
"""Bytes of a file, packed or unpacked; a day of three channels at 200 Hz has a fifth of it."""

_MOST_FILES = 2000
_TOO_MANY = f"lists more than {_MOST_FILES} files; unpack it"
_MOST_UNPACKED = 2**30  # bytes of all files of one archive
_GROWTH = 100  # greatest ratio of a file's size to its packed size: records of text have 3 to 10
_NEVER_TOO_LARGE = 2**20  # bytes: smaller files may grow by any ratio
_LISTING = 2**20  # bytes of an archive's list of files
_END, _END_64, _END_SIZE, _LONGEST_COMMENT = b"PK\x05\x06", b"PK\x06\x07", 22, 2**16
_TARS = (".tar", ".tar.gz", ".tgz")
_NAMED = re.compile(
    r"\.(?:zip|t)", re.IGNORECASE
)  # in every path into an archive: spares most paths a look at the disk
_PACKED = {".zip", ".gz", ".tar", ".tgz", ".bz2", ".xz", ".7z", ".rar", ".tbz", ".txz", ".zst"}
_MAGIC = (b"PK\x03\x04", b"\x1f\x8b", b"BZh", b"\xfd7zXZ", b"7z\xbc\xaf", b"Rar!")
_BLOCK = 512  # bytes of a block of a .tar, which ends in two empty ones
_READ_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_WITHIN = "an archive within an archive; unpack it"
_DAMAGED = (zipfile.BadZipFile, tarfile.TarError, zlib.error, EOFError, RuntimeError, ValueError, OSError)
"""Errors of the standard library on damaged files: RuntimeError for a password or an unknown method, ValueError for
impossible offsets, OSError of gzip."""


def is_archive(path: Path | PurePosixPath) -> bool:
    """Return whether a path is named as an archive that is read as a folder: .zip, .tar, .tar.gz, .tgz, in capitals or not."""
    return path.name.lower().endswith((".zip", *_TARS))


def is_read_me(name: str) -> bool:
    """Return whether a file is called read-me, but for one suffix and a .gz: readme.txt.gz, not readme.st_N.txt."""
    return bare(Path(name)).stem.lower() == "readme"


def not_read(path: Path) -> str:
    """Return why an archive of another kind (.7z, .rar) is not read, by its suffix; "" for a .zip or .tar and other files."""
    if bare(path).suffix.lower() in _PACKED and not is_archive(path):
        return "an archive that is not read (.zip and .tar.gz are, and .gz of one record); unpack it"
    return ""


def bare(path: Path) -> Path:
    """Return the path without a last .gz, in capitals or not."""
    return path.with_suffix("") if path.suffix.lower() == ".gz" else path


class Member(NamedTuple):
    """A file in an archive: its path, its name there, why it must not be opened ("" if it may), and its size [bytes]."""

    path: Path
    name: str
    refusal: str
    size: int = 0


class _Entry(NamedTuple):
    """A file in an archive's list: its name, with / between folders; sizes [bytes]; why its kind must not be opened, or ""."""

    name: str
    size: int
    packed: int
    kind: str
    open: Callable[[], IO[bytes] | None]


class _Archive(NamedTuple):
    """The files of an archive in memory, by name, and those that may be opened by path, of one path the first."""

    entries: list[_Entry]
    by_path: dict[PurePosixPath, _Entry]


def members(archive: Path) -> Iterator[Member]:
    """Yield the files of an archive, and of archives in it, by name, each with the reason if it must not be opened.

    Hidden and read-me files are skipped; the second file of one path, and all beyond 1 GiB unpacked, must not be opened. Raises
    ``InputError`` for a damaged archive, one above 256 MiB, or with more than 2000 files.
    """
    total = 0
    visited: set[Path] = set()
    for number, member in enumerate(_listed(archive), 1):
        if number > _MOST_FILES:
            raise InputError(_TOO_MANY)
        total += member.size
        refusal = member.refusal
        if not refusal and member.path in visited:
            refusal = "the archive has two files of this name; unpack it"
        elif not refusal and total > _MOST_UNPACKED:
            refusal = f"the archive unpacks to more than {_MOST_UNPACKED // 2**30} GiB; unpack it"
        elif not refusal:
            visited.add(member.path)
        yield member._replace(refusal=refusal)


def _listed(archive: Path, outer: str = "") -> Iterator[Member]:
    """Yield the files of an archive, and of archives in it; ``outer`` is the prefix of their names.

    Hidden and read-me files are left out; an inner archive that cannot be read, or lies in another inner one, is a file with that
    reason.
    """
    for entry in _opened_archive(archive, state(archive)).entries:
        name, path = PurePosixPath(entry.name), archive / _member_path(entry.name)
        if any(part.startswith(".") and part != ".." for part in name.parts) or is_read_me(name.name):
            continue
        refusal = _refusal(entry) or (_WITHIN if outer and is_archive(name) else "")
        member = Member(path, f"{outer}{entry.name}", refusal, entry.size)
        if refusal or not is_archive(name):
            yield member
            continue
        try:
            yield from list(_listed(path, f"{member.name}/"))
        except InputError as error:
            yield Member(path, member.name, "; ".join(error.messages))


def is_member(path: Path) -> bool:
    """Return whether a path leads to one of the :func:`members` of an archive, even a refused one; False if unreadable."""
    try:
        archive = archive_of(path)
        return archive is not None and path in _paths_in(archive, state_of(archive.stat()))
    except (InputError, OSError):
        return False


@lru_cache(maxsize=8)
def _paths_in(archive: Path, state: tuple[int, ...]) -> frozenset[Path]:
    """Return paths of the files in an archive; the cache depends on its ``state``, so that a changed archive is listed anew."""
    return frozenset(member.path for member in members(archive))


def archive_of(path: Path) -> Path | None:
    """Return the archive on the disk that contains a path; ``None`` for a path on the disk itself."""
    if not _NAMED.search(str(path)):
        return None
    return next((above for above in path.parents if is_archive(above) and above.is_file()), None)


def state(path: Path) -> tuple[int, ...]:
    """Return inode, device, size [bytes] and time [ns] of a file, or of the archive on the disk that holds it; () if gone."""
    try:
        return state_of((archive_of(path) or path).stat())
    except OSError:
        return ()


def files_in(folder: Path) -> list[Path]:
    """Return the sorted paths of the regular files directly in a folder, on the disk or in an archive.

    In an archive without hidden and read-me files and those that must not be opened.
    """
    archive = folder if is_archive(folder) and folder.is_file() else archive_of(folder)
    if archive is None:
        return sorted(path for path in folder.iterdir() if path.is_file())
    return [member.path for member in members(archive) if member.path.parent == folder and not member.refusal]


def content(path: Path, first: int | None = None) -> bytes:
    """Return the contents of a file, or its ``first`` bytes, unpacked if it is a .gz or lies in an archive.

    Raises ``InputError`` for a file that is irregular, damaged, gone from its archive, still packed once unpacked, or larger than
    256 MiB or, above 1 MiB, 100 times its packed size; ``OSError`` if the disk cannot be read.
    """
    if archive_of(path) is not None:
        data = _from_archive(path, first)
    elif path.suffix.lower() == ".gz":
        data = _from_gzip(_from_disk(path), first)
    else:
        return _from_disk(path, first)
    if data.startswith(_MAGIC) or data[257:262] == b"ustar":
        raise InputError(_WITHIN)
    return data


def _from_disk(path: Path, first: int | None = None) -> bytes:
    """Return the contents of a file on the disk, or its ``first`` bytes; raise ``InputError`` if it is irregular or too large."""
    with whole_input(path) as (file, size):
        if size > LARGEST:
            raise InputError(f"larger than {LARGEST // 2**20} MiB{'; unpack it' if is_archive(path) else ''}")
        # read() allocates as many bytes as it is asked for
        return file.read(size if first is None else min(first, size))


def _from_gzip(data: bytes, first: int | None = None) -> bytes:
    """Return the unpacked ``data``, or its ``first`` bytes."""
    most = min(LARGEST, max(_NEVER_TOO_LARGE, _GROWTH * len(data)))
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as file:
            unpacked = file.read(most + 1 if first is None else first)
    except _DAMAGED:
        raise InputError("not a gzip file, or a damaged one; fetch it again") from None
    if len(unpacked) > most:
        raise InputError(_too_large(len(data), most))
    return unpacked


def _from_archive(path: Path, first: int | None = None) -> bytes:
    """Return the contents of a file in an archive, or its ``first`` bytes; raise ``InputError`` if gone, refused or damaged."""
    archive = next(filter(is_archive, path.parents))
    opened = _opened_archive(archive, state(archive))
    entry = opened.by_path.get(PurePosixPath(path.relative_to(archive).as_posix()))
    if entry is None:
        raise InputError("no longer in the archive")
    try:
        with entry.open() or io.BytesIO() as file:
            return file.read(entry.size if first is None else first)
    except _DAMAGED:
        raise InputError("damaged within its archive; fetch the archive again") from None


@lru_cache(maxsize=2)
def _opened_archive(archive: Path, state: tuple[int, ...]) -> _Archive:
    """Return an archive, on the disk or in another one, listed once for its ``state``; raise ``InputError`` if damaged."""
    data = _from_disk(archive) if archive_of(archive) is None else _from_archive(archive)
    if archive.name.lower().endswith(".zip"):
        entries = _zip_entries(data)
    else:
        entries = _tar_entries(_from_gzip(data) if archive.name.lower().endswith("gz") else data)
    if len(entries) > _MOST_FILES:
        raise InputError(_TOO_MANY)
    files = sorted((entry for entry in entries if entry is not None), key=lambda entry: entry.name)
    return _Archive(files, {_member_path(e.name): e for e in reversed(files) if not _refusal(e)})


def _zip_entries(data: bytes) -> list[_Entry | None]:
    """Return the files as a .zip lists them, with / for the backslash that some programs write; None for folders."""
    if not data:
        raise InputError("the file is empty")
    _refuse_long_lists(data[-_END_SIZE - _LONGEST_COMMENT :])
    try:
        packed = zipfile.ZipFile(io.BytesIO(data))
    except _DAMAGED:
        raise InputError("not a zip archive, or a damaged one; fetch it again") from None
    entries: list[_Entry | None] = []
    for info in packed.infolist():
        kind = ""
        if info.flag_bits & 1:
            kind = "encrypted; unpack it with its password"
        elif stat.S_ISLNK(info.external_attr >> 16):
            kind = "a link; unpack the archive"
        elif info.compress_type not in _READ_METHODS:
            kind = f"packed by method {info.compress_type}, which is not read; unpack it"
        name = info.filename.replace("\\", "/")
        entry = _Entry(name, info.file_size, info.compress_size, kind, partial(packed.open, info))
        entries.append(None if info.is_dir() else entry)
    return entries


def _tar_entries(data: bytes) -> list[_Entry | None]:
    """Return the files as a .tar lists them, one more than the most at most; None for folders."""
    if len(data) < _BLOCK or any(data[-_BLOCK:]):
        raise InputError("not a tar archive, or a cut one; fetch it again")
    try:
        packed = tarfile.open(fileobj=io.BytesIO(data), mode="r:")  # noqa: SIM115
        infos = list(islice(packed, _MOST_FILES + 1))
    except _DAMAGED:
        raise InputError("not a tar archive, or a damaged one; fetch it again") from None
    entries: list[_Entry | None] = []
    for info in infos:
        kind = ""
        if info.issym() or info.islnk():
            kind = "a link; unpack the archive"
        elif not info.isreg() or info.issparse() or info.size > len(data):  # more than the archive cannot be in it
            kind = "no regular file; unpack the archive"
        entry = _Entry(info.name.removeprefix("./"), info.size, info.size, kind, partial(packed.extractfile, info))
        entries.append(None if info.isdir() else entry)
    return entries


def _refuse_long_lists(tail: bytes) -> None:
    """Raise ``InputError`` if the end record of a .zip is missing, or states a list of files above 1 MiB or in ZIP64 format."""
    start = tail.rfind(_END)
    if start < 0:
        raise InputError("not a zip archive, or a cut one; fetch it again")
    listing = int.from_bytes(tail[start + 12 : start + 16], "little")
    if listing > _LISTING or _END_64 in tail[max(0, start - 20) : start]:
        raise InputError(_TOO_MANY)


def _refusal(entry: _Entry) -> str:
    """Return why a file of an archive must not be opened; empty if it may."""
    name = PurePosixPath(entry.name)
    if name.is_absolute() or not name.parts or ".." in name.parts or ":" in name.parts[0]:
        return "its name leads out of the archive; unpack it where that does no harm"
    if entry.kind:
        return entry.kind
    if any(map(is_archive, name.parents)):
        return "in a folder with the name of an archive; unpack it"
    if name.suffix.lower() in _PACKED and not is_archive(name):
        return _WITHIN
    most = min(LARGEST, max(_NEVER_TOO_LARGE, _GROWTH * entry.packed))
    return _too_large(entry.packed, most) if entry.size > most else ""


def _too_large(packed: int, most: int) -> str:
    """Return the reason to refuse a file of ``packed`` bytes that unpacks to more than ``most``."""
    if most == LARGEST:
        return f"unpacks to more than {LARGEST // 2**20} MiB"
    return f"unpacks to more than {_GROWTH} times its {packed} bytes, more than any record; unpack it yourself if it is one"


def _member_path(name: str) -> PurePosixPath:
    """Return a name in an archive as a path within it, without root and ".."; "?" if nothing else is left."""
    inside = [part for part in PurePosixPath(name).parts if part not in ("/", "//", "..")]
    return PurePosixPath(*inside) if inside else PurePosixPath("?")
