"""What is written replaces regular files and nothing else; a pipe, a terminal or a device that a user names is written into."""

import os
import re
import shutil
import socket
import stat
import subprocess
import sys
import threading
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest
from report_samples import FIG7, write_results
from studies import RIGID, SINE, study_text, toml, write_study

import rockbatch as rb
from rockbatch.batch.preparing import OUTPUTS
from rockbatch.commands.cli import main
from rockbatch.common.files import LOCK, only_writer, remove, replacing, write_output, write_whole

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
RULES = {"check": [{"name": "upright", "demand": "theta_max_over_alpha", "at_most": 0.5, "reason": "a test"}]}
STUDY = study_text(
    pulses=(SINE | {"duration_s": 1.0},), cases=(RIGID,), output={"intensity": True},
    **RULES,
    fragility={"measure": "PGA", "levels_g": [0.2, 0.4]}, spectrum={"alpha": 0.2, "p": [1.0, 2.0]},
)  # fmt: skip


def make_device(path):
    try:
        os.mknod(path, 0o600 | stat.S_IFCHR, os.makedev(1, 3))  # as /dev/null, in a place of its own
    except PermissionError:
        pytest.skip("only root makes devices")


def make_socket(path):
    own = socket.socket(socket.AF_UNIX)
    before = Path.cwd()
    os.chdir(path.parent)  # paths of sockets are short
    own.bind(path.name)
    os.chdir(before)
    own.close()


def make_link(path):
    kept = path.parent / "kept.txt"
    kept.write_text("precious")
    path.symlink_to(kept)


def make_full_folder(path):
    path.mkdir()
    (path / "kept.txt").write_text("precious")


MAKE = {
    "pipe": os.mkfifo, "device": make_device, "socket": make_socket, "link": make_link, "folder": make_full_folder,
    "link to nothing": lambda path: path.symlink_to(path.with_name("nowhere")),
}  # fmt: skip
KINDS = pytest.mark.parametrize("kind", MAKE)


def each_once(names, kinds=tuple(MAKE)):
    """Return every name with one of the kinds, and the first with all of them: one function looks at the kind for all."""
    names = [*names]
    pairs = [(name, kinds[i % len(kinds)]) for i, name in enumerate(names)] + [(names[0], kind) for kind in kinds]
    return [*dict.fromkeys(pairs)]


def state(folder):
    """What is in a folder: names, kinds, and whether something has taken the place of something else."""
    found = {path: path.lstat() for path in folder.rglob("*")}
    return {path: (s.st_mode, s.st_ino, s.st_size if stat.S_ISREG(s.st_mode) else 0) for path, s in found.items()}


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    return write_study(tmp_path_factory.mktemp("study"), STUDY, "pier.toml")


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return write_results(tmp_path_factory.mktemp("results"), records=FIG7[:1])


@pytest.fixture(scope="module")
def records(tmp_path_factory):
    folder = tmp_path_factory.mktemp("records")
    (folder / "a.txt").write_text("0.0 0.1\n0.01 0.3\n0.02 -0.2\n")
    return folder


# Files in a folder of results

WRITING = {name: ["run"] for name in (*OUTPUTS, "checks.csv", "report.html", "peaks.csv.part", LOCK)} | {
    "fragility.json": ["fragility"], "fragility_runs.csv": ["fragility"], "fragility_runs.csv.part": ["fragility"],
    "spectrum_suite.csv": ["spectrum"], "spectrum.json": ["spectrum"],
    "accuracy.csv": ["accuracy"],
}  # fmt: skip


@pytest.mark.parametrize(("name", "kind"), each_once(WRITING))
def test_nothing_but_a_regular_file_is_replaced_in_a_folder_of_results(study, tmp_path, capsys, name, kind):
    MAKE[kind](tmp_path / name)
    before = state(tmp_path)
    for fresh in ([], ["--fresh"]) if WRITING[name] != ["accuracy"] else ([],):
        assert main([*WRITING[name], str(study), "--out", str(tmp_path), *fresh]) == 2
        message = capsys.readouterr().err
        assert re.search(rf"{re.escape(str(tmp_path / name))}: (a \w+|no plain file), which is n", message), message
        assert state(tmp_path) == before


