"""Keys of [motions] that make a suite of records: offsets, directions, selection, target, and what is believed."""

import math
from typing import Any

from rockbatch.motions import kinds
from rockbatch.motions.baseline import RULES, Offset
from rockbatch.motions.selection import Selection
from rockbatch.motions.turning import every
from rockbatch.study.target import read_target
from rockbatch.toml.kinds import KindError, boolean, choice, not_negative, number, text
from rockbatch.toml.reader import Key, Setting, Table


def _table(value: Any) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise KindError("a table in braces")
    return value


def _bound(value: Any) -> float:
    """An end of a range; inf where there is none."""
    if isinstance(value, float) and math.isinf(value) and value > 0:
        return value
    return number(value)


def _angle(value: Any) -> float:
    if not 1 <= number(value) <= 90:
        raise KindError("an angle within 1..90 degrees")
    return float(value)


SUITE = {
    "offset": Key(choice(*RULES[1:]), '"mean"'),
    "offset_window_s": Key(not_negative, "[0.0, 5.0]", many=True, distinct=False),
    "axis_deg": Key(kinds.azimuth, "35"),
    "every_deg": Key(_angle, "15"),
    "select": Key(_table, "{ pga_g = [0.1, inf] }"),
    "target": Key(_table, "{ pga_g = 0.4 }"),
    "confirm": Key(text, '["CHAN07", "RSN825_*"]', many=True),
    "confirm_pga": Key(text, '["RSN825_CAPEMEND_CPM000"]', many=True),
    "strict": Key(boolean, "true"),
}
_SELECT = {
    "pga_g": Key(_bound, "[0.1, 0.6]", many=True, distinct=False),
    "pgv_m_s": Key(_bound, "[0.3, inf]", many=True, distinct=False),
    "duration_s": Key(_bound, "[20, 120]", many=True, distinct=False),
    "d5_95_s": Key(_bound, "[5, 40]", many=True, distinct=False),
    "magnitude": Key(_bound, "[6.5, 8.0]", many=True, distinct=False),
}


def read_suite(motions: Table, read: dict[str, Any]) -> dict[str, Any]:
    """Fields of a ``MotionSpec`` from the values of the keys ``SUITE`` in [motions]; mistakes are noted."""
    found: dict[str, Any] = {
        "offset": _offset(motions, read),
        "azimuths": _azimuths(motions, read),
        "select": Selection(),
    }
    for name in ("confirm", "confirm_pga"):
        if name in read:
            found[name] = tuple(setting.value for setting in read[name])
    if "strict" in read:
        found["strict"] = read["strict"]
    if "select" in read and (table := motions.file.table(*motions.at, "select")):
        limits = {name: _range(table, name, given) for name, given in table.read(_SELECT).items()}
        found["select"] = Selection(**limits)
    if "target" in read and (table := motions.file.table(*motions.at, "target")):
        found["target"] = read_target(table)
    return found


def _offset(motions: Table, read: dict[str, Any]) -> Offset:
    rule, window = read.get("offset"), read.get("offset_window_s")
    if rule == "pre-event" and "offset_window_s" not in motions.data:
        motions.complain(
            'offset = "pre-event": over which time? write for example offset_window_s = [0.0, 5.0], '
            "seconds from the first sample",
            "offset",
        )
    elif "offset_window_s" in motions.data and "offset" not in motions.data:
        motions.complain('offset_window_s: is for offset = "pre-event"; write that too', "offset_window_s")
    elif "offset_window_s" in motions.data and rule in ("keep", "mean"):
        motions.complain(f'offset_window_s: does not apply to offset = "{rule}"; leave it out', "offset_window_s")
    elif window is not None:
        limits = _range(motions, "offset_window_s", window)
        if rule == "pre-event" and limits is not None:
            return Offset(rule, limits)
    return Offset(rule) if rule in ("keep", "mean") else Offset()


def _azimuths(motions: Table, read: dict[str, Any]) -> tuple[float, ...]:
    if "axis_deg" in read and "every_deg" in read:
        motions.complain("axis_deg and every_deg are given; keep the one that records shall be turned to", "every_deg")
    if "axis_deg" in read:
        return (read["axis_deg"],)
    return every(read["every_deg"]) if "every_deg" in read else ()


def _range(table: Table, name: str, given: list[Setting]) -> tuple[float, float] | None:
    """Two values in order; None, with the mistake noted, for anything else."""
    values = [setting.value for setting in given]
    written = table.data[name]
    if len(values) == 2 and values[0] < values[1]:
        return values[0], values[1]
    if not isinstance(written, list) or len(values) == len(written):  # else a value is refused already
        table.complain(f"{name} = {written}: must be two values in order, the least and the largest", name)
    return None
