"""Advice on statements that a file lacks, each tried on the file before it is given.

A statement is as in ``motions.toml``: the file is read again with it, and the message contains only statements that lead to
records whose header, count and step agree.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from rockbatch.common.errors import InputError, Unstated
from rockbatch.common.showing import shown
from rockbatch.common.units import acceleration_factor
from rockbatch.motions.component import Component
from rockbatch.motions.quality.plausible import HIGHEST, LOWEST
from rockbatch.motions.sources.record_file import ReadOptions
from rockbatch.motions.unused import Unusable

_UNITS = (("g", "m/s2", "cm/s2", "mm/s2"), ("mg", "in/s2", "ft/s2"))  # the second if none of the first is plausible
_TRIED: Mapping[str, str | float] = {"unit": "m/s2", "dt": 0.01}  # any unit and step show whether a file can be read
_OTHER_UNIT = "cm/s2"  # a second unit: read in it, components without a unit of their own have other samples
_MOST_LACKS = 3  # readings with more and more statements
_WHERE = (
    "under [motions] in the study, for all files that state none (the others keep their own), or for this file in motions.toml, "
    "which `rockbatch motions FOLDER --write-manifest` drafts"
)
_WHERE_FOR_SOME = (
    "under [motions] in the study, for all columns and files that state none (the others keep their own); in motions.toml, it "
    "would replace the units of its other columns, too"
)
_MEANING = {"layout": "if it is one series that goes on from line to line", "columns": "if these are its components"}

Read = Callable[[ReadOptions], Sequence[Component | Unusable]]
Statement = Mapping[str, object]
"""Values of fields of ``ReadOptions``, by name."""


@dataclass(frozen=True)
class _Trial:
    """A reading of a file with a statement: components, or the reason why there are none."""

    stated: Statement
    components: Sequence[Component]
    refusal: str


def with_advice(error: Unstated, read: Read, options: ReadOptions, gravity: float) -> Unstated:
    """Return the error of a file with the statements that lead to a record when tried, or else with the reason why none does."""
    choices = error.choices or ({key: _TRIED[key] for key in error.keys if key in _TRIED},)
    trials = [_trial(choice, read, options) for choice in choices]
    advice, where = [], _WHERE
    for choice, trial in zip(choices, trials, strict=True):
        if trial.components:
            other = _trial({**trial.stated, "unit": _OTHER_UNIT}, read, options) if "unit" in trial.stated else trial
            pairs = zip(trial.components, other.components, strict=True)
            without_unit = [c for c, changed in pairs if changed.unit != c.unit]  # to which a stated unit applies
            where = _WHERE_FOR_SOME if 0 < len(without_unit) < len(trial.components) else where
            advice.append(_advice_text(choice, trial, max((c.pga for c in without_unit), default=0.0), gravity))
    problem = "; ".join(error.messages)
    if advice:
        choices_in_words = ", or ".join([*(text.rstrip(",") for text in advice[:-1]), advice[-1]])
        message = f"{problem}; write {choices_in_words} {where}"
    else:
        message = f"{problem}; what could be stated makes no record of it: {trials[0].refusal}"
    stated = dict.fromkeys(key for trial in trials for key in (*trial.stated, *error.keys) if trial.components)
    return type(error)(message, keys=tuple(stated or error.keys))


def _trial(statement: Statement, read: Read, options: ReadOptions) -> _Trial:
    """Return the reading of a file with a statement, and with a unit and a step if it turns out to lack these."""
    stated = dict(statement)
    for _ in range(_MOST_LACKS):
        try:
            readings = read(options.with_statement(stated))
        except Unstated as again:
            more = {key: _TRIED[key] for key in again.keys if key in _TRIED and key not in stated}
            if not more:
                return _Trial(stated, (), "; ".join(again.messages))
            stated |= more
        except InputError as refusal:
            return _Trial(stated, (), "; ".join(refusal.messages))
        else:
            components = [reading for reading in readings if isinstance(reading, Component)]
            reasons = [reading.reason for reading in readings if isinstance(reading, Unusable)]
            reasons += [finding.text for component in components for finding in component.findings if finding.gross]
            return _Trial(stated, () if reasons else components, "; ".join(reasons))
    return _Trial(stated, (), "it lacks more than can be stated")


def _advice_text(choice: Statement, trial: _Trial, peak: float, gravity: float) -> str:
    """Return a statement in the words of TOML with its meaning, and the PGA in units in which a ``peak`` is plausible."""
    words = []
    for key, value in {**choice, **trial.stated}.items():
        if key == "unit":
            words.append(_units(peak, gravity))
        elif key == "dt":
            words.append("dt = … (its sampling interval [s])")
        else:
            written = f"[{', '.join(map(shown, value))}]" if isinstance(value, tuple) else shown(value)
            words.append(f"{key} = {written} {_MEANING[key]}")
    return " and ".join(words)


def _units(peak: float, gravity: float) -> str:
    """Return the words "unit = …" with the usual units in which a ``peak`` is a PGA of 0.001 to 5 g, else others, or none."""
    for units in _UNITS:
        peaks = {unit: peak * acceleration_factor(unit, gravity) / gravity for unit in units}
        fitting = [f"{shown(unit)} (PGA {pga:.2g} g)" for unit, pga in peaks.items() if LOWEST <= pga <= HIGHEST]
        if fitting:
            return f"unit = {' or '.join(fitting)}"
    return f"unit = its unit, in which {peak:.3g} is its peak"