ON_RESULTS = {
    "report.html": ["report"],
    "compare-b.html": ["report", "b"],
    "checks.csv": ["check", "--rules", "rules.toml"],
}


@pytest.mark.parametrize(("name", "kind"), each_once(ON_RESULTS))
def test_nor_by_commands_on_finished_results(results, tmp_path, monkeypatch, capsys, name, kind):
    command = ON_RESULTS[name]
    for folder in ("a", "b"):
        shutil.copytree(results, tmp_path / folder)
    (tmp_path / "rules.toml").write_text(toml(RULES))
    (tmp_path / "a" / name).unlink(missing_ok=True)
    MAKE[kind](tmp_path / "a" / name)
    before = state(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert main([command[0], "a", *command[1:]]) == 2
    assert f"a/{name}: a {kind.split()[0]}, which is n" in capsys.readouterr().err
    assert state(tmp_path) == before


@pytest.mark.parametrize(
    ("name", "kind"), each_once(["pier.toml", "checks.toml", "records", "motions.toml", "motions.csv"])
)
def test_nor_where_something_new_is_begun(records, tmp_path, capsys, name, kind):
    folder = shutil.copytree(records, tmp_path / "records") if name.startswith("motions") else tmp_path
    MAKE[kind](folder / name)
    before = state(tmp_path)
    code = main(["init", str(tmp_path)] if folder == tmp_path else ["motions", str(folder), "--write-manifest"])
    assert code == 2
    assert f"{folder / name} " in capsys.readouterr().err
    assert state(tmp_path) == before


@KINDS
def test_nor_by_the_functions_through_which_all_of_them_write(tmp_path, kind):
    path = tmp_path / "file"
    MAKE[kind](path)
    before = state(tmp_path)
    for write in (remove, lambda path: write_whole(path, "text")):
        with pytest.raises(rb.InputError, match=f"a {kind.split()[0]}, which is not replaced"):
            write(path)
        assert state(tmp_path) == before


@KINDS
def test_nor_what_comes_while_a_file_is_being_written(tmp_path, kind):
    path = tmp_path / "file"

    def write():
        with replacing(path) as temporary:
            temporary.write_text("text")
            MAKE[kind](path)

    with pytest.raises(rb.InputError, match="which is not replaced"):
        write()
    assert not stat.S_ISREG(path.lstat().st_mode)
    assert not list(tmp_path.glob(".file*"))


def test_a_lock_that_becomes_a_pipe_stays(tmp_path):
    with only_writer(tmp_path):
        (tmp_path / LOCK).unlink()
        os.mkfifo(tmp_path / LOCK)
    assert stat.S_ISFIFO((tmp_path / LOCK).lstat().st_mode)


# Files that a user names

UNIT = ("--unit", "g", "--role", "horizontal")
NAMED = {
    "motions": lambda path, places: ["motions", str(places["records"]), *UNIT, "--csv", path],
    "page": lambda path, places: ["motions", str(places["records"]), *UNIT, "--html", path],
    "statics": lambda path, places: ["statics", str(places["study"]), "--csv", path],
    "curves": lambda path, places: ["statics", str(places["study"]), "--curves", path],
    "report": lambda path, places: ["report", str(places["results"]), "--out", path],
    "two": lambda path, places: ["report", str(places["results"]), str(places["results"]), "--out", path],
}


@pytest.fixture
def places(study, results, records):
    return {"study": study, "results": results, "records": records}


@pytest.mark.parametrize(("command", "kind"), each_once(NAMED, ("socket", "link", "folder", "link to nothing")))
def test_a_name_of_what_is_no_file_and_takes_nothing_is_refused(places, tmp_path, capsys, command, kind):
    MAKE[kind](tmp_path / "out")
    before = state(tmp_path)
    assert main(NAMED[command](str(tmp_path / "out"), places)) == 2
    assert f"{tmp_path / 'out'}: a {kind.split()[0]}, which is not replaced" in capsys.readouterr().err
    assert state(tmp_path) == before


@contextmanager
def reading(pipe):
    """Read a pipe meanwhile; at the end the list holds its text."""
    handle, ended, parts, texts = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK), threading.Event(), [], []

    def read():
        while True:
            last = ended.is_set()
            with suppress(BlockingIOError):
                parts.append(os.read(handle, 1 << 16))
            if last and not parts[-1]:
                return
            ended.wait(0.01 if not parts or not parts[-1] else 0)

    reader = threading.Thread(target=read)
    reader.start()
    try:
        yield texts
    finally:
        ended.set()
        reader.join(timeout=60)
        os.close(handle)
    texts.append(b"".join(parts).decode())


