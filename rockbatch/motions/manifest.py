"""Manifests: facts about records that their files lack, or state wrongly.

``motions.toml`` has a table [[record]] for each file, ``motions.csv`` a line, with the keys of ``RECORD``; file names in them
are relative to their folder.
"""

import csv
import io
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from rockbatch.common.errors import InputError, Problem, refuse
from rockbatch.common.files import opened_input
from rockbatch.common.grouping import closest
from rockbatch.common.showing import shown
from rockbatch.common.units import acceleration_factor
from rockbatch.motions import kinds
from rockbatch.motions.component import Component
from rockbatch.motions.labels.evidence import Kind, Statement
from rockbatch.motions.labels.orientation import Orientation
from rockbatch.motions.sources.archives import archive_of, is_member
from rockbatch.motions.sources.record_file import LAYOUTS, ReadOptions
from rockbatch.motions.suites.sequences import SEQUENCE, ShockSequence, read_sequences
from rockbatch.motions.unused import Unusable
from rockbatch.toml.files_meant import nearby
from rockbatch.toml.kinds import boolean, choice, nonzero, not_negative, number, positive, text
from rockbatch.toml.meant import names
from rockbatch.toml.reader import Table, TomlFile
from rockbatch.toml.section import Key, Section

RECORD = Section(
    ("record",),
    (
        "Facts about a record that its file lacks or states wrongly. The file `motions.toml` lies in the folder of "
        "the records; `rockbatch motions FOLDER --write-manifest` drafts it."
    ),
    {
        "file": Key(
            kinds.file_name,
            '"RSN1063_NORTHR_RRS228.AT2"',
            "The file, relative to the folder of the manifest.",
            required=True,
        ),
        "component": Key(
            kinds.channel,
            '"NS"',
            "One of several components in the file, by its label, its name, or its number in the file, from 1.",
        ),
        "use": Key(
            boolean, "false", "false: it is left out; true: it is used before other files of the same recording."
        ),
        "role": Key(choice("horizontal", "vertical"), '"vertical"', "Whether the component is horizontal or vertical."),
        "layout": Key(
            choice(*LAYOUTS), '"wrapped"', '"wrapped": its numbers are one series that goes on from line to line.'
        ),
        "columns": Key(
            text,
            '["time", "000", "090", "up"]',
            'Meaning of the columns of a text file: "time", "up", an azimuth, or "-" for none of these.',
            many=True,
            distinct=False,
        ),
        "azimuth": Key(kinds.azimuth, "228", "Direction of the component, degrees clockwise from north."),
        "unit": Key(kinds.unit, '"cm/s2"', "Unit of acceleration, in place of the file's own."),
        "dt": Key(kinds.step, "0.01", "Sampling interval [s], in place of the file's own."),
        "sensitivity": Key(
            nonzero, "428000.0", "Counts per unit of acceleration of a file in counts, in place of StationXML's."
        ),
        "scale": Key(positive, "1.0", "Factor on the accelerations."),
        "polarity": Key(choice("+", "-"), '"-"', '"-" reverses the component.'),
        "station": Key(text, '"Rinaldi"', "Name of the station; components that share it belong together."),
        "distance_km": Key(not_negative, "6.5", "Distance to the rupture."),
        "magnitude": Key(number, "6.7", "Magnitude of the earthquake."),
        "confirm": Key(boolean, "true", "Whether a grossly unusual record is correct."),
        "confirm_pga": Key(boolean, "true", "Whether an unusual peak acceleration is correct."),
    },
    many=True,
    also=names(
        {
            "file": "filename path record",
            "station": "site stationname",
            "azimuth": "angle direction orientation bearing heading",
            "scale": "factor multiplier",
            "magnitude": "mw mag m",
            "distance_km": "rrup rjb distance",
            "component": "channel",
            "role": "type",
            "polarity": "sign",
            "dt": "timestep samplinginterval",
        }
    ),
    instead=names(
        {
            "write use = false": "skip ignore exclude omit leaveout",
            'write role = "vertical"': "vertical",
            'write polarity = "-"': "flip reverse invert",
        }
    ),
)
SECTIONS = (RECORD, replace(SEQUENCE, at=("sequence",)))
"""Tables of a ``motions.toml``."""
_MOST_HINTS = 10  # for missing files, each of which is compared with all files of its folder
_LONGEST_HEAD = 1000  # bytes of the first line of a CSV
_OPTIONS = ("unit", "dt", "layout", "columns", "sensitivity")
_CONFIRM = ("confirm", "confirm_pga")
_TEXTS = ("file", "role", "layout", "unit", "polarity", "station")
_COUNTED = re.compile("[1-9][0-9]?")  # a number of a channel; azimuths have three digits
_SAME = 1e-9  # relative: factors of units, and steps, that differ by less are the same


