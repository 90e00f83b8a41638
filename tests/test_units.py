"""Units of acceleration in the spellings of headers, and bounds."""

import pytest

from rockbatch.common.units import Bounds, acceleration_factor, length_factor


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


@pytest.mark.parametrize(
    ("unit", "factor"), [("mm", 1e-3), ("CM", 1e-2), (" cm/sec", 1e-2), ("m", 1.0), ("inch", None)]
)
def test_lengths_and_velocities_have_the_factor_of_their_length(unit, factor):
    assert length_factor(unit) == factor
