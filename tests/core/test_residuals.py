"""Residuals are read at a stated moment, whatever the length of the run, and their drift is known."""

import math
from dataclasses import replace
from itertools import combinations
from types import SimpleNamespace

import numpy as np
import pytest
from core_samples import FIG5, TOWER, pulse, waiting_after
from motion_files import RECORDS, needs_records

import rockbatch as rb
from rockbatch.core.springs.model import Contact, State, Supports
from rockbatch.core.types import Moment
from rockbatch.pier import ElasticBase, YieldingBase, rocking_frequency
from rockbatch.simulation import run_fixed, run_to_tolerance, springs


def tower_on_cape_mendocino(quiet_s: float):
    (motion,) = rb.read_motions(RECORDS / "table1" / "RSN825_CAPEMEND_CPM000.AT2").motions
    return run_to_tolerance(TOWER, YieldingBase(40.0, 0.05, eta=3.5), motion, 1e-4, quiet_s)


def test_residuals_do_not_depend_on_how_long_the_run_goes_on():
    """Bouc–Wen springs ratchet for ever on vibration that nothing damps; what is read is read once."""
    base = YieldingBase(20.0, 0.3, eta=2.2)
    short, long = (run_to_tolerance(FIG5, base, pulse("sine", 0.5, end=2.0), 1e-4, quiet_s) for quiet_s in (1.0, 40.0))
    assert long.t_end > short.t_end + 30.0
    for name in ("t_read", "theta_res", "settlement", "base_tilt", "settlement_drift", "theta_res_drift"):
        assert getattr(long, name) == getattr(short, name), name
    assert short.t_read >= 2.0 + 5.0 * 2.0 * math.pi / 20.0
    assert short.settlement_drift > 0.0


@pytest.mark.parametrize("base", [YieldingBase(40.0, 0.05, eta=2.5), YieldingBase(40.0, eta=2.5, zeta=0.05)])
def test_zeros_after_a_record_change_the_residual_less_than_its_error(base):
    """Springs that ratchet tilt to and fro with every swing that goes on."""
    shaking = rb.pulse("sine", name="sine", amplitude=3.0, period=1.5, dt=0.01, duration=6.0)
    found = []
    for zeros in (0, 53, 107):
        longer = replace(shaking, horizontal=np.append(shaking.horizontal, np.zeros(zeros)))
        found.append(run_to_tolerance(TOWER, base, longer, 1e-4))
    for one, other in combinations(found, 2):
        assert abs(one.theta_res - other.theta_res) <= max(one.theta_res_error, other.theta_res_error)


@needs_records
def test_the_settlement_of_the_papers_tower_does_not_hang_on_quiet_s():
    short, long = tower_on_cape_mendocino(2.0), tower_on_cape_mendocino(60.0)
    assert long.settlement == short.settlement
    assert short.settlement_drift > 1e-4  # m/s, told beside it


def test_the_drift_is_what_whole_periods_of_rocking_change():
    """Springs with a yield point do not ratchet; Bouc–Wen ones do, and the drift is the slope of the histories'
    settlement between the two readings."""
    motion, period = pulse("sine", 0.5, end=2.0), 2.0 * math.pi / 20.0
    base = YieldingBase(20.0, 0.3, eta=2.2)
    outcome = run_fixed(FIG5, base, motion, 8)
    history = rb.simulate(FIG5, base, motion, substeps=8).history.set_index("t")
    m = springs(FIG5, base)

    def settlement(t: float) -> float:
        row = history.iloc[int(np.abs(history.index.to_numpy() - t).argmin())]
        unstressed = [row[f"v_{side}"] - m.yield_deflection * row[f"z_{side}"] for side in ("left", "right")]
        return -0.5 * sum(unstressed)

    rocking = 2.0 * math.pi / rocking_frequency(FIG5, base)
    wait = math.ceil(math.ceil(5.0 * period / rocking) * rocking / motion.dt) * motion.dt
    change = settlement(outcome.t_read + wait) - settlement(outcome.t_read)
    assert outcome.settlement_drift == pytest.approx(change / wait, rel=1e-9)
    for spring in ("epp", "hardening"):
        assert abs(run_fixed(FIG5, replace(base, spring=spring), motion, 8).settlement_drift) < 1e-12


def test_a_reading_is_the_mean_tilt_over_the_samples_up_to_the_second_reading(uncompiled):
    m, rng = springs(FIG5, ElasticBase(50.0)), np.random.default_rng(1)
    readings = rng.uniform(-0.1, 0.0, (5, 2)).tolist()
    left, right = readings[0]
    for number, (here_left, here_right) in enumerate(readings[1:], 1):
        now = Moment(
            State(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), Contact(0.0, 0.0, 0.0, 0.0, 0.0), Supports(here_left, here_right)
        )
        values = {
            "waiting__read": 100.0,
            "clock__sample": 100.0 + number,
            "waiting__read_left": left,
            "waiting__read_right": right,
        }
        _, waiting = uncompiled(waiting_after, ("springs.ending", "_include_in_mean"), values, m, now)
        left, right = waiting["read_left"], waiting["read_right"]
        assert left - right == pytest.approx(np.mean([one - other for one, other in readings[: number + 1]]), rel=1e-12)
        assert left + right == pytest.approx(sum(readings[0]), rel=1e-12)


