"""Values that only a wrong unit explains: told with what is usual, and taken once they are confirmed."""

import pytest

import rockbatch as rb
from rockbatch.cli import main
from rockbatch.errors import InputError
from rockbatch.study import load_study

PULSE = (
    '[[motions.pulse]]\nname = "sine"\nshape = "sine"\namplitude_g = 0.2\nperiod_s = 1.0\ndt_s = 0.01\nduration_s = 2\n'
)
PARTS = {
    "pier": "[pier]\nwidth_m = 4\nheight_m = 30\nmass_t = 3000\n",
    "numerics": "[numerics]\ntolerance = 1e-4\n",
    "case": '[[case]]\nname = "pads"\nbase = "yielding"\nstiffness_kN_m = 2e6\nyield_kN = 4e4\n',
    "check": '[[check]]\nname = "uplift"\ndemand = "heel_uplift_m"\nat_most = 0.1\nreason = "keys"\n',
}
THETA = ('demand = "heel_uplift_m"\nat_most = 0.1', 'demand = "theta_max_over_alpha"\nat_most = 50')
FOUND = [  # part, what stands there, what shall, its key, and what is said
    ("pier", "width_m = 4", "width_m = 4000", "width_m", "[pier]: width_m = 4000: more than 400 m: the highest bridge piers"),
    ("pier", "height_m = 30", "height_m = 30e3", "height_m", "[pier]: height_m = 30000: more than 400 m"),
    ("pier", "mass_t = 3000", "mass_t = 3e6", "mass_t", "[pier]: mass_t = 3e+06: more than 1e+06 t: the heaviest"),
    ("pier", "mass_t = 3000", "mass_t = 3000\ntop_m = 31500", "top_m", "[pier]: top_m = 31500: more than 400 m"),
    ("pier", "mass_t = 3000", "mass_t = 2e3\ndeck_mass_t = 2e6", "deck_mass_t", "[pier]: deck_mass_t = 2e+06: more than"),
    ("pier", "mass_t = 3000", "[[pier.part]]\nmass_t = 3000\nheight_m = 1500\ninertia_t_m2 = 2e5", "height_m",
     "[[pier.part]] no. 1: height_m = 1500: more than 400 m"),
    ("numerics", "1e-4", "100", "tolerance", "[numerics]: tolerance = 100: more than 0.1 of theta_max/alpha"),
    ("case", "2e6", "2e9", "stiffness_kN_m",
     '[[case]] "pads": stiffness_kN_m = 2e+09: the pier\'s weight presses the supports in by 0.0074 mm only, where sound rock'),
    ("case", "4e4", "[4e4, 37e6]", "yield_kN",
     '[[case]] "pads": yield_kN = 3.7e+07: 2.51e+03 times what the support carries at rest, where 2 to 20'),
    ("check", "at_most = 0.1", "at_most = 100", "at_most",
     '[[check]] "uplift": at_most = 100: heel_uplift_m above 0.5302 is past the edge of overturning, so the limit decides'),
    ("check", *THETA, "at_most", '[[check]] "uplift": at_most = 50: theta_max_over_alpha above 1 is past the edge'),
    ("check", *(each.replace("theta_max_over_alpha", "top_drift_m") for each in THETA), "at_most",
     '[[check]] "uplift": at_most = 50: top_drift_m above 3.977 is past the edge'),
    ("check", *(each.replace("theta_max_over_alpha", "settlement_m") for each in THETA), "at_most",
     '[[check]] "uplift": at_most = 50: settlement_m above 4 is more than the pier is wide'),
    ("check", THETA[0], 'demand = "eta"\nat_least = 2500', "at_least", '[[check]] "uplift": at_least = 2500: eta above 100'),
    ("check", "at_most = 0.1", 'statistic = "count"\nabove = 100\nat_most = 2', "above",
     '[[check]] "uplift": above = 100: heel_uplift_m above 0.5302 is past the edge'),
]  # fmt: skip


def written(folder, **changed):
    path = folder / "study.toml"
    path.write_text(PULSE + "".join((PARTS | changed)[name] for name in PARTS), encoding="utf-8")
    return path


def problems_of(path):
    """What is said about a study; nothing where it is right."""
    try:
        load_study(path)
    except InputError as error:
        return error.problems
    return ()


def at_the_key(text, new, key):
    """``text`` with a line that confirms ``key`` below the last of ``new``, which is of the same table."""
    return text.replace(new, f'{new}\nconfirm = ["{key}"]')


@pytest.mark.parametrize(("part", "old", "new", "key", "said"), FOUND)
def test_what_only_a_wrong_unit_explains_is_refused_until_it_is_confirmed(tmp_path, part, old, new, key, said):
    assert old in PARTS[part]
    text = PARTS[part].replace(old, new)
    (problem,) = (each for each in problems_of(written(tmp_path, **{part: text})) if f": {said}" in each)
    assert problem.endswith(f'check the unit; if it is right, write confirm = ["{key}"] in this table')
    line = int(problem.removeprefix(f"{tmp_path / 'study.toml'}:").partition(":")[0])
    assert key in (tmp_path / "study.toml").read_text().splitlines()[line - 1]
    confirmed = problems_of(written(tmp_path, **{part: at_the_key(text, new, key)}))
    assert not any(f": {said}" in each for each in confirmed)  # others may follow from it, as of a pier of 4 km × 30 m


