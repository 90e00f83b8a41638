"""The study file: what a good one means, and what is said about a bad one."""

import math
import re
import tomllib
from itertools import chain
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rockbatch.common.errors import InputError
from rockbatch.motions.quality.baseline import Offset
from rockbatch.motions.suites.scaling import Target
from rockbatch.motions.suites.selection import Selection
from rockbatch.pier import Damper, DeckSpring, ElasticBase, Pier, RigidBase, Stop, Tendon, YieldingBase
from rockbatch.study import FemaSpec, Numerics, PulseSpec, Reference, Study, load_study
from rockbatch.study.case_keys import BASE_KEYS, CASE
from rockbatch.study.load import NUMERICS, REFERENCE, TOP
from rockbatch.study.motions import FEMA, MOTIONS
from rockbatch.study.motions import PULSE as PULSE_KEYS
from rockbatch.study.output import OUTPUT
from rockbatch.study.piers import PIER as PIER_KEYS
from rockbatch.study.restraint_keys import DEVICES
from rockbatch.toml.reader import MOST_REPORTED

CONFIGS = Path(__file__).parents[2] / "configs"
PIER = "[pier]\nalpha = 0.13\np = 0.38\n"
PULSE = (
    '[[motions.pulse]]\nname = "sine"\nshape = "sine"\namplitude_g = 0.4\nperiod_s = 1.0\ndt_s = 0.01\nduration_s = 5\n'
)
REFERENCE_TO_RIGID = '[[reference]]\nrecord = "*"\ncase = "rigid"\ntheta_max_over_alpha = 0.1\nsource = "S"\n'
RIGID = '[[case]]\nname = "rigid"\nbase = "rigid"\n'


def study_of(folder: Path, *parts: str, **options: Path) -> Study:
    path = folder / "study.toml"
    path.write_text("".join(parts))
    return load_study(path, **options)


def problems_of(folder: Path, *parts: str, **options: Path) -> list[str]:
    """What is said about a study, without the file's name: "12: [pier]: …"."""
    with pytest.raises(InputError) as caught:
        study_of(folder, *parts, **options)
    return [problem.removeprefix(f"{folder / 'study.toml'}:").strip() for problem in caught.value.messages]


def problem_of(folder: Path, *parts: str) -> str:
    (problem,) = problems_of(folder, *parts)
    return problem


def case(*keys: str, base: str = "yielding") -> str:
    return "\n".join(["[[case]]", f'base = "{base}"', *keys]) + "\n"


# What a good one means


def test_a_study_without_options_has_the_documented_defaults(tmp_path):
    study = study_of(tmp_path, PIER, PULSE, case(base="rigid"))
    assert study.title == "study"
    assert study.notes == ""
    periods = (0.5, 1.0, 2.0, 4.0)
    given = {"histories": "worst", "histories_MB": 20.0, "least_normal_share": 0.1, "sa_periods_s": periods}
    given |= {"least_stroke_mm": 10.0, "sa_pairs": (), "sections_m": (), "sections": None, "interaction_m": ()}
    assert study.output.keys == dict.fromkeys(OUTPUT, False) | given
    assert study.numerics == Numerics(tolerance=1e-4, substeps=None, quiet_s=2.0)
    motions = study.motions
    assert (motions.vertical, motions.polarity, motions.scale) == (True, ("+",), (1.0,))
    assert (motions.vertical_scale, motions.strict) == (1.0, False)
    assert study.motions.pulses == (PulseSpec("sine", "sine", 0.4, 1.0, 0.01, 5.0),)
    assert study.varied == ()
    (only,) = study.cases
    assert (only.name, only.pier, only.base) == ("rigid", Pier(0.13, 0.38), RigidBase())


def test_what_is_written_is_what_is_read(tmp_path):
    (tmp_path / "records").mkdir()
    text = f"""
title = "T"
notes = '''N'''
{PIER}mu = 2
gravity = 9.8
[motions]
path = ["records"]
vertical = false
polarity = "-"
scale = [0.5, 2]
unit = "cm/s/s"
dt = 0.005
columns = ["time", "-", "-", "NS"]
sensitivity = -4e5
[[motions.fema_p695]]
station = "SYL"
azimuth = 360
[numerics]
substeps = 4
quiet_s = 0
[[case]]
base = "yielding"
beta = 40
eta = 2.5
epsilon = 0.05
spring = "epp"
kinematics = "finite"
flight = "stop"
flight_limit_mm = 20
[[reference]]
record = "*"
case = "yielding"
theta_max_over_alpha = 0.1
source = "S"
"""
    study = study_of(tmp_path, text)
    assert (study.title, study.notes, study.text) == ("T", "N", text)
    motions = study.motions
    assert motions.paths == (tmp_path / "records",)
    assert (motions.vertical, motions.polarity, motions.scale) == (False, ("-",), (0.5, 2.0))
    assert (motions.unit, motions.dt, motions.sensitivity) == ("cm/s/s", 0.005, -4e5)
    assert motions.columns == ("time", "-", "-", "NS")
    assert motions.fema_p695 == (FemaSpec("SYL", 360.0),)
    assert study.numerics == Numerics(tolerance=None, substeps=4, quiet_s=0.0)
    (only,) = study.cases
    assert only.pier == Pier(0.13, 0.38, 2.0, 9.8)
    assert only.base == YieldingBase(40.0, 0.05, "finite", "stop", flight_limit_mm=20.0, eta=2.5, spring="epp")
    assert study.references == (Reference("*", "yielding", {}, 0.1, "S"),)


