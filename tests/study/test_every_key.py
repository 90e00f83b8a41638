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
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from motion_files import wiggle, write_at2
from waveform_files import trace, write_mseed

import rockbatch as rb
from rockbatch.checks.judging import judge
from rockbatch.common.errors import InputError
from rockbatch.pier.statics import statics
from rockbatch.results.run_json import describe_case
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
    sheets = [value for case in of_study.cases for value in statics(case.pier, case.base).row.values()]
    return [peaks.to_csv(), *sheets]


def stepped(uncompiled, tables):
    """Return the row of the first case, of a kernel that other tests do not compile."""
    of_study = rb.Study.from_dict(tables)
    motion, case = ground_motions(of_study).motions[0], of_study.cases[0]
    response = uncompiled(rb.simulate, case.pier, case.base, motion, substeps=1, quiet_s=0.1)
    return [response.row.drop(["record", "case"]).to_csv()]


def rows(tables):
    """Return the rows, with their names."""
    return [rb.run(rb.Study.from_dict(tables), jobs=1, progress=False).to_csv()]


def is_taken(tables):
    """Return whether a study is accepted: a key that confirms a value lets it pass."""
    try:
        rb.Study.from_dict(tables)
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
    elif kind == "counts":
        write_mseed(folder / "all.mseed", trace("HNE"), trace("HNN"), trace("HNZ"))
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
    try:
        found = ground_motions(rb.Study.from_dict(tables))
    except InputError as error:
        return error.problems
    used = [(motion.name, motion.dt, motion.horizontal.tolist(), motion.vertical is None) for motion in found]
    vertical = [None if motion.vertical is None else motion.vertical.tolist() for motion in found]
    return [used, vertical, sorted(file.name for file in (*found.unusable, *found.left_out))]


