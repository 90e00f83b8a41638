"""Plain text columns: time and accelerations, in units that the header or the study declares."""

import re
from dataclasses import dataclass

import numpy as np

from rockbatch.errors import InputError
from rockbatch.motions.component import Component
from rockbatch.motions.formats.record_file import RecordFile
from rockbatch.motions.motion import Samples, Unusable
from rockbatch.motions.orientation import UNKNOWN, orientation_of, split_stem
from rockbatch.units import acceleration_factor

SUFFIXES = frozenset({".txt", ".csv", ".dat", ".bbp", ".acc"})

_EVEN = 0.05  # of dt: what rounding in print does to even times; a lost sample is off by 1
_SECONDS = {"s": 1.0, "sec": 1.0, "secs": 1.0, "second": 1.0, "seconds": 1.0, "ms": 1e-3, "msec": 1e-3}
_COMMENT = ("#", "%")
_LONGEST = 500  # characters of a header line that are looked at
_UNIT = r"[(\[]\s*(?P<unit>[^()\[\]]+?)\s*[)\]]"
_NUMBERED = re.compile(rf"^column\s+(?P<at>\d+)\s*[:=]\s*(?P<label>.*?)\s*{_UNIT}", re.IGNORECASE)
_LABELLED = re.compile(rf"(?P<label>[^\s,;()\[\]][^,;\t()\[\]]*?)\s*{_UNIT}")
_STATED = re.compile(r"^units?\s*[:=]\s*(?P<unit>\S+)", re.IGNORECASE)
_SHORT = {"NORTHSOUTH": "NS", "EASTWEST": "EW", "UPDOWN": "UD"}


@dataclass(frozen=True)
class _Column:
    """What one column is: its label, and its unit where it is known."""

    label: str
    unit: str | None = None

    @property
    def is_time(self) -> bool:
        return re.sub(r"[^a-z]", "", self.label.lower()) in ("t", "time", "times")


def is_columns(head: bytes) -> bool:
    """Whether the first bytes may be text."""
    return b"\x00" not in head


def read_columns(file: RecordFile) -> list[Component | Unusable]:
    """One component per column of acceleration, in m/s².

    What the columns are comes from the header (``# time(sec) N-S(cm/s/s) …``, or ``# Column 2: North-south
    acceleration (cm/s/s)``), else from the study's ``columns``, ``unit`` and ``dt``. Nothing is assumed but
    one thing: in a file of two columns, one that grows evenly in time's manner is time.
    """
    header, table = _split(file.text)
    columns, unit, notes = _declared(header, file, table)
    dt = _step(columns, table, file)
    wanted = [i for i, column in enumerate(columns) if not column.is_time and column.label != "-"]
    readings: list[Component | Unusable] = []
    problems = []
    for i in wanted:
        column = columns[i]
        several = len(wanted) > 1
        name = f"{file.stem}.{column.label}" if several else file.stem
        declared = column.unit or unit
        if declared is None:
            problems.append(f'column {i + 1} ("{column.label}") has no unit')
            continue
        try:
            factor = acceleration_factor(declared, file.gravity)
        except ValueError as error:
            readings.append(Unusable(name, file.source, f'column {i + 1} ("{column.label}"): {error}'))
            continue
        by_label = orientation_of(column.label)
        orientation = by_label or (None if several else split_stem(file.stem)[1]) or UNKNOWN
        readings.append(
            Component(
                name=name,
                dt=dt,
                acceleration=table[:, i] * factor,
                orientation=orientation,
                station=file.stem if several else "",
                source=f"{file.source} (column {i + 1})" if several else file.source,
                notes=notes,
            )
        )
    if problems:
        raise InputError(
            f"{'; '.join(problems)}; write it in the header, e.g. # time(s) NS(cm/s2), "
            'or state it in the study, e.g. unit = "cm/s2"'
        )
    return readings


def _split(text: str) -> tuple[list[str], Samples]:
    """Header lines, without their comment sign, and the table of numbers, shape (npts, columns)."""
    header: list[str] = []
    rows: list[list[float]] = []
    for number, line in enumerate(text.splitlines(), start=1):
        stripped = line.strip()
        if not stripped:
            continue
        row = None if stripped.startswith(_COMMENT) else _numbers(stripped)
        if row is None:
            if rows and not stripped.startswith(_COMMENT):
                raise InputError(f'line {number}: found "{stripped[:60]}"; expected {len(rows[0])} numbers as above')
            header.append(stripped.lstrip("#% \t")[:_LONGEST])
            continue
        if rows and len(row) != len(rows[0]):
            raise InputError(f"line {number}: found {len(row)} numbers; expected {len(rows[0])} as above")
        rows.append(row)
    if not rows:
        raise InputError("no columns of numbers found in it")
    table = np.array(rows)
    if not np.isfinite(table).all():
        row_at, column_at = np.argwhere(~np.isfinite(table))[0]
        raise InputError(f"row {row_at + 1} of numbers, column {column_at + 1}: not a finite number")
    return header, table


