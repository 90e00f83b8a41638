"""Numbers of a row, computed again from the tables of its histories by other code.

The tables have the samples and events of a run, so that a greatest value between two samples may be larger, and never smaller.
"""

import numpy as np
import pandas as pd
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
    return rb.simulate(
        PIER, BASES[request.param], motion, substeps=4, quiet_s=0.0, forces=True, ledger=True, devices_work=True
    )


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


def of_places(response, kind):
    """Return elongation and force of each place of a kind of devices, shape (n,) each."""
    table = response.restraints
    names = [name.removesuffix(" force") for name in table if name.startswith(kind) and name.endswith("force")]
    return [(table[f"{name} elongation"].to_numpy(), table[f"{name} force"].to_numpy()) for name in names]


def deepest(response, kind, gap):
    """Return how far a kind of devices is deflected beyond its gap [m]."""
    return max(elongation.max() for elongation, _ in of_places(response, kind)) - gap


def closed(response, kind, gap):
    """Return how often gaps of a kind of devices close."""
    beyond = [elongation > gap for elongation, _ in of_places(response, kind)]
    return sum(int(its[0]) + int((~its[:-1] & its[1:]).sum()) for its in beyond)


def fastest(response, kind):
    """Return the greatest mean speed of a kind of devices between two rows [m/s]."""
    t = response.restraints.t.to_numpy()
    apart = np.diff(t) > 1e-6
    return max(
        np.abs(np.diff(elongation)[apart] / np.diff(t)[apart]).max() for elongation, _ in of_places(response, kind)
    )


def friction(forces):
    """Return the greatest V/N where N is above a tenth of the weight, also between rows, on straight lines."""
    rows = np.linspace(0, len(forces) - 1, 100 * len(forces))
    shear, normal = (np.interp(rows, np.arange(len(forces)), forces[name]) for name in ("base_shear", "normal_force"))
    return np.abs(shear / normal)[normal > 0.1 * G].max()


def left_the_ground(response):
    """Return how often a pivot of a pier on springs left its support, which every landing needs; on rigid ground lift-offs.

    A pivot that bounces leaves in the instant of its landing, which is one event.
    """
    events = response.events
    if isinstance(response.base, rb.RigidBase):
        return (events.kind == "lift-off").sum()
    moves = events[events.kind.isin(["separation", "impact"])]
    return (moves.kind == "impact").sum() + (moves.groupby("pivot").kind.last() == "separation").sum()


def slack(response):
    """Return how often the tendon goes slack."""
    ((_, force),) = of_places(response, "tendon")
    return ((force[:-1] > 0.0) & (force[1:] == 0.0)).sum()


def pushed(response, side):
    """Return the greatest deflection of a support over that at yield, η g/(β p)²."""
    base = response.base
    return greatest(response.history, f"v_{side}") / (base.eta * G / (base.beta * PIER.p) ** 2)


def first_uplift(response):
    """Return the time at which a pivot first leaves the ground."""
    return response.events.t[response.events.kind.isin(["separation", "lift-off"])].min()


SIZE = 0.75 * G / PIER.p**2
"""Distance of the centre from a pivot [m]."""

