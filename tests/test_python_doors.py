"""What commands do, from Python: the same folders and tables, and nothing on disk unless it is asked for."""

import json
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import pandas as pd
import pytest

import rockbatch as rb
import rockbatch.analyses.accuracy.error_and_time
import rockbatch.batch.threads
from rockbatch.commands.cli import main
from rockbatch.common.files import read_table

pytestmark = pytest.mark.usefixtures("pages")

STUDY = """
title = "Doors"

[pier]
alpha = 0.2
p = 1.0

[motions]
polarity = ["+", "-"]

[[motions.pulse]]
name = "one-sine"
shape = "sine"
amplitude_g = 1.0
period_s = 0.5
dt_s = 0.01
duration_s = 2.0

[[motions.pulse]]
name = "cosine"
shape = "cosine"
amplitude_g = 0.8
period_s = 0.6
dt_s = 0.01
duration_s = 2.0

[[case]]
name = "rigid"
base = "rigid"

[[case]]
name = "pads"
base = "yielding"
beta = [30, 50]
eta = 2.5

[[check]]
name = "rotation"
demand = "theta_max_over_alpha"
at_most = 0.5
reason = "what the bearings can follow"

[design]
vary = "pier.p"
between = [0.8, 1.2]
find = "greatest"
points = 2
width = 0.2

[fragility]
measure = "PGA"
levels_g = [0.4, 0.8, 1.6, 3.2]
method = "ida"
hunt_step = 0.2
tolerance = 0.2

[fragility.hazard]
levels_g = [0.2, 0.6]
rate_per_year = [0.01, 0.001]

[spectrum]
alpha = [0.15]
two_pi_over_p_s = [3.0, 8.0]
points = 3

[[spectrum.map]]
name = "sine"
shape = "sine"
frequency = [2.0, 6.0]
frequencies = 3
amplitude = [1.0, 8.0]
amplitudes = 4
tolerance = 0.4
width = 1.0

[sensitivity]
samples = 4

[sensitivity.uniform]
alpha = [0.18, 0.22]
eta = [2.2, 3.0]
"""
ANALYSES = {
    "design": ("design", "design_values", "design_checks", "design_runs"),
    "fragility": tuple(
        f"fragility{part}"
        for part in ("_scales", "", "_capacities", "_risk", "_runs")  # two records have no curve
    ),
    "spectrum": ("spectrum", "spectrum_suite", "overturning_map", "overturning_runs"),
    "sensitivity": ("sensitivity_runs", "sensitivity", "sobol"),
}
OF_TIME = {"created", "wall_s", "sha256", "command", "jobs"}


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    path = tmp_path_factory.mktemp("doors") / "study.toml"
    path.write_text(STUDY, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def commanded(study):
    """What the commands leave, a folder each."""
    for name in ("run", *ANALYSES):
        assert main([name, str(study), "--out", str(study.parent / name)]) in (0, 1)
    return study.parent


@pytest.fixture
def nowhere(monkeypatch, tmp_path):
    """The working folder, and the place of temporary files: both are empty."""
    for name in ("here", "temporary"):
        (tmp_path / name).mkdir()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    return tmp_path


def files(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


def untimed(path):
    """A JSON file but for what times it tells of, at the top and about the study."""
    return {name: value for name, value in json.loads(path.read_text(encoding="utf-8")).items() if name not in OF_TIME}


def assert_same_folder(one, other, csvs):
    kept, expected = ([name for name in files(folder) if not name.endswith(".part")] for folder in (one, other))
    assert kept == expected  # but for the runs of all searches, which a saved analysis has no use for
    for name in csvs:
        assert (one / name).read_bytes() == (other / name).read_bytes(), name
    for path in one.glob("*.json"):
        assert untimed(path) == untimed(other / path.name)


@pytest.mark.slow
def test_a_run_without_a_folder_leaves_no_file_and_gives_the_rows_of_the_table(study, commanded, nowhere):
    before = files(commanded)
    table = rb.run(study)
    assert files(commanded) == before
    assert files(nowhere) == []
    on_disk = rb.open_results(commanded / "run").peaks
    pd.testing.assert_frame_equal(table, on_disk, rtol=1e-9, check_dtype=False)


def test_a_run_into_a_folder_leaves_what_the_command_does(study, commanded, tmp_path):
    out = tmp_path / "out"
    table = rb.run(rb.load_study(study), out, jobs=1)
    assert_same_folder(out, commanded / "run", ["peaks.csv", "checks.csv"])
    pd.testing.assert_frame_equal(table, rb.open_results(commanded / "run").peaks, check_exact=True)
    ours, theirs = (
        rb.open_results(folder).history("one-sine", "rigid", polarity="+") for folder in (out, commanded / "run")
    )
    pd.testing.assert_frame_equal(ours, theirs, check_exact=True)
    told = json.loads((out / "run.json").read_text(encoding="utf-8"))["command"]
    assert told == ["rockbatch", "run", str(study), "--out", str(out)]
    assert "Doors" in (out / "report.html").read_text(encoding="utf-8")


@pytest.mark.slow
def test_an_interrupted_run_goes_on_from_python(study, commanded, tmp_path, monkeypatch):
    real, groups, out = rockbatch.batch.threads.outcomes_of, [], tmp_path / "out"
    monkeypatch.setattr(rockbatch.batch.groups, "LEAST_GROUP", 2)
    monkeypatch.setattr(rockbatch.batch.groups.groups, "__defaults__", (2,))

    def interrupted(runs, *more):
        groups.append(len(runs))
        if len(groups) == 2:
            raise KeyboardInterrupt
        return real(runs, *more)

    with monkeypatch.context() as patch:
        patch.setattr(rockbatch.batch.threads, "outcomes_of", interrupted)
        with pytest.raises(KeyboardInterrupt):
            rb.run(study, out, jobs=1)
    assert files(out) == ["peaks.csv.part"]
    counts = []
    rb.run(study, out, jobs=1, progress=lambda done, of: counts.append((done, of)))
    kept = json.loads((out / "run.json").read_text(encoding="utf-8"))["kept"]
    assert kept > 0
    assert (6 - kept, 6 - kept) in counts
    assert (out / "peaks.csv").read_bytes() == (commanded / "run/peaks.csv").read_bytes()
    counts.clear()
    rb.run(study, out, progress=lambda done, of: counts.append(of))
    assert 6 not in counts  # finished: histories alone are made again


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("name", ANALYSES)
def test_an_analysis_has_the_tables_of_the_command_and_saves_them(study, commanded, nowhere, name):
    before = files(commanded)
    found = getattr(rb, name)(study)
    assert files(commanded) == before
    assert files(nowhere) == []
    assert tuple(found.tables) == ANALYSES[name]
    assert found.files == ()
    for table in ANALYSES[name]:
        pd.testing.assert_frame_equal(
            getattr(found, table), read_table(commanded / name / f"{table}.csv"), check_exact=True
        )
        assert f"{table} ({len(found.tables[table])} rows)" in repr(found)
    assert f"<strong>{name} of &#x27;Doors&#x27;</strong>" in found._repr_html_()
    assert found._repr_html_().count("<td>rigid</td>") > 0
    saved = found.save(nowhere / "saved")
    assert_same_folder(nowhere / "saved", commanded / name, [f"{table}.csv" for table in ANALYSES[name]])
    assert sorted(path.name for path in saved) == files(nowhere / "saved")
    page = (nowhere / "saved/analyses.html").read_bytes()
    assert page == (commanded / name / "analyses.html").read_bytes()


@pytest.mark.parametrize("name", [pytest.param("spectrum", marks=pytest.mark.slow), "sensitivity"])
def test_what_was_saved_counts_as_finished(study, tmp_path, name, monkeypatch):
    """An analysis whose runs are in a folder, saved from Python, takes none of them again."""
    getattr(rb, name)(study).save(tmp_path)
    monkeypatch.setattr(rockbatch.batch.threads, "outcomes_of", None)
    assert getattr(rb, name)(study, tmp_path).files


def test_a_saved_analysis_leaves_no_table_of_an_earlier_one(study, tmp_path):
    stripes = tmp_path / "stripes.toml"
    stripes.write_text(STUDY.replace('method = "ida"\nhunt_step = 0.2\ntolerance = 0.2\n', ""), encoding="utf-8")
    found = rb.fragility(stripes)
    assert found.fragility_capacities is None
    (tmp_path / "fragility_capacities.csv").touch()
    found.save(tmp_path)
    assert not (tmp_path / "fragility_capacities.csv").exists()


def test_the_accuracy_is_saved_as_the_command_writes_it(study, nowhere, monkeypatch):
    monkeypatch.setattr(rockbatch.analyses.accuracy.error_and_time, "REPEATS", 1)
    found = rb.accuracy(study, runs=2)
    assert files(nowhere) == []
    assert set(found.accuracy["runs"]) == {2}
    assert [path.name for path in found.save(nowhere / "saved")] == ["accuracy.csv"]
    written = pd.read_csv(nowhere / "saved/accuracy.csv")
    numbers = found.accuracy.select_dtypes("number").astype("float64")
    np.testing.assert_allclose(written[numbers.columns].astype("float64"), numbers, rtol=1e-5)
    with pytest.raises(rb.InputError, match="runs = 0"):
        rb.accuracy(study, runs=0)
    with pytest.raises(rb.InputError, match="seconds = 0"):
        rb.accuracy(study, seconds=0)


@pytest.mark.slow
def test_a_report_is_made_of_one_folder_or_of_two(commanded, tmp_path):
    page = commanded / "run/report.html"
    earlier = page.read_bytes()
    page.unlink()
    made = rb.report(commanded / "run")
    assert made.path == page
    assert page.read_bytes() == earlier
    pd.testing.assert_frame_equal(made.peaks, rb.open_results(commanded / "run").peaks)
    assert set(made.checks["check"]) == {"rotation"}
    assert made.save(tmp_path / "copy").read_bytes() == earlier
    both = rb.report(commanded / "run", commanded / "run", out=tmp_path / "both.html")
    assert "two studies" in both.path.read_text(encoding="utf-8")
    assert both.peaks["study"].value_counts().to_dict() == {"A": len(made.peaks), "B": len(made.peaks)}
    whole = rb.report(commanded / "run", out=tmp_path / "whole.html", whole=True)
    assert whole.path.read_text(encoding="utf-8").count("<details open>") > 1
    copied = shutil.copytree(commanded / "run", tmp_path / "b")
    beside = rb.report(copied, commanded / "run", whole=True)
    assert beside.path == copied / "compare-run.html"
    assert "<details open>" in beside.path.read_text(encoding="utf-8")
    assert "two studies" in beside.save(tmp_path / "saved").read_text(encoding="utf-8")
    with pytest.raises(rb.InputError, match="not there"):
        rb.report(tmp_path)


def test_a_report_goes_to_the_standard_output_as_by_the_command(commanded, capfd):
    rb.report(commanded / "run", out="-")
    assert capfd.readouterr().out == (commanded / "run/report.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["run", *ANALYSES, "accuracy"])
def test_mistakes_are_reported_before_anything_is_written(study, nowhere, name):
    door, out = getattr(rb, name), nowhere / "out"
    broken = nowhere / "broken.toml"
    broken.write_text(STUDY.replace("eta = 2.5", "eta = 0.9\nbeat = 40"), encoding="utf-8")
    with pytest.raises(rb.InputError, match=r"broken\.toml:35"):
        door(broken, out)
    with pytest.raises(rb.InputError, match="no such file or folder"):
        door(rb.load_study(study), out, motions=nowhere / "missing")
    with pytest.raises(
        rb.InputError, match="motions = 3: must be a text, a path, a MotionSet, a Motion, a list of Motion or None"
    ):
        door(study, out, motions=3)
    with pytest.raises(rb.InputError, match="progress = 3"):
        door(study, out, progress=3)
    if name != "accuracy":
        with pytest.raises(rb.InputError, match="jobs = 0"):
            door(study, out, jobs=0)
    assert not out.exists()


def test_a_bar_is_drawn_where_it_is_asked_for(study, capfd):
    rb.run(study, progress=True)
    assert "/6 [" in capfd.readouterr().err


def test_without_a_word_a_bar_is_drawn_on_a_terminal_only(study, capfd, monkeypatch):
    from rockbatch.batch import listening

    monkeypatch.setattr(listening, "SHORT", 0.0)
    rb.run(study)
    assert capfd.readouterr().err == ""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    rb.run(study, progress=False)
    assert capfd.readouterr().err == ""
    rb.run(study)
    assert "/6 [" in capfd.readouterr().err


@pytest.mark.slow
def test_doors_are_cheap_until_they_are_opened_and_checking_never_loads_the_compiler(commanded):
    code = "import sys, rockbatch as rb\ndir(rb); rb.report; rb.load_study\n"
    code += "print([m for m in ('numba', 'obspy', 'h5py', 'matplotlib', 'scipy') if m in sys.modules])\n"
    code += f"from rockbatch.commands.cli import main; main(['check', {str(commanded / 'run')!r}])\n"
    code += "print([m for m in ('numba', 'obspy', 'matplotlib') if m in sys.modules])"
    lines = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.splitlines()
    assert (lines[0], lines[-1]) == ("[]", "[]")


def test_every_public_name_is_there():
    assert [name for name in rb.__all__ if not hasattr(rb, name)] == []
