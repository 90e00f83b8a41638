"""Work of devices: rainflow counting by the standard's example, closed forms, SciPy's DOP853 and quadrature, energy balances."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from core_samples import FIG5, broadband, pulse
from restrained_reference import TiedTwoSprings
from scipy.integrate import quad
from studies import SINE, study_text, write_study

import rockbatch as rb
from rockbatch.checks import read_verdicts
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, PASS
from rockbatch.common.errors import InputError
from rockbatch.common.units import GRAVITY
from rockbatch.motions.motion import Motion
from rockbatch.observers.devices_work.observe import greatest_of
from rockbatch.outcome.device_work import Courses, rainflow, with_turns, work_of
from rockbatch.pier import Damper, ElasticBase, RigidBase, Tendon, YieldingBase, places
from rockbatch.simulation.restraints import device_histories, device_work
from rockbatch.simulation.runs import Run, written_run

PADS = YieldingBase(50.0, 0.3, eta=3.0, flight="guided")
PER_LAMBDA = GRAVITY * FIG5.size / FIG5.half_width**2
SHAKEN = pulse("sine", 0.5, 1.0, dt=0.01, end=2.0)


def test_rainflow_counts_the_example_of_the_standard():
    """ASTM E1049-85, fig. 6: half cycles of the ranges 3, 6, 9 once, of 8 twice, of 4 three times."""
    ranges, counts = rainflow([-2, 1, -3, 5, -1, 3, -4, 4, -2])
    assert {width: counts[ranges == width].sum() for width in set(ranges)} == {3.0: 1, 4.0: 3, 6.0: 1, 8.0: 2, 9.0: 1}


@pytest.mark.parametrize("brace", [math.inf, 2.0])
def test_a_damper_turns_between_rows_where_its_speed_changes_sign(brace):
    """Travel of a sine over two periods, by 15 rows: 8 amplitudes within 10⁻³, where the rows alone lose 2 %."""
    t = np.linspace(0.3, 0.3 + 4.0 * math.pi, 15)
    way, speed = np.sin(t), np.cos(t)
    assert np.abs(np.diff(way)).sum() < 0.98 * 8.0
    assert np.abs(np.diff(with_turns(t, way, speed))).sum() == pytest.approx(8.0, rel=1e-3)
    pull = speed[:, None]
    base = RigidBase(restraints=(Damper("viscous", nu=1.0, at=0.0, brace=brace),))
    work = work_of(FIG5, base, Courses(way[:, None] + pull / (brace * PER_LAMBDA), pull, None, t, pull), 1.99)
    assert work.travel[0] == pytest.approx(8.0, rel=1e-3)
    assert work.half_cycles[0] == 3.0  # from end to end; by rows no swing is as long


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("seed", range(4))
def test_a_turn_at_an_end_but_for_rounding_is_at_that_end(seed):
    """As a block leaves or comes to rest: the zero of the rate is at an end, where its speed has the other sign by rounding."""
    rng = np.random.default_rng(seed)
    for _ in range(2000):
        h, speed, rounding = (
            10.0 ** rng.uniform(-6.0, -2.0),
            10.0 ** rng.uniform(-6.0, -1.0),
            10.0 ** rng.uniform(-22.0, -12.0),
        )
        travel = h * speed * rng.uniform(0.35, 0.7)  # below a third it turns on its way, too
        way, rates = np.array([0.0, travel]), np.array([speed, -rounding * speed])
        if rng.random() < 0.5:
            way, rates = way[::-1], -rates[::-1]
        turned = with_turns(np.array([0.0, h]), way, rates)
        assert len(turned) == 3
        assert turned[1] == pytest.approx(travel, rel=1e-9)
    t, rest = np.array([0.0, 1.1128475e-4]), 2.303389988472216e-08
    ends = np.array([4.139516324019473e-4, -7.25060202849681e-20])
    np.testing.assert_allclose(with_turns(t, np.array([0.0, rest]), ends), [0.0, rest, rest], rtol=1e-9)


def test_a_tendon_is_strained_most_between_rows_where_it_turns():
    """A cubic errs by h⁴/384 of it; the rows alone miss 4 %."""
    t = np.linspace(0.3, 0.3 + 4.0 * math.pi, 17)
    base, way, speed = RigidBase(restraints=(Tendon(psi=0.1, lam=0.5, strength=2.0),)), np.sin(t), np.cos(t)
    courses = Courses(way[:, None], way[:, None], None, t, speed[:, None])
    exact = (0.1 * GRAVITY + 0.5 * PER_LAMBDA) / (2.0 * GRAVITY)
    assert work_of(FIG5, base, courses, 0.01).strain[0] == pytest.approx(exact, rel=(math.pi / 4.0) ** 4 / 384.0)
    assert way.max() < 0.96


def test_the_speed_of_a_braced_damper_is_the_rate_of_its_own_way():
    dampers = Damper("viscous", nu=0.3, brace=2.0), Damper("hysteretic", f=0.1, yield_m=0.005, brace=50.0, at="left")
    base = RigidBase(restraints=dampers)
    result, rows = written_run(Run(FIG5, base, SHAKEN), 20, 0.0, 100_000, every_step=True, wait=False)
    rows = rows[: result.rows].view(np.recarray)
    found = device_histories(FIG5, base, rows)
    braces = PER_LAMBDA * np.array([device.brace for device in dampers for _ in places(FIG5, device)])
    way, step = found.elongation - found.pull / braces, np.diff(rows.t)
    even = np.flatnonzero((np.abs(step[1:] - step[:-1]) < 1e-12) & (step[1:] > 1e-5) & (rows.kind[1:-1] <= 0.0)) + 1
    rate = _rates(way, rows.t, even)
    assert len(even) > 1000
    for own, all_of_it, expected in zip(
        found.speed[even].T, _rates(found.elongation, rows.t, even).T, rate.T, strict=True
    ):
        most = np.abs(expected).max()
        assert np.abs(own - expected).max() < 2e-3 * most
        assert np.abs(all_of_it - expected).max() > 2e-2 * most  # with the brace it is another


def _rates(values, t, places_):
    return (values[places_ + 1] - values[places_ - 1]) / (t[places_ + 1] - t[places_ - 1])[:, None]


def test_a_jump_of_the_speed_at_an_event_is_no_turn():
    t, way, speed = np.array([0.0, 1.0, 1.0, 2.0]), np.array([0.0, 1.0, 1.0, 0.0]), np.array([1.0, 1.0, -1.0, -1.0])
    np.testing.assert_array_equal(with_turns(t, way, speed), way)


def test_rainflow_does_not_depend_on_points_between_reversals_nor_on_pauses():
    turns = [-2, 1, -3, 5, -1, 3, -4, 4, -2]
    fine = np.interp(np.linspace(0.0, 8.0, 801), np.arange(9.0), turns)
    assert sorted(zip(*rainflow(np.repeat(fine, 2)), strict=True)) == sorted(zip(*rainflow(turns), strict=True))
    assert [list(part) for part in rainflow([1.0, 1.0])] == [[], []]
    assert [list(part) for part in rainflow([0.0, 1.0, 3.0])] == [[3.0], [1.0]]


def test_work_of_a_viscous_damper_a_harmonic_cycle_is_pi_c_omega_a_squared():
    c, omega, a, cycles = 3.0, 2.0, 0.05, 4
    t = np.linspace(0.0, cycles * 2.0 * math.pi / omega, 40_001)
    stroke, speed = a * np.sin(omega * t), a * omega * np.cos(omega * t)
    base = RigidBase(restraints=(Damper("viscous", nu=1.0, at="left"),))
    work = work_of(FIG5, base, Courses(stroke[:, None], c * speed[:, None]), 0.09)
    assert work.lost[0] == pytest.approx(cycles * math.pi * c * omega * a * a, rel=1e-7)
    assert work.travel[0] == pytest.approx(cycles * 4.0 * a, rel=1e-7)
    assert work.half_cycles[0] == 2 * cycles - 1  # of 2 a; the first and the last quarter are half cycles of a
    assert work_of(FIG5, base, Courses(stroke[:, None], c * speed[:, None]), 0.11).half_cycles[0] == 0


def test_travel_of_one_way_is_the_stroke_and_a_brace_takes_its_share():
    braced = RigidBase(restraints=(Damper("viscous", nu=1.0, at="left", brace=2.0),))
    way, pull = np.linspace(0.0, 0.3, 7)[:, None], np.linspace(0.0, 0.5, 7)[:, None]
    assert work_of(FIG5, braced, Courses(way, pull), 0.01).travel[0] == pytest.approx(
        0.3 - 0.5 / (2.0 * GRAVITY * FIG5.size / FIG5.half_width**2)
    )


class Working(TiedTwoSprings):
    """The reference, with travel and work of its devices by quadrature of its dense output."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.travel, self.work = (np.zeros(len(self.elements)) for _ in range(2))
        turning = self.leg._turning

        def integrated(dense, times, states, theta, omega):
            turning(dense, times, states, theta, omega)
            for j in range(len(self.elements)):
                for a, b in pairwise(times):
                    self.travel[j] += abs(self.elongation(j, dense(b)) - self.elongation(j, dense(a)))
                self.work[j] += quad(
                    lambda t, j=j: self.pull(j, dense(t).tolist()) * self.speed(j, dense(t)), times[0], times[-1]
                )[0]

        self.leg._turning = integrated


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize(
    "device",
    [
        Damper("viscous", nu=1.0, at="left"),
        Damper("hysteretic", f=0.1, yield_m=0.005, at="right"),
        Damper("friction", f=0.05, at=0.3),
    ],
    ids=["viscous", "hysteretic", "friction"],
)
def test_travel_and_work_are_those_of_the_reference(device):
    base = replace(PADS, restraints=(device,))
    expected = Working(FIG5, base, SHAKEN, 0.0)
    expected.run()
    result, rows = written_run(Run(FIG5, base, SHAKEN), 8, 0.0, 100_000, every_step=True, wait=False)
    found = greatest_of(FIG5, base, device_work(FIG5, base, rows[: result.rows].view(np.recarray), 0.01))
    assert found.damper_travel == pytest.approx(expected.travel[0], rel=1e-4)
    assert found.damper_work == pytest.approx(expected.work[0], rel=1e-4)
    if device.kind == "friction":
        assert found.damper_work == pytest.approx(device.f * GRAVITY * found.damper_travel, rel=1e-4)