@dataclass(frozen=True)
class Entry:
    """The entry of a file, or of one component in it: its table and the values of its keys."""

    path: Path
    table: Table
    values: Mapping[str, Any]  # as RECORD has checked them

    @property
    def component(self) -> str | int | None:
        """Return the label, name or number in the file of its component; ``None`` for the whole file."""
        return self.values.get("component")

    @property
    def use(self) -> bool:
        """Return whether the file or component is to be used; True unless the entry says use = false."""
        return bool(self.values.get("use", True))

    @property
    def unused(self) -> str:
        """Return the reason for leaving out its file or component: "use = false in motions.toml"."""
        return f"use = false in {self.table.file.path.name}"

    def is_for(self, unusable: Unusable) -> bool:
        """Return whether its component is this unusable one; False for an entry of a whole file."""
        return self.component is not None and self.component in (unusable.label, unusable.name, unusable.number or None)


@dataclass
class Manifest:
    """Entries by the real path of their file, and mistakes, which :meth:`finish` raises."""

    entries: dict[Path, list[Entry]]
    files: list[TomlFile]
    refused: list[Problem]
    sequences: list[tuple[str, ShockSequence]] = field(default_factory=list)  # with the manifest of each

    @classmethod
    def read(cls, paths: Iterable[Path]) -> "Manifest":
        """Return the entries of the manifests at ``paths``; their mistakes wait for :meth:`finish`."""
        manifest = cls({}, [], [])
        for path in paths:
            try:
                file = TomlFile.read(path, SECTIONS) if path.suffix == ".toml" else _from_csv(path)
            except InputError as error:
                manifest.refused += error.problems
            else:
                manifest._add_entries(file)
        return manifest

    def _add_entries(self, file: TomlFile) -> None:
        """Add the entries and sequences of a manifest; files outside its folder, missing or repeated become problems."""
        self.files.append(file)
        Table(file, (), "", file.data).read({}, other=("record", "sequence"))
        self.sequences += [(str(file.path), sequence) for sequence in read_sequences(file, "sequence")]
        folder = Path(os.path.realpath(file.path.parent))
        listed: set[tuple[Path, str | None]] = set()
        for table in file.tables("record", title="file"):
            values = table.read(RECORD)
            if file.is_full:
                return
            if "file" not in values:
                continue
            path = Path(os.path.realpath(folder / values["file"]))
            if not path.is_relative_to(folder):
                table.complain(
                    f"file = {shown(values['file'])}: lies outside this folder; put a manifest there", "file"
                )
            elif not (os.path.isfile(path) or is_member(path)):
                hint = nearby(path, path.relative_to(folder).as_posix()) if len(file.problems) < _MOST_HINTS else ""
                table.complain(f"file = {shown(values['file'])}: no such file in {folder}{hint}", "file")
            elif (path, values.get("component")) in listed:
                table.complain(f"file = {shown(values['file'])}: given twice; write one table for it", "file")
            else:
                listed.add((path, values.get("component")))
                self.entries.setdefault(path, []).append(Entry(path, table, values))

    def entries_for(self, path: Path) -> list[Entry]:
        """Return the entries of a file, those of the whole file first; those of its archive if it has none."""
        if not self.entries:
            return []
        real = Path(os.path.realpath(path))
        archive = archive_of(real)
        entries = self.entries.get(real) or (self.entries.get(archive, []) if archive else [])
        return sorted(entries, key=lambda entry: entry.component is not None)

    def finish(self) -> None:
        """Raise :class:`InputError` with all mistakes of all manifests, if there are any."""
        problems = list(self.refused)
        for file in self.files:
            try:
                file.finish()
            except InputError as error:
                problems += error.problems
        refuse(problems)


