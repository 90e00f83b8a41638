"""A record of a suite is a station: what passes with two components of four stations is no seven records."""

import csv
import math
import statistics
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from check_samples import RECORD, case, folder, runs
from studies import PADS, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.checks import Rule, judge, read_verdicts
from rockbatch.checks.events import OfEvent
from rockbatch.checks.rule_files import load_rules
from rockbatch.checks.suite import Suite
from rockbatch.checks.suite_target import suite_of
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError, MissingColumns
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.results.checking import verdicts
from rockbatch.results.run_json import describe
from rockbatch.study.suite import ground_motions

INF = math.inf


def pairs(*stations, **cells):
    """Runs of stations A, B …, each with the θ_max/α of its components A1, A2 …"""
    names = "ABCDEFGHIJKLM"[: len(stations)]
    table = runs([theta for station in stations for theta in station], **cells)
    table["station"] = [name for name, station in zip(names, stations, strict=True) for _ in station]
    table["record"] = [
        f"{name}{i}" for name, station in zip(names, stations, strict=True) for i in range(1, len(station) + 1)
    ]
    return table


def judged(table, *, records=None, count="station", at_most=0.5, demand="theta_max_over_alpha", **asked):
    (verdict,) = judge([Rule("check", demand, at_most, **asked)], table, [case()], Suite(records or {}), count)
    return verdict


FOUR = ((0.1, 0.2), (0.3, 0.1), (0.2, 0.9), (0.1, 0.1))
"""Components of four stations: the mean of the eight is 0.25, that of the worse ones 0.375, the greatest 0.9."""
SEVEN = tuple((0.1 * i, 0.05 * i) for i in range(1, 8))


@pytest.mark.parametrize("statistic", ["en1998-1", "en1998-2", "aashto", "nzs1170.5"])
def test_eight_components_of_four_stations_are_no_seven_records(statistic):
    found = judged(pairs(*FOUR), statistic=statistic)
    assert (found.records, found.count, found.value, found.verdict) == (4, "station", 0.9, "fail")
    assert (
        judged(pairs(*FOUR), statistic=statistic, count="component") == found
    )  # of a study whose other checks count so


@pytest.mark.parametrize("statistic", [name for name, kind in STATISTICS.items() if kind.code])
def test_a_code_asks_for_motions_of_stations_and_its_count_of_components_is_refused(tmp_path, statistic):
    told = f'count = "component": {STATISTICS[statistic].code} asks for {STATISTICS[statistic].least} motions'
    with pytest.raises(InputError, match=f'{told}.* write count = "station" in this check, or a statistic of no code'):
        Rule("check", "theta_max_over_alpha", 0.5, statistic=statistic, count="component")
    text = COMPONENT + CHECK.replace("mean", statistic)
    with pytest.raises(InputError, match=told):
        rb.load_study(write_study(tmp_path, study_text() + "\n" + text))
    (tmp_path / "rules.toml").write_text(text + 'count = "station"\n')
    assert load_rules(tmp_path / "rules.toml")[0].count == "station"


def test_components_that_may_be_of_one_station_meet_no_code():
    found = judged(pairs(*SEVEN).assign(station=""), statistic="en1998-1", at_most=1.0)
    assert (found.records, found.count, found.verdict) == (14, "component", "not decided")
    assert found.note.startswith("EN 1998-1 counts stations; ")
    assert "these results do not say" in found.note
    assert judged(pairs(*SEVEN).assign(station=""), statistic="mean", at_most=1.0).verdict == "pass"


