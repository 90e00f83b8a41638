"""The schemas for editors, and the words of the reference: they say what the reader takes, all of it and nothing else."""

import importlib
import json
import pkgutil
import tomllib
from pathlib import Path

import pytest
from jsonschema import Draft7Validator
from studies import study_text, write_study

import rockbatch.checks
import rockbatch.motions
import rockbatch.study
from rockbatch.errors import InputError
from rockbatch.study import load_study
from rockbatch.study.schema import main, schema_of
from rockbatch.study.sections import CHECKS, FILES, MANIFEST, STUDY
from rockbatch.study.sensitivity import read_sensitivity
from rockbatch.toml import asking, kinds
from rockbatch.toml.reader import Key

CONFIGS = Path(__file__).parents[2] / "configs"
STUDIES = Draft7Validator(schema_of(STUDY, "study"))


def places(text):
    """Where the schema finds mistakes in a study: the key, or the table that lacks or has one too many."""
    return {error.json_path for error in STUDIES.iter_errors(tomllib.loads(text))}


@pytest.mark.parametrize("name", FILES)
def test_every_schema_is_one(name):
    Draft7Validator.check_schema(schema_of(FILES[name], name))


@pytest.mark.parametrize("path", sorted(CONFIGS.glob("*.toml")), ids=lambda path: path.stem)
def test_the_example_studies_are_right_by_the_schema(path):
    assert [error.message for error in STUDIES.iter_errors(tomllib.loads(path.read_text(encoding="utf-8")))] == []


@pytest.mark.parametrize("path", sorted(CONFIGS.glob("checks/*.toml")), ids=lambda path: path.stem)
def test_the_example_checks_are_right_by_their_schema(path):
    schema = STUDIES if "[pier]" in path.read_text(encoding="utf-8") else Draft7Validator(schema_of(CHECKS, "checks"))
    assert [error.message for error in schema.iter_errors(tomllib.loads(path.read_text(encoding="utf-8")))] == []


def test_a_manifest_is_right_by_its_schema_and_one_with_a_mistake_is_not():
    schema = Draft7Validator(schema_of(MANIFEST, "manifest"))
    assert schema.is_valid({"record": [{"file": "a.AT2", "azimuth": 228, "use": True}]})
    assert not schema.is_valid({"record": [{"file": "a.AT2", "azimut": 228}]})
    assert not schema.is_valid({"record": [{"azimuth": 228}]})


PAD = {"base": "yielding", "beta": 50, "eta": 2.5}


@pytest.mark.parametrize(
    ("tables", "where"),
    [
        ({"pier": {"alpha": -0.2, "p": 1.0}}, "$.pier.alpha"),
        ({"pier": {"alpha": 0.2, "p": [1.0, 1.0]}}, "$.pier.p"),
        ({"pier": {"alpha": 0.2, "p": "1.0"}}, "$.pier.p"),
        ({"pier": {"alpha": 0.2, "p": True}}, "$.pier.p"),
        ({"pier": {"alpha": 0.2, "p": 1.0, "widht_m": 4.0}}, "$.pier"),
        ({"motions": {"vertical": "yes"}}, "$.motions.vertical"),
        ({"motions": {"polarity": ["+", "*"]}}, "$.motions.polarity"),
        ({"motions": {"scale": [1, 1]}}, "$.motions.scale"),
        ({"motions": {"target": {"pga": 0.4}}}, "$.motions.target"),
        ({"cases": [PAD | {"restitution": 0.9}]}, "$.case[0]"),
        ({"cases": [{"base": "rigid", "eta": 2.5}]}, "$.case[0]"),
        ({"cases": [{"beta": 40}]}, "$.case[0]"),
        ({"cases": [PAD | {"spring": "bouc"}]}, "$.case[0].spring"),
        ({"numerics": {"substeps": 0}}, "$.numerics.substeps"),
        ({"numerics": {"substeps": 2.5}}, "$.numerics.substeps"),
        ({"output": {"histories": "some"}}, "$.output.histories"),
        ({"check": [{"name": "a", "demand": "theta", "at_most": 1, "reason": "b"}]}, "$.check[0].demand"),
        ({"chekc": [{"name": "a"}]}, "$"),
        ({"sensitivity": {"uniform": {"damper": {"force": [1, 2]}}}}, "$.sensitivity.uniform.damper"),
        ({"sensitivity": {"log_uniform": {"tendon_2": {"psi": [0.0, 0.5]}}}}, "$.sensitivity.log_uniform.tendon_2.psi"),
        ({"sensitivity": {"uniform": {"damper_0": {"f": [1, 2]}}}}, "$.sensitivity.uniform"),
    ],
)
def test_a_mistake_is_refused_by_the_schema_where_it_is_and_by_the_reader(tmp_path, tables, where):
    text = study_text(**tables)
    assert where in {place[: len(where)] for place in places(text)}
    read = load_study if "sensitivity" not in tables else lambda path: read_sensitivity(load_study(path))
    with pytest.raises(InputError):
        read(write_study(tmp_path, text))


