"""No room for files or in memory in the middle of a command: said with the place and a remedy, and nothing is lost."""

import os
import re

import pytest
from three_commands import TABLES, study_of, tables_in

import rockbatch.batch.groups
import rockbatch.batch.threads
from rockbatch.commands.cli import main

unix = pytest.mark.skipif(not hasattr(os, "fork"), reason="there are no limits on the size of files")


@pytest.fixture(autouse=True)
def small_groups(monkeypatch):
    """Each run is a group."""
    monkeypatch.setattr(rockbatch.batch.groups, "LEAST_GROUP", 1)
    monkeypatch.setattr(rockbatch.batch.groups.groups, "__defaults__", (1,))


def within(size, words):
    """Return the status of a command that may write files of ``size`` bytes at most."""
    import resource

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        return main(words)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@unix
@pytest.mark.slow
@pytest.mark.usefixtures("pages")
@pytest.mark.parametrize("command", TABLES)
def test_files_that_may_not_grow_are_named_one_after_the_other_and_nothing_is_lost(tmp_path, capsys, command):
    """By ever higher limits: the journal, a table, its description, the page; each time the finished runs are kept."""
    study, whole, out = study_of(command, tmp_path), tmp_path / "whole", tmp_path / "out"
    words = [command, str(study), "--jobs", "1", "--out"]
    status = main([*words, str(whole)])
    named, finished = [], 0
    sizes = sorted(path.stat().st_size for path in whole.iterdir())
    for size in sorted({2 * size // 3 for size in sizes}):
        capsys.readouterr()
        assert within(size, [*words, str(out)]) == 2
        (said,) = (line for line in capsys.readouterr().err.splitlines() if line.startswith("rockbatch: "))
        place, _, rest = said.removeprefix("rockbatch: ").partition(": cannot be written: File too large; ")
        assert rest.endswith("kept: make room and give the same command again")
        named.append(place)
        kept = [*out.glob("*.part"), *out.glob("*runs.csv"), *out.glob("peaks.csv")]
        rows = max(path.read_bytes().count(b"\n") for path in kept)
        assert rows >= finished
        finished = rows
    assert len({*named}) >= 2
    assert all(place.startswith(f"{out}/") for place in named)
    assert main([*words, str(out)]) == status
    assert tables_in(out) == tables_in(whole)


@unix
@pytest.mark.slow
@pytest.mark.usefixtures("pages")
def test_a_report_that_may_not_grow_is_named_and_the_earlier_one_stays(tmp_path, capsys):
    out = tmp_path / "out"
    main(["run", str(study_of("run", tmp_path)), "--jobs", "1", "--out", str(out)])
    earlier = {path.name: path.read_bytes() for path in out.iterdir()}
    capsys.readouterr()
    assert within(len(earlier["report.html"]) // 2, ["report", str(out)]) == 2
    assert f"{out}/report.html: cannot be written: File too large; what was finished" in capsys.readouterr().err
    assert {path.name: path.read_bytes() for path in out.iterdir()} == earlier


@pytest.mark.slow
@pytest.mark.parametrize("command", TABLES)
def test_memory_that_is_full_is_said_with_a_remedy_and_the_same_command_goes_on(tmp_path, monkeypatch, capsys, command):
    study, whole, out = study_of(command, tmp_path), tmp_path / "whole", tmp_path / "out"
    words = [command, str(study), "--jobs", "1", "--out"]
    real, groups = rockbatch.batch.threads.outcomes_of, []

    def outcomes_of(*asked):
        groups.append(asked)
        if len(groups) == 3:
            raise MemoryError
        return real(*asked)

    with monkeypatch.context() as patch:
        patch.setattr(rockbatch.batch.threads, "outcomes_of", outcomes_of)
        assert main([*words, str(out)]) == 2
    said = capsys.readouterr().err
    remedy = "run fewer at a time (--jobs), keep fewer histories, or allow more"
    assert f"rockbatch: out of memory: {remedy}; what is finished is kept: give the same command again\n" in said
    assert "Traceback" not in said
    status = main([*words, str(out)])
    finished = re.search(r"(\d+) (?:of them|runs) are finished already", capsys.readouterr().err)
    assert finished
    assert int(finished[1]) >= 2  # one that was under way when memory was full may have ended
    assert main([*words, str(whole)]) == status
    assert tables_in(out) == tables_in(whole)