@pytest.mark.parametrize("statistic", ["p84", "p84_95", "p84_lognormal"])
def test_many_directions_of_few_stations_are_too_few_records_for_a_quantile(statistic):
    least = STATISTICS[statistic].least
    few, enough = ([(0.1, 0.11, 0.12, 0.13)] * n for n in (least - 1, least))
    few, enough = (
        judged(table_of(stations), statistic=statistic, count="component", at_most=1.0) for stations in (few, enough)
    )
    assert (few.records, few.verdict, enough.verdict) == (4 * (least - 1), "not decided", "pass")
    told = f"{4 * (least - 1)} components of {least - 1} stations count, the {STATISTICS[statistic].words} asks for {least} "
    assert few.note.startswith(f"{told}stations")
    table = table_of([(0.1,) * 24])
    table.loc[0, "station"] = ""
    found = judged(table, statistic=statistic, count="component", at_most=1.0)
    assert (found.verdict, found.note.partition(" count,")[0]) == ("not decided", "24 components of 2 stations")


def table_of(stations):
    """Runs of stations S0, S1 …, each with the θ_max/α of its components."""
    rows = [(f"S{i}", f"S{i}.{j}", theta) for i, station in enumerate(stations) for j, theta in enumerate(station)]
    names, records, thetas = zip(*rows, strict=True)
    return runs(thetas, record=names).assign(station=names, record=records)


def test_pulses_are_no_records_that_a_code_takes():
    table = pairs(*SEVEN)
    for pulses, told in ((("B1", "B2"), "1 of 7 stations are pulses, and EN 1998-2 asks for records"), ((), "")):
        rule = Rule("c", "theta_max_over_alpha", 1.0, statistic="en1998-2")
        (found,) = judge([rule], table, [case()], Suite(unrecorded=pulses))
        assert found.verdict == ("not decided" if pulses else "pass")
        assert found.note.startswith(told)
        (plain,) = judge([replace(rule, statistic="mean")], table, [case()], Suite(unrecorded=pulses))
        assert plain.verdict == "pass"


@pytest.mark.parametrize(("pulses", "blamed"), [((), True), (("P",), False)])
def test_a_pulse_beside_records_of_two_directions_lacks_none(pulses, blamed):
    table = runs([0.1, 0.2, 0.1, 0.2, 0.1], station=["A", "A", "B", "B", "P"], record=["A1", "A2", "B1", "B2", "P"])
    (found,) = judge([Rule("c", "theta_max_over_alpha", 1.0)], table, [case()], Suite(unrecorded=pulses))
    assert ("P (1 of 2)" in found.note) is blamed


def test_a_study_of_pulses_meets_no_code_in_its_folder_and_as_a_table(tmp_path):
    pulses = [SINE | {"name": f"p{i}", "amplitude_g": 0.1 + 0.01 * i, "duration_s": 1.0} for i in range(7)]
    check = {"name": "c", "demand": "theta_max_over_alpha", "statistic": "en1998-1", "at_most": 0.9, "reason": "r"}
    study = rb.load_study(write_study(tmp_path, study_text(pulses=pulses, cases=({"base": "rigid"},), check=[check])))
    table = rb.run(study, out=tmp_path / "out")
    for results, more in ((tmp_path / "out", {}), (table, {"study": study})):
        (row,) = rb.check(results, **more).to_dict("records")
        assert row["verdict"] == "not decided"
        assert row["note"].startswith("7 of 7 stations are pulses")


@pytest.mark.parametrize(("code", "omits"), [("EN 1998-2", ()), ("EN 1998-1", ("target",)), ("", ("target",))])
def test_a_code_whose_target_judges_no_motion_says_so(code, omits):
    rule = Rule("c", "theta_max_over_alpha", 1.0, statistic="en1998-2")
    (found,) = judge([rule], pairs(*SEVEN, theta_max_error=0.0), [case()], Suite(code=code))
    assert (found.omits, found.verdict) == (omits, "pass")
    assert ("the motions are not judged by a target spectrum of its code" in found.note) == bool(omits)
    (plain,) = judge([replace(rule, statistic="mean")], pairs(*SEVEN, theta_max_error=0.0), [case()], Suite(code=code))
    assert (plain.omits, plain.note) == ((), "")


