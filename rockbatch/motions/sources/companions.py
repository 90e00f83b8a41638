"""Files beside a record, by their names: its step and count, as FEMA P-695's programs write them, and its velocities.

``SortedEQFile_(120111).txt`` has the samples, ``DtFile_(120111).txt`` the step [s], ``NumPointsFile_(120111).txt`` the count.
STA_vel.txt has the velocities of STA_acc.txt.
"""

import re
from collections.abc import Sequence
from pathlib import Path

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import grouped
from rockbatch.motions.sources import archives
from rockbatch.motions.sources.files import SourceFile

_NAMED = re.compile(
    r"(?P<kind>(?:Sorted)?EQ_?File|Dt_?File|NumPoints?_?File)_?\(?(?P<number>[\w-]+?)\)?", re.IGNORECASE
)
_KEYS = {"DT": "DT = {} s", "NU": "NPTS = {}"}
_LONGEST = 100  # bytes of a file that holds a number
_WORDS = {
    "acceleration": ("acc accel acceleration accelerations aceleracion", "a"),
    "velocity": ("vel velo velocity velocities velocidad", "v"),
    "displacement": ("dis disp displ displacement displacements desplazamiento", "d"),
}
_QUANTITIES = {word: (what, False) for what, (words, _) in _WORDS.items() for word in words.split()}
_QUANTITIES |= {letter: (what, True) for what, (_, letter) in _WORDS.items()}
_WORD = re.compile(
    rf"(?<![A-Za-z])(?:{'|'.join(sorted(_QUANTITIES, key=len, reverse=True))})(?![A-Za-z])", re.IGNORECASE
)


def statements_beside(files: Sequence[SourceFile]) -> tuple[dict[Path, tuple[str, ...]], dict[Path, str]]:
    """Return header lines by record, "DT = 0.01 s" and "NPTS = 4000", and by file that states them "a statement about RECORD".

    A step or count file without its record beside it, or with anything but a number in it, is in neither.
    """
    matches = [(file, match) for file in files if (match := _NAMED.fullmatch(file.path.stem))]
    named = {(file.path.parent, match["kind"][:2].upper(), match["number"]): file for file, match in matches}
    stated: dict[Path, tuple[str, ...]] = {}
    companions: dict[Path, str] = {}
    for (folder, kind, number), file in named.items():
        record = next((named[key] for sort in ("SO", "EQ") if (key := (folder, sort, number)) in named), None)
        if kind in _KEYS and record is not None and (text := _number(file.path)):
            stated[record.path] = (*stated.get(record.path, ()), _KEYS[kind].format(text))
            companions[file.path] = f"a statement about {record.path.name}"
    return stated, companions


def _number(path: Path) -> str:
    """Return the only number in a file as text; "" if the file holds anything else or cannot be read."""
    try:
        text = archives.content(path, _LONGEST + 1).decode("latin-1").strip()
        float(text)
    except (InputError, OSError, ValueError):
        return ""
    return text


def companions_by_quantity(files: Sequence[SourceFile]) -> dict[Path, str]:
    """Return by path "the velocity of a record", or displacement, for files whose names differ from the record's in that word.

    Single letters count only if there are all three: V alone is vertical.
    """
    entries = []
    for file in files:
        bare = archives.bare(file.path)
        for match in _WORD.finditer(bare.stem):
            what, is_letter = _QUANTITIES[match[0].lower()]
            around = (bare.stem[: match.start()], bare.stem[match.end() :], bare.suffix.lower(), is_letter)
            entries.append(((file.path.parent, *around), what, file.path))
    companions: dict[Path, str] = {}
    for (*_, is_letter), of_name in grouped(entries, lambda entry: entry[0]).items():
        kinds = {what for _, what, _ in of_name}
        if "acceleration" in kinds and (not is_letter or len(kinds) == len(_WORDS)):
            companions |= {path: f"the {what} of a record" for _, what, path in of_name if what != "acceleration"}
    return companions