def options_of(entries: Sequence[Entry], options: ReadOptions) -> ReadOptions:
    """Return ``options`` with unit, dt, layout, columns and sensitivity of the entries for the whole file.

    These then replace the file's own statements, as does a scale.
    """
    for entry in entries:
        if entry.component is None:
            stated = {key: entry.values[key] for key in _OPTIONS if key in entry.values}
            options = replace(options, **stated, instead=frozenset(stated) | ({"scale"} & entry.values.keys()))
    return options


def apply_entries(
    components: Sequence[Component], entries: Sequence[Entry], gravity: float, refused: Sequence[Unusable] = ()
) -> list[tuple[Component, bool]]:
    """Return a file's components with its entries applied, and whether each is to be used; mistakes go to the manifest.

    An entry that names no component applies to all. ``refused`` are the unusable components of the file, which entries may name.
    """
    chosen: list[tuple[Component, bool]] = [(component, True) for component in components]
    for entry in entries:
        if entry.table.file.is_full:
            break
        matching = [
            i for i, c in enumerate(components) if entry.component in (None, c.name, c.orientation.label, c.number)
        ]
        if not matching and components and not any(map(entry.is_for, refused)):
            labels = [*(c.orientation.label or c.name for c in components), *(unusable.label for unusable in refused)]
            labels_shown = ", ".join(map(shown, filter(None, labels)))
            complaint = f"component = {shown(entry.component)}: the file has {labels_shown}"
            entry.table.complain(f"{complaint}; write one of these, or its number in the file", "component")
        if len(matching) > 1:
            for key in (key for key in ("azimuth", "role") if key in entry.values):
                entry.table.complain(
                    f"{key}: the file has {len(matching)} components; write component = "
                    f"{shown(components[0].orientation.label)} with it, and a table for each",
                    key,
                )
        for i in matching:
            component, used = chosen[i]
            chosen[i] = (_apply_entry(component, entry, gravity), used and entry.use)
    return chosen


def _apply_entry(component: Component, entry: Entry, gravity: float) -> Component:
    """Return a component with the values of an entry, and notes; another unit or step leaves its initial state unknown."""
    values, file = entry.values, entry.table.file.path.name
    notes = list(component.notes)
    factor = 1.0
    initial = component.initial
    if "unit" in values and not component.unit:
        entry.table.complain("unit: the file has a scale of its own; leave it out, or write scale instead", "unit")
    elif "unit" in values:
        ratio = acceleration_factor(values["unit"], gravity) / acceleration_factor(component.unit, gravity)
        if abs(ratio - 1.0) > _SAME:
            factor, initial = ratio, None  # the unit of the initial state is unknown, too
            notes.append(f"unit {values['unit']} as {file} says, instead of {component.unit}")
    if "dt" in values and abs(values["dt"] - component.dt) > _SAME * component.dt:
        initial = None
        notes.append(f"dt = {values['dt']:g} s as {file} says, instead of {component.dt:g} s")
        component = replace(component, dt=values["dt"])
    if values.get("scale", 1.0) != 1.0:
        factor *= values["scale"]
        initial = initial and initial.times(values["scale"])
        notes.append(f"scaled by {values['scale']:g} as {file} says")
    if values.get("polarity") == "-":
        factor = -factor
        initial = initial and initial.times(-1.0)
        notes.append(f"sign reversed as {file} says")
    if "station" in values:
        joined = values["station"] in (component.station, component.site)  # a draft's key, no name for people
        name = component.origin.station if joined else values["station"]
        component = replace(component, station=values["station"], site="", event=values["station"])
        component = replace(component, origin=replace(component.origin, station=name))
    orientation = _orientation(component.orientation, entry)
    if orientation is not component.orientation:
        component = replace(component, statements=(Statement(Kind.USER, f"{file} says", orientation),))
    return replace(
        component,
        acceleration=component.acceleration * factor if factor != 1.0 else component.acceleration,
        orientation=orientation,
        magnitude=values.get("magnitude", component.magnitude),
        distance_km=values.get("distance_km", component.distance_km),
        confirmed=tuple(key for key in _CONFIRM if values.get(key, key in component.confirmed)),
        preferred=values.get("use", component.preferred),
        initial=initial,
        notes=tuple(notes),
    )


