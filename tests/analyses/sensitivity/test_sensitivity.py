"""What the answer depends on: Sobol indices against known ones, inputs that cannot matter, and the mistakes of a file."""

import json
import math
import shutil
from dataclasses import replace
from importlib.metadata import version

import numpy as np
import pandas as pd
import pytest
from studies import PADS, PIER, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.sensitivity import sampled
from rockbatch.analyses.sensitivity.analysis import answers, counted_as, tornado, values_of
from rockbatch.analyses.sensitivity.sampled import Design, Point, Points, design, indices, low_base_high
from rockbatch.analyses.sensitivity.section import section
from rockbatch.analyses.sensitivity.study import Input, own_values, read_sensitivity
from rockbatch.batch.plan import simulations
from rockbatch.batch.threads import Threads
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.common.units import GRAVITY
from rockbatch.motions import Motion
from rockbatch.pier import Damper, ElasticBase, Pier, RigidBase, Tendon, YieldingBase
from rockbatch.reporting.finished_analysis import Contents
from rockbatch.simulation import run_to_tolerance
from rockbatch.study import load_study
from rockbatch.study.inputs import impossible, outside, varied
from rockbatch.study.suite import ground_motions

STUDY = study_text(
    pulses=(
        SINE | {"name": "short", "amplitude_g": 0.5, "period_s": 0.6, "duration_s": 1.0},
        SINE | {"name": "long", "amplitude_g": 0.35, "period_s": 1.0, "duration_s": 1.0},
    ),
    cases=(RIGID | {"restitution": 0.9}, PADS | {"beta": 30, "eta": 3, "epsilon": 0.1}),
    sensitivity={
        "statistic": "max", "samples": 8, "uniform": {"alpha": [0.18, 0.22], "mu": [2.0, 4.0], "eta": [2.5, 3.5]},
        "log_uniform": {"p": [0.8, 1.2]}, "choice": {"vertical": [True, False], "polarity": ["+", "-"]},
    },
)  # fmt: skip


def written(tmp_path, text=STUDY):
    return write_study(tmp_path, text)


@pytest.fixture
def study(tmp_path):
    return load_study(written(tmp_path))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Results of the study above."""
    path = tmp_path_factory.mktemp("sensitivity")
    assert main(["sensitivity", str(written(path)), "--out", str(path / "out")]) == 0
    return path / "out"


# Sobol's indices


def test_the_indices_of_the_ishigami_function_are_the_known_ones(monkeypatch):
    """sin x + 7 sin² y + 0.1 z⁴ sin x on (−π, π)³ (Ishigami & Homma 1990).

    Its variances are V_x = (1 + π⁴/50)²/2, V_y = 49/8 and V_xz = 8 π⁸/22500. 2048 × 5 points: within 0.02, half the
    interval that the bootstrap gives.
    """
    monkeypatch.setattr(sampled, "RESAMPLES", 250)
    inputs = [Input(name, "uniform", (-math.pi, math.pi)) for name in "xyz"]
    points = design(inputs, 2048, seed=1)
    found = [math.sin(p["x"]) * (1 + 0.1 * p["z"] ** 4) + 7 * math.sin(p["y"]) ** 2 for p in points]
    table = indices(inputs, np.array(found), 0.95, seed=1).set_index("parameter")
    v_x, v_y, v_xz = 0.5 * (1 + math.pi**4 / 50) ** 2, 49 / 8, 8 * math.pi**8 / 22500
    whole = v_x + v_y + v_xz
    assert table["first"].to_list() == pytest.approx([v_x / whole, v_y / whole, 0.0], abs=0.02)
    assert table["total"].to_list() == pytest.approx([(v_x + v_xz) / whole, v_y / whole, v_xz / whole], abs=0.02)
    for name, exact in (("first", [v_x, v_y, 0.0]), ("total", [v_x + v_xz, v_y, v_xz])):
        assert (abs(table[name] - np.array(exact) / whole) < table[f"{name}_error"]).all()
        assert (table[f"{name}_error"] < 0.08).all()


def test_ranges_and_choices_are_drawn_as_they_are_meant():
    """Means of Sobol points: of log-uniform values the logarithm's is the middle; choices come as often."""
    inputs = [
        Input("p", "log_uniform", (0.1, 10.0)),
        Input("alpha", "uniform", (1.0, 3.0)),
        Input("kinematics", "choice", ("first-order", "finite")),
        Input("vertical", "choice", (True, False)),
    ]
    points = design(inputs, 256, seed=2)
    assert len(points) == 256 * 6
    assert np.mean([math.log(point["p"]) for point in points]) == pytest.approx(0.0, abs=0.02)
    assert np.mean([point["alpha"] for point in points]) == pytest.approx(2.0, abs=0.01)
    assert {point["kinematics"] for point in points} == {"first-order", "finite"}
    assert np.mean([point["vertical"] is True for point in points]) == pytest.approx(0.5, abs=0.02)


