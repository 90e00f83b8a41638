"""The schemas for editors, and the words of the reference: they say what the reader takes, all of it and nothing else."""

import importlib
import json
import math
import pkgutil
import re
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest
from jsonschema import Draft7Validator
from studies import study_text, write_study

import rockbatch.checks
import rockbatch.motions
import rockbatch.study
from rockbatch.analyses.sensitivity.study import read_sensitivity
from rockbatch.common.errors import InputError
from rockbatch.common.units import NOT_NEGATIVE, POSITIVE, Bounds
from rockbatch.pier import devices, traits
from rockbatch.study import case_keys, load_study
from rockbatch.study.restraint_keys import DEVICES
from rockbatch.study.schema import CHECKS, FILES, MANIFEST, STUDY, main, schema_of
from rockbatch.toml import kinds
from rockbatch.toml.kinds import KindError, Text, Whole
from rockbatch.toml.reader import Table, TomlFile
from rockbatch.toml.section import CONFIRM, Key, options

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
        ({"pier": {"alpha": -0.2, "p": 1.0}}, "$.pier.alpha"), ({"pier": {"alpha": 0.2, "p": [1.0, 1.0]}}, "$.pier.p"),
        ({"pier": {"alpha": 0.2, "p": 1.0, "widht_m": 4.0}}, "$.pier"),
        ({"motions": {"polarity": ["+", "*"]}}, "$.motions.polarity"), ({"motions": {"scale": [1, 1]}}, "$.motions.scale"),
        ({"motions": {"target": {"pga": 0.4}}}, "$.motions.target"), ({"cases": [PAD | {"restitution": 0.9}]}, "$.case[0]"),
        ({"cases": [{"base": "rigid", "eta": 2.5}]}, "$.case[0]"), ({"cases": [{"beta": 40}]}, "$.case[0]"),
        ({"chekc": [{"name": "a"}]}, "$"),
        ({"sensitivity": {"uniform": {"damper": {"force": [1, 2]}}}}, "$.sensitivity.uniform.damper"),
        ({"sensitivity": {"log_uniform": {"tendon_2": {"psi": [0.0, 0.5]}}}}, "$.sensitivity.log_uniform.tendon_2.psi"),
        ({"sensitivity": {"uniform": {"damper_0": {"f": [1, 2]}}}}, "$.sensitivity.uniform"),
    ],
)  # fmt: skip
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
def test_every_key_says_what_it_means_in_a_sentence(name):
    for section in FILES[name]:
        assert all(key.words.endswith(".") for key in section.values()), section.header


def test_every_key_that_is_read_anywhere_has_its_place_in_a_section():
    listed = {name for sections in FILES.values() for section in sections for name in section}
    for package in (rockbatch.study, rockbatch.checks, rockbatch.motions):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            for name, value in vars(importlib.import_module(module.name)).items():
                if isinstance(value, Mapping) and value and all(isinstance(key, Key) for key in value.values()):
                    assert value.keys() <= listed, f"{module.name}.{name}"


CASE = "[[case]]"
NEEDED = {
    "[[pier.part]]": "mass_t height_m", "[[motions.pulse]]": "name shape amplitude_g period_s dt_s duration_s gamma nu",
    "[[motions.fema_p695]]": "station azimuth", "[[motions.sequence]]": "name records", CASE: "base backbone_mm_kN",
    "[[case.damper]]": "kind",
    "[[case.stop]]": "gap_mm", "[[check]]": "name demand reason",
    "[[reference]]": "record case theta_max_over_alpha source",
}  # fmt: skip
SINGLE = {  # where every other key takes a list
    "[pier]": "gravity", "[[pier.part]]": "", CASE: "name base backbone_mm_kN other_width_m", "[[case.damper]]": "kind at",
    "[[case.tendon]]": "at", "[[case.stop]]": "at", "[[case.deck_spring]]": "side height_m",
}  # fmt: skip
SEVERAL = {
    "[motions]": "path polarity scale columns confirm confirm_pga leave_out", "[motions.target]": "spectrum confirm",
    "[motions.vertical_target]": "spectrum confirm", "[[motions.pulse]]": "confirm", "[numerics]": "confirm",
    "[[motions.sequence]]": "records factors polarity confirm", "[output]": "sa_periods_s sa_pairs sections_m interaction_m",
    "[[bound]]": "confirm", "[[check]]": "case scale capacity confirm",
}  # fmt: skip
ALIKE = {
    "[motions]": "columns", "[motions.target]": "spectrum", "[motions.vertical_target]": "spectrum",
    "[[motions.sequence]]": "records factors polarity",
}  # fmt: skip


def test_keys_that_have_to_be_written_that_take_lists_and_that_repeat_values():
    """As the tables say of themselves: a list is several piers or foundations, and few of their keys take none."""
    for section in STUDY[: [each.header for each in STUDY].index("[[reference]]") + 1]:
        several = {name for name, key in section.items() if key.many}
        assert {name for name, key in section.items() if key.required} == {*NEEDED.get(section.header, "").split()}
        if section.header in SINGLE:
            assert section.keys() - several == {*SINGLE[section.header].split()}
        else:
            assert several == {*SEVERAL.get(section.header, "").split()}
        assert {name for name, key in section.items() if not key.distinct} == {*ALIKE.get(section.header, "").split()}