@pytest.mark.parametrize(
    ("keys", "pier"),
    [
        ("alpha = 0.2\nsize_m = 7.3575", Pier.from_size(0.2, 7.3575)),
        ("width_m = 4\nheight_m = 30\ngravity = 9.8", Pier.rectangle(4.0, 30.0, 9.8)),
    ],
)
def test_a_pier_is_given_by_p_or_size_or_as_a_rectangle(tmp_path, keys, pier):
    study = study_of(tmp_path, f"[pier]\n{keys}\n", PULSE, RIGID)
    assert study.cases[0].pier == pier


def test_stiffness_mass_and_yield_force_become_beta_and_eta(tmp_path):
    """K = ω_v² M/2 and F_y = η M g/2 (Palmeri & Makris 2007), here in kN, t and m."""
    study = study_of(tmp_path, PIER, PULSE, case("stiffness_kN_m = 1.8e6", "mass_t = 2500", "yield_kN = 36787.5"))
    base = study.cases[0].base
    assert isinstance(base, YieldingBase)
    assert (base.beta * 0.38) ** 2 * 2.5e6 / 2 == pytest.approx(1.8e9, rel=1e-12)  # N/m
    assert base.eta == pytest.approx(3.0, rel=1e-12)


def test_lists_run_pier_by_pier_case_by_case_and_the_last_key_fastest(tmp_path):
    study = study_of(
        tmp_path,
        "[pier]\np = [0.38, 0.36]\nalpha = 0.13\n",
        PULSE,
        RIGID,
        case('name = "a"', "eta = [2.5, 3.5]", "beta = [40, 80]"),
        case('name = "b"', "beta = 60", base="elastic"),
    )
    assert study.varied == ("p", "eta", "beta")
    found = [(each.name, *each.columns.values()) for each in study.cases]
    of_one_pier = [("rigid",), ("a", 2.5, 40), ("a", 2.5, 80), ("a", 3.5, 40), ("a", 3.5, 80), ("b", 60)]
    assert found == [(name, p, *rest) for p in (0.38, 0.36) for name, *rest in of_one_pier]
    assert study.cases[-1].columns == {"p": 0.36, "beta": 60.0}
    for each in study.cases:
        assert each.pier.p == each.columns["p"]
        if isinstance(each.base, ElasticBase):
            assert each.base.beta == each.columns["beta"]


@pytest.mark.parametrize("base", ["rigid", "elastic", "yielding"])
def test_every_base_takes_what_flight_does_and_how_high_it_may_be(tmp_path, base):
    own = {"rigid": [], "elastic": ["beta = 40"], "yielding": ["beta = 40", "eta = 3"]}[base]
    study = study_of(tmp_path, PIER, PULSE, case(*own, 'flight = "stop"', "flight_limit_mm = [5, 20]", base=base))
    assert [each.columns for each in study.cases] == [{"flight_limit_mm": 5.0}, {"flight_limit_mm": 20.0}]
    assert [(each.base.flight, each.base.flight_limit_mm) for each in study.cases] == [("stop", 5.0), ("stop", 20.0)]
    assert study_of(tmp_path, PIER, PULSE, case(*own, base=base)).cases[0].base.flies
    told = problem_of(tmp_path, PIER, PULSE, case(*own, "flight_limit_mm = 0", base=base))
    assert "flight_limit_mm = 0: expected a number above 0" in told


def test_a_key_that_varies_shows_its_default_elsewhere_where_it_applies(tmp_path):
    study = study_of(
        tmp_path,
        PIER,
        PULSE,
        RIGID,
        case('name = "a"', "beta = 40", "eta = 3", "n = [5, 50]"),
        case('name = "b"', "beta = 40", "eta = 3"),
        case('name = "c"', "beta = 40", "eta = 3", 'spring = "epp"'),
    )
    assert [each.columns for each in study.cases] == [{}, {"n": 5.0}, {"n": 50.0}, {"n": 5.0}, {}]


def test_an_exponent_multiplies_only_the_springs_that_have_one(tmp_path):
    study = study_of(tmp_path, PIER, PULSE, case("beta = 40", "eta = 3", "n = [5, 50]", 'spring = ["bouc-wen", "epp"]'))
    assert [each.columns for each in study.cases] == [
        {"n": 5.0, "spring": "bouc-wen"},
        {"spring": "epp"},
        {"n": 50.0, "spring": "bouc-wen"},
    ]


def test_a_reference_keeps_only_the_keys_that_vary(tmp_path):
    reference = REFERENCE_TO_RIGID + "p = 0.38\nalpha = 0.13\n"
    study = study_of(tmp_path, "[pier]\np = [0.38, 0.36]\nalpha = 0.13\n", PULSE, RIGID, reference)
    assert study.references[0].columns == {"p": 0.38}


def test_given_motions_replace_all_sources_even_a_path_that_is_missing(tmp_path):
    fema = '[[motions.fema_p695]]\nstation = "SYL"\nazimuth = 360\n'
    study = study_of(tmp_path, PIER, '[motions]\npath = "nowhere"\nscale = 2\n', PULSE, fema, RIGID, motions=tmp_path)
    assert study.motions.paths == (tmp_path,)
    assert study.motions.scale == (2.0,)
    assert (study.motions.fema_p695, study.motions.pulses) == ((), ())
    assert study_of(tmp_path, PIER, RIGID, motions=tmp_path).motions.paths == (tmp_path,)


def test_a_file_of_another_system_reads_the_same(tmp_path):
    text = "".join((PIER, PULSE, RIGID))
    windows = tmp_path / "windows.toml"
    windows.write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    assert load_study(windows).cases == study_of(tmp_path, text).cases


# What is said about a bad one


