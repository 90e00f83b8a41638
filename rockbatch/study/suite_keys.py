"""Keys of [motions] that make a suite of records: offsets, directions, selection, target, and what is believed."""

from typing import Any

from rockbatch.motions import kinds
from rockbatch.motions.baseline import RULES, Offset
from rockbatch.motions.selection import Selection
from rockbatch.motions.turning import every
from rockbatch.study.target import read_target
from rockbatch.toml.kinds import KindError, Number, Other, boolean, choice, not_negative, text
from rockbatch.toml.reader import Table
from rockbatch.toml.section import Key, Section


def _table(value: Any) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise KindError("a table in braces")
    return value


_TABLE = Other("a table in braces", _table, {"type": "object"})
_END = Number(endless=True)

SUITE = {
    "offset": Key(choice(*RULES[1:]), '"mean"',
        'What is taken off every record: "keep" nothing, its "mean", or its mean over the time before the event. If it is '
        "not given, the mean is taken off where the format leaves the instrument's zero in the data."),
    "offset_window_s": Key(not_negative, "[0.0, 5.0]",
        'The time before the event, from and to [s] after the first sample, for offset = "pre-event".', pair=True,
        only={"offset": ("pre-event",)}),
    "axis_deg": Key(kinds.azimuth, "35",
        "Direction of the pier's axis in degrees from north, to which the horizontal pair of each station is turned."),
    "every_deg": Key(Number("an angle within 1..90 degrees", low=1.0, high=90.0), "15",
        "Step of directions in degrees: each horizontal pair is turned to all of them below 180°."),
    "select": Key(_TABLE, "{ pga_g = [0.1, inf] }", "Which records are used; see `[motions.select]`."),
    "target": Key(_TABLE, "{ pga_g = 0.4 }", "What each record is scaled to; see `[motions.target]`."),
    "confirm": Key(text, '["CHAN07", "RSN825_*"]',
        "Names of records, or patterns with * and ?, that are right though something about them is grossly odd; also "
        '"scale", where that is.', many=True),
    "confirm_pga": Key(text, '["RSN825_CAPEMEND_CPM000"]',
        "Names of records, or patterns, whose peak acceleration is right though it is far from usual.", many=True),
    "strict": Key(boolean, "true", "Whether one record that cannot be used ends the study before anything is run."),
}  # fmt: skip
"""Keys of [motions] that are read here."""

SELECT = Section(("motions", "select"), (
    "Which records are used: the least and the largest value of each measure, of the horizontal component before it is scaled. "
    "`inf` leaves a range open."
), {
    "pga_g": Key(_END, "[0.1, 0.6]", "Peak ground acceleration.", pair=True),
    "pgv_m_s": Key(_END, "[0.3, inf]", "Peak ground velocity.", pair=True),
    "duration_s": Key(_END, "[20, 120]",
        "Length of the record from its first to its last sample.", pair=True),
    "d5_95_s": Key(_END, "[5, 40]",
        "Significant duration, in which the Arias intensity grows from 5 to 95 %.", pair=True),
    "magnitude": Key(_END, "[6.5, 8.0]",
        "Magnitude, which a manifest beside the records has to say.", pair=True),
})  # fmt: skip


def read_suite(motions: Table, read: dict[str, Any]) -> dict[str, Any]:
    """Return fields of a ``MotionSpec`` from the values of the keys ``SUITE`` in [motions]; mistakes are noted."""
    fields: dict[str, Any] = {
        "offset": _offset(motions, read),
        "azimuths": _azimuths(motions, read),
        "select": Selection(),
    }
    for name in ("confirm", "confirm_pga"):
        if name in read:
            fields[name] = tuple(setting.value for setting in read[name])
    if "strict" in read:
        fields["strict"] = read["strict"]
    if "select" in read and (table := motions.file.table(*motions.at, "select")):
        fields["select"] = Selection(**table.read(SELECT))
    if "target" in read and (table := motions.file.table(*motions.at, "target")):
        fields["target"] = read_target(table)
    return fields


def _offset(motions: Table, read: dict[str, Any]) -> Offset:
    rule, window = read.get("offset"), read.get("offset_window_s")
    if rule != "pre-event":
        return Offset(rule) if rule else Offset()
    if not motions.has("offset_window_s"):
        motions.complain(
            'offset = "pre-event": over which time? write for example offset_window_s = [0.0, 5.0], '
            "seconds from the first sample",
            "offset",
        )
    return Offset(rule, window) if window else Offset()


def _azimuths(motions: Table, read: dict[str, Any]) -> tuple[float, ...]:
    if "axis_deg" in read and "every_deg" in read:
        motions.complain("axis_deg and every_deg are given; keep the one that records shall be turned to", "every_deg")
    if "axis_deg" in read:
        return (read["axis_deg"],)
    return every(read["every_deg"]) if "every_deg" in read else ()
