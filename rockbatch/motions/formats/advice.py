"""What a user may state of a file that lacks it, tried on the file before it is said.

Advice is a statement as in ``motions.toml``: the file is read again with it, and only what leads to records whose header, count
and step agree is written into the message.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from rockbatch.common.errors import InputError, Unstated
from rockbatch.common.showing import shown
from rockbatch.common.units import acceleration_factor
from rockbatch.motions.component import Component
from rockbatch.motions.motion import Unusable
from rockbatch.motions.plausible import HIGHEST, LOWEST
from rockbatch.motions.record_file import ReadOptions

_UNITS = (
    ("g", "m/s2", "cm/s2", "mm/s2"),
    ("mg", "in/s2", "ft/s2"),
)  # the second are named where none of the first fits
_TRIED: Mapping[str, Any] = {"unit": "m/s2", "dt": 0.01}  # any unit and step will do to see whether a file can be read
_MOST_LACKS = 3  # that come to light one after the other
_WHERE = (
    "under [motions] in the study, for all files that state none (the others keep their own), or for this file in motions.toml, "
    "which `rockbatch motions FOLDER --write-manifest` drafts"
)
_MEANING = {"layout": "if it is one series that goes on from line to line", "columns": "if these are its components"}

Read = Callable[[ReadOptions], Sequence[Component | Unusable]]


@dataclass(frozen=True)
class _Trial:
    """What a file is read as with a statement: components, or the reason why it is not."""

    stated: Mapping[str, Any]
    components: Sequence[Component]
    refusal: str


def advised(error: Unstated, read: Read, options: ReadOptions, gravity: float) -> Unstated:
    """Return the refusal of a file with what to state, where that was tried and leads to a record, or why nothing does."""
    choices = error.choices or ({key: _TRIED[key] for key in error.keys if key in _TRIED},)
    trials = [_tried(choice, read, options) for choice in choices]
    advice = [_words(choice, trial, gravity) for choice, trial in zip(choices, trials, strict=True) if trial.components]
    problem = "; ".join(error.messages)
    if advice:
        message = f"{problem}; write {', or '.join(advice)} {_WHERE}"
    else:
        message = f"{problem}; what could be stated makes no record of it: {trials[0].refusal}"
    stated = dict.fromkeys(key for trial in trials for key in (*trial.stated, *error.keys) if trial.components)
    return type(error)(message, keys=tuple(stated or error.keys))


def _tried(statement: Mapping[str, Any], read: Read, options: ReadOptions) -> _Trial:
    """Return what a file is read as with a statement, and with a unit and a step if it then lacks these."""
    values = dict(statement)
    for _ in range(_MOST_LACKS):
        try:
            readings = read(replace(options, **values, instead=frozenset({*options.instead, *values})))
        except Unstated as again:
            more = {key: _TRIED[key] for key in again.keys if key in _TRIED and key not in values}
            if not more:
                return _Trial(values, (), "; ".join(again.messages))
            values |= more
        except InputError as refusal:
            return _Trial(values, (), "; ".join(refusal.messages))
        else:
            reasons = [*_contradictions(readings)]
            components = [reading for reading in readings if isinstance(reading, Component)]
            return _Trial(values, () if reasons else components, "; ".join(reasons))
    return _Trial(values, (), "it lacks more than can be stated")


def _contradictions(readings: Sequence[Component | Unusable]) -> Iterator[str]:
    """Yield why readings are no records, or no sound ones."""
    for reading in readings:
        if isinstance(reading, Unusable):
            yield reading.reason
        else:
            yield from (finding.text for finding in reading.findings if finding.gross)


def _words(choice: Mapping[str, Any], trial: _Trial, gravity: float) -> str:
    """Return a statement as it is written, with what it means, and the peaks in units that may be meant."""
    words = []
    for key, value in {**choice, **trial.stated}.items():
        if key == "unit":
            words.append(_units(max(component.pga for component in trial.components), gravity))
        elif key == "dt":
            words.append("dt = …, its sampling interval [s],")
        else:
            written = f"[{', '.join(map(shown, value))}]" if isinstance(value, tuple) else shown(value)
            words.append(f"{key} = {written} {_MEANING[key]}")
    return " and ".join(words)


def _units(peak: float, gravity: float) -> str:
    """Return the units in which numbers with this ``peak`` may be, with the PGA that each makes of them."""
    for units in _UNITS:
        peaks = {unit: peak * acceleration_factor(unit, gravity) / gravity for unit in units}
        fitting = [f"{shown(unit)} (PGA {pga:.2g} g)" for unit, pga in peaks.items() if LOWEST <= pga <= HIGHEST]
        if fitting:
            return f"unit = {' or '.join(fitting)}"
    return f"unit = its unit, in which {peak:.3g} is its peak"
