"""A batch that ends before its end: what is finished is kept, and the same command comes to the same bytes."""

import json
import multiprocessing
import os
import random
import shutil
import signal
import subprocess
import sys
import time

import pytest
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch.batch.groups
import rockbatch.batch.threads
from rockbatch.batch.execution import to_simulate
from rockbatch.batch.plan import Plan
from rockbatch.batch.preparing import share_of
from rockbatch.commands.cli import main
from rockbatch.common.files import only_writer
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions
from rockbatch.workflow.running import _ranges as ranges

SIMULATED = 18 * 3
RUNS = 2 * SIMULATED  # with the mirror images

unix = pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are forked, with their kernels loaded")


@pytest.fixture(autouse=True)
def small_groups(monkeypatch):
    """Groups of 10 runs, that many may be finished or under way."""
    monkeypatch.setattr(rockbatch.batch.groups, "LEAST_GROUP", 10)
    monkeypatch.setattr(rockbatch.batch.groups.groups, "__defaults__", (10,))


@pytest.fixture
def study(tmp_path):
    return write(tmp_path / "study.toml")


def write(path, title="Long", last_scale=1.2):
    pads = PADS | {"beta": [30, 80], "epsilon": 0.1}
    scales = [round(0.05 * i, 2) for i in range(1, 18)]
    text = study_text(
        title=title,
        motions={"polarity": ["+", "-"], "scale": [*scales, last_scale]},
        pulses=(SINE | {"duration_s": 2.0},),
        cases=(RIGID, pads),
        output={"both_laws": False, "histories": "none"},
    )
    return write_study(path.parent, text, path.name)


@pytest.fixture(scope="module")
def carried_out(tmp_path_factory):
    """The folder of the study, carried out in one go."""
    folder = tmp_path_factory.mktemp("undisturbed")
    assert main(["run", str(write(folder / "study.toml")), "--out", str(folder / "out")]) == 0
    return folder / "out"


@pytest.fixture(scope="module")
def undisturbed(carried_out):
    """peaks.csv of the study, carried out in one go."""
    return (carried_out / "peaks.csv").read_bytes()


@pytest.fixture
def finished(carried_out, tmp_path):
    """A copy of that folder, as if it had been carried out here."""
    out = shutil.copytree(carried_out, tmp_path / "out")
    info = (out / "run.json").read_text(encoding="utf-8")
    (out / "run.json").write_text(info.replace(str(carried_out.parent), str(tmp_path)), encoding="utf-8")
    return out


def started(study, out, *more):
    """The command line in a process of its own, that is under way."""
    process = multiprocessing.get_context("fork").Process(
        target=forked, args=(["run", str(study), "--out", str(out), "--jobs", "2", *more],)
    )
    process.start()
    return process


def forked(arguments):
    signal.signal(signal.SIGINT, signal.default_int_handler)
    sys.stdout = sys.stderr = open(os.devnull, "w")  # noqa: SIM115
    os._exit(main(arguments))


def finished_in(out):
    """Number of runs in the journal."""
    try:
        return (out / "peaks.csv.part").read_bytes().count(b"\n") - 1
    except FileNotFoundError:  # not begun, or finished at this instant
        return 0


def stopped(*_):
    raise KeyboardInterrupt


def wait_for(out, runs):
    """Until so many runs are in the journal."""
    until = time.monotonic() + 60
    while finished_in(out) < runs:
        assert time.monotonic() < until
        time.sleep(0.002)


