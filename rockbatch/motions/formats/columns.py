"""Plain text columns: time and accelerations, in units that the header or the study states.

They are exports of spreadsheets and of other programs. Those of the SCEC Broadband Platform (.bbp) state all in their header
and are therefore an ObsPy waveform format, "BBP".
"""

import codecs
from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from rockbatch.common.errors import Contradiction, InputError, NoRecord, NoStep, NoUnit, Unstated
from rockbatch.common.showing import shown
from rockbatch.motions.component import Component, Sensor
from rockbatch.motions.formats.clock_times import in_seconds
from rockbatch.motions.formats.column_header import (
    Column,
    believed_unit,
    columns_named,
    columns_with_units,
    is_acceleration,
    is_of_another_quantity,
    line_about_spectra,
    other_series,
    seconds_in,
    spectrum_in,
    stated_count,
    stated_directions,
    stated_factor,
    stated_of_samples,
    stated_place,
    stated_record,
    stated_unit,
    with_quantities,
    without_index_name,
)
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording, to_components
from rockbatch.motions.formats.spelled_out import is_down, line_about_sign
from rockbatch.motions.formats.stated_step import stated_step
from rockbatch.motions.formats.table import read_table
from rockbatch.motions.formats.time_steps import grows_evenly, on_even_steps
from rockbatch.motions.labels.evidence import Kind, Statement, angles_statement
from rockbatch.motions.labels.orientation import Orientation, is_upward, orientation_in, same_azimuth, split_stem
from rockbatch.motions.limits import SAME_STEP, is_step
from rockbatch.motions.motion import Samples
from rockbatch.motions.quality.places import Stand, stand, tells_place
from rockbatch.motions.sources.record_file import ReadOptions, RecordFile, no_acceleration, text_of
from rockbatch.motions.unused import Unusable

_COMPONENTS = ("000", "090", "up")
_REPEATED = 0.9  # correlation of a motion with itself, corrected; two stations have less
_GROWING = 0.9  # of the steps of a column of time; those of an acceleration grow half the time


def is_columns(head: bytes) -> bool:
    """Return whether the first bytes may be text: UTF-16 by its mark, or without NUL."""
    return head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) or b"\x00" not in head


def holds_table(head: bytes) -> bool:
    """Return whether the first bytes, less their last line, are a table of three rows or more, with or without a header."""
    try:
        return len(read_table(text_of(head.rpartition(b"\n")[0]))[1]) > 2
    except InputError:
        return False


def is_bbp(head: bytes) -> bool:
    """Return whether the first bytes have comments that name exactly time and three accelerations, each with its unit."""
    lines = [line.lstrip("# \t") for line in head.decode("latin-1").splitlines() if line.startswith("#")]
    columns = columns_with_units(lines, 4) or []
    return (
        len(columns) == 4 and columns[0].is_time and all(is_acceleration(column.unit or "") for column in columns[1:])
    )


def read_columns(file: RecordFile) -> list[Component | Unusable]:
    """Return one component per column of acceleration, in m/s².

    The header names the columns (``# time(sec) N-S(cm/s/s) …``, or ``# Column 2: North-south acceleration (cm/s/s)``);
    the study's ``columns``, ``unit`` and ``dt`` supply what it lacks. There is one assumption: in a file of two columns
    without labels, a first one that grows evenly is time, unless the header mentions spectra. Uneven times are
    interpolated, with a note.
    """
    recordings = _parse(file.text, file.options, file.beside, file.stem)
    for i, recording in enumerate(recordings):
        if is_acceleration(recording.unit):
            overruled = file.options.overruled(recording.unit, recording.dt, file.gravity)
            recordings[i] = replace(recording, notes=(*recording.notes, *overruled))
    if len(recordings) > 1:
        return to_components(file, _by_station(recordings, file.stem))
    return to_components(file, recordings)


def _by_station(recordings: Sequence[Recording], stem: str) -> list[Recording]:
    """Return the columns of a file called ``stem`` as of one station, or of those before their directions: AAA_HNE, BBB_HNE.

    They are of several stations if directions repeat, but not within any of them, and if none is a copy of another's.
    """
    sites = [split_stem(recording.label) for recording in recordings]
    ways = [(site, way.vertical, way.azimuth, way.azimuth is None and way.label) for site, way in sites if way]
    several = len({site for site, *_ in ways}) > 1 and len({way[1:] for way in ways}) < len(ways) == len(set(ways))
    if not several or len(ways) < len(recordings) or not all(site for site, _ in sites) or _repeats(recordings, ways):
        return [replace(recording, station=stem) for recording in recordings]
    are_places = all(tells_place(site) for site, _ in sites)  # else codes of stations, such as COL beside KEM

    def of_site(recording: Recording, site: str) -> Recording:
        place = site if are_places or stand("", site)[0] is not Stand.GROUND else recording.sensor.place
        return replace(recording, station=f"{stem}, {site}", sensor=Sensor(site.upper(), place=place))

    return [of_site(recording, site) for recording, (site, _) in zip(recordings, sites, strict=True)]


