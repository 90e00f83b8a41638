"""[[bound]]: a case under a bound is the case of a study in which its keys are written so."""

from dataclasses import replace

import pytest

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.study.bound_keys import PRESETS, _factor
from rockbatch.study.design_bounds import DesignBound

PRESET = "NTC 2018 viscous"

PIER = {"width_m": 4.0, "height_m": 20.0, "mass_t": 800.0, "deck_mass_t": 500.0}
PULSE = {"name": "sine", "shape": "sine", "amplitude_g": 0.4, "period_s": 0.8, "dt_s": 0.01, "duration_s": 3.0}
SPRINGS = {"name": "springs", "base": "elastic", "stiffness_kN_m": 2.0e6, "zeta": 0.05}
DAMPERS = {"kind": "friction", "force_kN": 300.0, "at": "left"}, {"kind": "viscous", "nu": 0.4}
ROCK = {"name": "rock", "base": "rigid"}


def tables(*bounds, cases=(SPRINGS,), pier=PIER, **more):
    return {"pier": pier, "motions": {"pulse": [PULSE]}, "case": list(cases), "bound": list(bounds), **more}


def study(*bounds, **more):
    return rb.Study.from_dict(tables(*bounds, **more))


def under(name, of_study):
    return [case for case in of_study.cases if case.columns["bound"] == name]


@pytest.mark.parametrize(
    ("change", "written"),
    [
        ({"case.stiffness_kN_m": {"times": 2.0}}, {"case": [SPRINGS | {"stiffness_kN_m": 4.0e6}]}),
        ({"case.zeta": 0.02}, {"case": [SPRINGS | {"zeta": 0.02}]}),
        ({"pier.deck_mass_t": 700.0}, {"pier": PIER | {"deck_mass_t": 700.0}}),
        ({"pier.height_m": {"times": 1.1}}, {"pier": PIER | {"height_m": 22.0}}),
        (
            {"pier.deck_mass_t": {"times": 1.4}, "case.zeta": {"times": 0.5}, "case.stiffness_kN_m": {"times": 0.5}},
            {
                "pier": PIER | {"deck_mass_t": 700.0},
                "case": [SPRINGS | {"zeta": 0.025, "stiffness_kN_m": 1.0e6}],
            },
        ),
    ],
)
def test_a_case_under_a_bound_is_the_case_written_with_its_values(change, written):
    of_bound = under("b", study({"name": "b", **change}))
    (by_hand,) = rb.Study.from_dict({**tables(), **written, "bound": None}).cases
    assert [(case.pier.alpha, case.pier.p, case.base) for case in of_bound] == [
        (pytest.approx(by_hand.pier.alpha), pytest.approx(by_hand.pier.p), by_hand.base)
    ]


def coefficients(bound, of_study):
    return {
        case.name: [damper.nu for damper in case.base.restraints if damper.kind == "viscous"]
        for case in under(bound, of_study)
    }


def test_a_preset_stands_for_bounds_of_whichever_unit_cases_have():
    """Of a viscous damper in kN and one over M p, beside one of friction that stays; a rock without dampers runs unchanged."""
    damper = {"kind": "viscous", "coefficient_kN_s_m": 500.0, "exponent": 1.0}
    cases = [SPRINGS | {"damper": [damper]}, SPRINGS | {"name": "two", "damper": list(DAMPERS)}, ROCK]
    of_study = study({"preset": PRESET}, cases=cases)
    assert [bound.name for bound in of_study.bounds] == [f"{PRESET} low", f"{PRESET} high"]
    assert {bound.source for bound in of_study.bounds} == {PRESETS[PRESET].source}
    nominal = coefficients("", of_study)
    for name, times in (("low", 0.85), ("high", 1.15)):
        found = coefficients(f"{PRESET} {name}", of_study)
        assert found == {case: [pytest.approx(times * nu) for nu in values] for case, values in nominal.items()}
    assert [entry["lacking"] for entry in (bound.as_in_run_json() for bound in of_study.bounds)] == [
        [{"case": "rock", "keys": ["case.damper.coefficient_kN_s_m", "case.damper.nu"]}]
    ] * 2
    one = study({"preset": PRESET}, {"name": "b", "case.zeta": 0.1}, cases=[SPRINGS | {"damper": [damper]}])
    one = one.with_(bound=[PRESET])
    assert [bound.as_in_run_json()["changes"] for bound in one.bounds] == [
        ["case.damper.coefficient_kN_s_m × 0.85"],
        ["case.damper.coefficient_kN_s_m × 1.15"],
    ]


