"""Numbers of a row that not every pier has, computed again by other code: flights, keys, beds, bending, errors.

As in test_columns_recomputed.py, a greatest value between two rows of a table may be larger than theirs, and never smaller.
"""

import math
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq
from studies import SINE, study_text, write_study

import rockbatch as rb
from rockbatch.motions import Motion
from rockbatch.quantities.catalogue import COLUMNS

G = 9.81
PIER = rb.Pier(alpha=0.2, p=1.0, gravity=G, mass_t=1000.0)
SIZE = 0.75 * G / PIER.p**2
WIDTH, RISE = 2.0 * SIZE * math.sin(PIER.alpha), SIZE * math.cos(PIER.alpha)
"""Width between the pivots and height of the centre [m]."""
STEP = 0.005
FRICTION, STRENGTH, PSI, LAM = 0.3, 0.16, 0.1, 0.5
TAUT = LAM * G * SIZE / (0.5 * WIDTH) ** 2
"""Stiffness of the tendon per unit mass of the pier [1/s²]."""


def shaking(vertical: float) -> Motion:
    """Three cycles of a sine, and a stronger one of the vertical while they last, in parts of 1.3 g."""
    t = np.arange(0.0, 3.0, STEP)
    horizontal = 0.45 * G * np.sin(2.0 * np.pi * t / 0.8) * (t < 2.4)
    return Motion(
        "shaking", STEP, horizontal, 1.3 * vertical * G * np.sin(2.0 * np.pi * t / 0.3) * (abs(t - 1.0) < 0.3)
    )


# A pier that flies, with a tendon that yields


@pytest.fixture(scope="module")
def flying():
    devices = rb.Damper("viscous", nu=0.2), rb.Tendon(psi=PSI, lam=LAM, strength=STRENGTH)
    base = rb.RigidBase(restraints=devices, friction=FRICTION)
    return rb.simulate(PIER, base, shaking(1.0), forces=True, devices_work=True)


def flights(response):
    """Return take-off and landing of each flight: the rows around those in which both heels are up."""
    table = response.forces
    up = ((table.heel_gap_left > 0.0) & (table.heel_gap_right > 0.0)).to_numpy().astype(int)
    off, on = (np.flatnonzero(np.diff(up) == way) for way in (1, -1))
    t = table.t.to_numpy()
    return list(zip(t[off], t[on + 1], strict=True))


def test_flights_of_a_row_are_those_in_which_both_heels_are_up(flying):
    row, table = flying.row, flying.forces
    durations = [last - first for first, last in flights(flying)]
    assert row["flights"] == len(durations) == 2
    assert row["flight_s"] == pytest.approx(flights(flying)[0][0], abs=1e-12)
    assert row["flight_duration_s"] == pytest.approx(sum(durations), abs=1e-12)
    assert row["flight_longest_s"] == pytest.approx(max(durations), abs=1e-12)
    lower = np.minimum(table.heel_gap_left, table.heel_gap_right).max()
    assert lower <= row["flight_height_m"] <= 1.01 * lower


def test_keys_carry_the_shear_while_the_base_is_hardly_pressed(flying):
    row, table = flying.row, flying.forces
    carried = table.base_shear[table.normal_force < 0.1 * G].abs().max()
    assert carried * (1.0 - 1e-12) <= row["key_shear_m_s2"] <= 1.01 * carried
    assert row["key_shear_kN"] == pytest.approx(PIER.mass_t * row["key_shear_m_s2"], rel=1e-12)
    assert row["slides"] == (max(row["friction_demand"], row["impact_friction_demand"]) > FRICTION)


def test_a_base_that_has_the_friction_does_not_slide(flying):
    enough = replace(flying.base, friction=1.01 * flying.row["friction_demand"])
    assert rb.simulate(PIER, enough, shaking(1.0), forces=True).row["slides"] == 0
    short = replace(flying.base, friction=0.99 * flying.row["friction_demand"])
    assert rb.simulate(PIER, short, shaking(1.0), forces=True).row["slides"] == 1


