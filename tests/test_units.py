"""Units of acceleration, in the spellings of headers, and of the names of keys."""

import re

import pint
import pytest

from rockbatch.common.units import Bounds, acceleration_factor, length_factor
from rockbatch.toml.meant import in_another_unit, quantity_of


@pytest.mark.parametrize(
    ("spellings", "factor"),
    [
        (("m/s2", "M/S**2", "m/s/s", "m/s^2", "m/s²", "M/SEC**2", "m/(s**2)", "m*s-2", "m*s**-2", "M/S/S"), 1.0),
        (("cm/s**2", "cm/s2", "CM/SEC/SEC", "gal", "Gal", "GAL", "cm/s/s"), 0.01), (("mm/s2", "mm/s/s"), 1e-3),
        (("um/s**2", "µm/s²", "μm/s2"), 1e-6), (("nm/s**2", "NM/S**2", "nm/s/s", "nm/s^2"), 1e-9), (("g", "G"), 9.81),
        (("g/10", "G/10"), 0.981),
    ],
)  # fmt: skip
def test_every_spelling_of_a_unit_has_its_factor(spellings, factor):
    assert [acceleration_factor(spelling) for spelling in spellings] == pytest.approx(
        [factor] * len(spellings), rel=1e-14
    )


@pytest.mark.parametrize("unit", ["m/s", "cm", "counts", "V", "", "m/s3", "nm/s"])
def test_what_is_no_acceleration_is_refused_with_the_units_to_write(unit):
    with pytest.raises(ValueError, match="write one of g, g/10, mg, m/s2"):
        acceleration_factor(unit)


U = pint.get_application_registry()  # which two test files share, since it takes a second to make
OF_NAMES = {
    "m": "m mm cm km ft in", "s": "s sec ms", "rad": "rad mrad deg degrees", "rad/s": "rad_s", "metric_ton": "t kg mg tonnes",
    "kN": "kn n mn tf kip kips lbf", "kN/m": "kn_m n_m mn_m n_mm kn_mm kip_in kip_ft tf_m",
    "kN s/m": "kn_s_m kns_m n_s_m ns_m mn_s_m mns_m", "m/s": "m_s cm_s mm_s", "standard_gravity": "g m_s2 cm_s2 gal",
    "metric_ton m^2": "t_m2", "m^2": "m2 mm2 cm2", "": "percent pct", "MPa": "mpa kpa gpa", "Hz": "hz", "kN m": "knm", "kJ": "kj",
}  # fmt: skip
"""Ends of names of keys, by the unit in which they are counted."""
SPELT = {
    "mg": "Mg", "tonnes": "metric_ton", "t": "metric_ton", "kn": "kN", "n": "N", "mn": "MN",
    "tf": "metric_ton * standard_gravity", "kip": "kip", "kips": "kip", "kn_m": "kN/m", "n_m": "N/m", "mn_m": "MN/m",
    "n_mm": "N/mm", "kn_mm": "kN/mm", "kip_in": "kip/inch", "kip_ft": "kip/ft", "tf_m": "metric_ton * standard_gravity/m",
    "kn_s_m": "kN s/m", "kns_m": "kN s/m", "n_s_m": "N s/m", "ns_m": "N s/m", "mn_s_m": "MN s/m", "mns_m": "MN s/m",
    "m_s": "m/s", "cm_s": "cm/s", "mm_s": "mm/s", "rad_s": "rad/s", "g": "standard_gravity", "m_s2": "m/s^2",
    "cm_s2": "cm/s^2", "gal": "cm/s^2", "t_m2": "metric_ton m^2", "m2": "m^2", "mm2": "mm^2", "cm2": "cm^2",
    "percent": "0.01", "pct": "0.01", "mpa": "MPa", "kpa": "kPa", "gpa": "GPa", "hz": "Hz", "knm": "kN m", "kj": "kJ",
    "lbf": "lbf", "in": "inch", "sec": "s", "degrees": "deg",
}  # fmt: skip


@pytest.mark.parametrize(("unit", "end"), [(unit, end) for unit, ends in OF_NAMES.items() for end in ends.split()])
def test_a_unit_at_the_end_of_a_name_has_the_size_that_pint_knows(unit, end):
    """To 5e-4: g is 9.81 m/s² here, and 9.80665 there."""
    name, quantity, size = quantity_of(f"width_{end}")
    assert (name, quantity) == ("width", quantity_of(f"height_{OF_NAMES[unit].split()[0]}")[1])
    assert size == pytest.approx(U(SPELT.get(end, end)).to(unit).magnitude, rel=5e-4)


@pytest.mark.parametrize(
    ("key", "own", "others"),
    [
        ("width_m", "m", "mm cm km"), ("yield_mm", "mm", "m cm km"), ("dt_s", "s", "ms"), ("mass_t", "metric_ton", "kg kt"),
        ("force_kN", "kN", "MN N"), ("stiffness_kN_m", "kN/m", "MN/m N/m"), ("pgv_m_s", "m/s", "cm/s mm/s"),
        ("area_m2", "m^2", "mm² cm²"), ("own_inertia_t_m2", "metric_ton m^2", "kg·m² kt·m²"),
        ("c_kN_s_m", "kN s/m", "MN·s/m N·s/m"), ("pga_g", "standard_gravity", "m/s² cm/s²"),
    ],
)  # fmt: skip
def test_a_value_in_another_unit_is_told_with_what_to_write(key, own, others):
    for other in others.replace("·", "\u00a0").split(" "):
        other = other.replace("\u00a0", " ")
        meant = U(other.replace("²", "^2").replace("kt", "kilometric_ton")).to(own).magnitude
        said = in_another_unit(key, 1.0, lambda value, meant=meant: value == pytest.approx(meant, rel=5e-4))
        found = re.fullmatch(rf"; 1 {re.escape(other)} are {key} = (.*)", said)
        assert found
        assert float(found[1]) == pytest.approx(meant, rel=5e-4)
    assert in_another_unit(key, 1.0, lambda value: False) == ""


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


@pytest.mark.parametrize(
    ("unit", "factor"), [("mm", 1e-3), ("CM", 1e-2), (" cm/sec", 1e-2), ("m", 1.0), ("inch", None)]
)
def test_lengths_and_velocities_have_the_factor_of_their_length(unit, factor):
    assert length_factor(unit) == factor
