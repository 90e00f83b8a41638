"""Numbers in messages, read back in their order and held to what each of them names."""

import math
import re
from collections.abc import Callable

import numpy as np
import pytest
from messages import assert_states, said_by

import rockbatch as rb
from rockbatch.checks.rules import Rule
from rockbatch.common.errors import InputError
from rockbatch.common.units import rounded_up
from rockbatch.pier import Base, problems
from rockbatch.pier.sections import section_heights
from rockbatch.pier.statics import in_words
from rockbatch.quantities.statistics import _asce7_16_remark, _between_ranks, _p84_95_remark

G = 9.81
PIER = rb.Pier.from_size(0.2, 15.0, 3.0, G)  # I0/M = R0²/3
B, H = 15.0 * math.sin(0.2), 15.0 * math.cos(0.2)
P = math.sqrt(0.75 * G / 15.0)
TENDON = G * 15.0 / B**2
"""Stiffness of a device of λ = 1 per unit mass of the pier [1/s²]."""
A = np.sin(0.1 * np.arange(400))


def least_beta(pier):
    """Return the least β that keeps the pier upright: (β p)² b² = g h of two springs, with 1/p² = 4 R0/3g."""
    return math.sqrt(G * pier.height / pier.half_width**2) / pier.p


def on(base, pier=PIER):
    """Return a function that asks for the statics of a pier on a base."""
    return lambda: rb.statics(pier, base)


def tied(*devices):
    return on(rb.RigidBase(restraints=devices))


SOFT = rb.ElasticBase(2.0)
BED = rb.FootingBase(2.0, 3.0)


def with_capacity(*points):
    """Return a function that makes a check with this capacity of moments over axial forces."""
    return lambda: Rule("shaft", "section_moment_over_capacity", 1.0, at_m=3.0, capacity=points)


def released(times, amplitudes):
    """Return a function that reads a study of a release from 0.12 rad with these impacts."""
    measured = {"impact_s": times, "amplitude_rad": amplitudes}
    measured = {key: value for key, value in measured.items() if value}
    pier = {"alpha": 0.2, "p": 1.0, "initial_rotation_rad": 0.12}
    tables = {
        "pier": pier,
        "motions": {"still_s": 5.0},
        "case": [{"name": "rigid", "base": "rigid"}],
        "release": measured,
    }
    return lambda: rb.release(rb.Study.from_dict(tables))


def designed(width, between, points=10):
    """Return a function that reads a study of a damper's strength in this range."""
    case = {"name": "tied", "base": "rigid", "damper": [{"kind": "friction", "f": 0.1}]}
    design = {"vary": "case.damper.f", "between": between, "find": "least", "width": width, "points": points}
    check = {"name": "peak", "demand": "theta_max_over_alpha", "at_most": 0.3, "reason": "made up"}
    tables = {"pier": {"alpha": 0.2, "p": 1.0}, "case": [case], "design": design, "check": [check]}
    return lambda: rb.design(rb.Study.from_dict(tables, motions=SHAKEN))


SHAKEN = rb.Motion("shaken", 0.01, A)
HEAVY = rb.Pier.from_size(0.2, 15.0, 3.0, G, mass_t=1850.0)
SLENDER = rb.Pier(0.2, P, 3.0, G, flexural_period_s=1.2)


def line_of_sheet(name, base, pier=HEAVY):
    """Return a function that gives a line of the statics sheet."""
    return lambda: in_words(rb.statics(pier, base))[name]


def on_points(*points):
    return lambda: rb.YieldingBase(500.0, eta=1.5, spring="backbone", backbone=points)


def rocking(share):
    """Return the period of a block that rocks with this share of α on rigid ground [s] (Housner 1963)."""
    return 4.0 / P * math.acosh(1.0 / (1.0 - share))


