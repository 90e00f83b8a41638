"""Statements of the names of record files: stations and directions."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from rockbatch.common.grouping import grouped
from rockbatch.motions.labels.orientation import (
    Orientation,
    accidental,
    counted,
    direction_of_suffix,
    glued,
    in_numbered_sets,
    numbered,
    split_stem,
    told_apart,
)
from rockbatch.motions.sources import archives
from rockbatch.motions.sources.files import SourceFile

_RSN = re.compile(r"RSN[_ ]?0*(\d+)(?!\d)", re.IGNORECASE)


class FileName(NamedTuple):
    """Statements of the name of a file."""

    site: str  # the station's part
    direction: Orientation | None
    site_of_several: str  # the station's part if the file holds several components, and is named after none of them
    glued: tuple[str, Orientation] | None  # station's part and direction if the file states neither


def names_of(files: Sequence[SourceFile]) -> dict[Path, FileName]:
    """Return what each file's name says, its direction by the stem, else by the suffix (.EW), else None.

    The names in one folder decide together whether digits are azimuths, and letters directions. Digits in the name of a file of
    several components are its station's, unless a vertical one has the same site without them: TAF021 and TAF-UP.
    """
    names: dict[Path, FileName] = {}
    for paths in grouped((file.path for file in files), lambda path: path.parent).values():
        stems = {path: archives.bare(path).stem for path in paths}
        by_chance = set.union(*(rule(stems.values()) for rule in (counted, numbered, accidental)))
        apart, in_sets, ends_glued = (rule(stems.values()) for rule in (told_apart, in_numbered_sets, glued))
        alone = {stem: (stem, None) if stem in by_chance else split_stem(stem) for stem in stems.values()}
        ends = grouped(apart.items(), lambda item: item[1][0])
        shared = {site for site, of_site in ends.items() if len({alone[stem][1] for stem, _ in of_site}) == 1}
        of_folder: dict[str, tuple[str, Orientation | None]] = {}
        for stem in stems.values():
            parts = alone[stem]
            # where all names of a site end in x, x is no direction
            if stem in apart and (parts[1] is None or apart[stem][0] in shared):
                parts = apart[stem]
            of_folder[stem] = in_sets.get(stem, parts)
        upright = {site for site, direction in of_folder.values() if direction and direction.vertical}
        for path, stem in stems.items():
            site, direction = of_folder[stem]
            numbered_site = direction is not None and direction.label.isdigit() and site not in upright
            direction = direction or direction_of_suffix(archives.bare(path).suffix)
            end = None if direction else ends_glued.get(stem)
            names[path] = FileName(site, direction, stem if numbered_site else site, end)
    return names


def site_of(path: Path, site: str) -> str:
    """Return the site of a file: "RSN" and its number, else the name's station part ``site``, else its folder (UP.txt)."""
    rsn = _RSN.match(path.stem)
    return f"RSN{rsn[1]}" if rsn else site or path.parent.name
