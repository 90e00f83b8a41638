"""Forces in sections of the shaft, against the mass above them cut into points whose positions are differentiated twice."""

import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from numpy.polynomial import polynomial

import rockbatch as rb
from rockbatch.observers.interaction.observe import InteractionInSections
from rockbatch.observers.sections.observe import ForcesInSections
from rockbatch.outcome.changes import LEAST
from rockbatch.outcome.outcome import Section
from rockbatch.pier.sections import section_heights
from rockbatch.simulation import recording
from rockbatch.simulation import sections as of_sections
from rockbatch.simulation.base_forces import at_rows
from rockbatch.simulation.error_control import CHANCE
from rockbatch.simulation.observing import observed
from rockbatch.simulation.runs import Run, run_fixed
from rockbatch.simulation.sections import InBody, InSection, in_body, in_section, sections_of, with_errors

G = 9.81
SUBSTEPS = 20
"""Steps between samples of 0.01 s: a difference of fourth order then errs by less than 10⁻⁶ at ω = 100 rad/s."""

GAUSS = np.polynomial.legendre.leggauss(5)

BASES = {
    "rigid": rb.RigidBase(),
    "first-order": rb.ElasticBase(60.0, 0.2),
    "finite": rb.ElasticBase(60.0, 0.2, kinematics="finite"),
    "damped": rb.ElasticBase(60.0, zeta=0.05),
    "yielding": rb.YieldingBase(60.0, 0.2, eta=2.5),
}


def random_pier(rng):
    """A pier of stacked parts of different widths, with masses at one height and a deck that may turn with it."""
    width, foot, parts = rng.uniform(3.0, 6.0), 0.0, []
    for length in rng.uniform(2.0, 12.0, rng.integers(1, 4)):
        mass, across = rng.uniform(100.0, 900.0), rng.uniform(0.3, 1.0) * width
        parts.append(rb.Part(mass, foot + 0.5 * length, mass * (across**2 + length**2) / 12.0, length))
        foot += length
    parts.append(rb.Part(rng.uniform(10.0, 200.0), rng.uniform(0.1, 0.9) * foot, rng.uniform(0.0, 100.0), 0.0))
    parts.append(rb.Part(rng.uniform(100.0, 2000.0), foot + rng.uniform(0.0, 3.0), rng.choice([0.0, 3000.0]), 0.0))
    return rb.Pier.of_parts(width, parts, confirm=("width_m", "top_m", "deck_height_m"))


def random_motion(rng, pier, vertical):
    """Three seconds of noise, linear between samples, that makes the pier rock; ``vertical`` over g."""
    t = np.arange(300) * 0.01
    fades = np.sin(np.pi * t / t[-1])
    swings = [np.sin(2 * np.pi * f * t + rng.uniform(0, 6)) * fades for f in rng.uniform(0.5, 4.0, 6)]
    horizontal, lifting = sum(swings[:3]), sum(swings[3:])
    strength = 2.0 * G * math.tan(pier.alpha) / np.abs(horizontal).max()
    return rb.Motion("noise", 0.01, strength * horizontal, vertical * G * lifting / np.abs(lifting).max())


def points_above(pier, height):
    """Mass over M, height from the section and offset from the axis of points that stand for the mass above it."""
    whole, points = sum(part.mass_t for part in pier.parts), []
    for part in pier.parts:
        low, high = part.height_m - 0.5 * part.length_m, part.height_m + 0.5 * part.length_m
        radius = math.sqrt(max(part.inertia_t_m2 / part.mass_t - part.length_m**2 / 12.0, 0.0))
        if part.length_m == 0.0:
            slices = [(part.mass_t, low)] if low >= height else []
        else:
            half = 0.5 * max(high - max(low, height), 0.0)
            slices = [
                (part.mass_t * half * w / part.length_m, high - half + half * x) for x, w in zip(*GAUSS, strict=True)
            ]
        points += [
            (0.5 * mass / whole, place - height, side * radius) for mass, place in slices for side in (-1.0, 1.0)
        ]
    return np.array(points).reshape(-1, 3).T


