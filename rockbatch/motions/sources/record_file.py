"""A file as passed to all readers, and the user's statements for files that lack them."""

import codecs
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError, refuse
from rockbatch.common.units import GRAVITY, acceleration_factor
from rockbatch.motions.limits import SAME_STEP, STEPS, is_step
from rockbatch.motions.sources.stationxml import Inventories

LAYOUTS = ("columns", "wrapped")
"""Layouts of numbers in text files: a column for each component, or one series wrapped over lines."""

ROLES = ("horizontal",)
"""Roles that may be stated for all components of unknown direction."""


_SAME_UNIT = 1e-9  # relative


@checked
@dataclass(frozen=True)
class ReadOptions:
    """A study's statements for files that lack them.

    A file's own statement takes precedence. For headers that people write, as of text columns and AT2 files, a note says so
    if they differ.

    Attributes
    ----------
    unit : str or None
        Unit of the numbers, such as "cm/s2" or "g".
    dt : float or None
        Sampling interval [s] of text columns without time.
    columns : tuple of str or None
        Meaning of the columns of text files: "time", a component such as "000", "NS" or "up", or "-" (leave out).
    role : str or None
        Role of components of unknown direction: "horizontal".
    sensitivity : float or None
        Counts per ``unit`` (per m/s² where no unit is stated) of MiniSEED and SAC files.
    layout : str or None
        "wrapped": a text file without columns is one series wrapped over lines.
    instead : frozenset of str
        Names of these statements, and of ``scale``, that a manifest makes for this file, with precedence over the file's own.

    Examples
    --------
    >>> from pathlib import Path
    >>> _ = Path("shake.txt").write_text("0.0 0.1\\n0.3 0.0\\n-0.2 0.1\\n")
    >>> stated = rb.ReadOptions(unit="g", dt=0.01, columns=("090", "up"))
    >>> rb.read_motions("shake.txt", options=stated)
    <1 ground motion>
      records   shake.090
      PGA       0.300 g
      vertical  1 of 1
    """

    unit: str | None = None
    dt: float | None = None
    columns: tuple[str, ...] | None = None
    sensitivity: float | None = None
    role: str | None = None
    layout: str | None = None
    instead: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        wrong = []
        if self.unit is not None:
            try:
                acceleration_factor(self.unit)
            except ValueError as error:
                wrong.append(f'unit = "{self.unit}": {error}')
        if self.dt is not None and not is_step(self.dt):
            wrong.append(f"dt = {self.dt:g}: must be {STEPS}")
        if self.sensitivity is not None and not (math.isfinite(self.sensitivity) and self.sensitivity != 0):
            wrong.append(f"sensitivity = {self.sensitivity:g}: must be a number other than 0 [counts per unit]")
        if self.role not in (None, *ROLES):
            wrong.append(f'role = "{self.role}": must be "horizontal"; verticals are named one by one, in motions.toml')
        if self.layout not in (None, *LAYOUTS):
            wrong.append(f'layout = "{self.layout}": must be one of {", ".join(LAYOUTS)}')
        if self.columns is not None:
            object.__setattr__(self, "columns", tuple(self.columns))
            if all(name in ("-", "time", "t") for name in self.columns):
                wrong.append(
                    f'columns = {list(self.columns)}: no component among them; write e.g. ["time", "000", "090", "up"]'
                )
        refuse(wrong)

    def with_statement(self, stated: Mapping[str, object]) -> "ReadOptions":
        """Return these options with the statements ``stated`` of a manifest, by field, which replace the file's own."""
        values: dict[str, Any] = dict(stated)
        return replace(self, **values, instead=self.instead.union(stated))

    def overruled(self, unit: str, dt: float, gravity: float) -> tuple[str, ...]:
        """Return notes on the study's unit and step where a file's own ``unit`` or ``dt`` [s] overrules them; () else."""
        notes = []
        if self.unit is not None and "unit" not in self.instead:
            by_file, stated = acceleration_factor(unit, gravity), acceleration_factor(self.unit, gravity)
            if abs(by_file - stated) > _SAME_UNIT * by_file:
                notes.append(f"unit {unit} as the file states; {self.unit} is for files without a unit")
        if self.dt is not None and "dt" not in self.instead and abs(self.dt - dt) > SAME_STEP * dt:
            notes.append(f"dt = {dt:g} s as the file states; {self.dt:g} s is for files without a step")
        return tuple(notes)


def no_acceleration(called: str, kind: str) -> InputError:
    """Return the error for a channel, ``called`` so in its file, with another ``kind`` of samples, "velocities"."""
    return InputError(
        f"{called} holds {kind}, and accelerations are expected; if it does hold them, write unit = … for this file in "
        "motions.toml"
    )


@dataclass(frozen=True)
class RecordFile:
    """A file to be read: its path, its bytes, the study's statements about it, and the StationXML beside it."""

    path: Path
    source: str
    data: bytes
    options: ReadOptions = field(default_factory=ReadOptions)
    gravity: float = GRAVITY
    inventories: Inventories = field(default_factory=Inventories)
    beside: tuple[str, ...] = ()  # lines of a header that other files state: "DT = 0.01 s"

    @property
    def stem(self) -> str:
        """Return the file's name without its suffix."""
        return self.path.stem

    @property
    def text(self) -> str:
        """Return the bytes as text (``text_of``)."""
        return text_of(self.data)


def text_of(data: bytes) -> str:
    """Return the text of bytes: UTF-16 with its mark (Excel's "Unicode text"), else UTF-8, with its mark or not, else Latin-1.

    Raises ``InputError`` for bytes with the mark of UTF-16 which are none.
    """
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        try:
            return data.decode("utf-16")
        except UnicodeDecodeError:
            raise InputError("begins as UTF-16 text, but is not; save it as UTF-8") from None
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")
