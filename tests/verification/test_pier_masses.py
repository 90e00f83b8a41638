"""Piers with a deck, of parts, and rocking frames: published numbers, and mechanics done again with point masses."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.pier import Part, Pier, described, in_kilonewtons
from rockbatch.pier.figures import sketches
from rockbatch.pier.sections import section_heights
from rockbatch.simulation import run_fixed

G = 9.81


def shaft_points(width, height, mass, n):
    """A uniform rectangle as n × n point masses: positions from its lower left corner, shape (n², 2), and masses."""
    x, y = np.meshgrid((np.arange(n) + 0.5) * width / n, (np.arange(n) + 0.5) * height / n)
    return np.column_stack([x.ravel(), y.ravel()]), np.full(n * n, mass / n**2)


@pytest.mark.parametrize(
    ("ratio", "told"),
    [
        (
            0.5,
            {"height": "20", "alpha": "0.09966865249", "mu": "4.004405286", "p": "0.6249308126", "e": "0.9841549296"},
        ),
        (
            1.0,
            {"height": "22.5", "alpha": "0.08865588187", "mu": "5.404236540", "p": "0.6053718790", "e": "0.9867695700"},
        ),
    ],
)
def test_a_shaft_of_4_m_by_30_m_with_a_deck_at_its_top(ratio, told):
    """The values of a hand calculation, to their last digit."""
    pier = Pier.with_deck(4.0, 30.0, 2000.0, 2000.0 * ratio)
    found = {"height": pier.height, "alpha": pier.alpha, "mu": pier.mu, "p": pier.p, "e": pier.restitution}
    for name, digits in told.items():
        decimals = len(digits.partition(".")[2])
        assert f"{found[name]:.{decimals}f}" == digits, name
    assert (pier.mass_t, pier.top, 2 * pier.half_width) == (2000.0 * (1 + ratio), 30.0, pytest.approx(4.0, rel=1e-14))


def test_a_pier_turns_about_its_pivot_as_its_point_masses_do():
    """p² = M g R0/I_O with I_O = Σ m r² about the pivot; n² points miss 1/n² of a shaft's own inertia."""
    points, masses = shaft_points(8.0, 30.0, 2000.0, 400)
    deck = np.array([[4.0 + s, 33.0] for s in (-5.0, 5.0)])  # turns with the pier: 1000 t × 5² of its own
    points, masses = np.vstack([points, deck]), np.r_[masses, 500.0, 500.0]
    centre = masses @ points / masses.sum()
    about_pivot = masses @ (points**2).sum(axis=1)
    pier = Pier.with_deck(8.0, 30.0, 2000.0, 1000.0, deck_height_m=33.0, deck_inertia_t_m2=25_000.0)
    assert pier.height == pytest.approx(centre[1], rel=1e-12)
    assert math.tan(pier.alpha) == pytest.approx(centre[0] / centre[1], rel=1e-12)
    assert pier.p**2 == pytest.approx(masses.sum() * G * np.hypot(*centre) / about_pivot, rel=1e-5)
    assert pier.inertia_about_pivot == pytest.approx(about_pivot / masses.sum(), rel=1e-5)
    assert pier.top == 33.0


def test_a_shaft_cut_into_pieces_is_the_same_pier():
    """Each slice of a rectangle is one; the parallel axes put them together again. Rounding only."""
    cuts = [0.0, 3.0, 11.5, 12.0, 40.0]
    slices = [
        Part(50.0 * (up - low), 0.5 * (low + up), 50.0 * (up - low) * (7.0**2 + (up - low) ** 2) / 12)
        for low, up in pairwise(cuts)
    ]
    whole, cut = Pier.rectangle(7.0, 40.0, mass_t=2000.0), Pier.of_parts(7.0, slices, top_m=40.0)
    for name in ("alpha", "p", "mu", "mass_t", "size", "restitution"):
        assert getattr(cut, name) == pytest.approx(getattr(whole, name), rel=1e-13), name
    assert Pier.of_parts(7.0, [(2000.0, 20.0, Part.shaft(7.0, 40.0, 2000.0).inertia_t_m2)]).mu == pytest.approx(3.0)


