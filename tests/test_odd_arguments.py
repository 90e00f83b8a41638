"""Values and folders that are none, and what is said of them."""

import os
import subprocess
import sys

import pytest
from studies import RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.commands.cli import main


def test_no_advice_repeats_a_value_that_is_no_number():
    with pytest.raises(rb.OutOfRange) as refused:
        rb.Pier(alpha=float("nan"), p=2.0)
    assert str(refused.value).startswith("alpha = nan: must be below")
    assert "write" not in str(refused.value)
    with pytest.raises(rb.InputError) as refused:
        rb.Motion("m", 1e300, [0.0, 1.0])
    assert "1e-300" not in str(refused.value)


def test_an_empty_folder_for_results_is_refused(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    study = write_study(tmp_path, study_text(cases=(RIGID,)))
    with pytest.raises(SystemExit):
        main(["run", str(study), "--out", ""])
    assert "it is empty" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]


@pytest.mark.skipif(not os.path.isdir("/proc/self/fd"), reason="needs a folder that takes no files: Linux has one")
def test_a_folder_that_takes_no_files_is_not_said_to_be_in_use(tmp_path, capsys):
    study = write_study(tmp_path, study_text(cases=(RIGID,)))
    assert main(["run", str(study), "--out", "/proc/self/fd"]) == 2
    said = capsys.readouterr().err
    assert "no file can be written there" in said
    assert "another process" not in said


@pytest.mark.slow
def test_names_beyond_ascii_are_taken_where_the_locale_is_ascii(tmp_path):
    study = write_study(tmp_path, study_text(pulses=(SINE | {"name": "Sinus \u00fc"},), cases=(RIGID,)))
    ascii_only = os.environ | {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    command = [sys.executable, "-m", "rockbatch", "run", str(study), "--out", str(tmp_path / "\u00fc")]
    done = subprocess.run(command, env=ascii_only, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "Sinus \u00fc" in (tmp_path / "\u00fc" / "peaks.csv").read_text(encoding="utf-8")
