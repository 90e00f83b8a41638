"""Rocking apart from the lean of a base that has yielded: what the greatest rotation is, in rows, notes, columns and checks."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from studies import study_text, write_study

import rockbatch as rb
from rockbatch.batch.groups import outcomes_of
from rockbatch.batch.observers import observers_of
from rockbatch.checks.judging import judge
from rockbatch.commands.summary import summary, warnings
from rockbatch.common.errors import InputError
from rockbatch.core.types import SAMPLE
from rockbatch.motions import Motion
from rockbatch.observers.rocking.observe import Rocking
from rockbatch.pier import ElasticBase, Pier, YieldingBase
from rockbatch.reporting.sections.peaks import outcome
from rockbatch.results.columns import StudyRun, as_table, row
from rockbatch.results.labelled import Labelled
from rockbatch.results.labels import Series
from rockbatch.results.run_json import describe_case
from rockbatch.simulation import Run, Stop, run_all_to_tolerance, run_fixed, run_to_tolerance
from rockbatch.simulation.leaning import PARTS, greatest_swing, lean_of, unstressed, with_lean
from rockbatch.simulation.observing import observed
from rockbatch.simulation.recording import recorded
from rockbatch.simulation.restraints import stiffness_at_rest
from rockbatch.simulation.steps import readings
from rockbatch.study import Case, Numerics, Output, load_study

PIER = Pier(alpha=0.2, p=1.0)
PADS = YieldingBase(beta=40, eta=2.0, zeta=0.02)
ON_PADS = {"name": "pads", "base": "yielding", "beta": 40, "eta": 2.0, "zeta": 0.02}


def pulse_and_vibration(vertical):
    """A horizontal one-sine of 0.25 g over the first second, and from 4 to 20 s a vertical vibration at 4 Hz."""
    t = np.arange(0.0, 20.0, 0.01)
    horizontal = np.where(t < 1.0, 0.25 * 9.81 * np.sin(2 * np.pi * t), 0.0)
    return Motion("shaken", 0.01, horizontal, np.where(t > 4.0, vertical * 9.81 * np.sin(8 * np.pi * t), 0.0))


def parts_of(outcome):
    return outcome.observed.get("rocking")


def outcome_of(base, motion, **output):
    planned = StudyRun(motion, "+", 1.0, Case("case", PIER, base, {}))
    (outcome,) = outcomes_of([planned], Numerics(tolerance=1e-4), observers_of(Output.with_keys(**output)))
    return outcome


def test_the_stiffness_of_a_pier_on_springs_at_rest_is_less_by_its_weights_moment():
    """Two springs of K/2 at ±b have K b² in rocking, of which the weight takes M g h; per unit mass, with K/M = (β p)²."""
    pier = Pier.from_size(0.2, 10.0, 3.0, 9.81)
    whole = (30.0 * pier.p) ** 2
    rocking = whole * pier.half_width**2 - pier.gravity * pier.height
    assert stiffness_at_rest(pier, ElasticBase(30.0), 0.0) == pytest.approx(np.diag([whole, rocking]), rel=1e-12)


@pytest.mark.parametrize(
    "base",
    [
        PADS,
        pytest.param(replace(PADS, kinematics="finite"), marks=pytest.mark.slow),
        *(replace(PADS, spring=law) for law in ("epp", "hardening")),
    ],
)
def test_where_a_pier_would_rest_at_the_end_is_the_residual_rotation_of_its_row(base):
    """The core reads that by itself, from the supports' positions: a mean over the time between two readings after the record."""
    motion = pulse_and_vibration(0.3)
    outcome = run_to_tolerance(PIER, base, motion, 1e-4)
    rows = recorded(Run(PIER, base, motion), outcome, 2.0, every_step=False).rows
    samples = lean_of(PIER, base, rows)[rows.kind == SAMPLE]
    first, wait = round(outcome.t_read / motion.dt), readings(PIER, base, motion.dt)[1]
    assert samples[first : first + max(wait, 1)].mean() == pytest.approx(outcome.theta_res, rel=1e-9)
    assert abs(outcome.theta_res) > 0.01 * PIER.alpha


def test_a_peak_that_is_lean_is_said_to_be_with_the_rocking_before_it():
    """The pulse rocks the pier as far as it does without the vibration after it, which then tilts the base: the peak grows, the
    rocking does not."""
    rocked, leaned = (outcome_of(PADS, pulse_and_vibration(vertical), rocking=True) for vertical in (0.0, 0.5))
    assert rocked.theta_max_is == ""
    assert "lean" not in rocked.note
    assert leaned.theta_max_is == "lean"
    assert leaned.theta_max > 1.4 * rocked.theta_max
    assert leaned.t_max > 4.0
    assert parts_of(leaned).rocking == pytest.approx(parts_of(rocked).rocking, rel=1e-3)
    assert parts_of(leaned).lean == pytest.approx(abs(leaned.theta_res), rel=0.05)
    told = f"the base leaned by {parts_of(leaned).lean / PIER.alpha:.4f} alpha"
    assert told in leaned.note
    assert f"by {parts_of(leaned).rocking / PIER.alpha:.4f} alpha at most, at 1." in leaned.note


