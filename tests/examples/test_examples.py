"""The studies that come with rockbatch: found, copied with their records, and there in a wheel too."""

import os
import re
import subprocess
import sys
import zipfile
from dataclasses import fields, replace
from pathlib import Path

import pandas as pd
import pytest
from messages import assert_states

from rockbatch.checks.rule_files import load_rules
from rockbatch.commands.cli import main
from rockbatch.commands.example_studies import FIRST, copy, examples
from rockbatch.common.errors import InputError
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

CHECKOUT = Path(__file__).parents[2]
NAMES = [example.name for example in examples()]


def test_every_config_is_an_example_and_the_first_study_comes_first():
    assert sorted(NAMES) == sorted(path.stem for path in (CHECKOUT / "configs").glob("*.toml"))
    assert NAMES[0] == FIRST


@pytest.mark.sweep(fast=5)
@pytest.mark.parametrize("name", NAMES)
def test_a_copy_is_the_same_study_on_its_own_records(name, tmp_path):
    written = copy(name, tmp_path / "mine", "pier.toml")
    own, original = load_study(written[0]), load_study(CHECKOUT / "configs" / f"{name}.toml")
    for field in fields(original):
        if field.name not in ("title", "notes", "path", "text", "motions", "check_files"):  # what names files
            assert getattr(own, field.name) == getattr(original, field.name), field.name
    assert replace(own.motions, paths=()) == replace(original.motions, paths=())
    for path in own.motions.paths:
        assert path.is_relative_to(tmp_path)
        assert path.is_dir()


def test_the_first_study_is_held_against_the_limits_beside_it(tmp_path):
    written = copy(FIRST, tmp_path, "pier.toml")
    rules = load_study(written[0]).checks
    assert rules == load_rules(tmp_path / "checks.toml")
    text = (tmp_path / "checks.toml").read_text(encoding="utf-8")
    (tmp_path / "checks.toml").write_text(text.replace("at_most = 0.15", "at_most = 0.4"), encoding="utf-8")
    assert [rule.name for rule in load_study(written[0]).checks if rule not in rules] == ["uplift of the heel"]


@pytest.mark.slow
def test_no_copy_names_a_file_of_checks_that_is_not_there(tmp_path):
    for name in NAMES:
        text = copy(name, tmp_path / name, "pier.toml")[0].read_text(encoding="utf-8")
        assert "stepping_pier" not in text


def test_the_first_study_has_the_stations_that_come_with_rockbatch(tmp_path):
    study = load_study(copy(FIRST, tmp_path, "pier.toml")[0])
    found = ground_motions(study)
    assert len(found.motions) == 10
    assert not found.unusable
    assert all(motion.vertical is not None for motion in found.motions)
    assert (tmp_path / "records" / "README.md").read_text(encoding="utf-8").count("licence")  # goes with its records


@pytest.mark.parametrize("taken", ["pier.toml", "checks.toml", "records"])
def test_nothing_is_overwritten_and_nothing_half_written(taken, tmp_path):
    (tmp_path / taken / "own.AT2").mkdir(parents=True)
    (tmp_path / taken / "own.AT2" / "own.txt").touch()
    with pytest.raises(InputError, match=taken):
        copy(FIRST, tmp_path, "pier.toml")
    assert [path.name for path in tmp_path.iterdir()] == [taken]


def test_a_copy_that_was_interrupted_is_completed_and_what_is_not_of_it_is_kept(tmp_path):
    """Whichever files are there, and one that is not whole; a record of one's own among them is nobody's to replace."""
    copy(FIRST, tmp_path / "whole", "pier.toml")
    whole = {path.relative_to(tmp_path / "whole"): path.read_bytes() for path in files_in(tmp_path / "whole")}
    for here in range(len(whole)):
        for place, (path, content) in enumerate(whole.items()):
            if place <= here:
                (tmp_path / str(here) / path).parent.mkdir(parents=True, exist_ok=True)
                (tmp_path / str(here) / path).write_bytes(content)
        copy(FIRST, tmp_path / str(here), "pier.toml")
        assert {
            path.relative_to(tmp_path / str(here)): path.read_bytes() for path in files_in(tmp_path / str(here))
        } == whole
    (tmp_path / "0" / "records" / "own.AT2").write_text("mine")
    with pytest.raises(InputError, match="records exists already"):
        copy(FIRST, tmp_path / "0", "pier.toml")
    (tmp_path / "1" / "checks.toml").write_text("# mine")
    with pytest.raises(InputError, match=r"checks\.toml exists already"):
        copy(FIRST, tmp_path / "1", "pier.toml")


def files_in(folder):
    return sorted(path for path in folder.rglob("*") if path.is_file())


def test_what_is_no_example_is_answered_with_those_that_are():
    with pytest.raises(
        InputError, match=r"there is no example 'fig8'; did you mean fig\d\? `rockbatch examples` lists them"
    ):
        copy("fig8", Path("mine"), "pier.toml")


