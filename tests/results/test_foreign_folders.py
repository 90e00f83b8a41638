"""Folders of results that somebody else has made: nothing in them leads elsewhere, and what does not fit is told in words."""

import csv
import hashlib
import json
import os
import random
import shutil
from dataclasses import replace

import h5py
import numpy as np
import pytest
from altered_histories import altered
from report_samples import response, write_results
from studies import RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.commands.cli import main
from rockbatch.common.files import csv_line, is_plain, opened, read_text
from rockbatch.pier.restraints import kinds_of, restraint_of
from rockbatch.results import reading
from rockbatch.results.run_json import SHAPE
from rockbatch.results.shape import Maybe, fits, unfit

STUDY = study_text(
    pulses=(SINE | {"duration_s": 1.0},), cases=(RIGID,), check=[
        {"name": "upright", "demand": "theta_max_over_alpha", "at_most": 0.5, "reason": "a test"}
    ],
)  # fmt: skip
SECRET = "root:x:0:0:a planted secret"


def test_who_names_a_file_of_a_folder_is_told_the_folder(tmp_path):
    folder = tmp_path / "of pads"
    folder.mkdir()
    for name in ("run.json", "peaks.csv"):
        (folder / name).write_text("{}", encoding="utf-8")
    with pytest.raises(rb.InputError) as refused:
        rb.open_results(folder / "peaks.csv")
    assert str(refused.value).endswith(f"give the folder, such as {folder}")


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """What `rockbatch run` leaves, with a history and a check."""
    folder = tmp_path_factory.mktemp("finished")
    assert main(["run", str(write_study(folder, STUDY)), "--out", str(folder / "out"), "--jobs", "1"]) == 0
    return folder / "out"


@pytest.fixture
def foreign(finished, tmp_path):
    """A copy of it, for somebody to change."""
    return shutil.copytree(finished, tmp_path / "foreign")


def told(folder, command="report"):
    """Words of the one who makes the report; none if it is made."""
    try:
        rb.report(folder) if command == "report" else rb.check(folder)
    except rb.InputError as error:
        return str(error)
    return ""


# Plain files only


@pytest.mark.parametrize("name", ["run.json", "peaks.csv", "histories.h5", "checks.csv"])
@pytest.mark.parametrize("kind", ["link", "pipe", "folder"])
def test_a_file_that_is_no_plain_one_is_not_opened(foreign, tmp_path, name, kind):
    """A link would show any file of this machine in the report; a pipe would wait for ever."""
    moved = shutil.move(foreign / name, tmp_path / name)
    make = {"link": lambda: (foreign / name).symlink_to(moved), "pipe": lambda: os.mkfifo(foreign / name)}
    make.get(kind, lambda: (foreign / name).mkdir())()
    words = told(foreign)
    assert f"{foreign / name}: " in words
    assert "neither read nor written in a folder of results; remove it" in words


@pytest.mark.parametrize("name", ["peaks.csv", "run.json", "report.html", "checks.csv", "histories.h5"])
def test_a_link_in_the_place_of_a_result_is_refused_and_its_target_stays(tmp_path, finished, name, capsys):
    notes = tmp_path / "notes.txt"
    notes.write_text("precious")
    out = tmp_path / "out"
    out.mkdir()
    (out / name).symlink_to(notes)
    assert main(["run", str(finished.parent / "study.toml"), "--out", str(out)]) == 2
    assert f"{out / name}: a link, which is not replaced" in capsys.readouterr().err
    assert notes.read_text() == "precious"
    assert (out / name).readlink() == notes
    assert len(list(out.iterdir())) == 1


def test_the_door_opens_plain_files_only(tmp_path):
    plain = tmp_path / "plain"
    plain.write_text("text")
    assert read_text(plain) == "text"
    for odd in (tmp_path / "nowhere", tmp_path, tmp_path / "link"):
        assert not is_plain(odd)
    (tmp_path / "link").symlink_to(plain)
    for path in (tmp_path, tmp_path / "link"):
        with pytest.raises(rb.InputError, match="neither read nor written"):
            opened(path)
    os.link(plain, tmp_path / "other")
    with opened(plain) as file:
        assert file.read() == b"text"
    with pytest.raises(rb.InputError, match="a file with several names"):
        opened(plain, "r+b")  # to write there would change a file that may be in another folder
    with pytest.raises(FileNotFoundError):
        opened(tmp_path / "nowhere")


def test_a_file_larger_than_any_that_is_written_is_not_read(foreign):
    with (foreign / "run.json").open("r+b") as file:
        file.truncate(3 << 30)  # of zeros, without a byte on disk
    assert "3.2 GB, more than `rockbatch` ever writes" in told(foreign)


