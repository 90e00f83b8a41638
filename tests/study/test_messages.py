"""What is said about the mistakes that people make most: one message each, at the key that is wrong."""

import pytest
from studies import PIER, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.study import load_study
from rockbatch.toml.reader import MOST_REPORTED

PADS = {"name": "pads with dampers", "base": "rigid"}
HEAVY = {"width_m": 4.0, "height_m": 30.0, "mass_t": 2300.0}
EN_1998 = {"type": 1, "ground": "B", "ag_g": 0.25, "period_range_s": [0.4, 4.0]}


def said(folder, text):
    with pytest.raises(InputError) as caught:
        load_study(write_study(folder, text))
    return [problem.removeprefix(f"{folder / 'study.toml'}:").strip() for problem in caught.value.messages]


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"pier": {"widht_m": 4.0, "height_m": 30.0}}, "[pier]: widht_m: unknown key; did you mean width_m?"),
        ({"pier": {"alpha": 0.2, "size": 7.0}}, "[pier]: size: unknown key; did you mean size_m?"),
        ({"pier": {"alhpa": 0.2, "p": 1.0}}, "[pier]: alhpa: unknown key; did you mean alpha?"),
        ({"pier": PIER | {"mass": 900.0}, "cases": [PADS | {"damper": [{"kind": "friction", "force_kN": 40.0}]}]},
         "[pier]: mass: unknown key; did you mean mass_t?"),
        ({"cases": [{"bse": "rigid"}]}, "[[case]] no. 1: bse: unknown key; did you mean base?"),
        ({"cases": [], "csae": [PADS]}, "csae: unknown section; did you mean case?"),
        ({"cases": [{"base": "rigid", "shft": "elastic", "flexural_damping": 0.1}]},
         "[[case]] no. 1: shft: unknown key; did you mean shaft?"),
        ({"cases": [{"base": "yielding", "beta": 50.0, "eta_": 2.5}]}, "[[case]] no. 1: eta_: unknown key; did you mean eta?"),
        ({"cases": [{"base": "yielding", "beta": 50.0, "eta_of_supports": 2.5}]},
         "[[case]] no. 1: eta_of_supports: unknown key; did you mean eta?"),
    ],
)  # fmt: skip
def test_a_misspelt_key_is_reported_once_and_not_as_missing_too(tmp_path, tables, message):
    (problem,) = said(tmp_path, study_text(**tables).replace("case = []\n", ""))
    assert problem.partition(": ")[2] == message


def test_a_misspelt_pier_is_reported_once_though_its_mass_is_not_read(tmp_path):
    devices = {"damper": [{"kind": "friction", "force_kN": 40.0}]}
    text = study_text(pier=HEAVY, cases=[PADS | devices]).replace("[pier]", "[peir]")
    (problem,) = said(tmp_path, text)
    assert problem.endswith("peir: unknown section; did you mean pier?")


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"damper": [{"kind": "friction"}]}, "damper: unknown section; write [[case.damper]]"),
        ({"part": [{"mass_t": 5.0}]}, "part: unknown section; write [[pier.part]]"),
        ({"pulse": [SINE]}, "pulse: unknown section; write [[motions.pulse]]"),
        ({"numerics": {"ag_g": 0.2}}, "[numerics]: ag_g: unknown key; it belongs under [motions.target]"),
        ({"numerics": {"mass_t": 2.0}}, "mass_t: unknown key; it belongs under [pier] or [[pier.part]] or [[case]]"),
    ],
)  # fmt: skip
def test_the_message_on_a_misplaced_table_or_key_names_its_place(tmp_path, tables, message):
    (problem,) = said(tmp_path, study_text(**tables))
    assert message in problem


def test_a_device_is_called_by_its_case_and_number_and_its_kind_by_all_there_are(tmp_path):
    dampers = [{"kind": "friction", "f": 0.1, "at": "left"}, {"f": 0.1}]
    (problem,) = said(tmp_path, study_text(cases=[PADS | {"damper": dampers}]))
    assert '[[case]] "pads with dampers", damper 2: kind is missing; write for example kind = "friction"; ' in problem
    assert problem.endswith('kind is one of "friction", "hysteretic", "viscous"')