def test_all_mistakes_are_reported_at_once_each_with_its_line(tmp_path):
    text = """\
title = 5
titel = "x"
beta = 3
[pier]
alpha = true
p = -0.38
mu = nan
[motions]
path = ["nowhere", "study.tml"]
polarity = ["+", "x"]
scale = [1, 0, 1.0]
vertical = "yes"
unit = "furlong"
[[motions.pulse]]
name = "a"
shape = "sinus"
amplitude_g = 0
period_s = 0.5
dt_s = 0.6
duration_s = inf
[numerics]
tolerance = 0
substeps = 2.0
quiet_s = -1
[[case]]
base = "rigid"
restitution = 2
[[case]]
name = "1"
base = "yielding"
beta = [
   40,
   "80" ]
epsilon = 1.5
kinematics = "finit"
[[case]]
name = "1"
base = "yeilding"
[[reference]]
record = "*"
case = "ridgid"
theta_max_over_alpha = 0.1
p = 0.5
[sloppy]
"""
    problems = problems_of(tmp_path, text)
    expected = {
        1: 'title = 5: expected text in quotes; write for example title = "',
        2: "titel: unknown key; did you mean title?",
        3: "beta: unknown key; it belongs under [[case]]",
        5: "[pier]: alpha = true: expected a number; write for example alpha = 0.13",
        6: "[pier]: p = -0.38: expected a number above 0",
        7: "[pier]: mu = nan: expected a finite number",
        10: '[motions]: polarity = "x": expected one of "+", "-"',
        12: '[motions]: vertical = "yes": did you mean true? expected true, false or "required"',
        13: '[motions]: unit = "furlong": expected one of g, ',
        16: '[[motions.pulse]] "a": shape = "sinus": did you mean "sine"? expected one of "sine", "cosine", ',
        17: '[[motions.pulse]] "a": amplitude_g = 0: expected a number other than 0',
        20: '[[motions.pulse]] "a": duration_s = inf: expected a finite number',
        22: "[numerics]: tolerance = 0: expected a number above 0",
        23: "[numerics]: substeps = 2.0: expected a whole number",
        24: "[numerics]: quiet_s = -1: expected 0 or a number above it",
        25: "[[case]] no. 1: name is missing",
        27: "[[case]] no. 1: restitution = 2: must be within 0..1",
        28: '[[case]] "1": eta is missing',
        33: '[[case]] "1": beta = "80": did you mean 80? expected a number (without quotes)',
        34: '[[case]] "1": epsilon = 1.5: ',
        35: '[[case]] "1": kinematics = "finit": did you mean "finite"? expected one of "first-order", "finite"',
        37: '[[case]] "1": name = "1": given twice',
        38: '[[case]] "1": base = "yeilding": did you mean "yielding"? expected one of "rigid", "elastic", "yielding"',
        39: '[[reference]] "*": source is missing',
        41: '[[reference]] "*": case = "ridgid": did you mean "rigid"? expected one of "rigid", "1"',
        44: "sloppy: unknown section",
    }
    for line, beginning in expected.items():
        assert any(problem.startswith(f"{line}: {beginning}") for problem in problems), (line, beginning)
    assert [p for p in problems if p.startswith("9:")] == [
        f'9: [motions]: path = "nowhere": no such file or folder ({tmp_path / "nowhere"}); paths are relative to '
        "the study file",
        f'9: [motions]: path = "study.tml": no such file or folder ({tmp_path / "study.tml"}); paths are relative '
        "to the study file; did you mean study.toml?",
    ]
    assert [p for p in problems if p.startswith("11:")] == [
        '11: [motions]: scale = 0: expected a number above 0, or "list"; write for example scale = [1.0]',
        "11: [motions]: scale = 1.0: given twice; write it once",
    ]
    assert any(problem.startswith("23: [numerics]: tolerance and substeps are given") for problem in problems)
    lines = [int(problem.split(":")[0]) for problem in problems]
    assert lines == sorted(lines)
    assert len(problems) == len(expected) + 5


@pytest.mark.parametrize("name", ["pier_with_dampers", "fragility"])
def test_a_hundred_mistakes_come_first_and_the_rest_is_not_read(tmp_path, name):
    """No more than a hundred are noted: a pier without its keys is then no sound one."""
    path = CONFIGS / f"{name}.toml"
    for number in (MOST_REPORTED - 1, MOST_REPORTED, MOST_REPORTED + 1):
        many = "".join(f"k{n} = 1\n" for n in range(number))
        *others, last = problems_of(tmp_path, many, path.read_text(encoding="utf-8"))
        assert sum("unknown key" in each for each in (*others, last)) == min(number, MOST_REPORTED)
        assert ("there may be more" in last) == (len(others) >= MOST_REPORTED)


def test_the_message_on_an_empty_file_names_what_it_lacks(tmp_path):
    problems = problems_of(tmp_path, "")
    assert [problem.split(";")[0] for problem in problems] == [
        "[motions]: there are no ground motions",
        "[pier] is missing",
        "[[case]] is missing",
    ]


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ("alpha = 0.1", "1: [pier]: its size is missing; write p = 0.38"), ("p = 1", "1: [pier]: alpha is missing"),
        ("alpha = 0.1\np = 1\nsize_m = 7", "4: [pier]: p and size_m are given"),
        ("p = 1\nwidth_m = 4\nheight_m = 9\n", "4: [pier]: p, width_m and height_m are given"),
        ("width_m = 4", "1: [pier]: height_m is missing beside width_m"),
        ("width_m = 4\nheight_m = 9\nalpha = 0.1", "4: [pier]: alpha follows from width_m and height_m"),
        ("width_m = 4\nheight_m = 9\nmu = 3", "4: [pier]: mu follows from width_m and height_m"),
        ("alpha = 7.4\np = 1", "2: [pier]: alpha = 7.4: must be below π/2 = 1.5708 rad; if it is in degrees, write 0.1292"),
        ("alpha = [\n0.1,\n7.4]\np = 1", "4: [pier]: alpha = 7.4: must be below π/2"),
        ("alpha = []\np = 1", "2: [pier]: alpha = []: expected at least one value"),
        ("alpha = 0.1\np = 1\ngravity = []", "4: [pier]: gravity = []: expected one value, not a list"),
    ],
)  # fmt: skip
def test_a_pier_is_given_in_one_way_that_can_be(tmp_path, keys, said):
    assert problem_of(tmp_path, f"[pier]\n{keys}\n", PULSE, RIGID).startswith(said)