# HDF5 leads nowhere


def external(file, secret):
    del file["runs/000000/theta"]
    size = len(file["runs/000000/t"])
    secret.write_bytes((SECRET.encode() * 40_000)[: 8 * size])
    file["runs/000000"].create_dataset("theta", (size,), "f8", external=[(str(secret), 0, h5py.h5f.UNLIMITED)])


def external_link(file, secret):
    with h5py.File(secret, "w") as other:
        other["theta"] = file["runs/000000/theta"][:]
    del file["runs/000000/theta"]
    file["runs/000000/theta"] = h5py.ExternalLink(str(secret), "/theta")


def virtual(file, secret):
    values = file["runs/000000/theta"][:]
    with h5py.File(secret, "w") as other:
        other["theta"] = values
    layout = h5py.VirtualLayout((len(values),), "f8")
    layout[:] = h5py.VirtualSource(str(secret), "theta", (len(values),))
    del file["runs/000000/theta"]
    file["runs/000000"].create_virtual_dataset("theta", layout)


def soft_link(file, _):
    del file["runs/000000/theta"]
    file["runs/000000/theta"] = h5py.SoftLink("/runs/000000/t")


def link_of_groups(file, secret):
    file.copy("runs", "elsewhere")
    del file["runs"]
    file["runs"] = h5py.SoftLink("/elsewhere")


def without_bytes(file, _):
    del file["runs/000000/theta"]
    file["runs/000000"].create_dataset("theta", (4 * 10**9,), "f8")


def compressed(file, _):
    del file["runs/000000/theta"]
    file["runs/000000"].create_dataset("theta", (4 * 10**9,), "f8", chunks=(10**6,), compression="gzip")


def without_times(file, _):
    file["runs/000000/t"][:] = np.nan


def falling_times(file, _):
    file["runs/000000/t"][:] = file["runs/000000/t"][:][::-1]


def infinite(file, _):
    file["runs/000000/theta"][3] = np.inf


def text_for_numbers(file, _):
    size = len(file["runs/000000/t"])
    del file["runs/000000/theta"]
    file["runs/000000/theta"] = np.full(size, b"a", dtype="S1")


def beyond_the_end(file, _):
    after = file["runs/000000/events/after"]
    after[0] = 10**9


def array_for_a_name(file, _):
    file["runs/000000"].attrs["record"] = np.zeros(1000)


def another_pier(file, _):
    file["runs/000000/pier"].attrs["alpha"] = 1e300


HDF5 = (
    external, external_link, virtual, soft_link, link_of_groups, without_bytes, compressed, without_times, falling_times,
    infinite, text_for_numbers, beyond_the_end, array_for_a_name, another_pier,
)  # fmt: skip


@pytest.mark.parametrize("change", HDF5)
def test_histories_lead_nowhere_and_have_room_in_their_file(foreign, tmp_path, change):
    """Nothing of the file beside is in the report, and no memory is asked for that the file does not have."""
    (foreign / "report.html").unlink()
    with altered(foreign / "histories.h5") as file:
        change(file, tmp_path / "secret")
    assert f"{foreign / 'histories.h5'}: damaged (" in told(foreign)
    assert not (foreign / "report.html").exists()
    with pytest.raises(rb.InputError, match=r"histories\.h5: damaged \("):
        rb.open_results(foreign).response()


def test_a_history_of_a_case_that_nobody_lists_is_reported(foreign):
    with altered(foreign / "histories.h5") as file:
        file["runs/000000"].attrs["case"] = "unheard of"
    assert "there is a history of case unheard of that peaks.csv or run.json does not list" in told(foreign)


# run.json


def places(shape, value, at=()):
    """Every place of ``value`` that a shape says something about."""
    shape = shape.shape if isinstance(shape, Maybe) else shape
    if at:
        yield at
    if isinstance(shape, dict) and str not in shape and isinstance(value, dict):
        for key in sorted(shape.keys() & value.keys()):
            yield from places(shape[key], value[key], (*at, key))
    if isinstance(shape, list) and value:
        yield from places(shape[0], value[0], (*at, 0))


