"""Readers as ObsPy waveform plugins, from a path or file-like object to a Stream.

A format's module makes its two entry points by ``is_x, read_x = plugin("X", …)``; pyproject.toml registers them.
"""

import codecs
import os
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import BinaryIO

from rockbatch.common.errors import InputError, placed
from rockbatch.common.lazy import obspy
from rockbatch.common.units import GRAVITY, acceleration_factor
from rockbatch.motions.formats.recording import Recording, contradictions_of, letters
from rockbatch.motions.sources.record_file import text_of

HEAD = 4096
"""Number of first bytes by which formats are recognised."""

FileLike = str | os.PathLike[str] | BinaryIO


def begin_of(data: bytes) -> bytes:
    """Return the first bytes of a file, without the mark of UTF-8 that editors write before a text."""
    return data[:HEAD].removeprefix(codecs.BOM_UTF8)


def first_bytes(filename: FileLike) -> bytes:
    """Return the first bytes of a path or file-like object, without moving its position; b"" for anything else.

    Never raises: ObsPy passes on whatever it was given while it searches for a format.
    """
    try:
        if not isinstance(filename, str | os.PathLike):
            position = filename.tell()
            try:
                return bytes(filename.read(HEAD))
            finally:
                filename.seek(position)
        with open(os.fspath(filename), "rb") as file:
            return file.read(HEAD)
    except Exception:
        return b""


def plugin(
    name: str, matches: Callable[[bytes], bool], parse: Callable[[str], Sequence[Recording]]
) -> tuple[Callable[[FileLike], bool], Callable[..., "obspy.Stream"]]:
    """Return ObsPy's ``isFormat`` and ``readFormat`` of the format ``name``, by its check and its parser.

    ``readFormat`` raises ``InputError``, beginning with the file's name, for unusable files. Data stay in the file's unit,
    which is in ``stats`` under the format's name with the other facts of the header.
    """

    def is_format(filename: FileLike) -> bool:
        """Return whether a path or file-like object is a file of this format; never raises."""
        return matches(begin_of(first_bytes(filename)))

    def read_format(filename: FileLike, headonly: bool = False, **kwargs: object) -> "obspy.Stream":
        """Return a file of this format as an ObsPy Stream, with a Trace per channel; ObsPy's other arguments are ignored."""
        if isinstance(filename, str | os.PathLike):
            place, data = str(filename), Path(filename).read_bytes()
        else:
            place, data = str(getattr(filename, "name", "data")), filename.read()
        try:
            recordings = parse(text_of(data))
            _warn_of_contradictions(place, recordings)
        except InputError as error:
            raise type(error)(*placed(error.problems, place)) from None
        return obspy.Stream([_trace(name, recording, headonly) for recording in recordings])

    return is_format, read_format


def _warn_of_contradictions(place: str, recordings: Sequence[Recording]) -> None:
    """Warn of recordings whose samples differ from their header's statements; of recordings in units of acceleration only."""
    for recording in recordings:
        try:
            factor = acceleration_factor(recording.unit)
        except ValueError:
            continue
        findings, differences = contradictions_of(recording, factor, GRAVITY)
        for text in (*(finding.text for finding in findings), *differences):
            warnings.warn(f"{place} ({recording.label}): {text}", stacklevel=4)


def _trace(name: str, recording: Recording, headonly: bool) -> "obspy.Trace":
    """Return one channel as an ObsPy Trace, without its samples if ``headonly``."""
    sensor = recording.sensor
    by_sensor = (sensor.network or "", letters(sensor.station), sensor.location or "", recording.label.upper())
    network, station, location, channel = recording.codes or by_sensor
    header = {
        "delta": recording.dt,
        "network": network,
        "station": station,
        "location": location,
        "channel": channel,
        name.lower(): obspy.core.AttribDict({**recording.header, "unit": recording.unit, "component": recording.label}),
    }
    if recording.start is not None:
        header["starttime"] = obspy.UTCDateTime(recording.start)
    if headonly:
        return obspy.Trace(header={**header, "npts": len(recording.values)})
    return obspy.Trace(data=recording.values, header=header)
