"""Messages of batches, read back: each count, file and name in them is that of what they speak of."""

from types import SimpleNamespace

import pytest
from messages import assert_states, said_by

import rockbatch as rb
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import Listener, listener_of
from rockbatch.batch.preparing import check_records, run_count
from rockbatch.batch.threads import Threads, engine_of
from rockbatch.workflow.running import run_into

COLUMNS = ("record", "theta")
PIER = rb.Pier(0.2, 1.0)
MOTION = rb.Motion("shaken", 0.01, [0.1, 0.2, 0.3, 0.1])


def journal(path, rows, motions="b"):
    """Write a journal with these rows, which an exception leaves behind, and return its path."""
    with pytest.raises(KeyboardInterrupt), Journal(path, COLUMNS, {"cases": "a", "motions": motions}) as kept:  # noqa: PT012
        kept.add_all({number: {"record": name, "theta": number} for number, name in rows.items()})
        raise KeyboardInterrupt
    return path


def heard(path, call, **options):
    """Return what a journal tells, and the error that ends its use by ``call``, if one does."""
    told = []
    with Journal(path, COLUMNS, {"cases": "a", "motions": "b"}, tell=told.append, **options) as kept:
        told.append(said_by(lambda: call(kept) or ""))
    return told


def of_study(stations, scales, cases):
    motions = SimpleNamespace(motions=[SimpleNamespace(of_station=name) for name in stations])
    study = SimpleNamespace(cases=[None] * cases, motions=SimpleNamespace(scale=scales, polarity=["+"]))
    return run_count(study, motions)


def simulated(**settings):
    return lambda: rb.simulate(PIER, rb.RigidBase(), MOTION, **settings)


MESSAGES = {
    "a product of runs": (
        lambda: of_study("aabc", [1.0, 2.0, 3.0], 5),
        [4.0, "records", 3.0, "stations", 3.0, "scales", 5.0, "cases", 60.0, "runs"],
    ),
    "a product of one case": (lambda: of_study("abc", [1.0], 1), [3.0, "records", 1.0, "case", 3.0, "runs"]),
    "a record to keep": (
        lambda: check_records(["LGP00"], SimpleNamespace(motions=[MOTION, rb.Motion("LGP000", 0.01, [0.1, 0.2])])),
        ["LGP00", "LGP000"],
    ),
    "no record to keep": (
        lambda: check_records(["x"], SimpleNamespace(motions=[MOTION, rb.Motion("LGP000", 0.01, [0.1, 0.2])])),
        ["x", "shaken, LGP000"],
    ),
    "a tolerance": (simulated(tolerance=3e-13), ["tolerance", 3e-13, 1e-12]),
    "time after the record": (simulated(quiet_s=-2.5), ["quiet_s", -2.5, 0.0]),
    "a share of the weight": (simulated(forces=True, least_normal_share=1.7), [1.7, 0.0, 1.0]),
    "no progress": (lambda: listener_of(7), [7.0]),
    "no threads": (lambda: engine_of(-3), ["jobs", -3.0, 1.0]),
    "three threads": (lambda: str(Threads(3)), [3.0, "threads"]),
    "one thread": (lambda: str(Threads(1)), [1.0, "thread"]),
}  # fmt: skip


@pytest.mark.parametrize("name", MESSAGES)
def test_what_a_message_names_is_what_it_speaks_of(name):
    call, expected = MESSAGES[name]
    assert_states(said_by(call), *expected)


def test_a_share_is_said_to_be_part_of_the_runs_of_the_study_on_its_engine(tmp_path):
    cases = [{"name": f"rock {chr(97 + i)}", "base": "rigid", "restitution": 0.9 - 0.01 * i} for i in range(3)]
    motions = [{"name": "sine", "shape": "sine", "amplitude_g": 0.1, "period_s": 0.8, "dt_s": 0.02, "duration_s": 1.0}]
    study = rb.Study.from_dict(
        {"pier": {"alpha": 0.2, "p": 1.0}, "motions": {"pulse": motions, "scale": [0.5, 0.6, 0.7]}, "case": cases}
    )
    told = []
    listener = Listener()
    listener.say = told.append
    run_into(tmp_path, study, Threads(1), listener, command=(), share=(2, 4))
    begun, finished = (text.replace(str(tmp_path / "peaks.csv.part"), "FILE") for text in told)
    product = [1.0, "record", 3.0, "scales", 3.0, "cases", 9.0, "runs"]
    assert_states(begun, *product, 1.0, "thread", "share", 2.0, 4.0, 2.0, "runs")
    assert_states(finished, "FILE", "share", 2.0, 4.0, "finished")


def test_a_journal_of_other_motions_is_refused_with_its_rows_and_what_has_changed(tmp_path):
    path = journal(tmp_path / "peaks.csv.part", {0: "a", 2: "b", 5: "c"}, "other")
    said = said_by(lambda: heard(path, len))
    assert_states(said.replace(str(path), "FILE"), "FILE", 3.0, "motions", "--out", "--fresh")


def test_damaged_lines_are_counted_apart_from_the_rows_that_are_kept(tmp_path):
    path = journal(tmp_path / "peaks.csv.part", {0: "a", 2: "b", 5: "c", 6: "d", 7: "e"})
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(
        b"".join([*lines[:2], lines[2].replace(b"b", b"x"), lines[3], lines[4].replace(b"d", b"x"), lines[5]])
    )
    said = "; ".join(heard(path, lambda kept: None)).replace(str(path), "FILE")
    assert_states(said, 2.0, "lines", 3.0)


def test_a_run_that_two_folders_have_is_named_by_its_number_and_file(tmp_path):
    here = journal(tmp_path / "here.part", {4: "a", 7: "b"})
    other = journal(tmp_path / "other.part", {4: "a", 7: "x", 9: "c"})
    said = "; ".join(heard(here, lambda kept: kept.add_from(other))).replace(str(other), "FILE")
    assert_states(said, "FILE", 7.0)
