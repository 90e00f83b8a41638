"""The batch: every record in every case, in the order of the study, whatever the number of threads."""

import pickle
import subprocess
import threading

import numba
import numpy as np
import pandas as pd
import pytest
from studies import COSINE, PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
import rockbatch.batch.compiling
from rockbatch.batch.compiling import make_ready
from rockbatch.batch.digests import study_digests
from rockbatch.batch.execution import execute_runs
from rockbatch.batch.groups import groups, outcomes_of
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import Listener
from rockbatch.batch.observers import observers_of
from rockbatch.batch.plan import Plan, simulations
from rockbatch.batch.threads import Threads
from rockbatch.core.kernel import entry
from rockbatch.quantities.catalogue import FIXED, TRAILING, names
from rockbatch.results.columns import columns
from rockbatch.simulation import Stop, kept
from rockbatch.study import Output, load_study
from rockbatch.study.suite import ground_motions

STUDY = study_text(
    title="two pulses, three bases",
    motions={"polarity": ["+", "-"], "scale": [0.5, 1.0]},
    pulses=(SINE, COSINE),
    cases=(RIGID, PADS | {"beta": [30, 50], "epsilon": 0.1}),
)


@pytest.fixture
def study(tmp_path):
    return write_study(tmp_path, STUDY)


def test_kernels_of_damped_supports_and_of_dampers_are_made_ready_too(tmp_path, monkeypatch):
    """One run of each kind, and not of each number."""
    cases = (
        RIGID,
        {"name": "tied", "base": "rigid", "damper": [{"kind": "friction", "f": [0.1, 0.2]}]},
        {"name": "elastic", "base": "elastic", "beta": 40},
        {"name": "damped", "base": "elastic", "beta": 40, "zeta": [0.02, 0.05]},
    )
    loaded = load_study(write_study(tmp_path, study_text(cases=cases)))
    ready = []
    monkeypatch.setattr(rockbatch.batch.compiling, "outcomes_of", lambda runs, *rest: ready.extend(runs))
    make_ready(loaded, Listener())
    assert [run.case.name for run in ready] == ["rigid", "tied", "elastic", "damped"]


def test_processes_assist_once_a_kernel_must_be_compiled(tmp_path, monkeypatch):
    """The last kernels are compiled elsewhere, once each, and all are loaded here in the end."""
    cases = (RIGID, *({"name": f"n {n}", "base": "yielding", "eta": 2, "beta": 40, "n": n} for n in (2.5, 5)))
    loaded = load_study(write_study(tmp_path, study_text(cases=cases)))
    here, elsewhere, assisted = [], [], threading.Event()

    def compile_here(runs, *_):
        here.extend(run.case.name for run in runs)
        numba.njit(lambda x: 2.0 * x)(1.0)
        assert assisted.wait(60)

    def process(_, input, **__):
        elsewhere.append(pickle.loads(input)[0].case.name)
        if len(elsewhere) == 2:
            assisted.set()

    monkeypatch.setattr(rockbatch.batch.compiling, "cores", lambda: 2)
    monkeypatch.setattr(rockbatch.batch.compiling, "outcomes_of", compile_here)
    monkeypatch.setattr(subprocess, "run", process)
    said = Heard()
    make_ready(loaded, said)
    assert elsewhere == ["n 5", "n 2.5"]
    assert here == ["rigid", "rigid", "n 2.5", "n 5"]
    (sentence,) = said.said
    assert sentence.startswith("compiling the kernels")


def test_of_kernels_in_the_cache_nothing_is_said(study):
    make_ready(load_study(study), Listener())
    said = Heard()
    make_ready(load_study(study), said)
    assert said.said == []


def test_kernels_that_cannot_be_kept_are_mentioned_once_and_compiled_here_only(study, tmp_path, monkeypatch):
    """Of what other processes compile nothing would be found."""
    (tmp_path / "file").touch()
    monkeypatch.setenv("ROCKBATCH_CACHE", str(tmp_path / "file"))
    monkeypatch.setattr(kept._State, "reported", False)
    monkeypatch.setattr(kept._State, "reason", "")
    monkeypatch.setattr(rockbatch.batch.compiling, "cores", lambda: 8)
    monkeypatch.setattr(rockbatch.batch.compiling, "outcomes_of", lambda *_: entry(twice)(1.0))
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: pytest.fail("no process can help"))
    said = Heard()
    for _ in range(2):
        make_ready(load_study(study), said)
    compiling, reason, again = said.said
    assert compiling == again
    assert compiling.startswith("compiling the kernels")
    assert reason.startswith("compiled kernels are not kept, and the next command compiles them again: ")
    assert str(tmp_path / "file") in reason