def _repeats(recordings: Sequence[Recording], ways: Sequence[tuple[object, ...]]) -> bool:
    """Return whether a column is nearly proportional to another one of its direction, as raw_N is to corrected_N."""
    for (a, way), (b, other) in combinations(zip(recordings, ways, strict=True), 2):
        if way[1:] == other[1:]:
            first, second = (recording.values - recording.values.mean() for recording in (a, b))
            if abs(first @ second) > _REPEATED * np.linalg.norm(first) * np.linalg.norm(second):
                return True
    return False


def _parse(text: str, options: ReadOptions, beside: Sequence[str] = (), stem: str = "") -> list[Recording]:
    """Return the columns of acceleration of a file called ``stem``; one in an unknown unit keeps it beside known ones."""
    text, start = in_seconds(text)
    header, table = read_table(text, options.layout == "wrapped", named="layout" not in options.instead, stated=beside)
    if len(table) < 2:
        raise InputError("found one row of numbers; expected at least two samples")
    columns, notes = _columns(header, options, table)
    count = stated_count(header)
    if count is not None and count != len(table):
        raise InputError(f"the header says {count} samples, but there are {len(table)} rows; fetch the file again")
    if (factor := stated_factor(header)) and "scale" not in options.instead:
        raise Contradiction(
            f"its header states a factor of {factor}, and not whether its numbers are multiplied by it already: for this file in "
            "motions.toml write scale = … with this factor if they are not, or scale = 1 if they are"
        )
    not_acceleration = [i for i, column in enumerate(columns) if column.other]
    used = [i for i, column in enumerate(columns) if not (column.is_time or column.other or column.label == "-")]
    columns = _with_direction(columns, used, header, stem)
    units = _units(columns, used, header, options)
    if not used:
        quantities = " and ".join(columns[i].other for i in not_acceleration)
        raise NoRecord(f"found {quantities or 'a column of time and no other'}; expected accelerations")
    omitted = tuple(f"{_column_name(i, columns[i])} left out: a {columns[i].other}" for i in not_acceleration)
    dt, values, moved = _on_one_step(columns, table, header, options)
    recordings, sensor = [], Sensor(place=stated_place(header))
    alone = len(used) == 1
    unnamed = alone and split_stem(stem)[1] is None  # else its name tells the record
    key = stated_record(header, len(columns)) if unnamed else ""
    others = _other_statements(header) if alone and not columns[used[0]].stated else ()
    for i in used:
        label, orientation = columns[i].label, orientation_in(columns[i].label)
        if orientation.vertical and is_down(header) and not is_upward(label):
            orientation = replace(orientation, down=True)
        recording = Recording(
            label=label,
            orientation=orientation,
            stated_by=Kind.USER if columns[i].stated else Kind.HEADER,
            dt=dt,
            values=values[:, i],
            unit=units[i],
            station=key,
            start=start,
            sensor=sensor,
            stated=stated_of_samples(header) if alone else (),
            notes=(*notes, *omitted, *moved, *_remarks_on_sign(orientation, header, stem)),
            statements=others,
        )
        recordings.append(recording)
    return recordings


def _units(
    columns: Sequence[Column], used: Sequence[int], header: Sequence[str], options: ReadOptions
) -> dict[int, str]:
    """Return the units of the columns ``used``, "" for an unknown one; raise ``InputError`` if one of acceleration is missing."""
    of_all = believed_unit(stated_unit(header), options)
    own = {i: columns[i].unit for i in used}
    units = {i: (believed_unit(unit, options) if unit else of_all) or "" for i, unit in own.items()}
    known = any(map(is_acceleration, units.values()))  # then another unit makes only its own column unusable
    lacking = [i for i in used if not (units[i] if known else is_acceleration(units[i]))]
    other = next((i for i in used if units[i] and is_of_another_quantity(units[i])), None)
    if lacking and other is not None:
        raise no_acceleration(_column_name(other, columns[other]), f"numbers in {units[other]}")
    if lacking:
        untimed = not (stated_step(header) or options.dt or any(column.is_time for column in columns))
        lacks = [f': the unit "{units[i]}" is not known' if units[i] else " has no unit" for i in lacking]
        message = "; ".join(_column_name(i, columns[i]) + lack for i, lack in zip(lacking, lacks, strict=True))
        raise Unstated(message, keys=("unit", "dt")) if untimed else NoUnit(message)
    return units


