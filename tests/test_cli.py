"""The command line as users and their scripts meet it: files, messages, exit codes."""

import csv
import errno
import io
import json
import math
import os
import re
import shlex
import shutil
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from pathlib import Path
from types import SimpleNamespace

import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from report_samples import write_results
from studies import RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.batch import listening
from rockbatch.commands.cli import COMMANDS, EXIT_CODES, main, parser
from rockbatch.commands.motions import _by_cause
from rockbatch.commands.summary import summary
from rockbatch.common.errors import NoUnit, Truncated
from rockbatch.reporting import write_report
from rockbatch.results.beside_peaks import write_semicolons
from rockbatch.results.labelled import Labelled
from rockbatch.results.labels import Series
from rockbatch.study import load_study
from rockbatch.terminal import messages
from rockbatch.terminal.streams import filled, in_width, is_lost, shortened, show, tell

STUDY = study_text(title="A <pulse> & a pier")

AT2 = """PEER NGA STRONG MOTION DATABASE RECORD
Nowhere-01, 1/2/1999, Field, 090
ACCELERATION TIME SERIES IN UNITS OF G
NPTS=    {count}, DT=   .0100 SEC
"""


@pytest.fixture
def study(tmp_path):
    return write_study(tmp_path, STUDY)


def at2(values, count=None):
    return AT2.format(count=len(values) if count is None else count) + "\n".join(f"{v:15.7E}" for v in values) + "\n"


def test_run_writes_the_table_the_report_and_what_was_run(study, tmp_path, capsys):
    out = tmp_path / "results"
    assert main(["run", str(study), "--out", str(out), "--jobs", "1"]) == 0
    assert sorted(file.name for file in out.iterdir()) == ["histories.h5", "peaks.csv", "report.html", "run.json"]
    with open(out / "peaks.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["record"], row["case"], row["status"]) for row in rows] == [
        ("one-sine", "rigid", "ok"),
        ("one-sine", "pads", "ok"),
    ]
    info = json.loads((out / "run.json").read_text(encoding="utf-8"))
    assert info["study"]["text"] == STUDY
    assert info["runs"] == 2
    printed = capsys.readouterr()
    assert f"{float(rows[0]['theta_max_over_alpha']):.4f}" in printed.out
    assert "2 of 2" not in printed.out  # progress goes to stderr


@pytest.mark.usefixtures("pages")
def test_histories_of_another_record_are_added_on_demand_and_no_run_is_repeated(tmp_path, capsys):
    pulses = [
        SINE | {"name": name, "amplitude_g": size, "duration_s": 2.0} for name, size in (("weak", 0.3), ("strong", 0.5))
    ]
    study = write_study(tmp_path, study_text(pulses=pulses, cases=(RIGID,)))
    out = tmp_path / "out"
    command = ["run", str(study), "--out", str(out), "--jobs", "1"]
    assert main(command) == 0
    assert "--history RECORD" in (out / "report.html").read_text(encoding="utf-8")
    table = (out / "peaks.csv").read_bytes()
    assert [response.record for response in rb.open_results(out).responses] == ["strong"]
    assert main([*command, "--history", "weak"]) == 0
    assert "nothing is left to run" in capsys.readouterr().err
    assert (out / "peaks.csv").read_bytes() == table
    assert sorted(response.record for response in rb.open_results(out).responses) == ["strong", "weak"]
    assert main([*command, "--history", "weka"]) == 2
    assert "--history weka: no such record; did you mean weak?" in capsys.readouterr().err


@pytest.mark.slow
def test_a_spreadsheet_with_decimal_commas_gets_the_same_numbers(tmp_path, capsys):
    study = write_study(tmp_path, study_text(title="A ; B", cases=(RIGID | {"name": "1.5"},), output={"forces": True}))
    out = tmp_path / "out"
    assert main(["run", str(study), "--out", str(out), "--csv", "semicolon"]) == 0
    written = out / "peaks_semicolon.csv"
    assert capsys.readouterr().err.splitlines()[-1] == str(written)
    assert written.read_bytes().startswith(b"\xef\xbb\xbfrecord;case;")
    assert b".5;" not in written.read_bytes().replace(b";1.5;", b"")  # the name of a case, and no number
    table, peaks = pd.read_csv(written, sep=";", decimal=",", dtype={"case": "str"}), rb.open_results(out).peaks
    assert list(table) == list(peaks)
    for name in peaks.select_dtypes("number"):
        assert table[name].astype("float64").equals(peaks[name].astype("float64")), name
    assert list(table["case"]) == ["1.5"]
    assert main(["run", str(study), "--out", str(out), "--fresh"]) == 0
    assert not written.exists()  # it would be of other runs


