"""``rockbatch accuracy``: what it measures is the error, and the report shows it. Times are never asserted."""

import csv
import itertools
import math
import re
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch.analyses.accuracy.error_and_time
from rockbatch.analyses.accuracy import DOOR
from rockbatch.analyses.accuracy.error_and_time import SUBSTEPS, Clock, measure, reference, references, spread
from rockbatch.analyses.accuracy.levels import COLUMNS
from rockbatch.analyses.accuracy.section import section
from rockbatch.batch.listening import Listener
from rockbatch.batch.plan import Plan, simulations
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.pier import YieldingBase
from rockbatch.reporting.finished_analysis import Contents
from rockbatch.simulation import run_fixed
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

STUDY = study_text(
    title="two pulses, three bases", pier={"alpha": 0.15, "p": 1.0}, motions={"scale": [0.9, 1.0]},
    pulses=(
        SINE | {"name": "ricker", "shape": "ricker", "amplitude_g": 0.6, "period_s": 1.0, "dt_s": 0.02},
        SINE | {"name": "sine", "amplitude_g": 0.5, "period_s": 0.8, "dt_s": 0.02},
    ),
    cases=(RIGID, PADS | {"beta": [20, 40], "epsilon": 0.1}), numerics={"tolerance": 1e-5}, output={"histories": "all"},
)  # fmt: skip


SMALL = study_text(
    motions={"scale": [0.8, 1.0]}, pulses=(SINE | {"duration_s": 1.0},), cases=(RIGID, PADS | {"beta": [20, 40]}),
    output={"histories": "all"},
)  # fmt: skip


@pytest.fixture
def study_file(tmp_path):
    return write_study(tmp_path, SMALL)


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """The study, the references of its runs, and the table."""
    path = write_study(tmp_path_factory.mktemp("accuracy"), STUDY)
    study = load_study(path)
    references = [reference(run, study.numerics.quiet_s) for run in Plan(study, ground_motions(study))]
    assert None not in references
    return study, references, measure(study, references)


def order(table, method, column):
    """Slope of log error over log k, with the sign of an order of convergence, over k = 1 … 16."""
    errors = table[table["method"] == method].set_index("substeps")[column].loc[[1, 2, 4, 8, 16]]
    return -np.polyfit(np.log2(errors.index.astype(float)), np.log2(errors.to_numpy(float)), 1)[0]


@pytest.mark.slow
def test_located_events_keep_the_fourth_order_and_unlocated_ones_lose_three(measured):
    """Classical Runge–Kutta is of order 4; an event half a step late leaves an error of the order of the step.

    Where in its step an event falls is chance, so the errors scatter: the slopes are told from their neighbours, no
    more.
    """
    _, _, table = measured
    assert order(table, "located", "error_median") == pytest.approx(4.0, abs=0.5)
    assert order(table, "located", "error_max") == pytest.approx(4.0, abs=0.5)
    assert order(table, "not located", "error_max") == pytest.approx(1.0, abs=0.5)


def test_the_setting_of_the_study_keeps_its_tolerance(measured):
    study, references, table = measured
    (row,) = table[table["method"] == "study"].to_dict("records")
    assert row["tolerance"] == study.numerics.tolerance
    assert row["runs"] == len(references) == 12
    assert 0.0 < row["error_max"] <= study.numerics.tolerance


def test_a_fixed_number_of_substeps_is_its_own_setting(measured):
    study, references, _ = measured
    fixed = replace(study, numerics=replace(study.numerics, tolerance=None, substeps=4))
    (row,) = measure(fixed, references[:2]).tail(1).to_dict("records")
    assert row["method"] == "study"
    assert row["substeps"] == 4
    assert math.isnan(row["tolerance"])
    expected = [
        abs(run_fixed(run.pier, run.base, run.motion, 4).theta_max - r.outcome.theta_max) / 0.15
        for r in references[:2]
        for run in simulations([r.run])
    ]
    assert row["error_max"] == pytest.approx(max(expected), abs=1e-15)


