"""A cluster that is lost in the middle of an analysis: said in a sentence, and the same command goes on to the same bytes."""

import pytest
from many_runs import in_this_process
from studies import RIGID, study_text, write_study

from rockbatch.batch.dask import Dask
from rockbatch.commands.cli import main

__all__ = ["in_this_process"]

SPRUNG = {"name": "springs", "base": "elastic", "beta": 50.0}
CHECK = {"name": "peak", "demand": "theta_max_over_alpha", "at_most": 0.3, "reason": "made up"}
TABLES = {
    "run": {"cases": (SPRUNG, RIGID), "bound": [{"name": "soft", "case.beta": {"times": 0.8}}]},
    "design": {
        "cases": (SPRUNG,),
        "design": {"vary": "case.beta", "between": [30.0, 60.0], "find": "least", "points": 3, "width": 10.0},
    },
    "fragility": {"cases": (SPRUNG, RIGID), "fragility": {"measure": "PGA", "levels_g": [0.3, 0.6, 1.2]}},
}


def tables_in(folder):
    """Return the tables of a folder by name, but for what another number of workers is named in."""
    return {path.name: path.read_bytes() for path in folder.glob("*.csv")}


@pytest.mark.slow
@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("command", TABLES)
def test_an_analysis_whose_cluster_is_lost_goes_on_to_the_same_tables(tmp_path, capsys, monkeypatch, command):
    pytest.importorskip("distributed")
    study = write_study(tmp_path, study_text(check=[CHECK], output={"histories": "none"}, **TABLES[command]))
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
