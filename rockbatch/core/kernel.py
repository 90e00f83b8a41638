"""Decorators that compile kernels: one for building blocks, one for entries, one for hooks that systems implement."""

import functools
import hashlib
import inspect
import pickle
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import llvmlite
import numba
import numpy as np
from numba.core.caching import _Cache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompileResult
from numba.core.registry import CPUDispatcher
from numba.core.serialize import dumps
from numba.extending import overload, register_jitable

from rockbatch.core import kept

_CORE = Path(__file__).parent


def core_digest(folder: Path = _CORE) -> str:
    """Return the digest of all kernel sources and of the compiler's version.

    A kernel is made of many functions of many files: after a change in any of them, none that was compiled before is used.
    """
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sorted(folder.rglob("*.py")):
        digest.update(source.relative_to(folder).as_posix().encode() + b"\0" + source.read_bytes() + b"\0")
    return digest.hexdigest()[:20]


_DIGEST = core_digest()
"""As the sources are that this process loads."""

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
    """Compile a building block that sums over an array in any order, as vector instructions do: the last digits depend on it."""
    return _guarded(numba.njit(fastmath={"reassoc", "nsz", "contract"}, **_OPTIONS | _PART)(function))


def shared(function: Callable[..., Any]) -> Callable[..., Any]:
    """Let kernels use a function that Python calls too, uncompiled: few calls are not worth a compilation each process."""
    decorated: Callable[..., Any] = register_jitable(**_OPTIONS)(function)
    return decorated


_SWITCHES = ("OPT", "LOOP_VECTORIZE", "SLP_VECTORIZE", "ENABLE_AVX", "USING_SVML", "BOUNDSCHECK", "DEBUGINFO_DEFAULT")
"""Settings of Numba that change machine code."""


class _Kept(_Cache):
    """Machine code of an entry on disk, found by its content: by any copy of the sources, at any place (:mod:`kept`)."""

    def __init__(self, function: Callable[..., Any]):
        if function.__closure__:
            raise TypeError(f"{function.__qualname__}: the machine code of a closure cannot be kept: give it arguments")
        self._function, self._enabled = function, True
        self._sources = _DIGEST, self._own_digest()

    def _own_digest(self) -> str:
        """Return the digest of the function's own file, which need not be in the core."""
        return hashlib.sha256(Path(inspect.getfile(self._function)).read_bytes()).hexdigest()

    def _identity(self, signature: Any, codegen: Any) -> str:
        """Return all that the machine code of a signature depends on, in words that are the same in every process."""
        function = self._function
        compiler = (sys.version, numba.__version__, llvmlite.__version__, np.__version__, *codegen.magic_tuple())
        switches = [str(getattr(numba.config, name, "")) for name in _SWITCHES]
        return repr((self._sources, compiler, switches, function.__module__, function.__qualname__, str(signature)))

    def _name(self, identity: str) -> str:
        return f"{self._function.__name__}-{hashlib.sha256(identity.encode()).hexdigest()[:40]}"

    @property
    def cache_path(self) -> str:
        """See ``_Cache``."""
        return str(kept.folder())

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """See ``_Cache``."""
        target_context.refresh()
        identity = self._identity(sig, target_context.codegen())
        content = kept.read(self._name(identity), identity) if self._enabled else None
        if content is None:
            return None
        signature, parts = pickle.loads(content)
        # Types of the same name may differ: named tuples of two modules
        return CompileResult._rebuild(target_context, *parts) if signature == sig else None

    def save_overload(self, sig: Any, data: Any) -> None:
        """See ``_Cache``; what was compiled from sources that were changed after they were loaded is not kept."""
        changed = (core_digest(), self._own_digest()) != self._sources
        if changed or data.library.has_dynamic_globals or not self._enabled:
            return
        identity = self._identity(sig, data.codegen)
        kept.keep(self._name(identity), identity, dumps((sig, data._reduce())))

    def enable(self) -> None:
        """See ``_Cache``."""
        self._enabled = True

    def disable(self) -> None:
        """See ``_Cache``."""
        self._enabled = False

    def flush(self) -> None:
        """See ``_Cache``: nothing is held back."""


def entry(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function that Python calls, and keep the machine code on disk."""
    dispatcher: Any = numba.njit(**_OPTIONS)(function)
    if not numba.config.DISABLE_JIT:  # type: ignore[attr-defined]
        dispatcher._cache = _Kept(function)
    compiled: Callable[..., Any] = dispatcher
    return compiled


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
