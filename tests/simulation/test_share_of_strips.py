"""What the strips of a bed leave of errors: by half as many at the same step, and how it ends the halving of steps."""

from dataclasses import replace

import numpy as np
import pytest
from core_samples import pulse

import rockbatch as rb
from rockbatch.core.clock import WINDOWS
from rockbatch.outcome.outcome import BedDemands, Outcome
from rockbatch.pier import FootingBase, Pier
from rockbatch.simulation import chaos, error_control, run_to_tolerance
from rockbatch.simulation.agreement import Agreement, Tolerances, agreement
from rockbatch.simulation.coarser import share_of_strips, tolerances_beside, with_strips_error
from rockbatch.simulation.runs import Trial

PIER, BASE, SINE = Pier(0.2, 2.0), FootingBase(30.0, 3.0), pulse("sine", 0.5, dt=0.01, end=3.0)


def trial(theta_max, *windows, steps=4, work=1.0, pressure=2.0, status="ok", **more):
    """A run on a bed; the greatest rotations in the parts of the run are the first argument and then ``windows``."""
    peak = max(theta_max, *windows, 0.0)
    bed = BedDemands(0.2, 20.0, 1.0, pressure, 1.0, 4.0, 0, work)
    extremes = np.full(WINDOWS, np.nan)
    extremes[: 1 + len(windows)] = [theta_max, *windows]
    outcome = Outcome(
        status, "", theta_max=peak, theta_max_in_motion=peak, impacts=0, separations=1, t_max=1.0, t_flight=None,
        t_end=9.0, substeps=steps, bed=bed, **more,
    )  # fmt: skip
    return Trial(outcome, extremes)


def test_the_share_is_four_times_the_change_by_half_as_many_strips():
    """An error of order 1 is all of the change by half as many, one of order 2 a third of it."""
    own = trial(0.02, 0.01, theta_res=0.001, settlement=0.05)
    share = share_of_strips(own, trial(0.0206, 0.012, theta_res=0.0018, settlement=0.053), 5.0)
    assert share.peak == pytest.approx(4.0 * 0.0006)
    assert share.residual == pytest.approx(4.0 * 0.0008)
    assert share.settlement == pytest.approx(4.0 * 0.003)
    np.testing.assert_allclose(share.extremes[:3], [1.5 * 0.0006, 1.5 * 0.002, 0.0], atol=1e-15)


def test_the_peaks_share_has_the_change_of_any_extreme_until_the_later_peak():
    """Two peaks may agree by chance. Later extremes far below change nothing; the last run has its peak one window later."""
    own = trial(0.01, 0.02, 0.0195, 0.012)
    shares = [
        share_of_strips(own, trial(*extremes), 5.0).peak
        for extremes in ((0.013, 0.02, 0.0195, 0.012), (0.01001, 0.02, 0.0195, 0.0105), (0.01, 0.0199, 0.02, 0.0105))
    ]
    assert shares[0] == pytest.approx(1.5 * 0.003)
    assert shares[1] == pytest.approx(1.5 * 0.00001)
    assert shares[2] == pytest.approx(1.5 * 0.0005)


def test_the_peaks_share_has_what_strips_may_raise_a_later_extreme_above_it():
    """Four times its change, as of the peak: with more strips the later one may be the peak. One alone that got there is none."""
    own = trial(0.02, 0.01, 0.019)
    assert share_of_strips(own, trial(0.02, 0.01, 0.018), 5.0).peak == pytest.approx(0.019 + 4.0 * 0.001 - 0.02)
    assert share_of_strips(own, trial(0.02, 0.01), 5.0).peak == pytest.approx(3e-5 * 0.02)


def test_strips_that_agree_by_chance_claim_a_share_all_the_same():
    own = trial(0.02, 0.01, theta_res=0.0, settlement=0.05)
    share = share_of_strips(own, own, 5.0)
    assert (share.peak, share.residual, share.settlement) == (pytest.approx(3e-5 * 0.02), 0.0, 0.0)


def test_the_residuals_share_has_the_change_of_the_settlement():
    """Both come of the same sets, over half the width; the residual rotation may agree by chance."""
    own, fewer = trial(0.02, theta_res=0.001, settlement=0.05), trial(0.02, theta_res=0.001, settlement=0.051)
    assert share_of_strips(own, fewer, 5.0).residual == pytest.approx(1.5 * 0.001 / 5.0)