@pytest.mark.parametrize(
    "base",
    [
        rb.RigidBase(restitution=0.9, friction=0.5),
        rb.ElasticBase(60.0, zeta=0.1, friction=0.5),
        rb.YieldingBase(60.0, 0.1, eta=3.0, n=4.0),
    ],
)
def test_all_that_is_written_about_a_base_and_its_devices_has_a_shape(base):
    """What has none, such as restraints once, a reader would take as it comes."""
    devices = (rb.Damper("hysteretic", f=0.1, yield_m=0.01, at="left"), rb.Tendon(0.1, 0.5, at=0.5))
    devices += (rb.Stop(lam=2.0, gap_m=0.1), rb.DeckSpring(lam=2.0, gap_m=0.1, height_m=5.0))
    pier = rb.Pier(0.2, 1.0, mass_t=100.0)
    written = replace(base, restraints=devices).parameters(pier)
    shape = SHAPE["cases"][0]["parameters"]
    assert written.keys() <= shape.keys()
    assert all({*device} <= {*shape["restraints"].shape[0]} for device in written["restraints"])
    assert fits(written, shape)
    assert tuple(map(restraint_of, written["restraints"])) == devices
    others = dict.fromkeys(("side", "kind", "gap_m"), "new")  # keys of other devices, which a later version may give it
    assert restraint_of(others | written["restraints"][1]) == devices[1]
    assert kinds_of(others | written["restraints"][1]) == ("tendon",)


@pytest.mark.filterwarnings("ignore::rockbatch.common.errors.AboutResults")  # of a digest that is another
@pytest.mark.parametrize("command", ["report", "check"])
@pytest.mark.parametrize(
    "part", [0, pytest.param(1, marks=pytest.mark.slow), pytest.param(2, marks=pytest.mark.thorough)]
)
def test_whatever_stands_in_the_place_of_a_value_of_run_json_there_are_words(foreign, command, part):
    """Every place that is read, with one of many values: a page, a sentence, or verdicts."""
    good = (foreign / "run.json").read_text(encoding="utf-8")
    chance = random.Random(f"{command} {part}")
    values = (None, True, -1, 0, 1e300, 10**400, float("nan"), "x", "", [], {}, [[]], [None], {"a": 1}, ["x"])
    there = list(places(SHAPE, json.loads(good)))
    assert len(there) > 60
    for at in there[part::3]:
        info = json.loads(good)
        here = info
        for key in at[:-1]:
            here = here[key]
        here[at[-1]] = chance.choice(values)
        (foreign / "run.json").write_text(json.dumps(info), encoding="utf-8")
        told(foreign, command)
        del here[at[-1]]
        if fits(info, SHAPE):  # if not, that is told as a wrong value is
            (foreign / "run.json").write_text(json.dumps(info), encoding="utf-8")
            told(foreign, command)


@pytest.mark.parametrize(
    ("devices", "place"),
    [
        (3, ""),
        ("x", ""),
        ({"kind": "friction"}, ""),
        ([3], "[0]"),
        ([{"kind": 5}], "[0].kind"),
        ([{"psi": "x"}], "[0].psi"),
    ],
)
def test_impossible_devices_are_refused(foreign, devices, place):
    """Which checks a case can have hangs on its dampers and tendons."""
    info = json.loads((foreign / "run.json").read_text(encoding="utf-8"))
    info["cases"][0]["parameters"]["restraints"] = devices
    (foreign / "run.json").write_text(json.dumps(info), encoding="utf-8")
    assert f"cases[0].parameters.restraints{place}: expected" in told(foreign, "check")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[" * 100_000, "not JSON"), ("[]", "the whole: expected an object"), ("{}", "has no rockbatch, created, command"),
        ('{"a": 1', "not JSON"), ("\xff", "not JSON"),
    ],
)  # fmt: skip
def test_a_damaged_run_json_is_refused(foreign, text, words):
    (foreign / "run.json").write_text(text, encoding="latin-1")
    assert words in told(foreign)


TARGET = {
    "spectrum": "mine", "range_s": [0.1, 1.0], "factors": "none", "pairs": "apart", "alone": 0, "at_least": 0.9,
    "period_s": [0.1, 1.0], "sa_g": [1.0, 0.5], "mean_sa_g": [0.9, 0.6],
}  # fmt: skip


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({}, ""), ({"sa_g": "x"}, "target.sa_g: expected a list"), ({"factors": {}}, "target.factors: expected"),
        ({"range_s": [None]}, "target.range_s[0]: expected a number"), ({"period_s": []}, ""), ({"mean_sa_g": [1.0]}, ""),
        ({"range_s": [0.1]}, ""), ({"sa_g": [0.0, 0.0]}, ""), ({"mean_sa_g": [0.9, -0.6]}, ""),
    ],
)  # fmt: skip
@pytest.mark.usefixtures("pages")
def test_a_damaged_target_is_refused_or_left_out(foreign, wrong, words):
    info = json.loads((foreign / "run.json").read_text(encoding="utf-8")) | {"target": TARGET | wrong}
    (foreign / "run.json").write_text(json.dumps(info), encoding="utf-8")
    assert words in told(foreign)
    if not words:
        shown = "The suite against its target spectrum" in (foreign / "report.html").read_text(encoding="utf-8")
        assert shown is (wrong == {})