def test_a_choice_that_decides_all_has_the_whole_variance_and_the_other_none():
    inputs = [Input("spring", "choice", ("epp", "bouc-wen")), Input("p", "uniform", (1.0, 2.0))]
    points = design(inputs, 256, seed=1)
    table = indices(inputs, np.array([5.0 if point["spring"] == "epp" else 1.0 for point in points]), 0.95, 1)
    assert table["first"].to_list() == pytest.approx([1.0, 0.0], abs=0.02)
    assert table["total"].to_list() == pytest.approx([1.0, 0.0], abs=0.02)


def test_an_answer_that_never_changes_has_no_indices():
    inputs = [Input("p", "uniform", (1.0, 2.0))]
    table = indices(inputs, np.full(12, 0.3), 0.95, 1)
    assert table[["first", "total", "first_error", "total_error"]].isna().all(axis=None)


# The real model


def test_what_cannot_matter_does_not(folder):
    """μ enters the rigid base's equation through p and e alone, and both are given; these pulses have no vertical
    component; and a pier is as good as its mirror image. None of their total indices differs from 0 but by rounding."""
    shares = pd.read_csv(folder / "sobol.csv").set_index(["case", "parameter"])
    swings = pd.read_csv(folder / "sensitivity.csv").set_index(["case", "parameter"])
    for which in (("rigid", "mu"), *((case, name) for case in ("rigid", "pads") for name in ("vertical", "polarity"))):
        assert shares.loc[which, "total"] == pytest.approx(0.0, abs=1e-12)
        assert swings.loc[which, "swing"] == pytest.approx(0.0, abs=1e-12)
    for which in (("rigid", "p"), ("pads", "p")):
        assert shares.loc[which, "total"] > 0.2
        assert swings.loc[which, "swing"] > 0.1
    assert ("rigid", "eta") not in shares.index


def test_the_answers_at_both_ends_are_those_of_runs_of_their_own(folder, study):
    """The greater of the two pulses' peaks, to the ten digits that are kept."""
    swings = pd.read_csv(folder / "sensitivity.csv").set_index(["case", "parameter"])
    motions = ground_motions(study).motions

    def answer(pier, base):
        outcomes = [run_to_tolerance(pier, base, motion, 1e-4) for motion in motions]
        return max(counted_as(each.status, each.theta_max / pier.alpha, 1.0) for each in outcomes)

    base = RigidBase(0.9)
    for name, end, pier in (
        ("p", "low", Pier(0.2, 0.8)),
        ("p", "high", Pier(0.2, 1.2)),
        ("alpha", "base", Pier(0.2, 1.0)),
        ("alpha", "high", Pier(0.22, 1.0)),
    ):
        assert swings.loc[("rigid", name), f"answer_{end}"] == pytest.approx(answer(pier, base), rel=1e-8)
    pads = YieldingBase(30.0, eta=2.5, epsilon=0.1)
    assert swings.loc[("pads", "eta"), "answer_low"] == pytest.approx(answer(Pier(0.2, 1.0), pads), rel=1e-8)


def test_the_suite_has_every_motion_turned_and_stripped_as_its_point_says(study):
    """Points run fastest; the vertical component goes where the point says so, and nothing else is touched."""
    spec = read_sensitivity(study)
    points = Points(study, spec)
    motion = Motion("m", 0.01, np.array([0.0, 1.0, 2.0]), vertical=np.array([0.0, 3.0, 4.0]))
    suite = Design(study, points, [motion])
    runs = suite.runs()
    assert len(runs) == len(points) == (1 + 2 * 5) + 8 * 7 + (1 + 2 * 6) + 8 * 8
    for run, moved, point in zip(runs, simulations(runs), points.all, strict=True):
        sign = -1.0 if point.values["polarity"] == "-" else 1.0
        assert (moved.motion.horizontal == sign * motion.horizontal).all()
        assert (moved.motion.vertical is not None) is point.values["vertical"]
        assert run.case.pier.p == moved.pier.p == point.values["p"]