def twice(x):
    return 2.0 * x


class Heard(Listener):
    """Remembers what is said."""

    def __init__(self):
        self.said = []

    def say(self, text):
        """See Listener."""
        self.said.append(text)


def test_rows_come_in_the_order_of_the_study(study):
    table = rb.run(study)
    assert list(table.columns) == [*names(FIXED), "beta", *names(TRAILING), "mirror_of"]
    assert len(table) == 2 * 2 * 2 * 3
    first = table.loc[:5, ["record", "polarity", "scale", "case", "beta"]].astype(object).where(table.notna(), None)
    cases = (("rigid", None), ("pads", 30.0), ("pads", 50.0))
    assert first.to_numpy().tolist() == [["one-sine", "+", scale, *case] for scale in (0.5, 1.0) for case in cases]


def test_results_do_not_depend_on_the_number_of_jobs_to_the_bit(study):
    pd.testing.assert_frame_equal(rb.run(study, jobs=1), rb.run(study, jobs=5), check_exact=True)


def test_polarity_mirrors_and_changes_no_peak(study):
    """−ü_g mirrors θ: the peak is the same, the residual rotation changes its sign."""
    table = rb.run(study)
    plus, minus = (table[table["polarity"] == sign].reset_index(drop=True) for sign in "+-")
    assert plus["theta_max_over_alpha"].to_numpy() == pytest.approx(minus["theta_max_over_alpha"].to_numpy(), rel=1e-12)
    residual = plus["theta_res_over_alpha"].to_numpy()
    assert residual == pytest.approx(-minus["theta_res_over_alpha"].to_numpy(), rel=1e-9, nan_ok=True)
    assert np.nanmax(np.abs(residual)) > 1e-3


def test_every_tolerated_row_has_an_error_below_the_tolerance(study):
    table = rb.run(study)
    assert (table["status"] == "ok").all()
    assert (table["note"] == "").all()
    assert (table["theta_max_error"] <= 1e-4).all()
    assert table["substeps"].gt(1).all()


def test_a_fixed_step_has_no_error_estimate(study):
    study.write_text(STUDY + "\n[numerics]\nsubsteps = 3\n", encoding="utf-8")
    table = rb.run(study)
    assert table["theta_max_error"].isna().all()
    assert table["substeps"].eq(3).all()


def test_a_scaled_motion_is_the_scaled_pulse(study):
    table = rb.run(study)
    row = table[(table["record"] == "one-sine") & (table["scale"] == 0.5) & (table["case"] == "rigid")].iloc[0]
    pulse = rb.pulse("sine", name="half", amplitude=0.5 * 9.81, period=0.5, dt=0.01, duration=4.0)
    pier = rb.Pier(0.2, 1.0)
    response = rb.simulate(pier, rb.RigidBase(), pulse)
    assert np.abs(response.theta).max() / pier.alpha == pytest.approx(row["theta_max_over_alpha"], rel=1e-4)


def test_a_folder_without_any_motion_is_a_mistake_that_says_so(study, tmp_path):
    (tmp_path / "empty").mkdir()
    with pytest.raises(rb.InputError, match="no ground motion"):
        rb.run(study, motions=tmp_path / "empty")


def plan_of(study):
    loaded = load_study(study)
    return loaded, Plan(loaded, ground_motions(loaded))


def test_a_plan_makes_each_run_when_it_is_asked_for(study):
    """Counted and indexed like a list; each scaled motion is made once for all of them."""
    _, runs = plan_of(study)
    assert len(runs) == 24
    table = [(run.record.name, run.polarity, run.scale, run.case.columns) for run in runs]
    assert [(run.record.name, run.polarity, run.scale, run.case.columns) for run in runs[5:9]] == table[5:9]
    assert runs[-1].record.name == "one-cosine"
    motions = [run.motion for run in simulations(runs)]
    assert motions[0] is motions[2]
    assert motions[3] is not motions[2]
    assert len({id(motion) for motion in motions}) == 8
    assert (motions[9].horizontal == -motions[3].horizontal).all()
    assert [run.pga for run in runs] == [motion.pga for motion in motions]
    with pytest.raises(IndexError):
        runs[24]


