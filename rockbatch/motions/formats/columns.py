"""Plain text columns: time and accelerations, in units that the header or the study declares.

Exports of spreadsheets and of other programs, among them the SCEC Broadband Platform's (.bbp), which say all in
their header and are therefore an ObsPy waveform format, "BBP".
"""

import codecs
from dataclasses import replace

from rockbatch.errors import InputError, UnstatedError
from rockbatch.motions.component import Component
from rockbatch.motions.formats.column_header import (
    SECONDS,
    Column,
    columns_with_units,
    columns_without_units,
    stated_count,
    stated_step,
    stated_unit,
)
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.record_file import ReadOptions, RecordFile
from rockbatch.motions.formats.recording import Recording, to_components
from rockbatch.motions.formats.table import read_table
from rockbatch.motions.formats.time_steps import grows_evenly, on_even_steps
from rockbatch.motions.motion import Samples, Unusable
from rockbatch.motions.orientation import UNKNOWN, orientation_of, split_stem
from rockbatch.units import acceleration_factor

SUFFIXES = frozenset({".txt", ".csv", ".dat", ".bbp", ".acc"})


def is_columns(head: bytes) -> bool:
    """Whether the first bytes may be text."""
    return head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) or b"\x00" not in head


def is_bbp(head: bytes) -> bool:
    """Whether the first bytes are comments that declare time and three accelerations, each with its unit."""
    lines = [line.lstrip("# \t") for line in head.decode("latin-1").splitlines() if line.startswith("#")]
    columns = columns_with_units(lines, 4) or []
    return len(columns) == 4 and columns[0].is_time and all(map(_is_acceleration, columns[1:]))


def read_columns(file: RecordFile) -> list[Component | Unusable]:
    """One component per column of acceleration, in m/s².

    What the columns are comes from the header (``# time(sec) N-S(cm/s/s) …``, or ``# Column 2: North-south
    acceleration (cm/s/s)``), else from the study's ``columns``, ``unit`` and ``dt``. Nothing is assumed but
    one thing: in a file of two columns, one that grows evenly in time's manner is time. Uneven times are
    interpolated, and it is said.
    """
    recordings = _parse(file.text, file.options)
    if len(recordings) > 1:
        return to_components(file, [replace(recording, station=file.stem) for recording in recordings])
    (only,) = recordings
    if only.orientation is UNKNOWN:
        only = replace(only, orientation=split_stem(file.stem)[1] or UNKNOWN)
    return to_components(file, [only])


def _parse(text: str, options: ReadOptions) -> list[Recording]:
    """The columns of acceleration; ``InputError`` where they are not known, or have no unit."""
    header, table = read_table(text)
    columns, notes = _columns(header, options, table)
    count = stated_count(header)
    if count is not None and count != len(table):
        raise InputError(f"the header says {count} samples, but there are {len(table)} rows; fetch the file again")
    unit = stated_unit(header) or options.unit
    wanted = [i for i, column in enumerate(columns) if not column.is_time and column.label != "-"]
    lacking = [f"{_called(i, columns[i])} has no unit" for i in wanted if not (columns[i].unit or unit)]
    step = stated_step(header) or options.dt
    if lacking:
        untimed = step is None and not any(column.is_time for column in columns)
        raise UnstatedError(
            f"{'; '.join(lacking)}; write it in the header, e.g. # time(s) NS(cm/s2), "
            'or state it in the study, e.g. unit = "cm/s2"',
            *(("unit", "dt") if untimed else ("unit",)),
        )
    if not wanted:
        raise InputError("found a column of time and no other")
    dt, values, moved = _sampled(columns, table, step)
    return [
        Recording(
            label=columns[i].label,
            orientation=orientation_of(columns[i].label) or UNKNOWN,
            dt=dt,
            values=values[:, i],
            unit=columns[i].unit or unit or "",
            codes=("", "", "", columns[i].label),
            notes=(*notes, *moved),
        )
        for i in wanted
    ]


def _columns(header: list[str], options: ReadOptions, table: Samples) -> tuple[list[Column], tuple[str, ...]]:
    """What the columns are, and what had to be said about them."""
    width = table.shape[1]
    if columns := columns_with_units(header, width):
        return columns, ()
    if options.columns is not None:
        if len(options.columns) != width:
            raise InputError(f"found {width} columns; the study states columns = {list(options.columns)}")
        return [Column(label) for label in options.columns], ()
    if columns := columns_without_units(header, width):
        return columns, ()
    if width == 1:
        return [Column("")], ()
    if width == 2 and len(table) > 2 and grows_evenly(table[:, 0]):
        return [Column("time"), Column("")], ("first column, evenly growing, taken as time [s]",)
    raise InputError(
        f"found {width} columns and no header that says what they are; write one, "
        "e.g. # time(s) NS(cm/s2) UD(cm/s2), "
        'or state in the study, e.g. columns = ["time", "000", "090", "up"] ("-" leaves one out)'
    )


def _sampled(columns: list[Column], table: Samples, stated: float | None) -> tuple[float, Samples, tuple[str, ...]]:
    """Sampling interval [s], from the time column or as stated, the table on even times, and notes."""
    times = [i for i, column in enumerate(columns) if column.is_time]
    if len(times) > 1:
        raise InputError(f"found {len(times)} columns of time; expected one")
    if len(table) < 2:
        raise InputError("found one row of numbers; expected at least two samples")
    if not times:
        if stated is None:
            raise UnstatedError(
                "no column of time and no sampling interval; state it in the study, e.g. dt = 0.01", "dt"
            )
        return stated, table, ()
    column = columns[times[0]]
    seconds = SECONDS.get((column.unit or "s").strip().lower().rstrip("."))
    if seconds is None:
        raise InputError(f'unit of time "{column.unit}"; expected s or ms')
    dt, values, notes = on_even_steps(table[:, times[0]] * seconds, table)
    return dt, values, notes


def _called(i: int, column: Column) -> str:
    """A column for messages."""
    return f'column {i + 1} ("{column.label}")' if column.label else f"column {i + 1}"


def _is_acceleration(column: Column) -> bool:
    """Whether a column's unit is one of acceleration."""
    try:
        acceleration_factor(column.unit or "")
    except ValueError:
        return False
    return True


is_bbp_file, read_bbp_stream = plugin("BBP", is_bbp, lambda text: _parse(text, ReadOptions()))
