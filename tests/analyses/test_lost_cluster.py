"""A cluster that is lost in the middle of an analysis: said in a sentence, and the same command goes on to the same bytes."""

import signal

import pytest
from clusters import WORKER, cluster
from many_runs import in_this_process
from studies import seven_pulses
from three_commands import TABLES, study_of, tables_in

from rockbatch.batch.dask import Dask
from rockbatch.batch.journal import Journal
from rockbatch.commands.cli import main

__all__ = ["in_this_process"]


@pytest.mark.slow
@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("command", TABLES)
def test_an_analysis_whose_cluster_is_lost_goes_on_to_the_same_tables(tmp_path, capsys, monkeypatch, command):
    pytest.importorskip("distributed")
    study = study_of(command, tmp_path)
    lost, whole = tmp_path / "lost", tmp_path / "whole"
    real, seen = Dask._finished_of, []

    def finished_of(self, client, pending):
        seen.append(len(pending))
        if len(seen) > 1:
            raise OSError("timed out")
        return real(self, client, pending)

    with monkeypatch.context() as patch:
        patch.setattr(Dask, "_finished_of", finished_of)
        patch.setattr("rockbatch.batch.dask.MOST_RUNS_OF_A_TASK", 1)
        patch.setattr("rockbatch.batch.groups.LEAST_GROUP", 1)
        assert main([command, str(study), "--out", str(lost), "--engine", "dask", "--jobs", "1"]) == 2
    said = capsys.readouterr().err
    assert len(seen) == 2
    assert "lost (timed out); give the same command again to go on" in " ".join(said.split())
    assert "Traceback" not in said
    status = main([command, str(study), "--out", str(lost), "--jobs", "1"])
    assert "finished already" in capsys.readouterr().err
    assert main([command, str(study), "--out", str(whole), "--jobs", "1"]) == status
    assert status in (0, 1)
    assert tables_in(lost) == tables_in(whole)


def numbers_kept(folder):
    """Return the numbers of the finished runs in the journal of a folder."""
    (part,) = folder.glob("*.part")
    return {int(line.split(b",")[0].split()[1]) for line in part.read_bytes().splitlines()[1:]}


@pytest.fixture
def many_groups(tmp_path, monkeypatch):
    """A function that writes the study of a command, each of whose runs is a task, and returns its file."""
    pytest.importorskip("distributed")
    monkeypatch.setattr("rockbatch.batch.dask.MOST_RUNS_OF_A_TASK", 1)
    monkeypatch.setattr("rockbatch.batch.groups.LEAST_GROUP", 1)
    return lambda command: study_of(command, tmp_path, seven_pulses(0.6))


def killing(patch, processes):
    """Kill each process (SIGKILL) when as many groups as its key are finished."""
    real, kept = Dask.outcomes, []

    def outcomes(self, *asked):
        for group in real(self, *asked):
            yield group
            kept.append(group)
            if process := processes.get(len(kept)):
                process.kill()
                process.wait()

    patch.setattr(Dask, "outcomes", outcomes)
    return kept


@pytest.mark.thorough
@pytest.mark.parametrize("command", TABLES)
def test_an_analysis_goes_on_without_a_worker_that_is_killed(tmp_path, many_groups, monkeypatch, command):
    """The other worker takes over its runs and its records."""
    study, on_cluster, by_threads = many_groups(command), tmp_path / "cluster", tmp_path / "threads"
    with cluster(tmp_path, WORKER, workers=2) as lost, monkeypatch.context() as patch:
        kept = killing(patch, {3: lost.workers[0]})
        status = main([command, str(study), "--out", str(on_cluster), "--scheduler", lost.address])
        assert lost.workers[0].returncode == -signal.SIGKILL
    assert len(kept) >= 14
    assert main([command, str(study), "--out", str(by_threads), "--jobs", "1"]) == status
    assert tables_in(on_cluster) == tables_in(by_threads)


@pytest.mark.thorough
@pytest.mark.parametrize("command", TABLES)
def test_an_analysis_whose_scheduler_is_killed_keeps_every_row(tmp_path, many_groups, monkeypatch, capsys, command):
    """After the death of a worker, too; what is finished is carried out by nobody again."""
    study, lost, whole = many_groups(command), tmp_path / "lost", tmp_path / "whole"
    with cluster(tmp_path, WORKER, workers=2) as mortal, monkeypatch.context() as patch:
        kept = killing(patch, {3: mortal.workers[0], 9: mortal.scheduler})
        assert main([command, str(study), "--out", str(lost), "--scheduler", mortal.address]) == 2
    said = " ".join(capsys.readouterr().err.split())
    assert f"{mortal.address}: lost (" in said
    assert "give the same command again to go on, with a scheduler and workers that are there" in said
    assert "Traceback" not in said
    before = numbers_kept(lost)
    assert len(before) >= len(kept) >= 9
    real, added = Journal.add_columns, []
    with monkeypatch.context() as patch:
        patch.setattr(Journal, "add_columns", lambda *row: (added.extend(row[1]), real(*row))[1])
        status = main([command, str(study), "--out", str(lost), "--jobs", "1"])
    assert added
    assert not before & {*added}
    assert main([command, str(study), "--out", str(whole), "--jobs", "1"]) == status
    assert tables_in(lost) == tables_in(whole)
