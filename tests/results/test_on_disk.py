"""Results on disk: which histories are kept, that they come back to the bit, and what is said when they do not."""

import os
import subprocess
import sys
from dataclasses import asdict, replace
from itertools import pairwise
from types import SimpleNamespace

import h5py
import numpy as np
import pandas as pd
import pint
import pytest
from altered_histories import altered
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.batch.execution import execute_runs
from rockbatch.batch.journal import Journal
from rockbatch.batch.kept_histories import keep_histories, to_keep, worst
from rockbatch.batch.observers import observers_of
from rockbatch.batch.plan import Plan
from rockbatch.batch.threads import Threads
from rockbatch.outcome.outcome import TERMS
from rockbatch.results import histories_file, run_json
from rockbatch.results.columns import columns
from rockbatch.results.histories_file import FORMAT, HISTORY_UNITS, Responses, history_bytes, seal, write
from rockbatch.results.reading import read_saved
from rockbatch.results.run_json import describe, write_info
from rockbatch.simulation import Run, run_to_tolerance
from rockbatch.simulation.histories import histories
from rockbatch.simulation.recording import recorded
from rockbatch.study.suite import ground_motions

STUDY = study_text(
    title="Two pulses, three bases",
    pier={"alpha": [0.2, 0.25], "p": 1.0},
    motions={"polarity": ["+", "-"]},
    pulses=(
        SINE | {"name": "weak", "amplitude_g": 0.5, "duration_s": 1.0},
        SINE | {"name": "strong", "duration_s": 1.0},
    ),
    cases=(
        RIGID,
        {"name": "elastic", "base": "elastic", "beta": 50},
        PADS | {"epsilon": 0.1, "spring": ["bouc-wen", "epp"]},
    ),
    output={"histories": "all", "ledger": True, "forces": True},
)
PIER = rb.Pier(0.2, 1.0)
CREATED = "2007-06-25T10:00:00+00:00"


def carried_out(folder, text=STUDY):
    """A study as ``rockbatch run`` carries it out, up to its histories: what is saved, the study and its runs."""
    path = write_study(folder, text)
    study = rb.load_study(path)
    motions = ground_motions(study)
    runs = Plan(study, motions)
    with Journal(folder / "peaks.csv.part", columns(study), {}) as journal:
        execute_runs(runs, study.numerics, journal, Threads(1), observers_of(study.output))
        journal.write_in_order(folder / "peaks.csv")
    info = {"rockbatch": "0.1.0", "created": CREATED, "versions": {"python": "3.11.2", "numpy": "2.3.1"}}
    info |= {"command": [], "machine": "", "runs": len(runs), "jobs": 1, "wall_s": 1.0, **describe(study, motions)}
    write_info(folder, info)
    return read_saved(folder), study, runs


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("results")
    keep_histories(*carried_out(folder))
    return rb.open_results(folder)


FEW = study_text(
    pulses=(SINE | {"duration_s": 1.0},),
    cases=(RIGID, PADS | {"spring": ["bouc-wen", "epp"]}),
    output={"histories": "all", "ledger": True},
)
"""A study of three runs."""


TABLES = ("history", "events", "ledger", "forces", "impacts")


def same(one, other):
    """Whether two responses are equal to the bit, types of columns included."""
    for name in TABLES:
        ours, theirs = getattr(one, name), getattr(other, name)
        if ours is None or theirs is None:
            assert ours is theirs
        else:
            pd.testing.assert_frame_equal(ours, theirs, check_exact=True)
    frames = dict.fromkeys((*TABLES, "row"))  # the row is in peaks.csv
    ours, theirs = (asdict(replace(response, **frames)) for response in (one, other))
    for values in (ours, theirs):  # what is unusual was confirmed before it was written
        del values["pier"]["confirm"], values["base"]["confirm"]
    assert ours == theirs
    assert type(one.base) is type(other.base)
    return True


INFO = {"rockbatch": "0", "created": CREATED, "versions": {}, "varied": []}
INFO["study"] = {"title": "", "text": "", "sha256": ""}


