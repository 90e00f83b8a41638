"""Units of acceleration, in the spellings of headers."""

import pytest

from rockbatch.common.units import acceleration_factor


@pytest.mark.parametrize(
    ("spellings", "factor"),
    [
        (("m/s2", "M/S**2", "m/s/s", "m/s^2", "m/s²", "M/SEC**2", "m/(s**2)", "m*s-2", "m*s**-2", "M/S/S"), 1.0),
        (("cm/s**2", "cm/s2", "CM/SEC/SEC", "gal", "Gal", "GAL", "cm/s/s"), 0.01),
        (("mm/s2", "mm/s/s"), 1e-3),
        (("um/s**2", "µm/s²", "μm/s2"), 1e-6),
        (("nm/s**2", "NM/S**2", "nm/s/s", "nm/s^2"), 1e-9),
        (("g", "G"), 9.81),
        (("g/10", "G/10"), 0.981),
    ],
)
def test_every_spelling_of_a_unit_has_its_factor(spellings, factor):
    assert [acceleration_factor(spelling) for spelling in spellings] == pytest.approx(
        [factor] * len(spellings), rel=1e-14
    )


@pytest.mark.parametrize("unit", ["m/s", "cm", "counts", "V", "", "m/s3", "nm/s"])
def test_what_is_no_acceleration_is_refused_with_the_units_to_write(unit):
    with pytest.raises(ValueError, match="write one of g, g/10, m/s2"):
        acceleration_factor(unit)
