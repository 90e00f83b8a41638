"""Every column has the unit that it states: a pier of other lengths and times has the same numbers in its own units.

Lengths are eight times as large and times twice as long, so that powers of two are all that changes in the arithmetic.
"""

import dataclasses

import numpy as np
import pandas as pd
import pytest

import rockbatch as rb
from rockbatch.quantities.catalogue import COLUMNS

LENGTH, TIME = 8.0, 2.0
SPEED, ACCELERATION = LENGTH / TIME, LENGTH / TIME**2
UNITS = {
    "1": 1.0, "rad": 1.0, "standard_gravity": 1.0, "s": TIME, "1/s": 1.0 / TIME, "m": LENGTH, "m/s": SPEED, "m/s^2": ACCELERATION,
    "m^2/s^2": SPEED**2, "J/kg": SPEED**2, "kJ": SPEED**2, "kN": ACCELERATION, "kN*s": SPEED, "kN*m": ACCELERATION * LENGTH,
    "MPa": ACCELERATION / LENGTH**2,
}  # fmt: skip
TIMES = 0.01 * np.arange(500)
HORIZONTAL = 4.0 * np.sin(2.1 * TIMES) + 2.0 * np.sin(9.0 * TIMES)
VERTICAL = 3.0 * np.sin(11.0 * TIMES + 1.0)
DEVICES = (
    rb.Damper("viscous", nu=0.4), rb.Damper("hysteretic", f=0.05, yield_m=0.004), rb.Tendon(psi=0.1, lam=0.3),
    rb.Stop(gap_m=0.15, lam=20.0, at="right"),
)  # fmt: skip
BASES = {
    "rigid": rb.RigidBase(friction=0.3),
    "rigid with devices": rb.RigidBase(restraints=DEVICES),
    "yielding": rb.YieldingBase(30.0, eta=2.2, epsilon=0.1),
    "damped": rb.YieldingBase(30.0, eta=2.2, zeta=0.1, spring="epp"),
    "yielding with devices": rb.YieldingBase(30.0, eta=2.2, epsilon=0.1, restraints=DEVICES[:3]),
    "footing": rb.FootingBase(60.0, 2.5, length_m=5.0),
    "footing, finite, with devices": rb.FootingBase(
        60.0, 2.5, kinematics="finite", length_m=5.0, restraints=DEVICES[:2]
    ),
}
OTHERWISE = {"note", "damper_half_cycles"}
"""Words that name a time, and a count of strokes above a length that the user sets."""


SUFFIXES = {
    "_MN_m": ACCELERATION * LENGTH, "_kN_m": ACCELERATION * LENGTH,
    "_kN": ACCELERATION, "_MPa": ACCELERATION / LENGTH**2, "_m": LENGTH, "_s": TIME, "": 1.0,
}  # fmt: skip


def in_units(base, length, time):
    """Return the pier and a base in units of length and time that are so many times smaller."""

    def with_lengths(device):
        lengths = [field.name for field in dataclasses.fields(device) if field.name.endswith("_m")]
        given = {name: getattr(device, name) for name in lengths}
        return dataclasses.replace(device, **{name: value and value * length for name, value in given.items()})

    g, sizes = 9.81 * length / time**2, ("width_m", "height_m", "top_m", "mass_t")
    pier = rb.Pier.rectangle(4.0 * length, 18.0 * length, g, mass_t=500.0, top_m=20.0 * length, confirm=sizes)
    areas = {"area_m2": 2.0 * length**2} if isinstance(base, rb.ElasticBase | rb.YieldingBase) else {}
    return pier, dataclasses.replace(with_lengths(base), restraints=tuple(map(with_lengths, base.restraints)), **areas)


def row(base, length, time):
    """Return the row of a run."""
    g = length / time**2
    motion = rb.Motion("shaken", 0.01 * time, HORIZONTAL * g, VERTICAL * g)
    return rb.simulate(
        *in_units(base, length, time), motion, substeps=4, quiet_s=time, forces=True, ledger=True, devices_work=True
    ).row


def marked(name):
    """Return a base as a parameter: footings compile long, with devices a kernel that no other test needs."""
    mark = pytest.mark.thorough if "devices" in name else pytest.mark.slow
    return pytest.param(name, marks=mark) if "footing" in name else name


@pytest.mark.parametrize("name", [marked(name) for name in BASES])
def test_numbers_of_every_column_are_in_its_unit(name):
    here, there = row(BASES[name], 1.0, 1.0), row(BASES[name], LENGTH, TIME)
    assert len(here) > 60
    assert list(here.index) == list(there.index)
    for column in set(here.index) - OTHERWISE:
        value = here[column]
        if not isinstance(value, str):
            value = pytest.approx(value * UNITS[COLUMNS[column].unit], rel=1e-9, abs=1e-15)
        assert pd.isna(there[column]) if pd.isna(here[column]) else there[column] == value, column


@pytest.mark.sweep(fast=2)
@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.slow) if "footing" in n else n for n in BASES])
def test_facts_of_the_statics_and_their_tables_are_in_the_units_that_end_their_names(name):
    """Tables have nine decimals."""
    here, there = (rb.statics(*in_units(BASES[name], *units)) for units in ((1.0, 1.0), (LENGTH, TIME)))
    for table in ("row", "curve", "swings"):
        mine, other = getattr(here, table), getattr(there, table)
        assert list(mine) == list(other)
        for column in mine:
            unit = next(factor for suffix, factor in SUFFIXES.items() if column.endswith(suffix))
            values = (np.array(numbers[column], dtype=np.float64) for numbers in (other, mine))
            np.testing.assert_allclose(next(values), next(values) * unit, rtol=1e-6, atol=1e-8, err_msg=column)
