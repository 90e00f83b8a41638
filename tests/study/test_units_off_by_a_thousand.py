"""Values a thousand times too small or too large: refused until they are confirmed."""

import pytest
from studies import SINE, study_text, write_study

from rockbatch.analyses.fragility.study import read_fragility
from rockbatch.common.errors import InputError
from rockbatch.study import load_study

PIER = {"width_m": 8.0, "height_m": 30.0, "mass_t": 3000.0}
SPRINGS = {"name": "pads", "base": "yielding", "stiffness_kN_m": 2e6, "yield_kN": 4e4}
RATIOS = {"name": "pads", "base": "yielding", "beta": 40.0, "eta": 2.5}
STEEL = {"kind": "hysteretic", "force_kN": 450.0, "yield_mm": 5.0}
OIL = {"kind": "viscous", "coefficient_kN_s_m": 900.0, "brace_kN_m": 2e5}
TENDON = {"prestress_kN": 5000.0, "stiffness_kN_m": 40e3, "yield_kN": 15e3}
STOP = {"gap_mm": 100.0, "stiffness_kN_m": 5e5}
DECK_SPRING = {"gap_mm": 50.0, "stiffness_kN_m": 5e4, "height_m": 31.5}
DECK = {"width_m": 8.0, "height_m": 30.0, "mass_t": 2000.0, "deck_mass_t": 1000.0, "deck_inertia_t_m2": 12e3}
TABLES = {  # by the table that is varied: all that is usual
    "pier": PIER | {"flexural_period_s": 0.6, "top_m": 31.5},
    "deck": DECK, "held": {"alpha": 0.2, "p": 1.0, "initial_rotation_rad": 0.05},
    "size": {"alpha": 0.2, "size_m": 20.0}, "p": {"alpha": 0.2, "p": 0.4},
    "springs": SPRINGS | {"area_m2": 6.0, "flight_limit_mm": 20.0}, "ratios": RATIOS,
    "friction": {"kind": "friction", "force_kN": 450.0}, "hysteretic": STEEL, "viscous": OIL, "tendon": TENDON, "stop": STOP,
    "deck_spring": DECK_SPRING, "damper nu": {"kind": "viscous", "nu": 0.5}, "tendon psi": {"psi": 0.2},
    "stop lambda": {"gap_mm": 100.0, "lambda": 20.0}, "deck_spring lambda": {"lambda": 1.0},
}  # fmt: skip
PIERS = ("pier", "deck", "held", "size", "p")
NOTHING = "practically nothing"
SMALL = [  # table, key, value as written, and what is said of it
    ("pier", "width_m", 0.008, "less than 0.01 m"),
    ("pier", "height_m", 0.03, "less than 0.05 m"),
    ("pier", "mass_t", 3.0, "of 3 t would have 0.0016 t/m³"),
    ("pier", "flexural_period_s", 6e-4, "less than 0.02 s"),
    ("pier", "top_m", 0.0315, "less than 0.05 m"),
    ("deck", "deck_inertia_t_m2", 12.0, "of a mass of 1000 t at 0.11 m from its axis"),
    ("held", "initial_rotation_rad", 5e-5, "less than 0.0001 rad"),
    ("size", "size_m", 0.02, "less than 0.1 m"),
    ("p", "p", 0.02, "less than 0.1 rad/s"),
    ("springs", "area_m2", 0.006, "presses 2.5e+06 kPa"),
    ("springs", "flight_limit_mm", 0.02, "less than 0.1 mm"),
    ("friction", "force_kN", 0.45, NOTHING),
    ("hysteretic", "force_kN", 0.45, NOTHING),
    ("hysteretic", "yield_mm", 0.005, "the damper yields at 0.005 mm"),
    ("viscous", "coefficient_kN_s_m", 0.9, NOTHING),
    ("viscous", "brace_kN_m", 200.0, "1.4 % of the pier's weight at a rotation of α"),
    ("tendon", "prestress_kN", 5.0, NOTHING),
    ("tendon", "stiffness_kN_m", 40.0, NOTHING),
    ("stop", "gap_mm", 0.1, "it is met after 0.1 mm already"),
    ("stop", "stiffness_kN_m", 500.0, NOTHING),
    ("deck_spring", "gap_mm", 0.05, "it is met after 0.05 mm already"),
    ("deck_spring", "stiffness_kN_m", 50.0, NOTHING),
    ("deck_spring", "height_m", 0.0315, "0.00105 times the height"),
    ("tendon psi", "psi", 0.0, "with no prestress and no stiffness the tendon is not there"),
    ("stop lambda", "lambda", 0.0, "with no stiffness the stop is not there"),
    ("deck_spring lambda", "lambda", 0.0, "with no stiffness the spring is not there"),
]  # fmt: skip
LARGE = [
    ("pier", "width_m", 8000.0, "more than 400 m: the highest bridge piers"),
    ("pier", "height_m", 30e3, "more than 400 m"),
    ("pier", "mass_t", 3e6, "more than 1e+06 t: the heaviest"),
    ("pier", "flexural_period_s", 600.0, "more than 10 s"),
    ("deck", "deck_inertia_t_m2", 12e6 * 30, "at 6e+02 m from its axis"),
    ("size", "size_m", 20e3, "more than 400 m"),
    ("p", "p", 400.0, "more than 30 rad/s"),
    ("springs", "stiffness_kN_m", 2e9, "in by 0.0074 mm only, where sound rock"),
    ("springs", "yield_kN", 4e7, "2.72e+03 times what the support carries"),
    ("springs", "area_m2", 6000.0, "presses 2.5 kPa"),
    ("springs", "flight_limit_mm", 20e3, "more than 10000 mm"),
    ("ratios", "beta", 40e3, 'ground that does not give is base = "rigid"'),
    ("ratios", "eta", 2500.0, 'without a limit base = "elastic"'),
    ("friction", "force_kN", 45e3, "one damper has 1.53 times the pier's weight"),
    ("hysteretic", "yield_mm", 5e3, "the damper yields at 5e+03 mm"),
    ("viscous", "coefficient_kN_s_m", 9e5, "has the force of the pier's weight"),
    ("viscous", "brace_kN_m", 2e8, "leave out one that is rigid"),
    ("damper nu", "nu", 4000.0, "one damper has the force of the pier's weight"),
    ("tendon", "stiffness_kN_m", 4e7, "adds 14.2 times the pier's weight"),
    ("tendon", "yield_kN", 15e6, "it yields at 510 times"),
    ("stop", "gap_mm", 1e5, "more than the pier is wide"),
    ("stop", "stiffness_kN_m", 5e8, "at a deflection of 0.059 mm"),
    ("deck_spring", "gap_mm", 5e4, "the deck is only there"),
    ("deck_spring", "stiffness_kN_m", 5e7, "at a deflection of 0.59 mm"),
    ("deck_spring", "height_m", 31.5e3, "times the height of the pier"),
]  # fmt: skip