@pytest.mark.parametrize(
    ("device", "key", "meaning"),
    [
        ({"damper": [{"kind": "friction", "f": 0.1}, {"kind": "friction", "force_kN": 500e3}]}, "force_kN", "f = 22.1602"),
        ({"tendon": [{"psi": 0.1, "at": "left"}, {"prestress_kN": 500e3, "at": "right"}]}, "prestress_kN", "psi = 22.1602"),
    ],
)  # fmt: skip
def test_a_force_in_newtons_is_reported_at_its_own_key_in_kilonewtons(tmp_path, device, key, meaning):
    text = study_text(pier=HEAVY, cases=[PADS | device])
    (problem,) = said(tmp_path, text)
    what = next(iter(device))
    assert f'[[case]] "pads with dampers", {what} 2: {key} = 500000 means {meaning}: its ' in problem
    assert text.splitlines()[int(problem.partition(":")[0]) - 1].startswith(key)


def test_gravity_in_cm_s2_is_reported_at_its_key_and_nowhere_else(tmp_path):
    pads = {"base": "yielding", "stiffness_kN_m": 2e6, "yield_kN": 4e4}
    (problem,) = said(tmp_path, study_text(pier=HEAVY | {"gravity": 981}, cases=[pads]))
    assert "[pier]: gravity = 981: more than 30 m/s²: on Earth it is 9.81; check the unit" in problem
    moon = study_text(pier=HEAVY | {"gravity": 1.62}, cases=[pads])
    assert load_study(write_study(tmp_path, moon)).cases[0].pier.gravity == 1.62


@pytest.mark.parametrize(
    ("spectrum", "meant"), [("EC8", "EN 1998-1"), ("Eurocode 8", "EN 1998-1"), ("ASCE 7-16", "ASCE 7")]
)
def test_another_name_of_a_code_is_reported_alone_without_its_keys(tmp_path, spectrum, meant):
    (problem,) = said(tmp_path, study_text(motions={"target": EN_1998 | {"spectrum": spectrum}}))
    assert f'spectrum = "{spectrum}": no such file' in problem
    assert problem.endswith(f'did you mean "{meant}"?')


WHOLE = study_text(
    pier={"width_m": 4.0, "part": [{"mass_t": 900.0, "height_m": 12.0}, {"mass_t": 500.0, "height_m": 28.0}]},
    motions={"target": EN_1998 | {"spectrum": "EN 1998-1"}, "select": {"pga_g": [0.1, 1.0]}},
    cases=[PADS | {"damper": [{"kind": "hysteretic", "f": 0.1, "yield_mm": 5.0}], "tendon": {"psi": 0.1}}],
    numerics={"tolerance": 1e-4},
    output={"intensity": True, "sa_periods_s": [1.0]},
    suite={"count": "station"},
    check=[{"name": "a", "demand": "overturned", "at_most": 0, "reason": "collapse"}],
    reference=[{"record": "*", "case": "pads with dampers", "theta_max_over_alpha": 0.1, "source": "S"}],
)


HEADERS = [line for line in WHOLE.splitlines() if line.startswith("[")]


@pytest.mark.parametrize(
    ("header", "number"),
    [(header, MOST_REPORTED) for header in HEADERS] + [("", MOST_REPORTED + more) for more in (-1, 0, 1)],
)
def test_the_greatest_number_of_reported_mistakes_ends_in_words(tmp_path, header, number):
    """Nothing is made of tables that were then not read to their end; without a header they stand at the top."""
    mistakes = "".join(f"k{n} = 1\n" for n in range(number))
    text = WHOLE.replace(f"{header}\n", f"{header}\n{mistakes}", 1) if header else mistakes + WHOLE
    assert sum("unknown key" in problem for problem in said(tmp_path, text)) == min(number, MOST_REPORTED)


@pytest.mark.parametrize(
    ("pier", "damper", "said"),
    [
        ({"alpha": 0.2, "p": 1.0}, 'kind = "viscous"\nnu = 1.0\nexponent = 1.05\nbrace = 10.0',
         "damper 1: brace = 10: with one the exponent must be 1 at most; leave the brace out"),
        ({"width_m": 8.0, "height_m": 30.0, "mass_t": 2000.0}, 'kind = "friction"\nforce_kN = 1e9',
         "damper 1: force_kN = 1e+09 means f = 50968.4: its force over the weight must be within 0..10; check the unit"),
    ],
)  # fmt: skip
def test_what_is_impossible_of_a_device_is_said_of_the_key_that_was_written(pier, damper, said):
    with pytest.raises(InputError) as raised:
        rb.Study.from_toml(study_text(pier=pier, cases=[RIGID]) + f"\n[[case.damper]]\n{damper}\n")
    assert str(raised.value).endswith(said)
