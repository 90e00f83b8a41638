"""Columns of small CSV files that a study names, such as a hazard curve."""

import csv
import io
from collections.abc import Collection, Sequence
from pathlib import Path

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import closest
from rockbatch.toml.kinds import shown
from rockbatch.toml.reader import TomlFile

MOST_ROWS = 100_000


def columns_of(path: Path, known: Collection[str], texts: Collection[str] = ()) -> dict[str, list[float | str]]:
    """Return the columns of a CSV file by their names in its first line, all as long: numbers, or ``texts``.

    Lines that begin with # are remarks. With semicolons between the cells, decimals may have commas. Raises ``InputError`` with
    the file and the line for a column that is not ``known``, a cell that is no number, or a line that is too short.
    """
    lines = [
        (number, line)
        for number, line in enumerate(TomlFile.text_of(path).splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if len(lines) < 2 or len(lines) > MOST_ROWS:
        raise InputError(f"{path}: expected a line of column names, and a line for each row below it")
    delimiter = ";" if ";" in lines[0][1] else ","
    rows = [(number, _cells(line, delimiter)) for number, line in lines]
    names = _names(path, *rows[0], known)
    columns: dict[str, list[float | str]] = {name: [] for name in names}
    wrong: list[str] = []
    for number, cells in rows[1:]:
        if len(cells) != len(names):
            wrong.append(
                f"{path}:{number}: {len(cells)} cells below {len(names)} column names; write one in each column"
            )
            continue
        for name, cell in zip(names, cells, strict=True):
            try:
                columns[name].append(cell if name in texts else _number(cell, delimiter))
            except ValueError:
                wrong.append(f"{path}:{number}: {name} = {shown(cell)}: expected a number")
    if wrong:
        raise InputError(*wrong[:20])
    return columns


def _names(path: Path, number: int, names: Sequence[str], known: Collection[str]) -> Sequence[str]:
    for name in names:
        if name not in known:
            nearest = closest(name, known)
            instead = f"did you mean {nearest}?" if nearest else f"write one of {', '.join(known)}"
            raise InputError(f"{path}:{number}: {shown(name)}: unknown column; {instead}")
    if len(set(names)) < len(names):
        raise InputError(f"{path}:{number}: a column occurs twice")
    return names


def _cells(line: str, delimiter: str) -> list[str]:
    return [cell.strip() for cell in next(csv.reader(io.StringIO(line), delimiter=delimiter))]


def _number(cell: str, delimiter: str) -> float:
    return float(cell.replace(",", ".") if delimiter == ";" else cell)