@pytest.mark.parametrize(
    ("written", "line", "said"),
    [
        (case("eta = 3", base="rigid"), 3, 'eta = 3: does not apply to base = "rigid"; leave it out, or write base'),
        (case("beta = 40", "eta = 3", base="elastic"), 4, 'eta = 3: does not apply to base = "elastic"'),
        (case("beta = 40", "eta = 3", "restitution = 1"), 5, 'restitution = 1: does not apply to base = "yielding"'),
        (case("beta = 40", "eta = 3", 'spring = "epp"', "n = 5"), 6, 'n = 5: does not apply to spring = "epp"'),
        (case("beta = 40", "eta = 3", "spring = []", "n = 5"), 5, "spring = []: expected at least one value"),
        (case("beta = 40", "stiffness_kN_m = 1", "eta = 2"), 4, "beta and stiffness_kN_m are given"),
        (case("stiffness_kN_m = 1e6", "eta = 2"), 3, "mass_t is missing beside stiffness_kN_m"),
        (case("beta = 40", "yield_kN = 1e6"), 4, "mass_t is missing beside yield_kN"),
        (case("beta = 40", "eta = 2", "mass_t = 3e3"), 5, "mass_t is for use with"),
        (case("beta = 40"), 1, "eta is missing; write for example eta = 2.5, or yield_kN = "),
        (case(base="elastic"), 1, "beta is missing; write for example beta = 40.0, or stiffness_kN_m = "),
        ("[[case]]\nbeta = 40\n", 1, 'base is missing; write for example base = "yielding"'),
        (case("beta = 4", "eta = 3"), 3, "beta = 4: the pier topples on its springs under its own weight"),
        (case("beta = [40, 4]", "eta = 3"), 3, "beta = 4: the pier topples"),
        (case("beta = 40", "eta = 1"), 4, "eta = 1: the springs cannot carry the weight"),
        (case("beta = 40", "eta = 2", "n = 0.5"), 5, "n = 0.5: the Bouc–Wen exponent must be at least 1"),
        (case("beta = 40", "eta = 2", "bta = 3"), 5, "bta: unknown key; did you mean beta?"),
        (case("beta = 40", "eta = 2", "quiet_s = 3"), 5, "quiet_s: unknown key; it belongs under [numerics]"),
        (case("beta = 40", "eta = 2", 'name = ["a"]'), 5, 'name = ["a"]: did you mean "a"? expected one value, not a list'),
        ('[case]\nbase = "rigid"\n', 1, "case: expected a list of tables; write [[case]] above each one"),
    ],
)  # fmt: skip
def test_a_case_has_what_its_base_takes_and_what_can_be(tmp_path, written, line, said):
    above = PIER + PULSE
    problem = problem_of(tmp_path, above, written)
    place, _, rest = problem.partition(": ")
    assert int(place) == line + above.count("\n")
    assert rest.removeprefix("[[case]] no. 1: ").removeprefix('[[case]] ["a"]: ').startswith(said)


@pytest.mark.parametrize(
    ("base", "given", "ratio", "absolute"),
    [("elastic", {}, "beta", "stiffness_kN_m"), ("yielding", {"beta": 40.0}, "eta", "yield_kN")],
)
def test_each_of_the_values_that_are_advised_for_a_missing_one_makes_a_study(base, given, ratio, absolute):
    def study(mass, **keys):
        pier = {"width_m": 8.0, "height_m": 30.0} | mass
        tables = {"pier": pier, "motions": {"still_s": 5.0}, "case": [{"base": base} | given | keys]}
        return Study.from_dict(tables)

    with pytest.raises(InputError) as refused:
        study({})
    advised = re.findall(rf"\b({ratio}|{absolute}) = ([\d.e]+)", refused.value.messages[0])
    assert [name for name, _ in advised] == [ratio, absolute]
    values = [float(value) for _, value in advised]
    assert getattr(study({}, **{ratio: values[0]}).cases[0].base, ratio) == values[0]
    assert study({"mass_t": 3000.0}, **{absolute: values[1]}).cases[0].base.on_springs


def test_the_least_stiffness_and_yield_force_that_are_named_suffice(tmp_path):
    """The limits of β and η (model: β² > (1+μ) cos α/(μ sin²α), η > 1), in the units of the file.

    Bouc–Wen springs near their yield force need more stiffness; how much is named once their strength is known.
    """

    def keys(stiffness: float, strength: float) -> str:
        return case(f"stiffness_kN_m = {stiffness!r}", "mass_t = 3000", f"yield_kN = {strength!r}")

    said = problems_of(tmp_path, PIER, PULSE, keys(1e3, 1e3))
    stiffness, strength = (float(problem.split("above ")[-1]) for problem in said)
    assert said[0].startswith("13: [[case]] no. 1: stiffness_kN_m = 1000 with mass_t = 3000 means beta = ")
    assert said[1].startswith("15: [[case]] no. 1: yield_kN = 1000 with mass_t = 3000 means eta = ")
    assert len(problems_of(tmp_path, PIER, PULSE, keys(stiffness * 0.999, strength * 0.999))) == 2
    strength *= 1.001  # they are told to four digits
    (near,) = problems_of(tmp_path, PIER, PULSE, keys(stiffness * 1.001, strength))
    enough = float(near.split("above ")[-1])
    assert enough > 50 * stiffness
    study_of(tmp_path, PIER, PULSE, keys(enough * 1.001, strength))
    (still,) = problems_of(tmp_path, PIER, PULSE, keys(enough * 0.999, strength))
    assert "the least push topples the pier" in still
    study_of(tmp_path, PIER, PULSE, keys(stiffness * 1.02, 2 * strength))


