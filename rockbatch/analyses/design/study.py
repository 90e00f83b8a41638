"""The keys that a design varies, and what is looked for: [design] of a study file."""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rockbatch.analyses.design.written import paths_in, with_value
from rockbatch.common.grouping import closest
from rockbatch.common.showing import shown
from rockbatch.pier.supports import FIXED_BY_POINTS
from rockbatch.study import Study
from rockbatch.study.bound_keys import key_at, why_fixed
from rockbatch.study.tables import name_of
from rockbatch.toml.kinds import KindError, Other, Points, Whole, choice, number, positive, text
from rockbatch.toml.meant import names
from rockbatch.toml.reader import Table
from rockbatch.toml.section import Key, Section

EXAMPLE = "case.damper.f"
DIGITS = 10
"""Significant digits of every value that is tried, so that tables have it exactly."""
LEAST_WIDTH = 1e-6
"""Least width over the greatest value, in absolute terms."""


@dataclass(frozen=True)
class Varied:
    """A key that is varied: its path, the ends of its scan and the number of values in it."""

    path: str
    low: float
    high: float
    points: int

    @property
    def values(self) -> list[float]:
        """Return the values of the scan, evenly spaced from ``low`` to ``high``, both included, to ten digits."""
        return [rounded(value) for value in np.linspace(self.low, self.high, self.points).tolist()]

    @property
    def step(self) -> float:
        """Return the distance of two values of the scan."""
        return (self.high - self.low) / (self.points - 1)

    @property
    def width(self) -> float:
        """Return the width to which a change of verdict is narrowed by default: an eighth of the step, to two digits."""
        return float(f"{self.step / 8:.2g}")


@dataclass(frozen=True)
class DesignSpec:
    """[design]: what is varied, and how closely. :data:`DESIGN` says what each key means."""

    vary: tuple[Varied, ...]  # one key or two; intervals are those of the first, at each value of the second
    find: str  # "least" or "greatest"
    width: float  # to which a change of verdict is narrowed, in the unit of the first key
    # names of the cases that have the keys, and of those that have not
    cases: tuple[str, ...]
    lacking: tuple[str, ...]

    @property
    def paths(self) -> tuple[str, ...]:
        """Return the paths of the keys, which are columns of the tables."""
        return tuple(varied.path for varied in self.vary)


def rounded(value: float) -> float:
    """Return a value with :data:`DIGITS`, 10, significant digits."""
    return float(f"{value:.{DIGITS}g}")


def _end(value: object) -> float | tuple[float, ...]:
    """Return a number, an end of a range, or both of a list, a range; raises ``KindError`` for others."""
    if not isinstance(value, list):
        return number(value)
    if len(value) != 2:
        raise KindError("a range of two numbers for each key")
    return number(value[0]), number(value[1])


_CALLED = names(
    {"least": "smallest lowest minimum minimal min", "greatest": "largest highest biggest maximum maximal max"}
)
_RANGE = {"anyOf": [{"type": "number"}, {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}]}

DESIGN = Section(
    ("design",),
    "A key whose values are scanned by `rockbatch design`, for those with which every check passes under every bound. Each case "
    "that has the key is a design by itself. With two keys, those of the first are found at each value of the second.",
    {
        "vary": Key(
            text,
            f'"{EXAMPLE}"',
            "Full path of a key of [pier] or [[case]], or a list of two; its value in the file is not used.",
            required=True,
            many=True,
        ),
        "between": Key(
            Other("numbers", _end, _RANGE),
            "[0.02, 0.2]",
            "The least and the greatest value, in the key's unit; of two keys a list of two ranges.",
            required=True,
            many=True,
            distinct=False,
        ),
        "find": Key(
            choice("least", "greatest", called=_CALLED),
            '"least"',
            "Which of the passing values is looked for.",
            required=True,
        ),
        "points": Key(
            Whole(2, "a whole number from 2 to 1000", 1000),
            "11",
            "Number of values of the scan, evenly spaced; of two keys one number for both, or a list of two.",
            many=True,
            distinct=False,
            default=11,
        ),
        "width": Key(
            positive,
            "0.002",
            "To which each change of verdict is narrowed by bisection, in the unit of the key, or of the first of two; by "
            "default an eighth of the distance between values of the scan.",
        ),
    },
    also=names(
        {
            "vary": "key parameter variable",
            "between": "range limits bounds interval",
            "points": "steps number values",
            "width": "tolerance resolution accuracy",
            "find": "goal objective search",
        }
    ),
)
SECTIONS = (DESIGN,)