@pytest.mark.parametrize("of_one_event", [1, 2, 7])
def test_two_stations_of_one_event_are_not_independent(of_one_event):
    """Neither are more; every station of an event of its own is."""
    named = ["x"] * of_one_event + [*"abcdefg"[of_one_event:]]
    events = {f"{station}{i}": event for station, event in zip("ABCDEFG", named, strict=True) for i in (1, 2)}
    rule = Rule("c", "theta_max_over_alpha", 1.0, statistic="en1998-2")
    (found,) = judge([rule], pairs(*SEVEN), [case()], Suite(events=events))
    assert ("events" in found.omits) is (of_one_event > 1)


def test_records_of_one_event_say_so_and_are_as_many_as_the_check_allows():
    """Stations A, B and C of one event, D of another, and of the others it is not known."""
    table = pairs(*SEVEN)
    events = {
        f"{station}{i}": event for station, event in zip("ABCD", ["x 1999"] * 3 + ["y"], strict=True) for i in (1, 2)
    }
    told = "3 of 7 stations are of one event, x 1999; of 3 of 7 stations the event is not known"

    def of(**asked):
        (found,) = judge([Rule("c", "theta_max_over_alpha", 1.0, **asked)], table, [case()], Suite(events=events))
        return found

    assert of(statistic="mean").note == "no error estimate"  # no code's
    assert (of(statistic="en1998-2").verdict, told in of(statistic="en1998-2").note) == ("pass", True)
    assert "events" in of(statistic="en1998-2").omits
    assert of(statistic="en1998-2", per_event=6).verdict == "pass"
    assert "events" not in of(statistic="en1998-2", per_event=6).omits  # the check says how many may be
    few = of(statistic="en1998-2", per_event=5)  # those of no known event may be of the same one
    assert few.verdict == "not decided"
    assert few.note.startswith("the check allows 5 of one event, and of 3 it is not known")
    events |= {f"{station}{i}": "z" for station in "EFG" for i in (1, 2)}
    assert of(statistic="en1998-2", per_event=3).verdict == "pass"
    assert of(statistic="en1998-2", per_event=2).note.startswith("the check allows 2 of one event; ")
    events.clear()
    assert of(statistic="en1998-2", per_event=6).note.startswith(
        "the check allows 6 of one event, and of 7 it is not known"
    )
    assert of(statistic="en1998-2", per_event=7).verdict == "pass"
    with pytest.raises(InputError, match="per_event: is for a code's statistic; leave it out"):
        of(per_event=2)


def test_a_suite_says_how_many_records_of_one_event_its_codes_may_have(tmp_path):
    code = CHECK.replace("mean", "en1998-2")
    suite = "[suite]\nper_event = 2\n" + code + CHECK.replace("peak", "other")
    records = [RECORD | {"record": f"{s}{i}", "station": s, "event": "x 1999"} for s in "ABCD" for i in (1, 2)]
    out = folder(tmp_path / "out", pairs(*FOUR), [case()], suite.replace("0.5", "1.0"), records=records)
    assert [(one.verdict, "4 of 4 stations are of one event" in one.note) for one in verdicts(out)] == [
        ("not decided", True),
        ("pass", False),
    ]


@pytest.mark.parametrize(
    ("statistic", "value"),
    [("en1998-1", 0.4), ("en1998-2", 0.4), ("aashto", 0.4), ("nzs1170.5", 0.7), ("mean", 0.4), ("median", 0.4)],
)
def test_of_seven_stations_the_worse_components_count(statistic, value):
    found = judged(pairs(*SEVEN), statistic=statistic, at_most=1.0)
    assert (found.records, found.runs, found.value) == (7, 14, pytest.approx(value))
    assert "most unfavourable" not in found.note


@pytest.mark.parametrize("statistic", ["en1998-1", "en1998-2", "aashto", "nzs1170.5"])
def test_two_stations_decide_nothing_however_many_components_they_have(statistic):
    found = judged(pairs((0.1,) * 6, (0.2,) * 6), statistic=statistic)
    assert found.verdict == "not decided"
    assert "2 stations count, " in found.note
    assert " asks for 3" in found.note


