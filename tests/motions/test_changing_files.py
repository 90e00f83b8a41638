"""Files that are written, replaced or removed while they are read: nothing waits for ever, and no half of a file is a record."""

import os
import threading
import zipfile
from pathlib import Path

import pytest
from motion_files import at2_text, wiggle, write_at2
from studies import RIGID, study_text, write_study

import rockbatch as rb
from rockbatch.batch import preparing
from rockbatch.common.errors import InputError
from rockbatch.motions import folder, read_motions
from rockbatch.motions.sources import archives
from rockbatch.toml.reader import LARGEST, TomlFile

needs_pipes = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")


def meanwhile(monkeypatch, change):
    """Call ``change`` with the path of each file just after it was read."""
    plain = folder.read_record

    def read(file):
        found = plain(file)
        change(file)
        return found

    monkeypatch.setattr(folder, "read_record", read)


def grown(path: Path) -> None:
    path.write_bytes(path.read_bytes() + b"0.5\n")


def replaced(path: Path) -> None:
    was, new = path.stat(), path.with_suffix(".new")
    new.write_text(at2_text(wiggle(60, 2)))
    os.utime(new, ns=(was.st_atime_ns, was.st_mtime_ns))
    new.replace(path)


@pytest.mark.parametrize("change", [grown, replaced, lambda path: os.truncate(path, 200)])
def test_a_file_that_changes_while_its_folder_is_read_is_no_record(tmp_path, monkeypatch, change):
    for name in ("a.AT2", "b.AT2"):
        write_at2(tmp_path, name, wiggle(60, len(name)), title="nothing, 000")
    meanwhile(monkeypatch, lambda file: change(tmp_path / "a.AT2") if file.source == "b.AT2" else None)
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["b.AT2"]
    assert [file.reason for file in found.unusable] == [
        "changed while it was read; read it again when nothing writes into it any more"
    ]


def test_so_are_the_records_of_an_archive(tmp_path, monkeypatch):
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.writestr("a.AT2", at2_text(wiggle(60)))
    meanwhile(monkeypatch, lambda _: grown(tmp_path / "a.zip"))
    (file,) = read_motions(tmp_path).unusable
    assert file.reason.startswith("changed while it was read")


def test_a_file_that_is_gone_once_it_was_read_is_a_record(tmp_path, monkeypatch):
    write_at2(tmp_path, "a.AT2", wiggle(60))
    meanwhile(monkeypatch, lambda _: (tmp_path / "a.AT2").unlink())
    assert len(read_motions(tmp_path).motions) == 1


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("change", [replaced, Path.unlink])
def test_runs_use_what_was_read_whatever_becomes_of_the_files(tmp_path, monkeypatch, change):
    records = tmp_path / "records"
    records.mkdir()
    for name in ("a.AT2", "b.AT2"):
        write_at2(records, name, wiggle(60, len(name)), title="nothing, 000")
    flat = {"alpha": 0.02, "p": 1.0}  # so that it rocks
    study = write_study(tmp_path, study_text(pier=flat, motions={"path": "records"}, pulses=(), cases=(RIGID,)))
    monkeypatch.setattr(
        "rockbatch.workflow.running.write_report", lambda *_, **__: tmp_path
    )  # takes longer than the runs
    before = rb.run(study)
    plain = preparing.ground_motions

    def read(*given):
        found = plain(*given)
        for path in records.glob("*.AT2"):
            change(path)
        return found

    with monkeypatch.context() as patch:
        patch.setattr(preparing, "ground_motions", read)
        after = rb.run(study, tmp_path / "out")
    assert before["theta_max_over_alpha"].min() > 0
    assert after["theta_max_over_alpha"].to_numpy() == pytest.approx(
        before["theta_max_over_alpha"].to_numpy(), rel=1e-9
    )
    if change is replaced:  # records are told apart by their samples, not by their times
        again = rb.run(study, tmp_path / "out")
        assert (again["theta_max_over_alpha"] != after["theta_max_over_alpha"]).all()
    else:
        with pytest.raises(InputError, match="no ground motion"):
            rb.run(study, tmp_path / "out")


def test_what_is_written_between_two_looks_at_a_file_is_noticed(tmp_path):
    path = write_at2(tmp_path, "a.AT2", wiggle(60))
    with pytest.raises(InputError, match="changed while it was read"), rb.common.files.whole_input(path):
        grown(path)


@needs_pipes
def test_a_pipe_that_takes_the_place_of_a_file_keeps_nobody_waiting(tmp_path):
    for name in ("x.AT2", "x.zip", "x.gz", "motions.csv"):
        os.mkfifo(tmp_path / name)
        with pytest.raises(InputError, match="not a regular file"):
            archives.content(tmp_path / name)
    with pytest.raises(InputError, match="not a regular file"):
        list(archives.members(tmp_path / "x.zip"))
    assert not folder.is_manifest(tmp_path / "motions.csv")
    assert TomlFile.text_of(tmp_path / "motions.csv") == ""


@pytest.mark.skipif(not Path("/dev/fd").is_dir(), reason="no open files under their numbers here")
def test_a_study_may_come_through_a_pipe():
    """As ``rockbatch run <(…)`` has it: all that is written there is read."""
    text = study_text() + "#" * 200_000 + "\n"
    end, start = os.pipe()

    def write() -> None:
        with open(start, "w") as file:
            file.write(text)

    writer = threading.Thread(target=write)
    writer.start()
    try:
        assert TomlFile.text_of(Path(f"/dev/fd/{end}")) == text
    finally:
        os.close(end)
        writer.join()


def test_the_table_of_a_spectrum_is_read_up_to_a_size(tmp_path):
    (tmp_path / "sa.csv").write_bytes(b"0.1 0.5\n" * (LARGEST // 8 + 1))
    target = {"spectrum": "sa.csv", "period_range_s": [0.2, 2.0]}
    study = rb.load_study(write_study(tmp_path, study_text()))
    with pytest.raises(InputError, match="larger than 4 MiB"):
        study.with_(motions={"target": target})


def test_a_file_in_the_place_of_another_with_its_time_is_not_taken_for_it(tmp_path):
    """Copies keep times, and clocks are set back: a time alone tells no file from another."""
    path = tmp_path / "x.zip"

    def write(name: str) -> None:
        new = tmp_path / "new"
        with zipfile.ZipFile(new, "w") as archive:
            archive.writestr(name, "text")
        os.utime(new, (1e9, 1e9))
        new.replace(path)

    write("a.txt")
    assert archives.is_member(path / "a.txt")
    write("b.txt")
    assert (archives.is_member(path / "a.txt"), archives.is_member(path / "b.txt")) == (False, True)
