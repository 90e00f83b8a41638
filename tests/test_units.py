"""Units of acceleration in the spellings of headers; bounds, and what messages say of them and of keys."""

import ast
import importlib
import math
import pkgutil
import re
from itertools import chain, product
from pathlib import Path

import pint
import pytest

import rockbatch
from rockbatch.common.units import (
    _SIZES,
    LEAST,
    Bounds,
    Usual,
    acceleration_factor,
    factor_between,
    length_factor,
    number_in_unit_of,
    unit_in_words,
    unit_of,
)
from rockbatch.quantities.catalogue import COLUMNS, DEMANDS
from rockbatch.study.schema import STUDY


@pytest.mark.parametrize(
    ("spellings", "factor"),
    [
        (("m/s2", "M/S**2", "m/s/s", "m/s^2", "m/s²", "M/SEC**2", "m/(s**2)", "m*s-2", "m*s**-2", "M/S/S"), 1.0),
        (("m·s⁻²", "m·s^-2", "m s⁻²", "m.s-2", "m⋅s−2", "M/SEG2", "m/sn²", "m/sek^2"), 1.0),
        (("g's", "gs", "G’s"), 9.81), (("µg", "μg", "ug", "micro g"), 9.81e-6), (("mg", "milli-g"), 9.81e-3),
        (("cm/s**2", "cm/s2", "CM/SEC/SEC", "gal", "Gal", "GAL", "cm/s/s"), 0.01), (("mm/s2", "mm/s/s"), 1e-3),
        (("um/s**2", "µm/s²", "μm/s2"), 1e-6), (("nm/s**2", "NM/S**2", "nm/s/s", "nm/s^2"), 1e-9), (("g", "G"), 9.81),
        (("g/10", "G/10"), 0.981),
    ],
)  # fmt: skip
def test_every_spelling_of_a_unit_has_its_factor(spellings, factor):
    assert [acceleration_factor(spelling) for spelling in spellings] == pytest.approx(
        [factor] * len(spellings), rel=1e-14
    )


@pytest.mark.parametrize(
    ("unit", "own", "factor"),
    [
        ("mm", "m", 1e-3), ("m", "mm", 1e3), ("MN_m", "kN_m", 1e3), ("kN_mm", "kN_m", 1e3), ("kN_cm2", "kN_m2", 1e4),
        ("N_s_mm", "kN_s_m", 1.0), ("kg_m2", "t_m2", 1e-3), ("t_cm2", "t_m2", 1e-4), ("deg", "rad", math.radians(1)),
        ("m_s2", "g", 1 / 9.81), ("cm_s2", "g", 0.01 / 9.81), ("gal", "g", 0.01 / 9.81), ("percent", "g", 0.01),
        ("kN", "t", 1 / 9.81), ("kg", "kN", 9.81e-3), ("t", "kN", 9.81), ("cm_s", "m_s", 0.01), ("GPa", "MPa", 1e3),
        ("percent", "", 0.01), ("percent", "m", None), ("m", "s", None), ("kN_m", "kN", None), ("deg", "", None),
        ("furlong", "m", None), ("lb", "kN", 4.4482216152605e-3),
        ("kip_in", "kN_m", 4.4482216152605 / 0.0254), ("kg_m2", "kN_m2", None),
    ],
)  # fmt: skip
def test_a_number_in_another_unit_of_the_same_measure_has_its_factor(unit, own, factor):
    assert factor_between(unit, own) == (None if factor is None else pytest.approx(factor, rel=1e-12))


OF_PINT = {
    "tf": "force_metric_ton", "t": "metric_ton", "deg": "degree", "g": "gravity", "gal": "cm / s ** 2", "percent": "0.01",
    "pct": "0.01", "lb": "lbf", "in": "inch", "kips": "kip", "ksf": "kip / foot ** 2",
}  # fmt: skip
"""Units by pint's names, where they differ."""


def test_units_of_one_measure_have_the_sizes_of_another_library():
    known = pint.UnitRegistry()
    known.define("gravity = 9.81 m / s ** 2")
    sizes = {unit: 1.0 * known(OF_PINT.get(unit, unit)) for unit in _SIZES}
    related = 0
    for unit, own in product(sizes, sizes):
        if sizes[unit].check(sizes[own].dimensionality) and is_angle(unit) == is_angle(own):
            assert factor_between(unit, own) == pytest.approx((sizes[unit] / sizes[own]).to("").magnitude, rel=1e-12)
            related += 1
    assert related == sum(n * n for n in (6, 9, 2, 2, 3, 7, 2, 2))


def is_angle(unit):
    """Return whether a unit is one of angles, which pint does not tell from shares."""
    return unit in ("rad", "mrad", "deg")


@pytest.mark.parametrize(
    ("key", "text", "number"),
    [
        ("width_m", "4.0 m", "4.0"), ("width_m", "400 [cm]", "4"), ("width_m", "4.0 kN", ""), ("width_m", "4.0", ""),
        ("stiffness_kN_m", "1.5 MN/m", "1500"), ("deck_inertia_t_m2", "3 t m²", "3"), ("zeta", "7%", "0.07"),
        ("dt", "5 ms", "0.005"), ("alpha", "7.5°", "0.1308996939"), ("ag_g", "2.4525 m/s^2", "0.25"), ("mass_t", "1,800 t", ""),
        ("mass_t", "1 800 kg", ""),
    ],
)  # fmt: skip
def test_a_number_with_its_unit_is_read_in_the_unit_of_its_key(key, text, number):
    assert number_in_unit_of(key, text) == number