def test_friction_takes_all_the_energy_of_a_block_that_impacts_do_not_slow():
    """Let go at θ0 with e = 1 the block has g R (cos(α − θ0) − cos α) to lose; by hand it slides that over f g."""
    start, f = 0.5 * FIG5.alpha, 0.02
    base = RigidBase(restitution=1.0, restraints=(Damper("friction", f=f),))
    response = rb.simulate(
        FIG5, base, Motion("still", 0.01, np.zeros(100)), initial_rotation_rad=start, devices_work=True
    )
    each = response.device_work()

    def energy(theta, omega):
        height = FIG5.size * (math.cos(FIG5.alpha - abs(theta)) - math.cos(FIG5.alpha))
        return GRAVITY * height + 0.5 * FIG5.inertia_about_pivot * omega**2

    lost = energy(start, 0.0) - energy(response.theta[-1], response.omega[-1])
    assert lost > 0.1 * energy(start, 0.0)
    assert each["energy_J_kg"].sum() == pytest.approx(lost, rel=1e-3)
    assert each["energy_J_kg"].to_numpy() == pytest.approx(f * GRAVITY * each["travel_m"].to_numpy(), rel=1e-3)
    assert response.row["damper_work_J_kg"] == pytest.approx(each["energy_J_kg"].max(), rel=1e-3)
    assert response.row["damper_travel_m"] == pytest.approx(each["travel_m"].max(), rel=1e-3)
    assert response.row["damper_half_cycles"] == each["half_cycles"].max()
    assert each["energy_kJ"].isna().all()
    heavy = replace(response, pier=replace(FIG5, mass_t=50.0)).device_work()
    assert heavy["energy_kJ"].to_numpy() == pytest.approx(50.0 * each["energy_J_kg"].to_numpy(), rel=1e-12)