GREATEST = {
    "top_drift_m": lambda r: 2.0 * SIZE * np.cos(PIER.alpha) * greatest(r.history, "theta"),
    "heel_uplift_m": lambda r: 2.0 * SIZE * np.sin(PIER.alpha) * greatest(r.history, "theta"),
    "theta_max_in_motion_over_alpha": lambda r: greatest(r.history[r.history.t <= 3.0], "theta") / PIER.alpha,
    "damper_stroke_m": lambda r: of_devices(r, "damper", "elongation"),
    "stop_deflection_m": lambda r: deepest(r, "stop", 0.02),
    "deck_spring_deflection_m": lambda r: deepest(r, "deck spring", 0.01),
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
    "pga_g": lambda r: greatest(r.history, "ag_h") / G,
    "drift_height_m": lambda r: 2.0 * SIZE * np.cos(PIER.alpha),
    "separations": left_the_ground,
    "impact_friction_demand": lambda r: (r.impacts.impulse_horizontal.abs() / r.impacts.impulse_vertical).max(),
    "stop_blows": lambda r: closed(r, "stop", 0.02),
    "deck_spring_blows": lambda r: closed(r, "deck spring", 0.01),
    "tendon_slack": slack,
    "damper_work_kJ": lambda r: PIER.mass_t * r.row["damper_work_J_kg"],
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


def test_dampers_and_stops_take_what_is_worked_on_them(response):
    """A deck spring gives back what it takes."""
    for kind in ("damper", "stop"):
        assert response.row[f"{kind}_energy_J_kg"] == pytest.approx(worked(response, kind), rel=2e-2), kind
    assert response.row["deck_spring_energy_J_kg"] == 0.0
    places = of_places(response, "damper")
    most = max(np.trapezoid(force, elongation) for elongation, force in places)
    assert response.row["damper_work_J_kg"] == pytest.approx(most, rel=5e-3)
    travel = max(np.abs(np.diff(elongation)).sum() for elongation, _ in places)
    assert travel * (1.0 - 1e-12) <= response.row["damper_travel_m"] <= 1.004 * travel
    speed = fastest(response, "damper")
    assert speed * (1.0 - 1e-9) <= response.row["damper_speed_m_s"] <= 1.05 * speed


def test_friction_is_asked_for_where_the_base_is_pressed(response):
    assert response.row["friction_demand"] == pytest.approx(friction(response.forces), rel=0.02)


YIELDED = {
    f"{what}_{side}{unit}" for what, unit in (("ductility", ""), ("dissipated", "_J_kg")) for side in ("left", "right")
}
YIELDED |= {"residual_s", "theta_res_drift_per_s", "settlement_drift_m_s"}


def test_supports_yield_as_far_as_their_history_goes(response):
    """Plastic work is that of the balance; of each support, what is worked on it less what it stores, f²/2k."""
    row, base, history = response.row, response.base, response.history
    if not isinstance(base, rb.YieldingBase):
        assert all(pd.isna(row[name]) for name in YIELDED)
        return
    stiffness = 0.5 * (base.beta * PIER.p) ** 2
    for side in ("left", "right"):
        seen = pushed(response, side)
        assert seen * (1.0 - 1e-12) <= row[f"ductility_{side}"] <= 1.004 * seen
        way, force = history[f"v_{side}"], history[f"force_{side}"]
        stored = (force.iloc[-1] ** 2 - force.iloc[0] ** 2) / (2.0 * stiffness)
        lost = np.trapezoid(force, way) - stored
        assert row[f"dissipated_{side}_J_kg"] == pytest.approx(lost, rel=2e-3)
    plastic = row["dissipated_left_J_kg"] + row["dissipated_right_J_kg"]
    assert plastic == pytest.approx(row["energy_plastic_J_kg"], rel=1e-6)


def test_residuals_are_what_supports_do_not_spring_back_after_the_last_landing(response):
    """Deflections less f/k of each support, and the mean rotation of the vibration that goes on; none of a pier that stands."""
    row, base, history = response.row, response.base, response.history
    if isinstance(base, rb.RigidBase):
        assert all(pd.isna(row[name]) for name in ("theta_res_over_alpha", "settlement_m", "base_tilt_rad"))
        return
    stiffness = 0.5 * (base.beta * PIER.p) ** 2
    left, right = (history[f"v_{side}"] - history[f"force_{side}"] / stiffness for side in ("left", "right"))
    if not isinstance(base, rb.YieldingBase):
        for side, deflection in (("left", left), ("right", right)):
            assert np.abs(deflection[history[f"force_{side}"] < 0.0]).max() < 1e-12
        assert (row["settlement_m"], row["base_tilt_rad"]) == pytest.approx((0.0, 0.0), abs=1e-12)
        return
    assert response.impacts.t.max() < row["residual_s"] <= row["t_end_s"]
    read = (history.t - row["residual_s"]).abs().idxmin()
    assert row["settlement_m"] == pytest.approx(-0.5 * (left[read] + right[read]), rel=1e-3)
    assert row["base_tilt_rad"] == pytest.approx(
        (left[read] - right[read]) / (2.0 * SIZE * np.sin(PIER.alpha)), rel=0.03
    )
    rest = history[history.t > response.impacts.t.max()].theta
    assert row["theta_res_over_alpha"] * PIER.alpha == pytest.approx(rest.mean(), rel=0.1)


def test_a_row_names_the_run_as_it_was_asked_for(response):
    named = {
        "record": "pulse",
        "station": "pulse",
        "case": response.base.name,
        "polarity": "+",
        "scale": 1.0,
        "substeps": 4,
    }
    assert {name: response.row[name] for name in named} == named
    assert (response.row["status"], response.row["reason"]) == ("ok", "")