def test_two_legs_are_a_wide_rectangle_without_its_middle():
    """Legs of 2 m, their axes 8 m apart, are what 10 m of width have without the 6 m between them."""
    whole, middle = (Part.rectangle(10.0 * width, 15.0, 30.0, width) for width in (10.0, 6.0))
    legs = Part.rectangle(40.0, 15.0, 30.0, 2.0, apart_m=8.0)
    assert legs.mass_t == whole.mass_t - middle.mass_t
    assert legs.inertia_t_m2 == pytest.approx(whole.inertia_t_m2 - middle.inertia_t_m2, rel=1e-14)


def test_the_top_is_the_highest_point_unless_it_is_said():
    assert Pier(0.2, 1.0).top == 2 * Pier(0.2, 1.0).height
    assert Pier.with_deck(4.0, 30.0, 2000.0, 500.0, deck_height_m=28.0).top == 30.0
    assert Pier.with_deck(4.0, 30.0, 2000.0, 500.0, deck_height_m=32.0).top == 32.0
    assert Pier.with_deck(4.0, 30.0, 2000.0, 500.0, top_m=31.5).top == 31.5
    assert Pier.of_parts(4.0, [(1000.0, 10.0, 5e4), (300.0, 31.0)]).top == 31.0


SHAFT, CAP = Part.rectangle(1000.0, 30.0, 60.0, 4.0), Part.rectangle(100.0, 61.0, 2.0, 12.0)
LIFTS = [Part.rectangle(500.0, 15.0, 30.0, 5.0), Part.rectangle(500.0, 45.0, 30.0, 3.0)]
FOOTING = [Part.rectangle(3000.0, 1.0, 2.0, 12.0), Part.rectangle(500.0, 32.0, 60.0, 4.0)]


@pytest.mark.parametrize(
    ("pier", "highest", "deck"),
    [
        (Pier.rectangle(4.0, 60.0), 60.0, 60.0),
        (Pier.frame(Pier.rectangle(4.0, 60.0, mass_t=1000.0), 3, 900.0), 60.0, 60.0),
        (Pier.with_deck(4.0, 60.0, 1000.0, 500.0, deck_height_m=62.0), 62.0, 62.0),
        (Pier.with_deck(4.0, 60.0, 1000.0, 500.0, deck_height_m=58.0), 60.0, 58.0),
        (replace(Pier.rectangle(4.0, 60.0), deck_height_m=62.0), 62.0, 62.0),
        (Pier.of_parts(10.0, [SHAFT]), 60.0, 60.0), (Pier.of_parts(10.0, LIFTS), 60.0, 60.0),
        (Pier.of_parts(10.0, [CAP, SHAFT]), 62.0, 62.0), (Pier.of_parts(10.0, FOOTING), 62.0, 62.0),
        (Pier.of_parts(10.0, [SHAFT, Part(500.0, 63.0, 0.0, 0.0)], deck_height_m=63.0), 63.0, 63.0),
        (Pier.of_parts(10.0, [SHAFT, Part(500.0, 50.0, 0.0, 0.0)], deck_height_m=50.0), 60.0, 50.0),
    ],
)  # fmt: skip
def test_every_pier_has_one_top_whatever_it_is_made_of(pier, highest, deck):
    """Drift, the highest section, the end of the bending shaft and of the sketch are there; `top_m` moves the drift alone."""
    for drift, one in ((highest, pier), (50.0, replace(pier, top_m=50.0))):
        assert (one.highest, one.top, one.deck) == pytest.approx((highest, drift, deck), rel=1e-14)
        if pier.deck_over_columns is None:
            assert section_heights(one, 2)[-1] == highest
        (outline,) = [
            mark for mark in sketches([described(one) | {"springs": 0}])[0].panels[0].marks if mark.look.kind == "band"
        ]
        assert np.ptp(outline.x) / np.ptp(outline.y) == pytest.approx(2.0 * pier.half_width / highest, rel=1e-14)


def test_a_drift_read_at_the_end_of_a_tall_part_is_nothing_odd():
    """Most of the mass is in the footing: the centre is at 5.4 m, the upper end of the shaft at 62 m."""
    assert Pier.of_parts(10.0, FOOTING, top_m=62.0).top == 62.0
    with pytest.raises(InputError, match=r"top_m = 160: 2\.6 times the height of the pier, 62 m"):
        Pier.of_parts(10.0, FOOTING, top_m=160.0)