@pytest.mark.slow
@unix
def test_killed_at_random_instants_it_goes_on_and_ends_with_the_same_bytes(study, tmp_path, undisturbed):
    """While it starts, while runs are under way and written down, and while the table and the report are written."""
    out = tmp_path / "out"
    chance = random.Random(7)
    finished, ended = [], []
    while ended.count(-signal.SIGKILL) < 8:
        here = finished_in(out)
        place = chance.randint(here + 1, here + 20)
        with pytest.MonkeyPatch.context() as patch:
            held_at(patch, out, place)
            process = started(study, out)
        if len(ended) % 2:  # wherever it is
            process.join(chance.uniform(0.0, 0.5))
        else:
            while process.is_alive() and finished_in(out) < place:
                time.sleep(0.002)
        process.kill()
        process.join()
        ended.append(process.exitcode)
        finished.append(finished_in(out))
        if process.exitcode == 0:  # all that there was to do is done: once more, from the start
            assert (out / "peaks.csv").read_bytes() == undisturbed
            shutil.rmtree(out)
    assert set(ended) <= {0, -signal.SIGKILL}
    assert len({runs for runs in finished if 0 < runs < RUNS}) >= 3
    assert main(["run", str(study), "--out", str(out)]) == 0
    assert (out / "peaks.csv").read_bytes() == undisturbed
    assert sorted(file.name for file in out.iterdir()) == ["peaks.csv", "report.html", "run.json"]


def held_at(monkeypatch, out, runs):
    """No further group begins while so many runs are in the journal: there the process waits for its end."""
    real = rockbatch.batch.threads.outcomes_of

    def outcomes_of(*asked):
        while finished_in(out) >= runs:
            time.sleep(0.002)
        return real(*asked)

    monkeypatch.setattr(rockbatch.batch.threads, "outcomes_of", outcomes_of)


def slowed_down(monkeypatch, seconds):
    """Every group of runs takes so much longer."""
    real = rockbatch.batch.threads.outcomes_of
    monkeypatch.setattr(rockbatch.batch.threads, "outcomes_of", lambda *asked: (time.sleep(seconds), real(*asked))[1])


@pytest.mark.usefixtures("pages")
def test_an_interrupt_says_what_is_kept_and_the_same_command_goes_on(study, tmp_path, undisturbed, monkeypatch, capsys):
    real, groups = rockbatch.batch.threads.outcomes_of, []

    def interrupted(runs, *arguments):
        groups.append(runs)
        if len(groups) == 3:
            raise KeyboardInterrupt
        return real(runs, *arguments)

    out = tmp_path / "out"
    with monkeypatch.context() as patch:
        patch.setattr(rockbatch.batch.threads, "outcomes_of", interrupted)
        assert main(["run", str(study), "--out", str(out), "--jobs", "1"]) == 130
    told = capsys.readouterr().err
    kept = finished_in(out)
    assert 20 <= kept < RUNS
    assert f"interrupted: {kept // 2} of {SIMULATED} runs are finished and kept in {out / 'peaks.csv.part'}" in told
    assert "the same command continues from there" in told
    assert [file.name for file in out.iterdir()] == ["peaks.csv.part"]  # a table is there when it is whole
    assert main(["run", str(study), "--out", str(out)]) == 0
    assert f"{kept // 2} of them are finished already, {SIMULATED - kept // 2} are left" in capsys.readouterr().err
    assert (out / "peaks.csv").read_bytes() == undisturbed
    assert json.loads((out / "run.json").read_text())["kept"] == kept // 2
    assert main(["report", str(out)]) == 0
    assert f"{kept // 2} runs had been finished earlier" in (out / "report.html").read_text(encoding="utf-8")


