"""peaks.csv: make its columns from finished runs, and give tables the right types.

:mod:`rockbatch.quantities.catalogue` defines the columns.
"""

import math
from collections.abc import Container, Iterable, Mapping, Sequence
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.common.showing import shown
from rockbatch.common.statuses import STATUSES
from rockbatch.common.units import ColumnUnits
from rockbatch.motions import Motion, MotionSet
from rockbatch.outcome.outcome import Failure, Outcome
from rockbatch.pier import Pier
from rockbatch.quantities.arrays import texts_in
from rockbatch.quantities.catalogue import COLUMNS, COUNTS, FACTS, FIXED, MIRROR_OF, OPTIONAL, TEXTS, TRAILING, names
from rockbatch.quantities.rows import PEAKS
from rockbatch.study import Case, Study

JOURNAL = f"{PEAKS}.part"
"""Finished runs of an unfinished table."""


class StudyRun(NamedTuple):
    """A run of a study: record, polarity, scale and case, with its outcome once it is finished.

    ``mirror_of`` is the polarity of the simulated run of which this run is the mirror image; None if it is simulated itself.
    """

    record: Motion
    polarity: str
    scale: float
    case: Case
    mirror_of: str | None = None
    outcome: Outcome | None = None

    @property
    def pier(self) -> Pier:
        """The case's pier."""
        return self.case.pier

    @property
    def pga(self) -> float:
        """Peak horizontal acceleration of the motion [m/s²], times ``scale``; bitwise equal to that of the scaled record."""
        return self.record.pga * self.scale


_FIELDS = {column.name: column.source for column in COLUMNS.values() if isinstance(column.source, str)}
_FUNCTIONS = {column.name: column.source for column in COLUMNS.values() if callable(column.source)}
_OVER_ALPHA = tuple(column.name for column in COLUMNS.values() if column.over_alpha)
_read_fields = attrgetter(*_FIELDS.values())


def cells(runs: Sequence[StudyRun], requested: Container[str] = COLUMNS) -> dict[str, list[Any]]:
    """Return the columns of peaks.csv of n finished ``runs``, lists of length n; rotations over α, None if not applicable.

    Columns computed by functions are left out unless ``requested``.
    """
    table: dict[str, list[Any]] = {
        "record": [run.record.name for run in runs],
        "station": [run.record.of_station for run in runs],
        "case": [run.case.name for run in runs],
        "polarity": [run.polarity for run in runs],
        "scale": [run.scale for run in runs],
        MIRROR_OF: [run.mirror_of for run in runs],
    }
    varied = dict.fromkeys(name for case in {id(run.case): run.case for run in runs}.values() for name in case.columns)
    table |= {name: [run.case.columns.get(name) for run in runs] for name in varied}
    table |= zip(_FIELDS, map(list, zip(*(_read_fields(run.outcome) for run in runs), strict=True)), strict=True)
    table |= {name: [function(run) for run in runs] for name, function in _FUNCTIONS.items() if name in requested}
    alpha = [run.case.pier.alpha for run in runs]
    for name in filter(table.__contains__, _OVER_ALPHA):
        table[name] = [None if x is None else x / a for x, a in zip(table[name], alpha, strict=True)]
    for name in table.keys() & FACTS:
        table[name] = [None if holds is None else int(holds) for holds in table[name]]
    return table


def row(run: StudyRun) -> dict[str, object]:
    """Return the row of a finished run in peaks.csv, with all optional columns; None where one does not apply."""
    return {name: values[0] for name, values in cells([run]).items()}


def unusable_rows(motions: MotionSet) -> list[dict[str, object]]:
    """Return the cells record, status, failure and reason of peaks.csv for each file that could not be used."""
    status: dict[str, object] = {"status": "failed", "failure": Failure.UNUSABLE.value}
    return [status | {"record": file.name, "reason": f"{file.source}: {file.reason}"} for file in motions.unusable]


def columns(study: Study) -> list[str]:
    """Return the column names of ``study``'s peaks.csv in order: fixed, varied, trailing, then requested ones."""
    requested = [column for column in OPTIONAL if column.requested_by(study)]
    return [*names(FIXED), *study.varied, *names(TRAILING), *names(requested)]


def units(study: Study) -> dict[str, str]:
    """Return the units of the numeric columns of ``study``'s peaks.csv except varied keys; "1" for dimensionless."""
    described = (COLUMNS[name] for name in columns(study) if name in COLUMNS)
    return {column.name: column.unit for column in described if column.kind != "text"}


def with_units(table: "pd.DataFrame", of_columns: Mapping[str, str]) -> "pd.DataFrame":
    """Set ``table.attrs["units"]`` to the units of its columns, and return the same table."""
    table.attrs["units"] = ColumnUnits(of_columns)
    return table


