"""Intensity measures of a fragility: those of a motion, those over what lifts a pier off, and an engineer's own, from a table."""

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from rockbatch.common.errors import InputError, placed
from rockbatch.common.grouping import closest
from rockbatch.common.showing import shown
from rockbatch.motions import Motion
from rockbatch.motions.intensity.measures import pgv
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.pier import Pier
from rockbatch.toml.csv_columns import columns_of, heading_of
from rockbatch.toml.kinds import positive, text


class Measure(NamedTuple):
    """A measure that a study names: the key of its levels, their unit, its value of a motion, given the settings and g, and of
    a measure relative to a pier the factor that makes it so.
    """

    levels: str
    unit: str
    value: Callable[[Motion, Any, float], float]
    per_pier: Callable[[Pier], float] | None = None


def _pga(motion: Motion, _: object, gravity: float) -> float:
    return motion.pga / gravity


def _pgv(motion: Motion, *_: object) -> float:
    return float(pgv(motion.horizontal, motion.dt, motion.initial))


def _sa(motion: Motion, spec: Any, gravity: float) -> float:
    return float(spectral_acceleration(motion.horizontal, motion.dt, [spec.period_s], spec.damping)[0]) / gravity


MEASURES = {
    "PGA": Measure("levels_g", "g", _pga),
    "PGV": Measure("levels_m_s", "m/s", _pgv),
    "Sa": Measure("levels_g", "g", _sa),
    "PGA/(g tan alpha)": Measure("levels", "", _pga, lambda pier: 1.0 / math.tan(pier.alpha)),
    "p PGV/(g tan alpha)": Measure("levels", "", _pgv, lambda pier: pier.p / pier.gravity / math.tan(pier.alpha)),
}
LEVELS = ("levels_g", "levels_m_s", "levels")

_HEADING = re.compile(r"(?P<name>.*?\S)\s*[\[(](?P<unit>[^\])]*)[\])]")


@dataclass(frozen=True)
class OwnMeasure:
    """An engineer's own measure: its name and unit, a value of each record as it was recorded, and the power of the motion's
    scale by which it grows.
    """

    name: str
    unit: str
    values: tuple[tuple[str, float], ...]
    power: float = 1.0

    def of_records(self, names: Sequence[str]) -> list[float]:
        """Return the value of each record; raises ``InputError`` with every record that has none."""
        values = dict(self.values)
        if missing := [name for name in names if name not in values]:
            raise InputError(
                *(f"{name}: the measure {shown(self.name)} has no value of it{_near(name, values)}" for name in missing)
            )
        return [values[name] for name in names]


def _near(name: str, values: Mapping[str, float]) -> str:
    nearest = closest(name, values)
    return f", but of {nearest}" if nearest else ""


def own_measure(name: str, values: Iterable[tuple[str, float]], power: float) -> OwnMeasure:
    """Return the measure of a column with the heading ``name``, "AvgSa [g]", and a value for each record.

    Raises ``InputError`` for a heading without a unit ("[-]" for none), values that are not finite and above 0, and a record
    twice.
    """
    match = _HEADING.fullmatch(name.strip())
    if match is None:
        raise InputError(
            f"{shown(name)}: its heading has no unit; write {shown(f'{name} [g]')}, or {shown(f'{name} [-]')} without one"
        )
    listed = [(str(record), float(value)) for record, value in values]
    wrong = [
        f"{record}: {match['name']} = {value:g}: must be above 0"
        for record, value in listed
        if not 0 < value < math.inf
    ]
    names = [record for record, _ in listed]
    repeated = [record for record in dict.fromkeys(names) if names.count(record) > 1]
    wrong += [f"{record}: it has several values of {match['name']}" for record in repeated]
    if wrong:
        raise InputError(*wrong)
    unit = match["unit"].strip()
    return OwnMeasure(match["name"], "" if unit in ("-", "1") else unit, tuple(listed), power)


def measure_of_file(path: Path, power: float) -> OwnMeasure:
    """Return the measure of a CSV file: a column ``record``, and one of values with the unit in its heading.

    Raises ``InputError`` for other columns and as :func:`own_measure` does, with the path.
    """
    headings = heading_of(path)
    others = [name for name in headings if name != "record"]
    if "record" not in headings or len(others) != 1:
        raise InputError(
            f"{path}: its columns are {', '.join(headings)}; it needs record, and one of values, such as AvgSa [g]"
        )
    columns = columns_of(path, {"record": text, others[0]: positive})
    try:
        return own_measure(others[0], zip(columns["record"], columns[others[0]], strict=True), power)
    except InputError as error:
        raise type(error)(*placed(error.problems, f"{path}")) from None


def given_measure(im: Any, power: float) -> OwnMeasure:
    """Return a measure given from Python: values by record, such as a Series named "AvgSa [g]", or the path of a CSV file.

    Values without a name, such as a dict, are called IM, without a unit.
    """
    if isinstance(im, str | Path):
        return measure_of_file(Path(im), power)
    name = getattr(im, "name", None)
    values = im.items() if hasattr(im, "items") else im
    return own_measure(str(name) if name else "IM [-]", values, power)


def as_they_come(motions: Sequence[Motion], spec: Any, gravity: float) -> list[float]:
    """Return the measure of every motion as it comes, with the factor of a target, in g, m/s or the unit of an own measure.

    Raises ``InputError`` for records of which an own measure has no value.
    """
    if spec.own is not None:
        values = spec.own.of_records([motion.name for motion in motions])
        return [value * motion.factor**spec.own.power for value, motion in zip(values, motions, strict=True)]
    return [MEASURES[spec.measure].value(motion, spec, gravity) for motion in motions]