@pytest.mark.parametrize(("example", "study"), [((), "pier"), (("--example", "fig7"), "fig7")])
def test_init_names_the_study_its_report_and_the_file_of_limits(tmp_path, monkeypatch, capsys, example, study):
    monkeypatch.chdir(tmp_path)
    assert main(["init", "mine", *example]) == 0
    written = capsys.readouterr().out.split("\nNext:")
    assert f"mine/{study}.toml" in written[0].replace(os.sep, "/").splitlines()
    report = str(Path("reports", study, "report.html"))
    assert_states(written[1], "mine", f"run {study}.toml", report, f"{study}.toml", "checks.toml")


@pytest.mark.slow
@pytest.mark.usefixtures("pages")
def test_init_and_then_the_command_that_it_names_lead_to_a_report(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["init", "mine"]) == 0
    told = capsys.readouterr().out
    assert re.search(r"cd mine\n    \S*rockbatch run pier.toml\n", told)
    monkeypatch.chdir(tmp_path / "mine")
    main(["run", "pier.toml"])
    assert Path("reports", "pier", "report.html").stat().st_size > 10_000
    peaks = pd.read_csv(Path("reports", "pier", "peaks.csv"))
    assert len(peaks) == 30
    assert set(peaks["status"]) <= {"ok", "flight"}
    verdicts = pd.read_csv(Path("reports", "pier", "checks.csv"))
    limits = {rule.name: rule.limit for rule in load_rules("checks.toml")}
    assert dict(zip(verdicts["check"], verdicts["limit"], strict=True)) == limits
    passed = verdicts.groupby("yield_kN")["verdict"].agg(lambda each: set(each) == {"pass"})
    settled = peaks.groupby("yield_kN")["settlement_m"].max()
    assert not (passed & (settled > limits["settlement of the toe"])).any()


@pytest.mark.parametrize(
    ("installed", "on_path", "called"),
    [(True, True, "rockbatch"), (True, False, "PLACE/rockbatch"), (False, False, "rockbatch")],
)
def test_init_names_a_command_that_the_shell_finds(tmp_path, monkeypatch, capsys, installed, on_path, called):
    """Without its environment activated rockbatch is called by its path, from any folder."""
    place = tmp_path / "bin"
    place.mkdir()
    if installed:
        (place / "rockbatch").touch(mode=0o755)
    monkeypatch.setattr(sys, "executable", str(place / "python"))
    monkeypatch.setenv("PATH", str(place) if on_path else str(tmp_path))
    monkeypatch.chdir(tmp_path)
    assert main(["init", "mine"]) == 0
    assert f"    {called.replace('PLACE', str(place))} run pier.toml\n" in capsys.readouterr().out


def test_examples_are_listed_with_what_they_need(capsys):
    assert main(["examples"]) == 0
    lines = capsys.readouterr().out.splitlines()
    needs = {line.split()[0] for line in lines if "rockbatch[records]" in line}
    assert {"fig7", "fragility", "spectrum"} <= needs
    assert FIRST not in needs
    assert "near_fault" not in needs


@pytest.mark.slow
def test_a_wheel_has_them(tmp_path):
    """Built from this checkout, unpacked elsewhere, and used there."""
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)],
        cwd=CHECKOUT, check=True, capture_output=True,
    )  # fmt: skip
    (wheel,) = tmp_path.glob("*.whl")
    installed = tmp_path / "installed"
    zipfile.ZipFile(wheel).extractall(installed)
    environment = os.environ | {"PYTHONPATH": str(installed)}
    subprocess.run(
        [sys.executable, "-m", "rockbatch", "init", "mine"],
        cwd=tmp_path, env=environment, check=True, capture_output=True,
    )  # fmt: skip
    assert len(list((tmp_path / "mine" / "records").rglob("*.V2*"))) == 7
    names = {path.stem for path in (installed / "rockbatch" / "examples" / "configs").glob("*.toml")}
    assert names == set(NAMES)
    report = installed / "rockbatch" / "reporting"
    assert {"style.css", "script.js", "page.html"} <= {path.name for path in report.iterdir()}
    assert len(list((report / "sections").glob("*.html"))) == len(
        list((CHECKOUT / "rockbatch/reporting/sections").glob("*.html"))
    )


def test_init_into_a_folder_with_the_name_of_an_example_asks_which_is_meant(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["init", "near_fault"]) == 2
    assert "write rockbatch init near_fault --example near_fault, or give another folder" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
    assert main(["init", "near_fault", "--example", "near_fault"]) == 0


def test_the_comments_of_a_copied_study_stay_below_each_other(tmp_path):
    copy(FIRST, tmp_path, "pier.toml")
    path, vertical = re.findall(
        r"^(?:path|vertical) = .*", (tmp_path / "pier.toml").read_text(encoding="utf-8"), re.MULTILINE
    )
    assert path.index("#") == vertical.index("#")