def by_points(run, rows, height, middle, k_deck=0.0):
    """Shear, moment and axial force in the section at ``height`` at the row ``middle``, with neighbours at equal steps."""
    pier, base, near = run.pier, run.base, slice(middle - 2, middle + 3)
    t, theta, v, row = rows.t[near], rows.theta[near], rows.v[near], rows[middle]
    side = row.right - row.left
    side = row.bore if not base.on_springs and side == 0.0 else side
    b, h = pier.half_width, pier.height
    sine, cosine, mid = np.sin(theta), np.cos(theta), theta[2]
    along = h * sine + side * b * (1.0 - cosine)
    axes = np.array([[cosine[2], -sine[2]], [sine[2], cosine[2]]])  # across the axis and along it
    axes_of_centre = axes
    if base.kinematics == "first-order":
        along, axes_of_centre = h * theta, np.array([[1.0, -mid], [mid, 1.0]])
    weights = np.array([-1.0, 16.0, -30.0, 16.0, -1.0]) / (12.0 * (t[3] - t[2]) ** 2)
    samples = np.arange(run.motion.npts) * run.motion.dt
    ground = [np.interp(t[2], samples, component) for component in (run.motion.horizontal, run.motion.vertical)]
    of_centre = axes_of_centre @ [along @ weights + ground[0], v @ weights + ground[1] + G]
    mass, rise, off = points_above(pier, height)
    x = np.outer(rise + height - h, sine) + np.outer(off, cosine)
    y = np.outer(rise + height - h, cosine) - np.outer(off, sine)
    shear, axial = mass * (axes @ [x @ weights, y @ weights] + of_centre[:, None])
    turning = rise * shear - off * axial
    swing = 0.0 if base.on_springs else math.copysign(b, mid) * (1.0 - cosine[2])  # of rotation about a pivot
    push, arm = k_deck * (pier.deck * sine[2] + swing) * (pier.deck >= height), pier.deck - height
    shear_of_deck, axial_of_deck = push * axes_of_centre[:, 0]
    return shear.sum() + shear_of_deck, -turning.sum() - arm * shear_of_deck, axial.sum() + axial_of_deck


def smooth(rows, rng, number):
    """Rows with two neighbours at equal steps on both sides, within a sampling interval and away from events, at random."""
    step = np.diff(rows.t)
    even = np.abs(step - 0.01 / SUBSTEPS) < 1e-12
    even = even[:-3] & even[1:-2] & even[2:-1] & even[3:]
    place = np.arange(2, len(even) + 2)
    inside = np.all([rows.kind[place + shift] == -2.0 for shift in (-1, 0, 1)], axis=0)
    return rng.choice(place[even & inside], number)


def recorded(pier, base, motion, substeps=SUBSTEPS):
    run = Run(pier, base, motion)
    outcome = run_fixed(pier, base, motion, substeps, 0.2, wait=False)
    return run, recording.recorded(run, outcome, 0.2, True, wait=False).rows


def in_sections(run, rows, heights, numbers, shares):
    """Shear, moment and axial force, shape (heights, moments) each."""
    body = in_body(of_sections.recorded(run, rows), numbers, shares)
    return InSection(*map(np.array, zip(*(in_section(run.pier, body, height) for height in heights), strict=True)))


def check_against_points(seed, base, vertical, k_deck=0.0):
    rng = np.random.default_rng(seed)
    pier = random_pier(rng)
    if k_deck:
        base = replace(base, restraints=(rb.DeckSpring(lam=k_deck),))
        k_deck *= G * pier.size / pier.half_width**2
    run, rows = recorded(pier, base, random_motion(rng, pier, vertical))
    heights = (0.0, *rng.uniform(0.0, section_heights(pier, 2)[1], 3), section_heights(pier, 2)[1])
    numbers = smooth(rows[rows.t < 2.9].view(np.recarray), rng, 8)
    found = in_sections(run, rows, heights, numbers, np.ones(len(numbers)))
    for i, height in enumerate(heights):
        for j, number in enumerate(numbers):
            expected = by_points(run, rows, height, number, k_deck)
            forces = found.shear[i, j], found.moment[i, j], found.axial[i, j]
            scales = G, G * pier.height, G
            for ours, theirs, scale in zip(forces, expected, scales, strict=True):
                assert ours == pytest.approx(theirs, abs=2e-6 * scale), (seed, height, rows.t[number])
    return rows