@pytest.mark.parametrize(
    ("old", "new", "line", "said"),
    [
        ("dt_s = 0.01", "dt_s = 2", 6, "dt_s = 2"),
        ("duration_s = 5", "duration_s = 0.5", 7, "duration_s = 0.5"),
        ("duration_s = 5", "duration_s = 5\ngamma = 2", 8, "gamma = 2: does not apply to shape"),
        ('shape = "sine"', 'nu = 0\nshape = "mavroeidis-papageorgiou"', 1, "gamma is missing"),
        ("dt_s = 0.01", "dt_s = 1e-12", 6, "dt_s = 1e-12: more than"),
    ],
)
def test_a_pulse_that_cannot_be_is_refused_at_the_key_that_is_wrong(tmp_path, old, new, line, said):
    assert old in PULSE
    problem = problem_of(tmp_path, PIER, PULSE.replace(old, new), RIGID)
    assert problem.startswith(f'{line + 3}: [[motions.pulse]] "sine": {said}')


def test_pulses_and_components_are_given_once(tmp_path):
    fema = '[[motions.fema_p695]]\nstation = "SYL"\nazimuth = 360\n'
    problems = problems_of(tmp_path, PIER, PULSE, PULSE, fema, fema, RIGID)
    assert [problem.split(";")[0] for problem in problems] == [
        '12: [[motions.pulse]] "sine": name = "sine": given twice',
        '23: [[motions.fema_p695]] "SYL": azimuth = 360: given twice',
    ]


def test_without_a_readable_pier_a_base_is_still_checked_but_not_against_a_pier(tmp_path):
    problems = problems_of(tmp_path, "[pier]\nalpha = 0.13\np = 0\n", PULSE, case("beta = 0.5", "eta = 0.9"))
    assert [problem.split(";")[0] for problem in problems] == [
        "3: [pier]: p = 0: expected a number above 0",
        "14: [[case]] no. 1: eta = 0.9: the springs cannot carry the weight",
    ]


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ("axis_deg = 30\nevery_deg = 15", "6: [motions]: axis_deg and every_deg are given"),
        ("axis_deg = 400", "5: [motions]: axis_deg = 400: expected an azimuth within 0..360"),
        ("every_deg = 0", "5: [motions]: every_deg = 0: expected an angle within 1..90"),
        ('offset = "pre-event"', '5: [motions]: offset = "pre-event": over which time? write for example offset_window'),
        ('offset = "preevent"', '5: [motions]: offset = "preevent": did you mean "pre-event"? expected one of'),
        ("offset_window_s = [0, 5]", '5: [motions]: offset_window_s = [0, 5]: is for offset = "pre-event"'),
        ('offset = "mean"\noffset_window_s = [0, 5]',
         '6: [motions]: offset_window_s = [0, 5]: does not apply to offset = "mean"'),
        ('offset = "pre-event"\noffset_window_s = [5, 5]',
         "6: [motions]: offset_window_s = [5, 5]: expected a range; write for example"),
        ("select = 3", "5: [motions]: select = 3: expected a table in braces; write for example select = { pga_g"),
        ("select = { pga = [0, 1] }", "5: [motions.select]: pga: unknown key; did you mean pga_g?"),
        ("select = { pga_g = [1, 0.1] }",
         "5: [motions.select]: pga_g = [1, 0.1]: expected a range; write for example pga_g = [0.1, 1"),
        ("select = { pga_g = 0.1 }", "5: [motions.select]: pga_g = 0.1: expected a range; write for example"),
        ("select = { pga_g = [] }", "5: [motions.select]: pga_g = []: expected a range; write for example"),
        ("select = { pga_g = [0.1, 0.2, 0.3] }", "5: [motions.select]: pga_g = [0.1, 0.2, 0.3]: expected a range; write"),
        ("select = { pga_g = [0.1, nan] }", "5: [motions.select]: pga_g = nan: expected a finite number"),
        ("target = {}", "5: [motions.target]: the measure is missing"),
        ("target = { pga_g = 1, sa_g = 1 }", "5: [motions.target]: pga_g and sa_g are given; write one of"),
        ("target = { sa_g = 1 }", "5: [motions.target]: period_s is missing beside sa_g"),
        ("target = { pga_g = 1, period_s = 1 }", "5: [motions.target]: period_s: is for sa_g only"),
        ("[motions.target]\npga_g = -1", "6: [motions.target]: pga_g = -1: expected a number above 0"),
        ('vertical = "always"', '5: [motions]: vertical = "always": expected true, false or "required"'),
        ("vertical = 1", '5: [motions]: vertical = 1: did you mean true? expected true, false or "required"'),
        ("confirm = [1]", "5: [motions]: confirm = 1: expected text in quotes"),
        ('columns = ["time", "-"]', "5: [motions]: columns = ['time', '-']: no component among them"),
        ('strict = "yes"', '5: [motions]: strict = "yes": did you mean true? expected true or false'),
    ],
)  # fmt: skip
def test_what_makes_a_suite_is_checked_with_its_line(tmp_path, keys, said):
    assert problem_of(tmp_path, PIER, f"[motions]\n{keys}\n", PULSE, RIGID).startswith(said)