RANKED = np.arange(1.0, 8.0)
TEXTS: dict[str, tuple[Callable[[], object], list[float | str]]] = {
    "weight and settlement": (
        line_of_sheet("at rest", rb.ElasticBase(50.0)),
        [1850.0 * G, "kN", 1000.0 * G / (50.0 * P) ** 2, "mm"],
    ),
    "the moment": (line_of_sheet("moment", rb.RigidBase()), [B, "weight", B * 1850.0 * G, "kN m"]),
    "the strength": (line_of_sheet("strength", rb.RigidBase()), [math.tan(0.2), "g", 0.0]),
    "the vertical period": (
        lambda: line_of_sheet("periods", rb.ElasticBase(50.0))().partition(",")[0],
        ["vertical", 2.0 * math.pi / (50.0 * P), "s"],
    ),
    "a flexible pier": (
        line_of_sheet("flexure", rb.RigidBase(), SLENDER),
        [1.2 / rocking(0.1), 0.1, "α", 100.0 * (1.2 / rocking(0.1)) ** 2],
    ),
    "a first point at rest": (on_points((0.0, 0.3), (2.0, 1.0)), [0.0, 0.3, 0.0]),
    "points out of order": (on_points((1.0, 1.0), (3.0, 1.5), (2.5, 1.7)), [2.5, 1.7, 3.0, 1.5]),
    "points that fall": (on_points((1.0, 1.0), (3.0, 1.5), (4.0, 1.3)), [4.0, 1.3, 3.0, 1.5, 1.5]),
    "points that steepen": (on_points((1.0, 1.0), (3.0, 1.5), (4.0, 2.1)), [3.0, 1.5, 4.0, 2.1, 0.6, 0.25]),
    "a section above the top": (
        lambda: section_heights(HEAVY, [3.5, 31.5]),
        ["sections_m", 31.5, 0.0, 2.0 * H],
    ),
    "a quantile between ranks": (lambda: _between_ranks(len(RANKED)), [7.0, 24.0, "%"]),
    "a quantile by rank": (lambda: _p84_95_remark(np.arange(25.0)), ["rank", 25.0, 25.0]),
    "unacceptable responses": (lambda: _asce7_16_remark(np.array([1.0, np.inf, np.inf, np.inf])), [3.0, 1.0]),
}


