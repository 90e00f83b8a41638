"""What PEER's search lists of the records beside it, in ``_SearchResults.csv``: scale factor, event, site, duration and pulse."""

import csv
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from rockbatch.common.errors import InputError
from rockbatch.motions import archives
from rockbatch.motions.files import SourceFile
from rockbatch.motions.listed import NOTHING, Listed
from rockbatch.motions.record_file import text_of

NAME = "_searchresults.csv"
_LARGEST = 2**24  # bytes; a search of a hundred records with its spectra has 0.3 MB
_NUMBER, _FILE = "record sequence number", re.compile(r"(?:horizontal-[12]|vertical) acc\. filename")
_KEYS = {  # beginnings of heads, in the order in which they are looked for
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
    """Return what the lists among these files say, by the folder of each and the records in it; none of one that is damaged."""
    lists: dict[tuple[Path, str], Listed] = {}
    for file in files:
        if file.path.name.lower() == NAME and not file.refusal:
            try:
                rows = _rows(text_of(archives.content(file.path, _LARGEST)))
            except (InputError, OSError, csv.Error):
                continue
            for row in rows:
                of_record = _listed(row)
                names = [f"RSN{row[_NUMBER].strip()}"]
                names += [
                    Path(name.strip()).name.lower() for head, name in row.items() if _FILE.match(head) and name.strip()
                ]
                lists.update({(file.path.parent, name): of_record for name in names})
    return lists


def of_file(lists: Lists, path: Path, site: str) -> Listed:
    """Return what the list in a file's folder says of it, by its name or by its number, ``site``."""
    return lists.get((path.parent, path.name.lower())) or lists.get((path.parent, site)) or NOTHING


def _rows(text: str) -> list[dict[str, str]]:
    """Return the rows of the table that has a column of records' numbers, by its heads in lower case, down to another line."""
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
    heads = {key: [head for start in starts for head in row if head.startswith(start)] for key, starts in _KEYS.items()}
    values = {key: _above_0(row[of_key[0]]) for key, of_key in heads.items() if of_key}
    return Listed(**values)


def _above_0(cell: str) -> float | None:
    """Return the number of a cell; ``None`` where it has none, or -999 and the like."""
    try:
        value = float(cell)
    except ValueError:
        return None
    return value if math.isfinite(value) and value > 0.0 else None
