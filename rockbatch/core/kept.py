"""Files of machine code in the user's cache folder: one for each kernel, named by a digest of its sources.

A file begins with the digest of its identity and contents. A truncated, damaged or foreign file does not match and counts as
missing, and so does one that another user could have written, since unpickling runs code. Files are written under another
name and renamed, so that processes that compile at the same time do not disturb each other.
"""

import contextlib
import errno
import hashlib
import os
import stat
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

MOST_BYTES = 500_000_000
"""Greatest size of the cache: beyond it the least recently used kernels are dropped."""
UNUSED_DAYS = 60
"""Days without use after which a kernel is dropped: mostly those of older versions."""

_DAY = 86_400.0
_SUFFIX, _UNFINISHED = ".kernel", ".unfinished"
_MAGIC = b"rockbatch kernel 1\n"
_OTHERS = stat.S_IWGRP | stat.S_IWOTH
_PLAIN_ONLY = sum(getattr(os, flag, 0) for flag in ("O_NOFOLLOW", "O_NONBLOCK", "O_CLOEXEC", "O_BINARY"))


class KernelFile(NamedTuple):
    """A file of the cache, or an unfinished one of a process that ended."""

    path: Path
    size: int  # [bytes]
    used: float  # time of last use [s since the epoch], exact to a day


class _State:
    """Reason that this process could not keep a kernel, and whether it was reported."""

    reason = ""
    reported = False


def folder() -> Path:
    """Return the cache folder: ROCKBATCH_CACHE, or ``rockbatch`` in the user's cache folder; it may not exist yet.

    The user's is XDG_CACHE_HOME if that is absolute, else ``~/.cache``. Raises ``FileNotFoundError`` if that needs a home folder
    and there is none.
    """
    try:
        if chosen := os.environ.get("ROCKBATCH_CACHE"):
            return Path(chosen).expanduser().absolute()
        caches = Path(os.environ.get("XDG_CACHE_HOME", ""))
        return (caches if caches.is_absolute() else Path.home() / ".cache") / "rockbatch"
    except RuntimeError:
        raise FileNotFoundError(errno.ENOENT, "there is no home folder", "~") from None


def read(name: str, identity: str) -> bytes | None:
    """Return the content kept for ``identity``; None if it is missing, unreadable, damaged or distrusted.

    Mark it as used, unless it was within a day.
    """
    try:
        path = _trusted(folder()) / f"{name}{_SUFFIX}"
        with open(os.open(path, os.O_RDONLY | _PLAIN_ONLY), "rb") as file:
            status = os.fstat(file.fileno())
            if not stat.S_ISREG(status.st_mode) or _others_write(status):
                return None
            content = file.read()
    except OSError:
        return None
    head = len(_MAGIC) + hashlib.sha256().digest_size
    if content[:head] != _head(identity, content[head:]):
        return None
    if time.time() - status.st_mtime > _DAY:
        with contextlib.suppress(OSError):  # a folder that is only read
            os.utime(path)
    return content[head:]


def keep(name: str, identity: str, content: bytes) -> None:
    """Write ``content`` for :func:`read`, and drop old kernels; an ``OSError`` is not raised but left to :func:`unreported`."""
    try:
        path = _made() / f"{name}{_SUFFIX}"
        _replace(path, _head(identity, content) + content)
        _drop_old(path)
    except OSError as error:
        _State.reason = f"{error.filename or path.parent}: {error.strerror or error}"


def usable() -> bool:
    """Return True if this process can write to the cache folder, which is made if need be."""
    try:
        return os.access(_made(), os.W_OK)
    except OSError:
        return False


def unreported() -> str:
    """Return why this process could not keep a kernel, at the first call after the first failure only; else ""."""
    if _State.reported or not _State.reason:
        return ""
    _State.reported = True
    return (
        f"compiled kernels are not kept, and the next command compiles them again: {_State.reason}; "
        "`export ROCKBATCH_CACHE=FOLDER` names another folder"
    )


def files() -> list[KernelFile]:
    """Return the kernels and unfinished files in the cache folder, least recently used first; [] without a folder."""
    found = []
    with contextlib.suppress(FileNotFoundError):
        for entry in os.scandir(folder()):
            with contextlib.suppress(FileNotFoundError):  # another process has dropped it
                if entry.name.endswith((_SUFFIX, _UNFINISHED)) and entry.is_file(follow_symlinks=False):
                    status = entry.stat(follow_symlinks=False)
                    found.append(KernelFile(Path(entry.path), status.st_size, status.st_mtime))
    return sorted(found, key=lambda file: file.used)


def clear() -> list[KernelFile]:
    """Remove all kernels and unfinished files, but no others in the folder; return the removed ones."""
    removed = files()
    for file in removed:
        file.path.unlink(missing_ok=True)
    return removed


def _head(identity: str, content: bytes) -> bytes:
    """Return the first bytes of a file: a mark and the digest of ``identity`` and ``content``."""
    digest = hashlib.sha256(hashlib.sha256(identity.encode()).digest())
    digest.update(content)
    return _MAGIC + digest.digest()


def _others_write(status: os.stat_result) -> bool:
    """Return True if the owner is neither this user nor root, or if group or others may write; always False on Windows."""
    return hasattr(os, "geteuid") and (status.st_uid not in (os.geteuid(), 0) or bool(status.st_mode & _OTHERS))


def _trusted(home: Path) -> Path:
    """Return ``home``; raise ``PermissionError`` if others than this user and root may write into that folder."""
    if _others_write(os.stat(home)):
        remedy = "others may write into this folder; `chmod go-w` ends that if it is yours"
        raise PermissionError(errno.EPERM, remedy, str(home))
    return home


def _made() -> Path:
    """Return the cache folder, which is made if need be; raise ``PermissionError`` as :func:`_trusted`."""
    home = folder()
    home.mkdir(mode=0o700, parents=True, exist_ok=True)
    return _trusted(home)


def _replace(path: Path, content: bytes) -> None:
    """Write a file under a temporary name, and rename it to ``path``; after a failure remove it and raise."""
    handle, unfinished = tempfile.mkstemp(_UNFINISHED, f"{path.stem}-", path.parent)
    try:
        with open(handle, "wb") as file:
            file.write(content)
        os.replace(unfinished, path)
    except BaseException:  # an interrupt, too
        with contextlib.suppress(OSError):
            os.unlink(unfinished)
        raise


def _drop_old(newest: Path) -> None:
    """Remove files unused for UNUSED_DAYS, unfinished ones after a day, and beyond MOST_BYTES the least recently used.

    ``newest`` is never removed.
    """
    every, now = files(), time.time()
    total = sum(file.size for file in every)
    for file in every:
        days = UNUSED_DAYS if file.path.suffix == _SUFFIX else 1.0
        if file.path != newest and (total > MOST_BYTES or now - file.used > days * _DAY):
            file.path.unlink(missing_ok=True)
            total -= file.size