@pytest.mark.parametrize("command", NAMED)
def test_a_pipe_is_written_into(places, tmp_path, command):
    path = tmp_path / "out"
    assert main(NAMED[command](str(path), places)) == 0
    text = path.read_text()
    path.unlink()
    os.mkfifo(path)
    with reading(path) as read:
        assert main(NAMED[command](str(path), places)) == 0
    assert read[0].splitlines()[0] == text.splitlines()[0]
    assert len(read[0]) == len(text)
    assert stat.S_ISFIFO(path.lstat().st_mode)


def test_a_disk_is_not(tmp_path):
    try:
        os.mknod(tmp_path / "disk", 0o600 | stat.S_IFBLK, os.makedev(7, 250))
    except PermissionError:
        pytest.skip("only root makes devices")
    with pytest.raises(rb.InputError, match="a disk, which is not replaced"):
        write_output(tmp_path / "disk", "text")
    assert stat.S_ISBLK((tmp_path / "disk").lstat().st_mode)


def test_a_pipe_that_nobody_reads_and_one_that_is_closed_are_named_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(rb.InputError, match=r"pipe: cannot be written: .*; if it is a pipe, start its reader first"):
        write_output(tmp_path / "pipe", "text")
    handle = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    closing = threading.Timer(0.2, os.close, (handle,))
    closing.start()
    with pytest.raises(rb.InputError, match=r"pipe: cannot be written: Broken pipe$"):
        write_output(tmp_path / "pipe", "text" * 100_000)
    closing.join()


def test_a_terminal_is_written_into():
    outer, inner = os.openpty()
    write_output(Path(os.ttyname(inner)), "text\n")
    assert os.read(outer, 100).split() == [b"text"]
    os.close(outer)
    os.close(inner)


@pytest.mark.parametrize(("name", "to"), [("-", "pipe"), ("/dev/stdout", "file")])
def test_stdout_has_the_table_and_nothing_else(records, tmp_path, name, to):
    command = [sys.executable, "-m", "rockbatch", *NAMED["motions"](name, {"records": records})]
    with (tmp_path / "taken").open("wb") as file:
        done = subprocess.run(
            command, stdout=subprocess.PIPE if to == "pipe" else file, stderr=subprocess.PIPE, check=False
        )
    table = done.stdout if to == "pipe" else (tmp_path / "taken").read_bytes()
    assert done.returncode == 0
    assert [line.split(b",")[0] for line in table.splitlines()] == [b"record", b"a"]
    assert b"1 usable recording" in done.stderr
    assert not Path("-").exists()


def test_a_full_device_is_said_to_be_full():
    full = Path("/dev/full")
    if not full.is_char_device():
        pytest.skip("no such device here")
    link = os.stat(full)
    with pytest.raises(rb.InputError, match="/dev/full: cannot be written: No space left on device"):
        write_output(full, "text")
    assert os.path.samestat(os.stat(full), link)


def test_a_regular_file_is_replaced_as_a_whole(places, tmp_path):
    path = tmp_path / "out"
    path.write_text("earlier")
    os.link(path, tmp_path / "other name")
    assert main(NAMED["motions"](str(path), places)) == 0
    assert path.read_text().startswith("record,")
    assert (tmp_path / "other name").read_text() == "earlier"
