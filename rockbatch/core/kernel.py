"""Decorators that compile kernels: building blocks, entries from Python, and hooks that systems implement."""

import functools
import hashlib
import inspect
import pickle
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import llvmlite
import numba
import numpy as np
from numba.core.caching import _Cache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, CompileResult
from numba.core.compiler_machinery import PassManager, _pass_registry
from numba.core.registry import CPUDispatcher
from numba.core.serialize import dumps
from numba.core.typing import Signature
from numba.extending import overload, register_jitable

from rockbatch.core import kept

Function = TypeVar("Function", bound=Callable[..., object])

_CORE = Path(__file__).parent


def core_digest(folder: Path = _CORE) -> str:
    """Return the digest, 20 hexadecimal digits, of the names and contents of all kernel sources and of Numba's version.

    A kernel consists of functions of many files: after a change in any of them, no kernel on disk is used any more.
    """
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sorted(folder.rglob("*.py")):
        digest.update(source.relative_to(folder).as_posix().encode() + b"\0" + source.read_bytes() + b"\0")
    return digest.hexdigest()[:20]


_DIGEST = core_digest()
"""Digest of the sources that this process has loaded."""

_OPTIONS: dict[str, Any] = {
    "error_model": "numpy",  # a division by zero gives inf, as in every array library, and costs no branch
    "nogil": True,  # runs execute side by side in threads
    "no_cfunc_wrapper": True,  # no kernel is passed to a library in C
    "_nrt": False,  # kernels allocate nothing, and need no reference counts
}


class _NoEnvironment:
    """Ignore the environment of a library that is not loaded."""

    @staticmethod
    def set_env(*_: object) -> None:
        pass


class _PartLibrary(JITCodeLibrary):
    """Library of a building block: optimised and linked into its callers, without machine code of its own."""

    codegen = _NoEnvironment

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, _: str) -> int:
        return 0


class _OnlyPartLibrary(_PartLibrary):
    """Library of a building block with one caller: optimised only as a part of it."""

    def _optimize_final_module(self) -> None:
        pass


_UNUSED = {
    "WithLifting",
    "InlineClosureLikes",
    "RewriteDynamicRaises",
    "MakeFunctionToJitFunction",
    "InlineInlinables",
    "FindLiterallyCalls",
    "LiteralUnroll",
    "InlineOverloads",
    "NopythonRewrites",
    "DumpParforDiagnostics",
}
"""Numba's passes for features that no building block uses: closures, ``with``, array expressions, loops over literals."""


class _PartPasses(PassManager):
    """Passes of a building block, without events and checks of intermediate code, which took a tenth of all compilation."""

    def run(self, state: Any) -> None:
        """Run all passes on ``state``."""
        for kind, _ in self.passes:
            step = _pass_registry.get(kind).pass_inst
            step.analysis = self._analysis
            step.run_initialization(state)
            step.run_pass(state)
            step.run_finalizer(state)