def test_every_key_of_a_study_that_ends_in_a_unit_has_it_known_and_readable():
    keys = {key for section in STUDY for key in section}
    units = {unit_of(key) for key in keys} - {""}
    assert {"m", "mm", "t", "kN", "kN_m", "kN_s_m", "s", "g", "deg", "rad", "m_s", "t_m2"} <= units
    assert all(factor_between(unit, unit) == 1.0 for unit in units)
    read = {"kN_s_m": "kN s/m", "m_s2": "m/s²", "MN_m3": "MN/m³", "m_s": "m/s", "t_m3": "t/m³", "t_m2": "t m²"}
    assert {unit: unit_in_words(unit) for unit in read} == read


@pytest.mark.parametrize("unit", ["m/s", "cm", "counts", "V", "", "m/s3", "nm/s"])
def test_what_is_no_acceleration_is_refused_with_the_units_to_write(unit):
    with pytest.raises(ValueError, match="write one of g, g/10, mg, m/s2"):
        acceleration_factor(unit)


@pytest.mark.parametrize(
    ("bounds", "value", "words"),
    [
        (Bounds(0.0, 1.0), -1.0, "must be within 0 and 1"), (Bounds(0.0, 1.0, above=True), 0.0, "must be a number above 0"),
        (Bounds(0.5, 1.0), 0.0, "must be a number above 0"), (Bounds(-1.0, 1.0), -2.0, "must be within -1 and 1"),
        (Bounds(0.5, 1.0), 2.0, "must be within 0.5 and 1"),
    ],
)  # fmt: skip
def test_what_must_be_above_0_says_so_of_others_their_bounds_are_said(bounds, value, words):
    assert bounds.message(value) == words


# What messages say of bounds and keys

TOP = Path(rockbatch.__file__).parent


def tabled(kind):
    """Return everything of a kind that a module has by name, or in a table, by what it is called there."""
    names = [module.name for module in pkgutil.walk_packages([str(TOP)], "rockbatch.")]
    modules = map(importlib.import_module, (name for name in names if not name.startswith("rockbatch.core")))
    found = chain.from_iterable(
        (value if isinstance(value, dict) else {name: value}).items()
        for module in modules
        for name, value in vars(module).items()
    )
    return {id(one): (name, one) for name, one in found if isinstance(one, kind)}.values()


def numbers_in(text):
    """Return the numbers of a text; π is one."""
    found = re.findall(r"[-−]?(?:π/2|\d+(?:[ ,]\d{3})*(?:\.\d+)?(?:e[+-]?\d+)?)", text)
    return [float(re.sub(r"[ ,]", "", each.replace("−", "-").replace("π/2", str(math.pi / 2)))) for each in found]


@pytest.mark.parametrize(("name", "bounds"), tabled(Bounds))
def test_a_message_names_the_bound_that_a_value_is_beyond(name, bounds):
    for bound, beyond in ((bounds.high, 2.0 * bounds.high), (bounds.low, bounds.low - 0.1 * abs(bounds.low) - 1e-20)):
        said = bounds.message(beyond)
        least_above_0 = bound <= LEAST and re.search("above 0|0 or above|more than 0", said)
        assert least_above_0 or any(number == pytest.approx(bound, rel=1e-4) for number in numbers_in(said)), said


@pytest.mark.parametrize(("name", "usual"), tabled(Usual))
def test_what_is_said_to_be_usual_needs_no_confirmation(name, usual):
    words = usual.words.replace("within", "")
    assert all(usual.holds(number) for number in numbers_in(words.partition(", which")[0])), words
    for bound, beyond in ((usual.most, 2.0 * usual.most), (usual.least, 0.5 * usual.least)):
        if bound:
            (problem,) = usual.doubts(name, beyond)
            assert numbers_in(problem.text)[0] == pytest.approx(bound)
            assert usual.holds(bound)


NUMBERED = re.compile(r"(damper|tendon|stop|deck_spring|part)_[\dn](_|$)")
"""The prefix of a key of one of several devices or parts."""
SYMBOLS = {"a_p", "k_t", "omega_g", "sa_0"}
"""Words of formulas."""


def texts():
    """Yield the texts of the package that are no docstrings, each with its place."""
    for path in sorted(TOP.rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        alone = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in alone:
                yield f"{path.name}:{node.lineno}", node.value


def known_names():
    """Return the names of keys, columns and demands, of files, and of what the package has and takes."""
    found = {name for section in STUDY for name in (*section, section.header.strip("[]").rpartition(".")[2])}
    for _, text in texts():
        found |= set() if " " in text else {text, *text.split(","), Path(text).stem}
    for path in TOP.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            found |= {getattr(node, field, None) for field in ("id", "attr", "arg", "name")}
    return found | {*COLUMNS, *DEMANDS, *SYMBOLS}


def test_every_key_that_a_text_names_is_one():
    known = known_names()
    for place, text in texts():
        for name in re.findall(r"(?<![\w/.$-])[a-z]+(?:_[A-Za-z0-9]+)+(?![\w/(-])", text if " " in text else ""):
            assert NUMBERED.sub("", name) in {"", *known}, f"{place}: {name}"


@pytest.mark.parametrize(
    ("unit", "factor"), [("mm", 1e-3), ("CM", 1e-2), (" cm/sec", 1e-2), ("m", 1.0), ("inch", None)]
)
def test_lengths_and_velocities_have_the_factor_of_their_length(unit, factor):
    assert length_factor(unit) == factor


@pytest.mark.parametrize(
    ("name", "text", "number"),
    [
        ("area_m2", "5 m2", "5"),
        ("area_m2", "5 m²", "5"),
        ("area_m2", "5 m", ""),
        ("length_m", "5 m2", ""),
        ("length_m", "5 m", "5"),
    ],
)
def test_a_number_in_a_power_of_a_unit_is_no_number_in_the_unit(name, text, number):
    assert number_in_unit_of(name, text) == number