@pytest.mark.usefixtures("pages")
def test_a_part_by_another_version_is_refused_and_kept_until_fresh_starts_over(
    study, tmp_path, undisturbed, monkeypatch, capsys
):
    """Rows of two programs never stand in one table."""
    real, groups, out = rockbatch.batch.threads.outcomes_of, [], tmp_path / "out"

    def interrupted(runs, *arguments):
        groups.append(runs)
        if len(groups) == 3:
            raise KeyboardInterrupt
        return real(runs, *arguments)

    with monkeypatch.context() as patch:
        patch.setattr(rockbatch.batch.threads, "outcomes_of", interrupted)
        patch.setattr(rockbatch.batch.digests, "program", lambda: "0123456789abcdef")
        assert main(["run", str(study), "--out", str(out), "--jobs", "1"]) == 130
    part = (out / "peaks.csv.part").read_bytes()
    capsys.readouterr()
    assert main(["run", str(study), "--out", str(out)]) == 2
    told = capsys.readouterr().err
    assert f"{finished_in(out)} finished runs, but" in told
    assert "changed since (program)" in told
    assert "start over with --fresh" in told
    assert (out / "peaks.csv.part").read_bytes() == part
    assert main(["run", str(study), "--out", str(out), "--fresh"]) == 0
    assert (out / "peaks.csv").read_bytes() == undisturbed


@unix
def test_a_file_that_may_not_grow_is_reported_and_with_room_the_command_continues(study, tmp_path, undisturbed, capsys):
    """In the middle of the runs, by a limit on the size of files."""
    import resource

    out = tmp_path / "out"
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(undisturbed) // 2, before[1]))
    try:
        assert main(["run", str(study), "--out", str(out), "--jobs", "2"]) == 2
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    told = capsys.readouterr().err
    assert f"{out}/peaks.csv.part: cannot be written: File too large; the " in told
    assert "rows that are finished are kept: make room and give the same command again" in told
    kept = finished_in(out)
    assert 0 < kept < RUNS
    assert main(["run", str(study), "--out", str(out)]) == 0
    assert f"{kept // 2} of them are finished already" in capsys.readouterr().err
    assert (out / "peaks.csv").read_bytes() == undisturbed


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="small file systems are mounted in a namespace of their own")
def test_a_full_disk_is_reported_and_with_room_the_same_command_continues(study, tmp_path, undisturbed):
    """The disk is full in the middle of the runs, then in the middle of the table, and then there is room."""
    disk, kept = tmp_path / "disk", tmp_path / "kept"
    disk.mkdir()
    kept.mkdir()
    script = f"""
import contextlib, shutil, subprocess, sys
from rockbatch.commands.cli import main

sizes = {{"first": "{len(undisturbed) // 2}", "second": "{len(undisturbed) * 3 // 2}", "third": "50m"}}
for name, size in sizes.items():
    way = "remount" if name != "first" else "rw"
    if subprocess.run(["mount", "-t", "tmpfs", "-o", f"{{way}},size={{size}}", "none", "{disk}"]).returncode:
        sys.exit(99 if name == "first" else "the disk cannot be made larger")
    with open(f"{kept}/{{name}}", "w", encoding="utf-8") as said, contextlib.redirect_stderr(said):
        code = main(["run", "{study}", "--out", "{disk}/out", "--jobs", "2"])
    with open("{kept}/codes", "a") as codes:
        print(code, file=codes)
shutil.copy("{disk}/out/peaks.csv", "{kept}")
"""
    try:
        done = subprocess.run(["unshare", "-rm", sys.executable, "-c", script], capture_output=True, text=True)
    except FileNotFoundError:
        pytest.skip("there is no unshare")
    if done.returncode == 99 or "unshare:" in done.stderr:
        pytest.skip(f"no file system can be mounted here: {done.stderr}")
    first, second, third = ((kept / name).read_text(encoding="utf-8") for name in ("first", "second", "third"))
    assert (kept / "codes").read_text().split() == ["2", "2", "0"]
    remedy = "make room and give the same command again"
    assert f"{disk}/out/peaks.csv.part: cannot be written: No space left on device; the " in first
    assert f"rows that are finished are kept: {remedy}" in first
    assert f"{disk}/out/peaks.csv: cannot be written: No space left on device" in second
    assert remedy in second
    assert f"{SIMULATED} of them are finished already, 0 are left" in third
    assert (kept / "peaks.csv").read_bytes() == undisturbed