@pytest.mark.parametrize("jobs", [1, 2, 7])
def test_groups_take_every_run_once_and_in_order(study, jobs):
    loaded, runs = plan_of(study)
    found = list(groups(runs, loaded.numerics, jobs))
    assert [i for group in found for i in group] == list(range(24))


def test_a_group_is_closed_when_its_work_is_a_second(study, monkeypatch):
    loaded, runs = plan_of(study)
    monkeypatch.setattr(rockbatch.batch.groups, "STEPS_OF_A_GROUP", 1.0)
    assert [len(group) for group in groups(runs, loaded.numerics, 1)] == [1] * 24


class StopAfter(Stop):
    """Set when it has been looked at so many times: a thread that stops a group at a certain place of it."""

    def __init__(self, looks):
        self.looks, self.cell = looks, np.zeros(1, np.uint8)

    @property
    def flag(self):
        self.looks -= 1
        self.cell[0] = self.looks < 0
        return self.cell


@pytest.mark.slow
def test_a_group_that_is_stopped_anywhere_returns_whole_runs(study):
    """Once it is set, it is looked at no more than twice for each run."""
    loaded, runs = plan_of(study)
    chosen, observers = [runs[i] for i in (0, 1, 2, 7)], observers_of(Output.with_keys(rocking=True, forces=True))
    unstopped = StopAfter(10**6)
    whole = outcomes_of(chosen, loaded.numerics, observers, unstopped)
    assert None not in whole
    looks = 10**6 - unstopped.looks
    for number in range(looks):
        stop = StopAfter(number)
        found = outcomes_of(chosen, loaded.numerics, observers, stop)
        assert None in found
        assert all(outcome is None or repr(outcome) == repr(full) for outcome, full in zip(found, whole, strict=True))
        assert stop.looks >= -2 * len(chosen)
    assert looks > 10


def test_only_runs_that_are_wanted_and_not_in_the_journal_are_carried_out(study, tmp_path):
    """Numbers in the journal go on where an earlier part of it has ended."""
    loaded, runs = plan_of(study)
    simulated = []

    class Watched(Threads):
        def outcomes(self, runs, numerics, observers=()):
            simulated.append(len(runs))
            return super().outcomes(runs, numerics, observers)

    calls = []
    with Journal(tmp_path / "peaks.csv.part", columns(loaded), {}) as journal:
        for wanted in (range(5, 9), range(7, 12), range(7, 12)):
            numbers = range(100, 100 + len(runs))
            execute_runs(
                runs, loaded.numerics, journal, Watched(2), numbers=numbers, among=wanted, progress=calls.append
            )
        assert list(journal) == list(range(105, 112))
        assert journal[108]["record"] == runs[8].record.name
        assert float(journal[108]["beta"]) == runs[8].case.columns["beta"]
    assert simulated == [4, 3, 0]
    assert sum(calls) == 7


def test_digests_differ_by_what_rows_depend_on_and_by_nothing_else(study):
    """Runs that are finished stay good when a title, a comment or a check is changed."""

    def changed(*replaced):
        study.write_text(STUDY.replace(*replaced), encoding="utf-8")
        loaded = load_study(study)
        now = study_digests(loaded, ground_motions(loaded))
        return [name for name in now if now[name] != before[name]]

    loaded = load_study(study)
    before = study_digests(loaded, ground_motions(loaded))
    assert changed("two pulses", "2 pulses  # cosine and") == []
    assert changed("[motions]", '[output]\nhistories = "all"\n[motions]') == []
    assert changed("eta = 2.5", "eta = 2.6") == ["cases"]
    assert changed("[0.5, 1.0]", "[0.5, 1.1]") == ["scales"]
    assert changed("amplitude_g = 0.5", "amplitude_g = 0.51") == ["motions"]
    assert changed('"one-cosine"', '"cosine"') == ["motions"]
    assert changed("[motions]", "[numerics]\nquiet_s = 3\n[motions]") == ["numerics"]
    assert changed("[motions]", "[output]\nledger = true\n[motions]") == ["numerics"]