def test_a_restitution_that_is_not_given_starts_from_housners(tmp_path):
    text = STUDY.replace("restitution = 0.9\n", "").replace("mu = [", "restitution = [0.8, 0.99]\nmu = [")
    study = load_study(written(tmp_path, text))
    case = study.cases[0]
    inputs = Points(study, read_sensitivity(study)).inputs[0]
    assert low_base_high(inputs, study, case)[0]["restitution"] == case.pier.restitution


# Dampers and tendons

TIED = {
    "name": "tied",
    "base": "rigid",
    "damper": [{"kind": "friction", "f": 0.05}, {"kind": "viscous", "nu": 0.2, "at": "left"}],
    "tendon": {"psi": 0.2, "lambda": 0.5},
}
DAMPED = {"name": "damped", "base": "elastic", "beta": 30, "zeta": 0.05}


def varying(uniform, *, cases=(TIED,), pier=PIER, **more):
    """A study of dampers and tendons that varies these inputs."""
    asked = {"statistic": "max", "samples": 4, "uniform": uniform} | more
    return study_text(pier=pier, pulses=[SINE | {"duration_s": 1.0}], cases=cases, sensitivity=asked)


def test_parameters_of_devices_and_damped_supports_answer_as_separate_runs(tmp_path):
    uniform = {
        "zeta": [0.02, 0.1], "damper": {"f": [0.01, 0.1]}, "damper_2": {"nu": [0.1, 0.5]}, "tendon": {"psi": [0.1, 0.4]},
    }  # fmt: skip
    path = written(tmp_path, varying(uniform, cases=(TIED, DAMPED)))
    found = rb.sensitivity(path).sensitivity.set_index(["case", "parameter"])
    assert set(found.index) == {
        ("tied", "damper.f"), ("tied", "damper_2.nu"), ("tied", "tendon.psi"), ("damped", "zeta"),
    }  # fmt: skip
    (motion,) = ground_motions(load_study(path)).motions
    friction, viscous, tendon = (
        Damper("friction", f=0.05),
        Damper("viscous", nu=0.2, at="left"),
        Tendon(psi=0.2, lam=0.5),
    )
    for case, name, end, base in (
        ("tied", "damper.f", "base", RigidBase(restraints=(friction, viscous, tendon))),
        ("tied", "damper.f", "high", RigidBase(restraints=(replace(friction, f=0.1), viscous, tendon))),
        ("tied", "damper_2.nu", "high", RigidBase(restraints=(friction, replace(viscous, nu=0.5), tendon))),
        ("tied", "tendon.psi", "low", RigidBase(restraints=(friction, viscous, replace(tendon, psi=0.1)))),
        ("damped", "zeta", "low", ElasticBase(30.0, zeta=0.02)),
    ):
        outcome = run_to_tolerance(Pier(0.2, 1.0), base, motion, 1e-4)
        assert found.loc[(case, name), f"answer_{end}"] == pytest.approx(outcome.theta_max / 0.2, rel=1e-8), (name, end)
    assert (found["swing"] > 1e-3).all()


HEAVY = {"width_m": 2.0, "height_m": 10.0, "mass_t": 100.0}
IN_KN = {
    "name": "tied", "base": "rigid",
    "damper": [
        {"kind": "hysteretic", "force_kN": 50.0, "yield_mm": 5.0},
        {"kind": "viscous", "coefficient_kN_s_m": 40.0, "exponent": 0.5},
    ],
    "tendon": [{"prestress_kN": 100.0, "stiffness_kN_m": 4000.0, "yield_kN": 500.0}, {"lambda": 0.5, "at": "left"}],
}  # fmt: skip


