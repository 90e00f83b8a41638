"""The peak until a motion ends: what a run that fails later has reached, with an error that holds it."""

from pathlib import Path

import numpy as np
import pytest
from core_samples import FIG5, pulse
from studies import study_text, write_study

from rockbatch.commands.cli import main
from rockbatch.motions.motion import Motion
from rockbatch.pier import Pier, RigidBase, YieldingBase
from rockbatch.results.reading import read_saved
from rockbatch.simulation import Run, Stop, run_all_fixed, run_fixed, run_to_tolerance, written_run

FILE = Path(__file__).parents[1] / "verification" / "ratcheting_motion.txt"
PIER = Pier(alpha=0.082997, p=0.353807, mu=1.861922)
SOFT = YieldingBase(beta=25.95608, eta=1.06, epsilon=1.0, flight="stop")
"""A base that tilts on by free vibration after the motion of the file."""


@pytest.fixture(scope="module")
def motion():
    samples = np.loadtxt(FILE)
    return Motion("ratchets", samples[1, 0] - samples[0, 0], samples[:, 1])


@pytest.fixture(scope="module")
def failed(motion):
    return run_to_tolerance(PIER, SOFT, motion, 1e-4)


def peak_of_history(run, substeps, until):
    """Return the greatest |θ| at the steps of a run until a time."""
    found, rows = written_run(run, substeps, 0.0, 400_000, every_step=True, wait=False)
    rows = rows[: found.rows]
    return abs(rows.theta[rows.t <= until + 1e-9]).max()


def test_a_run_that_fails_after_its_motion_has_the_peak_until_then_within_its_error(failed, motion):
    assert failed.status == "failed"
    assert failed.failure == "ratchets"
    assert failed.t_max > motion.duration
    assert 0.0 < failed.theta_max_in_motion < failed.theta_max
    fine = run_fixed(PIER, SOFT, motion, 16 * failed.substeps, wait=False).theta_max_in_motion
    assert abs(failed.theta_max_in_motion - fine) <= failed.theta_max_in_motion_error < 1e-4 * PIER.alpha
    steps = peak_of_history(Run(PIER, SOFT, motion), 64, motion.duration)
    assert failed.theta_max_in_motion == pytest.approx(steps, rel=1e-5)


@pytest.mark.parametrize("base", [RigidBase(), YieldingBase(50.0, eta=2.2)], ids=["rigid", "springs"])
def test_it_ends_with_the_last_sample_whichever_runs_stand_beside_it(base):
    """Motions that end at several stages of a swing."""
    whole = pulse("sine", 0.5, 1.0, end=0.6)
    runs = [Run(FIG5, base, Motion(f"{n}", whole.dt, whole.horizontal[:n])) for n in (1, 20, 40, 75, 101)]
    outcomes = run_all_fixed(runs, [4] * len(runs), 2.0, Stop())
    for run, outcome in zip(runs, outcomes, strict=True):
        until = peak_of_history(run, 4, run.motion.duration) if run.motion.npts > 1 else 0.0
        assert outcome.theta_max_in_motion == pytest.approx(until, rel=1e-5)  # of which the steps have the peak
        assert outcome.theta_max_in_motion < outcome.theta_max or outcome.t_max <= run.motion.duration


def test_of_a_peak_within_the_motion_it_is_the_peak_and_loses_its_error_with_it():
    outcome = run_to_tolerance(FIG5, RigidBase(), pulse("sine", 0.5, 1.0, dt=0.01, end=5.0), 1e-4)
    assert (outcome.theta_max_in_motion, outcome.theta_max_in_motion_error) == (
        outcome.theta_max,
        outcome.theta_max_error,
    )
    assert outcome.noted("chaotic", theta_max_error=None).theta_max_in_motion_error is None


def test_only_a_pier_that_falls_after_its_motion_has_a_peak_with_an_error():
    for end, later in ((1.0, True), (10.0, False)):
        outcome = run_to_tolerance(FIG5, RigidBase(), pulse("sine", 1.0, 1.5, dt=0.01, end=end), 1e-4)
        assert outcome.status == "overturned"
        assert (outcome.theta_max_in_motion < FIG5.alpha) == later
        assert (outcome.theta_max_in_motion_error is not None) == later


def test_a_fixed_step_claims_no_error_of_it():
    fixed = run_fixed(FIG5, RigidBase(), pulse("sine", 1.0, 1.5, dt=0.01, end=1.0), 4)
    assert fixed.theta_max_in_motion > 0.0
    assert fixed.theta_max_in_motion_error is None


@pytest.mark.usefixtures("pages")
def test_the_page_and_the_terminal_say_so_and_a_check_that_it_breaks_fails(tmp_path, capsys, failed):
    least = (failed.theta_max_in_motion - failed.theta_max_in_motion_error) / PIER.alpha
    rule = {"demand": "theta_max_over_alpha", "statistic": "max", "basis": "judgement", "reason": "r"}
    soft = {
        "name": "soft",
        "base": "yielding",
        "beta": SOFT.beta,
        "eta": SOFT.eta,
        "epsilon": 1.0,
        "flight": "stop",
    }
    text = study_text(
        pier={"alpha": PIER.alpha, "p": PIER.p, "mu": PIER.mu}, motions={"path": str(FILE), "unit": "m/s2"}, pulses=(),
        cases=[soft], output={"both_laws": False, "histories": "none"},
        check=[rule | {"name": "broken", "at_most": 0.99 * least}, rule | {"name": "open", "at_most": 1.01 * least}],
    )  # fmt: skip
    study = write_study(tmp_path, text)
    assert main(["run", str(study), "--out", str(tmp_path / "out")]) == 1
    printed = capsys.readouterr()
    assert (
        "1 failed only after the motion: theta_max_in_motion_over_alpha has the peak until then, a lower bound; in all of them "
        'the springs ratchet in free vibration: take spring = "epp" or "hardening", or zeta of 0.2 or more'
    ) in " ".join(printed.err.split())
    verdicts = {line.split(",")[0]: line for line in (tmp_path / "out/checks.csv").read_text("utf-8").splitlines()}
    assert ",fail," in verdicts["broken"]
    assert ",not decided," in verdicts["open"]
    assert f"≥\u00a0{least:.4f}" in (tmp_path / "out/report.html").read_text("utf-8")
    (run,) = read_saved(tmp_path / "out").peaks.to_dict("records")
    assert run["theta_max_in_motion_over_alpha"] == pytest.approx(failed.theta_max_in_motion / PIER.alpha)
    assert run["theta_max_in_motion_error"] == pytest.approx(failed.theta_max_in_motion_error / PIER.alpha)