@pytest.mark.slow
@pytest.mark.usefixtures("pages")
def test_in_a_finished_folder_nothing_is_left_to_run_and_the_rest_is_made_again(
    study, finished, undisturbed, capsys, monkeypatch
):
    out = finished
    command = ["run", str(study), "--out", str(out)]
    cost = json.loads((out / "run.json").read_text())["wall_s"]
    write(study, title="Renamed")
    with monkeypatch.context() as patch:  # killed on its way: it stays finished
        patch.setattr("rockbatch.batch.finishing.write_info", stopped)
        assert main(command) == 130
    study.write_text(study.read_text().replace('histories = "none"', 'histories = "worst"'))
    capsys.readouterr()
    assert main(command) == 0
    assert "nothing is left to run" in capsys.readouterr().err
    assert (out / "histories.h5").exists()
    assert "Renamed" in (out / "report.html").read_text(encoding="utf-8")
    assert json.loads((out / "run.json").read_text())["wall_s"] == cost
    assert (out / "peaks.csv").read_bytes() == undisturbed
    assert main([*command, "--fresh"]) == 0
    assert "nothing is left" not in capsys.readouterr().err
    assert (out / "peaks.csv").read_bytes() == undisturbed


@pytest.mark.slow
def test_a_finished_study_that_is_run_again_does_nothing_again(study, tmp_path, capsys):
    """What is not there, or of another state of the study, is made again; a comment changes run.json too."""
    text = study_text(motions={"scale": [0.5, 1.0]}, cases=(RIGID,), output={"histories": "worst", "intensity": True})
    study.write_text(text, encoding="utf-8")
    out = tmp_path / "out"
    command = ["run", str(study), "--out", str(out)]

    def written():
        capsys.readouterr()
        assert main(command) == 0
        return {file.name: (file.stat().st_mtime_ns, file.stat().st_ino) for file in out.iterdir()}, capsys.readouterr()

    first, printed = written()
    again, repeated = written()
    assert again == first
    assert {"peaks.csv", "run.json", "histories.h5", "intensity.csv", "report.html"} == {*first}
    assert "nothing is left to run" in repeated.err
    assert repeated.out == printed.out
    assert all(str(out / name) in repeated.err for name in first)
    for name in ("histories.h5", "intensity.csv", "report.html"):
        (out / name).unlink()
        made, _ = written()
        assert {*made} == {*first}
        assert made["run.json"] != first["run.json"]
        first = made
    study.write_text(f"# a comment\n{study.read_text()}")
    assert written()[0]["report.html"] != first["report.html"]


def without_the_tail(text):
    return "".join(text.splitlines(keepends=True)[:40])


def sorted_rows(text):
    first, *rows = text.splitlines(keepends=True)
    return first + "".join(sorted(rows))


def another_number(text):
    return text.replace("0.", "1.", 1)


@pytest.mark.slow
@pytest.mark.usefixtures("pages")
def test_a_changed_table_is_reported_kept_and_replaced_only_on_request(study, tmp_path, finished, undisturbed, capsys):
    out = finished
    command = ["run", str(study), "--out", str(out)]
    report = (out / "report.html").read_bytes()
    for change in (without_the_tail, sorted_rows, another_number):
        changed = change(undisturbed.decode())
        (out / "peaks.csv").write_text(changed, encoding="utf-8", newline="")
        capsys.readouterr()
        assert main(command) == 2
        told = capsys.readouterr().err
        assert (
            f"{out / 'peaks.csv'}: not as `rockbatch run` wrote it, with {RUNS} rows: it was edited, or is damaged"
            in told
        )
        assert "move it away if you edited it, and run the study again with --fresh" in told
        assert (out / "peaks.csv").read_text(encoding="utf-8") == changed
        assert (out / "report.html").read_bytes() == report
    assert (
        main(["report", str(out), "--out", str(tmp_path / "page.html")]) == 0
    )  # its words are shown, and that is told
    assert "it was edited, or is damaged; its present values are shown" in capsys.readouterr().err
    assert main([*command, "--fresh"]) == 0
    assert (out / "peaks.csv").read_bytes() == undisturbed