SECTIONS = [(file, section) for file, sections in FILES.items() for section in sections if section.keys_read]
TABLES = ("select", "target")  # keys of [motions] that are tables of their own
NUMBERS = (-1e6, -7.0, -1, 0, 1e-6, 0.5, 1, 1.25, 2, 3, 4, 64, 1e6)
OTHERS = (True, False, "", " ", "x", "rigid", "+", "left", "EN 1998-1", "g", [], {}, [{}], [[0.5, 0.5]], [[0.5]], 2.5)


def values_of(key):
    """Values at, inside and outside the bounds of a key, words of its own and others, and values of other types."""
    kind = key.kind
    ends = [end for end in (getattr(kind, "low", 0), getattr(kind, "high", None) or 0) if abs(end) < 1e14]
    if getattr(kind, "bounds", None) is not None:
        ends += [end for end in (kind.bounds.low, kind.bounds.high) if 1e-14 < abs(end) < 1e14]
    near = [end + step for end in ends for step in (0, 1e-6, -1e-6, 1, -1) if end + step == 0 or abs(end + step) > 1e-9]
    example = tomllib.loads(f"x = {key.example}")["x"]
    single = [*NUMBERS, *OTHERS, *near, *getattr(kind, "options", ()), example]
    lists = [[one] for one in single] + [[0.5, 1.5], [1, 2], ["a", "b"], ["+", "-"], [1, "x"], [1, 2, 3], [1, 1]]
    return single + lists


def unlike(value):
    """A value that JSON and TOML tell apart: 2.0 is a whole number in JSON."""
    items = value if isinstance(value, list) else [value]
    return any(isinstance(item, float) and item.is_integer() for item in items)


def refused_by_reader(section, name, data):
    """Whether the reader refuses this key of a table, whatever goes together in it."""
    section = replace(section, clashes=())
    file = TomlFile(Path("x.toml"), "", data, {("t", key): n for n, key in enumerate(data, 1)})
    Table(file, ("t",), "", data).read(section)
    line = list(data).index(name) + 1
    return any(problem[0] == line for problem in file.problems)


def refused_by_schema(schema, name, data):
    """Whether the schema refuses this key; without a validator, because of another key."""
    return any(list(error.path)[:1] == [name] or error.validator is None for error in schema.iter_errors(data))


@pytest.mark.parametrize(("file", "section"), SECTIONS, ids=[f"{file} {section.header}" for file, section in SECTIONS])
def test_reader_and_schema_take_and_refuse_the_same_values_of_every_key(file, section):
    """Of ranges and lists, too. The order of a range, and what a unit or a file's name may be, no schema tells."""
    schema = Draft7Validator(schema_of([replace(section, at=())], ""))
    for name, key in section.items():
        given = {other: allowed[0] for other, allowed in key.only.items()} | ({"confirm": [name]} if key.usual else {})
        whole = isinstance(key.kind, Whole)
        for value in values_of(key):
            if name in TABLES or key is CONFIRM["confirm"] or (whole and unlike(value)):
                continue
            ends = value if key.pair and isinstance(value, list) and len(value) == 2 else []
            if ends and all(takes(key, end) for end in ends) and not ends[0] < ends[1]:
                continue
            text = isinstance(key.kind, Text) and key.kind.check
            if text and isinstance(value, str) and value.strip():
                continue
            if (
                key.many
                and isinstance(value, list)
                and len({repr(key.kind(v)) for v in value if takes(key, v)}) < len(value)
            ):
                continue  # 1 and 1.0 are one number to the reader
            data = given | {name: value}
            told = f"{section.header} {name} = {value!r}"
            assert refused_by_reader(section, name, data) == refused_by_schema(schema, name, data), told


@pytest.mark.parametrize(("file", "section"), SECTIONS, ids=[f"{file} {section.header}" for file, section in SECTIONS])
def test_reader_and_schema_refuse_a_key_beside_the_same_values_of_another(file, section):
    """Such as eta on a rigid base, n of springs without an exponent, f of a viscous damper; a list has them all."""
    schema = Draft7Validator(schema_of([replace(section, at=())], ""))
    for name, key in section.items():
        value = tomllib.loads(f"x = {key.example}")["x"]
        for other, allowed in key.only.items():
            beside = {each: values[0] for each, values in key.only.items() if each != other}
            cases = [{other: option} for option in options(section[other])]
            cases += [{other: list(options(section[other]))}] if section[other].many else []
            for given in ({}, *cases):
                data = beside | given | {name: value}
                refused = refused_by_reader(section, name, data)
                assert refused == refused_by_schema(schema, name, data), data
                if len(given) == 1 and not isinstance(given[other], list):
                    assert refused == (given[other] not in allowed), data


def takes(key, value):
    try:
        key.kind(value)
    except KindError:
        return False
    return True


