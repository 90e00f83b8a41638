"""The scorecard of records: which stand first, what is said of each, and the same columns in terminal, CSV and page."""

import csv
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from motion_files import wiggle, write_at2

import rockbatch as rb
from rockbatch.commands.cli import main
from rockbatch.commands.motions import _GLANCE, _scorecard, overview
from rockbatch.common.errors import Contradiction, NoUnit, Truncated
from rockbatch.motions import LeftOut, MotionSet, Unusable, small_figures
from rockbatch.motions.intensity import measures
from rockbatch.motions.motion import Finding
from rockbatch.motions.ranking import COLUMNS, Use, pulse_period, ranked_records
from rockbatch.motions.sources.listed import Listed
from rockbatch.workflow import records as on_page

ODD = (Finding("no PGD", "its displacement runs away"),)


def motion(name, pga_g, **values):
    wave = np.sin(2 * np.pi * np.arange(400) / 80)
    return rb.Motion(name, 0.01, 9.81 * pga_g * wave / np.abs(wave).max(), **values)


def found():
    held = motion("tiny", 0.0004, findings=(Finding("PGA", "outside", gross=True),))
    return MotionSet(
        [
            motion("weak", 0.1), motion("odd", 0.05, findings=ODD), motion("A1", 0.3, station="A"),
            motion("A2", 0.6, station="A", vertical=np.full(400, 1.962)), motion("strong", 0.9),
            motion("odder", 0.2, findings=ODD),
        ],
        [
            Unusable("B1", ("B1.txt",), "no unit", lacks=("unit",), station="B"),
            Unusable("B2", ("B2.txt",), "no unit", lacks=("unit",), station="B"),
            Unusable("cut", ("cut.txt",), "ends early"),
            Unusable("which", ("which.txt",), "two ways", kind=Contradiction),
            Unusable("tiny", ("tiny.txt",), "PGA outside", motion=held),
        ],
        [LeftOut("meta", ("meta.json",), "no record"), LeftOut("twin", ("twin.txt",), "a copy of weak.txt", of="weak.txt")],
    )  # fmt: skip


def test_the_doubtful_stand_first_then_the_strongest_and_copies_last():
    assert [(record.name, record.use) for record in ranked_records(found())] == [
        ("tiny", Use.HELD_BACK), ("B1", Use.HELD_BACK), ("which", Use.HELD_BACK), ("cut", Use.NOT_READ), ("odder", Use.USED),
        ("odd", Use.USED), ("strong", Use.USED), ("A2", Use.USED), ("weak", Use.USED), ("twin", Use.COPY),
    ]  # fmt: skip


def test_a_station_is_one_record_with_the_pga_of_each_component():
    (pair,) = (record.values for record in ranked_records(found()) if record.name == "A2")
    assert [pair[name] for name in ("pga_h_g", "pga_h2_g", "pga_v_g")] == pytest.approx([0.6, 0.3, 0.2])


def test_the_component_across_counts_as_the_second_horizontal():
    (pair,) = ranked_records(MotionSet([motion("x", 0.4, across=np.full(400, 2.943))]))
    assert pair.values["pga_h2_g"] == pytest.approx(0.3)


def test_what_is_held_back_says_its_doubt_in_a_word_and_keeps_its_measures():
    doubts = {record.name: record.doubts for record in ranked_records(found()) if record.use is Use.HELD_BACK}
    assert doubts == {"tiny": ["PGA"], "B1": ["no unit"], "which": ["contradiction"]}
    assert ranked_records(found())[0].values["pga_h_g"] == pytest.approx(0.0004)


def test_a_record_too_weak_for_the_earth_is_read_and_held_back(tmp_path):
    write_at2(tmp_path, "a.AT2", wiggle(300, 1, scale=1e-5), title="Made-up, 1/17/1994, A, 000")
    (file,) = rb.read_motions(tmp_path).unusable
    assert file.motion.pga_g < 1e-4
    assert [finding.what for finding in file.motion.findings] == ["PGA"]


