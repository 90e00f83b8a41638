"""The files of folders: possible records, other files, and those that must not be opened."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from rockbatch.common.errors import InputError
from rockbatch.common.files import legible
from rockbatch.motions.sources import archives
from rockbatch.motions.sources.own_files import OWN, is_own

MANIFESTS = ("motions.toml", "motions.csv")

_COMPANIONS = {
    "text about the records": ".json .md .rst .pdf .doc .docx .htm .html .log .toml .yml .yaml .bib .tex .geojson .kml .kmz .url "
    ".cff .ini .cfg",
    "a spreadsheet, which is not opened; if it holds records, save its sheets as CSV (UTF-8)": ".xls .xlsx .xlsm .ods",
    "a file of the operating system": ".db .lnk",
    "a picture": ".png .jpg .jpeg .gif .svg .svgz .tif .tiff .ps .eps",
    "a program": ".py .m .ipynb .r .sh",
    "the velocity of a record": ".vt2 .vel",
    "the displacement of a record": ".dt2 .disp .dis",
}
_BY_SUFFIX = {suffix: what for what, suffixes in _COMPANIONS.items() for suffix in suffixes.split()}
_NAMES = {"license", "licence", "copying", "notice", "authors", "citation", "contributing", "changelog", "index"}
_INVENTORY = ".xml"
_OUTSIDE = "a link that leads out of the folder; copy the file into it"
SEARCH_RESULTS = "_searchresults.csv"
"""Name, in lower case, of the list of a search in PEER's database, beside its records."""


@dataclass(frozen=True)
class SourceFile:
    """A file of a folder, or of an archive in it."""

    path: Path  # continued within an archive (see archives)
    source: str  # its short path for people
    refusal: str = ""  # why it must not be opened; empty for a possible record
    companion: str = ""  # its kind if it is no record: "a picture"; empty for a possible record

    @property
    def is_inventory(self) -> bool:
        """Return whether it may be StationXML, by the suffix .xml or .xml.gz."""
        return archives.bare(self.path).suffix.lower() == _INVENTORY


def files_of(roots: Sequence[Path]) -> Iterator[SourceFile]:
    """Yield the files of ``roots`` in turn, sorted within a folder, each real file once; instead of an archive its files.

    Hidden and read-me files below a folder are skipped. A link to a folder or out of the folder, a closed folder, a pipe, and an
    unreadable or empty archive come with a refusal.
    """
    visited: set[Path] = set()
    for root in roots:
        prefix = f"{root.absolute().name}/" if len(roots) > 1 and root.is_dir() else ""
        inside = Path(os.path.realpath(root if root.is_dir() else root.parent))
        for path in sorted(_paths_below(root)) if root.is_dir() else [root]:
            real = Path(os.path.realpath(path))
            if real in visited:
                continue
            visited.add(real)
            source = legible(prefix + path.relative_to(root).as_posix() if path != root else path.name)
            if path != root and not real.is_relative_to(inside):
                yield SourceFile(path, source, _OUTSIDE)
            elif real.is_dir():
                refusal = "a link to a folder, not followed" if path.is_symlink() else "a folder that cannot be opened"
                yield SourceFile(path, source, refusal)
            elif not real.is_file():
                yield SourceFile(path, source, "not a regular file")
            elif archives.is_archive(path):
                yield from _of_archive(path, source)
            else:
                yield _source_file(path, source)


def inventories_beside(file: Path) -> list[SourceFile]:
    """Return the .xml and .xml.gz files in the folder of ``file``, sorted; a link that leads out of the folder has a refusal."""
    inside = Path(os.path.realpath(file.parent))
    beside = []
    for path in archives.files_in(file.parent):
        outside = not Path(os.path.realpath(path)).is_relative_to(inside)
        beside.append(SourceFile(path, path.name, _OUTSIDE if outside else ""))
    return [source for source in beside if source.is_inventory]


def _of_archive(path: Path, source: str) -> Iterator[SourceFile]:
    """Yield the files of an archive; the archive itself, with the reason as its refusal, if it cannot be read or is empty."""
    try:
        members = list(archives.members(path))
        refusal = "" if members else "an archive without files"
    except InputError as error:
        members, refusal = [], "; ".join(error.messages)
    except OSError as error:
        members, refusal = [], f"cannot be read: {error.strerror or error}"
    if refusal:
        yield SourceFile(path, source, refusal)
    for member in members:
        name = f"{source}/{legible(member.name)}"
        regular = _source_file(member.path, name)
        if member.refusal and not regular.companion:
            yield SourceFile(member.path, name, member.refusal)
        elif member.path.name in MANIFESTS:
            yield SourceFile(
                member.path, name, companion="a manifest within an archive is not obeyed; put it beside that"
            )
        else:
            yield regular


def _source_file(path: Path, source: str) -> SourceFile:
    """Return a regular file, as a ``companion`` if it is known to be no record, with a ``refusal`` if it is an archive not read.

    It is known by its name (license.txt), its suffix (.pdf), or content that this program wrote. A manifest is neither.
    """
    if path.name.lower() == SEARCH_RESULTS:
        return SourceFile(path, source, companion="a table about the records")
    suffix = archives.bare(path).suffix.lower()
    if path.stem.lower() in _NAMES and suffix in ("", ".txt"):
        return SourceFile(path, source, companion="text about the records")
    if path.name not in MANIFESTS and suffix in _BY_SUFFIX:
        return SourceFile(path, source, companion=_BY_SUFFIX[suffix])
    if path.name not in MANIFESTS and is_own(path):
        return SourceFile(path, source, companion=OWN)
    return SourceFile(path, source, archives.not_read(path))


def _paths_below(folder: Path) -> Iterator[Path]:
    """Yield the files in and below a folder but hidden and read-me ones; links to folders and closed folders as they are."""
    closed: list[Path] = []
    for parent, folders, files in os.walk(folder, onerror=lambda error: closed.append(Path(error.filename))):
        folders[:] = [name for name in folders if not name.startswith(".")]
        links = [name for name in folders if os.path.islink(os.path.join(parent, name))]
        for name in [*files, *links]:
            if not name.startswith(".") and not archives.is_read_me(name):
                yield Path(parent, name)
    yield from closed