def test_work_closes_the_energy_balance_of_the_run():
    base = RigidBase(restraints=(Damper("viscous", nu=0.5, at="left"),))
    motion = Motion("noise", 0.01, broadband(np.random.default_rng(3), 0.01, 400, 0.6 * GRAVITY))
    row = rb.simulate(FIG5, base, motion, devices_work=True, ledger=True).row
    given = row["energy_input_J_kg"] + row["energy_p_delta_J_kg"] + row["energy_constraint_J_kg"]
    lost = given - row["energy_kinetic_J_kg"] - row["energy_potential_J_kg"] - row["energy_impact_J_kg"]
    assert row["damper_work_J_kg"] == pytest.approx(lost, rel=1e-5)


def test_the_work_of_a_damper_on_a_brace_leaves_out_what_the_brace_stores():
    """∫F dw by its loop; what the brace holds at the end, F²/2k, is a fifth of that."""
    damper = Damper("hysteretic", f=0.1, yield_m=0.005, brace=0.5, at="left")
    response = rb.simulate(FIG5, RigidBase(restraints=(damper,)), SHAKEN, devices_work=True, quiet_s=0.0)
    pull, way = (response.restraints[f"damper 1 {what}"].to_numpy() for what in ("force", "elongation"))
    own = way - pull / (0.5 * PER_LAMBDA)
    loop = (0.5 * (pull[1:] + pull[:-1]) * np.diff(own)).sum()
    assert response.row["damper_work_J_kg"] == pytest.approx(loop, rel=1e-3)
    assert response.row["damper_energy_J_kg"] == pytest.approx(loop, rel=1e-3)
    assert pull[-1] ** 2 / PER_LAMBDA > 0.1 * loop