def stored(folder, *responses):
    """The responses, written and opened."""
    write(folder / "histories.h5", responses, INFO)
    return Responses(folder / "histories.h5", INFO)


def at_rest(name="still", case="rigid"):
    """The response to no motion at all."""
    return rb.simulate(PIER, rb.RigidBase(), rb.Motion(name, 0.01, np.zeros(3)), quiet_s=0.0, case=case)


# Round trip


@pytest.mark.slow
def test_every_response_comes_back_equal_to_the_bit(results):
    """Another simulation with the substeps of the table gives the very same numbers: every fifth, of all kinds."""
    assert len(results.responses) == 2 * 2 * 2 * 4 == len(results.peaks)
    for row in results.peaks[::5].itertuples():
        response = results.responses[row.Index]
        motion = rb.pulse(
            "sine", name=row.record, amplitude=(0.5 if row.record == "weak" else 1.0) * 9.81, period=0.5, dt=0.01,
            duration=1.0,
        )  # fmt: skip
        if row.polarity == "-":
            motion = replace(motion, horizontal=-motion.horizontal)
        again = rb.simulate(
            response.pier, response.base, motion, substeps=int(row.substeps), case=row.case, ledger=True, forces=True
        )
        columns = {"alpha": row.alpha} | ({"spring": row.spring} if row.case == "pads" else {})
        assert same(response, replace(again, columns=columns, polarity=row.polarity))


def test_the_greatest_rotation_of_a_history_is_that_of_its_row(results):
    """The peak lies between samples: 1e-3 is what a parabola through samples 0.01 s apart misses, at most."""
    for row in results.peaks[1::5].itertuples():
        response = results.responses[row.Index]
        found = np.abs(response.theta).max() / response.pier.alpha
        assert found == pytest.approx(row.theta_max_over_alpha, rel=1e-3)


def test_peaks_come_back_with_the_types_and_ten_digits_of_the_run(results):
    ran = rb.run(results.directory / "study.toml")
    pd.testing.assert_frame_equal(results.peaks, ran, rtol=1e-9, atol=0)


def test_a_response_without_ledger_or_events_comes_back_too(tmp_path):
    resting = at_rest()
    assert resting.events.empty
    assert resting.ledger is None
    assert same(stored(tmp_path, resting)[0], resting)


# What an event leaves in the history


def test_an_event_points_to_the_rows_on_both_sides_of_its_jump():
    pulse = rb.pulse("sine", name="one-sine", amplitude=9.81, period=0.5, dt=0.01, duration=3.0)
    response = rb.simulate(PIER, rb.RigidBase(restitution=0.8), pulse)
    impacts = response.events[response.events["kind"] == "impact"]
    assert len(impacts) > 3
    before, after = (response.history.iloc[impacts[side]] for side in ("before", "after"))
    assert (before["t"].to_numpy() == impacts["t"].to_numpy()).all()
    assert after["omega"].to_numpy() == pytest.approx(0.8 * before["omega"].to_numpy(), rel=1e-15)
    lift_offs = response.events[response.events["kind"] == "lift-off"]
    assert (lift_offs["before"] == lift_offs["after"]).all()
    assert (response.t[lift_offs["after"]] == lift_offs["t"]).all()


def test_spring_forces_carry_the_weight_at_rest_and_eta_times_half_of_it_at_yield(results):
    response = results.response("strong", "pads", polarity="+", alpha=0.2, spring="epp")
    forces = response.history[["force_left", "force_right"]]
    gravity = response.pier.gravity
    assert forces.iloc[0].sum() == pytest.approx(-gravity, rel=1e-14)
    assert forces.min().min() == pytest.approx(-2.5 * gravity / 2, rel=1e-14)
    for side, z in (("left", response.z_left), ("right", response.z_right)):
        assert forces[f"force_{side}"].to_numpy() == pytest.approx(2.5 * gravity / 2 * z, rel=1e-14)