def test_a_count_is_of_stations():
    found = judged(pairs((0.6, 0.7), (0.6, 0.1), (0.1, 0.2)), statistic="count", above=0.5, at_most=2)
    assert (found.value, found.verdict, found.unit) == (2, "pass", "")


def test_both_components_of_one_station_are_one_unacceptable_response_under_asce7():
    stations = [(0.1, 0.1)] * 11
    status = ["overturned", "overturned", *["ok"] * 20]
    found = judged(pairs(*stations, status=status), statistic="asce7-16")
    assert (found.records, found.value, found.verdict) == (11, pytest.approx(0.12), "pass")


# What goes wrong in one direction


def test_a_component_that_failed_leaves_its_station_unknown():
    """The other one stood, but is not known to be the worse."""
    table = pairs(*FOUR, status=["failed", *["ok"] * 7])
    found = judged(table, statistic="max", at_most=1.0)
    assert (found.verdict, found.records, found.high) == ("not decided", 4, INF)
    assert (found.station, found.record) == ("A", "A1")


def test_a_component_that_is_left_out_is_reported_with_its_station():
    """It still counts, by the direction that is left: nobody shall take that for the worse one."""
    table = pairs(*FOUR, status=["ok", "ok", "ok", "ok", "ok", "failed", "ok", "ok"])
    found = judged(table, statistic="max", failed="left out")
    assert (found.verdict, found.value, found.records) == ("not decided", 0.3, 4)
    assert "not every direction counts, and the worst may be another: C (1 of 2)" in found.note


def test_a_station_of_which_one_component_could_not_be_read_is_reported():
    found = judged(pairs((0.1, 0.2), (0.3,), (0.2, 0.1)), statistic="en1998-2")
    assert (found.verdict, found.records) == ("pass", 3)
    assert "the worst may be another: B (1 of 2)" in found.note
    assert "directions" in found.omits
    by_component = judged(pairs((0.1, 0.2), (0.3,), (0.2, 0.1)), statistic="mean", count="component")
    assert "directions" not in by_component.omits


def test_where_every_station_has_one_component_none_is_missing():
    """As where records are turned to the axis of the bridge."""
    assert "direction" not in judged(pairs((0.1,), (0.2,), (0.3,))).note


def test_a_component_that_was_not_run_is_one_that_failed():
    stations = {"A1": "A", "A2": "A", "B1": "B"}
    found = judged(pairs((0.1,), (0.2,)), records=stations)
    assert (found.verdict, found.records, found.counted) == ("not decided", 2, "1 not run (unknown)")


# Polarities and scales


def test_polarities_are_directions_and_mirror_images_are_none():
    plus, minus = pairs(*FOUR), pairs(*(tuple(2 * each for each in station) for station in FOUR), polarity="-")
    found = judged(pd.concat([plus, minus]), statistic="mean", at_most=1.0)
    assert (found.records, found.runs, found.value) == (4, 16, pytest.approx(0.75))
    assert (found.station, found.record, found.polarity) == ("C", "C2", "-")
    mirrored = pd.concat([plus.assign(mirror_of=""), minus.assign(mirror_of="+")])
    assert judged(mirrored, statistic="mean").value == pytest.approx(0.375)


def test_a_station_at_three_scales_is_no_three_records():
    table = pd.concat([pairs(*FOUR[:2], scale=scale) for scale in (1.0, 1.5, 2.0)])
    found = judge([Rule("check", "theta_max_over_alpha", 0.5, statistic="en1998-2")], table, [case()])
    assert [(one.scale, one.records, one.verdict) for one in found] == [
        (scale, 2, "not decided") for scale in (1.0, 1.5, 2.0)
    ]


# What governs