@pytest.mark.parametrize("name", BASES)
def test_forces_in_sections_are_those_that_accelerate_the_mass_above(name):
    for seed in range(3):
        check_against_points(seed, BASES[name], vertical=0.3)


@pytest.mark.parametrize("name", BASES)
def test_forces_in_sections_during_flight(name):
    flew = 0
    for seed in range(20, 26):
        rows = check_against_points(seed, BASES[name], vertical=1.6)
        flew += bool(((rows.left == 0.0) & (rows.right == 0.0)).any())
    assert flew >= 3


@pytest.mark.parametrize("name", ["rigid", pytest.param("finite", marks=pytest.mark.thorough)])
def test_springs_at_the_deck_act_in_all_sections_below_it(name):
    for seed in range(40, 44):
        check_against_points(seed, BASES[name], vertical=0.3, k_deck=0.3)


def test_devices_at_the_deck_push_by_their_laws_between_rows_too():
    """In the middle of 16 steps within a sampling interval, by the two ends alone; linear in time it would be further away."""
    rng = np.random.default_rng(45)
    devices = (rb.Damper("viscous", nu=0.3, at="deck"), rb.Damper("viscous", nu=0.3, brace=0.2, at="deck"))
    pier, base = random_pier(rng), rb.RigidBase(restraints=(*devices, rb.DeckSpring(lam=0.3)))
    run, rows = recorded(pier, base, random_motion(rng, pier, 0.3))
    whole = in_body(of_sections.recorded(run, rows), np.arange(len(rows)), np.ones(len(rows))).on_deck
    off, off_linear = [], []
    for i in range(8, len(rows) - 8, 5):
        near = rows[i - 8 : i + 9]
        if (near.kind != -2.0).any() or abs(near.t[-1] - near.t[0] - 16 * 0.01 / SUBSTEPS) > 1e-9:
            continue
        two = of_sections.recorded(run, rows[[i - 8, i + 8]].view(np.recarray))
        half_way = in_body(two, np.array([1]), np.array([0.5])).on_deck
        off.append([abs(push[0] - of_all[i]) for (_, push), (_, of_all) in zip(half_way, whole, strict=True)])
        off_linear.append([abs(0.5 * (push[i - 8] + push[i + 8]) - push[i]) for _, push in whole])
    worst, worst_linear = np.max(off, axis=0) / G, np.max(off_linear, axis=0) / G
    assert (len(off) > 50, len(worst)) == (True, 3)
    assert (worst < 0.02 * worst_linear).all()
    assert (worst_linear > 5e-6).all()


def test_a_spring_at_the_deck_pushes_horizontally_however_far_the_shaft_leans():
    """Its force in the axes of the shaft, and its moment about the middle of a section below it."""
    zero, lean, push = np.zeros(1), np.array([0.6]), np.array([2.0])
    body = InBody(zero, zero, zero, zero, zero, np.sin(lean), np.cos(lean), [(9.0, push)], None)
    pier = random_pier(np.random.default_rng(1))
    below, above = in_section(pier, body, 4.0), in_section(pier, body, 9.5)
    assert np.hypot(below.shear, below.axial) == pytest.approx(push)
    assert np.arctan2(below.axial, below.shear) == pytest.approx(lean)
    assert below.moment == pytest.approx(-5.0 * below.shear)
    assert [*above] == [0.0, 0.0, 0.0]


def test_devices_at_the_base_act_below_all_sections():
    base = rb.RigidBase(restraints=(rb.Tendon(psi=0.2, lam=0.3, at=0.5), rb.Damper("viscous", nu=0.2)))
    for seed in range(50, 54):
        check_against_points(seed, base, vertical=0.3)


