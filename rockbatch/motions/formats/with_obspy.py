"""The one door to ObsPy's readers: always with the format named.

Left to find the format itself, ``obspy.read`` unpickles files that look like a pickled Stream, which runs
their code. Bytes are handed over rather than a path, so that nothing in a file's name is taken for a pattern
or an address.
"""

import io
import warnings
from typing import TYPE_CHECKING

from rockbatch.errors import InputError
from rockbatch.motions.motion import Samples

if TYPE_CHECKING:
    from obspy import Stream


def read_stream(data: bytes, name: str) -> "Stream":
    """ObsPy's reading of ``data`` in the format ``name``; ``InputError`` where it refuses or complains."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        from obspy import read  # which warns of its own use of the standard library

        try:
            stream = read(io.BytesIO(data), format=name, check_compression=False)
        except Exception as error:  # ObsPy's readers raise all sorts of types on damaged files
            raise InputError(f"ObsPy's {name} reader refuses it: {type(error).__name__}: {error}") from None
    complaints = [str(w.message) for w in caught if not issubclass(w.category, DeprecationWarning | FutureWarning)]
    if complaints:
        raise InputError(f"damaged: ObsPy's {name} reader says: {' '.join(complaints[0].split())}")
    return stream


def without_offset(acceleration: Samples) -> tuple[Samples, str]:
    """``acceleration`` [m/s²] less its mean over the record, and the note that says so.

    The whole record, not the time before the event: it needs no picking, and the ground's velocity ends at
    zero.
    """
    offset = float(acceleration.mean())
    return acceleration - offset, f"offset {offset:.4g} m/s² removed (mean over the record)"