def test_a_tendon_stays_longer_by_what_its_force_does_not_explain(flying):
    row, table = flying.row, flying.restraints
    elongation, force = table["tendon 1 elongation"], table["tendon 1 force"]
    assert force.max() == pytest.approx(STRENGTH * G, rel=1e-9)
    plastic = elongation - (force - PSI * G) / TAUT
    assert row["tendon_yield_m"] == pytest.approx(plastic[force > 0.0].max(), rel=1e-6)
    assert row["tendon_yield_m"] > 0.1 * elongation.max()
    greatest = (PSI * G / TAUT + elongation.max()) / (STRENGTH * G / TAUT)
    assert greatest * (1.0 - 1e-12) <= row["tendon_strain_over_yield"] <= 1.004 * greatest


def half_cycles(path, least):
    """Return the number of half cycles of at least this range by rainflow counting (ASTM E1049-85, 5.4.4), with a stack."""
    path = path[np.diff(path, prepend=np.inf) != 0.0]
    turns = [
        path[0],
        *(b for a, b, c in zip(path, path[1:], path[2:], strict=False) if (b - a) * (c - b) < 0.0),
        path[-1],
    ]
    stack, count = [], 0.0
    for turn in turns:
        stack.append(turn)
        while len(stack) > 2 and abs(stack[-1] - stack[-2]) >= (inner := abs(stack[-2] - stack[-3])):
            whole = len(stack) > 3
            count += (2.0 if whole else 1.0) * (inner >= least)
            stack[-3:] = stack[-1:] if whole else stack[-2:]
    return count + sum(abs(b - a) >= least for a, b in pairwise(stack))


def test_half_cycles_of_a_row_are_counted_again_with_a_stack(flying):
    table = flying.restraints
    counted = [half_cycles(table[f"damper 1 {side} elongation"].to_numpy(), 0.010) for side in ("left", "right")]
    assert flying.row["damper_half_cycles"] == max(counted)


# A footing


STRIPS, SAFETY, ZETA, LENGTH = 20, 3.0, 0.05, 10.0


@pytest.fixture(scope="module")
def on_bed():
    base = rb.FootingBase(30.0, SAFETY, ZETA, length_m=LENGTH, strips=STRIPS)
    return rb.simulate(PIER, base, shaking(0.2), substeps=8, quiet_s=0.5, forces=True)


class Replay:
    """The bed under the path of the foot that a history has: how deep each place was pressed, and its pressure."""

    def __init__(self, response):
        """Follow the lower side of the foot at 2001 places."""
        table, self.places = response.history, np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, 2001)
        self.stiffness = (response.base.beta * PIER.p) ** 2
        self.most = SAFETY * G / self.stiffness
        self.t = table.t.to_numpy()
        theta, rise = (table[name].to_numpy()[:, None] for name in ("theta", "v"))
        depth = -rise + self.places * theta
        self.plastic = np.maximum(np.maximum.accumulate(depth, axis=0) - self.most, 0.0)
        rate = np.gradient(depth, self.t + 1e-12 * np.arange(len(self.t)), axis=0)
        self.spring = depth - self.plastic
        force = self.stiffness * self.spring + 2.0 * ZETA * math.sqrt(self.stiffness) * rate
        self.pressure = np.where(self.spring > 0.0, np.clip(force, 0.0, SAFETY * G), 0.0)

    def at_rest(self):
        """Return rise and rotation at which the final bed carries the weight, first order."""

        def push(rise, theta):
            return self.stiffness * np.clip(-rise + self.places * theta - self.plastic[-1], 0.0, None)

        def rise_at(theta):
            return brentq(lambda rise: push(rise, theta).mean() - G, -1.0, 1.0)

        def moment(theta):
            return (push(rise_at(theta), theta) * (RISE * theta - self.places)).mean()

        middle = float(np.polyfit(self.places, self.plastic[-1], 1)[0])
        theta = brentq(moment, middle - 0.01, middle + 0.01)
        return rise_at(theta), theta