@pytest.mark.parametrize(("name", "place", "value"), [
    ("damper.force_kN", ("damper", 0), 60.0),
    ("damper_1.yield_mm", ("damper", 0), 3.0),
    ("damper.coefficient_kN_s_m", ("damper", 1), 70.0),
    ("damper_2.exponent", ("damper", 1), 0.8),
    ("tendon_1.prestress_kN", ("tendon", 0), 150.0),
    ("tendon_1.stiffness_kN_m", ("tendon", 0), 3000.0),
    ("tendon.yield_kN", ("tendon", 0), 600.0),
    ("tendon_2.lambda", ("tendon", 1), 0.7),
])  # fmt: skip
def test_an_input_is_what_the_case_has_with_the_value_written_there(tmp_path, name, place, value):
    """To the bit; and what the study says itself, in the key's own unit, is the base of the range."""
    study = load_study(written(tmp_path, study_text(pier=HEAVY, cases=[IN_KN])))
    key, (what, number) = name.partition(".")[2], place
    tables = [dict(each) for each in IN_KN[what]]
    tables[number][key] = value
    other = load_study(written(tmp_path, study_text(pier=HEAVY, cases=[IN_KN | {what: tables}])))
    assert varied(study.cases[0], {name: value}) == other.cases[0]
    assert own_values(study, study.cases[0])[name] == IN_KN[what][number][key]
    ratio = {"damper_1.force_kN": "damper.f", "tendon_1.prestress_kN": "tendon_1.psi"}
    for absolute, over_weight in ratio.items():
        own = own_values(study, study.cases[0])
        assert own[absolute] == pytest.approx(own[over_weight] * 100.0 * GRAVITY, rel=1e-11)


TWO = TIED | {"damper": [{"kind": "friction", "f": 0.05, "at": "left"}, {"kind": "friction", "f": 0.1, "at": 0.2}]}


@pytest.mark.parametrize(("uniform", "more", "line", "words"), [
    ({"damper": {"f": [0.06, 0.1]}}, {}, "f = ", 'does not hold the 0.05 of case "tied"; write damper.f = [0.05, 0.1]'),
    ({"damper": {"f": [0.02, 20.0]}}, {}, "f = ",
     "[sensitivity.uniform.damper]: f = 20.0: its force over the weight must be within 0..10"),
    ({"damper": {"f": [0.1, 0.02]}}, {}, "f = ", "expected a range; write for example f = [0.02, 0.1]"),
    ({"damper": {"force": [1.0, 2.0]}}, {}, "force = ", "force: unknown key; did you mean force_kN?"),
    ({"damper": {"force_kN": [1.0, 2.0]}}, {}, "force_kN", "damper.force_kN: it goes with a pier of known mass (mass_t)"),
    ({"damper": {"yield_mm": [1.0, 2.0]}}, {}, "yield_mm", 'damper.yield_mm: it goes with kind = "hysteretic"; leave it'),
    ({"damper_3": {"f": [0.01, 0.1]}}, {}, "f = ", "damper_3.f: no case of the study has a damper 3; leave it out"),
    ({"damper_2": {"f": [0.01, 0.1]}}, {}, "f = ", "damper_2.f: no damper of that number has it; leave it out"),
    ({"tendon": {"psi": [0.1, 0.4]}}, {"cases": (RIGID,)}, "psi", "tendon.psi: no case of the study has a tendon"),
    ({"tendon": {"yield_kN": [1.0, 4.0]}}, {"pier": HEAVY}, "yield_kN",
     "tendon.yield_kN: it goes with a tendon that yields; give its yield_kN in the case"),
    ({"damper": {"f": [0.01, 0.1]}}, {"cases": (TWO,)}, "f = ",
     'damper.f: case "tied" has 2 of them; write damper_1.f or damper_2.f'),
    ({"damper": {"f": [0.01, 0.1]}, "damper_1": {"f": [0.01, 0.1]}}, {}, "f = ",
     "damper.f and damper_1.f are given, which fix the same; keep one"),
    ({"tendon": {"psi": [0.1, 0.4]}}, {"log_uniform": {"tendon": {"psi": [0.1, 0.4]}}}, "psi",
     "tendon.psi is given under uniform and log_uniform; keep one"),
    ({"alpha": [0.1, 0.3]}, {"choice": {"damper": {"f": [0.1, 0.2]}}}, "damper", "belongs under [sensitivity.uniform]"),
    ({"zeta": [0.0, 0.1]}, {}, "zeta", "zeta: no case of the study has it"),
    ({"beta": [20.0, 60.0]}, {}, "beta", "beta: no case of the study has it"),
    ({"zeta": [0.0, 0.1]}, {"cases": (PADS,)}, "zeta",
     "zeta: it goes with springs that have one; write zeta in the case; leave it out"),
    ({"epsilon": [0.0, 0.1]}, {"cases": (DAMPED,)}, "epsilon",
     'epsilon: zeta or impact = "housner" takes its place; leave it out'),
])  # fmt: skip
def test_impossible_inputs_of_dampers_and_tendons_are_reported_at_their_line(tmp_path, uniform, more, line, words):
    path = written(tmp_path, varying(uniform, **more))
    with pytest.raises(InputError) as caught:
        read_sensitivity(load_study(path))
    (told,) = [problem for problem in caught.value.messages if words in problem] or [str(caught.value)]
    assert words in told
    number = int(told.partition("study.toml:")[2].partition(":")[0])
    assert line in path.read_text(encoding="utf-8").splitlines()[number - 1]


