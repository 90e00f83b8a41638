"""Every key of a study is used or refused: another value changes numbers, or a name that the key gives, or is refused.

:data:`USES` has, for every key of every table, a study in which another value tells, and what tells of it. A new key fails
until it has one. Keys of piers, bases and devices are tried beside each other besides, since a key may be used in one kind of
pier and be read in vain in another.
"""

import copy
import functools
import json
import tempfile
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from motion_files import wiggle, write_at2
from waveform_files import trace, write_mseed

import rockbatch as rb
from rockbatch.analyses.design.study import read_design
from rockbatch.analyses.fragility.study import read_fragility
from rockbatch.analyses.release.study import read_release
from rockbatch.analyses.sensitivity.study import read_sensitivity
from rockbatch.analyses.spectrum.study import read_spectrum
from rockbatch.checks.judging import judge
from rockbatch.common.errors import InputError
from rockbatch.pier.bases import BASES
from rockbatch.results.run_json import describe_case
from rockbatch.study.case_keys import CASE
from rockbatch.study.load import OF_REFERENCE, REFERENCE
from rockbatch.study.schema import STUDY
from rockbatch.study.suite import ground_motions

Tables = dict[str, Any]

# Studies

SINE = {"name": "s", "shape": "sine", "amplitude_g": 0.4, "period_s": 0.8, "dt_s": 0.02, "duration_s": 1.6}
QUICK = {"motions": {"pulse": [SINE]}, "numerics": {"substeps": 2, "quiet_s": 0.5}, "output": {"forces": True}}
ROCK = {"name": "r", "base": "rigid"}
PADS = {"name": "r", "base": "elastic", "stiffness_kN_m": 3e5}
SHAFT = {"mass_t": 1000.0, "height_m": 10.0, "length_m": 20.0, "width_m": 4.0}
LUMP = {"mass_t": 1000.0, "height_m": 10.0, "inertia_t_m2": 4e4}
PIERS: dict[str, Tables] = {
    "rectangle": {"width_m": 4.0, "height_m": 20.0, "mass_t": 1000.0},
    "size": {"alpha": 0.2, "size_m": 10.0, "mu": 3.0, "mass_t": 1000.0},
    "p": {"alpha": 0.2, "p": 1.0, "mu": 3.0, "mass_t": 1000.0},
    "deck": {"width_m": 4.0, "height_m": 20.0, "mass_t": 1000.0, "deck_mass_t": 500.0},
    "frame": {"width_m": 2.0, "height_m": 10.0, "mass_t": 100.0, "deck_mass_t": 500.0, "columns": 2},
    "parts": {"width_m": 4.0, "part": [SHAFT]},
    "parts and deck": {"width_m": 4.0, "part": [SHAFT], "deck_mass_t": 500.0, "deck_height_m": 21.0},
    "lump": {"width_m": 4.0, "part": [LUMP]},
}
"""Every way to describe a pier, each with a mass, so that forces tell of it."""


def study(pier="deck", case=ROCK, **tables):
    """Return the tables of a study on a kind of pier."""
    return QUICK | {"pier": PIERS[pier], "case": [case]} | tables


# What tells of a key


def numbers(tables):
    """Return the rows with their remarks, and the statics sheet of each case."""
    of_study = rb.Study.from_dict(tables)
    peaks = rb.run(of_study, jobs=1, progress=False).drop(columns=["record", "case", "station"])
    sheets = [value for case in of_study.cases for value in rb.statics(case.pier, case.base).row.values()]
    return [peaks.to_csv(), *sheets]


def stepped(uncompiled, tables):
    """Return the row of the first case, of a kernel that other tests do not compile."""
    of_study = rb.Study.from_dict(tables)
    motion, case = ground_motions(of_study).motions[0], of_study.cases[0]
    response = uncompiled(rb.simulate, case.pier, case.base, motion, substeps=1, quiet_s=0.1)
    return [response.row.drop(["record", "case"]).to_csv()]


def based(tables):
    """Return pier and base of the first case, of which tests of footings simulate the runs."""
    one = rb.Study.from_dict(tables).cases[0]
    return [repr((one.pier, one.base))]


def rows(tables):
    """Return the rows, with their names."""
    return [rb.run(rb.Study.from_dict(tables), jobs=1, progress=False).to_csv()]


def is_taken(tables, read=lambda study: study):
    """Return whether a study is accepted, and what is read of it: a key that confirms a value lets it pass."""
    try:
        read(rb.Study.from_dict(tables))
    except InputError:
        return [False]
    return [True]


def heading(tables):
    """Return what a study is called, and its text."""
    of_study = rb.Study.from_dict(tables)
    return [of_study.title, of_study.notes]


def verdicts(tables):
    """Return all of the verdicts, their words included."""
    of_study = rb.Study.from_dict(tables)
    peaks = rb.run(of_study, jobs=1, progress=False)
    entries = json.loads(json.dumps([describe_case(case) for case in of_study.cases]))
    return [vars(verdict) for verdict in judge(of_study.checks, peaks, entries, count=of_study.count)]


def verdicts_in_folder(tables):
    """Return the verdicts that a folder of results has, which knows the events of its records."""
    folder = Path(tempfile.mkdtemp())
    rb.run(rb.Study.from_dict(tables), folder, jobs=1, progress=False)
    return rb.check(folder)["verdict"].tolist()


@functools.cache
def records(kind):
    """Return a folder with two stations of three components, or with one file of text: a column, a table, or wrapped lines."""
    folder = Path(tempfile.mkdtemp())
    series = [wiggle(400, seed) for seed in range(6)]
    if kind == "broken":
        (folder / "y_000.AT2").write_text("PEER NGA STRONG MOTION DATABASE RECORD\nnothing\n", encoding="utf-8")
    if kind in ("stations", "broken"):
        for i, name in enumerate(("A_000", "A_090", "A_UP", "B_000", "B_090", "B_UP")):
            title = "Made-up, 1/17/1994, {}, {}".format(*name.split("_"))
            write_at2(folder, f"RSN{1 + i // 3}_{name}.AT2", (1.0 + i) * series[i], title=title)
        entries = [
            f'[[record]]\nfile = "{path.name}"\nmagnitude = {5.5 + int(path.name[3])}\n'
            for path in sorted(folder.iterdir())
        ]
        (folder / "motions.toml").write_text("".join(entries), encoding="utf-8")
    elif kind == "one event":
        for i, name in enumerate("ABC"):
            write_at2(folder, f"RSN{i}_{name}_000.AT2", 0.3 * series[i], title=f"Made-up, 1/17/1994, {name}, 000")
    elif kind == "counts":
        channels = zip(("HNE", "HNN", "HNZ"), series, strict=False)
        write_mseed(folder / "all.mseed", *(trace(code, (1e6 * one).astype("int32")) for code, one in channels))
    elif kind == "column":
        (folder / "x.txt").write_text("".join(f"{value:.6e}\n" for value in series[0]), encoding="utf-8")
    elif kind == "table":
        lines = (f"{0.01 * i:.2f} {series[0][i]:.6e} {series[1][i]:.6e} {series[2][i]:.6e}\n" for i in range(400))
        (folder / "x.txt").write_text("".join(lines), encoding="utf-8")
    else:
        lines = (" ".join(f"{value:.6e}" for value in series[0][i : i + 5]) + "\n" for i in range(0, 400, 5))
        (folder / "x.txt").write_text("".join(lines), encoding="utf-8")
    return str(folder)


@functools.cache
def checks_file():
    """Return a file of checks."""
    path = Path(tempfile.mkdtemp()) / "checks.toml"
    path.write_text(
        '[[check]]\nname = "more"\ndemand = "overturned"\nat_most = 0\nreason = "collapse"\n', encoding="utf-8"
    )
    return str(path)