def as_table(rows: Iterable[Mapping[str, object]], study: Study) -> "pd.DataFrame":
    """Return rows of peaks.csv as a DataFrame with the study's columns: "" for missing texts, NaN for numbers, <NA> for counts.

    Varied keys keep their values; further cells are left out.
    """
    table, varied = list(rows), set(study.varied)
    cells = {name: [row.get(name) for row in table] for name in columns(study)}
    return pd.DataFrame({name: values if name in varied else _typed(name, values) for name, values in cells.items()})


def read_cells(cells: Mapping[str, str]) -> dict[str, float | str | None]:
    """Convert the cells of a row of peaks.csv to numbers; texts stay, and words of varied keys; an empty number is None."""
    return {name: _value(name, text) for name, text in cells.items()}


def _value(name: str, text: str) -> float | str | None:
    """Return a cell of column ``name``: texts and words as they are, a count as int, a number as float, an empty one None."""
    if name in TEXTS:
        return text
    if text == "":
        return None
    if name in COUNTS:
        return int(text)
    try:
        return float(text)
    except ValueError:  # a varied key such as kinematics
        return text


def as_series(cells: Mapping[str, object]) -> "pd.Series":
    """Return a row of peaks.csv as a Series named after its record, without varied keys.

    Optional columns are there only if they have a value; other missing cells are "", NaN or <NA>.
    """
    present = [column for column in OPTIONAL if cells.get(column.name) is not None]
    columns = names((*FIXED, *TRAILING, *present))
    values = [
        _as_in_table(name, cells.get(name)) for name in columns
    ]  # making a table of one row takes ten times as long
    return pd.Series(values, index=columns, dtype=object, name=str(cells["record"]))


def _as_in_table(name: str, value: Any) -> object:
    """Return a cell as a row of :func:`as_table` has it: "" for a missing text, NaN for a number, <NA> for a count."""
    if name in TEXTS:
        return "" if value is None else value
    if name in COUNTS:
        return pd.NA if value is None else np.int64(value)
    return np.float64(math.nan if value is None else value)


NEEDED = (
    "record",
    "case",
    "polarity",
    "scale",
    "status",
    "flight_s",
    "theta_max_over_alpha",
    "theta_max_error",
    "chaotic",
    "may_overturn",
)
"""Columns without which an unsuccessful run could pass for a good one."""


def given_table(table: object, varied: Sequence[str]) -> "pd.DataFrame":
    """Return a user's rows of peaks.csv, filtered or from ``pandas.read_csv``, with "" for missing texts and numbers as floats.

    Raises ``InputError`` if it is no DataFrame, lacks a column of :data:`NEEDED`, has words for numbers, a status of no run, or
    repeats a run.
    """
    if not isinstance(table, pd.DataFrame):
        raise InputError(f"expected the table that rockbatch.run returned, not {type(table).__name__}")
    if wrong := [name for name in (*NEEDED, *varied) if list(table).count(name) != 1]:
        raise InputError(f"the table needs these columns once each, as rockbatch.run returned it: {', '.join(wrong)}")
    rows = table.reset_index(drop=True)
    for name in rows:
        if name in TEXTS:
            rows[name] = texts_in(rows[name])
        elif name in COLUMNS or name in varied:
            rows[name] = numbers_or_words(rows[name].astype(object))
            if rows[name].dtype != "float64" and name not in varied:
                word = next(cell for cell in rows[name].dropna() if math.isnan(pd.to_numeric(cell, errors="coerce")))
                raise InputError(f"{name} = {shown(str(word))}: expected a number")
    known = rows["status"].isin(("", *STATUSES))
    if not known.all():
        word = rows.loc[~known, "status"].iloc[0]
        raise InputError(f"status = {shown(word)}: expected one of {', '.join(map(shown, STATUSES))}")
    twice = (rows["case"] != "") & rows.duplicated(["record", "case", "polarity", "scale", *varied])
    if twice.any():
        record, case = rows.loc[twice, ["record", "case"]].iloc[0]
        raise InputError(f"the table has a run of {record}, case {case}, twice; leave one out")
    return rows


def numbers_or_words(cells: "pd.Series") -> "pd.Series":
    """Convert the cells of a varied key to floats if all are numbers; else keep words such as "finite"; NaN for empty ones."""
    filled = cells.where(cells.notna() & (cells != ""))
    numbers = pd.to_numeric(filled, errors="coerce")
    return filled if (numbers.isna() & filled.notna()).any() else numbers.astype("float64")


def _typed(name: str, values: list[Any]) -> Any:
    """Return the cells of a column with its type, as :func:`as_table` has them."""
    if name in TEXTS:
        return ["" if value is None else value for value in values]
    return pd.array(values, dtype="Int64") if name in COUNTS else np.array(values, dtype=np.float64)