# At the foot and at the top


@pytest.mark.parametrize("name", BASES)
def test_forces_at_the_foot_are_the_grounds_in_the_axes_of_the_shaft(name):
    """Shear and normal force of ``forces`` with their moment about the middle of the footing, from which the foot has moved."""
    rng = np.random.default_rng(7)
    pier, base = random_pier(rng), BASES[name]
    run, rows = recorded(pier, base, random_motion(rng, pier, 1.5), substeps=6)
    forces, numbers = at_rows(run, rows), np.arange(len(rows))
    found = in_sections(run, rows, [0.0], numbers, np.ones(len(rows)))
    sine, cosine, side = np.sin(rows.theta), np.cos(rows.theta), rows.right - rows.left
    side = side if base.on_springs else np.where(side != 0.0, side, rows.bore)
    to_right, up = side * pier.half_width * (1.0 - cosine), side * pier.half_width * sine
    shear, moment = forces.shear, forces.moment + up * forces.shear - to_right * forces.normal
    if base.kinematics == "first-order":  # the moment of the ground alone is about the pivot there (THEORY.md, Forces)
        ground = np.interp(rows.t, np.arange(run.motion.npts) * 0.01, run.motion.horizontal)
        sine, cosine = rows.theta, 1.0
        moment = forces.moment + side * pier.half_width * rows.theta * ground * (rows.t < 2.99)
    inner = rows.t < 2.99
    for ours, theirs in (
        (found.shear[0], shear * cosine - forces.normal * sine),
        (found.axial[0], forces.normal * cosine + shear * sine),
        (found.moment[0], moment),
    ):
        assert np.abs(ours - theirs)[inner].max() < 1e-11 * G * pier.height
    rocking = inner & (rows.left + rows.right == 1.0)
    if name == "rigid":  # all of the force is at the pivot
        assert np.allclose(found.moment[0][rocking], (side * pier.half_width * found.axial[0])[rocking], atol=1e-9)


def test_a_free_top_bears_nothing_and_one_under_a_deck_its_weight_and_inertia():
    rng = np.random.default_rng(8)
    block = rb.Pier.rectangle(width_m=4.0, height_m=20.0)
    run, rows = recorded(block, BASES["rigid"], random_motion(rng, block, 0.5), substeps=6)
    forces = in_sections(run, rows, [20.0], np.arange(len(rows)), np.ones(len(rows)))
    assert max(np.abs(values).max() for values in forces) < 1e-10

    pier = rb.Pier.with_deck(width_m=4.0, height_m=20.0, mass_t=600.0, deck_mass_t=300.0)
    run, rows = recorded(pier, BASES["rigid"], random_motion(rng, pier, 0.5), substeps=6)
    found = in_sections(run, rows, [20.0], np.arange(len(rows)), np.ones(len(rows)))
    deck = at_rows(run, rows).deck / 3.0  # a third of the mass
    horizontal = found.shear[0] * np.cos(rows.theta) + found.axial[0] * np.sin(rows.theta)
    assert np.allclose(horizontal, deck, atol=1e-9)
    assert np.abs(found.moment[0]).max() < 1e-10


def test_a_block_at_rest_bears_its_weight_and_the_ground_by_hand():
    """Solid, 4 m × 20 m, 1000 t, at the half of its height, while the ground accelerates by 1 m/s² to the right.

    500 t are above: V = 500 kN, N = 500 · 9.81 = 4905 kN, and a moment of 500 kN · 5 m that leans against the motion. At a
    quarter of the height 750 t are above, by 7.5 m: 750 kN, 7357.5 kN, −5625 kN m.
    """
    pier = rb.Pier.rectangle(width_m=4.0, height_m=20.0, mass_t=1000.0)
    run, rows = recorded(pier, BASES["rigid"], rb.Motion("steady", 0.01, np.ones(50)), substeps=2)
    forces = in_sections(run, rows, [5.0, 10.0], np.array([20]), np.ones(1))
    found = [1000.0 * values[:, 0] for values in (forces.shear, forces.axial, forces.moment)]
    assert np.allclose(found, [[750.0, 500.0], [7357.5, 4905.0], [-5625.0, -2500.0]])