def test_an_unasked_note_on_lean_costs_only_where_the_peak_may_be_lean():
    leaned, asked = (outcome_of(PADS, pulse_and_vibration(0.5), rocking=rocking) for rocking in (False, True))
    assert leaned == replace(asked, observed={})
    assert (leaned.theta_max_is, "mostly lean" in leaned.note) == ("lean", True)
    assert rb.simulate(PIER, PADS, pulse_and_vibration(0.5)).row["theta_max_is"] == "lean"
    assert outcome_of(PADS, pulse_and_vibration(0.0)).theta_max_is == ""
    assert outcome_of(PADS, pulse_and_vibration(0.3)).theta_max_is == ""  # rests at half of its peak, which is rocking


@pytest.mark.parametrize(
    "base", [rb.RigidBase(), ElasticBase(40), replace(PADS, eta=50.0, spring="epp")], ids=["rigid", "elastic", "strong"]
)
def test_where_nothing_yields_all_of_the_rotation_is_rocking(base):
    outcome = outcome_of(base, pulse_and_vibration(0.0), rocking=True)
    assert parts_of(outcome).rocking == pytest.approx(outcome.theta_max, rel=1e-4)
    assert abs(parts_of(outcome).lean or 0.0) < 1e-12


def test_the_error_of_rocking_and_lean_holds_against_a_quarter_of_the_step():
    """Of pads that yield; a fixed step has none, and where nothing yields it is that of the peak."""
    motion = pulse_and_vibration(0.5)
    outcome = outcome_of(PADS, motion, rocking=True)
    fine = run_fixed(PIER, PADS, motion, 4 * outcome.substeps)
    (fine,) = observed([Run(PIER, PADS, motion)], [fine], [Rocking()], 2.0, error=True)
    assert 0.0 < parts_of(outcome).rocking_error < 1e-3 * parts_of(outcome).rocking
    assert abs(parts_of(outcome).rocking - parts_of(fine).rocking) <= parts_of(outcome).rocking_error
    assert (
        abs(parts_of(outcome).lean - parts_of(fine).lean)
        <= parts_of(outcome).lean_error
        < 1e-2 * parts_of(outcome).lean
    )
    assert (parts_of(fine).rocking_error, parts_of(fine).lean_error) == (None, None)
    rigid = outcome_of(rb.RigidBase(), motion, rocking=True)
    assert (parts_of(rigid).rocking_error, parts_of(rigid).lean_error) == (rigid.theta_max_error, None)
    assert outcome_of(PADS, motion).observed == {}


def test_supports_are_unstressed_above_their_pivots_by_what_their_springs_give():
    """Pivots as complex numbers, turned by exp(−iθ), or 1 − iθ; while one is away its support stays where it was.

    From there at rest, which is lower than without weight by the plastic deflection of first loading.
    """
    rng, b, h = np.random.default_rng(3), PIER.half_width, PIER.height
    theta, v, *z = rng.uniform((-0.3, -0.1, -1.0, -1.0), (0.3, 0.1, 0.0, 0.0), (9, 4)).T
    rows = SimpleNamespace(theta=theta, v=v, z_left=z[0], z_right=z[1], left=np.arange(9) != 4, right=np.ones(9))
    deflection, x = PADS.eta * PIER.gravity / PADS.beta**2, np.linspace(0.0, 1.0 / PADS.eta, 10_001)
    sunk = deflection * np.trapezoid(x**5 / (1.0 - x**5), x)
    for kinematics, turned in (("finite", np.exp(-1j * theta)), ("first-order", 1.0 - 1j * theta)):
        pivots = [v + h + ((side * b - 1j * h) * turned).imag for side in (-1.0, 1.0)]
        left, right = (at - deflection * each + sunk for at, each in zip(pivots, z, strict=True))
        left[4] = left[3]
        found = unstressed(PIER, replace(PADS, kinematics=kinematics), rows)
        assert np.concatenate(found) == pytest.approx(np.concatenate([left, right]), abs=1e-11)


