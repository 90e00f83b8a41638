"""Tables beside peaks.csv are read with the runs, and are the same whenever and by whatever their runs are carried out."""

import pytest
from studies import COSINE, PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
import rockbatch.batch.beside
import rockbatch.batch.threads
from rockbatch.batch.beside import MOST_OF_A_CELL, packed, rows_beside, unpacked
from rockbatch.batch.groups import outcomes_of
from rockbatch.commands.cli import main
from rockbatch.outcome.outcome import Outcome
from rockbatch.results.columns import StudyRun

TABLES = ("half_cycles.csv", "sections.csv", "shocks.csv")
PIER = {"width_m": 3.0, "height_m": 14.0, "mass_t": 400.0}
PULSES = [SINE | {"duration_s": 2.0}, COSINE | {"duration_s": 2.0}]
SEQUENCE = [{"name": "twice", "records": ["one-sine", "one-cosine"], "pause_s": 3.0, "alone": True}]
ALL = {"half_cycles": True, "sections": 2, "histories": "none"}


def study_of(folder, output):
    motions = {"sequence": SEQUENCE, "polarity": ["+", "-"]}
    return write_study(
        folder, study_text(pier=PIER, pulses=PULSES, cases=[RIGID, PADS], motions=motions, output=output)
    )


def tables(folder):
    return {name: (folder / name).read_bytes() for name in TABLES}


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    folder = tmp_path_factory.mktemp("whole")
    rb.run(study_of(folder, ALL), folder / "out", jobs=1)
    return tables(folder / "out")


@pytest.fixture
def again(monkeypatch):
    """Numbers of observers of each run that is recorded again."""
    found = []
    read = rockbatch.batch.beside.read_again

    def counting(planned, row, observers, numerics):
        found.append(len(observers))
        return read(planned, row, observers, numerics)

    monkeypatch.setattr(rockbatch.batch.beside, "read_again", counting)
    return found


def test_no_run_is_recorded_again_for_its_tables(tmp_path, expected, again):
    rb.run(study_of(tmp_path, ALL), tmp_path / "out", jobs=2)
    assert tables(tmp_path / "out") == expected
    assert again == []


def test_a_batch_without_tables_beside_looks_at_no_run():
    """A million of them would take a minute."""
    assert rows_beside([], None, None, None, None, 1, None) == {}


def test_an_interrupted_batch_keeps_the_rows_of_its_tables(tmp_path, expected, again, monkeypatch):
    path, groups = study_of(tmp_path, ALL), []

    def interrupted(*asked):
        groups.append(asked)
        if len(groups) > 1:
            raise KeyboardInterrupt
        return outcomes_of(*asked)

    monkeypatch.setattr(rockbatch.batch.threads, "outcomes_of", interrupted)
    monkeypatch.setattr(rockbatch.batch.groups, "LEAST_GROUP", 3)
    with pytest.raises(KeyboardInterrupt):
        rb.run(path, tmp_path / "out", jobs=1)
    monkeypatch.setattr(rockbatch.batch.threads, "outcomes_of", outcomes_of)
    rb.run(path, tmp_path / "out", jobs=1)
    assert tables(tmp_path / "out") == expected
    assert again == []


def test_joined_shares_bring_the_rows_of_their_tables(tmp_path, expected, again):
    path = study_of(tmp_path, ALL)
    shares = [str(tmp_path / f"share{i}") for i in (1, 2)]
    for i, share in enumerate(shares, 1):
        assert main(["run", str(path), "--out", share, "--shard", f"{i}/2"]) == 0
    assert main(["merge", str(path), *shares, "--out", str(tmp_path / "out")]) == 0
    assert tables(tmp_path / "out") == expected
    assert again == []


def test_tables_that_are_asked_for_later_are_read_from_the_finished_runs(tmp_path, expected, again):
    rb.run(study_of(tmp_path, {"histories": "none"}), tmp_path / "out", jobs=1)
    peaks = (tmp_path / "out" / "peaks.csv").read_bytes()
    rb.run(study_of(tmp_path, ALL), tmp_path / "out", jobs=2)
    assert tables(tmp_path / "out") == expected
    assert set(again) == {3}
    assert (tmp_path / "out" / "peaks.csv").read_bytes() == peaks


def test_rows_of_a_cell_come_back_to_the_bit_unless_they_are_too_many():
    rows = [{"a": 0.1 + 0.2, "b": None, "c": float("inf"), "d": 'x,"y"\n', "n": 3}]
    outcome = Outcome("ok", "", 0.0, 0.0, 0, 0, None, 0.0, 1)
    run = StudyRun(None, "+", 1.0, None)
    assert packed(run, "t") == packed(run._replace(outcome=outcome), "t") == ""
    cell = packed(run._replace(outcome=outcome.with_table("t", rows)), "t")
    assert unpacked(cell) == rows
    assert not set(cell) & set(',"\n')
    many = [{"x": i * 0.1 + 1e-9 * i**2} for i in range(MOST_OF_A_CELL)]
    assert packed(run._replace(outcome=outcome.with_table("t", many)), "t") == ""