# Extremes


@pytest.mark.parametrize("name", BASES)
def test_a_mirrored_motion_gives_the_same_extremes(name):
    rng = np.random.default_rng(9)
    pier, heights = random_pier(rng), (0.0, 2.0, 4.0)
    motion = random_motion(rng, pier, 0.8)
    both = [
        sections_of(*recorded(pier, BASES[name], m, substeps=8), heights)
        for m in (motion, motion.times(1.0, reverse=True))
    ]
    assert np.allclose(*([section[:-1] for section in sections] for sections in both), rtol=1e-9)


@pytest.mark.parametrize("name", BASES)
def test_extremes_are_those_of_much_finer_steps_within_their_error(name):
    rng = np.random.default_rng(10)
    pier = random_pier(rng)
    motion = random_motion(rng, pier, 0.5)
    response = rb.simulate(pier, BASES[name], motion, sections=3, tolerance=1e-5)
    fine = sections_of(*recorded(pier, BASES[name], motion, substeps=80), section_heights(pier, 3))
    columns = ["section_shear_m_s2", "section_moment_m2_s2", "section_axial_least_m_s2", "section_axial_greatest_m_s2"]
    for row, exact in zip(response.sections.to_dict("records"), fine, strict=True):
        assert row["sections_error"] < 4e-3
        for column, value in zip(columns, exact[1:5], strict=True):
            assert row[column] == pytest.approx(value, rel=row["sections_error"] + 1e-5, abs=1e-6), column


@pytest.mark.parametrize("place", range(4))
def test_an_error_is_four_times_the_change_of_any_extreme_as_a_share_of_itself(place):
    """Also of the least axial force of a section that is pulled, which is negative; small ones count as a hundredth of g."""
    pier, values = random_pier(np.random.default_rng(3)), np.array([3.0, 20.0, -2.0, 30.0])
    other = values.copy()
    other[place] *= 1.001
    fine, coarse = (Section(1.0, *forces, 0.0) for forces in (values.tolist(), other.tolist()))
    assert with_errors([fine], [coarse], pier, CHANCE)[0].error == pytest.approx(0.004, rel=1e-9)
    small = fine._replace(axial_least=0.01 * pier.gravity * 1e-3)
    claimed = with_errors([small], [small._replace(axial_least=0.0)], pier, CHANCE)[0].error
    assert claimed == pytest.approx(0.004, rel=1e-9)
    assert with_errors([fine], [fine], pier, CHANCE)[0].error == CHANCE * LEAST


def error_at_foot(run, outcome, error):
    """The error of the forces in the lowest section, None without one."""
    (found,) = observed([run], [outcome], [ForcesInSections((0.0,))], 0.2, error=error, wait=False)
    (row,) = found.tables[ForcesInSections.table]
    return row["sections_error"]


def test_sections_of_a_chaotic_run_or_of_odd_steps_have_no_error():
    rng = np.random.default_rng(10)
    run, _ = recorded(random_pier(rng), BASES["rigid"], random_motion(rng, random_pier(rng), 0.5), substeps=8)
    for substeps, chaotic, claimed in ((8, None, True), (8, True, False), (7, None, False)):
        outcome = run_fixed(run.pier, run.base, run.motion, substeps, 0.2, wait=False).changed(chaotic=chaotic)
        assert (error_at_foot(run, outcome, error=True) is not None) == claimed
    assert error_at_foot(run, outcome.changed(substeps=8, chaotic=None), error=False) is None