MESSAGES: dict[str, tuple[Callable[[], object], list[float]]] = {
    "a fast viscous damper": (tied(rb.Damper("viscous", nu=400.0)), [400.0, 1000.0 * G / (400.0 * P)]),
    "a weak viscous damper": (tied(rb.Damper("viscous", nu=1e-4)), [1e-4, 1.0, 100.0 * 1e-4 * P / G]),
    "a strong friction damper": (tied(rb.Damper("friction", f=3.5)), [3.5, 3.5]),
    "a weak friction damper": (tied(rb.Damper("friction", f=1e-6)), [1e-6, 1e-4]),
    "a hysteretic damper that yields late": (
        tied(rb.Damper("hysteretic", f=0.1, yield_m=2.0)),
        [2.0, 2000.0, 1.0, 20.0],
    ),
    "a stiff brace": (
        tied(rb.Damper("viscous", nu=0.1, brace=1e5)),
        [1e5, 1000.0 * G / (1e5 * TENDON)],
    ),
    "a soft brace": (tied(rb.Damper("viscous", nu=0.1, brace=1e-7)), [1e-7, 2e-5]),
    "a strong tendon": (tied(rb.Tendon(psi=0.1, lam=0.5, strength=40.0)), [40.0, 40.0]),
    "a tendon that yields by its prestress": (lambda: rb.Tendon(psi=0.3, lam=0.5, strength=0.2), [0.2, 0.3]),
    "a stop far away": (tied(rb.Stop(7.0, 20.0, 0.6)), [7.0, 7.0]),
    "a stop next to the base": (tied(rb.Stop(2e-4, 20.0, 0.6)), [2e-4, 0.2]),
    "a device beside the base": (tied(rb.Damper("friction", f=0.1, at=7.0)), [7.0, 2.0 * B]),
    "a deck spring far below the deck": (
        tied(rb.DeckSpring(lam=0.3, height_m=1.0)),
        [1.0, 1.0 / (2.0 * H), 2.0 * H],
    ),
    "soft springs": (on(SOFT), [2.0, 1.0, least_beta(PIER)]),
    "a soft bed": (
        on(BED),
        [2.0, 3.0, rounded_up(math.sqrt(3.0) * least_beta(PIER)), 3.0 * (least_beta(PIER) / 2.0) ** 2],
    ),
    "springs that cannot carry a tendon": (
        on(rb.YieldingBase(50.0, eta=1.2, restraints=(rb.Tendon(psi=0.4, lam=0.1),))),
        [1.2, 0.4, 1.0, 1.400002],
    ),
    "a bed that cannot carry a tendon": (
        on(rb.FootingBase(50.0, 1.2, restraints=(rb.Tendon(psi=0.4, lam=0.1),))),
        [1.2, 0.4, 1.4],
    ),
    "a release beyond the edge": (lambda: rb.Pier(0.2, 1.0, initial_rotation_rad=0.3), [0.3, 0.2]),
    "a pier wider than high": (
        lambda: rb.Pier.with_deck(width_m=36.0, height_m=30.0, mass_t=2000.0, deck_mass_t=1000.0),
        [36.0, 30.0, 36.0 / 30.0],
    ),
    "a light deck": (
        lambda: rb.Pier.with_deck(width_m=6.0, height_m=30.0, mass_t=2000.0, deck_mass_t=2.0),
        [2.0, 0.001, 2000.0],
    ),
    "a heavy block": (
        lambda: rb.Pier.from_size(0.2, 5.0, 3.0, G, mass_t=1e5),
        [1e5, 2.0 / 3.0 * B, 2.0 / 3.0 * H, 1e5, 27e5 / (8.0 * B**2 * H)],
    ),
    "a motion without a step": (lambda: rb.Motion("m", 0.0, A), ['"m"', "dt", 0.0, 0.0]),
    "a motion with a sample that is no number": (
        lambda: rb.Motion("m", 0.01, np.where(np.arange(400) == 37, np.nan, A)),
        ['"m"', "horizontal sample", 37.0, 0.37],
    ),
    "a motion of two lengths": (
        lambda: rb.Motion("m", 0.01, A, A[:-3]),
        ['"m"', 400.0, "horizontal", 397.0, "vertical"],
    ),
    "a motion in a table": (lambda: rb.Motion("m", 0.01, A.reshape(2, 200)), ['"m"', "horizontal", 2.0, 200.0]),
    "a motion in gal": (
        lambda: rb.simulate(PIER, rb.RigidBase(), rb.Motion("m", 0.01, 300.0 * A)),
        [300.0 / G, 2.0, 4.0, 0.01],
    ),
    "a pier of which the shaft ends too low": (
        lambda: rb.Pier.with_deck(width_m=6.0, height_m=30.0, mass_t=2000.0, deck_mass_t=1000.0, deck_height_m=90.0),
        [90.0, 3.0, 30.0],
    ),
    "a part that reaches below the pivots": (
        lambda: rb.Pier.of_parts(6.0, [rb.Part(100.0, 10.0, 4000.0, length_m=24.0)]),
        [24.0, 10.0, 20.0],
    ),
    "a part with less inertia than a rod": (
        lambda: rb.Pier.of_parts(6.0, [rb.Part(100.0, 10.0, 700.0, length_m=10.0)]),
        [10.0, 12.0, 100.0 * 10.0**2 / 12.0, 700.0],
    ),
    "sections": (lambda: rb.simulate(PIER, rb.RigidBase(), SHAKEN, sections=1), [1.0, 2.0]),
    "a sequence with a factor of 0": (
        lambda: rb.sequence([SHAKEN, SHAKEN], name="twice", factors=[1.0, -2.0]),
        [-2.0, 0.0],
    ),
    "a sequence without a pause": (lambda: rb.sequence([SHAKEN, SHAKEN], name="twice", pause=-3.0), [-3.0, 0.0]),
    "a sequence of unlike steps": (
        lambda: rb.sequence([SHAKEN, rb.Motion("fine", 1e-5, 0.1 * A)], name="twice"),
        [1e-5, 0.01, 20.0],
    ),
    "a capacity with a moment below 0": (with_capacity([-5.0, 1.0], [0.0, 3.0], [9.0, -2.0]), [0.0, 9.0, -2.0, 0.0]),
    "a capacity that goes back": (
        with_capacity([-5.0, 1.0], [7.0, 4.0], [6.0, 3.0]),
        [7.0, 4.0, 6.0, 3.0, 0.0],
    ),
    "a capacity with a hollow": (
        with_capacity([-5.0, 1.0], [1.0, 2.0], [10.0, 31.0]),
        [1.0, 2.0, -5.0, 1.0, 10.0, 31.0, 1.0 + 30.0 * 6.0 / 15.0],
    ),
    "impacts that do not follow each other": (released([0.5, 1.9, 1.2], []), [3.0, 1.2, 2.0, 1.9]),
    "an amplitude above the release": (released([], [0.13, 0.05, 0.04]), [1.0, 0.13, 0.12]),
    "too few impacts": (released([0.5], []), [1.0, 3.0]),
    "a design narrower than a millionth": (designed(1e-9, [0.02, 0.2]), [1e-9, 2e-7]),
    "a design wider than its scan": (designed(0.1, [0.02, 0.2], points=10), [0.1, 0.02, 0.0025]),
    "a pulse with a step above its period": (
        lambda: rb.pulse("sine", name="s", amplitude=3.0, period=0.5, dt=0.7, duration=4.0),
        [0.7, 0.5],
    ),
    "a pulse that is cut": (
        lambda: rb.pulse("sine", name="s", amplitude=3.0, period=2.5, dt=0.01, duration=1.0),
        [1.0, 2.5],
    ),
}