def test_a_folder_with_a_file_that_cannot_be_used_counts_as_finished_too(study, tmp_path, capsys):
    (tmp_path / "records").mkdir()
    (tmp_path / "records" / "a.at2").write_text("no record")
    study.write_text(study.read_text().replace("[motions]\n", '[motions]\npath = "records"\n'))
    command = ["run", str(study), "--out", str(tmp_path / "out")]
    assert main(command) == 1
    capsys.readouterr()
    assert main(command) == 1
    assert "nothing is left to run" in capsys.readouterr().err


def test_damaged_rows_of_a_journal_are_reported_and_run_again(study, tmp_path, undisturbed, capsys):
    out = tmp_path / "out"
    assert main(["run", str(study), "--out", str(out), "--shard", "1/1"]) == 0
    part = out / "peaks.csv.part"
    lines = part.read_bytes().splitlines(keepends=True)
    for row in (5, 80):
        lines[row] = lines[row].replace(b",ok,", b",0k,")
    part.write_bytes(b"".join(lines))
    assert main(["run", str(study), "--out", str(out)]) == 0
    told = capsys.readouterr().err
    assert f"{part}: 2 lines are damaged; the {RUNS - 2} undamaged runs are kept, the others are carried out" in told
    assert (out / "peaks.csv").read_bytes() == undisturbed


def test_a_table_without_its_run_json_does_not_count_as_finished(study, tmp_path, undisturbed, capsys):
    out = tmp_path / "out"
    out.mkdir()
    (out / "peaks.csv").write_text("not ours")
    for info in ("", "[]"):
        (out / "run.json").write_text(info)
        assert main(["run", str(study), "--out", str(out)]) == 0
        assert (out / "peaks.csv").read_bytes() == undisturbed


@unix
def test_a_changed_study_replaces_finished_results_only_when_it_is_whole(study, finished, capsys, monkeypatch):
    out = finished
    command = ["run", str(study), "--out", str(out)]
    earlier = {file.name: file.read_bytes() for file in out.iterdir()}
    write(study, last_scale=1.3)
    with monkeypatch.context() as patch:
        slowed_down(patch, 0.05)
        process = started(study, out)
    wait_for(out, 20)
    process.kill()
    process.join()
    there = {file.name: file.read_bytes() for file in out.iterdir() if file.name in earlier}
    assert there == earlier

    write(study, last_scale=1.4)
    capsys.readouterr()
    assert main(command) == 2
    assert "something has changed since (scales); undo that to continue" in capsys.readouterr().err
    assert main([*command, "--fresh"]) == 0
    assert "1.4" in {line.split(",")[3] for line in (out / "peaks.csv").read_text(encoding="utf-8").splitlines()}
    assert sorted(file.name for file in out.iterdir()) == sorted(earlier)


def test_results_of_other_peaks_never_stand_beside_new_ones(study, finished, monkeypatch):
    """Killed between the table and what belongs to it, there is the table alone, and its journal."""
    from rockbatch.batch.preparing import cost_of_finished

    out = finished
    command = ["run", str(study), "--out", str(out)]
    for name in ("checks.csv", "histories.h5"):
        (out / name).touch()
    write(study, last_scale=1.3)
    with monkeypatch.context() as patch:
        patch.setattr("rockbatch.batch.finishing.write_info", stopped)
        assert main(command) == 130
    assert sorted(file.name for file in out.iterdir() if file.suffix != ".lock") == ["peaks.csv", "peaks.csv.part"]
    assert cost_of_finished(out, {}) is None
    assert main(command) == 0
    assert json.loads((out / "run.json").read_text())["kept"] == SIMULATED


def test_two_cannot_write_into_one_folder(study, tmp_path, capsys):
    out = tmp_path / "out"
    out.mkdir()
    with only_writer(out):
        assert main(["run", str(study), "--out", str(out)]) == 2
    assert f"{out}: another process is writing its results there" in capsys.readouterr().err


