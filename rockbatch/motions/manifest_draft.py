"""A draft of a manifest from the records in a folder, to be completed by hand."""

import json
import os
from collections.abc import Sequence
from pathlib import Path

from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.files import legible, write_output
from rockbatch.common.grouping import grouped
from rockbatch.motions.component import Component
from rockbatch.motions.folder import Reading, read_files
from rockbatch.motions.identity.directions import judge_directions
from rockbatch.motions.identity.doubles import without_doubles
from rockbatch.motions.identity.stations import by_station
from rockbatch.motions.quality.plausible import gross_findings
from rockbatch.motions.sources.record_file import ReadOptions
from rockbatch.motions.unused import Unusable

_HEAD = """\
# Facts about these records beyond their files; rockbatch reads them wherever the records are used.
# Drafted from the files: correct and complete it, and delete lines that are not needed.
#
# unit, dt     of the file's numbers, in place of its own; dt in s
# azimuth      degrees clockwise from north;  role = "vertical" or "horizontal";  polarity = "-" reverses the sign
# component    its label, or its number in the file;  scale: factor on the record
# station      components that share it belong together, and count as one record
# magnitude, distance_km;  use = false: leave it out;  use = true: use it rather than copies of the same recording
# confirm = true: it is right, however odd;  confirm_pga = true: its PGA outside 0.001-5 g is right
"""

_ASKED = {
    "unit": 'of its numbers: "g", "g/10", "m/s2", "cm/s2", "gal" or "mm/s2"',
    "dt": "its sampling interval [s]",
    "layout": '"wrapped", if it is one series that goes on from line to line',
    "columns": 'such as ["time", "000", "090", "up"]; "-" leaves one out',
    "sensitivity": "counts per m/s²",
}


@checked
def write_manifest(folder: str | os.PathLike[str], options: ReadOptions | None = None) -> Path:
    """Write a draft of ``motions.toml`` into ``folder`` and return its path.

    Raises ``InputError`` if it is no folder, or has a ``motions.toml`` or ``motions.csv``, which are never overwritten.
    """
    folder = Path(folder)
    target = folder / "motions.toml"
    if not folder.is_dir():
        raise InputError(f"{folder}: a manifest is for a folder; give the one that the records lie in")
    for existing in (target, folder / "motions.csv"):
        if os.path.lexists(existing):
            raise InputError(f"{existing} is there already; edit it, or move it away to have a new one drafted")
    write_output(target, draft(folder, options))
    return target


def draft(folder: Path, options: ReadOptions | None = None) -> str:
    """Return the text of a manifest: a table for each component, a remark for each unusable one; nothing for files left out.

    Unedited, it changes no name and no number.
    """
    readings, paths, _ = read_files([folder], options=options)
    readings = judge_directions(readings)
    components = [reading for reading in readings if isinstance(reading, Component)]
    doubles = {(double.name, double.source): double.reason for double in without_doubles(components)[1]}
    stations = {id(c): station[0].station or station[0].site for station in by_station(components) for c in station}
    stated = options is not None and options.sensitivity is not None  # a unit in the draft would displace it
    blocks = [_HEAD]
    for source, file_readings in grouped(readings, lambda r: r.file).items():
        name = paths[source].relative_to(folder).as_posix()
        for reading in file_readings:
            if legible(name) != name:
                blocks.append(f"# {legible(name)}: give it a name without control characters first\n")
            elif isinstance(reading, Component):
                double = doubles.get((reading.name, reading.source), "")
                called = _component_key(reading, file_readings)
                blocks.append(_record_table(reading, name, called, stations[id(reading)], double, with_unit=not stated))
            elif isinstance(reading, Unusable):
                blocks.append(_remark(name, reading))
    return "\n".join(blocks)


def _component_key(component: Component, file_readings: Sequence[Reading]) -> str | int | None:
    """Return a component's label, name or number, the first that is unique in its file; ``None`` if it is alone."""
    if len(file_readings) == 1:
        return None
    labels = [r.orientation.label if isinstance(r, Component) else getattr(r, "label", "") for r in file_readings]
    texts = [{label, reading.name} for label, reading in zip(labels, file_readings, strict=True)]
    names = (text for text in (component.orientation.label, component.name) if text)
    return next((text for text in names if sum(text in words for words in texts) == 1), component.number)


def _record_table(
    component: Component, name: str, called: str | int | None, station: str, double: str, with_unit: bool
) -> str:
    """Return the table of a component of the file ``name``, ``called`` so in it, with remarks on missing and doubtful facts."""
    orientation = component.orientation
    lines: list[tuple[str, str | float]] = [("file", name)]
    if called is not None:
        lines.append(("component", called))
    if orientation.known:
        lines.append(("role", "vertical" if orientation.vertical else "horizontal"))
    if orientation.azimuth is not None:
        lines.append(("azimuth", orientation.azimuth))
    if component.unit and with_unit:
        lines.append(("unit", component.unit))
    text = "[[record]]\n" + "".join(f"{key} = {_toml_value(value)}\n" for key, value in lines)
    if not orientation.known:
        why = legible(component.contradiction) or "its direction is unknown"
        text += f'# role = "horizontal"   # or "vertical": {why}; it is not used until this is stated\n'
    if not orientation.vertical:
        text += "# azimuth =\n" if orientation.azimuth is None else ""
        text += "".join(f"# {f.key} = true   # {legible(f.text)}\n" for f in gross_findings(component))
    if double:
        text += f"# use = true   # {legible(double)}\n"
    return text + f"# station = {_toml_value(station)}\n# magnitude =\n# distance_km =\n"


def _remark(name: str, unusable: Unusable) -> str:
    """Return the text for an unusable file: a commented table, or a table with a line to complete for each missing key."""
    remark, file = f"# Not used: {legible(unusable.reason)}\n", _toml_value(name)
    if not unusable.lacks:
        return f"{remark}# [[record]]\n# file = {file}\n# use = false\n"
    return f"{remark}[[record]]\nfile = {file}\n" + "".join(f"# {key} =   # {_ASKED[key]}\n" for key in unusable.lacks)


def _toml_value(value: str | float) -> str:
    """Return a value as TOML writes it, a number in full, a text in quotes, legible."""
    if isinstance(value, str):
        return json.dumps(legible(value), ensure_ascii=False)
    short = f"{value:g}"
    return short if float(short) == value else repr(float(value))