@pytest.mark.slow
def test_a_bed_is_pressed_as_its_strips_are_under_the_path_of_the_foot(on_bed):
    """The row has strips, whose pressures at the edges are those of the middle of a part; the replay has two thousand places."""
    row, bed = on_bed.row, Replay(on_bed)
    assert row["foot_alpha_rad"] == pytest.approx(math.atan(0.5 * WIDTH / RISE), rel=1e-12)
    assert row["contact_least"] == pytest.approx((bed.spring > 0.0).mean(axis=1).min(), abs=0.01)
    pushed = bed.pressure.mean(axis=1)
    assert row["bed_force_over_weight"] == pytest.approx(pushed.max() / G, rel=0.01)
    assert row["bed_force_s"] == pytest.approx(bed.t[pushed.argmax()], abs=0.02)
    assert row["bed_work_J_kg"] == pytest.approx(SAFETY * G * bed.plastic[-1].mean(), rel=0.02)
    left, right = (bed.pressure[:, place].max() for place in (0, -1))
    pressure = max(left, right) * PIER.mass_t / (WIDTH * LENGTH) / 1000.0
    assert row["bed_pressure_MPa"] == pytest.approx(pressure, rel=0.02)
    side = 0 if row["bed_pressure_at_m"] < 0.0 else -1
    assert abs(row["bed_pressure_at_m"]) == pytest.approx(0.5 * WIDTH, rel=1e-12)
    at = np.abs(bed.t - row["bed_pressure_s"]).argmin()
    assert bed.pressure[at, side] == pytest.approx(max(left, right), rel=0.02)


@pytest.mark.slow
def test_the_ground_yields_in_as_many_rocks_as_its_set_grows_in(on_bed):
    """Between two changes of sign of the rotation one half cycle."""
    bed, theta = Replay(on_bed), on_bed.history.theta.to_numpy()
    grows = np.diff(bed.plastic.sum(axis=1)) > 1e-9
    rocks = np.cumsum(np.diff(np.sign(theta)) != 0)
    assert on_bed.row["yielding_half_cycles"] == len(set(rocks[grows]))


@pytest.mark.slow
def test_a_footing_comes_to_rest_where_its_final_bed_carries_the_weight(on_bed):
    row = on_bed.row
    rise, theta = Replay(on_bed).at_rest()
    still = G / (on_bed.base.beta * PIER.p) ** 2
    assert row["theta_res_over_alpha"] * PIER.alpha == pytest.approx(theta, rel=0.03)
    assert row["settlement_m"] == pytest.approx(-rise - still, rel=0.03)
    for side, sign in (("left", -1.0), ("right", 1.0)):
        edge = row["settlement_m"] + sign * 0.5 * WIDTH * math.sin(row["theta_res_over_alpha"] * PIER.alpha)
        assert row[f"settlement_{side}_m"] == pytest.approx(edge, rel=1e-9)


# Sections


@pytest.mark.parametrize("height", [0.0, 10.0])
def test_forces_in_a_section_are_those_that_move_what_is_above_it(height):
    """By Newton and Euler, of the forces at the foot: along the tilted axis, across it, about the middle of the section."""
    response = rb.simulate(PIER, rb.RigidBase(), shaking(0.3), forces=True, sections=[height])
    table, history = response.forces, response.history
    theta, omega = (history[name].to_numpy() for name in ("theta", "omega"))
    shear, normal = (table[name].to_numpy() for name in ("base_shear", "normal_force"))
    across = shear * np.cos(theta) - normal * np.sin(theta)
    along = shear * np.sin(theta) + normal * np.cos(theta)
    at_foot = 0.5 * WIDTH * np.sign(table.base_moment.to_numpy()) * along
    turning = -(across * RISE + at_foot) / (SIZE**2 / 3.0)
    length, middle = 2.0 * RISE - height, 0.5 * height + RISE
    share, inertia = length / (2.0 * RISE), (length**2 + WIDTH**2) / 12.0
    of_part = across + (middle - RISE) * turning
    axial = share * (along - (middle - RISE) * omega**2)
    moment = np.abs(share * ((middle - height) * of_part + inertia * turning))
    stands = table.base_moment.to_numpy() != 0.0  # at rest both feet bear
    expected = {
        "shear": np.abs(share * of_part)[stands].max(),
        "moment": moment[stands].max(),
        "axial_least": axial[stands].min(),
        "axial_greatest": axial[stands].max(),
        "axial_at_moment": axial[stands][moment[stands].argmax()],
    }
    (row,) = response.sections.to_dict("records")
    for name, value in expected.items():
        over_mass = "m2_s2" if name == "moment" else "m_s2"
        assert row[f"section_{name}_{over_mass}"] == pytest.approx(value, rel=2e-3), name
        assert row[f"section_{name}_kN{'m' * (name == 'moment')}"] == pytest.approx(PIER.mass_t * value, rel=2e-3), name


# Errors: what a row changes by when the step is halved