# Shares


def test_shares_are_merged_to_the_results_of_one_run(study, tmp_path, undisturbed, capsys):
    folders = [tmp_path / str(share) for share in (1, 2, 3)]
    for share, folder in zip((1, 2, 3), folders, strict=True):
        assert main(["run", str(study), "--out", str(folder), "--shard", f"{share}/3"]) == 0
        assert finished_in(folder) == RUNS // 3
    out = tmp_path / "out"
    merge = ["merge", str(study), "--out", str(out)]
    assert main([*merge, str(folders[2]), str(folders[0])]) == 2
    told = capsys.readouterr().err
    first, last = SIMULATED // 3 + 1, 2 * SIMULATED // 3
    both = f"{first} to {last}, {SIMULATED + first} to {SIMULATED + last}"  # with the mirror images
    assert f"{RUNS // 3} of {RUNS} rows are missing in these folders: {both}; " in told
    assert f"rockbatch run {study} --out {out}" in told
    assert main([*merge, *map(str, folders)]) == 0
    assert (out / "peaks.csv").read_bytes() == undisturbed
    assert sorted(file.name for file in out.iterdir()) == ["peaks.csv", "report.html", "run.json"]
    assert json.loads((out / "run.json").read_text())["kept"] == SIMULATED


@pytest.mark.parametrize("shares", [1, 2, 5, SIMULATED])
def test_every_simulation_of_a_study_is_in_one_share(study, shares):
    """Also of a single record in both polarities."""
    loaded = load_study(study)
    runs = Plan(loaded, ground_motions(loaded))
    parts = [share_of(runs, share, shares) for share in range(1, shares + 1)]
    assert sorted(number for part in parts for number in part) == list(range(RUNS))
    simulated = [len(to_simulate(runs, part)) for part in parts]
    assert sum(simulated) == SIMULATED
    assert max(simulated) - min(simulated) <= 1


def test_what_merge_is_missing_can_be_carried_out_where_the_shares_were_joined(study, tmp_path, undisturbed):
    assert main(["run", str(study), "--out", str(tmp_path / "1"), "--shard", "1/2"]) == 0
    assert main(["merge", str(study), "--out", str(tmp_path), str(tmp_path / "1")]) == 2
    assert main(["run", str(study), "--out", str(tmp_path)]) == 0
    assert (tmp_path / "peaks.csv").read_bytes() == undisturbed


def test_shares_of_another_study_are_reported_all_at_once(study, tmp_path, capsys):
    other = write(tmp_path / "other.toml", last_scale=1.3)
    assert main(["run", str(other), "--out", str(tmp_path / "1"), "--shard", "1/2"]) == 0
    capsys.readouterr()
    folders = [str(tmp_path / "1"), str(tmp_path / "nowhere")]
    assert main(["merge", str(study), "--out", str(tmp_path / "out"), *folders]) == 2
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 2
    assert "something has changed since (scales)" in told[0]
    assert "nowhere" in told[1]
    assert "not there" in told[1]


@pytest.mark.parametrize("text", ["0/2", "3/2", "2", "1/0", "a/b", "-1/2"])
def test_an_impossible_share_is_refused(study, text, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["run", str(study), "--shard", text])
    assert ended.value.code == 2
    assert "must be such as 2/4" in capsys.readouterr().err or text.startswith("-")


@pytest.mark.parametrize(
    ("numbers", "text"),
    [([4], "5"), ([0, 1], "1 to 2"), ([0, 2, 3, 9], "1, 3 to 4, 10"), ([0, 2, 4, 6, 8], "1, 3, 5, 7, 9")],
)
def test_missing_rows_are_counted_from_one_in_ranges(numbers, text):
    assert ranges(numbers) == text
    assert ranges([*numbers[:-1], *range(20, 32, 2)]).endswith(", …")