def test_the_period_of_the_pulse_is_the_lists_else_that_of_a_pulse_like_record():
    assert pulse_period(motion("listed", 0.01, listed=Listed(pulse_period_s=3.1))) == 3.1
    assert pulse_period(motion("weak", 0.05)) is None
    assert pulse_period(rb.Motion.still(4.0)) is None
    times = np.arange(0.0, 20.0, 0.01)
    velocity = 0.8 * np.exp(-(((times - 6.0) / 1.2) ** 2)) * np.cos(np.pi * (times - 6.0))  # of 2 s
    near = rb.Motion("near", 0.01, np.gradient(velocity, 0.01))
    assert 1.8 < pulse_period(near) < 2.4
    assert pulse_period(replace(near, listed=Listed(pulse_period_s=3.1))) == 3.1
    shaken = replace(near, horizontal=20.0 * np.sin(5.0 * times) * np.sin(np.pi * times / 20.0))  # strong, and no pulse
    assert measures.pgv(shaken.horizontal, 0.01) > 0.3
    assert pulse_period(shaken) is None


def test_terminal_csv_and_page_have_the_same_columns(tmp_path, capsys):
    for i in range(4):
        write_at2(tmp_path / "in", f"RSN{i}_X_S{i}000.AT2", wiggle(300, i), title=f"Made-up, 1/17/1994, S{i}, 000")
    main(["motions", str(tmp_path / "in"), "--csv", str(tmp_path / "t.csv"), "--html", str(tmp_path / "t.html")])
    with (tmp_path / "t.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    pictures = {"acceleration", "sa"}
    assert set(on_page.COLUMNS) - pictures | set(on_page._NAMED) == set(COLUMNS)
    assert set(COLUMNS) <= set(rows[0])
    assert {*_GLANCE, *on_page._NAMED, "use", "check", "duration_s"} == set(COLUMNS)
    printed = capsys.readouterr().out
    page = (tmp_path / "t.html").read_text(encoding="utf-8")
    assert re.search(r"In every row: status <span[^>]*>used</span>", page)
    for row in rows:
        assert f"{float(row['pga_h_g']):.3f}" in printed
        assert f"{float(row['pga_h_g']):.3f}" in page
        assert f"{float(row['d5_95_s']):.1f}" in printed


def test_the_terminal_says_below_a_record_why_it_is_held_back_or_to_be_checked():
    shown = [re.sub(r"  +.*\d", "", line) for line in overview(found()).splitlines()]
    begin = next(place for place, line in enumerate(shown) if line.startswith("record")) + 1
    assert shown[begin : shown.index("", begin)] == [
        "tiny", "    held back: PGA", "B", "    held back: no unit", "which", "    held back: contradiction",
        "odder", "    to check: no PGD", "odd", "    to check: no PGD", "strong", "A", "weak",
    ]  # fmt: skip
    assert shown[0] == "7 files: 6 usable recordings of 5 stations, 5 not used, 2 left out"


@pytest.mark.slow
def test_the_terminal_shows_the_doubtful_and_the_strongest_of_many():
    many = MotionSet([motion(f"m{i:03d}", 0.001 * (i + 1), findings=ODD * (i % 4 == 0)) for i in range(200)])
    lines = overview(many).splitlines()
    names = [line.split()[0] for line in lines if line.startswith("m")]
    doubtful = [name for name in names if int(name[1:]) % 4 == 0]
    assert doubtful[:2] == ["m196", "m192"]
    assert names[len(doubtful) :][:3] == ["m199", "m198", "m197"]
    assert names == doubtful + names[len(doubtful) :]
    assert lines[1 + lines.index(next(line for line in lines if line.startswith("m196")))] == "    to check: no PGD"
    assert any(
        line == f"and {50 - len(doubtful)} doubtful and {150 - len(names) + len(doubtful)} other stations more"
        for line in lines
    )


@pytest.mark.parametrize(
    ("sound", "doubtful", "room", "shown"), [(4, 50, 40, (4, 18)), (50, 50, 40, (20, 10)), (4, 6, 40, (4, 6))]
)
def test_doubtful_records_have_the_lines_left_over_and_half_of_all_at_least(sound, doubtful, room, shown):
    many = [motion(f"S{i}x", 0.1) for i in range(sound)] + [
        motion(f"D{i}x", 0.2, findings=ODD) for i in range(doubtful)
    ]
    card = _scorecard(ranked_records(MotionSet(many)), room)
    assert tuple(sum(line.startswith(letter) and "x " in line for line in card) for letter in "SD") == shown


def test_the_scorecard_with_every_column_fits_into_80_letters(monkeypatch):
    listed = Listed(pulse_period_s=11.25, vs30_m_s=1428.14)
    parts = {"vertical": np.full(400, 9.8), "across": np.full(400, 4.9)}
    one = motion("R" * 60, 1.234, magnitude=7.62, distance_km=123.41, listed=listed, **parts)
    for module in ("commands.motions", "terminal.streams"):
        monkeypatch.setattr(f"rockbatch.{module}.width", lambda: 80)
    card = overview(MotionSet([one, motion("S", 0.4, findings=ODD)])).splitlines()[:10]
    assert max(map(len, card)) <= 80
    (line,) = (line for line in card if line.startswith("R"))
    assert line.split()[1:5] == ["1.234", "0.499", "0.999", "3.08"]  # a whole wave from rest: 2A/ω
    assert line.split()[-4:] == ["11.2", "7.62", "123.4", "1428"]


def test_a_trace_keeps_the_extremes_in_a_few_points():
    samples = np.random.default_rng(1).normal(size=50_000)
    samples[[12_345, 43_210]] = 60.0, -70.0
    figure = small_figures.trace(rb.Motion("long", 0.005, samples))
    line = figure.panels[0].marks[0]
    assert len(line.x) <= small_figures.MOST_POINTS
    assert (line.y.max(), line.y.min()) == pytest.approx((60 / 9.81, -70 / 9.81))


def test_small_spectra_are_on_one_scale():
    pair = [motion("a", 0.2), motion("b", 0.4)]
    first, second = (figure.panels[0] for figure in small_figures.spectra(pair))
    assert first.y == second.y
    assert first.y.fraction(np.sqrt(first.y.low * first.y.high)) == pytest.approx(0.5)
    assert first.x.fraction(small_figures.PERIODS) == pytest.approx(np.linspace(0.0, 1.0, len(small_figures.PERIODS)))
    assert second.marks[1].y == pytest.approx(2 * first.marks[1].y)
    assert first.marks[1].y == pytest.approx(pair[0].spectrum(small_figures.PERIODS).to_numpy())


def test_what_is_held_back_is_written_into_run_json_without_its_samples():
    from rockbatch.results.run_json import _not_used

    entries = [_not_used(file) for file in found().unusable]
    assert [entry["kind"] for entry in entries] == [*["UnusableRecord"] * 3, "Contradiction", "UnusableRecord"]
    assert all("motion" not in entry for entry in json.loads(json.dumps(entries)))


def held_for(*oddities):
    return motion("tiny", 0.0004, findings=tuple(Finding(what, "outside", gross=True) for what in oddities))


@pytest.mark.parametrize(
    ("one", "other", "alike"),
    [
        ({"reason": "Te Mara ends early"}, {"reason": "Ward ends early"}, True),
        (
            {"reason": 'expected "NPTS="', "kind": Contradiction},
            {"reason": 'expected "DT="', "kind": Contradiction},
            False,
        ),
        ({"lacks": ("unit",), "kind": NoUnit}, {"lacks": ("unit", "dt"), "kind": NoUnit}, False),
        ({"motion": held_for("PGA")}, {"motion": held_for("PGA"), "reason": "PGA 9 g"}, True),
        ({"motion": held_for("PGA")}, {"motion": held_for("cut")}, False),
    ],
)
def test_files_have_one_cause_by_their_error_or_findings_not_by_their_words(one, other, alike):
    first, second = (Unusable("a", ("a",), **{"reason": "cut", "kind": Truncated} | keys) for keys in (one, other))
    assert (first.cause == second.cause) is alike