def test_infinity_is_a_number_that_a_spreadsheet_computes_with(tmp_path):
    (tmp_path / "peaks.csv").write_text("record,friction_demand,beta\ninf,inf,1e-05\n1.5,,fast\n", encoding="utf-8")
    lines = write_semicolons(tmp_path).read_text(encoding="utf-8-sig").splitlines()
    assert lines == ["record;friction_demand;beta", "inf;9,99E+307;1e-05", "1.5;;fast"]


@pytest.mark.slow
def test_the_table_is_the_same_bytes_with_any_number_of_jobs(study, tmp_path):
    for jobs in ("1", "3"):
        assert main(["run", str(study), "--out", str(tmp_path / jobs), "--jobs", jobs]) == 0
    assert (tmp_path / "1/peaks.csv").read_bytes() == (tmp_path / "3/peaks.csv").read_bytes()


def test_the_most_frequent_reasons_of_failed_runs_are_named(study, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("rockbatch.simulation.runs.MOST_STEPS", 10)
    assert main(["run", str(study), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 1
    printed = capsys.readouterr().err
    assert "2 runs failed: see the column reason of peaks.csv\n  2 ×, for example: would take " in printed


@pytest.mark.usefixtures("pages")
def test_motions_replace_those_of_the_study_and_a_bad_file_is_a_row_with_its_reason(study, tmp_path, capsys):
    records = tmp_path / "records"
    records.mkdir()
    shake = [0.4 * (-1) ** (i // 20) for i in range(200)]
    (records / "GOOD090.AT2").write_text(at2(shake), encoding="latin-1")
    (records / "BAD090.AT2").write_text(at2(shake, count=201), encoding="latin-1")
    assert main(["run", str(study), "--out", str(tmp_path / "out"), "--motions", str(records)]) == 1
    with open(tmp_path / "out/peaks.csv", encoding="utf-8", newline="") as file:
        rows = {(row["record"], row["case"]): row for row in csv.DictReader(file)}
    assert rows["GOOD090", "rigid"]["status"] == "ok"
    assert rows["GOOD090", "pads"]["status"] in ("ok", "overturned", "flight")
    bad = rows["BAD090", ""]
    assert bad["status"] == "failed"
    assert "201" in bad["reason"]
    assert "200" in bad["reason"]
    told = capsys.readouterr()
    assert "BAD090" in told.err
    assert "1 file not used: see the column reason of peaks.csv" in told.err
    assert "failed" not in told.err
    assert "No limits were set, so nothing was checked. " in told.out
    assert told.out.index("uplift of the") < told.out.index("No limits were set")
    assert "BAD090" in (tmp_path / "out/report.html").read_text(encoding="utf-8")


@pytest.mark.usefixtures("pages")
def test_a_run_that_is_refused_is_a_row_with_its_reason_and_has_no_history(study, tmp_path, monkeypatch):
    """One step a sample is beyond the stability of β = 5000: nothing of it is run, not for its picture either."""
    extra = '[numerics]\nsubsteps = 1\n[output]\nhistories = "all"\n'
    study.write_text(STUDY.replace("beta = 50\n", "beta = 5000\n") + extra, encoding="utf-8")
    import rockbatch.batch.kept_histories

    real, written = rockbatch.batch.kept_histories.histories, []
    monkeypatch.setattr(
        rockbatch.batch.kept_histories,
        "histories",
        lambda *given, **more: (written.append(given[2]), real(*given, **more))[1],
    )
    assert main(["run", str(study), "--out", str(tmp_path / "out")]) == 1
    assert written == ["rigid"]
    with open(tmp_path / "out/peaks.csv", encoding="utf-8", newline="") as file:
        rigid, pads = csv.DictReader(file)
    assert rigid["status"] == "ok"
    assert (pads["status"], pads["theta_max_over_alpha"]) == ("failed", "")
    assert "substeps" in pads["reason"]
    assert "would blow up" in (tmp_path / "out/report.html").read_text(encoding="utf-8")


def test_wrong_input_runs_nothing_and_exits_with_2(study, tmp_path, capsys):
    study.write_text(STUDY.replace("eta = 2.5", "eta = 0.9\nbeat = 40"), encoding="utf-8")
    assert main(["run", str(study), "--out", str(tmp_path / "out")]) == 2
    assert not (tmp_path / "out").exists()
    told = capsys.readouterr().err
    assert "study.toml:24" in told
    assert "beta" in told  # did you mean
    assert "Traceback" not in told


FEWER = "run fewer at a time (--jobs), keep fewer histories, or "
AGAIN = "; what is finished is kept: give the same command again"


@pytest.mark.parametrize(
    ("words", "fewer", "again"),
    [
        (["statics"], "", ""),
        (["run"], FEWER, AGAIN),
        (["run", "--fresh"], FEWER, f"{AGAIN}, without --fresh"),
    ],
)
def test_out_of_memory_only_what_helps_the_command_is_advised(study, monkeypatch, capsys, words, fewer, again):
    def out_of_memory(*_):
        raise MemoryError

    command, *options = words
    monkeypatch.setattr(type(COMMANDS[command]), "run_command", out_of_memory)
    assert main([command, str(study), *options]) == 2
    assert capsys.readouterr().err == f"rockbatch: out of memory: {fewer}allow more{again}\n"


def test_a_misspelt_option_is_answered_with_the_one_of_its_command(study, capsys):
    for words, end in (
        (["run", str(study), "--dryrun"], "unrecognized arguments: --dryrun; did you mean --dry-run?"),
        (["motions", ".", "--units=g"], "unrecognized arguments: --units=g; did you mean --unit?"),
        (["run", str(study), "--zzz"], "unrecognized arguments: --zzz"),
        (["--zzz"], "unrecognized arguments: --zzz"),
    ):
        with pytest.raises(SystemExit) as ended:
            main(words)
        assert ended.value.code == 2
        assert capsys.readouterr().err.rstrip().removesuffix("; see `rockbatch --help`").endswith(end)


def test_for_a_study_in_place_of_results_the_message_names_the_folder(study, capsys):
    for command in ("check", "report"):
        assert main([command, str(study)]) == 2
        told = capsys.readouterr().err
        assert (
            f"{study}: a file, not a folder of results; give the folder, such as {Path('reports', study.stem)}" in told
        )


def test_motions_of_an_empty_folder_have_no_table(tmp_path, capsys):
    assert main(["motions", "--all", str(tmp_path)]) == 1
    assert capsys.readouterr() == ("", "0 records, 0 files not used, 0 left out; 0 stations\n")


def test_motions_shows_what_is_there_and_what_is_not_used(tmp_path, capsys):
    (tmp_path / "GOOD090.AT2").write_text(at2([0.1, -0.5, 0.2] * 50), encoding="latin-1")
    (tmp_path / "notes.doc").write_text("not a record", encoding="utf-8")
    (tmp_path / "records.zip").write_text("perhaps records", encoding="utf-8")
    assert main(["motions", "--all", str(tmp_path)]) == 1
    shown = capsys.readouterr().out
    assert "GOOD090" in shown
    assert "0.500" in shown
    assert "notes.doc: no record: " in shown
    assert "records.zip: not a zip archive, or a cut one" in shown


def test_reasons_are_counted_rarest_first_with_one_example_each():
    cut = [(Truncated, f"file{k}", f"line {k}: cut off in block (no. {k})") for k in range(3)]
    entries = [*cut, (NoUnit, "x", "no unit"), ("y", "y", "no step; no date"), (NoUnit, "u", "no unit in column 2")]
    assert _by_cause("Not used", entries, 2) == [
        "", "Not used", "  1 ×: no step; no date (y)", "  2 ×: no unit (such as x)", "  3 × for 1 other reason",
    ]  # fmt: skip
    assert _by_cause("Not used", entries, 4)[-1] == "  3 ×: line 0: cut off in block (no. 0) (such as file0)"
    assert not _by_cause("Not used", [], 2)


def test_help_loads_neither_compiler_nor_tables_nor_obspy():
    """Start-up stays light: what costs is loaded inside the command that needs it."""
    code = "import sys; from rockbatch.commands.cli import main\ntry: main(['--help'])\nexcept SystemExit: pass\n"
    heavy = "numba", "numpy", "pandas", "obspy", "h5py", "matplotlib", "scipy"
    code += f"print([m for m in {heavy!r} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_without_a_command_all_are_listed_with_a_line_each(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    assert main([]) == 2
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80
    assert lines[0] == "usage: rockbatch [-h] [--version] COMMAND ..."
    for name, command in COMMANDS.items():
        assert [line.split(None, 1) for line in lines if line.startswith(f"  {name} ")] == [[name, command.help]]


@pytest.mark.parametrize("name", COMMANDS)
def test_help_has_an_example_that_is_understood_and_the_exit_codes(name, capsys):
    with pytest.raises(SystemExit) as ended:
        main([name, "--help"])
    assert ended.value.code == 0
    told = capsys.readouterr().out
    example = COMMANDS[name].example
    assert f"example:\n  {example}\n" in told
    assert EXIT_CODES in told
    assert told.startswith(f"usage: rockbatch {name} ")
    program, *words = example.split()
    assert program == "rockbatch"
    assert parser().parse_args(words).command == name


def test_completion_offers_the_commands_and_options_that_may_come_next(tmp_path):
    def completed(line):
        asked = {
            "_ARGCOMPLETE": "1", "_ARGCOMPLETE_SHELL": "bash", "_ARGCOMPLETE_STDOUT_FILENAME": str(tmp_path / "told"),
            "COMP_LINE": line, "COMP_POINT": str(len(line)), "COMP_TYPE": "9", "_ARGCOMPLETE_IFS": "\n",
        }  # fmt: skip
        code = "from rockbatch.commands.cli import main; main()"
        subprocess.run([sys.executable, "-c", code], env=os.environ | asked, check=True, capture_output=True)
        return (tmp_path / "told").read_text(encoding="utf-8").split()

    assert completed("rockbatch s") == ["statics", "statement", "spectrum", "sensitivity"]
    assert "--seconds" in completed("rockbatch accuracy --sec")


@pytest.mark.skipif(sys.platform == "win32", reason="a shell of Unix")
def test_the_line_of_the_documentation_registers_the_completion():
    bash, tool = shutil.which("bash"), Path(sys.executable).with_name("register-python-argcomplete")
    line = 'eval "$(register-python-argcomplete rockbatch)"'
    assert line in (Path(__file__).parents[1] / "docs/commands.md").read_text(encoding="utf-8")
    if not (bash and tool.exists()):
        pytest.skip("without argcomplete or bash")
    environment = os.environ | {"PATH": f"{tool.parent}{os.pathsep}{os.environ['PATH']}"}
    command = [bash, "-c", f"{line}; complete -p rockbatch"]
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    assert "_python_argcomplete" in done.stdout


@contextmanager
def terminal(monkeypatch, rows, columns):
    """Let stderr be a terminal of this size; afterwards the list holds what it shows."""
    import fcntl
    import pty
    import struct
    import termios

    shown = []
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
    with os.fdopen(theirs, "w") as stream:
        monkeypatch.setattr("sys.stderr", stream)
        yield shown
    pieces = []  # a terminal hands over what it shows in pieces, of which the last may come late
    with suppress(OSError):  # at the end, since the other side is closed
        while piece := os.read(ours, 100_000):
            pieces.append(piece)
    shown.append(b"".join(pieces).decode())
    os.close(ours)


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals are of Unix")
def test_the_bar_moves_while_nothing_is_finished_and_makes_room_for_messages(monkeypatch):
    """As while kernels are compiled."""
    monkeypatch.setattr(listening, "MOVES_S", 0.1)
    with terminal(monkeypatch, 30, 100) as shown:
        listener = messages.Terminal()
        with listener.progress(3):
            time.sleep(1.2)
            listener.say("compiling")
    assert "0/3 [00:00<" in shown[0]
    assert "0/3 [00:01<" in shown[0]
    assert "\rcompiling" in shown[0].replace(" ", "")


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals are of Unix")
@pytest.mark.parametrize(("size", "drawn"), [((30, 100), True), ((0, 0), False)])
def test_progress_is_a_bar_with_the_time_left_on_a_terminal_that_has_a_size(size, drawn, monkeypatch):
    """A terminal without a size gets plain lines, as a file does."""
    monkeypatch.setattr(messages, "SECONDS_BETWEEN_LINES", 0.0)
    with terminal(monkeypatch, *size) as shown, messages.Terminal().progress(3) as advance:
        for _ in range(3):
            time.sleep(0.12)
            advance(1)
    if drawn:
        assert "/3 [" in shown[0]
        assert "<" in shown[0]  # time spent < time left
    else:
        assert shown[0].startswith("1 of 3 runs, ")


def test_plain_lines_of_progress_are_a_while_apart_and_estimate_the_time_left(monkeypatch, capsys):
    clock = iter([100.0, 105.0, 111.0, 115.0, 122.0])
    monkeypatch.setattr(messages, "time", SimpleNamespace(monotonic=lambda: next(clock)))
    monkeypatch.setattr(messages, "SECONDS_BETWEEN_LINES", 10.0)
    with messages.Terminal().progress(80) as advance:
        for _ in range(4):
            advance(10)
    assert capsys.readouterr().err.splitlines() == ["20 of 80 runs, 33 s left", "40 of 80 runs, 22 s left"]


def test_wide_tables_fit_the_terminal(monkeypatch):
    """On a terminal columns that do not fit go below the others; elsewhere a line is a row, for whoever reads it in."""
    head = ["", *(f"case {i}" for i in range(30))]
    rows = [["one", *["0.1"] * 30], [f"{'long ' * 20}(other)", *["0.2"] * 30]]
    assert len(in_width(head, rows).splitlines()) == 3
    monkeypatch.setattr("sys.stdout.isatty", lambda: True, raising=False)
    monkeypatch.setenv("COLUMNS", "60")
    lines = in_width(head, rows).splitlines()
    assert max(map(len, lines)) <= 60
    assert all(any(f"case {i}" in line for line in lines) for i in range(30))
    assert "\\" not in "".join(lines)
    assert lines[2].startswith("long lo…")
    assert "(other)" in lines[2]
    assert len(in_width(["", "a" * 100], [["one", "0"]]).splitlines()) == 2  # too wide for any block, and below none
    blocks = "\n".join(lines).split("\n\n")
    assert all(block.splitlines()[1].split()[0] == "one" for block in blocks)  # whose numbers they are


@pytest.mark.parametrize("terminal", [True, False])
def test_on_a_terminal_lines_are_wrapped_and_verdicts_keep_their_colour(monkeypatch, terminal):
    """Elsewhere a line stays one, and no escape sequence is written; nowhere does a text control the terminal."""
    stream = io.StringIO()
    monkeypatch.setattr(stream, "isatty", lambda: terminal)
    monkeypatch.setenv("COLUMNS", "40")
    tell(stream, f"\x1b[31mfail\x1b[0m {'word ' * 20}\x1b[2Jend")
    written = stream.getvalue()
    assert written.count("\x1b") == 2 * terminal
    assert written.startswith("\x1b[31mfail\x1b[0m word" if terminal else "\\x1b[31mfail\\x1b[0m word")
    assert "\\x1b[2Jend" in written
    lines = written.splitlines()
    assert (len(lines) > 2, max(map(len, lines)) <= 40 + len("\x1b[31m\x1b[0m")) == (terminal, terminal)


def test_prose_is_indented_behind_its_first_line():
    first, *rest = filled("word " * 100).splitlines()
    assert first.startswith("word")
    assert rest
    assert all(line.startswith("  word") for line in rest)


@pytest.mark.parametrize("name", ["run", "check", "accuracy", "design", "fragility", "spectrum", "sensitivity", "init"])
def test_help_says_which_files_come_out(name, capsys):
    with pytest.raises(SystemExit):
        main([name, "--help"])
    told = capsys.readouterr().out
    wanted = {"run": "peaks.csv", "check": "checks.csv", "init": "pier.toml"}.get(name, f"{name}.csv")
    assert wanted in told.partition("\nwrites:\n")[2]


# Whatever the terminal can print


def started(study, out, redirected, **more):
    """The command line in a shell of its own; its exit code and what it said on stderr."""
    command = f"{sys.executable} -m rockbatch run {study} --out {out} --jobs 1 {redirected}"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, errors="replace", env=os.environ | more)
    return done.returncode, done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="shells of Unix")
@pytest.mark.parametrize(
    ("redirected", "more", "code"),
    [
        ("> /dev/full", {"PYTHONIOENCODING": "ascii"}, 1), ("", {"PYTHONIOENCODING": "ascii"}, 0), (">&- 2>&-", {}, 0),
        ("> /dev/full 2> /dev/full", {}, 1),
    ],
)  # fmt: skip
@pytest.mark.slow
def test_a_run_ends_with_its_report_whatever_becomes_of_stdout_and_stderr(tmp_path, redirected, more, code):
    study = write_study(tmp_path, study_text(cases=[{"name": "θ-é-地", "base": "rigid"}], output={"histories": "none"}))
    ended, told = started(study, tmp_path / "out", redirected, **more)
    assert (tmp_path / "out/report.html").exists()
    assert ended == code
    assert "Traceback" not in told
    assert "Exception" not in told
    assert ("the output cannot be printed (No space left on device)" in told) == (redirected == "> /dev/full")


@pytest.mark.parametrize(
    ("code", "told"),
    [
        (errno.ENOSPC, "the output cannot be printed (No space left on device); the command continues\n"),
        (errno.EPIPE, ""),
    ],
)
def test_to_a_stream_that_has_failed_nothing_more_is_written(monkeypatch, capsys, code, told):
    class Failing(io.StringIO):
        def write(self, text):
            raise OSError(code, os.strerror(code))

    monkeypatch.setattr(sys, "stdout", Failing())
    for _ in range(2):
        show("text")
    assert capsys.readouterr().err == told
    assert [is_lost(sys.stdout), is_lost(sys.stdout)] == [True, False]


@pytest.mark.parametrize(
    ("error", "code", "begins"),
    [
        (
            PermissionError(errno.EACCES, "Permission denied", "out/peaks.csv"),
            2,
            "rockbatch: out/peaks.csv: Permission denied; ",
        ),
        (OSError(errno.ENOSPC, "No space left on device"), 2, "rockbatch: No space left on device; "),
        (OSError("the disk is gone"), 2, "rockbatch: the disk is gone; "),
        (rb.InputError("first", "second"), 2, "rockbatch: first\nrockbatch: second\n"),
        (MemoryError("for 7 runs"), 2, "rockbatch: for 7 runs\n"),
        (MemoryError(), 2, "rockbatch: out of memory: "),
        (ImportError("x.so: failed to map segment from shared object"), 2, "rockbatch: x.so: failed to map segment "),
        (KeyboardInterrupt(), 130, "rockbatch: interrupted\n"),
    ],
)
def test_an_error_of_a_command_is_a_line_with_the_file_and_the_reason(monkeypatch, capsys, error, code, begins):
    def failing(command, arguments):
        raise error

    monkeypatch.setattr(type(COMMANDS["examples"]), "run_command", failing)
    assert main(["examples"]) == code
    assert capsys.readouterr().err.startswith(begins)


@pytest.mark.sweep(fast=1)
@pytest.mark.skipif(sys.platform == "win32", reason="shells of Unix")
@pytest.mark.parametrize(("redirected", "told"), [("| true", ""), ("> /dev/full", "cannot be printed (No space left")])
@pytest.mark.usefixtures("pages")
def test_checks_and_their_report_do_not_need_a_reader(tmp_path, redirected, told):
    rules = tmp_path / "rules.toml"
    rules.write_text(
        '[[check]]\nname = "é"\ndemand = "theta_max_over_alpha"\nat_most = 0.9\nreason = "r"\n', encoding="utf-8"
    )
    (tmp_path / "out").mkdir()
    before = write_report(write_results(tmp_path / "out"), []).read_bytes()
    check = f"{sys.executable} -m rockbatch check {tmp_path / 'out'} --rules {rules}"
    done = subprocess.run(f"({check}; echo $? >&2) {redirected}", shell=True, capture_output=True, text=True)
    assert done.stderr.split()[-1] == "1"
    assert told in done.stderr
    assert "Traceback" not in done.stderr
    assert (tmp_path / "out/report.html").read_bytes() != before


@pytest.mark.skipif(sys.platform == "win32", reason="has a home folder always")
def test_without_a_home_it_runs_and_a_path_from_home_is_refused(tmp_path):
    """As in a container that is started under a number: no HOME, and no entry in the table of users."""
    code = """
import os, pwd, sys
for name in ("HOME", "XDG_CACHE_HOME", "ROCKBATCH_CACHE"):
    os.environ.pop(name, None)
pwd.getpwuid = {}.__getitem__
from rockbatch.simulation import kept
kept.keep("kernel", "identity", b"")
print(kept.unreported())
from rockbatch.commands.cli import main
main(["cache"])
sys.exit(main(["run", sys.argv[1]]))
"""
    study = write_study(tmp_path, study_text(motions={"path": "~/records"}))
    done = subprocess.run([sys.executable, "-c", code, str(study)], capture_output=True, text=True)
    assert done.returncode == 2, done.stderr
    assert "there is no home folder" in done.stdout
    assert "ROCKBATCH_CACHE" in done.stdout
    assert 'path = "~/records": there is no home folder here; write the whole path' in done.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are those of Linux")
def test_too_little_memory_ends_in_a_sentence(tmp_path):
    """Beyond it the compiler would end the process without one."""
    study = write_study(tmp_path, study_text())
    command = f"ulimit -v 400000; exec {sys.executable} -m rockbatch run {study} --out {tmp_path / 'out'}"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    assert "the memory of this process is limited to 410 MB" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_library_that_memory_is_too_little_for_is_reported_in_a_sentence(study, monkeypatch, capsys):
    """As pandas is, loaded when the runs are finished: their journal stays."""
    words = "algos.so: failed to map segment from shared object"

    def load(*_):
        raise ImportError(words)

    monkeypatch.setattr("rockbatch.commands.run.main", load)
    assert main(["run", str(study)]) == 2
    assert f"rockbatch: {words}: is memory limited" in capsys.readouterr().err
    words = "No module named 'pandas'"
    with pytest.raises(ImportError, match=words):
        main(["run", str(study)])


@pytest.mark.parametrize("command", [name for name, command in COMMANDS.items() if "--fresh" in command.arguments])
@pytest.mark.parametrize("word", ["--fre", "--f", "--fresch", "--refresh", "--freeze", "--threads", "--FRESH"])
def test_no_mistake_leads_to_the_option_that_discards_results(command, word, capsys):
    with pytest.raises(SystemExit) as ended:
        main([command, "pier.toml", word])
    error = capsys.readouterr().err
    assert ended.value.code == 2
    assert f"unrecognized arguments: {word}" in error
    assert not error.partition(word)[2].count("--fresh")


@pytest.mark.parametrize(
    ("words", "answer"),
    [
        ("chekc x", "rockbatch: there is no command chekc; did you mean check?"),
        ("Run pier.toml", "rockbatch: there is no command Run; did you mean run?"),
        ("zzz", "rockbatch: there is no command zzz; see `rockbatch --help`"),
        ("list", "rockbatch: there is no command list; did you mean examples?"),
        ("ls", "rockbatch: there is no command ls; did you mean examples?"),
        ("examples --list",
         "rockbatch: unrecognized arguments: --list; `rockbatch examples` takes none; see `rockbatch --help`"),
        ("-v", "rockbatch: unrecognized arguments: -v; did you mean --version?"),
        ("run pier.toml -o", "rockbatch: unrecognized arguments: -o; did you mean --out?"),
        ("run pier.toml --threads 4", "rockbatch: unrecognized arguments: --threads 4; did you mean --jobs?"),
        ("motions . --output=a.csv", "rockbatch: unrecognized arguments: --output=a.csv; did you mean --csv?"),
        ("run", "rockbatch run: the following arguments are required: STUDY.toml; see `rockbatch run --help`"),
        ("run pier", "rockbatch: pier: no such file; did you mean pier.toml?"),
        ("run .", "rockbatch: .: a folder; did you mean pier.toml?"),
        ("run empty", "rockbatch: empty: a folder; give a study file, such as pier.toml"),
        ("motions pier.toml",
         "rockbatch: pier.toml: not a record; give the folder of records, the path under [motions] of a study"),
        ("init --example nearfault x",
         "rockbatch: there is no example 'nearfault'; did you mean near_fault? `rockbatch examples` lists them"),
    ],
)  # fmt: skip
def test_a_mistake_in_a_command_line_is_answered_in_one_line_with_what_was_meant(
    words, answer, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "empty").mkdir()
    write_study(tmp_path, study_text()).rename(tmp_path / "pier.toml")
    try:
        code = main(words.split())
    except SystemExit as exit_:
        code = exit_.code
    assert (code, capsys.readouterr().err) == (2, f"{answer}\n")


@pytest.mark.parametrize(
    ("words", "wrong", "right"),
    [
        ("static pier.toml", "static", "statics pier.toml"),
        ("statics pier", "pier", "statics pier.toml"),
        ("statics peir.toml", "peir.toml", "statics pier.toml"),
        ("statics .", ".", "statics pier.toml"),
        ("statics sub", "sub", "statics sub/other.toml"),
        (r"statics sub\other.toml", r"sub\other.toml", "statics sub/other.toml"),
        ("statics pier.toml --curve c.csv", "--curve", "statics pier.toml --curves c.csv"),
        ("statics pier.toml --cvs=c.csv", "--cvs", "statics pier.toml --csv=c.csv"),
        ("compare --help", "compare", "report --help"),
        ("join --help", "join", "merge --help"),
    ],
)
def test_a_command_line_mended_as_its_answer_says_is_the_one_that_was_meant(
    words, wrong, right, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sub").mkdir()
    write_study(tmp_path, study_text(), "pier.toml")
    for folder, name in ((tmp_path, "checks.toml"), (tmp_path / "sub", "rules.toml")):
        write_study(folder, '[[check]]\nname = "no study"\n', name)
    write_study(tmp_path / "sub", study_text(), "other.toml")
    assert exit_code(words.split()) == 2
    (meant,) = re.findall(r"; did you mean (.*?)\?", capsys.readouterr().err)
    assert [shlex.split(words.replace(wrong, each, 1)) for each in meant.split(" or ")] == [right.split()]
    assert exit_code(right.split()) == 0


@pytest.mark.parametrize(
    ("words", "keys"),
    [
        ("run pier.toml --tolerance 1e-5", {"tolerance": 1e-5}),
        ("run pier.toml --quiet-s=5", {"quiet_s": 5.0}),
        ("accuracy pier.toml --quiet_s many", {"quiet_s": 2.0}),
        ("run pier.toml --intensity true", {"intensity": True}),
        ("run pier.toml --forces", {"forces": True}),
    ],
)
def test_an_option_that_is_a_key_of_the_study_is_answered_with_its_line_and_table(words, keys, tmp_path, capsys):
    assert exit_code(words.split()) == 2
    ((line, table),) = re.findall(r"write (.*) under (\[\w+\]); see", capsys.readouterr().err)
    study = load_study(write_study(tmp_path, f"{study_text()}\n{table}\n{line}\n"))
    for name, value in keys.items():
        assert getattr(study.numerics, name, None) == value or study.output.keys.get(name) == value


def test_a_folder_behind_a_study_is_answered_with_both_that_it_may_be(tmp_path, capsys):
    study = write_study(tmp_path, study_text())
    for words in (["run", str(study), "there"], ["fragility", str(study), "there"]):
        assert exit_code(words) == 2
        assert capsys.readouterr().err.endswith(
            "did you mean --out there for the results, or --motions there for the records?\n"
        )


def exit_code(words):
    """Exit code of a command line, also of one that the parser refuses."""
    try:
        return main(words)
    except SystemExit as exit_:
        return exit_.code


@pytest.mark.parametrize(("words", "begin"), [("help", "usage: rockbatch [-h]"), ("help run", "usage: rockbatch run"),
                                             ("check --list", "of every run: theta_max_over_alpha")])  # fmt: skip
def test_help_and_lists_are_there_under_the_words_for_them(words, begin, capsys):
    with pytest.raises(SystemExit) as exit_:
        main(words.split())
    assert exit_.value.code == 0
    assert capsys.readouterr().out.startswith(begin)


def test_an_unknown_demand_is_answered_with_the_command_that_lists_them(tmp_path, capsys):
    for demand, end in (
        ({"demand": "zzz"}, ': demand = "zzz": expected one that `rockbatch check --list` lists'),
        ({}, ': demand is missing; write for example demand = "theta_max_over_alpha"'),
    ):
        check = {"name": "drift", "at_most": 1, "reason": "x"} | demand
        assert main(["run", str(write_study(tmp_path, study_text(check=[check])))]) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert line.endswith(end)


@pytest.mark.slow
def test_reading_results_loads_no_record_format():
    code = "import sys, rockbatch.checks, rockbatch.reporting\n"
    code += "print([m for m in sys.modules if m.startswith('rockbatch.motions.formats')])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def two_of_each(values, foundations, piers, **columns):
    """Return labelled runs from peaks by record and number from 1, that of the foundation, or of the pier if one is alone."""
    rows = [
        {"record": record, "series": (place - 1) % len(foundations), "pier": (place - 1) % len(piers), "polarity": "+",
         "scale": 1.0, "with_vertical": "", "status": "ok", "theta_max_over_alpha": peak, "theta_max_is": ""} | columns
        for (record, place), peak in values.items()
    ]  # fmt: skip
    series = [Series(label, "", False, place) for place, label in enumerate(foundations)]
    return Labelled(series, piers, {}, {}, pd.DataFrame(rows), {})


def test_a_run_without_a_peak_has_its_status_alone_in_the_terminals_table():
    text = summary(two_of_each({("a", 1): math.nan}, ["pads"], [""], status="failed"), {"a": "first"})
    assert text.splitlines()[-1].split() == ["first", "failed"]


def test_the_terminals_table_says_what_tells_two_runs_of_a_record_apart():
    runs = two_of_each({("a", 1): 0.1, ("b", 1): 0.2}, ["pads"], [""])
    runs.runs.loc[1, ["record", "polarity", "scale"]] = ["a", "-", 2.0]
    lines = summary(runs, {"a": "first"}).splitlines()
    assert [" ".join(line.split()) for line in lines[-2:]] == [
        "first, motions scaled by 1 0.1000", "first, reversed, motions scaled by 2 0.2000"
    ]  # fmt: skip


def test_the_terminals_table_has_a_line_a_record_and_a_column_a_value():
    values = {("b", 1): 0.3, ("a", 1): 0.1, ("b", 2): 0.4, ("a", 2): 0.2}
    records = {"a": "first", "b": "second"}
    lines = summary(two_of_each(values, ["β = 40, η = 1", "β = 40, η = 2"], [""]), records).splitlines()
    assert [line.split() for line in lines[-2:]] == [["first", "0.1000", "0.2000"], ["second", "0.3000", "0.4000"]]
    assert lines[0] == "Peak rotation theta_max/alpha"
    of_piers = summary(two_of_each(values, ["pads"], ["α = 0.1 rad", "α = 0.2 rad"]), records)
    assert [block.splitlines()[0].rpartition(", ")[2] for block in of_piers.split("\n\n")] == [
        "α = 0.1 rad",
        "α = 0.2 rad",
    ]
    assert [block.splitlines()[-1].split() for block in of_piers.split("\n\n")] == [
        ["second", "0.3000"],
        ["second", "0.4000"],
    ]


def test_shortened_names_still_differ_as_the_names_do():
    """One of two cases has a tendon in the middle of a long name; both once read alike at 80 columns."""
    ends = "pads: K = 2 × 10⁶ kN/m, Fy = 40,000 kN, ", "F = 450 kN, C = 900 kN (s/m)^0.3, deck spring 2: gap = 20 mm"
    names = ["".join(ends), "P0 = 900 kN, ".join(ends), "pads", "".join(ends)]
    for room in (16, 24, 40, 60):
        short = shortened(names, room)
        assert short[0] == short[3]
        assert len(set(short)) == 3
        assert short[2] == "pads"
    assert "P0 = 900 kN" in shortened(names, 40)[1]
    assert max(map(len, shortened(names, 40))) <= 40


@settings(max_examples=100, deadline=None)
@given(st.lists(st.text("ab, ", max_size=30), min_size=1, max_size=6), st.integers(4, 12))
def test_any_names_that_differ_differ_when_shortened(names, room):
    assert len(set(shortened(names, room))) == len(set(names))
    assert all(short == name for short, name in zip(shortened(names, 30), names, strict=True))


def test_a_terminal_without_greek_gets_words_in_its_tables(monkeypatch):
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(io.BytesIO(), encoding="ascii"))
    text = in_width(["case", "θ/α"], [["β\u00a0=\u00a040 …", "∞"]])
    assert [line.split() for line in text.splitlines()] == [["case", "theta/alpha"], ["beta", "=", "40", "...", "inf"]]
