"""Both polarities: one is simulated, the other is its mirror image, and what is counted counts one."""

import json
from dataclasses import asdict, replace
from functools import partial

import numpy as np
import pandas as pd
import pytest
from studies import COSINE, PADS, SINE, study_text

import rockbatch as rb
from rockbatch.batch.execution import execute_runs, to_simulate
from rockbatch.batch.journal import Journal
from rockbatch.batch.observers import observers_of
from rockbatch.batch.plan import Plan, simulations
from rockbatch.batch.threads import Threads
from rockbatch.commands.cli import main
from rockbatch.pier import ElasticBase, Pier, YieldingBase
from rockbatch.quantities.rows import simulated
from rockbatch.results.columns import columns, row
from rockbatch.results.suite_statistics import suite
from rockbatch.simulation import run_to_tolerance
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

BOTH = '["+", "-"]'
STUDY = study_text(
    title="Mirrors",
    motions={"polarity": ["+", "-"], "scale": [0.5, 1.0]},
    pulses=(SINE | {"duration_s": 2.0}, COSINE | {"amplitude_g": 0.7, "duration_s": 2.0}),
    cases=(PADS | {"beta": [30, 50], "epsilon": 0.1},),
    output={"histories": "all", "ledger": True, "forces": True},
    check=[{"name": "half", "demand": "theta_max_over_alpha", "at_most": 0.001, "reason": "margin"}],
)
ROWS = 2 * 2 * 2 * 2


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "study.toml"

    def of(polarity=BOTH):
        path.write_text(STUDY.replace(BOTH, polarity), encoding="utf-8")
        return path

    return of


def without_histories(path):
    path.write_text(
        path.read_text(encoding="utf-8").replace('histories = "all"', 'histories = "none"'), encoding="utf-8"
    )
    return path


class Watched(Threads):
    """Notes what it simulates."""

    def __init__(self):
        super().__init__(1)
        object.__setattr__(self, "simulated", [])

    def outcomes(self, runs, numerics, observers=()):
        self.simulated.extend((run.record.name, run.polarity, run.scale, run.case.columns["beta"]) for run in runs)
        return super().outcomes(runs, numerics, observers)


def carried_out(path, folder, among=None):
    """What was simulated, and the journal's rows by number."""
    loaded = load_study(path)
    engine = Watched()
    with Journal(folder / "peaks.csv.part", columns(loaded), {}) as journal:
        execute_runs(
            Plan(loaded, ground_motions(loaded)),
            loaded.numerics,
            journal,
            engine,
            observers_of(loaded.output),
            among=among,
        )
        return engine.simulated, dict(journal.rows())


# The mirror image itself

PIER = Pier(0.2, 1.0)
slow = partial(pytest.param, marks=pytest.mark.slow)


@pytest.mark.parametrize(
    ("base", "amplitude"),
    [
        (ElasticBase(beta=40.0, epsilon=0.1), 6.0),
        slow(ElasticBase(beta=40.0, epsilon=0.1, kinematics="finite", flight="stop"), 6.0),  # flights let last bits grow
        (YieldingBase(beta=40.0, eta=2.0, epsilon=0.1), 6.0), (YieldingBase(beta=40.0, eta=2.0, epsilon=0.1, spring="epp"), 6.0),
        slow(YieldingBase(beta=40.0, eta=1.5, epsilon=0.1, spring="epp", kinematics="finite", flight="stop"), 4.0),
        (YieldingBase(beta=40.0, eta=2.0, zeta=0.05, spring="hardening"), 6.0),
        slow(YieldingBase(beta=40.0, eta=1.5, epsilon=0.1, spring="hardening", kinematics="finite", flight="stop"), 4.0),
        (YieldingBase(beta=40.0, eta=2.0, epsilon=0.1), 15.0), (YieldingBase(beta=40.0, eta=2.0, epsilon=0.1), 30.0),
    ],
)  # fmt: skip
@pytest.mark.parametrize("vertical", [False, True])
def test_a_mirrored_outcome_is_that_of_a_simulation_of_the_reversed_motion(base, amplitude, vertical):
    """Noise that fades, so that nothing is symmetric in time; it rocks, yields, overturns or flies.

    To rounding: left and right are not added up in the same order, and last bits grow on the way (here to 1e-11).
    """
    t = np.arange(600) * 0.01
    noise = np.random.default_rng(3).normal(0, 1, (2, 600)).cumsum(axis=1) * 0.1 * np.exp(-((t - 2) ** 2))
    noise = amplitude * noise / np.abs(noise).max()
    motion = rb.Motion("noise", 0.01, noise[0], 0.3 * noise[1] if vertical else None)
    there = run_to_tolerance(PIER, base, motion, 1e-4, 2.0)
    back = run_to_tolerance(PIER, base, replace(motion, horizontal=-motion.horizontal), 1e-4, 2.0)
    mirrored = asdict(there.mirrored())
    exact = ("status", "reason", "note", "impacts", "separations", "substeps", "theta_max_is", "failure", "observed")
    for name, value in asdict(back).items():
        if "not settled" in there.note and name in ("impacts", "separations", "flights", "note"):
            continue  # as of a pier that falls, and bounces on its edge on the way
        assert mirrored[name] == (
            value if name in exact or value is None else pytest.approx(value, rel=1e-9, abs=1e-12)
        )
    assert there.mirrored().mirrored() == there