def test_a_column_without_a_name_is_refused(foreign):
    lines = (foreign / "peaks.csv").read_text(encoding="utf-8").splitlines()
    text = "\n".join([lines[0] + ",", *(line + "," for line in lines[1:])])
    (foreign / "peaks.csv").write_text(text, encoding="utf-8")
    assert "peaks.csv:1: has a column without a name" in told(foreign)


@pytest.mark.parametrize("count", [-1, "x", None, {}])
def test_an_unknown_way_of_counting_is_refused(foreign, count):
    info = json.loads((foreign / "run.json").read_text(encoding="utf-8")) | {"count": count}
    (foreign / "run.json").write_text(json.dumps(info), encoding="utf-8")
    assert 'count: expected "station" or "component"' in told(foreign)


@pytest.mark.parametrize("more", [{"target_sa_g": [1.0]}, {"mean_sa_g": [], "target_sa_g": []}])
@pytest.mark.usefixtures("pages")
def test_spectra_that_do_not_fit_their_periods_are_not_drawn(foreign, more):
    info = json.loads((foreign / "run.json").read_text(encoding="utf-8"))
    info["spectra"] |= more
    (foreign / "run.json").write_text(json.dumps(info), encoding="utf-8")
    assert told(foreign) == ""
    assert "Pseudo-spectral" not in (foreign / "report.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("command", ["report", "check"])
def test_a_case_of_values_that_the_table_does_not_have_is_reported(foreign, command):
    info = json.loads((foreign / "run.json").read_text(encoding="utf-8"))
    info["cases"][0]["columns"]["a"] = 1
    (foreign / "run.json").write_text(json.dumps(info), encoding="utf-8")
    assert "cases vary a, which varied does not list" in told(foreign, command)


def test_a_place_that_does_not_fit_is_named_with_what_was_expected():
    shape = {"a": [{"b": (float, None), "c": Maybe(str)}], "d": ("x", "y"), "e": {str: int}}
    assert fits({"a": [{"b": 1}, {"b": None, "c": "", "more": []}], "d": "y", "e": {"z": 3}}, shape)
    wrong = {"a": [{"b": 1e300}, {"c": 1}], "d": "z", "e": {"z": 0.5}}
    assert [str(one) for one in unfit(wrong, shape)] == [
        "a[0].b: expected a number or null", "a[1].b is missing", "a[1].c: expected a text", 'd: expected "x" or "y"',
        "e.z: expected a whole number",
    ]  # fmt: skip
    assert [str(one) for one in unfit(wrong, shape, 1)] == ["a[0].b: expected a number or null"]


# Tables


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (",ok,", ",fine,", 'status = "fine": expected ok, overturned, flight, failed'),
        (",1,ok", ",1e999,ok", 'scale = "1e999": expected a number or nothing'),
        (",1,ok", ",,ok", "a run without scale"), (",ok,", ",ok,,,,,,,,,,,,,,,,,,,,,,,", "cells: expected"),
    ],
)  # fmt: skip
def test_a_table_that_no_run_can_have_left_is_reported_with_its_line(foreign, old, new, words):
    peaks = foreign / "peaks.csv"
    peaks.write_text(peaks.read_text(encoding="utf-8").replace(old, new, 1), encoding="utf-8")
    said = told(foreign)
    assert f"{peaks}:2: " in said
    assert words in said


@pytest.mark.parametrize("word", ["demand", "statistic", "count", "sense", "verdict"])
def test_a_verdict_of_words_that_no_check_has_is_reported(foreign, word):
    path = foreign / "checks.csv"
    head, row = csv.reader(path.read_text(encoding="utf-8").splitlines())
    row[head.index(word)] = "pads"
    path.write_text(csv_line(head) + csv_line(row), encoding="utf-8")
    assert told(foreign) == f"{path}: damaged ({word} = 'pads'); start `rockbatch check` again"


@pytest.mark.parametrize("value", ["inf", "-1e999", "nan"])
def test_a_verdict_of_a_pier_that_no_case_has_is_reported(foreign, value):
    path = foreign / "checks.csv"
    head, row = csv.reader(path.read_text(encoding="utf-8").splitlines())
    path.write_text(csv_line([*head, "alpha"]) + csv_line([*row, value]), encoding="utf-8")
    assert told(foreign) == f"{path}: damaged ({value} as a value of a case); start `rockbatch check` again"