def recorded(kind="stations", **keys):
    """Return the tables of a study on recorded motions."""
    return study("rectangle") | {"motions": {"path": records(kind)} | keys}


def motions(tables):
    """Return the motions that are run, by their names and samples, and the files that are not used."""
    of_study = rb.Study.from_dict(tables)
    try:
        found = ground_motions(of_study)
    except InputError as error:
        return error.messages
    used = [(motion.name, motion.dt, motion.horizontal.tolist(), motion.vertical is None) for motion in found]
    vertical = [None if motion.vertical is None else motion.vertical.tolist() for motion in found]
    return [used, vertical, sorted(file.name for file in (*found.unusable, *found.left_out))]


def whole_folder(tables, run=rb.run):
    """Return what a folder of results has, but for times and the text of the study."""
    folder = Path(tempfile.mkdtemp())
    run(rb.Study.from_dict(tables), folder, jobs=1, progress=False)
    (path,) = folder.glob("*.json")
    info = json.loads(path.read_text(encoding="utf-8"))
    for name in ("created", "wall_s", "command", "study", "jobs", "machine", "digest", "sha256"):
        info.pop(name, None)
    tables_found = {path.name: path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.csv"))}
    histories = folder / "histories.h5"
    kept = [] if not histories.exists() else list(map(str, rb.open_results(folder).responses))
    return [info, tables_found, kept]


def references(tables):
    """Return the published values as the study has them."""
    return [*rb.Study.from_dict(tables).references]


class Use(NamedTuple):
    """A study in which a key has another value than in ``tables``, and what tells of it."""

    tables: Tables
    path: tuple[str | int, ...]
    value: Any
    tells: Callable[..., list[Any]] = numbers
    more: Tables = {}  # noqa: RUF012 (what the other value needs beside it, never changed)

    def changed(self, key: str) -> Tables:
        """Return the study with the key's other value."""
        other = copy.deepcopy(self.tables)
        table = other
        for step in self.path:
            table = table[step]  # type: ignore[index]
        table |= {key: self.value} | self.more  # type: ignore[misc]
        return other


_KNOWN: list[tuple[Tables, Callable[[Tables], list[Any]], list[Any]]] = []


def known(tables, tells):
    """Return what tells of a study that is asked for again and again."""
    for of_tables, by, found in _KNOWN:
        if repr(by) == repr(tells) and of_tables == tables:
            return found
    _KNOWN.append((tables, tells, tells(tables)))
    return _KNOWN[-1][2]


def outcome(use, key, uncompiled=None):
    """Return what another value does: True if it tells, False if it does not, None if it is refused."""
    tells = functools.partial(stepped, uncompiled) if use.tells is stepped else use.tells
    try:
        found = tells(use.changed(key))
    except InputError:
        return None
    return repr(found) != repr(known(use.tables, tells))


def swept(tables, path, values):
    """Return the keys that tell, and those that are refused, of a table in a study; fail if one does neither."""
    found = {key: outcome(Use(tables, path, value), key) for key, value in values.items()}
    idle = [key for key, does in found.items() if does is False]
    assert not idle, f"accepted and without effect: {idle}"
    return {key for key, does in found.items() if does}, {key for key, does in found.items() if does is None}


# Piers, bases and devices: every key beside every other

OF_PIER = {
    "alpha": 0.21, "mu": 3.2, "gravity": 9.7, "p": 1.1, "size_m": 11.0, "width_m": 4.2, "height_m": 21.0, "mass_t": 1100.0,
    "deck_mass_t": 550.0, "deck_height_m": 21.5, "deck_inertia_t_m2": 2e4, "top_m": 15.0, "flexural_period_s": 0.5, "columns": 3,
    "initial_rotation_rad": 0.05,
}  # fmt: skip
OF_PART = {"mass_t": 1100.0, "height_m": 11.0, "inertia_t_m2": 5e4, "length_m": 18.0, "width_m": 4.4, "apart_m": 3.0}
OF_CASE = {
    "restitution": 0.8, "beta": 45.0, "stiffness_kN_m": 3.5e5, "mass_t": 1200.0, "epsilon": 0.2, "zeta": 0.06, "friction": 0.05,
    "area_m2": 8.0, "eta": 3.0, "yield_kN": 4e4, "n": 4.0, "spring": "epp", "flexural_damping": 0.1,
}  # fmt: skip
DEVICES: dict[str, tuple[str, Tables]] = {
    "friction": ("damper", {"kind": "friction", "f": 0.05}),
    "hysteretic": ("damper", {"kind": "hysteretic", "f": 0.05, "yield_mm": 2.0}),
    "viscous": ("damper", {"kind": "viscous", "nu": 0.1}), "tendon": ("tendon", {"psi": 0.1, "lambda": 0.2}),
    "stop": ("stop", {"gap_mm": 5.0, "lambda": 5.0}), "spring at the deck": ("deck_spring", {"gap_mm": 5.0, "lambda": 0.2}),
}  # fmt: skip
OF_DEVICE = {
    "force_kN": 600.0, "f": 0.06, "yield_mm": 3.0, "coefficient_kN_s_m": 500.0, "nu": 0.2, "exponent": 0.7, "brace_kN_m": 1e4,
    "brace": 2.0, "at": 0.5, "prestress_kN": 500.0, "psi": 0.15, "stiffness_kN_m": 3e4, "lambda": 0.4, "yield_kN": 1600.0,
    "gap_mm": 3.0, "restitution": 0.3, "side": "left", "height_m": 15.0,
}  # fmt: skip


@pytest.mark.sweep(fast=3)
@pytest.mark.parametrize("kind", PIERS)
def test_every_key_of_a_pier_is_used_or_refused_beside_every_other(kind):
    """A height beside parts was read, and ignored."""
    pier = PIERS[kind]
    used, refused = swept(study(kind), ("pier",), OF_PIER)
    assert {key for key in pier if key in OF_PIER} <= used
    assert ("height_m" in refused) == (kind not in ("rectangle", "deck", "frame"))
    if "part" in pier:
        of_part, _ = swept(study(kind), ("pier", "part", 0), OF_PART)
        assert pier["part"][0].keys() <= of_part


@pytest.mark.parametrize("base", [ROCK, PADS, PADS | {"zeta": 0.05}], ids=["rigid", "elastic", "damped"])
def test_every_key_of_a_case_is_used_or_refused_beside_every_other(base):
    used, _ = swept(study(case=base), ("case", 0), OF_CASE)
    assert {key for key in base if key in OF_CASE} <= used


@pytest.mark.sweep(fast=4)
@pytest.mark.parametrize("base", [ROCK, PADS], ids=["rigid", "elastic"])
@pytest.mark.parametrize("kind", DEVICES)
def test_every_key_of_a_device_is_used_or_refused_beside_every_other(kind, base):
    what, device = DEVICES[kind]
    used, _ = swept(study(case=base | {what: [device]}), ("case", 0, what, 0), OF_DEVICE)
    assert {key for key in device if key in OF_DEVICE} <= used


# Every key of every table: where it tells


def uses(tables, path, values, tells=numbers):
    """Return a use of each of several keys of a table in one study."""
    return {key: Use(tables, path, value, tells) for key, value in values.items()}


def confirms(tables, path, **unusual):
    """Return the use of the key that confirms an unusual value."""
    other = copy.deepcopy(tables)
    table: Any = other
    for step in path:
        table = table[step]
    table |= unusual
    return {"confirm": Use(other, path, list(unusual), is_taken)}


def of_device(what, device, keys, base=ROCK, pier="deck"):
    """Return uses of keys of a device."""
    return uses(study(pier, base | {what: [device]}), ("case", 0, what, 0), keys)


PULSE = ("motions", "pulse", 0)
MP = SINE | {"shape": "mavroeidis-papageorgiou", "gamma": 1.5, "nu": 0.0}
CHECK = {"name": "rotation", "demand": "theta_max_over_alpha", "at_most": 0.5, "reason": "agreed"}
TWO = {
    "motions": {"pulse": [SINE, SINE | {"name": "t", "amplitude_g": 0.3}], "scale": [1.0, 1.5], "polarity": ["+", "-"]}
}
STRONG = {"motions": {"pulse": [SINE | {"amplitude_g": 3.0, "period_s": 1.5}]}}
SETTLES = {"name": "s", "demand": "settlement_m", "at_most": 0.1, "reason": "agreed", "other_law": True}
STIFF = {"name": "k", "demand": "stiffness_kN_m", "at_least": 1e5, "reason": "agreed"}
CHECKED = study(suite={}, check=[CHECK]) | TWO
SOFT = {"name": "r", "base": "elastic", "beta": 40.0}
BOTH_AXES = recorded(axis_deg=30.0) | {"case": [ROCK | {"other_width_m": 5.0}], "suite": {}}
SHAKEN = recorded(vertical=True, scale=10.0)
ONE_EVENT = recorded("one event") | {"check": [CHECK | {"statistic": "en1998-2"}], "suite": {}}
TINY = {"motions": {"pulse": [SINE | {"period_s": 0.4, "duration_s": 0.4}]}}
YIELDING = study(case=SOFT | {"base": "yielding", "eta": 2.5, "spring": "bouc-wen"}) | TINY
ON_POINTS = (
    study(case={"name": "r", "base": "yielding", "spring": "backbone", "backbone_mm_kN": [[100.0, 3e4], [300.0, 4e4]]})
    | TINY
)
FOOT = {"name": "r", "base": "footing", "width_m": 4.0, "length_m": 8.0}
SOIL = FOOT | {"shear_modulus_MPa": 60.0, "poisson": 0.45, "bearing_MPa": 1.5, "embedment_m": 1.0}
ON_CLAY, RADIATING = study(case=SOIL), study(case=SOIL | {"radiation": True, "density_t_m3": 1.9})
QUIVER = {"motions": {"pulse": [SINE | {"period_s": 0.4, "duration_s": 0.4, "dt_s": 0.001}]}}
"""With samples that follow the fastest mode of a shaft."""
SPRINGY = study(case=ROCK | {"shaft": "elastic"}, pier="parts") | QUIVER
SPRINGY |= {"pier": PIERS["parts"] | {"part": [SHAFT | {"flexural_rigidity_kNm2": 1e8, "shear_rigidity_kN": 1e7}]}}
BENDING = (
    study(case=ROCK | {"shaft": "elastic", "flexural_damping": 0.01})
    | QUIVER
    | {"pier": PIERS["deck"] | {"flexural_period_s": 0.5}}
)
UNWEIGHED = {"alpha": 0.2, "p": 1.0}
IN_SECTION = study(
    output={"sections_m": [0.0, 10.0]},
    check=[CHECK | {"demand": "section_moment_kNm", "at_m": 0.0, "at_most": 1e4}],
)
OF_CAPACITY = study(
    output={"interaction_m": [0.0]},
    check=[
        CHECK
        | {
            "demand": "section_moment_over_capacity",
            "at_m": 0.0,
            "at_most": 1.0,
            "capacity": [[-1e3, 0.0], [0.0, 5e4], [1e6, 0.0]],
        }
    ],
)
IN_SEQUENCE = study() | {
    "motions": {
        "pulse": [SINE, SINE | {"name": "t", "amplitude_g": 0.3}],
        "sequence": [{"name": "q", "records": ["s", "t"], "pause_s": 20.0}],
    }
}
HYSTERETIC = {"kind": "hysteretic", "f": 0.05, "yield_mm": 2.0}

USES: dict[str, dict[str, Use]] = {
    "": uses(study(title="A", notes="B"), (), {"title": "C", "notes": "D"}, heading),
    "[pier]": {
        **uses(study("size"), ("pier",), {key: OF_PIER[key] for key in ("alpha", "mu", "gravity", "size_m", "top_m")}),
        **uses(study("p"), ("pier",), {"p": 1.1, "flexural_period_s": 0.5, "initial_rotation_rad": 0.05}),
        **uses(study(), ("pier",), {
            key: OF_PIER[key] for key in OF_PIER if key.startswith("deck") or key in ("width_m", "height_m", "mass_t")
        }),
        **uses(study("frame"), ("pier",), {"columns": 3}), **confirms(study(), ("pier",), top_m=80.0),
    },
    "[[pier.part]]": {
        **uses(study("parts"), ("pier", "part", 0), {key: OF_PART[key] for key in OF_PART if key != "inertia_t_m2"}),
        **uses(study("lump"), ("pier", "part", 0), {"inertia_t_m2": 5e4}),
        **uses(SPRINGY, ("pier", "part", 0), {"flexural_rigidity_kNm2": 2e8, "shear_rigidity_kN": 2e7}, stepped),
        **confirms(study("parts"), ("pier", "part", 0), width_m=500.0),
    },
    "[[motions.pulse]]": {
        **uses(study(), PULSE, {
            "name": "t", "shape": "cosine", "amplitude_g": 0.5, "period_s": 0.7, "dt_s": 0.01, "duration_s": 2.4,
        }, motions),
        **uses(study() | {"motions": {"pulse": [MP]}}, PULSE, {"gamma": 1.6, "nu": 0.3}, motions),
        **confirms(study(), PULSE, amplitude_g=40.0),
    },
    "[[case]]": {
        **uses(CHECKED, ("case", 0), {"name": "other"}, verdicts),
        **uses(study(case={"name": "r", "base": "rigid"}), ("case", 0), {"restitution": 0.8, "friction": 0.05, "area_m2": 8.0}),
        **uses(study(case=SOFT), ("case", 0), {"beta": 45.0, "epsilon": 0.2, "zeta": 0.06, "impact": "housner"}),
        **uses(study(), ("case", 0), {"contact_stiffness_kN_m": 5e6}),
        **uses(ON_CLAY, ("case", 0), {
            "width_m": 5.0, "length_m": 9.0, "shear_modulus_MPa": 70.0, "poisson": 0.3, "bearing_MPa": 2.0, "embedment_m": 1.5,
            "formula": "pais-kausel", "strips": 8,
        }, based),
        **uses(RADIATING, ("case", 0), {"radiation": False, "density_t_m3": 1.7}, based),
        **uses(study(case=FOOT | {"stiffness_MN_m3": 60.0}), ("case", 0), {"stiffness_MN_m3": 80.0, "safety_factor": 3.0}, based),
        **uses(study(case=FOOT | {"young_GPa": 0.03, "depth_m": 0.5}), ("case", 0), {"young_GPa": 0.04, "depth_m": 0.4}, based),
        **uses(study(case=PADS), ("case", 0), {"stiffness_kN_m": 3.5e5}),
        **uses(SHAKEN | {"case": [SOFT | {"flight": "guided"}]}, ("case", 0), {"flight_limit_mm": 0.2}),
        **uses(SHAKEN | {"case": [SOFT]}, ("case", 0), {"flight": "stop"}),
        **uses(YIELDING, ("case", 0), {"eta": 3.0, "spring": "epp", "n": 3.0, "kinematics": "finite"}, stepped),
        **uses(study(case=PADS | {"base": "yielding", "yield_kN": 3e4}) | TINY, ("case", 0), {"yield_kN": 4e4}, stepped),
        **uses(ON_POINTS, ("case", 0), {"backbone_mm_kN": [[100.0, 2.8e4], [300.0, 4e4]]}, stepped),
        **uses(BENDING, ("case", 0), {
            "flexural_damping": 0.1, "flexural_damping_kind": "stiffness", "flexural_modes": 2,
        }, stepped),
        **uses(BENDING | {"case": [ROCK | {"shaft": "elastic"}]}, ("case", 0), {"shaft": "rigid"}, stepped),
        **uses(study(case=PADS | {"mass_t": 900.0}) | {"pier": UNWEIGHED}, ("case", 0), {"mass_t": 1000.0}),
        "base": Use(study(), ("case", 0), "elastic", more={"beta": 40.0}),
        **uses(BOTH_AXES, ("case", 0), {"other_width_m": 6.0}),
        **confirms(study(case=PADS), ("case", 0), stiffness_kN_m=3e12),
    },
    "[[case.damper]]": {
        **confirms(study(case=ROCK | {"damper": [HYSTERETIC]}), ("case", 0, "damper", 0), yield_mm=5e4),
        "kind": Use(
            study(case=ROCK | {"damper": [{"kind": "friction", "f": 0.05}]}), ("case", 0, "damper", 0), "hysteretic",
            more={"yield_mm": 2.0},
        ),
        **of_device("damper", {"kind": "friction", "force_kN": 700.0}, {"force_kN": 800.0}),
        **of_device("damper", {"kind": "friction", "f": 0.05}, {"f": 0.06, "at": "left"}),
        **of_device("damper", HYSTERETIC, {"yield_mm": 3.0, "brace": 2.0, "brace_kN_m": 1e4}),
        **of_device("damper", {"kind": "viscous", "nu": 0.1}, {"nu": 0.2, "exponent": 0.7}),
        **of_device("damper", {"kind": "viscous", "coefficient_kN_s_m": 500.0}, {"coefficient_kN_s_m": 600.0}),
    },
    "[[case.tendon]]": {
        **confirms(study(case=ROCK | {"tendon": [{"psi": 0.1, "lambda": 0.2}]}), ("case", 0, "tendon", 0), psi=1e-5),
        **of_device("tendon", {"psi": 0.1, "lambda": 0.2}, {"psi": 0.15, "lambda": 0.3, "yield_kN": 1600.0, "at": 0.5}),
        **of_device("tendon", {"prestress_kN": 900.0, "stiffness_kN_m": 2e4}, {"prestress_kN": 950.0, "stiffness_kN_m": 3e4}),
    },
    "[[case.stop]]": {
        **confirms(study(case=ROCK | {"stop": [{"gap_mm": 5.0, "lambda": 5.0}]}), ("case", 0, "stop", 0), gap_mm=1e5),
        **of_device("stop", {"gap_mm": 5.0, "lambda": 5.0}, {"gap_mm": 4.0, "lambda": 6.0, "restitution": 0.5, "at": "left"}),
        **of_device("stop", {"gap_mm": 5.0, "stiffness_kN_m": 2e5}, {"stiffness_kN_m": 3e5}),
    },
    "[[case.deck_spring]]": {
        **confirms(
            study(case=ROCK | {"deck_spring": [{"gap_mm": 5.0, "lambda": 0.2}]}), ("case", 0, "deck_spring", 0), gap_mm=1e5
        ),
        **of_device("deck_spring", {"gap_mm": 5.0, "lambda": 0.2}, {
            "gap_mm": 4.0, "lambda": 0.3, "restitution": 0.5, "side": "left", "height_m": 15.0,
        }),
        **of_device("deck_spring", {"gap_mm": 5.0, "stiffness_kN_m": 2e4}, {"stiffness_kN_m": 3e4}),
    },
    "[numerics]": {
        **uses(study(case=SOFT, numerics={"quiet_s": 0.5}), ("numerics",), {"tolerance": 1e-9}),
        **uses(study(), ("numerics",), {"substeps": 3, "quiet_s": 3.0}), **confirms(study(), ("numerics",), quiet_s=900.0),
    },
    "[[check]]": {
        **uses(study(check=[CHECK]) | {"case": [ROCK, SOFT | {"name": "q"}]}, ("check", 0), {"case": ["q*"]}, verdicts),
        **uses(IN_SECTION, ("check", 0), {"at_m": 10.0}, whole_folder),
        **uses(OF_CAPACITY, ("check", 0), {"capacity": [[-1e3, 0.0], [0.0, 6e4], [1e6, 0.0]]}, whole_folder),
        **uses(CHECKED, ("check", 0), {
            "name": "n", "demand": "omega_max_over_p", "statistic": "mean", "least": 9, "count": "component", "at_most": 0.4,
            "basis": "code", "reason": "b",  "scale": [1.0], "overturned": "left out",
            "flight": "left out", "failed": "left out",
        }, verdicts),
        **uses(study(check=[CHECK | {"statistic": "count", "above": 0.01}]) | TWO, ("check", 0), {"above": 0.3}, verdicts),
        **uses(study(case=SOFT, check=[STIFF]), ("check", 0), {"at_least": 2e5}, verdicts),
        **uses(BOTH_AXES | {"check": [CHECK]}, ("check", 0), {"both_axes": "srss"}, verdicts),
        **uses(study(check=[CHECK]), ("check", 0), {"other_law": True}, is_taken),
        **uses(ONE_EVENT, ("check", 0), {"per_event": 2}, verdicts_in_folder),
        **confirms(study(check=[CHECK]), ("check", 0), at_most=5.0),
    },
    "[suite]": {
        **uses(CHECKED, ("suite",), {"checks": checks_file()}, verdicts),
        **uses(CHECKED, ("suite",), {"count": "component"}, verdicts),
        **uses(BOTH_AXES | {"check": [CHECK]}, ("suite",), {"both_axes": "srss"}, verdicts),
        **uses(ONE_EVENT, ("suite",), {"per_event": 2}, verdicts_in_folder),
    },
    "[[motions.sequence]]": {
        **uses(IN_SEQUENCE, ("motions", "sequence", 0), {
            "name": "other", "records": ["t", "s"], "pause_s": 25.0, "factors": [1.0, 0.5], "polarity": ["+", "-"], "alone": True,
        }, motions),
        **confirms(IN_SEQUENCE, ("motions", "sequence", 0), pause_s=1000.0),
    },
    "[[motions.fema_p695]]": uses(
        study() | {"motions": {"fema_p695": [{"station": "SYL", "azimuth": 360}]}}, ("motions", "fema_p695", 0),
        {"station": "CAP", "azimuth": 90}, motions,
    ),
    "[motions]": {
        **uses(recorded(vertical=True), ("motions",), {
            "vertical": False, "offset": "mean", "axis_deg": 30.0, "every_deg": 60.0, "vertical_scale": 0.5,
            "select": {"pga_g": [0.25, 9.0]}, "target": {"pga_g": 0.3}, "vertical_target": {"pga_g": 0.3},
            "leave_out": ["RSN1_A_000"], "path": records("table"),
        }, motions),
        **uses(recorded(offset="pre-event", offset_window_s=[0.0, 1.0]), ("motions",), {"offset_window_s": [0.0, 2.0]}, motions),
        **uses(study() | {"motions": {"pulse": [SINE]}}, ("motions",), {"scale": 1.5, "polarity": "-", "still_s": 5.0}, rows),
        **uses(recorded("column", unit="g", dt=0.01, role="horizontal"), ("motions",), {"unit": "cm/s2", "dt": 0.02}, motions),
        **uses(recorded("column", unit="g", dt=0.01), ("motions",), {"role": "horizontal"}, motions),
        **uses(recorded("table", unit="g", columns=["time", "000", "090", "up"]), ("motions",), {
            "columns": ["time", "000", "-", "up"],
        }, motions),
        **uses(recorded("wrapped", unit="g", dt=0.01, role="horizontal"), ("motions",), {"layout": "wrapped"}, motions),
        **uses(recorded("counts", sensitivity=1e5), ("motions",), {"sensitivity": 2e5}, motions),
        **uses(recorded("column", unit="cm/s2", dt=0.01, role="horizontal"), ("motions",), {
            "confirm_pga": ["*"], "confirm": ["*"],
        }, motions),
        **uses(recorded("broken"), ("motions",), {"strict": True}, motions),
    },
    "[motions.select]": uses(recorded(select={}), ("motions", "select"), {
        "pga_g": [0.25, 9.0], "pgv_m_s": [0.5, 9.0], "duration_s": [10.0, 20.0], "d5_95_s": [9.0, 20.0], "magnitude": [7.0, 9.0],
    }, motions),
    "[output]": {
        **uses(study(case=SOFT, output={}), ("output",), {"rocking": True}, rows),
        **uses(
            study(output={"histories": "worst"}) | {"case": [ROCK, SOFT | {"name": "q"}]}, ("output",), {"histories_MB": 1e-6},
            whole_folder,
        ),
        **uses(
            study(case=SOFT | {"base": "yielding", "eta": 2.5}, output={}), ("output",), {"both_laws": True}, whole_folder,
        ),
        **uses(study(output={}), ("output",), {
            "histories": "none", "ledger": True, "forces": True, "intensity": True, "half_cycles": True, "sections": 3,
            "sections_m": [0.0, 10.0], "interaction_m": [0.0, 10.0], "interaction_base": True,
        }, whole_folder),
        **uses(study(output={"forces": True}), ("output",), {"least_normal_share": 0.9999}, whole_folder),
        **uses(study(output={"intensity": True}), ("output",), {"sa_periods_s": [0.7]}, whole_folder),
        **uses(recorded() | {"output": {"intensity": True}}, ("output",), {"sa_pairs": ["rotd50"]}, whole_folder),
        **uses(study(output={}, case=ROCK | {"damper": [HYSTERETIC]}), ("output",), {"devices_work": True}, whole_folder),
        **uses(study(output={"devices_work": True}, case=ROCK | {"damper": [HYSTERETIC]}), ("output",), {
            "least_stroke_mm": 500.0,
        }, whole_folder),
    },
}  # fmt: skip


# Targets: factors on the records

TABLE = [[0.1, 1.0], [0.5, 1.0], [2.0, 0.3]]
EC8 = {"spectrum": "EN 1998-1", "type": 1, "ground": "B", "ag_g": 0.3, "factors": "each", "period_range_s": [0.2, 1.5]}
ASCE = {"spectrum": "ASCE 7", "sds_g": 0.8, "sd1_g": 0.5, "tl_s": 1.2, "factors": "each", "period_range_s": [0.2, 1.5]}
AASHTO = {
    "spectrum": "AASHTO",
    "as_g": 0.3,
    "sds_g": 0.8,
    "sd1_g": 0.5,
    "factors": "each",
    "period_range_s": [0.05, 1.5],
}
NZS = {
    "spectrum": "NZS 1170.5",
    "subsoil": "C",
    "hazard_factor": 0.4,
    "fault_km": 8.0,
    "factors": "each",
    "period_range_s": [0.2, 3.0],
}
EC8_UP = {"spectrum": "EN 1998-1 vertical", "type": 1, "ag_g": 0.3, "factors": "each", "period_range_s": [0.05, 1.0]}
POINTS = {"spectrum": TABLE, "period_range_s": [0.2, 1.5]}
WITH_SHARE = functools.partial(whole_folder)


def of_target(name, target, values, tells=motions):
    """Return uses of keys of a target of recorded motions."""
    return uses(recorded(vertical=True, **{name: target}), ("motions", name), values, tells)


def targets(name):
    """Return a use of each key of a target of horizontal or vertical components."""
    found = {
        **of_target(name, {"pga_g": 0.3}, {"pga_g": 0.4}), **of_target(name, {"pgv_m_s": 0.3}, {"pgv_m_s": 0.4}),
        **of_target(name, {"sa_g": 0.3, "period_s": 0.5}, {"sa_g": 0.4, "period_s": 0.7, "damping": 0.1}),
        **of_target(name, POINTS, {
            "spectrum": [[0.1, 1.0], [0.5, 1.0], [2.0, 0.5]], "period_range_s": [0.3, 1.0], "factors": "each",
            "interpolation": "linear",
        }),
        **of_target(name, POINTS | {"factors": "none"}, {"at_least": 0.5}, WITH_SHARE),
        **of_target(name, EC8, {
            "ground": "C", "soil_factor": 1.5, "tb_s": 0.4, "tc_s": 0.7, "td_s": 1.0,
        }),
        **of_target(name, ASCE, {"tl_s": 1.0}), **of_target(name, AASHTO, {"as_g": 0.4, "sds_g": 0.7, "sd1_g": 0.4}),
        **of_target(name, NZS, {"subsoil": "D", "hazard_factor": 0.3, "return_period_factor": 1.3, "fault_km": 4.0}),
        **of_target(name, EC8, {"type": 2, "ag_g": 0.4}),
        **confirms(recorded(vertical=True, **{name: {"pga_g": 0.3}}), ("motions", name), pga_g=8.0),
    }  # fmt: skip
    if name == "target":
        return found | of_target(name, POINTS, {"pairs": "srss"})
    return found | of_target(name, EC8_UP, {"avg_over_ag": 0.6})


USES |= {"[motions.target]": targets("target"), "[motions.vertical_target]": targets("vertical_target")}
USES["[motions.target]"]["avg_over_ag"] = USES["[motions.vertical_target]"]["avg_over_ag"]
PUBLISHED = {"record": "*", "case": "r", "theta_max_over_alpha": 0.1, "source": "a paper", "alpha": 0.2}
REFERRED = study("size", reference=[PUBLISHED]) | {
    "pier": PIERS["size"] | {"alpha": [0.2, 0.25]}, "case": [ROCK, SOFT | {"name": "q"}],
}  # fmt: skip
USES["[[reference]]"] = uses(REFERRED, ("reference", 0), {
    "record": "s*", "case": "q", "theta_max_over_alpha": 0.2, "source": "a book", "alpha": 0.25,
}, references)  # fmt: skip

STIFF = study(case=SOFT, bound=[{"name": "stiff", "case.beta": {"times": 1.5}}])


def bounds_of(tables):
    """Return the bounds of a study as run.json has them."""
    return [bound.as_in_run_json() for bound in rb.Study.from_dict(tables).bounds]


USES["[[bound]]"] = uses(STIFF, ("bound", 0), {"name": "soft", "source": "tests of the ground"}, bounds_of) | confirms(
    STIFF, ("bound", 0), **{"case.beta": 5000.0}
)


# Analyses: another table or run.json

TWO_PULSES = {"motions": {"pulse": [SINE, SINE | {"name": "t", "period_s": 1.2, "duration_s": 2.4}]}}


def of_analysis(name, run, /, keys, path=(), tables=TWO_PULSES, pier="rectangle", case=ROCK, **values):
    """Return uses of ``values`` of the table ``path`` in the analysis ``name`` with these ``keys``."""
    whole = study(pier, case, **{name: keys}) | {"output": {}} | tables
    return uses(whole, (name, *path), values, functools.partial(whole_folder, run=run))


def confirmed(read, keys, path, **unusual):
    """Return the use of the key that confirms an unusual value of an analysis."""
    use = confirms(study("rectangle", **keys), path, **unusual)["confirm"]
    return {"confirm": use._replace(tells=functools.partial(is_taken, read=read))}


of_fragility = functools.partial(of_analysis, "fragility", rb.fragility)
STRIPES = {"measure": "PGA", "levels_g": [0.2, 0.5, 1.0]}
IDA = STRIPES | {"method": "ida", "hunt_step": 0.5, "window": 0.1}
BY_PGV = {"measure": "PGV", "levels_m_s": [0.2, 1.0, 2.0]}
BY_SA = {"measure": "Sa", "period_s": 1.0, "levels_g": [0.2, 0.5, 1.0]}
LIMITED = TWO_PULSES | {"check": [CHECK | {"at_most": 0.05}, CHECK | {"name": "more", "at_most": 0.1}]}
CLOUD = LIMITED | {"motions": TWO_PULSES["motions"] | {"scale": [0.8, 1.0, 1.2]}}
THREE = {"levels_g": [0.1, 0.3, 1.0], "rate_per_year": [0.02, 0.003, 0.0001]}
HAZARD = STRIPES | {"hazard": THREE}
ADDED = STRIPES | {"dispersion": [{"name": "modelling", "value": 0.3}]}
DRAWN = {"uncertain": {"uniform": {"alpha": [0.19, 0.21], "restitution": [0.85, 0.95]}}}
STRIPED = {
    "measure": "PGA",
    "stripe": [{"level_g": 0.4, "records": ["s", "t"]}, {"level_g": 0.9, "records": ["s", "t"]}],
}


@functools.cache
def table_file(text):
    """Return a CSV file of this text."""
    path = Path(tempfile.mkdtemp()) / "table.csv"
    path.write_text(text, encoding="utf-8")
    return str(path)


def own_measure(second):
    """Return keys of a fragility by an engineer's own measure, of which the two pulses have 2 and ``second``."""
    return {"measure_file": table_file(f"record,own [cm]\ns,2.0\nt,{second}\n"), "levels": [1.0, 3.0, 5.0]}


def drawn(spread, of_rock, of_pads, of_kilonewtons, **changed):
    """Return uses of the inputs of one spread: those of rigid ground, and by ratios and in kN those of springs."""
    damped, soft = SOFT | {"base": "yielding", "eta": 2.5, "spring": "epp", "zeta": 0.05}, SOFT | {"epsilon": 0.2}
    heavy = PADS | {"base": "yielding", "yield_kN": 4e4, "spring": "epp", "zeta": 0.05}
    found = {}
    for case, sizes in ((ROCK, of_rock), (soft, of_pads), (damped, of_pads), (heavy, of_kilonewtons)):
        for name, (size, other) in sizes.items():
            if (name == "epsilon" and case is not soft) or (name in ("zeta", "eta") and case is not damped):
                continue
            keys = STRIPES | {"uncertain": {spread: {name: size}}}
            found |= of_fragility(keys, ("uncertain", spread), case=case, pier="rectangle", **{name: other})
    return found


USES |= {
    "[fragility]": {
        **of_fragility(IDA, tolerance=0.3, hunt_step=0.25, window=0.2, levels_g=[0.2, 0.6, 1.0], confidence=0.9),
        **of_fragility(STRIPES, least_scale=0.9, most_scale=2.0), **of_fragility(BY_PGV, levels_m_s=[0.2, 1.2, 2.0]),
        **of_fragility(BY_SA, period_s=0.7, damping=0.1),
        **of_fragility(own_measure(3.0), measure_file=own_measure(4.0)["measure_file"], measure_power=2.0,
            levels=[2.0, 3.0, 5.0]),
        "method": of_fragility(STRIPES, method="ida")["method"]._replace(more={"hunt_step": 0.5, "window": 0.1}),
        "measure": of_fragility(STRIPES, measure="Sa")["measure"]._replace(more={"period_s": 1.0}),
        **of_fragility(STRIPES, tables=LIMITED, checks=["more"]),
        **of_fragility({"measure": "PGA", "method": "cloud"}, tables=CLOUD, censored_below=0.9),
        **confirmed(read_fragility, {"fragility": STRIPES}, ("fragility",), levels_g=[0.2, 50.0]),
    },
    "[fragility.hazard]": {
        **of_fragility(HAZARD, ("hazard",), levels_g=[0.1, 0.35, 1.0], rate_per_year=[0.02, 0.004, 0.0001],
            shape="quadratic", years=[10], source="a model"),
        **of_fragility(own_measure(3.0) | {"hazard": {"levels": [1.0, 3.0], "rate_per_year": [0.02, 0.001]}}, ("hazard",),
            levels=[1.0, 4.0]),
        **of_fragility(STRIPES | {"hazard": {"levels_g": [0.3], "return_period_years": [475], "slope": 3.0}}, ("hazard",),
            return_period_years=[975], slope=2.5),
        **of_fragility(BY_PGV | {"hazard": {"levels_m_s": [0.1, 1.0], "rate_per_year": [0.02, 0.0001]}}, ("hazard",),
            levels_m_s=[0.1, 1.2]),
        **of_fragility(STRIPES | {"hazard": {"file": table_file("levels_g,rate_per_year\n0.1,0.02\n1,0.0001\n")}}, ("hazard",),
            file=table_file("levels_g,rate_per_year\n0.1,0.02\n1,0.0002\n")),
        **confirmed(read_fragility, {"fragility": HAZARD}, ("fragility", "hazard"), levels_g=[0.1, 0.3, 50.0]),
    },
    "[[fragility.dispersion]]": {
        **of_fragility(ADDED, ("dispersion", 0), name="tests", value=0.4, source="judgement"),
        **uses(study("rectangle", fragility=ADDED | DRAWN), ("fragility", "dispersion", 0), {
            "without": ["alpha", "restitution"],
        }, functools.partial(is_taken, read=read_fragility)),
    },
    "[[fragility.stripe]]": {
        **of_fragility({"measure_file": own_measure(3.0)["measure_file"], "stripe": [
            {"level": 2.0, "records": ["s", "t"]}, {"level": 4.0, "records": ["s", "t"]},
        ]}, ("stripe", 0), level=2.5),
        **of_fragility(STRIPED, ("stripe", 0), level_g=0.3, records=["t"], scales=[1.1, 0.9]),
        **of_fragility({"measure": "PGV", "stripe": [
            {"level_m_s": 0.4, "records": ["s", "t"]}, {"level_m_s": 0.9, "records": ["s", "t"]},
        ]}, ("stripe", 0), level_m_s=0.3),
        **of_fragility({"measure": "PGA", "stripe": [
            {"level_g": 0.4, "file": table_file("record\ns\n")}, {"level_g": 0.9, "records": ["s", "t"]},
        ]}, ("stripe", 0), file=table_file("record\nt\n")),
        **confirmed(read_fragility, {"fragility": STRIPED}, ("fragility", "stripe", 1), level_g=50.0),
    },
    "[fragility.uncertain]": of_fragility(STRIPES | DRAWN, ("uncertain",), seed=2),
    "[fragility.uncertain.lognormal]": drawn(
        "lognormal", {"alpha": (0.02, 0.03), "restitution": (0.02, 0.03)},
        dict.fromkeys(("beta", "epsilon", "zeta", "eta"), (0.02, 0.03)),
        dict.fromkeys(("stiffness_kN_m", "yield_kN"), (0.02, 0.03)),
    ),
    "[fragility.uncertain.uniform]": drawn(
        "uniform", {"alpha": ([0.19, 0.21], [0.19, 0.22]), "restitution": ([0.85, 0.95], [0.86, 0.95])},
        {"beta": ([35.0, 45.0], [35.0, 50.0]), "epsilon": ([0.1, 0.3], [0.1, 0.4]), "zeta": ([0.04, 0.06], [0.04, 0.07]),
            "eta": ([2.0, 3.0], [2.0, 3.5])},
        {"stiffness_kN_m": ([2e5, 4e5], [2e5, 5e5]), "yield_kN": ([3e4, 5e4], [3e4, 6e4])},
    ),
    "[[fragility.uncertain.correlation]]": of_fragility(
        STRIPES | {"uncertain": DRAWN["uncertain"] | {"correlation": [{"between": ["alpha", "restitution"], "value": 0.7}]}},
        ("uncertain", "correlation", 0), value=-0.5,
    ),
}  # fmt: skip
THREE_DRAWN = {"uncertain": {
    "uniform": {"alpha": [0.19, 0.21], "epsilon": [0.1, 0.3], "beta": [35.0, 45.0]},
    "correlation": [{"between": ["alpha", "epsilon"], "value": 0.7}],
}}  # fmt: skip
USES["[[fragility.uncertain.correlation]]"] |= of_fragility(
    STRIPES | THREE_DRAWN, ("uncertain", "correlation", 0), case=SOFT | {"epsilon": 0.2}, between=["alpha", "beta"]
)

of_design = functools.partial(of_analysis, "design", rb.design, tables=LIMITED)
HEIGHTS = {"vary": "pier.height_m", "between": [18.0, 24.0], "find": "least", "points": 3, "width": 1.0}
WIDTHS = {"vary": "pier.width_m", "between": [3.0, 4.0], "find": "greatest", "width": 0.05, "points": 2}
USES |= {
    "[design]": {
        **of_design(HEIGHTS, between=[17.0, 24.0], find="greatest", points=4, width=0.5),
        **of_design(WIDTHS, vary="pier.height_m"),
    },
}
of_spectrum = functools.partial(of_analysis, "spectrum", rb.spectrum, case={"name": "r", "base": "rigid"})
SPECTRUM = {"alpha": [0.2], "two_pi_over_p_s": [4.0, 8.0], "points": 3}
MAP = {
    "name": "m", "shape": "sine", "frequency": [1.0, 2.0], "frequencies": 2, "amplitude": [1.0, 4.0], "amplitudes": 3,
    "tolerance": 0.2, "width": 1.0,
}  # fmt: skip
MP_MAP = MAP | {"shape": "mavroeidis-papageorgiou", "gamma": 1.5, "nu": 0.0}
SIMILAR = {"alpha": [0.2], "omega_g_over_p": [1.0, 4.0], "pga_over_g_tan_alpha": [2.0], "points": 3}
USES |= {
    "[spectrum]": {
        **of_spectrum(SPECTRUM, alpha=[0.25], two_pi_over_p_s=[4.0, 9.0], points=4, spacing="log"),
        **of_spectrum({"alpha": [0.2], "p": [0.8, 1.5], "points": 3}, p=[0.8, 1.6]),
        **of_spectrum({"alpha": [0.2], "size_m": [5.0, 20.0], "points": 3}, size_m=[5.0, 25.0]),
        **of_spectrum(SIMILAR, tables=TWO_PULSES | {"pier": UNWEIGHED}, omega_g_over_p=[1.0, 5.0], pga_over_g_tan_alpha=[3.0]),
    },
    "[[spectrum.map]]": {
        **of_spectrum({"map": [MAP]}, ("map", 0), name="n", shape="cosine", frequency=[1.0, 2.5], frequencies=3,
            amplitude=[1.0, 5.0], amplitudes=4, tolerance=0.01, width=0.1),
        **of_spectrum({"map": [MP_MAP]}, ("map", 0), gamma=1.8, nu=0.5),
    },
}  # fmt: skip

of_sensitivity = functools.partial(of_analysis, "sensitivity", rb.sensitivity)
RANGES: dict[str, tuple[Tables, list[Any], list[Any]]] = {
    "alpha": (ROCK, [0.18, 0.21], [0.18, 0.22]), "p": (ROCK, [0.7, 0.9], [0.7, 1.0]), "mu": (SOFT, [2.5, 3.5], [2.5, 4.0]),
    "restitution": (ROCK | {"restitution": 0.9}, [0.85, 0.95], [0.85, 0.92]), "beta": (SOFT, [35.0, 45.0], [35.0, 50.0]),
    "epsilon": (SOFT | {"epsilon": 0.2}, [0.1, 0.3], [0.1, 0.4]), "zeta": (SOFT | {"zeta": 0.05}, [0.04, 0.06], [0.04, 0.07]),
    "stiffness_kN_m": (PADS, [2e5, 4e5], [2e5, 5e5]), "eta": (SOFT | {"base": "yielding", "eta": 2.5}, [2.0, 3.0], [2.0, 3.5]),
    "n": (SOFT | {"base": "yielding", "eta": 2.5, "n": 3.0}, [2.0, 4.0], [2.0, 5.0]),
    "yield_kN": (PADS | {"base": "yielding", "yield_kN": 2.5e4}, [2e4, 3e4], [2e4, 3.5e4]),
}  # fmt: skip
"""A case that has the input, and two ranges of it."""
SAMPLED = {"samples": 4, "uniform": {"alpha": [0.18, 0.21]}}
ONE_PULSE = {"motions": {"pulse": [SINE | {"dt_s": 0.04}]}}


USES |= {
    "[sensitivity]": {
        **of_sensitivity(SAMPLED, statistic="max", samples=8, confidence=0.9, seed=2),
        **of_sensitivity(SAMPLED, tables=STRONG, overturned=2.0),
    },
}  # fmt: skip

RELEASED = {"motions": {"still_s": 5.0}, "pier": {"width_m": 0.3, "height_m": 1.2, "initial_rotation_rad": 0.1}}
of_release = functools.partial(of_analysis, "release", rb.release, tables=RELEASED)
MEASURED = {"impact_s": [0.33, 0.81, 1.22, 1.57], "amplitude_rad": [0.082, 0.068, 0.057, 0.048]}
USES["[release]"] = {
    **of_release(MEASURED, impact_s=[0.33, 0.81, 1.21, 1.56], amplitude_rad=[0.081, 0.068, 0.057, 0.048], clock="first impact",
        confidence=0.9),
    **of_release({"measured": table_file("impact_s\n0.33\n0.81\n1.22\n1.57\n")},
        measured=table_file("impact_s\n0.33\n0.81\n1.21\n1.56\n")),
    **of_release(MEASURED, case={"name": "r", "base": "elastic", "beta": 300.0}, fit="zeta"),
}  # fmt: skip


def _takes_long(header):
    """Return whether a table is one of an analysis, whose studies take longer."""
    return header.strip("[]").partition(".")[0] in ("design", "fragility", "spectrum", "sensitivity", "release")


@pytest.mark.sweep(fast=10)
@pytest.mark.parametrize(
    "header",
    [
        pytest.param(header, marks=pytest.mark.slow) if _takes_long(header) else header
        for header in USES
        if header != "[[case]]"
    ],
)
def test_another_value_of_every_key_tells(header, uncompiled):
    idle = {key: use.value for key, use in USES[header].items() if not outcome(use, key, uncompiled)}
    assert not idle


@pytest.mark.sweep(slow=16)
@pytest.mark.parametrize("key", USES["[[case]]"])
def test_another_value_of_every_key_of_a_case_tells(key, uncompiled):
    assert outcome(USES["[[case]]"][key], key, uncompiled)


@pytest.mark.parametrize("histories", ["all", "none"])
def test_the_size_of_histories_is_refused_where_it_decides_nothing(histories):
    tables = study(output={"histories": histories})
    assert outcome(Use(tables, ("output",), 5.0, is_taken), "histories_MB")  # taken without it, refused with it
    assert is_taken(study(output={"histories": "worst", "histories_MB": 5.0})) == [True]


DRAWN_FROM = ("[sensitivity.choice", "[sensitivity.uniform", "[sensitivity.log_uniform")
"""Tables of inputs that a sensitivity draws; what each does to its answer is in tests/analyses/sensitivity."""
NO_OTHER_VALUE = {("[[case]]", "flexural_impact"), ("[[bound]]", "preset")}
"""Keys that take one value only; what a preset stands for is in test_design_bounds.py."""


ONE_EACH = {"name", "gravity", "base", "backbone_mm_kN", "other_width_m", "kind", "at", "side"}
"""Keys of piers, cases and devices that name a case, or decide what else belongs to it: these are no lists."""
ANOTHER = {
    "impact": "landing", "formula": "gazetas", "radiation": True, "flight": "guided", "spring": "bouc-wen", "shaft": "elastic",
    "kinematics": "first-order", "flexural_damping_kind": "modal", "strips": 10,
}  # fmt: skip
"""A value beside that of USES, for words and what is even."""
LISTS = [
    pytest.param(use, key, id=f"{header} {key}")
    for header in USES
    if header.strip("[]").partition(".")[0] in ("pier", "case")
    for key, use in USES[header].items()
    if key != "confirm" and key not in ONE_EACH and (header, key) != ("[[case.deck_spring]]", "height_m")
]


@pytest.mark.parametrize(("use", "key"), LISTS)
def test_each_value_of_a_list_is_a_case_for_every_key_but_those_that_say_what_it_is(use, key):
    values = [
        use.value,
        ANOTHER.get(key) if key in ANOTHER else use.value + (1 if isinstance(use.value, int) else 0.01),
    ]
    cases = rb.Study.from_dict(use._replace(value=values).changed(key)).cases
    shown = [[] if value == "rigid" else [value] for value in values]  # keys of a shaft are columns where it bends
    assert [list(one.columns.values()) for one in cases] == shown


@pytest.mark.parametrize("name", BASES)
def test_a_case_takes_every_key_that_is_a_field_of_its_base(name):
    of_base = {field.name for field in fields(BASES[name])}
    assert [key for key in CASE if key in of_base and name not in CASE[key].only.get("base", BASES)] == []


def test_a_footing_takes_another_damping_ratio():
    """It had one from Python alone."""
    assert outcome(Use(ON_CLAY, ("case", 0), 0.1, based), "zeta")


def test_another_value_of_a_key_with_one_is_refused():
    assert is_taken(Use(BENDING, ("case", 0), "rate").changed("flexural_impact")) == [False]


# Keys of recorded motions in a study of pulses alone

OF_RECORDS = {
    "vertical": False, "unit": "g", "dt": 0.02, "columns": ["time", "000"], "sensitivity": 2.0, "role": "horizontal",
    "layout": "wrapped", "offset": "mean", "axis_deg": 30.0, "every_deg": 60.0, "select": {"pga_g": [0.1, 9.0]},
    "target": {"pga_g": 0.3}, "vertical_target": {"pga_g": 0.3}, "vertical_scale": 0.5, "confirm": ["x"], "confirm_pga": ["*"],
    "leave_out": ["x"], "strict": True,
}  # fmt: skip


@pytest.mark.parametrize("key", OF_RECORDS)
def test_keys_of_records_are_refused_without_any_and_used_by_a_path_instead(key):
    """``rockbatch run --motions PATH`` and ``motions=`` take the place of the pulses, and are read as the study says."""
    tables = study(motions={"pulse": [SINE], key: OF_RECORDS[key]})
    told = "axis_deg or every_deg" if key in ("axis_deg", "every_deg") else key
    with pytest.raises(InputError, match=rf"{told}: is for recorded motions; write path = .*, or leave {told} out"):
        ground_motions(rb.Study.from_dict(tables))
    of_path = rb.Study.from_dict(tables, motions=records("stations"))
    assert of_path.motions != rb.Study.from_dict(study(), motions=records("stations")).motions


def test_what_pulses_and_still_ground_have_a_use_for_stays_beside_them():
    keys = {"scale": [20.0], "confirm": ["scale"], "polarity": ["+", "-"], "vertical": True, "strict": False}
    compared = {"target": {"spectrum": [[0.1, 1.0], [2.0, 0.4]], "period_range_s": [0.2, 1.5], "factors": "none"}}
    assert len(ground_motions(rb.Study.from_dict(study(motions={"pulse": [SINE]} | keys | compared)))) == 1
    with pytest.raises(InputError, match="unit: is for recorded motions"):
        ground_motions(rb.Study.from_dict(study(motions={"still_s": 5.0, "unit": "g"})))


def test_a_check_of_devices_that_no_case_has_asks_for_no_output_of_theirs():
    """Following the one message would lead to the other."""
    travel = {"name": "travel", "demand": "damper_travel_m", "at_most": 3.0, "reason": "agreed"}
    assert is_taken(study(check=[travel])) == [True]
    assert is_taken(study(check=[travel], case=ROCK | {"damper": [HYSTERETIC]})) == [False]


# Published values


@pytest.mark.parametrize("key", [key for key in REFERENCE if key not in OF_REFERENCE])
def test_a_key_of_a_reference_is_refused_where_no_case_has_its_value(key):
    kind = REFERENCE[key].example
    value = json.loads(kind) if kind[0] in '"[0123456789tf' else kind
    value = value[0] if isinstance(value, list) else value
    value = 0.9 * value if isinstance(value, float) else value  # not what the case has
    published = {"record": "*", "case": "r", "theta_max_over_alpha": 0.1, "source": "a paper", key: value}
    with pytest.raises(InputError, match=f"{key} = .*: no case"):
        rb.Study.from_dict(study("size", reference=[published]))


# Defaults of the reference

ANALYSES = {
    "design": read_design, "fragility": read_fragility, "release": read_release, "sensitivity": read_sensitivity,
    "spectrum": read_spectrum,
}  # fmt: skip
UNWRITTEN = {("[design]", "points")}
"""A key that does not go with the studies of :data:`USES`."""
DEFAULTS = [
    pytest.param(section, key, id=f"{section.header} {key}")
    for section in STUDY
    for key in section
    if section.default(key) is not None and (section.header, key) not in UNWRITTEN
]


def settings(tables):
    """Return what a study and its analyses are read as, but for their text."""
    of_study = rb.Study.from_dict(tables)
    values = [getattr(of_study, field.name) for field in fields(of_study) if field.name != "text"]
    return repr(values + [read(of_study) for name, read in ANALYSES.items() if name in tables])


@pytest.mark.parametrize(("section", "key"), DEFAULTS)
def test_a_key_with_the_default_of_the_reference_is_as_none(section, key):
    """``zeta`` of springs had the default of a footing, ``period_s`` one though it is required."""
    use, default = USES[section.header][key], section.default(key)
    tables = copy.deepcopy(use.tables)
    table: Any = tables
    for step in use.path:
        table = table[step]
    table.pop(key, None)
    written = Use(tables, use.path, list(default) if isinstance(default, tuple) else default).changed(key)
    tells = verdicts if section.header == "[suite]" else settings  # a check knows whether it was given one of its own
    assert tells(written) == tells(tables)


def test_every_key_of_every_table_has_a_use():
    """A new key of these tables fails until a study is given in which it tells."""
    for section in STUDY:
        if section.header.startswith(DRAWN_FROM):
            continue
        alone = {key for header, key in NO_OTHER_VALUE if header == section.header}
        of_cases = REFERENCE.keys() - {*OF_REFERENCE, "alpha"} if section.header == REFERENCE.header else set()
        assert USES[section.header].keys() | alone | of_cases == set(section), section.header