def _orientation(orientation: Orientation, entry: Entry) -> Orientation:
    """Return the orientation by an entry's role and azimuth; ``orientation`` itself if the entry states neither."""
    values = entry.values
    if not values.keys() & {"role", "azimuth"}:
        return orientation
    role = values.get("role", "vertical" if orientation.vertical else "horizontal")
    if role == "vertical":
        if "azimuth" in values:
            entry.table.complain('azimuth: it is a vertical component; write role = "horizontal" if not', "azimuth")
        return Orientation(orientation.label or role, vertical=True, down=orientation.down)
    azimuth = values["azimuth"] % 360.0 if "azimuth" in values else orientation.azimuth
    return Orientation(orientation.label, azimuth=azimuth)


def is_manifest(path: Path) -> bool:
    """Return whether a file named as a manifest is one: True for .toml; for .csv if it has a column "file", or cannot be opened.

    Another ``motions.csv`` may be a record.
    """
    if path.suffix == ".toml":
        return True
    try:
        with opened_input(path) as file:
            head = file.read(_LONGEST_HEAD).decode("utf-8-sig", "replace")
    except OSError:
        return True  # reading it then reports the error with the other mistakes
    try:
        lines = io.StringIO(head, newline=None)
        return "file" in [cell.strip() for cell in next(csv.reader(lines, delimiter=_delimiter(head)), [])]
    except csv.Error:
        return False


def _delimiter(text: str) -> str:
    """Return ";" if the first line has one, as Excel writes it in countries with decimal commas, else ","."""
    return ";" if ";" in io.StringIO(text, newline=None).readline() else ","


def _from_csv(path: Path) -> TomlFile:
    """Return a ``motions.csv``, with any line ends, as if it were TOML; empty cells are missing keys."""
    content = TomlFile.text_of(path)
    delimiter = _delimiter(content)
    rows = csv.reader(io.StringIO(content, newline=""), delimiter=delimiter)
    records: list[dict[str, object]] = []
    file = TomlFile(path, content, {"record": records}, {("header",): 1})
    try:
        names = [name.strip() for name in next(rows)]
        for name in names:
            if name not in RECORD and not file.is_full:
                closest_key = closest(name, RECORD)
                instead = f"did you mean {closest_key}?" if closest_key else "write one of " + ", ".join(RECORD)
                file.complain(("header",), f"{shown(name)}: unknown column; {instead}")
        for cells in rows:
            key_path: tuple[str | int, ...] = ("record", len(records))
            row = {name: cell.strip() for name, cell in zip(names, cells, strict=False) if cell.strip()}
            if any(cell.strip() for cell in cells):
                file.lines.update({key: rows.line_num for key in (key_path, *((*key_path, name) for name in row))})
                if len(cells) > len(names):
                    file.complain(key_path, f"found {len(cells)} cells; the first line names {len(names)} columns")
                records.append({name: _cell_value(name, row[name], delimiter) for name in row if name in RECORD})
    except csv.Error as error:
        raise InputError(f"{path}:{rows.line_num}: not a line of a CSV file: {error}") from None
    return file


def _cell_value(name: str, cell: str, delimiter: str) -> str | int | float:
    """Return the value of a cell: the text of keys with texts, a channel's number of one or two digits, a bool, or a float.

    Between semicolons a float may have a decimal comma. Any other cell comes back as text, which its key then refuses.
    """
    if name in _TEXTS or (name == "component" and not _COUNTED.fullmatch(cell)):
        return cell
    if name == "component":
        return int(cell)
    if cell.lower() in ("true", "false"):
        return cell.lower() == "true"
    try:
        return float(cell.replace(",", ".") if delimiter == ";" else cell)
    except ValueError:
        return cell