def test_the_history_of_an_overturned_pier_ends_where_it_fell(tmp_path):
    """On its side, at π/2; not at the sample before."""
    strong = rb.pulse("sine", name="strong", amplitude=3 * 9.81, period=2.0, dt=0.05, duration=10.0)
    outcome = run_to_tolerance(PIER, rb.RigidBase(), strong, 1e-4)
    recording = recorded(Run(PIER, rb.RigidBase(), strong), outcome, 2.0, every_step=False)
    response = histories(recording, outcome.status, "rigid", {})
    assert response.status == "overturned"
    assert response.t[-1] == outcome.t_end
    assert abs(response.theta[-2]) < outcome.theta_max <= abs(response.theta[-1])
    assert same(stored(tmp_path, response)[0], response)


def test_flight_is_the_last_event_of_a_run_that_it_ends(tmp_path):
    """The ground drops away at 2 g: the springs relax, and both pivots leave them."""
    down = np.full(200, -2 * 9.81)
    motion = rb.Motion("drop", 0.01, np.zeros(200), vertical=down)
    for base in (rb.ElasticBase(beta=50, flight="stop"), rb.YieldingBase(beta=50, flight="stop", eta=2.5)):
        response = rb.simulate(PIER, base, motion, quiet_s=0.0)
        last = response.events.iloc[-1]
        assert (response.status, last["kind"]) == ("flight", "flight")
        assert last["after"] == len(response.t) - 1
        assert last["t"] == response.t[-1]
        assert same(stored(tmp_path, response)[0], response)


def test_rigid_ground_of_an_earlier_version_ended_runs_at_their_flight(tmp_path):
    responses = stored(tmp_path, at_rest())
    assert responses[0].base == rb.RigidBase()
    with altered(tmp_path / "histories.h5") as file:
        for name in ("flight", "flight_limit_mm"):
            del file["runs/000000/base"].attrs[name]
    assert responses[0].base == rb.RigidBase(flight="stop")


def test_forces_of_an_earlier_version_have_no_base_moment(tmp_path, results):
    response = results.responses[0]
    responses = stored(tmp_path, response)
    with altered(tmp_path / "histories.h5") as file:
        del file["runs/000000/forces/base_moment"]
    pd.testing.assert_frame_equal(responses[0].forces, response.forces.drop(columns="base_moment"))


def test_numbers_of_half_their_size_come_back_in_the_types_of_a_response(tmp_path, results):
    response = results.responses[0]
    responses = stored(tmp_path, response)
    with altered(tmp_path / "histories.h5") as file:
        group = file["runs/000000"]
        for name, kind in {"theta": "f4", "events/t": "f4", "events/after": "i4"}.items():
            values = group[name][:].astype(kind)
            del group[name]
            group[name] = values
    read = responses[0]
    pd.testing.assert_series_equal(read.events.dtypes, response.events.dtypes)
    pd.testing.assert_series_equal(read.history.dtypes, response.history.dtypes)
    np.testing.assert_array_equal(read.theta, response.theta.astype(np.float32))


# The file, as others read it


@pytest.mark.slow
def test_every_number_has_a_unit_and_a_length_that_fits(results):
    """Units are those that pint reads; all columns of a run have as many rows as its time, or as it has impacts."""
    registry = pint.UnitRegistry()
    seen = set()
    with h5py.File(results.directory / "histories.h5") as file:

        def look(name, item):
            if isinstance(item, h5py.Dataset) and item.dtype.kind != "S":
                seen.add(item.attrs["unit"])
                own = name.split("/")[2]
                if own != "events":
                    of = f"{'/'.join(name.split('/')[:2])}/{'impacts/t' if own == 'impacts' else 't'}"
                    assert item.shape == file[of].shape

        file.visititems(look)
    assert {str(registry(unit).units) if unit != "1" else unit for unit in seen} == {
        "second", "radian", "radian / second", "meter", "newton / kilogram", "joule / kilogram", "meter / second ** 2",
        "meter / second", "meter ** 2 / second ** 2", "1",
    }  # fmt: skip


