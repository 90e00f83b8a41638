"""Files that are probably meant by paths at which nothing can be read."""

import os
import re
from collections.abc import Sequence
from pathlib import Path

from rockbatch.common.errors import InputError, NotFound
from rockbatch.common.grouping import closest
from rockbatch.common.showing import shown
from rockbatch.toml.section import Section


def unreadable(path: Path, error: OSError, sections: Sequence[Section]) -> InputError:
    """Return the error about a file of ``sections`` that cannot be opened, with files that may be meant."""
    if isinstance(error, FileNotFoundError):
        return NotFound(f"{path}: no such file{nearby(path, str(path))}")
    if path.is_dir():
        inside = [file for file in sorted(path.glob("*.toml")) if _has_required(file, sections)][:3]
        hint = f"did you mean {' or '.join(map(str, inside))}?" if inside else "give a study file, such as pier.toml"
        what = "a folder of results" if (path / "run.json").is_file() else "a folder"
        return NotFound(f"{path}: {what}; {hint}")
    return NotFound(f"{path}: cannot be read: {error.strerror or error}")


def _has_required(file: Path, sections: Sequence[Section]) -> bool:
    """Return whether a file has a header of each table that is required, as no file of rules has; False if it cannot be read."""
    try:
        text = file.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return False
    names = [re.escape(".".join(section.at)) for section in sections if section.required]
    return all(re.search(rf"^[ \t]*\[+[ \t]*{name}[ \t]*\]", text, re.MULTILINE) for name in names)


# slashes for backslashes, and for characters that TOML made of these, as the line break in "C:\new"
_SLASHED = str.maketrans({"\\": "/", "\n": "/n", "\t": "/t", "\r": "/r", "\b": "/b", "\f": "/f", "\x1b": "/e"})


def _spelt_out(path: Path, written: str) -> str | None:
    """Return the path probably meant: the folder of a pattern (records/*.AT2), one with variables filled in, an address file://
    as a path.

    None for another path, or if there is nothing at the one meant.
    """
    folder = Path(written).parent.as_posix()
    if any(sign in path.name for sign in "*?[") and path.parent.is_dir() and folder != ".":
        return folder
    other = os.path.expandvars(written.removeprefix("file://"))
    return other if other != written and Path(other).expanduser().exists() else None


def nearby(path: Path, written: str) -> str:
    """Return "; did you mean …?" with the path that is probably meant, in the form of ``written``; "" for none.

    It is ``written`` with slashes if it has backslashes, which begin other characters in a text of TOML, whether there is such a
    file or not; else that of :func:`_spelt_out`; else a file of similar name beside ``path``.
    """
    if (slashed := written.translate(_SLASHED)) != written:
        return f"; did you mean {shown(slashed)}? Slashes do on every system"
    if (other := _spelt_out(path, written)) is not None:
        return f"; did you mean {shown(other)}?"
    try:
        names = os.listdir(path.parent)
    except OSError:
        return ""
    longer = [name for name in names if name.startswith(f"{path.name}.")]
    nearest = next((name for name in (f"{path.name}.toml", *longer) if len(longer) == 1 and name in names), None)
    nearest = nearest or closest(path.name, sorted(names))
    return f"; did you mean {(Path(written).parent / nearest).as_posix()}?" if nearest else ""