def test_a_tendon_that_yields_is_strained_beyond_yield_by_what_it_stays_longer():
    base = RigidBase(restraints=(Tendon(psi=0.1, lam=1.0, strength=0.13),))
    row = rb.simulate(FIG5, base, SHAKEN, devices_work=True).row
    assert row["tendon_yield_m"] > 0.0
    stiffness = 1.0 * GRAVITY * FIG5.size / FIG5.half_width**2
    assert row["tendon_strain_over_yield"] == pytest.approx(
        1.0 + stiffness * row["tendon_yield_m"] / (0.13 * GRAVITY), rel=1e-5
    )


@pytest.mark.parametrize("seed", range(3))
def test_work_is_within_the_error_that_a_row_claims(seed):
    rng = np.random.default_rng(seed)
    base = RigidBase(
        restraints=(Damper("viscous", nu=float(rng.uniform(0.1, 1.0))), Tendon(psi=0.1, lam=0.5, strength=0.3))
    )
    motion = Motion("noise", 0.01, broadband(rng, 0.01, 400, 0.5 * GRAVITY))
    row, exact = (
        rb.simulate(FIG5, base, motion, devices_work=True, tolerance=tolerance).row for tolerance in (1e-4, 1e-9)
    )
    for name in ("damper_travel_m", "damper_work_J_kg", "tendon_strain_over_yield"):
        assert abs(row[name] - exact[name]) <= row["devices_error"] * abs(row[name])


def _study(tmp_path, **output):
    case = {"name": "rock", "base": "rigid", "damper": [{"kind": "friction", "f": 0.02}]}
    check = {"name": "travel", "demand": "damper_travel_m", "at_most": 1e-6, "reason": "a test"}
    return write_study(tmp_path, study_text(pulses=(SINE,), cases=[case], output=output, check=[check]))


