"""Records as FEMA P-695's programs write them: a text file each for samples, step and count.

``SortedEQFile_(120111).txt`` has the samples, ``DtFile_(120111).txt`` the step [s], ``NumPointsFile_(120111).txt`` the count.
"""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from rockbatch.common.errors import InputError
from rockbatch.motions.sources import archives
from rockbatch.motions.sources.files import SourceFile

_NAMED = re.compile(
    r"(?P<kind>(?:Sorted)?EQ_?File|Dt_?File|NumPoints?_?File)_?\(?(?P<number>[\w-]+?)\)?", re.IGNORECASE
)
_KEYS = {"DT": "DT = {} s", "NUM": "NPTS = {}"}
_LONGEST = 100  # bytes of a file that holds a number


def statements_beside(files: Sequence[SourceFile]) -> tuple[dict[Path, tuple[str, ...]], dict[Path, str]]:
    """Return header lines by record, "DT = 0.01 s" and "NPTS = 4000", and by file that states them "a statement about RECORD".

    A step or count file without its record beside it, or with anything but a number in it, is in neither.
    """
    named = {
        (file.path.parent, *_kind_and_number(match)): file
        for file in files
        if (match := _NAMED.fullmatch(file.path.stem))
    }
    stated: dict[Path, tuple[str, ...]] = {}
    companions: dict[Path, str] = {}
    for (folder, kind, number), file in named.items():
        record = next((named[key] for sort in ("SOR", "EQF") if (key := (folder, sort, number)) in named), None)
        if kind in _KEYS and record is not None and (text := _number(file.path)):
            stated[record.path] = (*stated.get(record.path, ()), _KEYS[kind].format(text))
            companions[file.path] = f"a statement about {record.path.name}"
    return stated, companions


def _kind_and_number(match: Mapping[str, str] | re.Match[str]) -> tuple[str, str]:
    """Return the kind of a file, "DT", "NUM", "SOR" (SortedEQFile) or "EQF" (EQFile), and the number of its record."""
    kind = match["kind"].upper().replace("_", "")
    return "DT" if kind.startswith("DT") else kind[:3], match["number"]


def _number(path: Path) -> str:
    """Return the only number in a file as text; "" if the file holds anything else or cannot be read."""
    try:
        text = archives.content(path, _LONGEST + 1).decode("latin-1").strip()
        float(text)
    except (InputError, OSError, ValueError):
        return ""
    return text
