"""Results are never replaced without a word, and those of another study not at all unless it is asked for."""

import pytest
from studies import RIGID, study_text, write_study

from rockbatch.commands.cli import main

SMALL = {"cases": (RIGID,), "output": {"histories": "none"}}


def run(study, out, *more):
    return main(["run", str(study), "--out", str(out), *more])


@pytest.fixture
def finished(tmp_path):
    """A study and its results."""
    study = write_study(tmp_path, study_text(title="Pier 4", **SMALL), "pier.toml")
    out = tmp_path / "reports" / "pier"
    run(study, out)
    return study, out


def test_an_earlier_version_is_named(finished, capsys):
    study, out = finished
    study.write_text(study.read_text(encoding="utf-8").replace("0.2", "0.21"), encoding="utf-8")
    capsys.readouterr()
    run(study, out)
    told = capsys.readouterr().err
    assert "the results of an earlier version of the study, of 20" in told
    assert f"in {out}, will be replaced" in told
    capsys.readouterr()
    run(study, out)
    assert "replaced" not in capsys.readouterr().err  # nothing is left to run


@pytest.mark.parametrize("title", ["Pier 4", "Pier 5"])
def test_another_study_of_the_same_name_does_not_take_its_place(finished, tmp_path, capsys, title):
    study, out = finished
    (tmp_path / "other").mkdir()
    other = write_study(
        tmp_path / "other", study_text(title=title, pier={"alpha": 0.3, "p": 1.0}, **SMALL), "pier.toml"
    )
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    capsys.readouterr()
    assert run(other, out) == 2
    told = capsys.readouterr().err
    assert f'{out} holds the results of another study, {study}, "Pier 4", of 20' in told
    assert "--out" in told
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before
    run(other, out, "--fresh")
    assert (out / "peaks.csv").read_bytes() != before["peaks.csv"]


def test_a_study_that_has_moved_is_known_by_its_title(finished, tmp_path, capsys):
    study, out = finished
    moved = study.rename(tmp_path / "renamed.toml")
    moved.write_text(moved.read_text(encoding="utf-8").replace("0.2", "0.21"), encoding="utf-8")
    capsys.readouterr()
    run(moved, out)
    assert "an earlier version of the study" in capsys.readouterr().err
    moved.unlink()
    other = write_study(tmp_path, study_text(title="Pier 5", **SMALL), "pier5.toml")
    assert run(other, out) == 2
    assert '"Pier 4"' in capsys.readouterr().err


OUTPUTS = {
    "run": (
        "peaks.csv",
        "run.json",
        "histories.h5",
        "intensity.csv",
        "checks.csv",
        "shocks.csv",
        "report.html",
    ),
    "design": ("design_runs.csv", "design.json"),
    "fragility": ("fragility_runs.csv", "fragility.json", "report.html"),
    "spectrum": ("spectrum_suite.csv", "overturning_map.csv"),
    "sensitivity": ("sobol.csv",),
    "accuracy": ("accuracy.csv", "accuracy.json"),
}


@pytest.mark.parametrize(("command", "name"), [(command, name) for command, names in OUTPUTS.items() for name in names])
def test_a_folder_called_like_an_output_is_noticed_before_the_first_run(tmp_path, capsys, command, name):
    text = study_text(
        check=[{"name": "rotation", "demand": "theta_max_over_alpha", "at_most": 0.5, "reason": "joints"}],
        design={"vary": "pier.p", "between": [0.8, 1.2], "find": "least", "width": 0.01},
        fragility={"measure": "PGA", "levels_g": [0.2, 0.4]},
        spectrum={"alpha": 0.2, "p": [1.0, 2.0]},
        sensitivity={"uniform": {"alpha": [0.1, 0.3]}},
    )
    study, out = write_study(tmp_path, text, "pier.toml"), tmp_path / "out"
    (out / name).mkdir(parents=True)
    assert main([command, str(study), "--out", str(out)]) == 2
    message = f"{out / name}: a folder, which is not replaced; move it away, or name another\n"
    assert capsys.readouterr().err == f"rockbatch: {message}"
    assert [path.name for path in out.iterdir()] == [name]


@pytest.mark.slow
def test_a_folder_called_like_an_unfinished_file_stops_nothing_and_stays(finished, capsys):
    study, out = finished
    (out / ".x.unfinished").mkdir()
    (out / ".y.unfinished").write_text("half")
    assert run(study, out, "--fresh") in (0, 1)
    assert (out / ".x.unfinished").is_dir()
    assert not (out / ".y.unfinished").exists()
