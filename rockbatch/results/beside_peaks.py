"""Tables beside peaks.csv with rows for each simulated run, and a copy of peaks.csv for spreadsheets."""

import csv
import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from rockbatch.common.errors import InputError
from rockbatch.common.files import csv_text, opened_text, read_table, replacing, write_whole
from rockbatch.common.lazy import pd
from rockbatch.motions import Motion
from rockbatch.pier import Pier
from rockbatch.quantities.catalogue import TEXTS
from rockbatch.quantities.rows import PEAKS, as_in_peaks, simulated, with_case
from rockbatch.results.labelled import Row
from rockbatch.study import Study

NAMING = ("record", "case", "polarity", "scale")
"""Columns that identify a run, together with the varied keys."""

SEMICOLONS = "peaks_semicolon.csv"
"""peaks.csv for Excel with decimal commas."""

LARGEST = "9,99E+307"
"""Stands for infinity: the largest round number that Excel accepts."""


class SimulatedRun(NamedTuple):
    """A simulated run: its identity and peak as in peaks.csv, its motion along the axis of its case, unscaled, and its pier."""

    row: Row
    motion: Motion
    scale: float
    pier: Pier


def runs(peaks: "pd.DataFrame", study: Study, motions: Sequence[Motion]) -> Iterator[SimulatedRun]:
    """Yield the simulated runs of ``peaks`` in its order, without mirror images and unusable files."""
    records = {motion.name: motion for motion in motions}
    cases = {case_key(case.name, case.columns, study.varied): case for case in study.cases}
    columns_kept = [*NAMING, *study.varied, "status", "theta_max_over_alpha"]
    table = simulated(with_case(peaks))[columns_kept]
    for cells in table.to_dict("records"):
        row = {str(name): value for name, value in cells.items()}
        case = cases[case_key(row["case"], row, study.varied)]
        yield SimulatedRun(row, case.motion(records[row["record"]]), float(row["scale"]), case.pier)


def write(path: Path, table: Iterable[Mapping[str, object]]) -> Path:
    """Write rows with the same keys to a CSV, completely or not at all; return its path. No rows give ``NAMING`` as heads."""
    rows = list(table)
    write_whole(path, csv_text(list(rows[0]) if rows else list(NAMING), rows))
    return path


def present(path: Path, key: str) -> Path:
    """Return ``path``; raise ``InputError`` if there is no such file, with the ``key`` of a study that asks for it."""
    if not path.exists():
        raise InputError(f"{path}: not there; add {key} to the study and start `rockbatch run` again")
    return path


def read_beside(
    path: Path, varied: Sequence[str], columns: Iterable[str], texts: Collection[str] = ()
) -> "pd.DataFrame":
    """Read a table beside peaks.csv, with "" for empty texts.

    A table without rows, of a study whose runs have none, has heads for its runs only, and gets the ``columns``.

    Raises ``InputError`` if a column that names the run or one of ``columns`` is missing, or if one of these that is not in
    ``texts`` is not numeric.
    """
    table = read_table(path, texts)
    if table.empty and list(table) == list(NAMING):
        return table.reindex(columns=[*NAMING, *varied, *columns])
    wrong = [f"column {name} is missing" for name in (*NAMING, *varied, *columns) if name not in table]
    numbers = [name for name in columns if name in table and name not in texts]
    wrong += [f"column {name} has texts" for name in numbers if not pd.api.types.is_numeric_dtype(table[name])]
    if wrong:
        why = "the file was changed, or written by an earlier version"
        raise InputError(f"{path}: {wrong[0]}: {why}; start `rockbatch run` again")
    # As in peaks.csv, with which it is merged: the nominal design has an empty bound
    return table.fillna({name: "" for name in TEXTS if name in table})


def write_semicolons(directory: Path) -> Path:
    """Write a copy of peaks.csv with semicolons and decimal commas; return its path.

    The file begins with a byte order mark, by which Excel recognises UTF-8. Texts are unchanged.
    """
    path = directory / SEMICOLONS
    with (
        opened_text(directory / PEAKS) as file,
        replacing(path) as temporary,
        temporary.open("w", encoding="utf-8-sig", newline="") as written,
    ):
        reader, writer = csv.reader(file), csv.writer(written, delimiter=";", lineterminator="\r\n")
        head = next(reader)
        writer.writerow(head)
        for row in reader:
            writer.writerow(
                [cell if name in TEXTS else _with_comma(cell) for name, cell in zip(head, row, strict=True)]
            )
    return path


def _with_comma(cell: str) -> str:
    """Return a cell with a decimal comma if it is a number, +infinity as :data:`LARGEST`; words and empty cells unchanged."""
    try:
        return LARGEST if float(cell) == math.inf else cell.replace(".", ",")
    except ValueError:
        return cell


def case_key(case: str, columns: Mapping[str, object], varied: Sequence[str]) -> tuple[object, ...]:
    """Return the key of a case: its name and its varied values as peaks.csv has them."""
    return (case, *(as_in_peaks(columns.get(name)) for name in varied))