@pytest.mark.parametrize("wrong", ["damper_1.f", "damper_2.f"])
def test_an_impossible_value_is_told_of_the_one_of_two_dampers_that_has_it(tmp_path, wrong):
    case = load_study(written(tmp_path, study_text(cases=[TWO]))).cases[0]
    values = {"damper_1.f": 0.06, "damper_2.f": 0.06} | {wrong: -1.0}
    assert impossible(case, values) == [(f"{wrong} = -1: its force over the weight must be within 0..10", wrong)]


# How runs count


@pytest.mark.parametrize(("status", "theta", "counts"), [
    ("ok", 0.3, 0.3),
    ("ok", 1.4, 1.0),
    ("overturned", 9.0, 1.0),
    ("overturned", 0.2, 1.0),
    ("flight", 0.2, 1.0),
    ("failed", 0.2, 0.2),
    ("failed", math.nan, 1.0),
])  # fmt: skip
def test_runs_count_at_most_as_overturned(status, theta, counts):
    assert counted_as(status, theta, 1.0) == counts


def test_the_statistic_is_that_of_the_suite_at_each_point():
    rows = [{"status": "ok", "theta_max_over_alpha": str(x)} for x in (0.1, 0.2, 0.3, 0.6, 0.5, 0.4)]
    rows[3]["status"] = "overturned"
    statuses, values = values_of(rows, 2, 1.0)  # three motions, two points
    assert statuses == {"ok": 5, "overturned": 1}
    assert answers(values, "median").tolist() == [0.3, 0.4]
    assert answers(values, "max").tolist() == [0.5, 1.0]


def test_a_swing_holds_the_answer_of_the_study_itself_and_the_greatest_comes_first():
    """Where the answer at the study's own value is above both ends of p; alpha has the greater swing."""
    inputs = [Input("p", "uniform", (0.5, 2.0)), Input("alpha", "uniform", (0.1, 0.3))]
    answers_there = np.array([0.9, 0.2, 0.3, 0.1, 0.8])
    alpha, p = tornado(inputs, [Point(0, {"p": 1.0, "alpha": 0.2})], answers_there)
    assert (alpha["parameter"], p["parameter"]) == ("alpha", "p")
    assert (alpha["swing"], p["swing"]) == pytest.approx((0.8, 0.7))
    assert (p["low"], p["base"], p["high"]) == (0.5, 1.0, 2.0)
    assert (p["answer_low"], p["answer_base"], p["answer_high"]) == (0.2, 0.9, 0.3)


# The study file and the command


def test_every_mistake_is_reported_with_its_line(tmp_path):
    text = STUDY.replace("samples = 8", "samples = 10\nstatistics = 1").replace('= ["+", "-"]', '= ["+"]')
    text = text.replace("mu = [2.0, 4.0]", "mu = [4.0, 2.0]\nkinematics = 1\np = [0.5, 2]")
    with pytest.raises(InputError) as caught:
        read_sensitivity(load_study(written(tmp_path, text)))
    told = "\n".join(caught.value.messages)
    for line, words in (
        (36, "samples = 10: expected a power of two from 4"),
        (37, "statistics: unknown key; did you mean statistic?"),
        (41, "mu = [4.0, 2.0]: expected a range; write for example mu = [2.0, 4.0]"),
        (42, "kinematics = 1: belongs under [sensitivity.choice]"),
        (47, "p is given under uniform and log_uniform; keep one"),
        (51, 'polarity: expected both choices; write polarity = ["+", "-"]'),
    ):
        assert any(f"study.toml:{line}: " in problem and words in problem for problem in caught.value.messages), told


