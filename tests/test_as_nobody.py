"""What only a user without rights and without a name meets, as in a container: few processes, and no home."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from motion_files import wiggle, write_at2
from studies import RIGID, study_text, write_study

import rockbatch
from rockbatch.commands.cli import main

NOBODY = 200_000 + os.getpid() % 100_000
"""A number that no user has, and no other process of these tests."""

AS_NOBODY = (
    "setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups",
    "--inh-caps=+dac_override", "--ambient-caps=+dac_override",  # whose Python it is, and whose folders, is not in question
)  # fmt: skip


def rockbatch_as_nobody(processes: int, *words: str) -> subprocess.CompletedProcess[str]:
    environment = {name: value for name, value in os.environ.items() if name not in ("HOME", "OMP_NUM_THREADS")}
    environment["PYTHONPATH"] = str(Path(rockbatch.__file__).parents[1])
    limited = ["prlimit", f"--nproc={processes}", *AS_NOBODY, sys.executable, "-m", "rockbatch", *words]
    return subprocess.run(limited, capture_output=True, text=True, env=environment)


@pytest.fixture(autouse=True)
def can_be_nobody():
    if sys.platform != "linux" or os.geteuid() != 0 or not all(map(shutil.which, ("setpriv", "prlimit"))):
        pytest.skip("only root of a Linux can become another user")
    if subprocess.run([*AS_NOBODY, "true"], capture_output=True).returncode:
        pytest.skip("this root may not")


@pytest.fixture
def study(tmp_path):
    write_at2(tmp_path / "records", "r000.AT2", wiggle())
    return of_records(tmp_path, [i / 100 for i in range(1, 301)])  # more than one group


def of_records(folder, scales):
    """Write a study of the records of a folder."""
    motions = {"path": "records", "scale": scales}
    return write_study(folder, study_text(motions=motions, pulses=(), cases=(RIGID,), output={"histories": "none"}))


@pytest.mark.parametrize(
    ("processes", "jobs", "otherwise"),
    [(1, 1, ""), pytest.param(2, 4, ", or write --jobs 1", marks=pytest.mark.slow)],
)
def test_where_processes_are_too_few_a_sentence_says_so_and_no_record_is_to_blame(study, processes, jobs, otherwise):
    """Without a limit to their threads, OpenBLAS sends SIGINT where it is loaded, and numexpr ends the process."""
    out = study.with_name("out")
    done = rockbatch_as_nobody(processes, "run", str(study), "--out", str(out), "--jobs", str(jobs))
    assert done.returncode == 2, done.stderr
    *before, last = done.stderr.splitlines()
    assert last == (
        "rockbatch: no more threads can be started: the number of processes is limited here (ulimit -u, or a container's "
        f"limit); allow more{otherwise}"
    )
    assert not [line for line in before if "not used" in line or "pthread" in line]
    assert "Traceback" not in done.stderr
    assert not (out / "peaks.csv").exists()


@pytest.mark.slow  # a whole run in a process of its own
def test_with_three_processes_one_thread_finishes_the_batch(study):
    study = of_records(study.parent, [0.5, 1.0])
    few, many = (study.with_name(name) for name in ("few", "many"))
    done = rockbatch_as_nobody(3, "run", str(study), "--out", str(few), "--jobs", "1")
    assert done.returncode == 0, done.stderr
    assert (few / "report.html").is_file()
    assert main(["run", str(study), "--out", str(many), "--jobs", "1"]) == 0
    assert (few / "peaks.csv").read_bytes() == (many / "peaks.csv").read_bytes()


def test_where_dask_raises_an_error_of_processes_the_sentence_is_the_same(study, monkeypatch, capsys):
    distributed = pytest.importorskip("distributed")

    def refuses(**_):
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr(distributed, "Client", refuses)
    assert main(["run", str(study), "--engine", "dask", "--jobs", "1"]) == 2
    assert "rockbatch: dask could not start a cluster on this machine (can't start" in capsys.readouterr().err


@pytest.mark.slow
def test_where_dask_cannot_start_its_processes_a_sentence_says_so(study):
    pytest.importorskip("distributed")
    out = study.with_name("out")
    done = rockbatch_as_nobody(4, "run", str(study), "--out", str(out), "--engine", "dask", "--jobs", "1")
    assert done.returncode == 2, done.stderr
    assert done.stderr.splitlines()[-1].startswith("rockbatch: dask could not start a cluster on this machine (")
    assert not (out / "peaks.csv").exists()