def test_a_motion_with_a_jump_bends_the_foot_no_more_than_its_normal_force_can():
    """All of N is at the pivot: |moment| = b N, though 0.5 g at once would ask for h ü_g, twice as much."""
    pier = rb.Pier.rectangle(width_m=3.0, height_m=15.0)
    motion = rb.pulse("cosine", name="cosine", amplitude=0.5 * G, period=0.5, dt=0.01, duration=2.0)
    run, rows = recorded(pier, BASES["rigid"], motion, substeps=8)
    (foot,) = sections_of(run, rows, [0.0])
    assert foot.moment == pytest.approx(pier.half_width * foot.axial_at_moment, rel=1e-9)
    assert foot.moment < 0.45 * pier.height * 0.5 * G


# interaction.csv


def reach(points, sizes):
    """Return how far points of N and |E|, over their ``sizes``, reach in 61 directions."""
    ways = np.linspace(0.0, np.pi, 61)
    return (np.array([np.cos(ways), np.sin(ways)]).T @ [points[0] / sizes[0], np.abs(points[1]) / sizes[1]]).max(axis=1)


def by_points_at_rows(run, rows, height):
    """Axial force and moment in a section by the points above it, normal force and shear of the base for None, shape (2, n).

    At all rows at which the points can be differentiated.
    """
    numbers = np.unique(smooth(rows[rows.t < 2.9].view(np.recarray), np.random.default_rng(0), 20000))
    shear, moment, axial = np.array([by_points(run, rows, height or 0.0, number) for number in numbers]).T
    if height is not None:
        return np.array([axial, moment])
    sine, cosine = np.sin(rows.theta[numbers]), np.cos(rows.theta[numbers])
    if run.base.kinematics == "first-order":
        sine, cosine = rows.theta[numbers], 1.0
    return np.array([axial * cosine - shear * sine, shear * cosine + axial * sine]) / (sine**2 + cosine**2)


def read_at_rows(run, rows, height):
    """The same by the run's own forces, at all rows; of the base also between them, on the cubic through four even ones."""
    if height is not None:
        (forces,) = of_sections.forces_in_sections(run, rows, [height])
        return np.array([forces.axial, forces.moment])
    forces, step = at_rows(run, rows), np.diff(rows.t)
    even = (step[1:-1] > 0.0) & np.isclose(step[:-2], step[1:-1]) & np.isclose(step[2:], step[1:-1])
    around = np.flatnonzero(even)[:, None] + np.arange(4)
    curves = (polynomial.polyfit(np.arange(-1, 3), its[around].T, 3) for its in (forces.normal, forces.shear))
    between = [polynomial.polyval(np.array([0.25, 0.5, 0.75]), curve).ravel() for curve in curves]
    return np.hstack([[forces.normal, forces.shear], between])