def test_supports_drift_by_what_changes_between_two_readings(uncompiled):
    """Of the first two readings and of the last; a first reading has none."""
    m, now = springs(FIG5, ElasticBase(50.0)), Moment(
        State(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), Contact(0.0, 0.0, 0.0, 0.0, 0.0), Supports(-0.05, -0.02)
    )  # fmt: skip
    common = {"clock__sample": 120.0, "clock__dt": 0.01, "waiting__read_wait": 20.0, "waiting__patience": 50.0}
    common |= {
        "waiting__last_left": -0.04,
        "waiting__last_right": -0.03,
        "waiting__drift_left": 7.0,
        "waiting__drift_right": 8.0,
    }
    for read, last, drift in (
        (-1.0, -1.0, (7.0, 8.0, 0.0, 0.0)),
        (100.0, 100.0, (-0.05, 0.05, -0.05, 0.05)),
        (80.0, 100.0, (7.0, 8.0, -0.05, 0.05)),
    ):
        values = common | {"waiting__read": read, "waiting__last_read": last, "waiting__last_drift_left": 0.0}
        values |= {"waiting__last_drift_right": 0.0}
        _, found = uncompiled(waiting_after, ("springs.ending", "_read_base"), values, m, now)
        names = "drift_left", "drift_right", "last_drift_left", "last_drift_right"
        assert [found[name] for name in names] == pytest.approx(drift, rel=1e-12)
        assert (found["last_read"], found["last_left"], found["last_right"]) == (120.0, -0.05, -0.02)
        if read < 0.0:
            assert (found["read"], found["read_left"], found["read_right"]) == (120.0, -0.05, -0.02)


@pytest.mark.parametrize(
    ("samples", "wait", "longest", "read_by"),
    [(500.0, 30.0, 580.0, 184.0), (120.0, 30.0, 214.0, 184.0), (120.0, 0.0, 200.0, 104.0)],
)
def test_a_run_on_springs_begins_with_nothing_read_and_waits_for_the_readings(
    samples, wait, longest, read_by, uncompiled
):
    """A record of 101 samples, read from 4 behind it, with a patience of 80."""
    m, base = springs(FIG5, ElasticBase(50.0)), ElasticBase(50.0)
    run = SimpleNamespace(dt=0.01, read_after=4.0, patience=80.0, read_wait=wait, gravity=9.81, prestress=0.5)
    values = {"clock__npts": 101.0, "clock__samples": samples}
    _, waiting = uncompiled(waiting_after, ("springs.ending", "set_deadline"), values, m, run)
    nothing = dict.fromkeys(("read_left", "read_right", "drift_left", "drift_right"), math.nan)
    nothing |= dict.fromkeys(
        ("last_drift_left", "last_drift_right", "stored", "further_right", "further_left", "further_growth"), 0.0
    )
    expected = nothing | {
        "earliest": 104.0, "patience": 80.0, "read_wait": wait, "longest": longest, "read_by": read_by, "load": 10.31,
        "midway": math.inf, "midway_tilt": math.inf, "period": 2.0 * math.pi / rocking_frequency(FIG5, base),
    }  # fmt: skip
    assert {name: waiting[name] for name in expected} == pytest.approx(expected, rel=1e-12, nan_ok=True)
    assert waiting["read"] < 0.0


@pytest.mark.parametrize("spring", ["bouc-wen", "epp"])
def test_a_base_is_foreseen_to_tilt_on_as_between_its_readings(spring, uncompiled):
    """For half of the patience, at the greater of both drifts to either side, amplified as a pier leans on a tilted base;
    twice as fast, and growing by itself while its supports sink, on springs that ratchet."""
    base = YieldingBase(50.0, 0.1, eta=3.0, spring=spring)
    m, b, h, rng = springs(FIG5, base), FIG5.half_width, FIG5.height, np.random.default_rng(2)
    stiffness = rocking_frequency(FIG5, base) ** 2 * (FIG5.inertia_about_pivot - b * b)
    amplified, ratchets, seen = 1.0 + FIG5.gravity * h / stiffness, spring == "bouc-wen", set()
    for _ in range(12):
        drifts = rng.normal(
            -1e-4, 3e-4, (2, 2)
        )  # of the left and right support, between the first readings and the last
        names = "drift_left", "drift_right", "last_drift_left", "last_drift_right"
        values = {f"waiting__{name}": drift for name, drift in zip(names, drifts.ravel().tolist(), strict=True)}
        values |= {"waiting__patience": 600.0, "clock__dt": 0.01}
        _, waiting = uncompiled(waiting_after, ("springs.ending", "_foresee"), values, m)
        way = 3.0 * (2.0 if ratchets else 1.0) * drifts
        turns, sinks = amplified * (way[:, 0] - way[:, 1]) / b, max(0.0, -way.sum(axis=1).min())
        exponent = 5.0 * h * amplified * sinks / b**2 if ratchets else 0.0
        more = math.expm1(exponent) / exponent if exponent > 0.0 else 1.0
        expected = more * max(0.0, turns.max()), more * max(0.0, -turns.min()), math.expm1(exponent)
        assert [waiting[name] for name in ("further_right", "further_left", "further_growth")] == pytest.approx(
            expected, rel=1e-8
        )
        seen |= {(expected[0] > 0.0, expected[1] > 0.0)}
    assert len(seen) == 3