@pytest.mark.parametrize(
    ("bounds", "said"),
    [
        (({"preset": "EN 15129"},), 'preset = "EN 15129": expected one of "NTC 2018 viscous"'),
        (({"preset": "NTC 2018 viscous", "name": "low"},), "a preset names its bounds; leave name out"),
        (({"preset": "NTC 2018 viscous", "source": "test"},), "a preset has its source; leave source out"),
        (({"preset": "NTC 2018 viscous", "case.zeta": 0.1},), '"case.zeta": a preset has its changes; write it in a'),
        (({"preset": "NTC 2018 viscous"},) * 2, 'preset = "NTC 2018 viscous": given twice; write it once'),
        (
            ({"preset": "NTC 2018 viscous"},),
            "no case has one of the keys that it changes: case.damper.coefficient_kN_s_m,",
        ),
        (({"case.zeta": 0.1},), 'name is missing; write for example name = "stiff ground"'),
    ],
)
def test_a_preset_that_cannot_be_used_is_refused_with_a_remedy(bounds, said):
    with pytest.raises(InputError) as refused:
        study(*bounds)
    assert said in str(refused.value)


@pytest.mark.parametrize(
    ("path", "forces"),
    [
        ("case.damper.force_kN", [360.0, 0.4]),
        ("case.damper_1.force_kN", [360.0, 0.4]),
        ("case.damper.nu", [300.0, 0.48]),
        ("case.damper_2.nu", [300.0, 0.48]),
    ],
)
def test_devices_are_changed_all_or_by_their_number(path, forces):
    (case,) = under("b", study({"name": "b", path: {"times": 1.2}}, cases=[SPRINGS | {"damper": list(DAMPERS)}]))
    friction, viscous = case.base.restraints
    weight = 1300.0 * 9.81
    assert [friction.f * weight, viscous.nu] == pytest.approx(forces)


@pytest.mark.parametrize(("path", "forces"), [("damper", [360.0, 240.0]), ("damper_2", [300.0, 240.0])])
def test_of_two_devices_with_the_key_only_the_numbered_one_is_changed(path, forces):
    pair = [
        {"kind": "friction", "force_kN": 300.0, "at": "left"},
        {"kind": "friction", "force_kN": 200.0, "at": "right"},
    ]
    (case,) = under(
        "b", study({"name": "b", f"case.{path}.force_kN": {"times": 1.2}}, cases=[SPRINGS | {"damper": pair}])
    )
    assert [damper.f * 1300.0 * 9.81 for damper in case.base.restraints] == pytest.approx(forces)


def test_the_nominal_design_runs_and_then_each_bound_alone():
    bounds = {"name": "stiff", "case.stiffness_kN_m": {"times": 2.0}}, {"name": "light", "pier.deck_mass_t": 400.0}
    soft = {"stiffness_kN_m": [1.0e6, 2.0e6]}
    of_study = study(*bounds, cases=[SPRINGS | soft, ROCK])
    assert of_study.varied == ("stiffness_kN_m", "bound")
    names = [case.columns["bound"] for case in of_study.cases]
    assert names == ["", "stiff", "light"] * 3
    design = [case.columns.get("stiffness_kN_m") for case in of_study.cases]
    assert design == [1.0e6] * 3 + [2.0e6] * 3 + [None] * 3  # a column names the design, by its nominal value
    nominal = [replace(case, columns={}) for case in of_study.cases if not case.columns["bound"]]
    alone = rb.Study.from_dict(tables(cases=[SPRINGS | soft, ROCK]) | {"bound": None})
    assert nominal == [replace(case, columns={}) for case in alone.cases]


