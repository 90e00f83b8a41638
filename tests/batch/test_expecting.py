"""What a dry run says, held against what the run then leaves."""

import math
import re
from contextlib import contextmanager
from itertools import pairwise

import pytest
from studies import PADS, RIGID, study_text, write_study

from rockbatch.batch import expecting
from rockbatch.batch.expecting import expected
from rockbatch.batch.listening import Listener
from rockbatch.commands.cli import main
from rockbatch.commands.run import in_words
from rockbatch.study import load_study

CASES = (RIGID, PADS | {"beta": [30, 50], "eta": [2.5, 3.5]})


@pytest.fixture
def study(tmp_path):
    text = study_text(motions={"polarity": ["+", "-"], "scale": [0.5, 1.0, 1.5]}, cases=CASES)
    return write_study(tmp_path, text)


def test_runs_and_sizes_are_those_that_come_out(study, tmp_path, monkeypatch):
    monkeypatch.setattr(expecting, "SECONDS_TRIED", math.inf)
    found = expected(load_study(study), 2, Listener())
    out = tmp_path / "out"
    main(["run", str(study), "--out", str(out)])
    assert found.runs == 15  # of 30 rows half are mirror images
    assert found.tried == 15
    assert found.what == "1 record × 3 scales × 5 cases = 15 runs (polarity: mirror images, counted once)"
    assert found.table == pytest.approx((out / "peaks.csv").stat().st_size, rel=0.5)
    assert found.histories == pytest.approx((out / "histories.h5").stat().st_size, rel=0.5)


def test_of_a_share_its_runs_count_and_no_histories(study):
    whole, parts = load_study(study), []
    for number in (1, 2, 3):
        parts.append(expected(whole, 2, Listener(), (number, 3)))
        assert parts[-1].what.endswith(f"; share {number} of 3 is {parts[-1].runs} of them")
        assert parts[-1].histories == 0
    every = expected(whole, 2, Listener())
    assert sum(part.table for part in parts) == pytest.approx(every.table)
    assert all(0 < part.runs < every.runs for part in parts)


def test_what_a_run_refuses_its_dry_run_refuses(study, capsys):
    for wrong, words in (
        (["--shard", "1/100"], "rockbatch: --shard 1/100: the study has 15 simulations"),
        (["--history", "one"], "no such record"),
    ):
        assert main(["run", str(study), "--dry-run", *wrong]) == 2
        assert words in capsys.readouterr().err


def test_time_of_a_few_stands_for_all(study, monkeypatch):
    """A clock that counts steps: whatever is tried, the same is foreseen for all."""
    loaded, foreseen = load_study(study), []
    for tried in (1, 7, 15):
        steps, outcomes_of = [0.0], expecting.outcomes_of

        def counted(runs, *rest, steps=steps, outcomes_of=outcomes_of):
            steps[0] += sum(expecting.least_steps(run, loaded.numerics) for run in runs)
            return outcomes_of(runs, *rest)

        monkeypatch.setattr(expecting, "TRIED", tried)
        monkeypatch.setattr(expecting, "SECONDS_TRIED", math.inf)
        monkeypatch.setattr(expecting, "outcomes_of", counted)
        monkeypatch.setattr(expecting.time, "perf_counter", lambda steps=steps: steps[0])
        found = expected(loaded, 1, Listener())
        assert found.tried == tried
        foreseen.append(found.seconds)
        monkeypatch.undo()
    assert foreseen == pytest.approx([steps[0]] * 3)  # those of all 15
    assert expected(loaded, 1, Listener()).seconds < 60.0


def test_runs_are_tried_on_all_threads_until_the_time_is_up_and_that_is_shown(study, monkeypatch):
    shares, shown = [], []

    class Watching(Listener):
        @contextmanager
        def progress(self, total):
            yield lambda more: shown.append((more, total))

    outcomes_of = expecting.outcomes_of

    def watched(runs, *rest):
        shares.append(len(runs))
        return outcomes_of(runs, *rest)

    monkeypatch.setattr(expecting, "outcomes_of", watched)
    monkeypatch.setattr(expecting, "SECONDS_TRIED", math.inf)
    every = expected(load_study(study), 2, Watching())
    assert (every.tried, every.jobs) == (15, 2)
    assert sorted(shares) == [1, 1, 1, 2, 2, 4, 4]
    assert shown == [(2, 15), (4, 15), (8, 15), (1, 15)]
    monkeypatch.setattr(expecting, "SECONDS_TRIED", 0.0)
    assert expected(load_study(study), 2, Watching()).tried == 2


def test_nothing_is_written(study, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(expecting, "SECONDS_TRIED", math.inf)
    before = sorted(tmp_path.rglob("*"))
    assert main(["run", str(study), "--dry-run", "--jobs", "1"]) == 0
    assert sorted(tmp_path.rglob("*")) == before
    told = capsys.readouterr().out
    assert "= 15 runs" in told
    assert "on 1 thread, measured on 15 of them" in told
    sizes = re.search(r"^peaks\.csv: about (\S+) MB; histories: about (\S+) MB$", told, re.MULTILINE).groups()
    found = expected(load_study(study), 1, Listener())
    assert [1e6 * float(size) for size in sizes] == pytest.approx([found.table, found.histories], rel=0.05)


def test_runs_that_are_tried_are_spread_and_not_too_many_steps(monkeypatch):
    steps = [1e6] * 90 + [1e9] * 10
    chosen = expecting._spread(steps)
    assert sum(steps[i] for i in chosen) <= max(expecting.STEPS_TRIED, 1e9)
    assert len(set(chosen)) == len(chosen) >= 1
    assert expecting._spread([1e12]) == [0]
    monkeypatch.setattr(expecting, "STEPS_TRIED", 8.0)
    few = sorted(expecting._spread([1.0] * 1000))
    assert max(after - before for before, after in pairwise([0, *few, 1000])) < 400  # and not the first ones
    monkeypatch.setattr(expecting, "STEPS_TRIED", 100.0)
    monkeypatch.setattr(expecting, "TRIED", 10)
    assert sorted(expecting._spread([1.0] * 100)) == [round(10 * i + 4.5) for i in range(10)]


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(0.3, "less than 1 s"), (40.4, "about 40 s"), (600.0, "about 10 min"), (12600.0, "about 3.5 h")],
)
def test_times_are_in_words(seconds, words):
    assert in_words(seconds) == words
