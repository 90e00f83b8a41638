"""Numbers of a row, computed again from the tables of its histories by other code.

The tables have the samples and events of a run, so that a greatest value between two samples may be larger, and never smaller.
"""

import numpy as np
import pytest

import rockbatch as rb

G = 9.81
PIER = rb.Pier(alpha=0.2, p=1.0, gravity=G, mass_t=1000.0)
DEVICES = (
    rb.Damper("viscous", nu=0.2),
    rb.Tendon(psi=0.1, lam=0.5),
    rb.Stop(0.02, 20.0, 0.6),
    rb.DeckSpring(0.3, gap_m=0.01),
)
BASES = {
    "rigid": rb.RigidBase(restraints=DEVICES),
    "elastic": rb.ElasticBase(50.0, epsilon=0.2, restraints=DEVICES),
    "yielding": rb.YieldingBase(50.0, eta=2.5, restraints=DEVICES),
}
TERMS = ("kinetic", "potential", "elastic", "input", "plastic", "impact", "p_delta", "constraint", "damping")


@pytest.fixture(scope="module", params=BASES)
def response(request):
    motion = rb.pulse("sine", name="pulse", amplitude=0.5 * G, period=0.8, dt=0.005, duration=3.0)
    return rb.simulate(PIER, BASES[request.param], motion, substeps=4, quiet_s=0.0, forces=True, ledger=True)


def greatest(table, *columns):
    """Return the greatest magnitude in these columns."""
    return max(np.nanmax(np.abs(table[name])) for name in columns)


def of_devices(response, kind, what):
    """Return the greatest magnitude of a kind of devices, by the end of the names of their columns."""
    return greatest(response.restraints, *(c for c in response.restraints if c.startswith(kind) and c.endswith(what)))


def worked(response, kind):
    """Return the work done on a kind of devices, by trapezoids."""
    table = response.restraints
    forces = [name for name in table if name.startswith(kind) and name.endswith("force")]
    paths = [name.removesuffix("force") + "elongation" for name in forces]
    return sum(np.trapezoid(table[force], table[path]) for force, path in zip(forces, paths, strict=True))


def first_uplift(response):
    """Return the time at which a pivot first leaves the ground."""
    return response.events.t[response.events.kind.isin(["separation", "lift-off"])].min()


GREATEST = {
    "theta_max_over_alpha": lambda r: greatest(r.history, "theta") / PIER.alpha,
    "omega_max_over_p": lambda r: greatest(r.history, "omega") / PIER.p,
    "normal_force_m_s2": lambda r: greatest(r.forces, "normal_force"),
    "normal_force_kN": lambda r: greatest(r.forces, "normal_force") * PIER.mass_t,
    "base_shear_m_s2": lambda r: greatest(r.forces, "base_shear"),
    "base_shear_kN": lambda r: greatest(r.forces, "base_shear") * PIER.mass_t,
    "base_moment_m2_s2": lambda r: greatest(r.forces, "base_moment"),
    "base_moment_kNm": lambda r: greatest(r.forces, "base_moment") * PIER.mass_t,
    "deck_acceleration_m_s2": lambda r: greatest(r.forces, "deck_acceleration"),
    "pivot_force_left": lambda r: greatest(r.forces, "pivot_left"),
    "pivot_force_right": lambda r: greatest(r.forces, "pivot_right"),
    "pivot_force_left_kN": lambda r: greatest(r.forces, "pivot_left") * 0.5 * PIER.mass_t * G,
    "pivot_force_right_kN": lambda r: greatest(r.forces, "pivot_right") * 0.5 * PIER.mass_t * G,
    "heel_gap_left_m": lambda r: r.forces.heel_gap_left.max(),
    "heel_gap_right_m": lambda r: r.forces.heel_gap_right.max(),
    "heel_speed_left_m_s": lambda r: greatest(r.forces, "heel_speed_left"),
    "heel_speed_right_m_s": lambda r: greatest(r.forces, "heel_speed_right"),
    "damper_force_over_weight": lambda r: of_devices(r, "damper", "force") / G,
    "damper_force_kN": lambda r: of_devices(r, "damper", "force") * PIER.mass_t,
    "tendon_force_over_weight": lambda r: of_devices(r, "tendon", "force") / G,
    "tendon_force_kN": lambda r: of_devices(r, "tendon", "force") * PIER.mass_t,
    "stop_force_over_weight": lambda r: of_devices(r, "stop", "force") / G,
    "stop_force_kN": lambda r: of_devices(r, "stop", "force") * PIER.mass_t,
    "deck_spring_force_over_weight": lambda r: of_devices(r, "deck spring", "force") / G,
    "deck_spring_force_kN": lambda r: of_devices(r, "deck spring", "force") * PIER.mass_t,
}
"""Greatest values, which may lie between two rows of the tables."""

EXACT = {
    **{f"energy_{term}_J_kg": lambda r, term=term: r.ledger[term].iloc[-1] for term in TERMS},
    "landing_velocity_m_s": lambda r: greatest(r.impacts, "landing_velocity"),
    "impulse_m_s": lambda r: greatest(r.impacts, "impulse_vertical"),
    "impulse_kN_s": lambda r: greatest(r.impacts, "impulse_vertical") * PIER.mass_t,
    "impacts": lambda r: (r.events.kind == "impact").sum(),
    "first_uplift_s": first_uplift,
    "first_uplift_g": lambda r: abs(np.interp(first_uplift(r), r.history.t, r.history.ag_h)) / G,
    "t_end_s": lambda r: r.history.t.iloc[-1],
}


def test_greatest_values_of_a_row_are_those_of_its_tables(response):
    for name, recomputed in GREATEST.items():
        seen = recomputed(response)
        assert seen * (1.0 - 1e-12) <= response.row[name] <= 1.004 * seen, name


def test_ends_counts_and_instants_of_a_row_are_those_of_its_tables(response):
    assert {name: response.row[name] for name in EXACT} == pytest.approx(
        {name: recomputed(response) for name, recomputed in EXACT.items()}, rel=1e-9, abs=1e-14
    )
    rows = response.history
    assert response.row["t_max_s"] == pytest.approx(rows.t[rows.theta.abs().idxmax()], abs=0.005)
    assert response.row["energy_remainder_J_kg"] >= response.ledger.remainder.abs().max() * (1.0 - 1e-9)


def test_dampers_take_what_is_worked_on_them(response):
    assert response.row["damper_energy_J_kg"] == pytest.approx(worked(response, "damper"), rel=5e-3)