def test_a_table_with_both_polarities_is_that_of_simulating_both(study):
    """One after the other, each alone, every column but the note itself."""
    both = rb.run(study())
    for sign in "+-":
        alone = rb.run(study(f'"{sign}"'))
        own = both[both["polarity"] == sign].drop(columns="mirror_of").reset_index(drop=True)
        pd.testing.assert_frame_equal(own, alone, rtol=1e-9, atol=1e-12)
    assert both.loc[both["polarity"] == "-", "theta_res_over_alpha"].abs().max() > 1e-3


# What is simulated


@pytest.mark.parametrize("polarity", [BOTH, '["-", "+"]'])
def test_of_both_polarities_one_is_simulated_and_both_have_rows(study, tmp_path, polarity):
    found, rows = carried_out(study(polarity), tmp_path)
    assert len(found) == len(set(found)) == ROWS // 2
    assert {sign for _, sign, _, _ in found} == {"+"}
    assert list(rows) == list(range(ROWS))
    assert {(row["polarity"], row["mirror_of"]) for row in rows.values()} == {("+", ""), ("-", "+")}


def test_one_polarity_alone_is_simulated_and_is_no_mirror_image(study, tmp_path):
    found, rows = carried_out(study('"-"'), tmp_path)
    assert {sign for _, sign, _, _ in found} == {"-"}
    assert len(found) == len(rows) == ROWS // 2
    assert "mirror_of" not in rows[0]


def test_shares_that_part_mirror_images_come_to_the_rows_of_one_run(study, tmp_path):
    """The first record has rows 0 to 3, and their mirror images are 4 to 7."""
    _, whole = carried_out(study(), tmp_path / "whole")
    for among, number in ((range(4), 4), (range(4, 8), 4), (range(2, 6), 4), (range(3, 8), 4)):
        folder = tmp_path / f"{among}"
        simulated, rows = carried_out(study(), folder, among)
        assert rows == {number: whole[number] for number in among}
        assert len(simulated) == len(set(simulated)) == number
        assert {sign for _, sign, _, _ in simulated} == {"+"}


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("lost", [0, 4])
def test_a_journal_that_has_lost_one_of_two_mirror_images_gets_that_one_again(study, tmp_path, lost):
    loaded = load_study(study())
    runs = Plan(loaded, ground_motions(loaded))
    _, whole = carried_out(study(), tmp_path / "whole")
    with Journal(tmp_path / "peaks.csv.part", columns(loaded), {}) as journal:
        for kept in (range(lost), range(lost + 1, len(runs))):
            execute_runs(runs, loaded.numerics, journal, Threads(1), observers_of(loaded.output), among=kept)
        assert list(to_simulate(runs, range(len(runs)), journal)) == [0]
        engine = Watched()
        execute_runs(runs, loaded.numerics, journal, engine, observers_of(loaded.output))
        assert len(engine.simulated) == 1
        assert journal[lost] == whole[lost]


# What is counted


@pytest.mark.slow
@pytest.mark.usefixtures("pages")
def test_statistics_checks_and_the_report_count_mirror_images_once(study, tmp_path, capsys):
    out = tmp_path / "both"
    assert main(["run", str(without_histories(study())), "--out", str(out)]) == 1  # the check fails
    told = capsys.readouterr()
    assert "2 records × 2 scales × 2 cases = 8 runs (polarity: mirror images, counted once)" in told.err
    assert json.loads((out / "run.json").read_text(encoding="utf-8"))["runs"] == ROWS // 2
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "8 runs. Opposite polarities are mirror images and counted once." in " ".join(page.split())
    alone = study('"+"')
    pd.testing.assert_frame_equal(rb.check(out), rb.check(rb.run(alone), study=alone))
    peaks = rb.open_results(out).peaks
    once = simulated(peaks)
    assert (len(peaks), len(once)) == (ROWS, ROWS // 2)
    assert suite(once["theta_max_over_alpha"].to_numpy(), list(once["status"])).count == ROWS // 2


def test_analyses_simulate_one_polarity_and_say_so(study, tmp_path, capsys):
    path = study()
    text = path.read_text(encoding="utf-8")
    path.write_text(text + "\n[spectrum]\nalpha = 0.2\np = [1, 2]\npoints = 2\n", encoding="utf-8")
    assert main(["spectrum", str(path), "--out", str(tmp_path / "out")]) == 0
    assert "spectra: 2 motions, 16 runs (polarity: mirror images, counted once)" in capsys.readouterr().err
    assert set(pd.read_csv(tmp_path / "out" / "spectrum.csv")["polarity"]) == {"+"}
    assert (pd.read_csv(tmp_path / "out" / "spectrum_suite.csv")["count"] == 2).all()


def test_the_row_of_a_run_that_was_simulated_names_no_mirror(study):
    loaded = load_study(study())
    runs = Plan(loaded, ground_motions(loaded))
    (run,) = simulations([runs[0]])
    outcome = run_to_tolerance(run.pier, run.base, run.motion, 1e-4, 2.0)
    assert row(runs[0]._replace(outcome=outcome))["mirror_of"] == ""
    assert row(runs[4]._replace(outcome=outcome.mirrored()))["mirror_of"] == "+"