@pytest.mark.parametrize("name", TEXTS)
def test_numbers_of_a_text_are_those_of_what_it_names(name):
    call, expected = TEXTS[name]
    assert_states(said_by(call).replace("R0", ""), *expected)


@pytest.mark.parametrize("name", MESSAGES)
def test_numbers_of_a_message_are_those_of_what_it_names(name):
    call, expected = MESSAGES[name]
    with pytest.raises(InputError) as refused:
        call()
    assert_states(str(refused.value), *expected)


LONG = rb.Pier(0.2, P, 3.0, G, flexural_period_s=1.5)
PULLED = (rb.Tendon(psi=0.4123456789, lam=0.1),)
BOUNDS: dict[str, tuple[rb.Pier, Callable[[float], Base], float]] = {
    "β of springs": (PIER, rb.ElasticBase, 2.0),
    "β of yielding springs": (PIER, lambda beta: rb.YieldingBase(beta, eta=1.05, spring="epp"), 2.0),
    "β of springs that give way": (PIER, lambda beta: rb.YieldingBase(beta, eta=1.02), 1.02 * least_beta(PIER)),
    "β of springs under a shaft": (
        LONG,
        lambda beta: rb.ElasticBase(beta, zeta=0.1, shaft="elastic", kinematics="finite"),
        1.0001 * least_beta(PIER),
    ),
    "β of a bed": (PIER, lambda beta: rb.FootingBase(beta, 3.0), 2.0),
    "η of springs with a tendon": (PIER, lambda eta: rb.YieldingBase(5000.0, eta=eta, restraints=PULLED), 1.2),
    "η of springs with another tendon": (
        PIER,
        lambda eta: rb.YieldingBase(5000.0, eta=eta, restraints=(rb.Tendon(psi=0.6897594, lam=0.1),)),
        1.2,
    ),
    "η of a backbone": (
        PIER,
        lambda eta: rb.YieldingBase(500.0, eta=eta, spring="backbone", backbone=((1.0, 1.0), (3.0, 1.7), (4.0, 1.7))),
        0.3,
    ),
    "safety of a bed with a tendon": (PIER, lambda factor: rb.FootingBase(50.0, factor, restraints=PULLED), 1.2),
}
"""A pier, a base with a value that has to be above a bound, and such a value below it."""


@pytest.mark.parametrize("name", BOUNDS)
def test_a_value_above_the_bound_of_a_message_is_accepted_and_a_lesser_one_is_not(name):
    pier, on_base, below = BOUNDS[name]
    (refused,) = problems(pier, on_base(below))
    bound = float(re.findall(r"above (?:1 \+ psi, |sqrt.* = )?([\d.]*\d)", refused.text)[-1])
    assert not problems(pier, on_base(bound * (1.0 + 1e-7)))
    assert problems(pier, on_base(bound * (1.0 - 1.1e-3)))


def test_a_bed_that_hardly_carries_the_weight_has_no_period_in_full_contact():
    """It gives way to the least tilt."""
    assert rb.statics(PIER, rb.FootingBase(50.0, 1.0005)).full_contact_period_s is None


@pytest.mark.parametrize("digits", [2, 4])
def test_a_value_is_rounded_up_to_the_next_one_of_so_many_digits(digits):
    """4.001 and 4001 steps of 0.001 are not the same number to a computer."""
    last = 10 ** (digits - 1)
    for steps in range(last, 10 * last):
        value = float(f"{steps}e-3")
        assert rounded_up(value, digits) == value
        assert rounded_up(value * (1.0 - 1e-9), digits) == value
        assert rounded_up(value * (1.0 + 1e-9), digits) == float(f"{steps + 1}e-3")
    assert rounded_up(math.inf, digits) == math.inf