def _other_statements(header: Sequence[str]) -> tuple[Statement, ...]:
    """Return the header's statements of the direction of an only column, azimuths as angles, which are believed first."""
    statements = []
    for label in stated_directions(header):
        words, orientation = f"its header says {shown(label)}", orientation_in(label)
        angles = angles_statement(label, words, orientation.azimuth, None) if label.endswith(" deg") else None
        statements.append(angles or Statement(Kind.HEADER, words, orientation))
    return tuple(statements)


def _remarks_on_sign(orientation: Orientation, header: Sequence[str], stem: str) -> tuple[str, ...]:
    """Return a remark on a line that speaks of a sign, if a component that may be vertical is not taken as positive down."""
    way = orientation if orientation.known else split_stem(stem)[1]
    line = line_about_sign(header)
    if not line or (way and (way.down or not way.vertical)):
        return ()
    return (
        f'positive up, though its header says "{line[:60]}": if it is positive down, write polarity = "-" in motions.toml',
    )


def _with_direction(columns: list[Column], used: Sequence[int], header: Sequence[str], stem: str) -> list[Column]:
    """Return the columns, the only one that is ``used`` with the direction in a line of the header if its label tells none.

    A line on the sign of verticals is one, unless the file's name ``stem`` says that it is horizontal.
    """
    if len(used) != 1 or orientation_in(columns[used[0]].label).known:
        return columns
    named = split_stem(stem)[1]
    down = is_down(header) and (named is None or named.vertical)
    directions = [*stated_directions(header), *(["vertical down"] if down else [])]
    if not directions:
        return columns
    return [replace(column, label=directions[0]) if i in used else column for i, column in enumerate(columns)]


def _columns(header: list[str], options: ReadOptions, table: Samples) -> tuple[list[Column], tuple[str, ...]]:
    """Return the columns by header and study, and notes on them."""
    width = table.shape[1]
    columns = (
        _behind_an_index(without_index_name(header), table)
        or columns_named(header, width)
        or _beside_an_index(header, table)
    )
    stated = options.columns
    notes: tuple[str, ...] = ()
    if stated is not None:
        known = columns or [Column("")] * width
        completed = list(map(_merged_column, known, stated)) if len(stated) == width else [None]
        if None not in completed:
            columns = [column for column in completed if column]
        elif columns is None:
            raise InputError(f"found {width} columns; the study states columns = {list(stated)}")
        else:
            notes = (
                f"its header describes its {width} columns; the {len(stated)} that are stated are those of other files",
            )
    if columns is None:
        unstated = not is_acceleration(stated_unit(header) or "")
        if unstated and "unit" not in options.instead and (line := other_series(header)):
            raise no_acceleration(f'it, by "{line[:60]}" in its header,', "no accelerations")
        return _guessed_columns(header, table)
    columns = _with_time(with_quantities(columns), table)
    if spectrum := spectrum_in(columns):
        raise NoRecord(f"{spectrum} is no time history; take the record of accelerations instead")
    return columns, notes


def _behind_an_index(header: Sequence[str], table: Samples) -> list[Column] | None:
    """Return the columns of a table whose first one, "-" or "time", numbers its rows or grows evenly, and is not named; or None.

    ``header`` names the others, among which is no time if the first grows evenly.
    """
    if _counts_rows(table[:, 0]):
        return _beside_an_index(header, table)
    named = columns_named(header, table.shape[1] - 1) if header and grows_evenly(table[:, 0]) else None
    return None if named is None or any(column.is_time for column in named) else [Column("time"), *named]


def _beside_an_index(header: Sequence[str], table: Samples) -> list[Column] | None:
    """Return "-" and the columns beside a first one that numbers the rows, if the header names all of them; else ``None``."""
    named = columns_named(header, table.shape[1] - 1) if _counts_rows(table[:, 0]) else None
    return None if named is None else [Column("-"), *named]


def _counts_rows(column: Samples) -> bool:
    """Return whether a column numbers its rows, from 0 or 1."""
    return column[0] in (0.0, 1.0) and bool((np.diff(column) == 1.0).all())