def device_of(table):
    """The name of a device's table in a case; empty for a pier or its supports."""
    name = table.partition(" ")[0]
    known = ("tendon", "stop", "deck_spring")
    return name if name in known else "" if table in (*PIERS, "springs", "ratios") else "damper"


def problems_with(folder, table, **keys):
    """What is said about a study with these keys in a table; nothing if it is accepted."""
    written = TABLES[table] | keys
    pier, case = PIER, {"name": "a", "base": "rigid"}
    if table in PIERS:
        pier = written
    elif table in ("springs", "ratios"):
        case = written
    else:
        case = case | {device_of(table): [written]}
    try:
        load_study(write_study(folder, study_text(pier=pier, cases=[case])))
    except InputError as error:
        return error.messages
    return ()


@pytest.mark.parametrize("table", TABLES)
def test_usual_values_are_accepted(tmp_path, table):
    assert problems_with(tmp_path, table) == ()


@pytest.mark.parametrize(("table", "key", "value", "said"), SMALL + LARGE)
def test_a_unit_off_by_a_thousand_is_refused_until_it_is_confirmed(tmp_path, table, key, value, said):
    named = [problem for problem in problems_with(tmp_path, table, **{key: value}) if f"{key} = {value:g}: " in problem]
    (problem,) = [problem for problem in named if said in problem]
    place = f"[[case.{device_of(table)}]]" if device_of(table) else "this table"
    assert problem.endswith(f'check the unit; if it is right, write confirm = ["{key}"] in {place}')
    lines = (tmp_path / "study.toml").read_text(encoding="utf-8").splitlines()
    assert key in lines[int(problem.removeprefix(f"{tmp_path / 'study.toml'}:").partition(":")[0]) - 1]
    confirmed = problems_with(tmp_path, table, **{key: value, "confirm": [key]})
    assert not any(said in problem for problem in confirmed)  # of what follows from it, more may be odd


@pytest.mark.parametrize(
    "pier",
    [
        {"width_m": 0.03, "height_m": 0.1, "mass_t": 0.0007}, {"width_m": 0.25, "height_m": 1.0, "mass_t": 0.5},
        {"alpha": 0.1, "p": 8.5}, {"alpha": 0.2, "p": 1.0, "mass_t": 3000.0}, {"alpha": 0.13, "p": 0.38, "mass_t": 3000.0},
    ],
)  # fmt: skip
def test_blocks_of_laboratories_and_piers_of_papers_are_accepted(tmp_path, pier):
    load_study(write_study(tmp_path, study_text(pier=pier, cases=[{"base": "rigid"}])))


def of_check(folder, confirm=(), **limit):
    check = {"name": "bearing", "reason": "plan", **limit} | ({"confirm": list(confirm)} if confirm else {})
    study = study_text(pier=PIER, cases=[SPRINGS], check=[check], output={"forces": True})
    load_study(write_study(folder, study))