@pytest.mark.parametrize("name", FILES)
def test_every_example_is_taken_by_the_reader_and_by_the_schema(name):
    for section in FILES[name]:
        schema = Draft7Validator(schema_of([replace(section, at=())], ""))
        for key, declared in section.items():
            if declared is CONFIRM["confirm"]:
                continue
            data = {other: values[0] for other, values in declared.only.items()} | tomllib.loads(
                f"{key} = {declared.example}"
            )
            assert not refused_by_reader(section, key, data), f"{section.header} {key}"
            assert not refused_by_schema(schema, key, data), f"{section.header} {key}"


@pytest.mark.parametrize(
    ("kind", "schema", "words"),
    [
        (kinds.number, {"type": "number"}, "a number"),
        (kinds.positive, {"type": "number", "exclusiveMinimum": 0}, "a number above 0"),
        (kinds.not_negative, {"type": "number", "minimum": 0}, "0 or a number above it"),
        (kinds.nonzero, {"type": "number", "not": {"const": 0}}, "a number other than 0"),
        (kinds.count, {"type": "integer", "minimum": 1}, "a whole number, 1 or above"),
        (kinds.boolean, {"type": "boolean"}, "true or false (without quotes)"),
        (kinds.text, {"type": "string", "pattern": r"\S"}, "text in quotes"),
        (kinds.choice("a", "b"), {"enum": ["a", "b"]}, 'one of "a", "b"'),
        (kinds.within(Bounds(0, 1)), {"type": "number", "minimum": 0, "maximum": 1}, "a number from 0 to 1"),
        (
            kinds.within(POSITIVE),
            {"type": "number", "minimum": POSITIVE.low, "maximum": POSITIVE.high},
            "a number above 0",
        ),
        (
            kinds.within(NOT_NEGATIVE),
            {"type": "number", "minimum": 0, "maximum": NOT_NEGATIVE.high},
            "a number, 0 or above",
        ),
        (
            kinds.within(Bounds(2, 9, below=True)),
            {"type": "number", "minimum": 2, "exclusiveMaximum": 9},
            "a number from 2 to below 9",
        ),
    ],
)
def test_a_kind_says_what_it_takes(kind, schema, words):
    assert kind.schema() == schema
    assert kind.words == words


def test_a_key_that_is_named_as_a_quantity_has_its_bounds():
    """Of devices and bases; but for η, whose bound depends on the law of its springs."""
    tables = [(devices.BOUNDS, section) for section in DEVICES.values()] + [(traits.BOUNDS, case_keys.CASE)]
    found = [
        (bounds[name], key.kind)
        for bounds, section in tables
        for name, key in section.items()
        if name in {*bounds} - {"eta"}
    ]
    numbers = [(bounds, kind.bounds) for bounds, kind in found if isinstance(kind, kinds.Number)]
    assert len(numbers) > 10
    assert all(own == bounds for bounds, own in numbers)


NUMBER = r"(-?\d[\d.]*(?:e-?\d+)?)"
STATED = {  # words of bounds, and the bounds
    rf"from {NUMBER} to {NUMBER}": lambda low, high: Bounds(low, high),
    rf"within {NUMBER}\.\.{NUMBER}": lambda low, high: Bounds(low, high),
    rf"of {NUMBER} to {NUMBER} s": lambda low, high: Bounds(low, high),
    rf"above {NUMBER} and at most {NUMBER}": lambda low, high: Bounds(low, high, above=True),
    rf"above {NUMBER} and below {NUMBER}": lambda low, high: Bounds(low, high, above=True, below=True),
    rf"{NUMBER} or above and below {NUMBER}": lambda low, high: Bounds(low, high, below=True),
    rf"{NUMBER} or (?:above|a number above it)": lambda low: Bounds(low, math.inf),
    rf"above {NUMBER}": lambda low: Bounds(low, math.inf, above=True),
    "a number|other than 0": lambda: Bounds(-math.inf, math.inf),
}


def test_the_words_of_a_number_have_the_bounds_within_which_it_is_taken():
    """Of all keys of all files; those of a quantity write their own words, which are above."""
    found = {key.kind for _, section in SECTIONS for key in section.values() if isinstance(key.kind, kinds.Number)}
    plain = {kind for kind in found if kind.bounds is None}
    assert len(plain) > 10
    for kind in plain:
        bounds, stated = next(
            (bounds, match) for words, bounds in STATED.items() if (match := re.search(words, kind.text))
        )
        limits = bounds(*map(float, stated.groups()))
        assert (kind.low, kind.high) == (limits.low, limits.high), kind.text
        for end in {kind.low, kind.high} - {-math.inf, math.inf}:
            assert takes(Key(kind, "", ""), end) == (end in limits), f"{kind.text}: {end:g}"


def test_the_schema_can_be_written(capsys):
    assert main(["study"]) == 0
    assert json.loads(capsys.readouterr().out)["properties"]["pier"]["properties"]["alpha"]
    assert main(["stduy"]) == 2
    assert "study, checks, manifest" in capsys.readouterr().err