def test_the_mass_of_a_case_is_judged_too(tmp_path):
    pier = PARTS["pier"].replace("mass_t = 3000\n", "")
    case = PARTS["case"].replace("2e6", "2e9") + "mass_t = 3e6\n"
    problem, *_ = problems_of(written(tmp_path, pier=pier, case=case.replace("4e4", "4e7")))
    assert '[[case]] "pads": mass_t = 3e+06: more than 1e+06 t' in problem
    believed = at_the_key(case.replace("4e4", "4e7"), "mass_t = 3e6", "mass_t")
    assert problems_of(written(tmp_path, pier=pier, case=believed)) == ()


def test_a_study_that_is_confirmed_runs(tmp_path):
    """Stiff as a laboratory's floor, and a limit that is not meant to bite."""
    case = at_the_key(PARTS["case"].replace("4e4", "37e6"), "37e6", "yield_kN")
    check = at_the_key(PARTS["check"].replace("0.1", "100"), "at_most = 100", "at_most")
    study = load_study(written(tmp_path, case=case, check=check))
    assert study.cases[0].base.eta == pytest.approx(2 * 37e6 / (3000 * 9.81))
    assert study.checks[0].confirm == ("at_most",)
    assert main(["run", str(study.path), "--out", str(tmp_path / "out")]) == 0


def test_what_is_usual_passes(tmp_path):
    """The ends of what is usual, ratios of any size, and a limit at the edge of overturning."""
    ends = {
        "pier": "[pier]\nwidth_m = 100\nheight_m = 400\nmass_t = 1e6\n",
        "case": '[[case]]\nname = "pads"\nbase = "yielding"\nbeta = 5000\neta = 5000\n',
        "numerics": "[numerics]\ntolerance = 0.1\n",
        "check": PARTS["check"].replace(*THETA).replace("50", "1"),
    }
    load_study(written(tmp_path, **ends))


def test_a_limit_is_odd_only_where_it_is_so_for_all_its_cases(tmp_path):
    """0.6 m is past the edge of the pier of 4 m and not of the one of 6 m."""
    both = PARTS["pier"].replace("width_m = 4", "width_m = [4, 6]")
    load_study(written(tmp_path, pier=both, check=PARTS["check"].replace("0.1", "0.6")))
    with pytest.raises(InputError, match=r"heel_uplift_m above 1\.184 is past"):
        load_study(written(tmp_path, pier=both, check=PARTS["check"].replace("0.1", "1.3")))


@pytest.mark.parametrize(
    ("part", "old", "new", "said"),
    [
        ("pier", "= 3000", '= 3000\nconfirm = ["heigth_m"]', 'confirm = "heigth_m": this table has no such key; write one'),
        ("numerics", "1e-4", '1e-4\nconfirm = "quiet_s"', 'this table has no such key; write one of "tolerance"'),
        ("check", "= 0.1", '= 0.1\nconfirm = "name"', 'confirm = "name": expected one of "at_most", "at_least", "above"'),
        ("numerics", "1e-4", "9e-13", "tolerance = 9e-13: expected 1e-12 or above, because rounding alone makes as much"),
        ("numerics", "1e-4", "0", "tolerance = 0: expected a number above 0"),
    ],
)  # fmt: skip
def test_what_cannot_be_confirmed_or_met_is_told(tmp_path, part, old, new, said):
    with pytest.raises(InputError) as caught:
        load_study(written(tmp_path, **{part: PARTS[part].replace(old, new)}))
    (problem,) = caught.value.problems
    assert said in problem


def test_rules_from_elsewhere_are_held_against_the_piers_of_the_results(tmp_path):
    out = tmp_path / "out"
    assert main(["run", str(written(tmp_path)), "--out", str(out)]) == 0
    rules = tmp_path / "rules.toml"
    rules.write_text(PARTS["check"].replace("0.1", "100"), encoding="utf-8")
    with pytest.raises(InputError, match=r'check "uplift": at_most = 100: heel_uplift_m above 0\.5302'):
        rb.check(out, rules)
    with pytest.raises(InputError, match="past the edge"):
        rb.check(out, [rb.Rule("uplift", "heel_uplift_m", at_most=100.0)])
    assert (
        rb.check(out, [rb.Rule("uplift", "heel_uplift_m", at_most=100.0, confirm=("at_most",))])["value"].notna().all()
    )
    rules.write_text(at_the_key(rules.read_text(), "at_most = 100", "at_most"), encoding="utf-8")
    assert rb.check(out, rules)["verdict"].eq("pass").all()


def test_a_run_to_less_than_rounding_is_refused(tmp_path):
    """It would never be called settled."""
    pier, motion = rb.Pier(0.2, 1.0), rb.pulse("sine", name="p", amplitude=2.5, period=1.0, dt=0.01, duration=1.0)
    with pytest.raises(InputError, match="tolerance = 1e-13: must be 1e-12 or above"):
        rb.simulate(pier, rb.RigidBase(), motion, tolerance=1e-13)
