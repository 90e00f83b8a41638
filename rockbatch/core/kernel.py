"""Decorators that compile kernels: one for building blocks, one for entries, one for hooks that systems implement."""

import atexit
import contextlib
import functools
import hashlib
import inspect
import shutil
import tempfile
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.registry import CPUDispatcher
from numba.extending import overload, register_jitable

_CORE = Path(__file__).parent


def core_digest(folder: Path = _CORE) -> str:
    """Return the digest of all kernel sources and of the compiler's version.

    Numba's own cache looks only at the file of the function that is called: after a change in a function that it
    calls, it would go on with the old physics. The cache folder therefore bears this digest.
    """
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sorted(folder.rglob("*.py")):
        digest.update(source.relative_to(folder).as_posix().encode() + b"\0" + source.read_bytes() + b"\0")
    return digest.hexdigest()[:20]


def _usable_folder() -> str:
    """Return the first writable folder: beside the sources, in the user's cache, or a temporary one of this process."""
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


class _NoEnvironment:
    """Take the environment of a library that is not loaded."""

    @staticmethod
    def set_env(*_: object) -> None:
        pass


class _PartLibrary(JITCodeLibrary):
    """Library of a building block: optimised, to be linked into its callers, and never turned into machine code by itself."""

    codegen = _NoEnvironment

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, _: str) -> int:
        return 0


class _OnlyPartLibrary(_PartLibrary):
    """Library of a building block with one caller: optimised there only, with what is around it."""

    def _optimize_final_module(self) -> None:
        pass


_UNUSED = {
    "WithLifting", "InlineClosureLikes", "RewriteDynamicRaises", "MakeFunctionToJitFunction", "InlineInlinables",
    "FindLiterallyCalls", "LiteralUnroll", "InlineOverloads", "NopythonRewrites", "DumpParforDiagnostics",
}  # fmt: skip
"""Numba's passes over what no building block has: closures, blocks of ``with``, array expressions, loops over literals."""


class _PartCompiler(Compiler):
    """Compiler of a building block, whose machine code nobody calls: making it took a quarter of all compilation."""

    library = _PartLibrary

    def define_pipelines(self) -> list[Any]:
        self.state.library = self.library(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
        pipelines: list[Any] = super().define_pipelines()
        for pipeline in pipelines:
            pipeline.passes[:] = [step for step in pipeline.passes if step[0].__name__ not in _UNUSED]
            pipeline.finalize()
        return pipelines


class _OnlyPartCompiler(_PartCompiler):
    """Compiler of a building block with one caller."""

    library = _OnlyPartLibrary


_PART: dict[str, Any] = {"no_cpython_wrapper": True, "pipeline_class": _PartCompiler}


class _Guarded(CPUDispatcher):
    """Dispatcher of a building block that Python calls through a kernel made for it: as it is, a call would end the process."""

    def __call__(self, *arguments: Any) -> Any:
        return _entry_to(self)(*arguments)


@functools.cache
def _entry_to(block: Any) -> Any:
    @numba.njit(**_OPTIONS)
    def call(*arguments):
        return block(*arguments)

    return call


def _guarded(dispatcher: Any) -> Any:
    if not numba.config.DISABLE_JIT:  # type: ignore[attr-defined]
        dispatcher.__class__ = _Guarded
    return dispatcher


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a building block; it is linked into the entries that use it."""
    return _guarded(numba.njit(**_OPTIONS | _PART)(function))


def inlined(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a building block that becomes part of its callers: loops over it can be turned into vector code."""
    return _guarded(numba.njit(forceinline=True, **_OPTIONS | _PART)(function))


def inlined_once(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a building block that becomes part of its only caller, and is optimised there only."""
    return _guarded(numba.njit(forceinline=True, **_OPTIONS | _PART | {"pipeline_class": _OnlyPartCompiler})(function))


def summing(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a building block that sums over an array in any order, which vector instructions need: the last digits depend on it."""
    return _guarded(numba.njit(fastmath={"reassoc", "nsz", "contract"}, **_OPTIONS | _PART)(function))


def shared(function: Callable[..., Any]) -> Callable[..., Any]:
    """Let kernels use a function that Python calls too, uncompiled: few calls are not worth a compilation each process."""
    decorated: Callable[..., Any] = register_jitable(**_OPTIONS)(function)
    return decorated


def entry(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function that Python calls, and keep the machine code on disk."""
    settings: Any = numba.config
    folder = settings.CACHE_DIR
    settings.CACHE_DIR = CACHE_FOLDER
    try:
        dispatcher: Any = numba.njit(cache=True, **_OPTIONS)(function)
    finally:
        settings.CACHE_DIR = folder
    with contextlib.suppress(AttributeError):  # uncompiled, or a Numba that keeps its cache otherwise
        # Numba numbers the files: two processes that compile at a time would take one number, and one the other's code
        dispatcher._cache._cache_file._data_name_pattern = f"{function.__name__}-{uuid.uuid4().hex}.{{number:d}}.nbc"
    return dispatcher


def hook(stub: Callable[..., Any]) -> Any:
    """Let each system implement a function; the type of the first argument chooses the implementation when compiled.

    ``stub`` has the arguments and says what the function does; ``@stub.of(Model)`` registers the implementation for systems
    described by the named tuple ``Model``, or for ``type(None)``: nothing. A driver that calls it knows no system by name, and
    its machine code is that of the implementation written out. Implementations become part of their callers, so that loops
    over lanes can be turned into vector code.
    """
    return _hook(stub, None)


def optional_hook(default: Callable[..., Any]) -> Any:
    """Let systems implement a function as those of :func:`hook`; ``default`` serves the others."""
    return _hook(default, default)


def _hook(stub: Callable[..., Any], default: Any) -> Any:
    implementations: dict[type, Callable[..., Any]] = {}

    @functools.wraps(stub)
    def call(system: Any, *rest: Any) -> Any:
        return implementations.get(type(system), default)(system, *rest)

    def choose(system: Any, *rest: Any) -> Any:
        described_by = (
            type(None) if isinstance(system, numba.types.NoneType) else getattr(system, "instance_class", object)
        )
        return implementations.get(described_by, default)

    def of(described_by: type) -> Callable[[Callable[..., Any]], Any]:
        def register(implementation: Callable[..., Any]) -> Any:
            implementations[described_by] = implementation
            return call

        return register

    choose.__signature__ = inspect.signature(stub)  # type: ignore[attr-defined]
    call.of = of  # type: ignore[attr-defined]
    options: Any = _OPTIONS | _PART | {"forceinline": True}
    overload(call, jit_options=options, strict=False)(choose)
    return call