def test_a_range_without_the_values_of_several_cases_is_answered_once(tmp_path):
    """α of the study is atan(3.9/30) and atan(5/30); the range that is advised holds both, and is taken."""
    text = study_text(
        pier={"width_m": [3.9, 5.0], "height_m": 30.0, "mass_t": 3000.0},
        cases=(RIGID,),
        sensitivity={"uniform": {"alpha": [0.14, 0.15]}},
    )
    with pytest.raises(InputError) as caught:
        read_sensitivity(load_study(written(tmp_path, text)))
    (message,) = caught.value.messages
    assert message.endswith('does not hold the 0.129275 of case "rigid", and 1 more; write alpha = [0.1292, 0.1652]')
    (parameter,) = read_sensitivity(
        load_study(written(tmp_path, text.replace("[0.14, 0.15]", "[0.1292, 0.1652]")))
    ).inputs
    assert parameter.levels == (0.1292, 0.1652)
    assert outside("f", (0.2, 0.8), [("a", 0.0), ("b", None), ("c", 0.5)]).endswith("write f = [0.0, 0.8]")


@pytest.mark.parametrize(("old", "new", "words"), [
    ("alpha = [0.18, 0.22]", "alpha = [0.21, 0.22]", 'the 0.2 of case "rigid", and 1 more; write alpha = [0.2, 0.22]'),
    ("eta = [2.5, 3.5]", "beta = [4, 30]", "beta = 4: the pier topples on its springs"),
    ("eta = [2.5, 3.5]", "eta = [0.5, 3.5]", "eta = 0.5: the springs cannot carry the weight"),
    ("alpha = [0.18, 0.22]", "alpha = [0.02, 0.22]", "beta = 30: the pier topples on its springs"),
    ("mu = [2.0, 4.0]", "n = [0.5, 6]", "n = 0.5: the Bouc–Wen exponent must be at least 1"),
    (STUDY[STUDY.index('[[case]]\nname = "pads"') : STUDY.index("[sensitivity]")], "", "eta: no case of the study has it"),
    (STUDY[STUDY.index("[sensitivity.uniform]") :], "", "nothing is varied"),
    (STUDY[STUDY.index("[sensitivity]") :], "", "[sensitivity] is missing"),
])  # fmt: skip
def test_inputs_that_cannot_be_varied_so_are_refused(tmp_path, old, new, words):
    assert old in STUDY
    with pytest.raises(InputError) as caught:
        read_sensitivity(load_study(written(tmp_path, STUDY.replace(old, new))))
    assert words in str(caught.value)


def test_a_case_that_has_none_of_the_inputs_is_left_out(tmp_path):
    """η of a rigid base."""
    text = STUDY[: STUDY.index("[sensitivity.uniform]")] + "[sensitivity.uniform]\neta = [2.5, 3.5]\n"
    assert main(["sensitivity", str(written(tmp_path, text)), "--out", str(tmp_path / "out")]) == 0
    for name in ("sensitivity.csv", "sobol.csv"):
        table = pd.read_csv(tmp_path / "out" / name)
        assert table[["case", "parameter"]].to_numpy().tolist() == [["pads", "eta"]]


def test_another_statistic_of_finished_runs_takes_no_run(folder, tmp_path, monkeypatch, capsys):
    out = tmp_path / "out"
    shutil.copytree(folder, out)
    path = written(tmp_path, STUDY.replace('"max"', '"p84"').replace("samples", "overturned = 0.5\nsamples"))

    def refused(*_):
        raise TypeError("no run is wanted")

    with monkeypatch.context() as patch:
        patch.setattr(Threads, "outcomes", refused)
        assert main(["sensitivity", str(path), "--out", str(out)]) == 0
        with pytest.raises(TypeError):  # other runs: they would be carried out
            main(["sensitivity", str(written(tmp_path, STUDY.replace("= 8", "= 16"))), "--out", str(out)])
    told = capsys.readouterr().err
    assert "theta_max/alpha = 0.5" in told
    assert "The 84 % quantile is by interpolation between the ranks of" in told
    assert (out / "sensitivity_runs.csv").read_bytes() == (folder / "sensitivity_runs.csv").read_bytes()
    assert (out / "sensitivity.csv").read_bytes() != (folder / "sensitivity.csv").read_bytes()


def test_an_input_vertical_without_vertical_components_is_said_to_do_nothing(folder):
    info = json.loads((folder / "sensitivity.json").read_text(encoding="utf-8"))
    told = section(Contents(folder, info["study"]))
    assert "No record has a vertical component" in told


def test_the_page_names_its_records_and_versions(folder):
    info = json.loads((folder / "sensitivity.json").read_text(encoding="utf-8"))
    told = section(Contents(folder, info["study"]))
    assert "2 ground motions: short; long." in told
    assert f"numba {version('numba')}" in told