BENT = replace(PIER, flexural_period_s=0.3)
SMALL = rb.Pier(alpha=0.2, p=2.0, gravity=G, mass_t=100.0)
SPRUNG = rb.YieldingBase(20.0, eta=2.0, restraints=(rb.Damper("viscous", nu=0.2),))
TOLERANCE = 1e-2


def with_half_the_steps(pier, base, motion, **outputs):
    """Return a run to the tolerance, and that with half its steps per sample."""
    fine = rb.simulate(pier, base, motion, tolerance=TOLERANCE, **outputs)
    return fine, rb.simulate(pier, base, motion, substeps=int(fine.row["substeps"]) // 2, **outputs)


def change(fine, coarse, name):
    return abs(fine.row[name] - coarse.row[name])


def greatest_change(fine, coarse, columns):
    """Return the greatest relative change of these columns."""
    return max(change(fine, coarse, name) / abs(fine.row[name]) for name in columns)


@pytest.mark.slow
def test_the_top_of_a_bending_shaft_goes_as_far_as_its_history_says():
    base = rb.RigidBase(shaft="elastic", flexural_modes=1)
    fine, coarse = with_half_the_steps(BENT, base, shaking(0.0))
    row, table = fine.row, fine.history
    seen = table.deflection.abs().max()
    assert seen * (1.0 - 1e-12) <= row["deflection_max_m"] <= 1.004 * seen
    drift = (2.0 * RISE * table.theta + table.deflection).abs().max()
    assert row["top_drift_m"] == pytest.approx(drift, rel=5e-3)
    assert row["deflection_error_m"] == pytest.approx(change(fine, coarse, "deflection_max_m"), rel=1e-6)
    assert row["top_drift_error_m"] == pytest.approx(change(fine, coarse, "top_drift_m"), rel=1e-6)


FORCES = (
    "base_shear_m_s2",
    "normal_force_m_s2",
    "friction_demand",
    "pivot_force_left",
    "pivot_force_right",
    "heel_gap_left_m",
    "heel_gap_right_m",
    "heel_speed_left_m_s",
    "heel_speed_right_m_s",
    "deck_acceleration_m_s2",
    "landing_velocity_m_s",
    "impulse_m_s",
    "impact_friction_demand",
    "omega_max_over_p",
    "base_moment_m2_s2",
)
OF_DAMPERS = "damper_force_over_weight", "damper_stroke_m", "damper_speed_m_s", "damper_energy_J_kg"


def test_errors_of_a_row_are_its_changes_when_the_step_is_halved():
    """Of residuals, twice the drift between two readings is added, here a period of rocking in full contact apart.

    Of forces and dampers it is four times the change.
    """
    fine, coarse = with_half_the_steps(SMALL, SPRUNG, shaking(0.0).times(0.5), forces=True, sections=[0.5])
    row = fine.row
    for name in ("theta_max", "theta_max_in_motion"):
        assert row[f"{name}_error"] == pytest.approx(change(fine, coarse, f"{name}_over_alpha"), rel=1e-6)
    assert row["forces_error"] == pytest.approx(4.0 * greatest_change(fine, coarse, FORCES), rel=1e-3)
    assert row["devices_error"] == pytest.approx(4.0 * greatest_change(fine, coarse, OF_DAMPERS), rel=1e-3)
    least_axial, greatest_axial = (f"section_axial_{end}_m_s2" for end in ("least", "greatest"))
    of_section = "section_shear_m_s2", "section_moment_m2_s2", least_axial, greatest_axial
    (own,), (other,) = (response.sections.to_dict("records") for response in (fine, coarse))
    changed = max(abs(own[name] / other[name] - 1.0) for name in of_section)
    assert own["sections_error"] == pytest.approx(4.0 * changed, rel=1e-2)
    seconds = (row["theta_res_error"] - change(fine, coarse, "theta_res_over_alpha")) / row["theta_res_drift_per_s"]
    b, h, k = SMALL.half_width, SMALL.height, 0.5 * (SPRUNG.beta * SMALL.p) ** 2
    rocking = math.sqrt((2.0 * k * b**2 - G * h) / (SMALL.size**2 / 3.0 + h**2))
    assert seconds == pytest.approx(2.0 * math.ceil(2.0 * math.pi / rocking / STEP) * STEP, rel=1e-6)
    of_settlement = change(fine, coarse, "settlement_m") + row["settlement_drift_m_s"] * seconds
    assert row["settlement_error_m"] == pytest.approx(of_settlement, rel=1e-9)


@pytest.mark.slow
def test_errors_on_a_bed_are_four_times_the_changes_by_step_and_strips(on_bed):
    """Those of the greatest push and pressure have (0.1)²/8 of them, too, which readings at the ends of steps may miss."""
    fine = rb.simulate(PIER, on_bed.base, shaking(0.2), tolerance=TOLERANCE)
    steps = {"substeps": int(fine.row["substeps"]) // 2}
    coarse = rb.simulate(PIER, on_bed.base, shaking(0.2), **steps)
    fewer = rb.simulate(PIER, replace(on_bed.base, strips=STRIPS // 2), shaking(0.2), **steps)
    row = fine.row
    for name, error, missed in (
        ("bed_force_over_weight", "bed_force_error", 0.00125),
        ("bed_pressure_MPa", "bed_pressure_error_MPa", 0.00125),
        ("bed_work_J_kg", "bed_work_error_J_kg", 0.0),
    ):
        changes = 4.0 * (change(fine, coarse, name) + change(coarse, fewer, name))
        assert row[error] == pytest.approx(changes + missed * row[name], rel=1e-6), name
    of_strips = 4.0 * change(coarse, fewer, "theta_max_over_alpha")
    assert of_strips * (1.0 - 1e-6) <= row["strips_error"] <= row["theta_max_error"]
    edges = row["settlement_error_m"] + 0.5 * WIDTH * PIER.alpha * row["theta_res_error"]
    assert row["edge_settlement_error_m"] == pytest.approx(edges, rel=1e-9)


# Parts of a peak, other laws, mirror images, chaos


PULSE = SINE | {"amplitude_g": 0.4, "period_s": 0.9, "dt_s": 0.005, "duration_s": 3.0}
SOFT = {"name": "soft", "base": "yielding", "beta": 40.0, "eta": 1.8, "zeta": 0.05}
PADS = rb.YieldingBase(40.0, eta=1.8, zeta=0.05)


def table_of(folder, cases, motions=None, **output):
    return rb.run(write_study(folder, study_text(pulses=(PULSE,), motions=motions, cases=cases, output=output)))


def apart(table):
    """Return the greatest rocking, the lean at the peak and the peak, over α, of a pier on PADS.

    It rests where two springs of k = (β p)²/2, shorter by what has yielded, and the moment g h θ of its weight balance. A support
    that is left keeps its place.
    """
    k, most = 0.5 * 40.0**2, 1.8 * G / 40.0**2
    left, right = (
        (table[f"v_{side}"] - most * table[f"z_{side}"]).where(table[f"force_{side}"] < 0.0).ffill()
        for side in ("left", "right")
    )
    rest = (left - right) / WIDTH / (1.0 - G * RISE / (0.5 * k * WIDTH**2))
    peak = table.theta.abs().idxmax()
    return [
        x / 0.2
        for x in ((table.theta - rest).abs().max(), rest[peak] * np.sign(table.theta[peak]), abs(table.theta[peak]))
    ]


def test_rocking_is_about_the_rotation_at_which_yielded_springs_would_carry_the_pier(tmp_path):
    row = table_of(tmp_path, (SOFT,), rocking=True).iloc[0]
    motion = rb.pulse("sine", name="one-sine", amplitude=0.4 * 9.81, period=0.9, dt=0.005, duration=3.0)
    steps = int(row["substeps"])
    (rocking, lean, peak), (coarser_rocking, coarser_lean, _) = (
        apart(rb.simulate(rb.Pier(0.2, 1.0), PADS, motion, substeps=n).history) for n in (steps, steps // 2)
    )
    assert rocking * (1.0 - 1e-12) <= row["theta_rocking_over_alpha"] <= 1.004 * rocking
    assert row["theta_lean_over_alpha"] == pytest.approx(lean, rel=1e-9)
    assert row["theta_rocking_error"] == pytest.approx(abs(rocking - coarser_rocking), rel=0.1)
    assert row["theta_lean_error"] == pytest.approx(abs(lean - coarser_lean), rel=1e-3)
    assert (row["theta_max_is"] == "lean") == (lean >= 0.5 * peak and peak - lean < 0.5 * rocking)


def test_the_settlement_by_the_other_law_is_that_of_springs_of_this_law(tmp_path):
    both = table_of(tmp_path, (SOFT,), both_laws=True).iloc[0]
    other = table_of(tmp_path, (SOFT | {"spring": "epp"},)).iloc[0]
    assert both["settlement_other_law_m"] == pytest.approx(other["settlement_m"], rel=1e-12)
    assert abs(both["settlement_other_law_m"] / both["settlement_m"] - 1.0) > 0.01


def test_rows_of_the_other_polarity_are_runs_of_the_reversed_motion(tmp_path):
    table = table_of(tmp_path, (SOFT,), {"polarity": ["+", "-"]})
    assert table["mirror_of"].tolist() == ["", "+"]
    motion = rb.pulse("sine", name="one-sine", amplitude=-0.4 * 9.81, period=0.9, dt=0.005, duration=3.0)
    own, mirror = rb.simulate(rb.Pier(0.2, 1.0), PADS, motion).row, table.iloc[1]
    numbers = {name: value for name, value in own.items() if isinstance(value, float)}
    assert len(numbers) > 20
    assert mirror[list(numbers)].to_dict() == pytest.approx(numbers, rel=1e-9, abs=1e-14, nan_ok=True)
    assert own["ductility_left"] == pytest.approx(table.iloc[0]["ductility_right"], rel=1e-9)
    assert own["theta_res_over_alpha"] == pytest.approx(-table.iloc[0]["theta_res_over_alpha"], rel=1e-9)


@pytest.mark.slow
def test_a_pier_may_overturn_where_a_motion_stronger_by_a_part_in_1e8_overturns_it():
    """Its peak is chaotic then, and that of a motion weaker by a hundredth is not."""
    rng, t = np.random.default_rng(3), np.arange(0.0, 20.0, 0.01)
    waves = [np.sin(2.0 * np.pi * f * t + rng.uniform(0.0, 6.0)) for f in rng.uniform(0.3, 3.0, 12)]
    wave = sum(waves) * np.minimum(1.0, (20.0 - t) / 5.0)

    def under(amplitude):
        return rb.simulate(rb.Pier(0.2, 2.5), rb.RigidBase(), Motion("noise", 0.01, amplitude * wave, None)).row

    low, high = 0.33, 0.34
    while high / low - 1.0 > 4e-9:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if under(middle)["status"] == "overturned" else (middle, high)
    flags = ["status", "chaotic", "may_overturn"]
    assert under(low)[flags].tolist() == ["ok", 1, 1]
    assert math.isnan(under(low)["theta_max_error"])
    assert under(0.99 * low)[flags].tolist() == ["ok", 0, 0]


# All columns


LEDGER = "kinetic", "potential", "elastic", "input", "plastic", "impact", "p_delta", "constraint", "damping"
ELSEWHERE = {
    "beyond_linearised": "verification/test_large_rotations.py",
    "still_rocks": "simulation/test_still_rocks.py",
    "landing_force_kN": "simulation/test_landing_force.py",
    "failure": "simulation/test_error_control.py",
    "note": "simulation/test_error_control.py",
}
"""Columns that other tests hold to values of their own."""
NAMED = (
    ("{side}", ("left", "right")),
    ("{kind}", ("damper", "stop")),
    ("{what}", ("ductility", "dissipated")),
    ("{term}", LEDGER),
    ("{name}", ("theta_max", "theta_max_in_motion")),
    ("{unit}", ("", "_J_kg")),
)
"""Parts of names that tests put together."""


def recomputed_here():
    """Return the columns that these two files ask for by name, in `row["..."]` or as a key of a table of functions."""
    here = Path(__file__)
    texts = (path.read_text(encoding="utf-8") for path in (here, here.with_name("test_columns_recomputed.py")))
    source = "".join(text.partition("\n# All columns\n")[0] for text in texts)
    names = set(re.findall(r'"([\w{}]+)"', source))
    for part, words in NAMED:
        names |= {name.replace(part, word) for name in names if part in name for word in words}
    return names


def test_every_column_of_the_table_of_peaks_is_computed_again_in_some_test():
    unnamed = COLUMNS.keys() - recomputed_here() - ELSEWHERE.keys()
    assert not unnamed
    assert not ELSEWHERE.keys() & recomputed_here()
    for name, test in ELSEWHERE.items():
        assert name.removesuffix("_kN") in (Path(__file__).parents[1] / test).read_text(encoding="utf-8")