@pytest.mark.parametrize(
    ("asked", "governs"),
    [
        ({}, ("C", "C2", 0.9)),
        ({"statistic": "mean"}, ("C", "C2", 0.9)),
        ({"demand": "top_drift_m", "statistic": "en1998-2"}, ("C", "C2", pytest.approx(0.9 * 0.2 * 2 * 7.2108408))),
        ({"demand": "overturned", "at_most": 0}, ("", "", math.nan)),
    ],
)
def test_a_verdict_names_the_run_that_governs_and_what_it_demands(asked, governs):
    found = judged(pairs(*FOUR), **asked)
    assert (found.station, found.record) == governs[:2]
    assert found.governing == pytest.approx(governs[2], nan_ok=True)
    assert found.unit == ("m" if asked.get("demand") == "top_drift_m" else "")


def test_what_is_not_decided_names_the_run_that_leaves_it_open():
    """Not the largest value that is known, which another run has."""
    table = pairs(*FOUR, status=["ok", "flight", *["ok"] * 6])
    found = judged(table, at_most=1.0)
    assert (found.verdict, found.record, found.governing, found.value) == ("not decided", "A2", 0.2, 0.9)
    too_few = judged(pairs(*FOUR[1:3]), at_most=1.0, statistic="aashto")
    assert (too_few.verdict, too_few.record) == ("not decided", "B2")


def test_an_event_names_the_run_in_which_it_happens():
    table = pairs(*FOUR, status=["ok"] * 6 + ["overturned", "ok"])
    found = judged(table, demand="overturned", at_most=0)
    assert (found.verdict, found.station, found.record, found.governing) == ("fail", "D", "D1", 1.0)


# Fewest records, and what counts


def test_any_statistic_can_ask_for_more_records():
    assert judged(pairs(*FOUR), statistic="mean", least=4).verdict == "pass"
    found = judged(pairs(*FOUR), statistic="mean", least=5)
    assert (found.verdict, found.note.split("; ")[:1]) == ("not decided", ["4 stations count, the check asks for 5"])
    assert judged(pairs(*FOUR), statistic="mean", least=5, count="component").verdict == "pass"
    assert judged(pairs(*FOUR), statistic="max", least=5).verdict == "fail"  # more records lower no maximum


@pytest.mark.parametrize(
    ("asked", "problem"),
    [
        ({"statistic": "en1998-2", "least": 2}, "least = 2: EN 1998-2 asks for 3; leave it out"),
        ({"count": "stations"}, 'count = "stations": did you mean "station"? expected one of "station"'),
        ({"demand": "eta", "at_most": None, "at_least": 2, "least": 3}, "least: eta is the same for all records"),
        ({"demand": "flight", "statistic": "aashto"}, "flight is yes or no"),
    ],
)
def test_what_makes_no_sense_is_refused(asked, problem):
    with pytest.raises(InputError) as caught:
        Rule(**({"name": "check", "demand": "theta_max_over_alpha", "at_most": 0.5} | asked))
    assert any(problem in each for each in caught.value.messages)


CHECK = '[[check]]\nname = "peak"\ndemand = "theta_max_over_alpha"\nstatistic = "mean"\nat_most = 0.5\nreason = "r"\n'
COMPONENT = '[suite]\ncount = "component"\n'


def counts(out, rules=None):
    return [(one.records, one.count) for one in verdicts(out, rules)]


def test_a_suite_says_what_counts_and_a_check_may_say_otherwise(tmp_path):
    own = folder(tmp_path / "a", pairs(*FOUR), [case()], CHECK)
    assert counts(own) == [(4, "station")]
    suite = folder(tmp_path / "b", pairs(*FOUR), [case()], COMPONENT + CHECK)
    assert counts(suite) == [(8, "component")]
    other = CHECK.replace("peak", "other") + 'count = "station"\n'
    both = folder(tmp_path / "c", pairs(*FOUR), [case()], COMPONENT + CHECK + other)
    assert counts(both) == [(8, "component"), (4, "station")]
    # Rules from elsewhere count as the study does, unless they say it
    assert counts(suite, [Rule("peak", "theta_max_over_alpha", 0.5)]) == [(8, "component")]
    file = tmp_path / "rules.toml"
    file.write_text(CHECK)
    assert counts(suite, file) == [(8, "component")]
    file.write_text(COMPONENT.replace("component", "station") + CHECK)
    assert [rule.count for rule in load_rules(file)] == ["station"]
    assert counts(suite, file) == [(4, "station")]