@pytest.mark.parametrize(
    ("ratio", "slower", "e"), [(1.0, "0.866025404", "0.958127959"), (4.0, "0.832050294", "0.956195403")]
)
def test_a_frame_has_the_published_frequency_and_restitution(ratio, slower, e):
    """Makris & Vassiliou (2013), α = 0.15; the number of columns enters by γ alone."""
    for columns in (2, 5):
        column = Pier(0.15, 1.0, mass_t=400.0)
        frame = Pier.frame(column, columns, ratio * columns * 400.0)
        assert (f"{frame.p / column.p:.9f}", f"{frame.restitution:.9f}", frame.alpha) == (slower, e, 0.15)
        assert frame.mass_t == pytest.approx(columns * 400.0 * (1 + ratio))


def test_a_frame_under_a_deck_that_outweighs_its_columns_is_the_published_limit():
    """γ → ∞: √(2/3) and cos 2α; what is left is of order 1/γ."""
    frame = Pier.frame(Pier(0.15, 1.0, mass_t=1.0, confirm=("mass_t",)), 2, 2e9, confirm=("deck_mass_t",))
    assert frame.p == pytest.approx(math.sqrt(2 / 3), abs=1e-9)
    assert frame.restitution == pytest.approx(math.cos(0.3), abs=1e-9)


def test_a_frame_moves_as_its_columns_and_its_deck_do():
    """Kinetic and potential energy of point masses: columns turn about a lower corner, the deck follows the opposite upper one.

    T = ½ θ̇² Σ m |∂r/∂θ|² does not depend on θ, and θ̈ = −(dV/dθ)/(2T/θ̇²) = −p̂² sin(α − θ). n² points: 1/n².
    """
    width, height, columns, m_c, m_d = 1.5, 10.0, 4, 35.0, 420.0
    frame = Pier.frame(Pier.rectangle(width, height, mass_t=m_c), columns, m_d)
    points, masses = shaft_points(width, height, m_c, 200)
    moving = np.vstack(
        [points - [width, 0.0], [-width, height]]
    )  # from the right pivot, about which it tilts to the right
    masses = np.r_[columns * masses, m_d]
    inertia = masses @ (moving**2).sum(axis=1)
    for theta in (0.0, 0.05, 0.12):
        slope = G * masses @ (-moving[:, 0] * math.cos(theta) - moving[:, 1] * math.sin(theta))
        assert slope / inertia == pytest.approx(frame.p**2 * math.sin(frame.alpha - theta), rel=2e-5)
    assert frame.inertia_about_pivot == pytest.approx(inertia / masses.sum(), rel=2e-5)
    assert frame.height == pytest.approx(masses @ moving[:, 1] / masses.sum(), rel=1e-12)
    assert (2 * frame.half_width, frame.top) == (pytest.approx(width, rel=1e-12), pytest.approx(height, rel=1e-12))


def test_a_frame_loses_at_an_impact_what_the_impulses_at_its_contacts_take():
    """Virtual work with the velocities after the impact: impulses at the new contacts do none, so e = Σ m v·w / Σ m w·w.

    v and w are the velocities at θ̇ = 1 before and after, about the one and the other lower corner; the deck's are those of the
    upper corner it rests on. n² points: 1/n².
    """
    width, height, columns, m_c, m_d = 3.0, 10.0, 3, 35.0, 70.0
    frame = Pier.frame(Pier.rectangle(width, height, mass_t=m_c), columns, m_d)
    points, masses = shaft_points(width, height, m_c, 200)
    masses = np.r_[columns * masses, m_d]
    before = np.vstack([points - [width, 0.0], [-width, height]])
    after = np.vstack([points, [width, height]])
    e = (masses @ (before * after).sum(axis=1)) / (masses @ (after**2).sum(axis=1))
    assert frame.restitution == pytest.approx(e, rel=2e-5)
    as_block = 1 - 2 * frame.mu / (1 + frame.mu) * math.sin(frame.alpha) ** 2
    assert abs(as_block - e) > 0.01  # what Housner's block of this mu would have


