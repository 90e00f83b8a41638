"""The exit code of an analysis is 1 if any of its runs failed, or a record cannot be used, whatever the analysis."""

from importlib import import_module

import pandas as pd
import pytest
from studies import RIGID, study_text, write_study

from rockbatch.analyses.design.analysis import DesignSearch
from rockbatch.analyses.fragility.analysis import Fragility
from rockbatch.analyses.sensitivity.analysis import Sensitivity
from rockbatch.analyses.spectrum.analysis import Spectrum
from rockbatch.commands.cli import main
from rockbatch.common.analyses import doors
from rockbatch.motions import Unusable
from rockbatch.terminal.analysis import finished
from rockbatch.workflow.analysis import Analysis

OF_RUNS = [(kind, name) for kind in (DesignSearch, Fragility, Sensitivity, Spectrum) for name in kind.RUNS]


def ended(kind, statuses, unusable=()):
    """An analysis of ``kind`` whose runs ended so, in each of its tables of runs."""
    tables = dict.fromkeys(kind.TABLES) | {
        name: pd.DataFrame({"status": of_runs}) for name, of_runs in statuses.items()
    }
    rest = {name: None for name in ("curves", "spec", "spectra", "maps") if name in kind.__dataclass_fields__}
    return kind(study=None, info={}, unusable=unusable, **tables, **rest)


@pytest.mark.parametrize(("kind", "name"), OF_RUNS)
def test_a_run_that_failed_is_counted_and_makes_the_exit_code_1(kind, name, capsys):
    assert finished(ended(kind, {name: ["ok", "overturned", "flight"]})) == 0
    assert capsys.readouterr().err == ""
    assert finished(ended(kind, {name: ["ok", "failed", "flight", "failed"]})) == 1
    assert capsys.readouterr().err == f"2 of 4 runs failed: see the column reason of {name}.csv\n"
    assert finished(ended(kind, {name: ["ok"]}, (Unusable("a", ("a.dat",), "empty"),))) == 1


def test_every_analysis_with_runs_of_its_own_says_which_tables_they_are_in():
    assert [kind.RUNS for kind in (DesignSearch, Fragility, Sensitivity)] == [
        ("design_runs",), ("fragility_runs",), ("sensitivity_runs",)
    ]  # fmt: skip
    assert Spectrum.RUNS == ("spectrum", "overturning_runs")
    for name in doors():
        module = import_module(f"rockbatch.analyses.{name}.analysis")
        for kind in vars(module).values():
            if isinstance(kind, type) and issubclass(kind, Analysis) and kind is not Analysis:
                assert {*kind.RUNS} <= {*kind.TABLES}


def test_a_sensitivity_with_failed_runs_ends_with_1(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("rockbatch.simulation.runs.MOST_STEPS", 10)
    inputs = {"statistic": "max", "samples": 8, "uniform": {"alpha": [0.18, 0.22]}}
    path = write_study(tmp_path, study_text(cases=(RIGID,), sensitivity=inputs))
    assert main(["sensitivity", str(path), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 1
    assert "runs failed: see the column reason of sensitivity_runs.csv\n" in capsys.readouterr().err
