"""The one door to ObsPy's readers: always with the format named.

Left to find the format itself, ``obspy.read`` unpickles files that look like a pickled Stream, which runs
their code. Bytes are handed over rather than a path, so that nothing in a file's name is taken for a pattern
or an address, and after a look at the header (``before_obspy``).
"""

import io
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rockbatch.errors import InputError
from rockbatch.motions.formats.before_obspy import CHECKS

if TYPE_CHECKING:
    from obspy import Stream


_OPTIONS = {"SAC": {"round_sampling_interval": False}}  # rounding a step of four bytes, ObsPy warns of 1/512 s


@contextmanager
def _unraisable() -> Iterator[list[str]]:
    """Collects errors that ObsPy's callbacks from C cannot raise; Python would print them on the terminal."""
    found: list[str] = []
    before = sys.unraisablehook
    sys.unraisablehook = lambda unraised: found.append(f"{type(unraised.exc_value).__name__}: {unraised.exc_value}")
    try:
        yield found
    finally:
        sys.unraisablehook = before


def read_stream(data: bytes, name: str) -> "Stream":
    """ObsPy's reading of ``data`` in the format ``name``; ``InputError`` where its header cannot be, or ObsPy complains."""
    data = CHECKS[name](data)
    with warnings.catch_warnings(record=True) as caught, _unraisable() as unraised:
        warnings.simplefilter("always")
        from obspy import read  # which warns of its own use of the standard library

        try:
            stream = read(io.BytesIO(data), format=name, check_compression=False, **_OPTIONS.get(name, {}))
        except Exception as error:  # ObsPy's readers raise all sorts of types on damaged files
            raise InputError(f"ObsPy's {name} reader refuses it: {type(error).__name__}: {error}") from None
    complaints = [str(w.message) for w in caught if not issubclass(w.category, DeprecationWarning | FutureWarning)]
    complaints += unraised
    if complaints:
        raise InputError(f"damaged: ObsPy's {name} reader says: {' '.join(complaints[0].split())}")
    return stream
