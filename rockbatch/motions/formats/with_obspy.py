"""The only access to ObsPy's readers: always with the format named, and after a check of the file.

Left to recognise the format, ``obspy.read`` unpickles files that look like a pickled Stream, which runs their code. Bytes are
passed rather than a path, so that nothing in a file's name is taken for a pattern or an address.

ObsPy's readers trust headers: a blockette of length 0 is an endless loop. So each format has a check here, which raises
``InputError`` for impossible values.
"""

import io
import re
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np

from rockbatch.common.errors import InputError, Truncated
from rockbatch.common.lazy import obspy

_ADDRESS = re.compile(r"<[\w.]+ object at 0x[0-9a-fA-F]+>")  # changes from run to run

_DATA, _CONTROL = b"DRQM", b"VAST"  # kinds of records in a SEED volume
_FIXED = 48  # bytes of a data record's fixed header
_LENGTHS = range(7, 21)  # of records, as powers of 2
_LENGTH_IN = (b"005", b"008", b"010")  # the blockettes of a volume that tell the length of its records
_BLOCKETTE = re.compile(rb"[0-9]{7}")  # three digits of type, four of length


def check_mseed(data: bytes) -> bytes:
    """Return MiniSEED, or a SEED volume, unchanged; raise ``InputError`` if its first data record is missing or impossible.

    Impossible are a day, hour, minute or second, a chain of blockettes, and a length of records, also one of a volume.
    """
    start = 0
    if data[6:7] in _CONTROL:
        length = 2 ** _volume_exponent(data)
        kinds = (data[offset + 6 : offset + 7] for offset in range(0, len(data), length))
        start = length * next((i for i, kind in enumerate(kinds) if kind and kind in _DATA), len(data))
    _data_record(data[start : start + 2 ** max(_LENGTHS)])
    return data


def _volume_exponent(data: bytes) -> int:
    """Return log₂ of the length of a volume's records, by its first blockettes; raise ``InputError`` if missing or impossible."""
    offset = 8
    while _BLOCKETTE.match(data, offset):
        kind, length = data[offset : offset + 3], int(data[offset + 3 : offset + 7])
        if kind in _LENGTH_IN:
            digits = data[offset + 11 : offset + 13]
            if not digits.isdigit() or int(digits) not in _LENGTHS:
                raise InputError(f'SEED volume: records of 2^"{digits.decode("latin-1")}" bytes; expected 07 to 20')
            return int(digits)
        if length <= 7:
            raise InputError(f"SEED volume: a blockette of {length} bytes; expected more than 7: it is damaged")
        offset += length
    raise InputError("SEED volume: no blockette states the length of its records; fetch MiniSEED instead")


def _data_record(record: bytes) -> None:
    """Raise ``InputError`` unless bytes begin with a data record of possible day, time, chain of blockettes and length."""
    if len(record) < _FIXED or record[6:7] not in _DATA:
        raise Truncated("holds no whole data record; fetch it again")
    order = ">" if 1 <= int.from_bytes(record[22:24], "big") <= 366 else "<"
    header = np.frombuffer(record[:_FIXED], f"{order}u2")  # of 16-bit words; bytes 24 to 27 are hour, minute, second
    hour, minute, second = record[24:27]
    if hour > 23 or minute > 59 or second > 60 or not 1 <= header[11] <= 366:
        raise InputError(f"MiniSEED header: day {header[11]}, {hour}:{minute}:{second} is no time: it is damaged")
    offset, previous = int(header[23]), 0
    while offset:
        if offset < max(_FIXED, previous + 4) or offset + 7 > len(record):
            raise InputError(f"MiniSEED header: a blockette at byte {offset}, after one at {previous}: it is damaged")
        kind, following = (int(word) for word in np.frombuffer(record[offset : offset + 4], f"{order}u2"))
        if kind == 1000 and record[offset + 6] not in _LENGTHS:
            raise InputError(
                f"MiniSEED header: records of 2^{record[offset + 6]} bytes; expected 2^7 to 2^20: it is damaged"
            )
        offset, previous = following, offset