@pytest.mark.parametrize(
    ("limit", "said"),
    [
        ({"demand": "yield_kN", "at_least": 26},
         "at_least = 26: yield_kN is 4e+04 here, 1.5e+03 times the limit, so that it decides nothing; check"),
        ({"demand": "yield_kN", "at_least": 26e6},
         "at_least = 2.6e+07: yield_kN is 4e+04 here, 0.0015 times the limit, so that it decides nothing; check"),
        ({"demand": "stiffness_kN_m", "at_least": 2000}, "at_least = 2000: stiffness_kN_m is 2e+06 here"),
        ({"demand": "base_shear_kN", "at_most": 9e6},
         "at_most = 9e+06: base_shear_kN is a force, and the pier's weight, 2.943e+04 kN, is 0.0033 times the limit; check"),
        ({"demand": "base_shear_kN", "at_most": 2}, "is 1.5e+04 times the limit; check"),
    ],
)  # fmt: skip
def test_a_limit_in_another_unit_is_refused_until_it_is_confirmed(tmp_path, limit, said):
    with pytest.raises(InputError) as caught:
        of_check(tmp_path, **limit)
    (problem,) = caught.value.messages
    assert said in problem
    of_check(tmp_path, confirm=set(limit) - {"demand"}, **limit)


def test_limits_near_what_is_there_are_accepted(tmp_path):
    for limit in ({"demand": "yield_kN", "at_least": 26e3}, {"demand": "base_shear_kN", "at_most": 9000.0}):
        of_check(tmp_path, **limit)


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        (
            "period_s",
            1000.0,
            "more than 100 s: pulses of near-fault records have 0.5 to 10; if it is in ms, write period_s = 1; check",
        ),
        ("period_s", 1e-3, "less than 0.01 s"),
    ],
)
def test_a_pulse_in_another_unit_is_refused_until_it_is_confirmed(tmp_path, key, value, said):
    pulse = SINE | {"dt_s": 1e-5 if value == 1e-3 else 0.01, "duration_s": 2.0 if value < 1.0 else 2e3, key: value}
    with pytest.raises(InputError, match=f"{key} = {value:g}: {said}"):
        load_study(write_study(tmp_path, study_text(pulses=(pulse,))))
    load_study(write_study(tmp_path, study_text(pulses=(pulse | {"confirm": [key]},))))


FRAGILITY = {"measure": "PGV", "levels_m_s": [0.25, 0.5, 1.0]}
HAZARD = {"levels_m_s": [0.1, 0.2, 0.4], "return_period_years": [100, 475, 2475]}
RATES = {"levels_m_s": [0.1, 0.2, 0.4], "rate_per_year": [0.01, 0.0021, 0.0004]}


@pytest.mark.parametrize(
    ("table", "key", "written", "said"),
    [
        (FRAGILITY, "levels_m_s", [25, 50, 100], "levels_m_s = 25: more than 10 m/s: the strongest"),
        (HAZARD, "levels_m_s", [11, 20, 40], "levels_m_s = 11: more than 10 m/s"),
        (HAZARD, "return_period_years", [0.1, 0.475, 2.475], "return_period_years = 0.1: less than 0.5 years"),
        (RATES, "rate_per_year", [10, 2.1, 0.4], "rate_per_year = 10: more than 2 per year"),
    ],
)  # fmt: skip
def test_levels_and_rates_in_another_unit_are_refused_until_they_are_confirmed(tmp_path, table, key, written, said):
    def read(**confirm):
        changed = table | {key: written} | confirm
        fragility = changed if table is FRAGILITY else FRAGILITY | {"hazard": changed}
        read_fragility(load_study(write_study(tmp_path, study_text(fragility=fragility))))

    with pytest.raises(InputError) as caught:
        read()
    assert any(said in problem for problem in caught.value.messages)
    read(confirm=[key])


def test_levels_in_percent_of_g_and_tables_of_a_hazard_are_judged_too(tmp_path):
    percent = {"measure": "PGA", "levels_g": [20, 40]}
    with pytest.raises(InputError, match="levels_g = 20: more than"):
        read_fragility(load_study(write_study(tmp_path, study_text(fragility=percent))))
    (tmp_path / "hazard.csv").write_text("levels_m_s,return_period_years\n0.1,0.1\n0.4,2.475\n", encoding="utf-8")
    for more in ({}, {"confirm": ["file"]}):
        text = study_text(fragility=FRAGILITY | {"hazard": {"file": "hazard.csv"} | more})
        study = load_study(write_study(tmp_path, text))
        if more:
            read_fragility(study)
        else:
            with pytest.raises(InputError, match=r'return_period_years = 0\.1: .* confirm = \["file"\] in this table'):
                read_fragility(study)