@pytest.mark.slow
def test_a_study_asks_for_the_work_checks_it_and_shows_it(tmp_path):
    out = tmp_path / "out"
    row = rb.run(rb.load_study(_study(tmp_path, devices_work=True, least_stroke_mm=2.0)), out=out).iloc[0]
    assert row["damper_travel_m"] > 0.0
    assert row["damper_half_cycles"] >= 1
    assert [verdict.verdict for verdict in read_verdicts(out)] == [FAIL]
    assert "damper travel" in rb.report(out).path.read_text(encoding="utf-8")


def test_who_does_not_ask_for_the_work_has_no_column_of_it_and_reads_how_to(tmp_path):
    with pytest.raises(InputError, match="write devices_work = true under"):
        rb.load_study(_study(tmp_path))
    with pytest.raises(InputError, match=r"least_stroke_mm = 2.*: is for devices_work = true"):
        rb.load_study(_study(tmp_path, least_stroke_mm=2.0))


@pytest.mark.parametrize(
    ("devices", "verdicts"),
    [
        ({}, [DOES_NOT_APPLY, DOES_NOT_APPLY]),
        ({"tendon": [{"psi": 0.1, "lambda": 0.5}]}, [DOES_NOT_APPLY, DOES_NOT_APPLY]),
        ({"tendon": [{"psi": 0.1, "lambda": 0.5, "yield_kN": 1e4}]}, [DOES_NOT_APPLY, PASS]),
    ],
)
def test_devices_that_a_study_lacks_bring_no_columns_and_checks_of_them_do_not_apply(tmp_path, devices, verdicts):
    travel = {"name": "travel", "demand": "damper_travel_m", "at_most": 1e-6, "reason": "a test"}
    strain = {"name": "strain", "demand": "tendon_strain_over_yield", "at_most": 1.0, "reason": "a test"}
    text = study_text(
        pier={"width_m": 4.0, "height_m": 20.0, "mass_t": 1000.0}, pulses=(SINE,),
        cases=[{"name": "rock", "base": "rigid"} | devices], output={"devices_work": True}, check=[travel, strain],
    )  # fmt: skip
    table = rb.run(write_study(tmp_path, text), out=tmp_path / "out")
    assert not any(name.startswith("damper") for name in table)
    yields = any("yield_kN" in device for device in devices.get("tendon", ()))
    assert ("tendon_strain_over_yield" in table) == yields
    assert [verdict.verdict for verdict in read_verdicts(tmp_path / "out")] == verdicts


@pytest.mark.slow
def test_what_dampers_do_ends_with_the_run_while_the_pier_still_rocks():
    """THEORY.md, Dampers and tendons: the peak is the same with a tail of two minutes, and what follows is what the page says."""
    oil, steel = (Damper("viscous", nu=0.02),), (Damper("hysteretic", f=0.02, yield_m=0.005),)
    damped = {"kinematics": "finite", "zeta": 0.02}
    bases = (
        RigidBase(restraints=oil), RigidBase(restraints=steel), ElasticBase(30.0, restraints=oil, **damped),
        ElasticBase(30.0, epsilon=0.5, restraints=steel), YieldingBase(30.0, eta=3.0, spring="epp", restraints=oil, **damped),
    )  # fmt: skip
    shaken = Motion("shaken", 0.01, broadband(np.random.default_rng(3), 0.01, 1200, 4.0), None)
    missing = {"damper_energy_J_kg": [], "damper_travel_m": []}
    for base in bases:
        ended, later = (rb.simulate(FIG5, base, shaken, devices_work=True, quiet_s=tail).row for tail in (2.0, 120.0))
        assert ended.theta_max_over_alpha == later.theta_max_over_alpha
        for name, shares in missing.items():
            shares.append(100.0 * (1.0 - ended[name] / later[name]))
        assert ended.damper_half_cycles < later.damper_half_cycles
    assert [(round(min(shares)), round(max(shares))) for shares in missing.values()] == [(6, 59), (26, 76)]