@pytest.mark.slow
@pytest.mark.parametrize("name", ["first-order", "rigid"])
def test_each_column_of_interaction_is_that_of_the_mass_above_differentiated_twice(name):
    """Corners reach as far as the forces at all rows, but for those left out; between rows and beside events a little farther.

    The error is four times the change of the reach by half the steps, and 10⁻⁴ for corners left out.
    """
    rng = np.random.default_rng(14)
    pier, base = random_pier(rng), BASES[name]
    run, rows = recorded(pier, base, random_motion(rng, pier, 0.3))
    coarse = recorded(pier, base, run.motion, SUBSTEPS // 2)[1]
    outcome = run_fixed(pier, base, run.motion, SUBSTEPS, 0.2, wait=False)
    heights = (0.0, 0.6 * section_heights(pier, 2)[1])
    observer = InteractionInSections(heights, base=True)
    (found,) = observed([run], [outcome], [observer], 0.2, error=True, wait=False)
    table = pd.DataFrame(found.tables[observer.table]).astype(float)
    assert table["height_m"].drop_duplicates().tolist() == pytest.approx([*heights, math.nan], nan_ok=True)
    for height in (*heights, None):
        own = table[table["height_m"].isna() if height is None else table["height_m"] == height]
        effect, other = ("shear_kN", "moment_kNm") if height is None else ("moment_kNm", "shear_kN")
        assert own[other].isna().all()
        assert own["axial_kN"].is_monotonic_increasing
        corners = own[["axial_kN", effect]].to_numpy().T / pier.mass_t
        sizes = np.abs(corners).max(axis=1)
        farther = reach(corners, sizes) - reach(by_points_at_rows(run, rows, height), sizes)
        assert farther.min() > -1e-4, height
        assert farther.max() < 1e-2, height
        of_rows = [reach(read_at_rows(run, its, height), sizes) for its in (rows, coarse)]
        change = np.abs(of_rows[0] - of_rows[1]).max()
        assert own["interaction_error"].to_numpy() == pytest.approx(CHANCE * change + 1e-4, abs=1e-7), height


# What has no sections


@pytest.mark.parametrize(
    ("pier", "message"),
    [
        (rb.Pier(0.2, 1.0, 4.0), "mu = 4 does not say how the mass is spread"),
        (
            rb.Pier.frame(rb.Pier.rectangle(2.0, 10.0, mass_t=100.0), 2, 100.0),
            "how the deck of a frame presses on each",
        ),
        (rb.Pier.of_parts(4.0, [(100.0, 5.0, 1000.0), (50.0, 9.0, 0.0, 0.0)]), "part 1, at 5 m, has no length_m"),
        (replace(rb.Pier.with_deck(4.0, 20.0, 600.0, 300.0), p=1.0), "the parts are those of another pier"),
    ],
)
def test_a_pier_whose_mass_is_not_known_over_the_height_has_no_sections(pier, message):
    with pytest.raises(rb.InputError, match=message):
        section_heights(pier, 3)


def test_sections_are_between_the_foot_and_the_highest_point():
    pier = rb.Pier.with_deck(4.0, 20.0, 600.0, 300.0, deck_height_m=22.0)
    assert section_heights(pier, 3) == (0.0, 11.0, 22.0)
    assert section_heights(pier, (15.0, 5.0, 5.0)) == (5.0, 15.0)
    for height in (-1.0, 23.0):
        with pytest.raises(
            rb.InputError, match=rf"sections_m = {height:g}: must be within 0 and the top of the pier, 22 m"
        ):
            section_heights(pier, (5.0, height))


@pytest.mark.parametrize(
    ("length", "message"),
    [(11.0, "reaches below the pivots; about 5 m it may be 10"), (10.0, "an inertia of m L²/12 = 833.333")],
)
def test_a_length_that_a_part_cannot_have_is_refused(length, message):
    with pytest.raises(rb.InputError, match=message):
        rb.Pier.of_parts(4.0, [(100.0, 5.0, 700.0, length)])


def test_a_turn_within_a_step_is_sought_where_its_parabola_has_it():
    """Of a(s − s₀)² + c with s₀ within the step the turn is at s₀, whichever way it bends; a turn beyond the step is none, nor is
    one below what the ends have."""
    for bend, turn in ((-3.0, 0.3), (2.0, 0.85), (4.0, 0.5)):
        values = np.array([bend * (s - turn) ** 2 for s in (0.0, 1.0)])
        half = np.array([bend * (0.5 - turn) ** 2])
        flat, still = np.zeros(2), np.zeros(1)
        for order in range(3):
            ends, middles = [flat] * 3, [still] * 3
            ends[order], middles[order] = values + 7.0, half + 7.0
            numbers, shares = of_sections._promising(InSection(*ends), InSection(*middles), np.array([1]))
            assert numbers.tolist() == [1]
            assert shares == pytest.approx([turn], rel=1e-12)
    for turn in (-0.1, 1.1):
        values, half = np.array([turn**2, (1.0 - turn) ** 2]), np.array([(0.5 - turn) ** 2])
        found = of_sections._promising(InSection(values, flat, flat), InSection(half, still, still), np.array([1]))
        assert len(found[0]) == len(found[1]) == 0
    later = np.array([0.0, 0.0, 9.0, -9.0])  # other rows are beyond the turn of the first step
    hidden = of_sections._promising(
        InSection(later, np.zeros(4), np.zeros(4)), InSection(np.array([1.0]), still, still), np.array([1])
    )
    assert len(hidden[0]) == 0
