"""Compilation of kernels, once for each kind of foundation."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module

from numba.core import config, event
from numba.np import linalg

from rockbatch.core.system import System
from rockbatch.pier import Base, Pier
from rockbatch.simulation.models import model, system_of


def kernel_of(pier: Pier, base: Base) -> tuple[System, bool]:
    """Return the system of ``pier`` on ``base``, and True if it has devices: runs alike in both share compiled code."""
    return system_of(model(pier, base)), bool(base.restraints)


def compiles() -> bool:
    """Return False if the user has disabled Numba's compiler."""
    return not config.DISABLE_JIT  # type: ignore[attr-defined]


def load_numba() -> None:
    """Load Numba's array functions without SciPy's linear algebra, which takes 0.2 s and is not used by the kernels.

    Numba loads it only to check that it is installed; a kernel that multiplies matrices loads it when it is compiled. Does
    nothing with a version of Numba that checks differently.
    """
    ensure_blas = getattr(linalg, "ensure_blas", None)
    if ensure_blas is None:  # a version of Numba that checks differently
        return
    linalg.ensure_blas = lambda: None
    try:
        import_module("numba.np.arraymath")
    finally:
        linalg.ensure_blas = ensure_blas


@contextmanager
def on_compilation(action: Callable[[], object]) -> Iterator[None]:
    """Call ``action`` before the first compilation in the context; never if all kernels are in the cache."""

    class FirstOnly(event.Listener):
        waits = True

        def on_start(self, _: object) -> None:
            if self.waits:
                self.waits = False
                action()

        def on_end(self, _: object) -> None:
            pass

    with event.install_listener("numba:compile", FirstOnly()):
        yield