def test_a_frame_runs_as_the_block_that_stands_for_it():
    """On rigid ground α, p̂ and e say all; to rounding."""
    frame = Pier.frame(Pier.rectangle(1.5, 10.0, mass_t=35.0), 4, 420.0)
    motion = rb.pulse("sine", name="pulse", amplitude=0.3 * G, period=1.2, dt=0.01, duration=4.0)
    block = Pier(frame.alpha, frame.p)
    found = run_fixed(frame, rb.RigidBase(), motion, 2, 2.0)
    told = run_fixed(block, rb.RigidBase(frame.restitution), motion, 2, 2.0)
    assert (found.theta_max, found.impacts) == (pytest.approx(told.theta_max, rel=1e-14), told.impacts)
    assert found.impacts > 0
    assert run_fixed(block, rb.RigidBase(), motion, 2, 2.0).theta_max != found.theta_max


def test_a_frame_on_springs_is_refused_with_the_reason():
    frame = Pier.frame(Pier.rectangle(1.5, 10.0, mass_t=35.0), 4, 420.0)
    motion = rb.pulse("sine", name="pulse", amplitude=1.0, period=1.0, dt=0.01, duration=2.0)
    for base in (rb.ElasticBase(60.0), rb.YieldingBase(60.0, eta=3.0)):
        with pytest.raises(
            InputError, match=r"rigid ground only.*each column settles by itself.*write \[\[pier.part\]\]"
        ):
            rb.simulate(frame, base, motion)


def test_stiffness_and_strength_become_beta_and_eta_and_back():
    """K = ω_v² M/2 and F_y = η M g/2 with the mass of pier and deck, in kN, t and m."""
    pier = Pier.with_deck(4.0, 30.0, 2000.0, 1000.0)
    base = rb.YieldingBase.from_stiffness(pier, 2.0e6, 40e3, epsilon=0.05, n=3)
    assert (base.beta * pier.p) ** 2 == pytest.approx(2 * 2.0e9 / 3.0e6, rel=1e-14)  # N/m over kg
    assert base.eta == pytest.approx(40e6 / (0.5 * 3.0e6 * G), rel=1e-14)
    assert (base.epsilon, base.n) == (0.05, 3)
    assert in_kilonewtons(pier, base) == pytest.approx({"stiffness_kN_m": 2.0e6, "yield_kN": 40e3}, rel=1e-14)
    elastic = rb.ElasticBase.from_stiffness(pier, 2.0e6, flight="guided")
    assert elastic == rb.ElasticBase(base.beta, flight="guided")
    assert rb.YieldingBase.from_stiffness(pier, 2.0e6, eta=2.5) == rb.YieldingBase(base.beta, eta=2.5)
    assert in_kilonewtons(Pier(0.1, 1.0), base) == {}


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: rb.ElasticBase.from_stiffness(Pier(0.1, 1.0), 1e6), "mass_t is missing"),
        (lambda: rb.ElasticBase.from_stiffness(Pier(0.1, 1.0, mass_t=1e3), -1e6), r"stiffness_kN_m = -1e\+06: must be"),
        (lambda: Pier(0.1, 1.0, mass_t=0.0), "mass_t = 0: must be a number above 0"),
        (lambda: Pier(0.1, 1.0, top_m=math.inf), r"top_m = inf: must be 1e\+15 at most"),
        (lambda: Pier.of_parts(4.0, []), "there are none"),
        (lambda: Pier.of_parts(4.0, [(1.0, 10.0), (1.0, -1.0)]), "part_2_height_m = -1: must be 0 or"),
        (lambda: Pier.of_parts(4.0, [(1.0, 10.0)]), "they have no rotary inertia about their common centre"),
        (lambda: Pier.of_parts(4.0, [(1.0, 0.0, 2.0)]), "they have no height"),
        (lambda: Pier.with_deck(4.0, 30.0, 2000.0, -1.0), "deck_mass_t = -1: must be a number above 0"),
        (lambda: Pier.frame(Pier(0.1, 1.0, mass_t=100.0), 1, 100.0), "columns = 1: must be a whole number, 2 or above"),
        (lambda: Pier.frame(Pier(0.1, 1.0), 2, 1.0), "mass_t is missing, of one column"),
        (lambda: Pier.frame(Pier(0.1, 1.0, 4.0, mass_t=100.0), 2, 100.0), "mu = 4: the columns of a frame are solid"),
    ],
)
def test_what_cannot_be_is_refused_with_its_name(make, said):
    with pytest.raises(InputError, match=said):
        make()
