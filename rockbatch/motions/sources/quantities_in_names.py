"""Files of velocities and displacements beside a record, told by their names alone: STA_vel.txt beside STA_acc.txt."""

import re
from collections.abc import Sequence
from pathlib import Path

from rockbatch.common.grouping import grouped
from rockbatch.motions.sources import archives
from rockbatch.motions.sources.files import SourceFile

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


def companions_by_quantity(files: Sequence[SourceFile]) -> dict[Path, str]:
    """Return by path "the velocity of a record" or "the displacement of a record" for files called otherwise than the record in
    this word alone.

    Single letters count only if there are all three: V alone is vertical.
    """
    found = []
    for file in files:
        bare = archives.bare(file.path)
        for match in _WORD.finditer(bare.stem):
            what, is_letter = _QUANTITIES[match[0].lower()]
            around = (bare.stem[: match.start()], bare.stem[match.end() :], bare.suffix.lower(), is_letter)
            found.append(((file.path.parent, *around), what, file.path))
    companions: dict[Path, str] = {}
    for (*_, is_letter), of_name in grouped(found, lambda entry: entry[0]).items():
        kinds = {what for _, what, _ in of_name}
        if "acceleration" in kinds and (not is_letter or len(kinds) == len(_WORDS)):
            companions |= {path: f"the {what} of a record" for _, what, path in of_name if what != "acceleration"}
    return companions