def whole_folder(tables):
    """Return what a folder of results has, but for times and the text of the study."""
    folder = Path(tempfile.mkdtemp())
    rb.run(rb.Study.from_dict(tables), folder, jobs=1, progress=False)
    info = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    for name in ("created", "wall_s", "command", "study", "jobs", "machine"):
        info.pop(name, None)
    tables_found = {path.name: path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.csv"))}
    histories = folder / "histories.h5"
    kept = [] if not histories.exists() else list(map(str, rb.open_results(folder).responses))
    return [info, tables_found, kept]


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
TINY = {"motions": {"pulse": [SINE | {"period_s": 0.4, "duration_s": 0.4}]}}
YIELDING = study(case=SOFT | {"base": "yielding", "eta": 2.5, "spring": "bouc-wen"}) | TINY
BENDING = study(case=ROCK | {"shaft": "elastic"}) | TINY | {"pier": PIERS["deck"] | {"flexural_period_s": 0.5}}
UNWEIGHED = {"alpha": 0.2, "p": 1.0}
IN_SECTION = study(
    output={"sections_m": [0.0, 10.0]},
    check=[CHECK | {"demand": "section_moment_kNm", "at_m": 0.0, "at_most": 1e4}],
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
        **uses(study(case=SOFT), ("case", 0), {"beta": 45.0, "epsilon": 0.2, "zeta": 0.06}),
        **uses(study(case=PADS), ("case", 0), {"stiffness_kN_m": 3.5e5}),
        **uses(SHAKEN | {"case": [SOFT | {"flight": "guided"}]}, ("case", 0), {"flight_limit_mm": 0.2}),
        **uses(SHAKEN | {"case": [SOFT]}, ("case", 0), {"flight": "stop"}),
        **uses(YIELDING, ("case", 0), {"eta": 3.0, "spring": "epp", "n": 3.0, "kinematics": "finite"}, stepped),
        **uses(study(case=PADS | {"base": "yielding", "yield_kN": 3e4}) | TINY, ("case", 0), {"yield_kN": 4e4}, stepped),
        **uses(BENDING, ("case", 0), {"shaft": "rigid", "flexural_damping": 0.1}, stepped),
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
        **uses(CHECKED, ("check", 0), {
            "name": "n", "demand": "omega_max_over_p", "statistic": "mean", "least": 9, "count": "component", "at_most": 0.4,
            "basis": "code", "reason": "b",  "scale": [1.0], "overturned": "left out",
            "flight": "left out", "failed": "left out",
        }, verdicts),
        **uses(study(check=[CHECK | {"statistic": "count", "above": 0.01}]) | TWO, ("check", 0), {"above": 0.3}, verdicts),
        **uses(study(case=SOFT, check=[STIFF]), ("check", 0), {"at_least": 2e5}, verdicts),
        **uses(BOTH_AXES | {"check": [CHECK]}, ("check", 0), {"both_axes": "srss"}, verdicts),
        **uses(study(check=[CHECK]), ("check", 0), {"other_law": True}, is_taken),
        **confirms(study(check=[CHECK]), ("check", 0), at_most=5.0),
    },
    "[suite]": {
        **uses(CHECKED, ("suite",), {"checks": checks_file()}, verdicts),
        **uses(CHECKED, ("suite",), {"count": "component"}, verdicts),
        **uses(BOTH_AXES | {"check": [CHECK]}, ("suite",), {"both_axes": "srss"}, verdicts),
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
        **uses(recorded("column", unit="g", dt=0.01, role="horizontal"), ("motions",), {
            "unit": "cm/s2", "dt": 0.02, "role": "vertical",
        }, motions),
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
            study(case=SOFT | {"base": "yielding", "eta": 2.5}, check=[SETTLES], output={}), ("output",), {"both_laws": False},
            is_taken,
        ),
        **uses(study(output={}), ("output",), {
            "histories": "none", "ledger": True, "forces": True, "intensity": True, "half_cycles": True, "sections": 3,
            "sections_m": [0.0, 10.0],
        }, whole_folder),
        **uses(study(output={"forces": True}), ("output",), {"least_normal_share": 0.9999}, whole_folder),
        **uses(study(output={"intensity": True}), ("output",), {"sa_periods_s": [0.7]}, whole_folder),
        **uses(recorded() | {"output": {"intensity": True}}, ("output",), {"sa_pairs": ["rotd50"]}, whole_folder),
        **uses(study(output={}, case=ROCK | {"damper": [HYSTERETIC]}), ("output",), {"devices_work": True}, whole_folder),
        **uses(study(output={"devices_work": True}, case=ROCK | {"damper": [HYSTERETIC]}), ("output",), {
            "least_stroke_mm": 0.5,
        }, whole_folder),
    },
}  # fmt: skip


@pytest.mark.parametrize("header", USES)
@pytest.mark.usefixtures("no_report")
def test_another_value_of_every_key_tells(header, uncompiled):
    idle = {key: use.value for key, use in USES[header].items() if not outcome(use, key, uncompiled)}
    assert not idle


@pytest.mark.parametrize("histories", ["all", "none"])
def test_the_size_of_histories_is_refused_where_it_decides_nothing(histories):
    tables = study(output={"histories": histories})
    assert outcome(Use(tables, ("output",), 5.0, is_taken), "histories_MB")  # taken without it, refused with it
    assert is_taken(study(output={"histories": "worst", "histories_MB": 5.0})) == [True]


ELSEWHERE = {
    "[[reference]]": "repeats the keys of cases; a value that no case has is refused (tests/study)",
    "[motions.target]": "test_spectrum_target.py", "[motions.vertical_target]": "test_vertical_target.py",
    "fragility": "tests/analyses/fragility", "spectrum": "tests/analyses/spectrum", "sensitivity": "tests/analyses",
    "release": "tests/analyses",
}  # fmt: skip
"""Tables whose keys have their tests in other places, by their header, or the name of their analysis."""


def test_every_key_of_every_table_has_a_use():
    """A new key of these tables fails until a study is given in which it tells."""
    for section in STUDY:
        if section.header in ELSEWHERE or (section.at and section.at[0] in ELSEWHERE):
            continue
        assert USES[section.header].keys() == set(section), section.header