def test_what_makes_a_suite_is_read(tmp_path):
    keys = """[motions]
axis_deg = 30
offset = "pre-event"
offset_window_s = [0, 2.5]
confirm = "C*"
confirm_pga = ["A*", "B"]
vertical = "required"
strict = true
select = { pga_g = [0.1, inf], magnitude = [6, 8] }
target = { sa_g = 0.5, period_s = 1.2, damping = 0.02 }
"""
    motions = study_of(tmp_path, PIER, keys, PULSE, RIGID).motions
    assert motions.azimuths == (30.0,)
    assert motions.offset == Offset("pre-event", (0.0, 2.5))
    assert (motions.confirm, motions.confirm_pga, motions.strict) == (("C*",), ("A*", "B"), True)
    assert motions.vertical == "required"
    assert motions.select == Selection(pga_g=(0.1, math.inf), magnitude=(6.0, 8.0))
    assert motions.target == Target(sa_g=0.5, period_s=1.2, damping=0.02)


def test_a_reference_to_a_value_that_no_case_has_is_refused(tmp_path):
    reference = REFERENCE_TO_RIGID + "p = 0.4\nbeta = 40\n"
    problems = problems_of(tmp_path, "[pier]\np = [0.38, 0.36]\nalpha = 0.13\n", PULSE, RIGID, reference)
    assert problems == [
        '19: [[reference]] "*": p = 0.4: no case "rigid" has it; write 0.38 or 0.36, or leave it out',
        '20: [[reference]] "*": beta = 40.0: no case "rigid" has it; leave it out',
    ]


def test_missing_given_motions_are_reported_beside_the_mistakes_of_the_file(tmp_path):
    with pytest.raises(InputError) as caught:
        study_of(tmp_path, PIER, PULSE, RIGID, "bse = 1\n", motions=tmp_path / "nowhere")
    first, second = caught.value.messages
    assert "--motions" in first
    assert "no such file or folder" in first
    assert "bse: unknown key" in second


_ATOMS = st.one_of(
    st.integers(-5, 5),
    st.floats(),
    st.booleans(),
    st.sampled_from(["rigid", "elastic", "yielding", "epp", "sine", "+", ""]),
)
_KEYS = st.sampled_from([*PIER_KEYS, *MOTIONS, *FEMA, *PULSE_KEYS, *NUMERICS, *CASE, *BASE_KEYS, *REFERENCE])
_TABLES = st.sampled_from(
    ["[pier]", "[motions]", "[[motions.pulse]]", "[[motions.fema_p695]]", "[numerics]", "[[case]]", "[[reference]]"]
)
_ANY = _ATOMS | st.lists(_ATOMS, max_size=3)


def _written(value: object) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list):
        return "[" + ", ".join(map(_written, value)) + "]"
    return str(value).lower() if isinstance(value, bool) else repr(value)


def _is_read_or_refused(path: Path) -> None:
    try:
        load_study(path)
    except InputError as error:
        problems = error.messages
    else:
        problems = ()
    assert all(problem.startswith(f"{path}:") for problem in problems)


@settings(max_examples=30, deadline=None)  # the first example pays for the imports
@given(st.lists(st.tuples(_TABLES, st.dictionaries(_KEYS, _ANY, max_size=9)), max_size=6))
def test_whatever_is_written_gives_a_study_or_an_input_error(tmp_path_factory, tables):
    chunks = [f"{table}\n" + "".join(f"{k} = {_written(v)}\n" for k, v in keys.items()) for table, keys in tables]
    path = tmp_path_factory.getbasetemp() / "any.toml"
    path.write_text("".join(chunks))
    _is_read_or_refused(path)


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 1000), _ANY)
def test_any_value_in_the_place_of_a_good_one_gives_a_study_or_an_input_error(tmp_path_factory, place, value):
    lines = (CONFIGS / "example.toml").read_text().splitlines()
    keys = [n for n, line in enumerate(lines) if re.match(r"\w+ = [^\"]*$", line)]
    n = keys[place % len(keys)]
    lines[n] = f"{lines[n].split(' = ')[0]} = {_written(value)}"
    path = tmp_path_factory.getbasetemp() / "changed.toml"
    path.write_text("\n".join(lines))
    _is_read_or_refused(path)


# The studies that come with the program


@pytest.mark.parametrize("path", sorted(CONFIGS.glob("*.toml")), ids=lambda path: path.stem)
def test_every_study_that_comes_along_is_sound_and_explains_itself(path):
    study = load_study(path)
    assert study.title
    assert study.notes
    assert study.cases
    if any(
        case.base.ratchets for case in study.cases
    ):  # as the paper's own: it says so, and asks nothing of settlements
        assert re.search("Bouc.Wen", study.notes)
        assert not any("settlement" in rule.demand for rule in study.checks)


@pytest.mark.parametrize(
    ("name", "alpha", "bases", "wave", "varied"),
    [
        ("fig5", 0.2, [(50.0, eta) for eta in (5.0, 3.0, 2.5, 2.2)], ("sine", 1.0, 0.5), "eta"),
        ("fig6", 0.15, [(beta, 2.5) for beta in (20.0, 40.0, 60.0, 100.0)], ("cosine", 1.0, 1.0), "beta"),
    ],
)
def test_figures_5_and_6_have_the_paper_s_parameters(name, alpha, bases, wave, varied):
    study = load_study(CONFIGS / f"{name}.toml")
    expected = [RigidBase(flight="stop")]
    for beta, eta in bases:
        by_e = YieldingBase(beta, flight="stop", eta=eta, impact="housner")
        expected += [YieldingBase(beta, 0.1, flight="stop", eta=eta), by_e]
    assert [each.base for each in study.cases] == expected
    assert {each.pier for each in study.cases} == {Pier(alpha, 1.0)}
    (pulse,) = study.motions.pulses
    assert (pulse.shape, pulse.amplitude_g, pulse.period_s) == wave
    assert study.varied == (varied, "impact")