class _PartCompiler(Compiler):
    """Compiler of a building block, without its unused machine code, which took a quarter of all compilation."""

    library = _PartLibrary

    def define_pipelines(self) -> list[PassManager]:
        """Return Numba's pipelines without :data:`_UNUSED` passes, compiling into :attr:`library`."""
        self.state.library = self.library(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
        pipelines = list[PassManager]()
        for numbas in super().define_pipelines():
            pipeline = _PartPasses(numbas.pipeline_name)
            pipeline.passes = [step for step in numbas.passes if step[0].__name__ not in _UNUSED]
            pipeline.finalize()
            pipelines.append(pipeline)
        return pipelines


class _OnlyPartCompiler(_PartCompiler):
    """Compiler of a building block with one caller."""

    library = _OnlyPartLibrary


_PART: dict[str, Any] = {"no_cpython_wrapper": True, "pipeline_class": _PartCompiler}


class _Guarded(CPUDispatcher):
    """Dispatcher of a building block, which Python calls through an entry of its own: a direct call would crash."""

    def __call__(self, *arguments: object) -> object:
        return _entry_to(self)(*arguments)


@functools.cache
def _entry_to(block: CPUDispatcher) -> Callable[..., object]:
    """Return a kernel that calls a building block, and that Python can call."""

    @numba.njit(**_OPTIONS)
    def call(*arguments):
        return block(*arguments)

    return call


def _guarded(dispatcher: Any) -> Any:
    """Return the dispatcher of a building block, made safe to call from Python; unchanged if Numba does not compile."""
    if not numba.config.DISABLE_JIT:  # type: ignore[attr-defined]
        dispatcher.__class__ = _Guarded
    return dispatcher


def kernel(function: Function) -> Function:
    """Compile a building block, which is linked into the entries that use it."""
    return _guarded(numba.njit(**_OPTIONS | _PART)(function))


def inlined(function: Function) -> Function:
    """Compile a function that is inlined into its callers, so that loops over it can be vectorised."""
    return _guarded(numba.njit(forceinline=True, **_OPTIONS | _PART)(function))


def inlined_once(function: Function) -> Function:
    """Compile a building block that is inlined into its only caller, and optimised only there."""
    return _guarded(numba.njit(forceinline=True, **_OPTIONS | _PART | {"pipeline_class": _OnlyPartCompiler})(function))


def shared(function: Function) -> Function:
    """Let kernels use a function that Python calls uncompiled, since few calls are not worth a compilation in each process."""
    decorated: Function = register_jitable(**_OPTIONS)(function)
    return decorated


_SWITCHES = ("OPT", "LOOP_VECTORIZE", "SLP_VECTORIZE", "ENABLE_AVX", "USING_SVML", "BOUNDSCHECK", "DEBUGINFO_DEFAULT")
"""Settings of Numba that change the machine code."""


class _Kept(_Cache):
    """Machine code of an entry on disk, found by a digest of the sources, wherever these are (:mod:`kept`)."""

    def __init__(self, function: Callable[..., object]):
        if function.__closure__:
            raise TypeError(f"{function.__qualname__}: the machine code of a closure cannot be kept: give it arguments")
        self._function, self._enabled = function, True
        self._sources = _DIGEST, self._own_digest()

    def _own_digest(self) -> str:
        """Return the digest of the file of the function, which may be outside of the core."""
        return hashlib.sha256(Path(inspect.getfile(self._function)).read_bytes()).hexdigest()

    def _identity(self, signature: Signature, codegen: Any) -> str:
        """Return a text of everything that the machine code of a signature depends on, the same in every process."""
        function = self._function
        compiler = (sys.version, numba.__version__, llvmlite.__version__, np.__version__, *codegen.magic_tuple())
        switches = [str(getattr(numba.config, name, "")) for name in _SWITCHES]
        return repr((self._sources, compiler, switches, function.__module__, function.__qualname__, str(signature)))

    def _name(self, identity: str) -> str:
        """Return the name of the kernel's file without its suffix: the function's name and a digest of ``identity``."""
        return f"{self._function.__name__}-{hashlib.sha256(identity.encode()).hexdigest()[:40]}"

    @property
    def cache_path(self) -> str:
        """Return the path of the cache folder, as ``_Cache`` does."""
        return str(kept.folder())

    def load_overload(self, sig: Signature, target_context: Any) -> CompileResult | None:
        """Return the machine code kept for a signature; None if there is none that fits and is intact, or if disabled."""
        target_context.refresh()
        identity = self._identity(sig, target_context.codegen())
        content = kept.read(self._name(identity), identity) if self._enabled else None
        if content is None:
            return None
        signature, parts = pickle.loads(content)
        # The texts of two signatures may be equal though they differ, by named tuples of the same name in two modules
        return CompileResult._rebuild(target_context, *parts) if signature == sig else None

    def save_overload(self, sig: Signature, data: Any) -> None:
        """Keep the machine code ``data`` of a signature on disk.

        Nothing is kept if the sources have changed since they were loaded, if the code refers to addresses of this process, or if
        disabled.
        """
        changed = (core_digest(), self._own_digest()) != self._sources
        if changed or data.library.has_dynamic_globals or not self._enabled:
            return
        identity = self._identity(sig, data.codegen)
        kept.keep(self._name(identity), identity, dumps((sig, data._reduce())))

    def enable(self) -> None:
        """Let kernels be loaded and kept from now on."""
        self._enabled = True

    def disable(self) -> None:
        """Let no kernel be loaded or kept from now on."""
        self._enabled = False

    def flush(self) -> None:
        """Do nothing: there is no index of files to clear."""


def entry(function: Function) -> Function:
    """Compile a function that Python calls, and keep the machine code on disk.

    Raises ``TypeError`` for a closure.
    """
    dispatcher: Any = numba.njit(**_OPTIONS)(function)
    if not numba.config.DISABLE_JIT:  # type: ignore[attr-defined]
        dispatcher._cache = _Kept(function)
    compiled: Function = dispatcher
    return compiled


def hook(stub: Callable[..., object]) -> Any:
    """Return a function that each system implements; the type of its first argument selects the implementation.

    ``stub`` has the arguments and the docstring; ``@stub.of(Model)`` registers the implementation for systems described by the
    named tuple ``Model``, or for ``type(None)``. The selection is made in compilation, so that a driver that calls a hook knows
    no system by name and costs nothing more, and a missing implementation fails there. Implementations are inlined, so that loops
    over lanes can be vectorised.
    """
    return _hook(stub, None)


def optional_hook(default: Callable[..., object]) -> Any:
    """Return a function as :func:`hook`; ``default`` is used for systems without an implementation."""
    return _hook(default, default)


def _hook(stub: Callable[..., object], default: Callable[..., object] | None) -> Any:
    implementations: dict[type, Callable[..., object] | None] = {}

    @functools.wraps(stub)
    def call(system: object, *rest: object) -> object:
        implementation = implementations.get(type(system), default)
        assert implementation is not None, f"{stub.__name__} is not implemented for {type(system).__name__}"
        return implementation(system, *rest)

    def choose(system: object, *rest: object) -> Callable[..., object] | None:
        if isinstance(system, numba.types.NoneType):
            return implementations.get(type(None), default)
        return implementations.get(getattr(system, "instance_class", object), default)

    def of(described_by: type) -> Callable[[Function], Any]:
        def register(implementation: Function) -> Any:
            implementations[described_by] = implementation
            return call

        return register

    choose.__signature__ = inspect.signature(stub)  # type: ignore[attr-defined]
    call.of = of  # type: ignore[attr-defined]
    options: Any = _OPTIONS | _PART | {"forceinline": True}
    overload(call, jit_options=options, strict=False)(choose)
    return call
