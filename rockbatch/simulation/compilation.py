"""Compilation of kernels, which takes long and happens once for each kind of foundation."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from numba.core import config, event
from numba.np import linalg

from rockbatch.core.system import System
from rockbatch.pier import Base, Pier
from rockbatch.simulation.models import model, system_of


def kernel_of(pier: Pier, base: Base) -> tuple[System, bool]:
    """Return what runs of ``pier`` on ``base`` are compiled for: their system, and whether there are devices."""
    return system_of(model(pier, base)), bool(base.restraints)


def compiles() -> bool:
    """Return whether Numba compiles at all, or its users have disabled that."""
    return not config.DISABLE_JIT  # type: ignore[attr-defined]


def load_numba() -> None:
    """Load Numba's functions of arrays without SciPy's linear algebra, which takes 0.2 s and serves no kernel.

    Numba loads it only to see whether it is installed; a function that multiplies matrices loads it when it is compiled.
    """
    look: Any = getattr(linalg, "ensure_blas", None)
    if look is None:  # a Numba that looks for it otherwise
        return
    linalg.ensure_blas = lambda: None
    try:
        import_module("numba.np.arraymath")
    finally:
        linalg.ensure_blas = look


@contextmanager
def on_compilation(action: Callable[[], object]) -> Iterator[None]:
    """Call ``action`` once if anything has to be compiled meanwhile, before that begins; not if kernels are in the cache."""

    class FirstOnly(event.Listener):
        waits = True

        def on_start(self, _: Any) -> None:
            if self.waits:
                self.waits = False
                action()

        def on_end(self, _: Any) -> None:
            pass

    with event.install_listener("numba:compile", FirstOnly()):
        yield