_TAG = 16  # bytes of the tag before each header and frame of an .evt
_HEADERS = (2040, 2736)  # bytes of its file header: of K2 and of the newer ones


def is_evt(head: bytes) -> bool:
    """Return whether the first bytes are the tag of the header of a Kinemetrics .evt."""
    return (
        len(head) >= _TAG and head[:1] == b"K" and head[1] in (0, 1) and _tag(head, 0)[:2] in {(1, n) for n in _HEADERS}
    )


def _tag(data: bytes, at: int) -> tuple[int, int, int]:
    """Return the type of a frame and the lengths of its header and data [bytes], by the tag at byte ``at``."""
    order = ">" if data[at + 1] == 1 else "<"
    (kind,) = np.frombuffer(data, f"{order}u4", 1, at + 4)
    length, of_data = np.frombuffer(data, f"{order}u2", 2, at + 8)
    return int(kind), int(length), int(of_data)


def check_evt(data: bytes) -> bytes:
    """Return an .evt unchanged; raise ``InputError`` unless its tags lead from one to the next up to its end, or zeros."""
    at = 0
    while at < len(data):
        if data[at : at + 1] == b"\0" and not any(data[at : at + _TAG]):
            break  # zeros that recorders write after the last frame
        if len(data) < at + _TAG or data[at : at + 1] != b"K" or data[at + 1] > 1:
            raise Truncated(f".evt: no tag at byte {at}: it is cut, or damaged")
        kind, length, of_data = _tag(data, at)
        if (kind == 1) != (at == 0) or at + _TAG + length + of_data > len(data):
            raise Truncated(f".evt: a frame of {length} and {of_data} bytes at byte {at}: it is cut, or damaged")
        at += _TAG + length + of_data
    return data


_OF_TRIGGERS = ("chan_lta", "chan_sta")

CHECKS: dict[str, Callable[[bytes], bytes]] = {"MSEED": check_mseed, "KINEMETRICS_EVT": check_evt}
"""Checks by ObsPy's name of the format."""


@contextmanager
def _collecting_unraisable() -> Iterator[list[str]]:
    """Context manager: yield a list of errors that ObsPy's callbacks from C cannot raise, and Python would print."""
    errors: list[str] = []
    hook = sys.unraisablehook
    sys.unraisablehook = lambda unraised: errors.append(f"{type(unraised.exc_value).__name__}: {unraised.exc_value}")
    try:
        yield errors
    finally:
        sys.unraisablehook = hook


def _is_harmless(warning: warnings.WarningMessage, name: str) -> bool:
    """Return whether a warning is not about the samples: about ObsPy's use of libraries, or settings of a trigger."""
    if issubclass(warning.category, DeprecationWarning | FutureWarning):
        return True
    return name == "KINEMETRICS_EVT" and str(warning.message).startswith(_OF_TRIGGERS)


def read_stream(data: bytes, name: str) -> "obspy.Stream":
    """Return ``data`` in the format ``name`` as read by ObsPy; raise ``InputError`` for damage, or if ObsPy warns of anything."""
    data = CHECKS[name](data)
    with warnings.catch_warnings(record=True) as caught, _collecting_unraisable() as unraised:
        warnings.simplefilter("always")
        try:
            stream = obspy.read(io.BytesIO(data), format=name, check_compression=False)
        except Exception as error:  # ObsPy's readers raise errors of any type on damaged files
            message = _ADDRESS.sub("the file", str(error))
            raise InputError(f"ObsPy's {name} reader refuses it: {type(error).__name__}: {message}") from None
    complaints = [str(w.message) for w in caught if not _is_harmless(w, name)]
    complaints += unraised
    if complaints:
        raise InputError(f"damaged: ObsPy's {name} reader says: {' '.join(complaints[0].split())}")
    return stream