def test_a_case_that_lacks_the_key_runs_unchanged_and_is_named():
    of_study = study({"name": "stiff", "case.stiffness_kN_m": {"times": 2.0}}, cases=[SPRINGS, ROCK])
    assert of_study.bounds[0].lacking == (("rock", ("case.stiffness_kN_m",)),)
    nominal, stiff = (case for case in of_study.cases if case.name == "rock")
    assert (nominal.pier, nominal.base) == (stiff.pier, stiff.base)


@pytest.mark.parametrize(
    ("bound", "words"),
    [
        ({"case.eta": {"times": 2.0}}, "case.eta × 2: no case has this key, so that there is nothing to multiply"),
        ({"case.restitution": 0.9}, "case.restitution = 0.9: no case has this key; write its nominal value in a "),
        ({"pier.top_m": 21.0}, "pier.top_m = 21: [pier] has no such key; write its nominal value in [pier]"),
        ({"case.damper.force_kN": 300.0}, "case.damper.force_kN = 300: no case has this key"),
        ({"case.stiffness_kNm": 3.0}, '"case.stiffness_kNm": no such key; did you mean case.stiffness_kN_m?'),
        *(
            ({path: value}, f'"{path}": another value makes another design; write another [[case]]')
            for path, value in {
                "case.base": "rigid",
                "case.name": "other",
                "case.other_width_m": 6.0,
                "case.damper.kind": "viscous",
                "case.damper.at": "right",
            }.items()
        ),
        ({"case.kinematics": {"times": 2.0}}, "times is for numbers"),
        ({"case.zeta": {"times": -1.0}}, "expected a factor above 0"),
        ({"case.zeta": {"time": 1.2}}, 'expected a factor above 0; write for example "case.zeta" = { times = 1.2 }'),
        ({"case.zeta": [0.02, 0.05]}, "expected a number"),
        ({"case.zeta": 2.0}, "case.zeta"),
        ({"case.stiffness_kN_m": 10.0}, '"springs": stiffness_kN_m = 10 with the 1300 t of [pier] means beta = '),
        ({"pier.deck_mass_t": {"times": 1e4}}, '[[bound]] "b": [pier]: deck_mass_t = '),
        ({}, "it changes nothing; write for example"),
        ({"name": "1.5", "case.zeta": 0.02}, "expected a name that is no number in tables"),
        ({"case.zeta": 0.02, "confirm": ["zetta"]}, 'confirm = "zetta": there is no such key'),
    ],
)
def test_a_bound_that_cannot_be_is_refused_at_its_place_with_the_remedy(bound, words):
    with pytest.raises(InputError) as raised:
        study({"name": "b"} | bound)
    assert words in str(raised.value)
    assert str(raised.value).startswith('study.toml: [[bound]] "')


@pytest.mark.parametrize(
    ("written", "factor"),
    [
        ({"times": 1.01e-6}, 1.01e-6), ({"times": 1e-6}, None), ({"times": 0.0}, None), ({"times": -1.0}, None),
        ({"times": 0.99e6}, 0.99e6), ({"times": 1e6}, None), ({"times": 3}, 3.0), ({"times": True}, None), ({"times": "2"}, None),
        ({}, None), ({"times": 2.0, "plus": 1.0}, None), ({"plus": 1.0}, None),
    ],
)  # fmt: skip
def test_a_factor_of_a_bound_is_a_number_between_a_millionth_and_a_million(written, factor):
    assert _factor(written) == factor


def test_two_bounds_of_one_name_are_refused():
    with pytest.raises(InputError, match=r'"b": given twice; give each bound its own name'):
        study({"name": "b", "case.zeta": 0.02}, {"name": "b", "case.zeta": 0.1})


def test_the_advice_to_confirm_an_unusual_value_is_taken():
    unusual = {"name": "b", "pier.deck_mass_t": {"times": 200.0}}
    with pytest.raises(InputError, match=r'write confirm = \["deck_mass_t"\] in this table'):
        study(unusual, cases=[ROCK])
    confirmed = study(unusual | {"confirm": ["deck_mass_t"]}, cases=[ROCK])
    assert under("b", confirmed)[0].pier.mass_t == pytest.approx(100_800.0)