def test_nothing_is_known_of_strips_that_come_to_another_end():
    own, fallen = trial(0.02, theta_max_error=1e-5, theta_res_error=1e-6), trial(1.5, status="overturned")
    assert share_of_strips(own, fallen, 5.0) is None
    assert share_of_strips(fallen, fallen, 5.0) is None
    found = with_strips_error(own.outcome, own, fallen, 5.0)
    assert (found.theta_max_error, found.theta_res_error, found.bed.pressure_error) == (None, None, None)
    assert found.note == "half as many strips come to another end: overturned; no error is claimed"
    assert with_strips_error(fallen.outcome, own, own, 5.0) is fallen.outcome


def test_errors_of_results_are_those_of_steps_and_strips_together():
    own = trial(0.02, theta_res=0.001, settlement=0.05)
    fewer = trial(0.0206, theta_res=0.0018, settlement=0.053, pressure=1.8)
    kept = own.outcome.changed(theta_max=0.0201, theta_max_error=1e-4, theta_res_error=2e-5, settlement_error=3e-4)
    found = with_strips_error(kept, own, fewer, 5.0)
    assert found.theta_max_error == pytest.approx(4.0 * (1e-4 + 0.0006))
    assert found.theta_res_error == pytest.approx(4.0 * (2e-5 + 0.0008))
    assert found.settlement_error == pytest.approx(4.0 * (3e-4 + 0.003))
    assert found.bed.strips_error == pytest.approx(4.0 * 0.0006)
    assert with_strips_error(replace(kept, theta_max_error=None), own, fewer, 5.0).theta_max_error is None


def test_errors_of_the_greatest_push_and_pressure_have_what_steps_may_miss():
    """Beside four times the changes by twice the step and by half as many strips, (ω h)²/8 of themselves, ω h = 0.1."""
    own, fewer = trial(0.02), trial(0.02, work=1.3, pressure=1.8)
    kept = own.outcome.changed(bed=replace(own.outcome.bed, force=21.0, pressure=2.1, work=1.02))
    bed = with_strips_error(kept, own, fewer, 5.0).bed
    assert bed.force_error == pytest.approx(4.0 * 1.0 + 0.00125 * 21.0)
    assert bed.pressure_error == pytest.approx(4.0 * (0.1 + 0.2) + 0.00125 * 2.1)
    assert bed.work_error == pytest.approx(4.0 * (0.02 + 0.3))


def test_a_peak_within_the_motion_has_the_strips_share_however_the_run_ended():
    """Of a run that overturned after its motion nothing else has an error; a peak on its side tells that nothing is known."""
    own, fewer = trial(0.02, change_in_motion=1e-4), trial(0.0206)
    found = with_strips_error(own.outcome, own, fewer, 5.0)
    assert found.change_in_motion == pytest.approx(4.0 * (1e-4 + 0.0006))
    fallen = replace(own.outcome, status="overturned", bed=None)
    assert with_strips_error(fallen, own, fewer, 5.0).change_in_motion == pytest.approx(4.0 * (1e-4 + 0.0006))
    assert with_strips_error(fallen, own, own, 5.0).change_in_motion == pytest.approx(4e-4 + 3e-5 * 0.02)
    assert with_strips_error(replace(fallen, change_in_motion=None), own, fewer, 5.0).change_in_motion is None


def test_steps_may_add_a_tenth_of_what_strips_leave_and_no_less_than_the_tolerance():
    share = share_of_strips(trial(0.02, 0.01, theta_res=0.0), trial(0.022, 0.012, theta_res=0.008), 5.0)
    wide, own = tolerances_beside(1e-5, share), tolerances_beside(1e-5, None)
    assert (wide.peak, wide.residual) == (pytest.approx(0.4 * 0.002), pytest.approx(0.4 * 0.008))
    np.testing.assert_allclose(wide.extremes[:3], [0.15 * 0.002, 0.15 * 0.002, 1e-5])
    assert (own.peak, own.residual, *own.extremes) == (1e-5,) * (WINDOWS + 2)
    assert tolerances_beside(1e-3, share)[:2] == (1e-3, pytest.approx(0.4 * 0.008))