def test_what_is_right_is_taken_whichever_form_it_has():
    text = study_text(
        pier={"width_m": 4, "height_m": [30, 40.0], "mass_t": 500, "confirm": ["mass_t"]},
        motions={"path": "records", "vertical": "required", "scale": 2, "select": {"pga_g": [0, 1]}},
        cases=[
            PAD | {"name": "a", "n": [2, 5], "damper": [{"kind": "friction", "f": 0.1}]},
            {"name": "b", "base": "rigid", "tendon": {"psi": 0.5}},
            {"name": "c", "base": "elastic", "beta": 50, "tendon": [{"psi": 0.5, "at": "left"}]},
        ],
        reference=[{"record": "*", "case": "a", "theta_max_over_alpha": 0.1, "source": "me", "part_1_mass_t": 5}],
        sensitivity={"uniform": {"damper": {"f": [0.0, 0.1]}, "tendon_2": {"lambda": [0.5, 1]}}},
    ).replace("[0, 1]", "[0, inf]")
    assert places(text) == set()


@pytest.mark.parametrize("name", FILES)
def test_every_key_has_words_and_all_words_have_a_key(name):
    for section in FILES[name]:
        assert {*section.words} == {*section.keys}, f"words of {section.header} in rockbatch/study/words.py"
        assert all(words.endswith(".") for words in section.words.values())


def test_every_key_that_is_read_anywhere_has_its_place_in_a_section():
    listed = {name for sections in FILES.values() for section in sections for name in section.keys}
    for package in (rockbatch.study, rockbatch.checks, rockbatch.motions):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            for name, value in vars(importlib.import_module(module.name)).items():
                if isinstance(value, dict) and value and all(isinstance(key, Key) for key in value.values()):
                    assert value.keys() <= listed, f"{module.name}.{name}"


@pytest.mark.parametrize("name", FILES)
def test_every_example_is_taken_by_the_reader_and_by_the_schema(name):
    for section in FILES[name]:
        properties = schema_of([section], "")["properties"] if not section.at else None
        for key, rule in section.keys.items():
            value = tomllib.loads(f"x = {rule.example}")["x"]
            if key in ("select", "target"):
                continue  # tables of their own
            for one in value if rule.many and isinstance(value, list) else [value]:
                assert asking.takes(rule.kind, one), f"{section.header} {key}"
                assert Draft7Validator(asking.schema(rule.kind)).is_valid(one), f"{section.header} {key}"
            assert properties is None or key in properties


def place(value):
    """A kind of one's own: a word, or a number."""
    if isinstance(value, str) and value != "left":
        raise kinds.KindError('"left" or an offset in m')
    return value if value == "left" else kinds.number(value)


@pytest.mark.parametrize(
    ("kind", "schema", "told"),
    [
        (kinds.number, {"type": "number"}, "a number"),
        (kinds.positive, {"type": "number", "exclusiveMinimum": 0}, "a number above 0"),
        (kinds.not_negative, {"type": "number", "minimum": 0}, "0 or a number above it"),
        (kinds.nonzero, {"type": "number"}, "a number other than 0"),
        (kinds.count, {"type": "integer", "minimum": 1}, "a whole number, 1 or above"),
        (kinds.boolean, {"type": "boolean"}, "true or false (without quotes)"),
        (kinds.text, {"type": "string", "minLength": 1}, "text in quotes"),
        (place, {"anyOf": [{"type": "number"}, {"const": "left"}]}, '"left" or an offset in m'),
        (kinds.choice("a", "b"), {"enum": ["a", "b"]}, 'one of "a", "b"'),
    ],
)
def test_a_kind_tells_what_it_takes(kind, schema, told):
    assert asking.schema(kind) == schema
    assert asking.told(kind) == told


def test_the_schema_can_be_written(capsys):
    assert main(["study"]) == 0
    assert json.loads(capsys.readouterr().out)["properties"]["pier"]["properties"]["alpha"]
    assert main(["stduy"]) == 2
    assert "study, checks, manifest" in capsys.readouterr().err