def test_the_file_says_what_it_is_and_what_made_it(results):
    with h5py.File(results.directory / "histories.h5") as file:
        assert file.attrs["format"] == FORMAT
        assert file.attrs["title"] == "Two pulses, three bases"
        assert file.attrs["study"] == STUDY
        assert file.attrs["sha256"] == results.info["study"]["sha256"]
        assert file.attrs["rockbatch"] == "0.1.0"
        assert file["versions"].attrs["numpy"] == "2.3.1"
        run = file["runs/000000"]
        assert (run.attrs["record"], run.attrs["case"], run.attrs["polarity"]) == ("weak", "rigid", "+")
        assert run["pier"].attrs["alpha"] == 0.2
        assert set(run) == {
            *("base", "events", "forces", "impacts", "ledger", "pier", "varied"),
            *("t", "theta", "omega", "energy", "ag_h", "ag_v"),
        }  # fmt: skip
        assert set(file["runs/000001"]) >= set(HISTORY_UNITS) - {"deflection"}
        assert set(run["ledger"]) == set(TERMS)


@pytest.mark.parametrize("name", ["a/b", "..", ".", "/", "Erdbeben in Düzce ⟂ 地震", "x" * 100_000, " ", "000000"])
def test_a_record_may_have_any_name(tmp_path, name):
    responses = stored(tmp_path, at_rest(name, case=name), at_rest(name, case="b"))
    assert [response.record for response in responses] == [name, name]
    assert responses.runs["case"].tolist() == [name, "b"]


def test_what_hdf5_cannot_hold_of_a_name_is_written_as_an_escape(tmp_path):
    """A file's name that is not Unicode comes with lone surrogates, and TOML allows NUL in the name of a case."""
    response = replace(at_rest(), record="b\udcffc", case="a\0b")
    assert [getattr(stored(tmp_path, response)[0], name) for name in ("record", "case")] == [r"b\udcffc", r"a\x00b"]


# Whole or not at all


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError])
def test_an_error_on_the_way_leaves_the_earlier_file_and_nothing_else(tmp_path, error):
    stored(tmp_path, at_rest())
    earlier = (tmp_path / "histories.h5").read_bytes()

    def broken():
        yield at_rest()
        raise error

    with pytest.raises(error):
        write(tmp_path / "histories.h5", broken(), INFO)
    assert [file.name for file in tmp_path.iterdir()] == ["histories.h5"]
    assert (tmp_path / "histories.h5").read_bytes() == earlier


@pytest.mark.parametrize("free", [3e6, histories_file.MARGIN + 1])  # the second leaves no room for the table
def test_a_full_disk_is_reported_before_it_is_written_to(tmp_path, monkeypatch, free):
    """HDF5 itself would print a page of errors and may crash at exit."""
    stored(tmp_path, at_rest())
    earlier = (tmp_path / "histories.h5").read_bytes()
    monkeypatch.setattr(histories_file, "disk_usage", lambda folder: SimpleNamespace(free=free))
    with pytest.raises(rb.InputError, match=f"the disk is full, {free / 1e6:.0f} MB are left; make room"):
        stored(tmp_path, at_rest())
    assert [file.name for file in tmp_path.iterdir()] == ["histories.h5"]
    assert (tmp_path / "histories.h5").read_bytes() == earlier