def halved(monkeypatch, peaks, fewer, **more):
    """Let a run on a footing come to ``peaks`` by halved steps, on half the strips to ``fewer``; return outcome and what ran."""
    asked, times = [], []

    def run(runs, substeps, quiet_s, stop):
        trials = []
        for one, steps in zip(runs, substeps, strict=True):
            asked.append((one.base.strips, steps))
            times.append(steps)
            level = (steps // times[0]).bit_length() - 1
            values = peaks if one.base.strips == BASE.strips else fewer
            trials.append(trial(values[min(level, len(values) - 1)], steps=steps, theta_res=0.0, **more))
        return trials

    monkeypatch.setattr(error_control, "try_all", run)
    monkeypatch.setattr(chaos, "try_all", run)
    outcome = run_to_tolerance(PIER, BASE, SINE, 1e-4)
    first = times[0]
    return outcome, [(strips, steps // first) for strips, steps in asked]


def test_steps_are_halved_until_they_are_below_what_the_strips_leave(monkeypatch):
    """A change of 10⁻³ by the step is within a tenth of what strips change, and far above the tolerance of 2·10⁻⁵."""
    outcome, asked = halved(monkeypatch, (0.1, 0.101, 0.10101), (0.11,))
    assert asked[:3] == [(40, 1), (20, 1), (40, 2)]
    assert outcome.theta_max == 0.101
    assert outcome.theta_max_error == pytest.approx(4.0 * (0.001 + 0.01))
    outcome, asked = halved(monkeypatch, (0.1, 0.101, 0.10101), (0.1001, 0.1011))
    assert asked[:5] == [(40, 1), (20, 1), (40, 2), (20, 2), (40, 4)]
    assert outcome.theta_max == 0.10101
    assert outcome.theta_max_error == pytest.approx(4.0 * (0.00001 + 0.0001))


def test_other_strips_that_fall_leave_the_tolerance_of_steps_as_it_is(monkeypatch):
    def ends(runs, substeps, quiet_s, stop):
        return [
            trial(0.1, steps=steps, theta_res=0.0) if run.base.strips == BASE.strips
            else trial(1.5, steps=steps, status="overturned")
            for run, steps in zip(runs, substeps, strict=True)
        ]  # fmt: skip

    monkeypatch.setattr(error_control, "try_all", ends)
    outcome = run_to_tolerance(PIER, BASE, SINE, 1e-4)
    assert (outcome.status, outcome.theta_max_error) == ("ok", None)
    assert "half as many strips come to another end: overturned" in outcome.note


def test_each_result_agrees_within_its_own_tolerance():
    coarse, fine = trial(0.02, 0.010, theta_res=0.0), trial(0.02, 0.015, theta_res=0.0, theta_res_error=1e-4)
    wide = Tolerances(1e-5, 1e-3, np.full(WINDOWS, 1e-2))
    assert agreement(fine, coarse, wide, PIER) == Agreement.THROUGHOUT
    assert agreement(fine, coarse, wide._replace(peak=1e-3, residual=1e-5), PIER) == Agreement.NONE
    assert agreement(fine, coarse, wide._replace(peak=1e-2, extremes=np.full(WINDOWS, 1e-5)), PIER) == Agreement.RESULTS


def test_errors_of_forces_have_four_times_what_half_as_many_strips_change():
    """Of forces at the base and in sections."""
    motion = pulse("sine", 0.35, dt=0.01, end=3.0)
    own = rb.simulate(PIER, BASE, motion, forces=True, sections=3)
    few, substeps = replace(BASE, strips=20), int(own.row.substeps)
    fewer = rb.simulate(PIER, few, motion, forces=True, sections=3, substeps=substeps)
    assert own.row.status == fewer.row.status == "ok"
    changes = [abs(1.0 - fewer.row[name] / own.row[name]) for name in ("base_shear_m_s2", "base_moment_m2_s2")]
    assert max(changes) > 1e-4
    assert own.row.forces_error >= 4.0 * max(changes)
    shear = "section_shear_m_s2"
    changed = abs(1.0 - fewer.sections[shear] / own.sections[shear])[:2]  # the last is at the top
    assert changed.max() > 1e-4
    assert (own.sections.sections_error[:2] >= 4.0 * changed).all()