def _merged_column(header: Column, stated: str) -> Column | None:
    """Return a header's column, completed by the study's label or left out by its "-"; None if they contradict each other."""
    if stated == "-":
        return Column(stated)
    study = Column(stated)
    if header.is_time or header.is_abscissa or header.is_ordinate:
        return header if header.is_time == (study.is_time or study.may_be_time) else None
    if study.is_time or (study.may_be_time and header.may_be_time):
        return Column("time", header.unit) if header.may_be_time or not header.label else None
    by_header, by_study = orientation_in(header.label), orientation_in(stated)
    if by_header.known and by_study.known:
        azimuths = (by_header.azimuth, by_study.azimuth)
        role_differs = by_header.vertical != by_study.vertical or by_header.down != by_study.down
        if role_differs or not (None in azimuths or same_azimuth(*azimuths)):
            return None
    header_suffices = by_header.vertical or by_header.azimuth is not None or not by_study.known
    return header if by_header.known and header_suffices else Column(stated, header.unit, stated=True)


def _with_time(columns: list[Column], table: Samples) -> list[Column]:
    """Return columns in which a label T without unit is time if more than 90 % of its steps are upward, else transverse.

    They are unchanged if another one is time.
    """
    if any(column.is_time for column in columns):
        return columns
    return [
        Column("time") if column.may_be_time and (np.diff(table[:, i]) > 0).mean() > _GROWING else column
        for i, column in enumerate(columns)
    ]


def _guessed_columns(header: list[str], table: Samples) -> tuple[list[Column], tuple[str, ...]]:
    """Return columns without labels, and notes: one acceleration, or evenly growing times and acceleration, in either order."""
    width = table.shape[1]
    if width == 1:
        return [Column("")], ()
    even = [i for i in range(width) if len(table) > 2 and grows_evenly(table[:, i])]
    time = even[0] if len(even) == 1 else None
    counted = time is not None and _counts_rows(table[:, time])
    if width == 2 and time is not None and not counted:
        if line := line_about_spectra(header):
            raise InputError(
                f'found two columns without labels below "{line[:60]}": a spectrum is no time history; if this is one, '
                'state columns = ["time", "000"], in the study or for this file in motions.toml'
            )
        columns = [Column("time" if i == time else "") for i in range(width)]
        return columns, (f"{'second' if time else 'first'} column, evenly growing, taken as time [s]",)
    names = [*_COMPONENTS, *["-"] * width][: width - (time is not None)]
    if time is not None:
        names.insert(time, "-" if counted else "time")
    stated = {"columns": tuple(names)}
    which = ", of which one grows by 1, as numbers of rows and ms do," if counted else ""
    raise Unstated(
        f"found {width} columns{which} and no header that says what they are, such as # time(s) NS(cm/s2) UD(cm/s2); "
        '"-" leaves one out',
        keys=("columns",),
        choices=({"layout": "wrapped"}, stated) if time is None else (stated,),
    )


def _on_one_step(
    columns: list[Column], table: Samples, header: list[str], options: ReadOptions
) -> tuple[float, Samples, tuple[str, ...]]:
    """Return the sampling interval [s], by the column of time or as stated, the table at even times, and notes."""
    times = [i for i, column in enumerate(columns) if column.is_time]
    if any(not np.array_equal(table[:, times[0]], table[:, i]) for i in times[1:]):
        raise InputError(f"found {len(times)} columns of time that differ; expected one")
    stated = stated_step(header)
    if not times:
        impossible = (
            stated is not None and not is_step(stated.dt) and "dt" in options.instead
        )  # else it is noted (manifest)
        dt = options.dt if stated is None or impossible else stated.dt
        if dt is None:
            raise NoStep("no column of time and no sampling interval")
        return dt, table, ()
    column = columns[times[0]]
    seconds = seconds_in(column.unit or "s")
    if seconds is None:
        raise InputError(f'unit of time "{column.unit}"; expected s or ms')
    t = table[:, times[0]] * seconds
    dt, values, notes = on_even_steps(t, table)
    usual = float(np.median(np.diff(t)))
    doubted = stated if "dt" not in options.instead else None
    if doubted and all(abs(doubted.dt - step) > SAME_STEP * step for step in (dt, usual)):
        raise Contradiction(
            f'the header says "{doubted.words}", {doubted.dt:g} s, but time grows by {usual:g} s; correct the one that is '
            "wrong, or write dt = … for this file in motions.toml"
        )
    return dt, values, notes


def _column_name(i: int, column: Column) -> str:
    """Return the name of a column in messages: 'column 2 ("NS")', or 'column 2' without a label."""
    return f'column {i + 1} ("{column.label}")' if column.label else f"column {i + 1}"


is_bbp_file, read_bbp_stream = plugin("BBP", is_bbp, lambda text: _parse(text, ReadOptions()))