def test_a_table_that_is_mended_between_two_looks_is_reported(foreign, monkeypatch):
    """A row that cannot be is looked for in the file again, where it may be right by then."""
    peaks = foreign / "peaks.csv"
    sound = peaks.read_text(encoding="utf-8")
    peaks.write_text(sound.replace(",ok,", ",fine,", 1), encoding="utf-8")
    plain = reading._bad_cells
    monkeypatch.setattr(
        reading, "_bad_cells", lambda *where: (peaks.write_text(sound, encoding="utf-8"), plain(*where))[1]
    )
    assert told(foreign) == f"{peaks}: changed while it was read; read it again when nothing writes into it any more"


@pytest.mark.parametrize("wrong", ["run.json", "peaks.csv"])
def test_a_folder_of_another_version_that_cannot_be_read_names_it(foreign, wrong):
    """A later version may have bases and outcomes that this one does not know."""
    info = json.loads((foreign / "run.json").read_text(encoding="utf-8")) | {"rockbatch": "9.1\x1b"}
    if wrong == "run.json":
        info["cases"][0]["base"] = "rubber"
    else:
        peaks = foreign / "peaks.csv"
        peaks.write_text(peaks.read_text(encoding="utf-8").replace(",ok,", ",leaning,", 1), encoding="utf-8")
    (foreign / "run.json").write_text(json.dumps(info), encoding="utf-8")
    ending = f"\n{foreign}: written by rockbatch 9.1\\x1b, but this is {rb.__version__}: read it with that version"
    assert told(foreign).endswith(ending)
    assert told(foreign, "check").endswith(ending)


# What a terminal would obey


@pytest.mark.usefixtures("pages")
def test_nothing_of_a_foreign_folder_reaches_terminal_or_report_as_a_command(tmp_path, capsys):
    bell = "\x1b]0;owned\x07\x1b[2J\x9b31m\u202e\u200b\u3164\U000e0041"
    write_results(
        tmp_path, records=[(f"rec{bell}", 0.5)], machine=f"here{bell}", notes=[bell],
        unusable=[{"name": f"bad{bell}", "source": f"x{bell}.at2", "reason": f"why{bell}"}],
        changes={(f"rec{bell}", "rigid"): {"status": "failed", "reason": f"because{bell}"}},
    )  # fmt: skip
    rules = tmp_path / "rules.toml"
    rules.write_text('[[check]]\nname = "n"\ndemand = "theta_max_over_alpha"\nat_most = 1.0\nreason = "r"\n')
    main(["report", str(tmp_path)])
    main(["check", str(tmp_path), "--rules", str(rules)])
    (tmp_path / "peaks.csv").write_text(f"record{bell}\n")
    main(["report", str(tmp_path)])
    main(["report", str(tmp_path / f"nowhere{bell}")])
    printed = capsys.readouterr()
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    table = (tmp_path / "checks.csv").read_text(encoding="utf-8")
    assert "rec\\x1b]0;owned\\x07" in page
    assert "nowhere\\x1b" in printed.err
    for text in (printed.out, printed.err, page, table):
        assert not set(text) & set("\x1b\x07\x9b\u202e\u200b\u3164\U000e0041")


def test_the_report_of_made_up_histories_still_comes(tmp_path):
    """The samples that other tests draw stay what a folder may hold."""
    write_results(tmp_path)
    from rockbatch.reporting import write_report

    base = rb.YieldingBase(beta=40.0, eta=2.5, epsilon=0.05)
    assert write_report(tmp_path, [response("ERZ-NS", "1", base)]).exists()


def test_what_is_expected_of_a_value_is_said_in_words():
    shape = {"a": [float], "b": {str: int}, "c": (str, None), "d": ([int], {"x": int})}
    right = {"a": [1.5], "b": {"k": 2}, "c": None, "d": {"x": 1}}
    assert fits(right, shape)
    expected = {"a": "a list", "b": "an object", "c": "a text or null", "d": "a list or an object"}
    for key, words in expected.items():
        (problem,) = unfit(right | {key: 1.25}, shape)
        assert (problem.place, problem.expected) == (key, words)


def test_a_table_with_other_ends_of_lines_is_not_edited(tmp_path):
    written = b"record,status\na,ok\nb,overturned\n"
    noted = {"peaks": {"rows": 2, "sha256": hashlib.sha256(written).hexdigest()}}
    for content, differs in (
        (written, False),
        (written.replace(b"\n", b"\r\n"), False),
        (written.replace(b"ok", b"ko"), True),
    ):
        (tmp_path / "peaks.csv").write_bytes(content)
        assert bool(reading.edited(tmp_path, noted)) is differs