def test_fig7_has_the_paper_s_parameters_all_three_of_its_p_and_both_impacts():
    study = load_study(CONFIGS / "fig7.toml")
    foundations = [("rigid", RigidBase(flight="stop"))]
    for name, beta, eta in (("1", 40.0, 2.5), ("2", 40.0, 3.5), ("3", 80.0, 2.5), ("4", 80.0, 3.5)):
        foundations += [
            (name, YieldingBase(beta, 0.05, flight="stop", eta=eta)),
            (name, YieldingBase(beta, flight="stop", eta=eta, impact="housner")),
        ]
    assert [(each.name, each.base, each.pier) for each in study.cases] == [
        (name, base, Pier(0.13, p)) for p in (0.38, 0.36, 0.35) for name, base in foundations
    ]
    assert Pier(0.13, 0.35).size == pytest.approx(60.1, abs=0.05)  # the paper's R0, as printed
    assert {(each.theta_max_over_alpha, each.case) for each in study.references} == {
        (0.114, "rigid"),
        (0.0191, "rigid"),
    }
    assert len(study.motions.fema_p695) == 4


def test_the_example_s_comments_name_every_key_there_is():
    """A newcomer copies it: what it does not show does not exist."""
    text = (CONFIGS / "example.toml").read_text()
    shown = chain(TOP, PIER_KEYS, MOTIONS, FEMA, PULSE_KEYS, NUMERICS, CASE, BASE_KEYS, *DEVICES.values())
    for key in {*shown} - {"flexural_impact"}:  # which has no effect, and is left out
        assert re.search(rf"\b{key}\b", text), key


@pytest.mark.parametrize("name", ["example", "first_study"])
def test_the_devices_in_comments_of_a_first_study_can_be_put_in(name):
    """Those of the text in comments, and then the ratios that it gives instead."""
    (block,) = re.findall(
        r"(?:^#     .*\n|^#\n)+(?=\n# (?:What|---))", (CONFIGS / f"{name}.toml").read_text(), re.MULTILINE
    )
    assert set(re.findall(r"(\w+) = ", block)) == {key for keys in DEVICES.values() for key in keys} - {"confirm"}
    devices = block.replace("#     ", "").replace("#\n", "\n")
    heavy = "[pier]\nwidth_m = 8.0\nheight_m = 30.0\nmass_t = 2000.0\n"
    (only,) = Study.from_toml(heavy + PULSE + RIGID + devices).cases
    assert [type(device) for device in only.base.restraints] == [Damper, Damper, Tendon, Stop, DeckSpring]
    ratios = re.sub(r"(?m)^\w+ = [^#\n]*#.*\bor (\w+ = [\d.]+).*$", r"\1", devices).replace("yield_kN", "# yield_kN")
    hysteretic, viscous, tendon, stop, beside = Study.from_toml(PIER + PULSE + RIGID + ratios).cases[0].base.restraints
    assert hysteretic == Damper("hysteretic", f=0.02, yield_m=0.005, at="left")
    assert viscous == Damper("viscous", nu=0.5, exponent=0.5, brace=5.0)
    assert (tendon.psi, tendon.lam, tendon.strength) == (0.5, 1.0, math.inf)
    assert (stop.gap_m, stop.lam, stop.restitution, stop.at) == (0.1, 20.0, 0.6, "left")
    assert beside == DeckSpring(0.2, 0.05, 0.6, "right", 31.5)


@pytest.mark.slow
def test_what_the_example_leaves_out_in_comments_can_be_put_in(tmp_path):
    """Each commented key, alone, is one that the study takes, or that excludes another one with a reason."""
    lines = (CONFIGS / "example.toml").read_text().splitlines()
    commented = [
        n for n, line in enumerate(lines) if re.match(r"# \w+ = ", line) and not re.match("# (station|azimuth)", line)
    ]
    assert len(commented) > 10
    for n in commented:
        changed = [line.removeprefix("# ") if at == n else line for at, line in enumerate(lines)]
        tomllib.loads("\n".join(changed))
        path = tmp_path / "study.toml"
        path.write_text("\n".join(changed))
        try:
            load_study(path)
        except InputError as error:
            said = str(error)
        else:
            said = ""
        assert "unknown" not in said, said
        assert "expected" not in said, said


def test_zeta_takes_the_place_of_epsilon(tmp_path):
    study = study_of(tmp_path, PIER, PULSE, case("beta = 40", "eta = 2.5", "zeta = [0.02, 0.05]"))
    assert [only.base for only in study.cases] == [YieldingBase(40.0, eta=2.5, zeta=zeta) for zeta in (0.02, 0.05)]
    assert [only.columns for only in study.cases] == [{"zeta": 0.02}, {"zeta": 0.05}]


def test_epsilon_beside_zeta_is_reported_once_with_its_line(tmp_path):
    keys = case('name = "a"', "beta = 40", "epsilon = 0.1", "zeta = 0.05", base="elastic")
    with pytest.raises(InputError) as error:
        study_of(tmp_path, PIER, PULSE, keys)
    (told,) = error.value.messages
    assert "epsilon = 0.1: zeta is given too" in told
    with pytest.raises(InputError, match="zeta = 5: damping of the supports"):
        study_of(tmp_path, PIER, PULSE, case("beta = 40", "zeta = 5", base="elastic"))


def test_a_list_of_impacts_has_epsilon_for_landing_only(tmp_path):
    listed = case("beta = 40", "eta = 2.5", "epsilon = [0.05, 0.1]", 'impact = ["landing", "housner"]')
    study = study_of(tmp_path, PIER, PULSE, listed)
    assert [(only.base.impact, only.base.epsilon) for only in study.cases] == [
        ("landing", 0.05), ("housner", 0.0), ("landing", 0.1),
    ]  # fmt: skip
    assert [only.columns for only in study.cases] == [
        {"epsilon": 0.05, "impact": "landing"}, {"impact": "housner"}, {"epsilon": 0.1, "impact": "landing"},
    ]  # fmt: skip
    (only,) = study_of(tmp_path, PIER, PULSE, case("beta = 40", 'impact = "housner"', base="elastic")).cases
    assert only.base == ElasticBase(40.0, impact="housner")


