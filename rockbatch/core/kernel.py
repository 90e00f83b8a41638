"""How kernels are compiled: one decorator for every function of the core, and one for those that Python calls."""

import atexit
import hashlib
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba

_CORE = Path(__file__).parent


def core_digest(folder: Path = _CORE) -> str:
    """Digest of all kernel sources and of the compiler's version.

    Numba's own cache looks only at the file of the function that is called: after a change in a function that it
    calls, it would go on with the old physics. The cache folder therefore bears this digest.
    """
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sorted(folder.rglob("*.py")):
        digest.update(source.relative_to(folder).as_posix().encode() + b"\0" + source.read_bytes() + b"\0")
    return digest.hexdigest()[:20]


def _usable_folder() -> str:
    """First of: beside the sources, the user's cache, a temporary folder for this process, that can be written to."""
    name = f"kernels-{core_digest()}"
    for parent in (lambda: _CORE / "__pycache__", lambda: Path.home() / ".cache" / "rockbatch"):
        try:
            folder = parent() / name
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
        except (OSError, RuntimeError):  # the latter where nobody is at home
            continue
        return str(folder)
    temporary = tempfile.mkdtemp(prefix=name)
    atexit.register(shutil.rmtree, temporary, ignore_errors=True)
    return temporary


CACHE_FOLDER = _usable_folder()

_OPTIONS: dict[str, Any] = {
    "error_model": "numpy",  # a division by zero gives inf, as in every array library, and costs no branch
    "nogil": True,  # runs go side by side in threads
    "no_cfunc_wrapper": True,  # none is handed to a library in C
    "_nrt": False,  # kernels allocate nothing, and need not count who else holds their arrays
}


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a building block; it is inlined into the entries that use it."""
    return numba.njit(**_OPTIONS)(function)


def inlined(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a building block that becomes part of its callers: loops over it can be turned into vector code."""
    return numba.njit(forceinline=True, **_OPTIONS)(function)


def entry(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function that Python calls, and keep the machine code on disk."""
    settings: Any = numba.config
    folder = settings.CACHE_DIR
    settings.CACHE_DIR = CACHE_FOLDER
    try:
        return numba.njit(cache=True, **_OPTIONS)(function)
    finally:
        settings.CACHE_DIR = folder