def _numbers(line: str) -> list[float] | None:
    """The numbers of a line, ``None`` if it holds anything else; "0,01; 2,5" has decimal commas."""
    if ";" in line:
        line = line.replace(",", ".").replace(";", " ")
    if "_" in line:  # Python would read 1_0 as ten
        return None
    try:
        return [float(token) for token in line.replace(",", " ").split()]
    except ValueError:
        return None


def _declared(header: list[str], file: RecordFile, table: Samples) -> tuple[list[_Column], str | None, tuple[str, ...]]:
    """The columns, the unit of those that have none of their own, and what had to be said about them."""
    width = table.shape[1]
    options = file.options
    stated = next((match["unit"].rstrip(".,;") for line in header if (match := _STATED.match(line))), None)
    unit = stated or options.unit
    numbered = {int(m["at"]): _Column(_tidy(m["label"]), m["unit"]) for line in header if (m := _NUMBERED.match(line))}
    if sorted(numbered) == list(range(1, width + 1)):
        return [numbered[i + 1] for i in range(width)], unit, ()
    for line in reversed(header):
        labelled = [_Column(_tidy(match["label"]), match["unit"]) for match in _LABELLED.finditer(line)]
        if len(labelled) == width and not _LABELLED.sub("", line).strip(" \t,;"):  # "PGA (g): 0.5" is no label
            return labelled, unit, ()
    if options.columns is not None:
        if len(options.columns) != width:
            raise InputError(f"found {width} columns; the study states columns = {list(options.columns)}")
        return [_Column(label) for label in options.columns], unit, ()
    for line in reversed(header):
        names = [_Column(_tidy(name)) for name in re.split(r"[\s,;]+", line.strip(" ,;"))]
        if len(names) == width and any(column.is_time or orientation_of(column.label) for column in names):
            return names, unit, ()
    if width == 1:
        return [_Column("")], unit, ()
    if width == 2 and len(table) > 2 and _step_of(table[:, 0]) is not None:
        return [_Column("time"), _Column("")], unit, ("first column, evenly growing, taken as time [s]",)
    raise InputError(
        f"found {width} columns and no header that says what they are; write one, "
        "e.g. # time(s) NS(cm/s2) UD(cm/s2), "
        'or state in the study, e.g. columns = ["time", "000", "090", "up"] ("-" leaves one out)'
    )


def _tidy(label: str) -> str:
    """A column's label for names and tables: "N-S" and "North-south acceleration" give "NS"."""
    bare = re.sub(r"(?i)\s*(?:ground\s*)?acc(?:eleration|el)?\b\.?\s*", " ", label).strip()
    key = re.sub(r"[^A-Z]", "", bare.upper())
    if key in _SHORT:
        return _SHORT[key]
    return re.sub(r"[-\s]+", "", bare) if orientation_of(bare) else bare or label


def _step(columns: list[_Column], table: Samples, file: RecordFile) -> float:
    """Sampling interval [s], from the time column or as the study states it."""
    times = [i for i, column in enumerate(columns) if column.is_time]
    if len(times) > 1:
        raise InputError(f"found {len(times)} columns of time; expected one")
    if len(table) < 2:
        raise InputError("found one row of numbers; expected at least two samples")
    if not times:
        if file.options.dt is None:
            raise InputError("no column of time and no sampling interval; state it in the study, e.g. dt = 0.01")
        return file.options.dt
    column = columns[times[0]]
    seconds = _SECONDS.get((column.unit or "s").strip().lower().rstrip("."))
    if seconds is None:
        raise InputError(f'unit of time "{column.unit}"; expected s or ms')
    dt = _step_of(table[:, times[0]])
    if dt is None:
        raise InputError(
            f"time in column {times[0] + 1} does not grow evenly (tolerance {_EVEN:.0%} of a step); resample the record"
        )
    return float(f"{dt * seconds:.12g}")


def _step_of(t: Samples) -> float | None:
    """Step of evenly growing times; ``None`` where they are not."""
    dt = float(t[-1] - t[0]) / (len(t) - 1)
    if not dt > 0:
        return None
    return dt if np.abs(t - (t[0] + dt * np.arange(len(t)))).max() <= _EVEN * dt else None
