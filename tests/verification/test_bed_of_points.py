"""Columns of a footing's bed within their claimed errors of those of a bed of many points (tests/helpers/bed_of_points.py)."""

import math

import bed_of_points
import numpy as np
import pytest

import rockbatch as rb

G, DT = 9.81, 0.01
PIER = rb.Pier(alpha=0.3, p=1.0, mass_t=1000.0)
LENGTH = 5.0
CASES = {
    "two rocks that yield": (rb.FootingBase(25.0, 2.0, 0.05, "first-order", length_m=LENGTH), 0.9, 0.0),
    "barely at its edges": (rb.FootingBase(25.0, 6.0, 0.05, "first-order", length_m=LENGTH), 0.8, 0.0),
    "weak, shaken up and down": (rb.FootingBase(25.0, 1.5, 0.2, "first-order", length_m=LENGTH), 0.35, 0.4),
    "strong": (rb.FootingBase(20.0, 10.0, 0.05, "finite", length_m=LENGTH), 1.0, 0.3),
}


def shaking(strength, vertical):
    """One sine of 0.8 s, with a vertical one of 0.25 s, in parts of g; 3 s of rest."""
    t = np.arange(0.0, 4.0, DT)
    up = vertical * G * np.sin(2.0 * np.pi * t / 0.25) if vertical else 0.0 * t
    return rb.Motion("sine", DT, strength * G * np.sin(2.0 * np.pi * t / 0.8) * (t < 0.8), up * (t < 1.0))


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(name, marks=[pytest.mark.slow] * (each[0].kinematics == "finite")) for name, each in CASES.items()
    ],
)
def both(request):
    base, strength, vertical = CASES[request.param]
    motion = shaking(strength, vertical)
    row = rb.simulate(PIER, base, motion, forces=True, quiet_s=0.0).row
    bed = bed_of_points.Bed(
        PIER.half_width,
        PIER.height,
        PIER.inertia,
        G,
        base.beta * PIER.p,
        base.safety_factor,
        base.zeta,
        base.kinematics == "finite",
    )
    steps = math.ceil(bed.omega_v * DT / 0.04)
    return row, bed, *bed_of_points.follow(bed, motion.horizontal, motion.vertical, DT, steps)


def test_demands_on_a_bed_are_those_of_points_within_their_errors(both):
    """And 0.1 % for the points, whose edges are half of one away."""
    row, bed, most, _ = both
    assert row["status"] == "ok"
    times = PIER.mass_t / (2.0 * bed.half_width * LENGTH) / 1000.0
    for name, error, expected in (
        ("theta_max_over_alpha", "theta_max_error", most["theta_max"] / PIER.alpha),
        ("bed_force_over_weight", "bed_force_error", most["push"] / G),
        ("bed_pressure_MPa", "bed_pressure_error_MPa", most["edge"] * times),
        ("bed_work_J_kg", "bed_work_error_J_kg", most["work"]),
    ):
        assert row[name] == pytest.approx(expected, abs=row[error] + 1e-3 * expected), name
    assert row["base_shear_m_s2"] == pytest.approx(most["shear"], rel=row["forces_error"] + 1e-3)
    assert row["contact_least"] == pytest.approx(most["contact_least"], abs=0.01)
    assert row["yielding_half_cycles"] == most["half_cycles"]


def test_a_footing_rests_as_on_points_within_its_errors(both):
    row, bed, _, sets = both
    x = bed.places[:-2]
    theta, v = bed_of_points.at_rest(bed, sets, (sets[:-2] @ x) / (x @ x))
    assert row["theta_res_over_alpha"] == pytest.approx(theta / PIER.alpha, abs=row["theta_res_error"] + 1e-6)
    depths = bed_of_points.sunk(bed, v, theta)[0] - G / bed.omega_v**2
    for side, depth in (("left", depths[-2]), ("right", depths[-1])):
        assert row[f"settlement_{side}_m"] == pytest.approx(depth, abs=row["edge_settlement_error_m"] + 1e-6)