@pytest.mark.parametrize("value", [35.0, {"times": 100.0}])
def test_an_unusual_value_of_a_case_is_asked_to_be_confirmed(value):
    """Friction of 35 or 30 is a slip of degrees; the nominal 0.3 is usual."""
    unusual = {"name": "b", "case.friction": value}
    rough = {"cases": [ROCK | {"friction": 0.3}], "output": {"forces": True}}
    with pytest.raises(InputError, match=r'write confirm = \["friction"\] in this table'):
        study(unusual, **rough)
    confirmed = study(unusual | {"confirm": ["friction"]}, **rough)
    assert under("b", confirmed)[0].base.friction >= 30.0


def test_two_bounds_whose_names_look_alike_are_refused():
    with pytest.raises(InputError, match=r'"soft  ground": is read as the bound "soft ground"'):
        study({"name": "soft ground", "case.zeta": 0.02}, {"name": "soft  ground", "case.zeta": 0.1})


def test_every_key_that_a_case_lacks_is_named_once_with_the_source_of_the_bound():
    two = {"case.zeta": 0.02, "case.stiffness_kN_m": {"times": 2.0}}
    of_study = study({"name": "stiff", "source": "tests of 2024", **two}, cases=[SPRINGS, ROCK])
    (entry,) = (bound.as_in_run_json() for bound in of_study.bounds)
    assert entry == {
        "bound": "stiff",
        "source": "tests of 2024",
        "changes": ["case.zeta = 0.02", "case.stiffness_kN_m × 2"],
        "lacking": [{"case": "rock", "keys": ["case.zeta", "case.stiffness_kN_m"]}],
    }


def test_a_path_without_quotes_is_read_likewise():
    quoted = '[pier]\nalpha = 0.2\np = 1.0\n[motions]\nstill_s = 1.0\n[[case]]\nbase = "elastic"\nbeta = 40.0\n'
    texts = (
        f'{quoted}[[bound]]\nname = "b"\n{path}' for path in ('"case.beta" = {times = 2.0}', "case.beta.times = 2.0")
    )
    first, second = (rb.Study.from_toml(text).cases for text in texts)
    assert first == second
    assert [case.base.beta for case in first] == [40.0, 80.0]


def test_an_axis_across_is_that_of_the_pier_under_the_bound():
    both = ROCK | {"other_width_m": 6.0}
    motions = {"motions": {"path": "motions/near_fault", "axis_deg": 0.0}}
    of_study = study({"name": "high", "pier.height_m": {"times": 1.2}}, cases=[both], **motions)
    heights = {(case.name, case.columns["bound"]): 2.0 * case.pier.height for case in of_study.cases}
    with_deck = rb.Study.from_dict(tables(cases=[both], pier=PIER | {"height_m": 24.0}) | motions | {"bound": None})
    high = {case.name: 2.0 * case.pier.height for case in with_deck.cases}
    assert {name: heights[name, "high"] for name in high} == pytest.approx(high)


def test_results_of_a_study_without_bounds_have_no_column_of_them():
    of_study = rb.Study.from_dict(tables() | {"bound": None})
    assert (of_study.varied, of_study.bounds, of_study.cases[0].columns) == ((), (), {})


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_a_run_under_a_bound_is_the_run_of_a_study_written_so_to_the_bit(factor):
    of_bound = rb.run(study({"name": "b", "case.stiffness_kN_m": {"times": factor}}), progress=False, jobs=1)
    by_hand = rb.run(
        rb.Study.from_dict(tables(cases=[SPRINGS | {"stiffness_kN_m": 2.0e6 * factor}]) | {"bound": None}),
        progress=False,
        jobs=1,
    )
    assert of_bound["bound"].tolist() == ["", "b"]
    shared = [name for name in by_hand if name != "bound"]
    assert of_bound[shared].iloc[1].equals(by_hand[shared].iloc[0])


def test_a_bound_can_be_taken_away_in_python():
    of_study = study({"name": "b", "case.zeta": 0.02}, {"name": "c", "case.zeta": 0.1})
    assert [bound.name for bound in of_study.with_(bound="c").bounds] == ["c"]
    assert of_study.with_(bound=None).varied == ()
    assert isinstance(of_study.bounds[0], DesignBound)
