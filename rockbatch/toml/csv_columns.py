"""Columns of small CSV files that a study names, such as a hazard curve or the measured values of a test."""

import csv
import math
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import closest
from rockbatch.common.showing import shown
from rockbatch.toml.kinds import Kind, KindError, Text
from rockbatch.toml.reader import TomlFile

MOST_ROWS = 100_000


def columns_of(path: Path, kinds: Mapping[str, Kind], *, gaps: bool = False) -> dict[str, list[Any]]:
    """Return the columns of a CSV file by the names in its heading, of equal length, with values of these ``kinds``.

    Lines that begin with # are comments, and rows of empty cells alone are skipped. With semicolons between the cells, decimals
    may have commas. With ``gaps`` a cell that is empty or "nan" is NaN. Raises ``InputError`` for an unknown or repeated
    column, with the first 20 cells that are not of their kind and lines with fewer or more cells than names, for a file without
    a row below its heading, and as :meth:`TomlFile.text_of`. A column of ``kinds`` that the file lacks is no error.
    """
    rows, delimiter = _rows(path)
    names = _names(path, *rows[0], kinds)
    columns: dict[str, list[object]] = {name: [] for name in names}
    wrong: list[str] = []
    for number, cells in rows[1:]:
        if len(cells) != len(names):
            wrong.append(
                f"{path}:{number}: {len(cells)} cells below {len(names)} column names; write one in each column"
            )
        elif any(cells):
            for name, cell in zip(names, cells, strict=True):
                try:
                    columns[name].append(_value(cell, kinds[name], delimiter, gaps))
                except KindError as error:
                    wrong.append(f"{path}:{number}: {name} = {shown(cell)}: {error.advice()}")
    if wrong:
        raise InputError(*wrong[:20])
    return columns


def heading_of(path: Path) -> list[str]:
    """Return the names of the columns of a CSV file, as its first line that is no comment has them, unchecked.

    Raises ``InputError`` without a row below it.
    """
    return _rows(path)[0][0][1]


def _rows(path: Path) -> tuple[list[tuple[int, list[str]]], str]:
    """Return the numbers and cells of the lines that are neither blank nor comments, the heading first, and the delimiter.

    That is a semicolon if the heading has one, else a comma. Cells have no blanks at their ends. Raises ``InputError`` for a
    file without a row below its heading, or of more than :data:`MOST_ROWS` lines.
    """
    numbered = enumerate(TomlFile.text_of(path).splitlines(), 1)
    lines = [(number, line) for number, line in numbered if line.strip() and not line.lstrip().startswith("#")]
    if len(lines) < 2:
        raise InputError(f"{path}: expected a line of column names, and a line for each row below it")
    if len(lines) > MOST_ROWS:
        raise InputError(f"{path}: {len(lines):,} lines; at most {MOST_ROWS:,} are read")
    delimiter = ";" if ";" in lines[0][1] else ","
    return [
        (number, [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter))]) for number, line in lines
    ], delimiter


def _names(path: Path, number: int, names: Sequence[str], known: Collection[str]) -> Sequence[str]:
    """Return the ``names`` of the heading in line ``number``. Raises ``InputError`` for an unknown or a repeated one."""
    for name in names:
        if name not in known:
            nearest = closest(name, known)
            instead = f"did you mean {nearest}?" if nearest else f"write one of {', '.join(known)}"
            raise InputError(f"{path}:{number}: {shown(name)}: unknown column; {instead}")
    if len(set(names)) < len(names):
        raise InputError(f"{path}:{number}: a column occurs twice")
    return names


def _value(cell: str, kind: Kind, delimiter: str, gaps: bool) -> object:
    """Return the value of a cell; with ``gaps`` "" and "nan" are NaN. Raises :class:`KindError` for one of another ``kind``.

    With the ``delimiter`` ";" a number may have a decimal comma. "1_0" is no number.
    """
    if gaps and cell.lower() in ("", "nan"):
        return math.nan
    if isinstance(kind, Text):
        return kind(cell)
    if "_" in cell:  # Python reads 1_0 as 10, but in a table it is a slip
        raise KindError(kind.words)
    try:
        value = float(cell.replace(",", ".") if delimiter == ";" else cell)
    except ValueError:
        raise KindError(kind.words) from None
    return kind(value)