def test_a_mistake_under_suite_is_reported_with_its_line(tmp_path):
    text = study_text(suite={"count": "pair"})
    path = write_study(tmp_path, text)
    with pytest.raises(InputError, match=r'\[suite\]: count = "pair": expected one of "station", "component"'):
        rb.load_study(path)
    path = write_study(tmp_path, study_text(suite={"counts": "station"}))
    with pytest.raises(InputError, match=r"counts: unknown key; did you mean count\?"):
        rb.load_study(path)
    path = write_study(tmp_path, study_text(suite={"count": "component"}))
    assert rb.load_study(path).count == "component"


def test_pulses_are_records_of_their_own_in_the_table_and_in_a_folder(tmp_path):
    path = write_study(tmp_path, study_text(pulses=(SINE, SINE | {"name": "other"}), cases=(PADS,)) + "\n" + CHECK)
    assert main(["run", str(path), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 0
    from_folder, from_table = rb.check(tmp_path / "out"), rb.check(rb.run(path, jobs=1), study=path)
    pd.testing.assert_frame_equal(from_folder, from_table)
    assert list(from_folder["records"]) == [2]


# Folders of an earlier version


def test_where_stations_are_not_known_components_count_and_it_is_said(tmp_path, capsys):
    records = [RECORD | {"record": f"{s}{i}"} for s in "ABCD" for i in (1, 2)]
    out = folder(tmp_path / "out", pairs(*FOUR), [case()], CHECK, records=records)
    table = pd.read_csv(out / "peaks.csv").drop(columns="station")
    table.to_csv(out / "peaks.csv", index=False)
    with pytest.warns(MissingColumns, match="station"):
        (found,) = verdicts(out)
    assert (found.records, found.count) == (8, "component")
    assert "these results do not say which components are of one station" in found.note
    assert main(["check", str(out), "--all"]) == 0
    printed = capsys.readouterr().out
    assert " components " in printed.splitlines()[1]
    assert "do not say which components are of one station" in " ".join(printed.split())


def test_verdicts_of_an_earlier_version_are_still_read(tmp_path):
    out = folder(tmp_path / "out", pairs(*FOUR), [case()], CHECK)
    assert main(["check", str(out)]) == 0
    new = ["count", "unit", "station", "record", "polarity", "governing"]
    pd.read_csv(out / "checks.csv").drop(columns=new).to_csv(out / "checks.csv", index=False)
    (found,) = read_verdicts(out)
    assert (found.records, found.station, found.count) == (4, "", "")


# The numbers, by hand


def by_hand(path: Path, statistic, count):
    """What the columns of peaks.csv come to, without a line of the package."""
    worst: dict[str, float] = {}
    with path.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            name = row["station" if count == "station" else "record"]
            worst[name] = max(worst.get(name, 0.0), float(row["theta_max_over_alpha"]))
    values = list(worst.values())
    if statistic == "mean" or (statistic not in ("max", "nzs1170.5") and len(values) >= 7):
        return len(values), statistics.fmean(values)
    return len(values), max(values)


@pytest.mark.parametrize(("stations", "count"), [(FOUR, "component"), (SEVEN, "station")], ids=["four", "seven"])
@pytest.mark.parametrize("statistic", ["max", "mean", "en1998-1", "en1998-2", "aashto", "nzs1170.5"])
def test_a_verdict_is_what_plain_python_makes_of_peaks_csv(tmp_path, stations, count, statistic):
    table = pd.concat([pairs(*stations), pairs(*stations, polarity="-").assign(theta_max_over_alpha=0.15)])
    out = folder(tmp_path / "out", table, [case()])
    count = "station" if STATISTICS[statistic].code else count
    (found,) = verdicts(out, [Rule("peak", "theta_max_over_alpha", 0.5, statistic=statistic, count=count)])
    records, value = by_hand(out / "peaks.csv", statistic, count)
    assert (found.records, found.value) == (records, pytest.approx(value, rel=1e-9))
    assert found.verdict == ("pass" if value <= 0.5 else "fail")


@pytest.mark.parametrize(
    ("records", "unknown", "remarks"),
    [
        (1, 0, []), (2, 0, ["2 of 4 stations are of one event, Kaikoura 2016"]),
        (1, 1, ["of 1 of 4 stations the event is not known"]), (0, 4, []),
        (3, 1, ["3 of 4 stations are of one event, Kaikoura 2016", "of 1 of 4 stations the event is not known"]),
    ],
)  # fmt: skip
def test_two_records_of_an_event_and_some_of_unknown_ones_are_remarked_on(records, unknown, remarks):
    assert OfEvent("Kaikoura 2016", records, 4, unknown).remarks == remarks


CODED = [name for name, kind in STATISTICS.items() if kind.code]


@pytest.mark.parametrize("statistic", CODED)
def test_sequences_that_share_a_station_are_no_independent_motions_of_a_code(statistic):
    names = [f"S{i} + S{i + 1}" for i in range(0, 24, 2)]
    table = runs([0.1] * 12, station=names, record=[f"q{i}" for i in range(12)])
    apart = {f"q{i}": (f"S{2 * i}", f"S{2 * i + 1}") for i in range(12)}
    shared = apart | {"q3": ("S0", "S7")}
    rule = Rule("c", "theta_max_over_alpha", 0.5, statistic=statistic)
    told_of = f"2 of 12 motions have a record of S0 in them, and {STATISTICS[statistic].code}"
    for shocks, told in ((apart, ""), (shared, told_of)):
        (found,) = judge([rule], table, [case()], Suite(shocks=shocks))
        assert (found.verdict, found.why_open.startswith(told)) == ("not decided" if told else "pass", True)
    beside = pd.concat([table, runs([0.1], station="S0", record="alone")])
    (found,) = judge([rule], beside, [case()], Suite(shocks=apart))
    assert found.why_open.startswith("2 of 13 motions have a record of S0")
    (plain,) = judge([replace(rule, statistic="mean")], table, [case()], Suite(shocks=shared))
    assert plain.verdict == "pass"
    (unknown,) = judge([rule], table, [case()], Suite(shocks=apart | {"q3": ()}))
    assert unknown.why_open == "the stations of a sequence are not known: pass the motions of the table, too"


@pytest.mark.parametrize("second", [lambda i: (i + 1) % 3, lambda i: 3 + i % 3])
def test_sequences_of_few_stations_are_too_few_records_for_a_quantile(second):
    """Three sequences of six stations are three motions, and those with common stations one: a shock more adds none."""
    joined = 1 if second(2) == 0 else 3
    shocks = {f"q{i}": (f"S{i % 3}", f"S{second(i)}") for i in range(6)}
    table = runs([0.1] * 6, station=[f"sequence {name}" for name in shocks], record=[*shocks])
    (found,) = judge([Rule("c", "theta_max_over_alpha", 0.5, statistic="p84")], table, [case()], Suite(shocks=shocks))
    assert (found.verdict, found.why_open) == (
        "not decided", f"6 components of {joined} station{'s' * (joined > 1)} count, the 84 % quantile asks for 6 stations",
    )  # fmt: skip


def test_a_station_of_which_one_component_is_not_selected_lacks_a_direction():
    alone = runs([0.1], station="A", record="A1", theta_max_error=1e-5)
    rule = Rule("c", "theta_max_over_alpha", 0.5)
    for motions, told in ((Suite(not_selected={"A": 1, "C": 2}), "A (1 of 2)"), (Suite(not_selected={"C": 2}), "")):
        (found,) = judge([rule], alone, [case()], motions)
        assert (told in found.note, found.omits) == (True, ("directions",) if told else ())
    (settled,) = judge([Rule("c", "failed", 0)], alone, [case()], Suite(not_selected={"A": 1}))
    assert (settled.verdict, settled.omits) == ("pass", ())  # of the runs of the study, of which none is missing
    both_ways = pd.concat([alone, alone.assign(polarity="-")])
    assert "A (2 of 4)" in judge([rule], both_ways, [case()], Suite(not_selected={"A": 1}))[0].note


def test_motions_without_the_vertical_component_asked_for_are_counted_by_station():
    table = pairs(*FOUR, theta_max_error=1e-5)
    rule = Rule("c", "theta_max_over_alpha", 1.0)
    (found,) = judge([rule], table, [case()], Suite(without_vertical=["A1", "A2", "C2"]))
    assert (found.verdict, found.omits) == ("pass", ("verticals",))
    assert found.note == "2 of 4 stations lack the vertical component"
    for demand, told in (("overturned", "1 of 4 stations lacks the vertical component"), ("failed", "")):
        (of_one,) = judge([Rule("c", demand, 0.0)], table, [case()], Suite(without_vertical=["A1"]))
        assert (of_one.verdict, of_one.note) == ("pass", told)
    (by_component,) = judge([rule], table, [case()], Suite(without_vertical=["A1", "A2", "C2"]), "component")
    assert by_component.note == "3 of 8 components lack the vertical component"
    assert not judge([rule], table, [case()], Suite())[0].omits


def test_a_suite_knows_shared_stations_and_what_was_not_selected(tmp_path):
    near_fault = Path(rb.__file__).parents[1] / "motions/near_fault"
    every = rb.read_motions(near_fault)
    names = [motion.name for motion in every]
    first, second = every.motions[0], next(m for m in every if m.of_station != every.motions[0].of_station)
    weakest = min(every, key=lambda motion: motion.pga)
    text = f"""
[pier]
alpha = 0.2
p = 1.0
[motions]
path = "{near_fault}"
select = {{ pga_g = [{1.001 * weakest.pga / 9.81}, 9.0] }}
[[motions.sequence]]
name = "both"
records = ["{first.name}", "{second.name}"]
alone = true
[[case]]
base = "rigid"
"""
    (tmp_path / "study.toml").write_text(text, encoding="utf-8")
    study = rb.load_study(tmp_path / "study.toml")
    suite = suite_of(describe(study, ground_motions(study)))
    assert len(suite.stations) == len(names)  # one more, and one less
    assert suite.shocks == {"both": sorted([first.of_station, second.of_station])}
    assert suite.not_selected == {weakest.of_station: 1}
    assert not suite.without_vertical


def test_a_table_of_sequences_meets_no_code_without_its_motions():
    """It has not what they are joined of; three of pulses passed EN 1998-1."""
    pulses = [SINE | {"name": f"p{i}", "amplitude_g": 0.1 + 0.01 * i, "duration_s": 1.0} for i in range(6)]
    sequences = [{"name": f"q{i}", "records": [f"p{2 * i}", f"p{2 * i + 1}"], "pause_s": 1.0} for i in range(3)]
    check = {"name": "c", "demand": "theta_max_over_alpha", "statistic": "en1998-1", "at_most": 0.9, "reason": "r"}
    text = {"motions": {"pulse": pulses, "sequence": sequences}, "case": [{"base": "rigid"}], "check": [check]}
    study = rb.Study.from_dict({"pier": {"alpha": 0.2, "p": 1.0}} | text)
    (row,) = rb.check(rb.run(study, progress=False), study=study).to_dict("records")
    assert (row["verdict"], row["records"]) == ("not decided", 3)
    assert row["note"].startswith("the stations of a sequence are not known: pass the motions of the table, too")
