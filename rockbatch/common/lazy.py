"""Packages and names imported at first use, since they load slowly: ``from rockbatch.common.lazy import pd``."""

from collections.abc import Callable, Mapping
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any


class _Lazy(ModuleType):
    """Stand-in for a module that is imported at the first attribute access."""

    def __getattr__(self, name: str) -> Any:
        value = vars(self)[name] = getattr(import_module(self.__name__), name)
        return value


if TYPE_CHECKING:
    import h5py as h5py
    import obspy as obspy
    import pandas as pd
else:
    h5py, obspy, pd = map(_Lazy, ("h5py", "obspy", "pandas"))


def loading(package: str, homes: Mapping[str, str]) -> Callable[[str], Any]:
    """Return the ``__getattr__`` of a package, which loads a public name from its module at first use.

    ``homes`` maps names to modules; the function raises ``AttributeError`` for other names.
    """

    def load(name: str) -> Any:
        if name in homes:
            return getattr(import_module(homes[name]), name)
        raise AttributeError(f"module '{package}' has no attribute '{name}'")

    return load