@pytest.mark.parametrize(
    ("base", "keys", "told"),
    [
        (
            "elastic",
            ('impact = "housner"', "epsilon = 0.1"),
            'epsilon = 0.1: does not apply to impact = "housner"; leave it out',
        ),
        (
            "elastic",
            ('impact = "housner"', "epsilon = 0"),
            'epsilon = 0: does not apply to impact = "housner"; leave it out',
        ),
        (
            "elastic",
            ('impact = "housner"', "zeta = 0.05"),
            'impact = "housner": zeta is given too, and a damped support',
        ),
        (
            "elastic",
            ('impact = "landing"', "zeta = 0.05"),
            'impact = "landing": zeta is given too, and a damped support',
        ),
        (
            "rigid",
            ('impact = "housner"',),
            'impact = "housner": does not apply to base = "rigid"; leave it out, or write base',
        ),
    ],
)
def test_an_impact_is_refused_where_it_or_epsilon_has_no_effect(tmp_path, base, keys, told):
    stiff = ("beta = 40",) if base == "elastic" else ()
    assert told in problem_of(tmp_path, PIER, PULSE, case(*stiff, *keys, base=base))


HEAVY = "[pier]\nwidth_m = 4.0\nheight_m = 30.0\nmass_t = 2000.0\n"


def test_dampers_and_tendons_by_kilonewtons_and_by_ratios(tmp_path):
    """f = F_d/(M g), nu = C/(M p), psi = P0/(M g), lambda = k_t b²/(M g R0)."""
    hysteretic = 'kind = "hysteretic"\nforce_kN = [450, 900]\nyield_mm = 5\n'
    dampers = f'[[case.damper]]\n{hysteretic}[[case.damper]]\nkind = "viscous"\nnu = 0.5\n'
    tendon = "[case.tendon]\nprestress_kN = 5000\nstiffness_kN_m = 40000\nyield_kN = 9000\nat = 0.5\n"
    study = study_of(tmp_path, HEAVY, PULSE, f'[[case]]\nbase = "rigid"\n{dampers}{tendon}')
    first, second = study.cases
    weight = 2000.0 * 9.81
    pier = first.pier
    hysteretic, viscous, rod = first.base.restraints
    assert hysteretic == Damper("hysteretic", f=450 / weight, yield_m=0.005)
    assert viscous == Damper("viscous", nu=0.5)
    assert rod.lam == pytest.approx(40000 * 2.0**2 / (weight * pier.size))
    assert rod == Tendon(5000 / weight, rod.lam, 9000 / weight, 0.5)
    assert second.base.restraints[0].f == 900 / weight
    assert [case.columns for case in study.cases] == [{"damper_1_force_kN": 450}, {"damper_1_force_kN": 900}]


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        ('kind = "friction"', "force_kN is missing"), ('kind = "friction"\nf = 0.1\nforce_kN = 5', "force_kN and f"),
        ('kind = "friction"\nf = 0.1\nyield_mm = 5', 'yield_mm = 5: does not apply to kind = "friction"'),
        ('kind = "hysteretic"\nf = 0.1', "yield_mm is missing"),
        ('kind = "viscous"\ncoefficient_kN_s_m = 5', "coefficient_kN_s_m: kN are of a pier whose mass is known"),
        ('kind = "rubber"\nf = 0.1', "rubber"), ('kind = "viscous"\nnu = 0.1\nat = "middle"', "an offset"),
    ],
)  # fmt: skip
def test_mistakes_of_a_damper_are_reported(tmp_path, keys, told):
    with pytest.raises(InputError) as error:
        study_of(tmp_path, PIER, PULSE, f'[[case]]\nbase = "rigid"\n[[case.damper]]\n{keys}\n')
    assert told in str(error.value)


def test_dampers_and_tendons_on_springs_are_read(tmp_path):
    text = '[[case]]\nbase = "yielding"\nbeta = 40\neta = 3.0\n[[case.damper]]\nkind = "friction"\nf = 0.1\n'
    text += "[case.tendon]\npsi = [0.5, 1.0]\n"
    study = study_of(tmp_path, PIER, PULSE, text)
    assert [case.base.restraints for case in study.cases] == [
        (Damper("friction", f=0.1), Tendon(psi=psi)) for psi in (0.5, 1.0)
    ]
    with pytest.raises(InputError, match="eta must be above 1 \\+ psi"):
        study_of(tmp_path, PIER, PULSE, text.replace("[0.5, 1.0]", "[0.5, 2.0]"))


def test_dampers_on_one_side_have_no_mirror_image(tmp_path):
    both = '[motions]\npolarity = ["+", "-"]\n' + PULSE
    damper = '[[case]]\nbase = "rigid"\n[[case.damper]]\nkind = "friction"\nf = 0.1\n'
    study_of(tmp_path, PIER, both, damper)
    with pytest.raises(InputError, match="keep one polarity"):
        study_of(tmp_path, PIER, both, damper + 'at = "left"\n')


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ("[{ pga_g = 0.4 }, { pga_g = 0.5 }]", "target: expected one table; write [motions.target], once"),
        ("[{ pga_g = 0.4 }, 3]", "target = [{ pga_g = 0.4 }, 3]: expected one value, not a list"),
    ],
)
def test_a_list_in_place_of_a_table_is_called_tables_only_if_it_has_no_others(tmp_path, value, words):
    path = tmp_path / "study.toml"
    path.write_text(f"[pier]\nalpha = 0.2\np = 1.0\n[motions]\ntarget = {value}\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        load_study(path)
    assert any(words in message for message in caught.value.messages)