def read_design(study: Study) -> DesignSpec:
    """Return what the study file asks for in [design]; ``InputError`` with every mistake, or if there is no such table."""
    file = study.file()
    example = f'[design] with vary = "{EXAMPLE}", between = [0.02, 0.2] and find = "least"'
    table = file.table("design", required=example)
    read = {} if table is None else table.read(DESIGN)
    if table is None or not file.is_sound_since(0):
        file.finish()
    assert table is not None
    if not study.checks:
        table.complain("there is no [[check]], so that every value would pass; write one")
    vary = tuple(_varied(table, read))
    cases, lacking = _having(table, study, [varied.path for varied in vary])
    width: float = read.get("width", vary[0].width if vary else 0.0)
    if vary and not 0.0 < width < vary[0].step:
        step = f"the values of the scan are {vary[0].step:.4g} apart"
        table.complain(
            f"width = {width:g}: {step}, and a width is less; write for example width = {vary[0].width}", "width"
        )
    if vary and width < (least := LEAST_WIDTH * max(abs(vary[0].low), abs(vary[0].high))):
        table.complain(f"width = {width:g}: must be {least:.4g} or above, a millionth of the greatest value", "width")
    file.finish()
    return DesignSpec(vary, read["find"], width, cases, lacking)


def _varied(table: Table, read: Mapping[str, Any]) -> Iterator[Varied]:
    """Yield the keys that are varied, with their ranges, without those that have mistakes, which become problems of the file."""
    paths, ranges, points = read["vary"], read["between"], read.get("points", (11,))
    if len(paths) > 2:
        table.complain("vary: expected one key or two", "vary")
        return
    single = len(paths) == 1
    if single:
        ranges = (ranges,) if all(isinstance(end, float) for end in ranges) else ranges
    if len(ranges) != len(paths) or not all(isinstance(ends, tuple) and len(ends) == 2 for ends in ranges):
        example = "[0.02, 0.2]" if single else "[[0.02, 0.2], [1e6, 4e6]]"
        table.complain(
            f"between: expected a range for each key of vary; write for example between = {example}", "between"
        )
        return
    if len(points) > len(paths):
        table.complain("points: expected one number for each key of vary, or one for all", "points")
        return
    for path, (low, high), number_of in zip(paths, ranges, (*points, points[0])[: len(paths)], strict=True):
        if wrong := why_fixed(path, EXAMPLE):
            table.complain(wrong, "vary")
        elif wrong := _why_not_over(path, low, high):
            table.complain(wrong, "between")
        elif not low < high:
            table.complain(f"between: {low:g} is not below {high:g}; write [{high:g}, {low:g}]", "between")
        else:
            yield Varied(path, low, high, number_of)


def _why_not_over(path: str, low: float, high: float) -> str:
    """Return why an existing key cannot be varied over a range, tried at its ends and middle; empty if it can."""
    if path == "pier.gravity":
        return f"{shown(path)}: motions that are given in g would change with it; vary another key"
    key = key_at(path)
    assert key is not None
    if isinstance(key.kind, Points):
        return f"{shown(path)}: points are not varied; vary another key"
    for value in (low, high, 0.5 * (low + high)):
        try:
            if not isinstance(key.kind(value), float):
                raise KindError("a key of numbers with decimals")
        except KindError as wrong:
            return f"{path} = {value:g}: {wrong.advice()}"
    return ""


def _having(table: Table, study: Study, paths: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the names of the cases that have all keys at these ``paths``, and of the others.

    A key that no case has becomes a problem of the file, and both are empty. If no case has all keys, that is a problem, too,
    and the first is empty.
    """
    tables: dict[str, Any] = tomllib.loads(study.text)
    having = {name_of(case): [with_value(tables, path, name_of(case), 1.0) is not None for path in paths]
              for case in tables["case"]}  # fmt: skip
    for place, path in enumerate(paths):
        if not any(has[place] for has in having.values()):
            others = sorted({*paths_in(tables)})
            near = closest(path, others, alike=0.8)
            same_table = [other for other in others if other.rpartition(".")[0] == path.rpartition(".")[0]]
            if path.rpartition(".")[2] in FIXED_BY_POINTS and any("backbone_mm_kN" in case for case in tables["case"]):
                text = "no case has this key, which the points of backbone_mm_kN fix, and these are not varied"
                table.complain(f"{shown(path)}: {text}; vary another key", "vary")
                return (), ()
            where = "[pier] has no such key" if path.startswith("pier.") else "no case has this key"
            instead = " or ".join(map(shown, [near] if near else same_table))
            hint = f", or vary {instead}" if instead else ""
            table.complain(f"{shown(path)}: {where}; write its value there{hint}", "vary")
            return (), ()
    chosen = tuple(name for name, has in having.items() if all(has))
    if not chosen and paths:
        table.complain("vary: no case has both keys", "vary")
    return chosen, tuple(name for name in having if name not in chosen)