@pytest.mark.slow
def test_runs_that_end_otherwise_are_counted_and_have_no_error(measured):
    study, references, _ = measured
    over = [replace(one, outcome=replace(one.outcome, status="overturned")) for one in references[:2]]
    table = measure(study, [*over, references[2]])
    assert set(table["status_differs"]) == {2}
    assert (table["error_max"] == table["error_median"]).all()  # of the one that is left
    assert measure(study, over)["error_max"].isna().all()


def test_an_error_is_no_less_than_what_its_reference_is_known_to(measured):
    """Steps of the reference have its very peak: an error of 0, of a peak that is known to 1e-9."""
    study, references, _ = measured
    one = replace(references[0], change=1e-9)
    (simulation,) = simulations([one.run])
    outcome = run_fixed(simulation.pier, simulation.base, simulation.motion, 32, study.numerics.quiet_s)
    table = measure(study, [replace(one, outcome=outcome)])
    finest = table[(table["method"] == "located") & (table["substeps"] == 32)]
    assert finest["error_max"].tolist() == [1e-9]
    assert table["error_max"].min() == 1e-9 < table["error_max"].max()


def test_a_study_whose_runs_all_overturn_says_that_there_is_no_error(tmp_path, capsys):
    pulses = (SINE | {"amplitude_g": 2.0, "period_s": 2.0, "duration_s": 3.0},)
    text = study_text(pier={"alpha": 0.1, "p": 3.0}, motions={}, pulses=pulses, cases=(RIGID,))
    assert main(["accuracy", str(write_study(tmp_path, text)), "--out", str(tmp_path / "out"), "--runs", "1"]) == 0
    printed = capsys.readouterr().out
    assert "No error is known for the setting of this study" in printed
    with open(tmp_path / "out" / "accuracy.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {(row["runs"], row["compared"], row["error_max"]) for row in rows} == {("1", "0", "")}


def test_a_reference_has_the_outcome_of_the_step_before_and_its_peak_too(measured, monkeypatch):
    """One that overturns has no peak to compare; the same outcome twice is what counts."""
    run = measured[1][0].run
    pier = run.case.pier
    coarse = replace(measured[1][0].outcome, status="ok", theta_max=0.05)
    fallen = replace(coarse, status="overturned", theta_max=0.5 * math.pi)
    changed = replace(coarse, theta_max=0.05 + 1e-13 * pier.alpha)
    for script, expected in (
        ([coarse, fallen, coarse, changed], changed),
        ([coarse, fallen, fallen], fallen),
        ([fallen, coarse, changed], changed),
        ([replace(coarse, status="failed")] * 40, None),
    ):
        steps, left = [], iter(script)

        def scripted(pier, base, motion, substeps, quiet_s, left=left, steps=steps):
            steps.append(substeps)
            return next(left)

        monkeypatch.setattr(rockbatch.analyses.accuracy.error_and_time, "run_fixed", scripted)
        found = reference(run, 2.0)
        assert (found and found.outcome) == expected
        assert [after / before for before, after in itertools.pairwise(steps)] == [2.0] * (len(steps) - 1)
        assert expected is None or (len(steps), found.change) == (len(script), 1e-12)  # what a reference is known to


@pytest.mark.slow
def test_steps_that_are_too_long_to_be_run_have_neither_error_nor_time(measured):
    study, _, _ = measured
    run = Plan(study, ground_motions(study))[1]
    stiff = run._replace(case=replace(run.case, base=YieldingBase(beta=500.0, eta=2.5)))
    table = measure(study, [reference(stiff, 2.0)]).set_index(["method", "substeps"])
    assert table.loc[("located", 1), "status_differs"] == 1  # ω_v h = 10
    assert table.loc[("located", 1), ["error_max", "seconds_per_run"]].isna().all()
    assert table.loc[("located", 32), "status_differs"] == 0
    assert table.loc[("located", 32), "error_max"] < 1e-3


def test_runs_are_spread_over_the_study(measured):
    runs = [one.run for one in measured[1]]
    places = {id(run): place for place, run in enumerate(runs)}
    for most, kept in ((12, list(range(12))), (99, list(range(12))), (5, [0, 3, 6, 8, 11]), (1, [0])):
        assert [places[id(run)] for run in spread(runs, most)] == kept


class Heard(Listener):
    """Keeps what is said, and how much was done of how much."""

    def __init__(self):
        self.said, self.counts = [], []

    def say(self, text):
        self.said.append(text)

    @contextmanager
    def progress(self, total):
        self.counts.append([0, total])

        def told(more):
            self.counts[-1][0] += more

        yield told


class Scripted(Clock):
    """A clock with time for so many questions, and none after them."""

    def __init__(self, questions):
        super().__init__()
        self.questions = questions

    def remaining(self, share=1.0):
        self.questions -= 1
        return math.inf if self.questions >= 0 else -1.0


def test_references_stop_in_time_and_are_spread_over_the_study_wherever_they_do(measured):
    study, every, _ = measured
    motions, heard = ground_motions(study), Heard()
    kept = references(study, motions, 12, heard, Scripted(2))
    assert len(kept) == 2
    assert [one.outcome.theta_max for one in kept] == [every[i].outcome.theta_max for i in (0, 5)]
    assert heard.counts == [[2, 12]]
    assert "left out, for want of time: 10 runs (--seconds gives more)" in heard.said
    with pytest.raises(InputError, match="give it more time"):
        references(study, motions, 12, Listener(), Scripted(0))


def test_without_time_the_setting_of_the_study_is_measured_and_nothing_else(measured):
    study, every, _ = measured
    heard = Heard()
    table = measure(study, every[1:3], listener=heard, clock=Clock(1e-9))
    assert table["method"].to_list() == ["study"]
    assert heard.counts == [[2, 2 * (1 + 2 * len(SUBSTEPS))]]
    assert table["error_max"][0] <= study.numerics.tolerance
    assert [told for told in heard.said if told.startswith("left out")] == [
        "left out, for want of time: from 1 steps per sample on",
    ]


@pytest.fixture
def brief(monkeypatch):
    """One pass: the rows are what matters."""
    monkeypatch.setattr(rockbatch.analyses.accuracy.error_and_time, "REPEATS", 1)


@pytest.mark.usefixtures("pages")
def test_the_command_writes_its_table_and_the_report_shows_it(study_file, tmp_path, brief):
    out = tmp_path / "out"
    assert main(["run", str(study_file), "--out", str(out)]) == 0
    assert "Measured on" not in (out / "report.html").read_text(encoding="utf-8")
    assert main(["accuracy", str(study_file), "--out", str(out), "--runs", "5"]) == 0
    with open(out / "accuracy.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert tuple(rows[0]) == COLUMNS
    fixed = [("located", str(k)) for k in SUBSTEPS] + [("not located", str(k)) for k in SUBSTEPS]
    assert [(row["method"], row["substeps"]) for row in rows] == [*fixed, ("study", "")]
    assert [row["runs"] for row in rows] == ["5"] * 13
    assert ">Histories<" in (out / "report.html").read_text(encoding="utf-8")

    page = (out / "report.html").read_text(encoding="utf-8")
    assert "Measured on" in page
    assert "k = 16" in page
    assert section(Contents(out, {"sha256": "of another state"})) == ""


def test_without_results_there_is_a_table_but_no_report(study_file, tmp_path, brief):
    out = tmp_path / "out"
    assert main(["accuracy", str(study_file), "--out", str(out), "--runs", "1"]) == 0
    assert [file.name for file in out.iterdir()] == ["accuracy.csv"]
    assert re.findall(r"\w+\.\w+", DOOR.writes) == ["accuracy.csv", "report.html"]  # this one beside results
    with open(out / "accuracy.csv", encoding="utf-8", newline="") as file:
        methods = {row["method"] for row in csv.DictReader(file)}
    assert methods == {"located", "not located", "study"}


def test_an_earlier_option_is_taken_and_a_time_of_zero_refused(study_file, tmp_path, brief, capsys):
    assert main(["accuracy", str(study_file), "--out", str(tmp_path), "--runs", "1", "--no-scipy"]) == 0
    with pytest.raises(SystemExit) as ended:
        main(["accuracy", str(study_file), "--seconds", "0"])
    assert ended.value.code == 2
    assert "must be above 0" in capsys.readouterr().err


@pytest.mark.parametrize(
    "content", ["method,study\nlocated\n", "method,study\nlocated,x\n", ",".join(COLUMNS) + "\n" + 13 * "x,", "\0"]
)
def test_a_damaged_table_is_left_out(tmp_path, content):
    (tmp_path / "accuracy.csv").write_text(content, encoding="utf-8")
    assert section(Contents(tmp_path, {"sha256": "x"})) == ""


def test_a_table_of_an_earlier_version_says_what_to_run(tmp_path):
    """It has no column with the number of runs that were compared."""
    names = [name for name in COLUMNS if name != "compared"]
    (tmp_path / "accuracy.csv").write_text(
        f"{','.join(names)}\n{','.join(OWN[name] for name in names)}\n", encoding="utf-8"
    )
    assert "Of an earlier version; run `rockbatch accuracy` again." in section(Contents(tmp_path, {"sha256": "x"}))


def test_runs_that_never_settle_are_counted(study_file, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(rockbatch.analyses.accuracy.error_and_time, "ACCEPTED", -1.0)
    assert main(["accuracy", str(study_file), "--out", str(tmp_path / "out"), "--runs", "1"]) == 2
    assert "settles" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


OWN = {
    "method": "study", "substeps": "", "tolerance": "1e-5", "runs": "4", "compared": "4", "error_median": "1e-7",
    "error_95": "2e-6", "error_max": "3e-6", "seconds_per_run": "0.002", "status_differs": "0", "reference_change": "1e-10",
    "machine": "here", "study": "x",
}  # fmt: skip
FIXED = OWN | {"method": "located", "substeps": "2", "tolerance": "", "error_max": "1e-3"}


@pytest.mark.parametrize(("change", "words", "marked"), [
    ({}, "(tolerance 1e-05) the peak θmax/α is off by 3.0e-06 at most over 4 runs, and a run takes 2 ms.", []),
    ({"tolerance": "", "substeps": "8"}, "(8 steps per sample) the peak", []),
    ({"error_max": "2e-5"}, "off by 2.0e-05 at most", ["that is more than the tolerance"]),
    ({"status_differs": "1"}, "", ["1 of these runs ends otherwise than the reference, and has no error"]),
    ({"status_differs": "2"}, "", ["2 of these runs end otherwise than the reference, and have no error"]),
    ({"reference_change": "3e-6"}, "", ["the references themselves are known to 3e-06 only"]),
    ({"compared": "3"}, "off by 3.0e-06 at most over 3 of 4 runs", []),
    ({"error_max": ""}, "", ["no measured run with it ends standing as its reference does"]),
])  # fmt: skip
def test_the_page_opens_with_error_and_time_and_marks_omissions(tmp_path, change, words, marked):
    with open(tmp_path / "accuracy.csv", "w", encoding="utf-8", newline="") as file:
        rows = csv.DictWriter(file, COLUMNS)
        rows.writeheader()
        rows.writerows([FIXED, OWN | change])
    first = section(Contents(tmp_path, {"sha256": "x"})).split("<figure", 1)[0]
    spans = [" ".join(span.split()) for span in re.findall(r'<span class="undecided">(.*?)</span>', first, re.DOTALL)]
    assert words in " ".join(re.sub("<.*?>", "", first).split())
    assert len(spans) == len(marked)
    assert all(part in span for part, span in zip(marked, spans, strict=True))
