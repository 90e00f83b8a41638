"""PEER's ``_SearchResults.csv`` beside its records: scale factor, event, site, duration and pulse of each."""

import csv
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from rockbatch.common.errors import InputError
from rockbatch.motions.sources import archives
from rockbatch.motions.sources.files import SEARCH_RESULTS, SourceFile
from rockbatch.motions.sources.listed import NOT_LISTED, Listed
from rockbatch.motions.sources.record_file import text_of

_LARGEST = 2**24  # bytes; a search of a hundred records with its spectra has 0.3 MB
_NUMBER, _FILE = "record sequence number", re.compile(r"(?:horizontal-[12]|vertical) acc\. filename")
_KEYS = {  # beginnings of column heads, in the order of preference
    "scale": ("scale factor",),
    "magnitude": ("magnitude",),
    "distance_km": ("rrup", "closstdist", "rjb"),
    "vs30_m_s": ("vs30",),
    "d5_95_s": ("5-95% duration",),
    "pulse_period_s": ("tp",),
}


Lists = Mapping[tuple[Path, str], Listed]
"""By folder, and by number ("RSN779") or name of file in lower case."""


def listed_in(files: Sequence[SourceFile]) -> Lists:
    """Return the rows of all undamaged lists among these files, by folder and by "RSN779" or file name of the record."""
    lists: dict[tuple[Path, str], Listed] = {}
    for file in files:
        if file.path.name.lower() == SEARCH_RESULTS and not file.refusal:
            try:
                rows = _rows(text_of(archives.content(file.path, _LARGEST)))
            except (InputError, OSError, csv.Error):
                continue
            for row in rows:
                record_files = [name.strip() for head, name in row.items() if _FILE.match(head) and name.strip()]
                keys = [f"RSN{row[_NUMBER].strip()}", *(Path(name).name.lower() for name in record_files)]
                lists.update(dict.fromkeys(((file.path.parent, key) for key in keys), _listed(row)))
    return lists


def of_file(lists: Lists, path: Path, site: str) -> Listed:
    """Return the row of a file in its folder's list, by its name or its number ``site``; ``NOT_LISTED`` if neither is listed."""
    return lists.get((path.parent, path.name.lower())) or lists.get((path.parent, site)) or NOT_LISTED


def _rows(text: str) -> list[dict[str, str]]:
    """Return rows, by heads in lower case, below the heads with a record number up to the first row without; [] without heads."""
    rows: list[dict[str, str]] = []
    heads: list[str] = []
    for cells in csv.reader(text.splitlines(), skipinitialspace=True):
        lower = [cell.strip().lower() for cell in cells]
        if not heads:
            heads = lower if _NUMBER in lower else []
            continue
        row = dict(zip(heads, cells, strict=False))
        if not row.get(_NUMBER, "").strip().isdecimal():
            break
        rows.append(row)
    return rows


def _listed(row: Mapping[str, str]) -> Listed:
    """Return the facts in a row; None for those whose column is missing, or whose value is no number above 0."""
    values = {}
    for key, beginnings in _KEYS.items():
        heads = [head for beginning in beginnings for head in row if head.startswith(beginning)]
        values[key] = _above_0(row[heads[0]]) if heads else None
    return Listed(**values)


def _above_0(cell: str) -> float | None:
    """Return the number in a cell; ``None`` for no number, and for -999 and others not above 0."""
    try:
        value = float(cell)
    except ValueError:
        return None
    return value if math.isfinite(value) and value > 0.0 else None