@pytest.mark.skipif(not hasattr(os, "posix_fallocate"), reason="no file can be given room here before it is written to")
@pytest.mark.parametrize("fits", [0, 1])
def test_a_limit_on_the_size_of_files_is_met_before_histories_are_written_to(tmp_path, monkeypatch, fits):
    """As a quota is, which the free space of the disk does not tell; here before the first, and behind it."""
    import resource

    stored(tmp_path, at_rest())
    earlier = (tmp_path / "histories.h5").read_bytes()
    monkeypatch.setattr(histories_file, "MARGIN", len(earlier) // 2)
    before, taken = resource.getrlimit(resource.RLIMIT_FSIZE), []

    def responses():
        for _ in range(4):
            taken.append(at_rest())
            yield taken[-1]

    resource.setrlimit(resource.RLIMIT_FSIZE, (len(earlier) // 3 + 2 * fits * len(earlier), before[1]))
    try:
        with pytest.raises(
            rb.InputError, match=r"histories\.h5: cannot be written: File too large; what was finished before"
        ):
            write(tmp_path / "histories.h5", responses(), INFO)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert (len(taken) > 1) == bool(fits)
    assert [file.name for file in tmp_path.iterdir()] == ["histories.h5"]
    assert (tmp_path / "histories.h5").read_bytes() == earlier
    write(tmp_path / "histories.h5", responses(), INFO)
    assert len(Responses(tmp_path / "histories.h5", INFO)) == 4


@pytest.mark.skipif(not hasattr(os, "posix_fallocate"), reason="no file can be given room here before it is written to")
def test_room_is_tried_again_only_once_half_of_the_margin_is_used(tmp_path, monkeypatch):
    """A file system without such a call is written to instead, which took 10 MB for each history."""
    tried, give_room = [], os.posix_fallocate

    def counted(handle, size, needed):
        tried.append((size, size + needed))
        give_room(handle, size, needed)

    monkeypatch.setattr(os, "posix_fallocate", counted)
    monkeypatch.setattr(histories_file, "MARGIN", 60_000)
    stored(tmp_path, *[at_rest()] * 12)
    assert 2 < len(tried) < 8
    assert all(start < end for (_, end), (start, _) in pairwise(tried))  # never beyond the room that was tried


# Which runs are kept


def row(status, theta_max=0.5, t_end=10.0):
    return {"status": status, "theta_max_over_alpha": theta_max, "t_end_s": t_end}


def worst_of(*rows_of_cases):
    """The worst, as (record, case), of rows that are given case by case, put in the order of a study."""
    cases = len(rows_of_cases)
    table = pd.DataFrame([rows[i] for i in range(len(rows_of_cases[0])) for rows in rows_of_cases])
    return [divmod(number, cases) for number in worst(table, cases)]


def test_the_worst_of_a_case_is_its_greatest_rotation_of_any_status():
    rotations = [row("ok", 0.1), row("flight", 0.3), row("ok", 0.2)]
    assert worst_of(rotations, rotations[::-1], [rotations[0]] * 3) == [(1, 0), (1, 1), (0, 2)]


def test_overturning_is_worse_than_any_rotation_and_the_earlier_the_worse():
    late, early = row("overturned", 1.6, t_end=8.0), row("overturned", 1.5, t_end=3.0)
    assert worst_of([row("ok", 2.0), late, early]) == [(2, 0)]
    assert worst_of([early, late, row("flight", 2.0, t_end=1.0)]) == [(0, 0)]


def test_a_failed_run_is_never_the_worst_and_a_case_that_only_failed_has_none():
    failed, refused = row("failed", 9.0), row("failed", np.nan)
    assert worst_of([failed, row("ok", 0.1)], [failed, refused]) == [(1, 0)]


@pytest.mark.slow
def test_worst_is_what_a_study_keeps_that_does_not_say(tmp_path):
    text = STUDY.replace('histories = "all"\n', "").replace("ledger = true\n", "")
    text = text.replace('[motions]\npolarity = ["+", "-"]\n', "[motions]\nscale = 0.9\n")
    saved, study, runs = carried_out(tmp_path, text)
    keep_histories(saved, study, runs)
    results = rb.open_results(tmp_path)
    assert [(response.case, response.columns) for response in results.responses] == [
        (case.name, case.columns) for case in study.cases
    ]
    for response in results.responses:
        rows = results.peaks[(results.peaks["case"] == response.case) & (results.peaks["alpha"] == response.pier.alpha)]
        greatest = rows[rows["spring"].fillna("") == response.columns.get("spring", "")]["theta_max_over_alpha"].max()
        assert np.abs(response.theta).max() / response.pier.alpha == pytest.approx(greatest, rel=1e-3)
        assert response.scale == 0.9
        assert response.ledger is None


def test_the_worst_runs_go_first_where_not_all_fit(tmp_path):
    saved, study, runs = carried_out(tmp_path, STUDY.replace('histories = "all"\nledger = true\n', ""))
    every = to_keep(study, runs, saved.peaks)
    sizes = {number: history_bytes(runs[number], saved.peaks.iloc[number]) for number in every.numbers}
    rotations = saved.peaks["theta_max_over_alpha"]
    by_rotation = sorted(every.numbers, key=lambda number: -rotations[number])
    room = sum(sizes[number] for number in by_rotation[:3]) + 1.0
    chosen = to_keep(replace(study, output=replace(study.output, histories_MB=room / 1e6)), runs, saved.peaks)
    assert len(every.numbers) > 4
    assert every.left_out == 0
    assert sorted(chosen.numbers) == sorted(by_rotation[:3])
    assert chosen.left_out == len(every.numbers) - 3
    least = to_keep(replace(study, output=replace(study.output, histories_MB=1e-9)), runs, saved.peaks)
    assert least.numbers == by_rotation[:1]  # a report without any would show no history at all


TIED = RIGID | {"damper": [{"kind": "friction", "f": 0.05}], "tendon": {"psi": 0.1, "lambda": 0.5}}


@pytest.mark.parametrize("text", [FEW, study_text(cases=[TIED], output={"histories": "all"})], ids=["springs", "tied"])
def test_the_size_of_histories_is_announced_beforehand(tmp_path, text):
    """Of dampers and tendons the loops, too."""
    saved, study, runs = carried_out(tmp_path, text)
    told = sum(
        history_bytes(runs[number], saved.peaks.iloc[number]) for number in to_keep(study, runs, saved.peaks).numbers
    )
    path = keep_histories(saved, study, runs)
    assert path is not None
    size = (
        path.stat().st_size
    )  # Bouc–Wen springs are taken to change their branch with every half wave, which is the most
    assert 0.97 * size < told < 1.3 * size


def test_runs_that_were_refused_have_no_history(tmp_path):
    saved, study, runs = carried_out(tmp_path, FEW)
    saved.peaks.loc[1, ["status", "theta_max_over_alpha"]] = ["failed", np.nan]
    assert to_keep(study, runs, saved.peaks).numbers == [0, *range(2, len(saved.peaks))]


def test_a_history_too_long_for_memory_is_reported_and_the_others_are_there(tmp_path, monkeypatch):
    saved, study, runs = carried_out(tmp_path, FEW)
    saved.peaks.loc[1, "substeps"] = 1_000  # of its ledger, a hundred thousand rows and more
    monkeypatch.setattr("rockbatch.simulation.recording.MOST_ROWS", 100_000)
    with pytest.raises(rb.InputError, match=r"one-sine: a history of \d+ rows, more than 100000;") as error:
        keep_histories(saved, study, runs)
    assert len(error.value.messages) == 1
    assert len(rb.open_results(tmp_path).responses) == len(runs) - 1


def test_progress_advances_with_every_run_that_is_kept(tmp_path):
    saved, study, runs = carried_out(tmp_path, FEW)
    calls = []
    keep_histories(saved, study, runs, calls.append)
    assert len(calls) == len(to_keep(study, runs, saved.peaks).numbers) == 3


# Choosing one


def test_a_response_is_found_by_whatever_distinguishes_it_from_the_others(results):
    response = results.response("strong", "pads", polarity="-", alpha=0.25, spring="epp")
    assert (response.record, response.case, response.polarity) == ("strong", "pads", "-")
    assert response.base == rb.YieldingBase(beta=50.0, eta=2.5, epsilon=0.1, spring="epp")
    assert response.pier.alpha == 0.25
    row = {"record": "strong", "case": "rigid", "polarity": "+", "alpha": 0.2}
    assert results.history(**row).equals(results.response(**row).history)
    assert results.events(**row).equals(results.response(**row).events)
    assert len(results.events(**row)) > 0


@pytest.mark.parametrize(
    ("choice", "told"),
    [
        ({"record": "strng"}, r'no history with record = "strng"; did you mean "strong"\?'),
        ({"record": "Kobe"}, r'no history with record = "Kobe"; there are "weak"; "strong"'),
        ({"case": "rigid", "spring": "epp"}, 'no history with spring = "epp"; it applies to none'),
        ({"record": "weak", "case": "rigid", "alpha": 0.3}, r"no history with alpha = 0\.3; there are 0\.2; 0\.25"),
        (
            {"polarity": "+", "beta": 50},
            "beta: not a key of runs; choose by record, case, polarity, scale, alpha, spring",
        ),
        (
            {"record": "weak", "case": "rigid", "alpha": 0.2},
            r'2 histories fit; choose one: polarity = "\+"; polarity = "-"$',
        ),
        ({"record": "weak", "case": "rigid"}, r'4 histories fit; choose one: polarity = "\+", alpha = 0\.2; polarity'),
        ({}, "32 histories fit; .*; and 24 more$"),
    ],
)
def test_a_choice_that_fits_none_or_several_is_reported_with_those_that_there_are(results, choice, told):
    with pytest.raises(rb.InputError, match=told):
        results.response(**choice)


def test_responses_are_a_sequence_that_is_read_one_by_one(results):
    responses = results.responses
    assert same(responses[-1], responses[len(responses) - 1])
    assert [response.case for response in responses[:2]] == ["rigid", "elastic"]
    with pytest.raises(IndexError):
        responses[len(responses)]
    assert list(responses.runs.columns) == ["record", "case", "polarity", "scale", "status", "alpha", "spring"]
    assert responses.runs["status"].tolist() == results.peaks["status"].tolist()


# What is not there, or not ours


def test_without_histories_it_says_how_to_get_them(tmp_path):
    assert keep_histories(*carried_out(tmp_path, STUDY.replace('histories = "all"', 'histories = "none"'))) is None
    results = rb.open_results(tmp_path)
    assert len(results.responses) == 0
    with pytest.raises(rb.InputError, match="no histories; add \\[output\\] histories"):
        results.history("weak", "rigid")


def test_a_name_may_be_begun_where_one_alone_begins_so(results):
    row = {"case": "pads", "polarity": "-", "alpha": 0.25, "spring": "epp"}
    assert results.response("stro", **row).record == "strong"
    assert results.response("strong", **row | {"case": "pa"}).case == "pads"
    with pytest.raises(rb.InputError):
        results.response("trong", **row)
    with pytest.raises(rb.InputError):
        results.response("", **row)


def test_a_folder_without_results_is_refused():
    with pytest.raises(rb.InputError, match="nowhere: not there"):
        rb.open_results("nowhere")


@pytest.mark.parametrize("analysed", [True, False])
def test_a_folder_of_an_analysis_alone_is_refused_in_a_line_that_names_its_page(tmp_path, analysed):
    if analysed:
        (tmp_path / "analyses.html").write_text("")
    with pytest.raises(rb.InputError) as error:
        rb.report(tmp_path)
    assert len(error.value.problems) == 1
    assert ("analyses.html" in str(error.value)) is analysed
    (tmp_path / "peaks.csv").write_text("")
    with pytest.raises(rb.InputError, match=r"run\.json: not there"):
        rb.open_results(tmp_path)


def damaged(folder, change):
    """What is said about a file after ``change``."""
    stored(folder, at_rest())
    change(folder / "histories.h5")
    with pytest.raises(rb.InputError) as error:
        Responses(folder / "histories.h5", INFO)[0]
    (problem,) = error.value.messages
    assert problem.startswith(f"{folder / 'histories.h5'}: ")
    return problem


def edited(change):
    def edit(path):
        with altered(path) as file:
            change(file)

    return edit


def test_a_truncated_file_is_refused(tmp_path):
    assert "damaged" in damaged(tmp_path, lambda path: path.write_bytes(path.read_bytes()[:-1000]))


def test_a_file_that_is_no_hdf5_is_refused(tmp_path):
    assert "damaged" in damaged(tmp_path, lambda path: path.write_text("peaks"))


def test_a_file_of_which_one_byte_is_another_is_refused_wherever_it_is(tmp_path):
    """Beyond its first block; of many, HDF5 itself dies without a word."""
    responses = stored(tmp_path, at_rest())
    path = tmp_path / "histories.h5"
    whole = path.read_bytes()
    for place in range(512, len(whole), 97):
        changed = bytearray(whole)
        changed[place] ^= 0x5A
        path.write_bytes(changed)
        with pytest.raises(rb.InputError, match="damaged"):
            Responses(path, INFO)[0]
    path.write_bytes(whole)
    assert len(responses) == 1


@pytest.mark.parametrize("place", range(512 + 48, 512 + 56))
def test_a_file_whose_list_lies_beyond_all_files_is_refused(tmp_path, place):
    """Addresses of the first block of HDF5, of which one byte is another: to h5py it lies where no file reaches."""

    def lead_astray(path):
        data = bytearray(path.read_bytes())
        data[place] = 0xF1
        path.write_bytes(data)
        seal(path)

    assert "damaged" in damaged(tmp_path, lead_astray)


def test_hdf5_of_another_kind_is_refused(tmp_path):
    assert "not the histories" in damaged(tmp_path, edited(lambda file: file.attrs.__delitem__("format")))


@pytest.mark.parametrize("name", ["theta", "events/kind", "pier", "base", "varied"])
def test_a_file_in_which_something_is_missing_is_refused(tmp_path, name):
    assert "damaged" in damaged(tmp_path, edited(lambda file: file["runs/000000"].__delitem__(name)))


def test_columns_of_unlike_length_are_refused(tmp_path):
    def shorten(file):
        run = file["runs/000000"]
        theta = run["theta"][:-1]
        del run["theta"]
        run["theta"] = theta

    assert "damaged" in damaged(tmp_path, edited(shorten))


@pytest.mark.parametrize("mark", ["created", "sha256"])
def test_histories_of_another_run_are_refused(tmp_path, mark):
    assert "by another run than run.json" in damaged(
        tmp_path, edited(lambda file: file.attrs.__setitem__(mark, "other"))
    )


# What it costs those who do not ask


def test_a_study_that_asks_for_no_histories_never_uses_hdf5(tmp_path, monkeypatch):
    monkeypatch.setattr(histories_file, "h5py", None)
    study = rb.load_study(write_study(tmp_path, study_text(cases=(RIGID,), output={"histories": "none"})))
    rb.run(study, out=tmp_path / "out")
    assert len(rb.open_results(tmp_path / "out").responses) == 0


@pytest.mark.slow
def test_histories_are_read_without_the_compiler(results):
    code = f"import sys, rockbatch as rb; rb.open_results({str(results.directory)!r}).responses[0]"
    code += "; print(*(name for name in ('numba', 'h5py') if name in sys.modules))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split() == [
        "h5py"
    ]


def test_what_yielding_springs_write_is_expected_to_grow_with_time_and_frequency():
    """Each changes its branch twice a period, on top of the samples and of the impacts."""
    pier, record = rb.Pier(0.2, 1.0), SimpleNamespace(dt=0.01)

    def expected(base, seconds=20.0):
        run = SimpleNamespace(case=SimpleNamespace(pier=pier, base=base), record=record)
        return history_bytes(run, {"impacts": 9, "separations": 9, "t_end_s": seconds})

    soft, stiff, stiffest = (rb.YieldingBase(beta, eta=3.0) for beta in (50.0, 100.0, 200.0))
    more = expected(stiff) - expected(soft)
    assert expected(stiffest) - expected(stiff) == pytest.approx(2.0 * more, rel=1e-9)
    assert expected(stiff, 40.0) - expected(soft, 40.0) == pytest.approx(2.0 * more, rel=1e-9)
    assert more > 0.0
    assert expected(rb.ElasticBase(50.0)) == expected(rb.ElasticBase(200.0)) < expected(soft)


@pytest.mark.parametrize("commit", ["1f2e3d4c5b6a", ""])
def test_the_versions_have_the_commit_of_a_checkout_alone(monkeypatch, commit):
    monkeypatch.setattr(run_json, "commit", lambda: commit)
    assert run_json.versions().get("commit", "none") == (commit or "none")
