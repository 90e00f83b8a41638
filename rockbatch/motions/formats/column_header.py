"""What the header of a table says its columns are, in the ways that people write it."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from rockbatch.errors import InputError
from rockbatch.motions.formats.fixed_width import HUGE
from rockbatch.motions.orientation import orientation_of

SECONDS = {"s": 1.0, "sec": 1.0, "secs": 1.0, "second": 1.0, "seconds": 1.0, "ms": 1e-3, "msec": 1e-3}
"""Units of time [s]."""

_UNIT = r"[(\[]\s*(?P<unit>[^()\[\]]+?)\s*[)\]]"
_NUMBERED = re.compile(rf"^column\s+(?P<at>\d{{1,3}})\s*[:=]\s*(?P<label>.*?)\s*{_UNIT}", re.IGNORECASE)
_LABELLED = re.compile(rf"(?P<label>[^\s,;()\[\]][^,;\t()\[\]]*?)\s*{_UNIT}")
_STATED = re.compile(r"^units?\s*[:=]\s*(?P<unit>\S+)", re.IGNORECASE)
_STEP = re.compile(
    r"^(?:dt|delta ?t|time ?step|sampling interval)\s*[:=]\s*(?P<dt>[-+.0-9e]{1,20})\s*(?P<unit>[a-z]*)\.?$",
    re.IGNORECASE,
)
_COUNT = re.compile(
    r"\b(?:npts|(?:number|no\.?) of (?:points|samples))\s*[:=]?\s*(?P<npts>[0-9]{1,12})\b", re.IGNORECASE
)
_SHORT = {"NORTHSOUTH": "NS", "EASTWEST": "EW", "UPDOWN": "UD"}


@dataclass(frozen=True)
class Column:
    """What one column is: its label, and its unit where it is known."""

    label: str
    unit: str | None = None

    @property
    def is_time(self) -> bool:
        """Whether it holds times."""
        return re.sub(r"[^a-z]", "", self.label.lower()) in ("t", "time", "times")


def columns_with_units(header: Sequence[str], width: int) -> list[Column] | None:
    """Columns of which the header tells label and unit; ``None`` where it does not for all of them.

    ``Column 2: North-south acceleration (cm/s/s)``, or in one line ``time(sec) N-S(cm/s/s) …``.
    """
    numbered = {int(m["at"]): Column(_tidy(m["label"]), m["unit"]) for line in header if (m := _NUMBERED.match(line))}
    if sorted(numbered) == list(range(1, width + 1)):
        return [numbered[i + 1] for i in range(width)]
    for line in reversed(header):
        labelled = [Column(_tidy(match["label"]), match["unit"]) for match in _LABELLED.finditer(line)]
        if len(labelled) == width and not _LABELLED.sub("", line).strip(' \t,;"'):  # "PGA (g): 0.5" is no label
            return labelled
    return None


def columns_without_units(header: Sequence[str], width: int) -> list[Column] | None:
    """Columns of which the header tells the labels, time or a direction among them: ``t, NS, UD``."""
    for line in reversed(header):
        names = [Column(_tidy(name)) for name in re.split(r"[\s,;]+", line.replace('"', "").strip(" ,;"))]
        if len(names) == width and any(column.is_time or orientation_of(column.label) for column in names):
            return names
    return None


def stated_unit(header: Sequence[str]) -> str | None:
    """The unit of a line ``unit: cm/s2``."""
    return next((match["unit"].rstrip(".,;") for line in header if (match := _STATED.match(line))), None)


def stated_step(header: Sequence[str]) -> float | None:
    """The sampling interval [s] of a line ``dt = 0.01 s``."""
    match = next((match for line in header if (match := _STEP.match(line.strip()))), None)
    if match is None:
        return None
    seconds = SECONDS.get(match["unit"].lower() or "s")
    try:
        dt = float(match["dt"]) * (seconds or 0.0)
    except ValueError:
        dt = 0.0
    if not 0 < dt < HUGE:
        raise InputError(f'header: found "{match[0]}"; expected e.g. dt = 0.01 s')
    return dt


def stated_count(header: Sequence[str]) -> int | None:
    """The number of samples of a line such as ``NPTS = 4000``."""
    return next((int(match["npts"]) for line in header if (match := _COUNT.search(line))), None)


def _tidy(label: str) -> str:
    """A column's label for names and tables: "N-S" and "North-south acceleration" give "NS"."""
    label = label.strip('"')
    bare = re.sub(r"(?i)\s*(?:ground\s*)?acc(?:eleration|el)?\b\.?\s*", " ", label).strip()
    key = re.sub(r"[^A-Z]", "", bare.upper())
    if key in _SHORT:
        return _SHORT[key]
    return re.sub(r"[-\s]+", "", bare) if orientation_of(bare) else bare or label