def test_the_greatest_swing_about_a_line_is_found_between_rows_of_any_distance():
    """Of 0.01 e^(−λt) sin ωt about a line that rises by more, where tan ωt = ω/λ; each half cycle after it is smaller."""
    decay, omega = 0.3, 2.0
    phase = np.arctan2(omega, decay)
    peak = 0.01 * np.exp(-decay * phase / omega) * np.sin(phase)
    for seed in range(20):
        t = np.cumsum(np.random.default_rng(seed).uniform(0.02, 0.3, 30))
        wave, line = 0.01 * np.exp(-decay * t), 0.02 + 0.03 * t
        swing, rate = wave * np.sin(omega * t), wave * (omega * np.cos(omega * t) - decay * np.sin(omega * t))
        for side in (-1.0, 1.0):
            found = greatest_swing(t, side * (line + swing), side * (0.03 + rate), side * swing)
            assert found == pytest.approx((peak, phase / omega), rel=2e-3, abs=0.3 / PARTS)
            assert found[0] == pytest.approx(peak, rel=2e-3)


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("requested", [False, True])
def test_many_runs_are_classified_as_one_is(requested):
    """Piers that lean, swing, stand on strong pads or overturn, at two sampling intervals, side by side and each alone."""
    runs = [
        Run(PIER, replace(PADS, eta=eta), replace(pulse_and_vibration(vertical), dt=dt))
        for eta in (1.5, 2.0, 50.0)
        for vertical in (0.0, 0.3, 0.5)
        for dt in (0.01, 0.008)
    ]
    outcomes = run_all_to_tolerance(runs, 1e-4, 2.0, Stop())

    def classified(runs, outcomes):
        return observed(runs, outcomes, [Rocking()], 2.0, error=True) if requested else with_lean(runs, outcomes, 2.0)

    found = classified(runs, outcomes)
    assert found == [classified([run], [outcome])[0] for run, outcome in zip(runs, outcomes, strict=True)]
    assert all(("rocking" in outcome.observed) is requested for outcome in found)
    assert 0 < sum(outcome.theta_max_is == "lean" for outcome in found) < len(runs)


def test_a_check_of_rocking_is_not_decided_within_its_error(tmp_path):
    check = {"name": "rocking", "demand": "theta_rocking_over_alpha", "at_most": 0.1, "reason": "a limit"}
    study = load_study(write_study(tmp_path, study_text(cases=(ON_PADS,), check=[check], output={"rocking": True})))
    motion = pulse_and_vibration(0.5)
    outcome = outcome_of(study.cases[0].base, motion, rocking=True)
    for near, verdict in ((0.5, "not decided"), (1.5, "pass"), (-1.5, "fail")):
        limit = (parts_of(outcome).rocking + near * parts_of(outcome).rocking_error) / study.cases[0].pier.alpha
        runs = as_table([row(StudyRun(motion, "+", 1.0, study.cases[0], outcome=outcome))], study)
        (told,) = judge([replace(study.checks[0], at_most=limit)], runs, [describe_case(study.cases[0])])
        assert told.verdict == verdict


def test_a_check_may_ask_for_the_rocking_and_the_tables_mark_the_lean(tmp_path):
    """The rocking is within a limit that the peak, mostly lean, exceeds."""
    checks = [
        {"name": name, "demand": f"theta_{name}_over_alpha", "at_most": 0.1, "reason": "a limit"} for name in ("max", "rocking")
    ]  # fmt: skip
    text = study_text(cases=(ON_PADS,), check=checks, output={"rocking": True})
    study = load_study(write_study(tmp_path, text))
    (one,) = study.cases
    motion = pulse_and_vibration(0.5)
    finished = StudyRun(motion, "+", 1.0, one, outcome=outcome_of(one.base, motion, rocking=True))
    runs = as_table([row(finished)], study)
    verdicts = judge(study.checks, runs, [describe_case(one)])
    assert [verdict.verdict for verdict in verdicts] == ["fail", "pass"]
    assert verdicts[1].value == runs["theta_rocking_over_alpha"][0]
    labels = Labelled([Series("pads", "", False, 0)], [""], {}, {}, runs.assign(series=0, pier=0, with_vertical=""), {})
    shown = summary(labels, {"shaken": "shaken"})
    assert f"lean {runs['theta_max_over_alpha'][0]:.4f}" in shown
    assert "of 1 run, marked lean, is mostly the lean" in " ".join(warnings(runs, labels.case_of))
    assert "lean</sup>" in outcome(runs.iloc[0].to_dict())


def test_a_check_of_rocking_is_refused_where_nobody_asked_for_it(tmp_path):
    check = {"name": "rocking", "demand": "theta_rocking_over_alpha", "at_most": 0.1, "reason": "a limit"}
    with pytest.raises(InputError, match="there is no column of rocking; write rocking = true under"):
        load_study(write_study(tmp_path, study_text(check=[check])))


def test_only_a_pier_that_was_let_go_from_a_rotation_is_said_to_have_been():
    still = rb.Motion("still", 0.01, np.zeros(50))
    released = Pier(0.2, 1.0, initial_rotation_rad=0.1)
    notes = [rb.simulate(pier, rb.RigidBase(), still).row.note for pier in (Pier(0.2, 1.0), released)]
    assert notes[0] == ""
    assert "the rotation from which the pier was let go" in notes[1]
