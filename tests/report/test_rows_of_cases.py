"""Rows of "What was studied": cases that differ in a key differ in their row, besides their name."""

from dataclasses import fields, replace
from types import SimpleNamespace

import numpy as np
import pytest
from check_samples import PIER as RIGID_PIER
from report_page import Page

from rockbatch.pier import Damper, DeckSpring, ElasticBase, RigidBase, Stop, Tendon, YieldingBase
from rockbatch.pier.bases import FootingBase
from rockbatch.reporting.sections.studied import _foundations
from rockbatch.results.run_json import describe_case
from rockbatch.study import Case

PIER = replace(RIGID_PIER, flexural_period_s=0.9)
FOOT = FootingBase(beta=80.0, safety_factor=4.0, length_m=6.0, friction=0.6)
BENT_FOOT = replace(FOOT, kinematics="finite", shaft="elastic", flexural_modes=3)
ON_POINTS = YieldingBase(
    beta=50.0, eta=2.5, spring="backbone", backbone=((1.0, 1.0), (3.0, 2.0), (5.0, 2.5)), epsilon=0.1
)
BASES = [
    RigidBase(
        shaft="elastic", flexural_modes=3, restitution=0.9, friction=0.6, area_m2=4.0, contact_stiffness_kN_m=1e6
    ),
    ElasticBase(beta=50.0, shaft="elastic", flexural_modes=3, epsilon=0.1, friction=0.6, area_m2=4.0),
    YieldingBase(beta=50.0, shaft="elastic", flexural_modes=3, eta=2.5, zeta=0.05, friction=0.6, area_m2=4.0),
    ON_POINTS,
    FOOT,
    BENT_FOOT,
]
DEVICES = [
    Damper(kind="friction", f=0.05, at=0.4), Damper(kind="viscous", nu=0.03, exponent=0.3, brace=2.0),
    Damper(kind="hysteretic", f=0.05, yield_m=0.01, at=0.4), Tendon(psi=0.2, lam=0.5, strength=0.6, at=0.3),
    Stop(gap_m=0.02, lam=5.0, restitution=0.7, at=0.5), DeckSpring(lam=0.5, gap_m=0.01, restitution=0.8, height_m=9.0),
]  # fmt: skip
OTHER = {
    "shaft": "rigid", "flexural_damping_kind": "stiffness", "kinematics": "finite", "flight": "stop", "spring": "epp",
    "impact": "housner", "side": "left", "kind": "hysteretic",
}  # fmt: skip


def rows(*bases, pier=PIER):
    """Return the cells of cases in the table of foundations, without their names."""
    cases = [describe_case(Case(f"case {i}", pier, base, {})) for i, base in enumerate(bases)]
    page = Page(_foundations(SimpleNamespace(info={"cases": cases, "varied": []})))
    return [cells[1:] for cells in page.tables[""][-len(bases) :]]


def changed(thing, name, rng):
    """Return ``thing`` with another value of a field: another word or count, or a number larger by some hundred-thousandths."""
    value = getattr(thing, name)
    if isinstance(value, str):
        other = OTHER[name]
    elif isinstance(value, int):
        other = value + (-1 if name == "flexural_modes" else 2)
    elif name == "backbone":
        other = *value[:-1], (value[-1][0], value[-1][1] * (1 - 1e-5 * rng.uniform(1, 9)))
    else:
        other = value * (1 + 1e-5 * rng.uniform(1, 9))
    return replace(thing, **{name: other})


def keys_of(thing):
    """Return the fields that can be changed: those with a value of which there are others, but devices."""
    return [
        field.name
        for field in fields(thing)
        if field.name not in ("restraints", "confirm")
        and getattr(thing, field.name) not in (None, ())
        and not (isinstance(getattr(thing, field.name), float) and np.isinf(getattr(thing, field.name)))
    ]


@pytest.mark.parametrize("base", BASES, ids=lambda base: f"{base.name}, {base.shaft}")
def test_cases_that_differ_in_one_key_of_their_base_have_rows_that_differ(base):
    rng = np.random.default_rng(4)
    for name in keys_of(base):
        if name == "impact" or (name == "epsilon" and base.zeta is not None):  # excluded by epsilon and by zeta
            continue
        if base.shaft == "rigid" and (name == "shaft" or name.startswith("flexural")):
            continue
        if (base is BENT_FOOT and name == "kinematics") or (base is ON_POINTS and name in ("spring", "n")):
            continue
        first, second = rows(base, changed(base, name, rng))
        assert first != second, name


@pytest.mark.parametrize("mass", [True, False])
@pytest.mark.parametrize("device", DEVICES, ids=lambda device: getattr(device, "kind", device.what))
def test_cases_that_differ_in_one_key_of_a_device_have_rows_that_differ(device, mass):
    rng = np.random.default_rng(5)
    pier = PIER if mass else replace(PIER, mass_t=None)
    for name in keys_of(device):
        weighed = name == "strength" and not mass  # a study gives it in kN alone
        if name == "kind" or weighed or name in _UNUSED.get(getattr(device, "kind", ""), ()):
            continue
        pair = [replace(RigidBase(), restraints=(one,)) for one in (device, changed(device, name, rng))]
        first, second = rows(*pair, pier=pier)
        assert first != second, name


_UNUSED = {"friction": ("nu", "yield_m", "exponent"), "viscous": ("f", "yield_m"), "hysteretic": ("nu", "exponent")}


def test_a_case_under_a_bound_has_the_name_that_it_has_on_the_scorecard():
    cases = [describe_case(Case("pads", PIER, BASES[0], {"bound": bound})) for bound in ("", "stiff")]
    page = Page(_foundations(SimpleNamespace(info={"cases": cases, "varied": ["bound"]})))
    assert [row[0] for row in page.tables[""][-2:]] == ["pads", "pads: stiff"]


def test_numbers_without_a_format_of_their_own_have_six_digits():
    bases = [replace(FOOT, safety_factor=factor) for factor in (4.123456789, 5.0)]
    assert "4.12346" in rows(*bases)[0]
