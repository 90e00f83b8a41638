"""Suites: offsets, selection, targets, strictness, and what ``rockbatch motions`` tells of them."""

import csv
import re
from dataclasses import replace

import numpy as np
import pytest
from motion_files import wiggle, write_at2
from studies import FOLDER_STUDY, write_study

from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.motions import Motion, MotionSet, read_motions
from rockbatch.motions.component import Component
from rockbatch.motions.intensity import measures
from rockbatch.motions.quality.baseline import Offset, remove_offset
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.motions.suites.scaling import Target, at_target
from rockbatch.motions.suites.selection import Selection, selected
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions
from rockbatch.terminal.messages import Terminal


def component(values, raw: bool = False) -> Component:
    return Component("c", 0.1, np.asarray(values, float), raw=raw)


def motion(name: str = "m", scale: float = 1.0, **more) -> Motion:
    t = np.arange(400) * 0.01
    return Motion(name, 0.01, scale * np.sin(2 * np.pi * t), vertical=scale * 0.5 * np.cos(7 * t), **more)


def study_of(folder, keys: str = ""):
    return load_study(write_study(folder, FOLDER_STUDY + keys))


# Offsets


def test_by_default_only_what_an_instrument_left_is_taken_off_and_it_is_said():
    assert remove_offset(component([1, 2, 3]), Offset()).acceleration.tolist() == [1, 2, 3]
    freed = remove_offset(component([1, 2, 3], raw=True), Offset())
    assert freed.acceleration.tolist() == [-1, 0, 1]
    assert freed.notes == ("offset 2 m/s² removed (mean over the record)",)


def test_an_offset_can_be_kept_or_taken_off_by_the_mean_of_all_or_before_the_event():
    kept = remove_offset(component([1, 2, 3], raw=True), Offset("keep"))
    assert kept.acceleration.tolist() == [1, 2, 3]
    assert kept.notes == ("offset 2 m/s² kept (mean over the record)",)
    assert remove_offset(component([1, 2, 3]), Offset("mean")).acceleration.tolist() == [-1, 0, 1]
    before = remove_offset(component([1, 2, 9, 9, 9]), Offset("pre-event", (0.0, 0.1)))
    assert before.acceleration.tolist() == [-0.5, 0.5, 7.5, 7.5, 7.5]
    assert before.notes == ("offset 1.5 m/s² removed (mean from 0 to 0.1 s, before the event)",)


@pytest.mark.parametrize("dt", [0.1, 0.01, 0.005, 0.004])
@pytest.mark.parametrize("first", [0, 3, 29])
def test_the_samples_at_both_ends_of_a_window_are_within_it(dt, first):
    values = np.arange(80.0) ** 2
    for last in range(first + 1, 80):
        window = round(first * dt, 6), round(last * dt, 6)  # as people write them: 0.3, not 3 · 0.1
        freed = remove_offset(Component("c", dt, values), Offset("pre-event", window))
        assert values[0] - freed.acceleration[0] == pytest.approx(np.mean(values[first : last + 1]))
        between = round((first - 0.5) * dt, 6), round((last + 0.5) * dt, 6)
        if between[0] >= 0.0 and last < 79:
            freed = remove_offset(Component("c", dt, values), Offset("pre-event", between))
            assert values[0] - freed.acceleration[0] == pytest.approx(np.mean(values[first : last + 1]))


def test_a_window_that_a_record_does_not_have_costs_that_record_only(tmp_path):
    write_at2(tmp_path, "long.AT2", wiggle(300), title="nothing, 000")
    write_at2(tmp_path, "short.AT2", wiggle(50), title="nothing, 000")
    found = read_motions(tmp_path, offset=Offset("pre-event", (0.0, 1.0)))
    assert [m.name for m in found.motions] == ["long"]
    assert [u.reason for u in found.unusable] == ["offset_window_s = [0, 1] is not within its 0.49 s"]


@pytest.mark.parametrize(
    ("rule", "window"), [("pre-event", None), ("mean", (0, 1)), ("pre-event", (1, 1)), ("x", None)]
)
def test_an_offset_that_cannot_be_is_refused(rule, window):
    with pytest.raises(InputError, match="offset"):
        Offset(rule, window)


# Selection


def test_records_are_selected_by_every_measure_and_the_others_have_a_reason():
    found = MotionSet([motion("weak", 0.5), motion("fit", 2.0), motion("strong", 9.0)])
    chosen = selected(found, Selection(pga_g=(0.1, 0.5)), gravity=10.0)
    assert [m.name for m in chosen.motions] == ["fit"]
    assert [left.reason for left in chosen.left_out] == [
        "not selected: pga_g = 0.05 is not within 0.1..0.5",
        "not selected: pga_g = 0.9 is not within 0.1..0.5",
    ]
    for limits, names in (({"pgv_m_s": (1.0, 9.0)}, ["strong"]), ({"duration_s": (4.0, 9.0)}, [])):
        assert [m.name for m in selected(found, Selection(**limits), 10.0).motions] == names
    pgv = measures.pgv(motion("fit", 2.0).horizontal, 0.01)
    chosen = selected(found, Selection(pgv_m_s=(pgv, pgv), duration_s=(3.99, 3.99)), 10.0)
    assert [m.name for m in chosen.motions] == ["fit"]  # both ends are included


def test_the_length_of_a_record_and_its_significant_duration_are_selected_apart():
    """One second of shaking in ten of record, and ten in ten: both are as long, but only one shakes for long."""
    short, long = np.zeros(1001), np.ones(1001)
    short[450:551] = 1.0  # and half a step more on either side, by trapezoids of its square: 0.9 · 1.01 s
    found = MotionSet([Motion("short", 0.01, short), Motion("long", 0.01, long)])
    by_length = selected(found, Selection(duration_s=(9.0, 11.0)), 9.81)
    assert [m.name for m in by_length.motions] == ["short", "long"]
    by_shaking = selected(found, Selection(d5_95_s=(8.0, 11.0)), 9.81)
    assert [m.name for m in by_shaking.motions] == ["long"]
    assert [left.reason for left in by_shaking.left_out] == ["not selected: d5_95_s = 0.909 is not within 8..11"]


def test_a_record_of_unknown_magnitude_cannot_be_selected_by_it():
    found = MotionSet([motion("known", magnitude=7.0), motion("small", magnitude=5.0), motion("unknown")])
    chosen = selected(found, Selection(magnitude=(6.0, 8.0)), 9.81)
    assert [m.name for m in chosen.motions] == ["known"]
    assert [left.name for left in chosen.left_out] == ["small"]
    assert "write magnitude in motions.toml" in chosen.unusable[0].reason


# Targets


def test_every_record_meets_its_target_with_its_vertical_and_the_factor_is_kept():
    found = MotionSet([motion("a", 1.0), motion("b", 3.0)])
    for scaled in at_target(found, Target(pga_g=0.4), 10.0).motions:
        assert scaled.pga == pytest.approx(4.0, rel=1e-12)
    for scaled in at_target(found, Target(pgv_m_s=0.7), 10.0).motions:
        assert measures.pgv(scaled.horizontal, 0.01) == pytest.approx(0.7, rel=1e-12)
    target = Target(sa_g=0.5, period_s=0.8, damping=0.02)
    for scaled, before in zip(at_target(found, target, 10.0).motions, found.motions, strict=True):
        assert spectral_acceleration(scaled.horizontal, 0.01, [0.8], 0.02)[0] == pytest.approx(5.0, rel=1e-12)
        np.testing.assert_allclose(scaled.vertical, before.vertical * scaled.factor, rtol=1e-14)
        assert scaled.notes == (f"scaled by {scaled.factor:.4g} to SA(0.8 s, 2 %) = 0.5 g",)


def test_a_record_without_motion_meets_no_target():
    still = replace(motion(), horizontal=np.zeros(400))
    found = at_target(MotionSet([still]), Target(pga_g=0.4), 10.0)
    assert not found.motions
    assert "no motion that can be scaled to PGA = 0.4 g" in found.unusable[0].reason


@pytest.mark.parametrize("keys", [{}, {"pga_g": 1.0, "pgv_m_s": 1.0}, {"sa_g": 1.0}, {"pga_g": 0.0}])
def test_a_target_is_one_measure(keys):
    with pytest.raises(InputError, match="a target is one of"):
        Target(**keys)


# From the study file


def test_a_study_turns_selects_and_scales_its_records(tmp_path):
    for azimuth, seed in (("000", 1), ("090", 2)):
        title = f"X, 1/17/1994, STA, {azimuth}"
        write_at2(tmp_path / "records", f"RSN7_X_Y{azimuth}.AT2", wiggle(80, seed), title=title)
    write_at2(tmp_path / "records", "RSN8_X_Y000.AT2", wiggle(80, scale=0.01), title="X, 1/17/1994, Z, 000")
    keys = "every_deg = 90\nselect = { pga_g = [0.05, inf] }\ntarget = { pga_g = 0.3 }\n"
    found = ground_motions(study_of(tmp_path, keys))
    assert [m.name for m in found.motions] == ["RSN7_X_Y_az000", "RSN7_X_Y_az090"]
    assert [m.pga for m in found.motions] == pytest.approx([0.3 * 9.81] * 2)
    factors = [0.3 / np.abs(wiggle(80, seed)).max() for seed in (1, 2)]
    assert [m.factor for m in found.motions] == pytest.approx(factors, rel=1e-5)  # AT2 has seven digits
    assert ["only one horizontal" in u.reason for u in found.unusable] == [True]


def test_pulses_keep_their_own_amplitude(tmp_path):
    (tmp_path / "records").mkdir()
    pulse = '[[motions.pulse]]\nname = "p"\nshape = "cosine"\namplitude_g = 0.2\nperiod_s = 1\ndt_s = 0.01\nduration_s = 2\n'
    (only,) = ground_motions(study_of(tmp_path, "target = { pga_g = 0.4 }\n" + pulse)).motions
    assert (only.pga, only.factor) == (pytest.approx(0.2 * 9.81), 1.0)


def test_one_bad_record_costs_itself_and_a_strict_study_everything(tmp_path):
    write_at2(tmp_path / "records", "good.AT2", wiggle(50), title="nothing, 000")
    write_at2(tmp_path / "records", "high.AT2", wiggle(50, scale=60), title="nothing, 000")
    found = ground_motions(study_of(tmp_path))
    assert ([m.name for m in found.motions], [u.name for u in found.unusable]) == (["good"], ["high"])
    with pytest.raises(InputError) as caught:
        ground_motions(study_of(tmp_path, "strict = true\n"))
    assert "high.AT2: PGA 5" in caught.value.messages[0]
    assert "1 of the records cannot be used" in caught.value.messages[-1]
    assert len(ground_motions(study_of(tmp_path, 'strict = true\nconfirm_pga = "hi*"\n')).motions) == 2


# Verticals


def with_one_vertical(folder) -> None:
    """Two stations, one of them without a vertical."""
    for station, seed in (("has", 1), ("lacks", 2)):
        write_at2(folder, f"{station}000.AT2", wiggle(100, seed), title=f"X, 1/17/1994, {station}, 0")
    write_at2(folder, "hasUP.AT2", wiggle(100, 3), title="X, 1/17/1994, has, UP")


def test_records_that_lack_the_vertical_that_was_asked_for_are_named(tmp_path):
    with_one_vertical(tmp_path / "records")
    assert ground_motions(study_of(tmp_path)).without_vertical == ["lacks000"]
    assert ground_motions(study_of(tmp_path, "vertical = false\n")).without_vertical == []
    pulse = (
        '[[motions.pulse]]\nname = "p"\nshape = "sine"\namplitude_g = 1\nperiod_s = 1\ndt_s = 0.01\nduration_s = 2\n'
    )
    assert ground_motions(study_of(tmp_path, pulse)).without_vertical == ["lacks000"]  # a pulse has none to miss


def test_a_required_vertical_costs_a_record_without_it_and_a_strict_study_all(tmp_path):
    with_one_vertical(tmp_path / "records")
    found = ground_motions(study_of(tmp_path, 'vertical = "required"\n'))
    assert [motion.name for motion in found.motions] == ["has000"]
    (refused,) = found.unusable
    assert refused.reason.startswith("X 1994, lacks, 000 has no vertical component, and the study requires it")
    with pytest.raises(InputError) as caught:
        ground_motions(study_of(tmp_path, 'vertical = "required"\nstrict = true\n'))
    assert caught.value.messages[0].startswith("lacks000.AT2: X 1994, lacks, 000 has no vertical component")


def test_a_vertical_that_does_not_last_over_the_peak_is_none(tmp_path):
    write_at2(tmp_path, "s000.AT2", wiggle(100, 1), title="X, 1/17/1994, STA, 0")
    write_at2(tmp_path, "sUP.AT2", wiggle(100, 2)[:20], title="X, 1/17/1994, STA, UP")
    assert read_motions(tmp_path).without_vertical == ["s000"]
    assert len(read_motions(tmp_path, vertical="required").unusable) == 1


def test_of_many_records_without_a_vertical_the_first_are_named(capsys):
    Terminal().motions(MotionSet([Motion(f"r{i}", 0.01, np.arange(3.0) + i, lacks_vertical=True) for i in range(1023)]))
    said = capsys.readouterr().err
    assert (said.count(";"), said.endswith("r2; and 1,020 more\n")) == (3, True)


@pytest.mark.usefixtures("pages")
def test_run_and_its_report_name_the_records_without_a_vertical(tmp_path, capsys):
    with_one_vertical(tmp_path / "records")
    study_of(tmp_path, '[output]\nhistories = "none"\n')
    assert main(["run", str(tmp_path / "study.toml"), "--out", str(tmp_path / "out")]) == 0
    assert "no vertical: X 1994, lacks, 000 (lacks000)\n" in capsys.readouterr().err
    report = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "<p>no vertical: X 1994, lacks, 000 (lacks000)</p>" in report
    study_of(tmp_path, 'vertical = "required"\n[output]\nhistories = "none"\n')
    assert main(["run", str(tmp_path / "study.toml"), "--out", str(tmp_path / "out")]) == 1
    rows = list(csv.DictReader((tmp_path / "out" / "peaks.csv").read_text().splitlines()))
    assert {row["record"]: row["status"] for row in rows} == {"has000": "ok", "lacks000": "failed"}
    assert main(["run", str(tmp_path / "study.toml"), "--out", str(tmp_path / "o"), "--strict"]) == 2
    assert not (tmp_path / "o").exists()


# The command


def test_the_table_is_a_csv_too_with_a_row_for_every_file(tmp_path, capsys):
    records = tmp_path / "records"
    for name, component_, seed in (("000", "0", 1), ("-UP", "UP", 2)):
        write_at2(records, f"=RSN7{name}.AT2", wiggle(200, seed), title=f"X, 1/17/1994, STA, {component_}")
    (records / "bad.AT2").write_text("nothing")
    (records / "meta.json").write_text("{}")
    out = tmp_path / "table.csv"
    assert main(["motions", "--all", str(records), "--csv", str(out)]) == 1
    with out.open(encoding="utf-8", newline="") as file:
        good, bad, companion = csv.DictReader(file)
    assert list(good)[:13] == [
        "record", "file_h", "file_v", "dt_s", "npts", "duration_s", "pga_h_g", "pga_v_g", "pgv_h_m_s", "pgd_h_m",
        "arias_m_s", "d5_95_s", "reason",
    ]  # fmt: skip
    assert (good["record"], good["file_h"], good["file_v"]) == ("'=RSN7000", "'=RSN7000.AT2", "'=RSN7-UP.AT2")
    (found,) = read_motions(records).motions
    assert float(good["pga_h_g"]) == pytest.approx(found.pga / 9.81, rel=1e-9)
    assert float(good["arias_m_s"]) == pytest.approx(measures.arias_intensity(found.horizontal, 0.01), rel=1e-9)
    assert float(good["d5_95_s"]) == pytest.approx(measures.significant_duration(found.horizontal, 0.01), rel=1e-9)
    assert (bad["record"], bad["npts"]) == ("bad", "")
    assert "says PEER AT2 or text columns, but its header is another one" in bad["reason"]
    assert companion["reason"] == "no record: text about the records"
    shown = capsys.readouterr()
    assert "1 record, 1 file not used, 1 left out" in shown.err
    assert "Arias [m/s]" in shown.out
    assert "length [s]" in shown.out
    assert "D5-95 [s]" in shown.out


def test_strict_makes_a_bad_file_fatal_and_companions_harm_nobody(tmp_path):
    write_at2(tmp_path, "good.AT2", wiggle(50), title="nothing, 000")
    (tmp_path / "meta.json").write_text("{}")
    assert main(["motions", "--all", str(tmp_path), "--strict"]) == 0
    (tmp_path / "bad.AT2").write_text("nothing")
    assert main(["motions", "--all", str(tmp_path)]) == 1
    assert main(["motions", "--all", str(tmp_path), "--strict"]) == 2


def test_a_manifest_is_drafted_once(tmp_path, capsys):
    write_at2(tmp_path, "good.AT2", wiggle(50), title="nothing, 000")
    assert main(["motions", "--all", str(tmp_path), "--write-manifest"]) == 0
    assert (tmp_path / "motions.toml").is_file()
    assert main(["motions", "--all", str(tmp_path), "--write-manifest"]) == 2
    assert "is there already" in capsys.readouterr().err
    assert main(["motions", "--all", str(tmp_path), str(tmp_path), "--write-manifest"]) == 2


@pytest.mark.usefixtures("pages")
def test_run_and_its_report_name_a_record_that_would_be_usual_in_another_unit(tmp_path, capsys):
    """A peak of 3.9 m/s² without a unit in its file, read as 3.9 g because the study says so."""
    samples = 3.9 * np.sin(0.5 * np.arange(200)) * np.exp(-0.02 * np.arange(200))
    (tmp_path / "records").mkdir()
    for name, factor in (("strong_NS.txt", 1.0), ("weak_EW.txt", 0.01)):
        (tmp_path / "records" / name).write_text("\n".join(f"{factor * a:.6f}" for a in samples), encoding="utf-8")
    text = 'title = "t"\n[pier]\nalpha = 0.2\np = 1.0\n[motions]\npath = "records"\nunit = "g"\ndt = 0.01\n'
    path = write_study(tmp_path, f'{text}[[case]]\nname = "rigid"\nbase = "rigid"\n[output]\nhistories = "none"\n')
    assert main(["run", str(path), "--out", str(tmp_path / "out")]) == 0
    (warned,) = (line for line in capsys.readouterr().err.splitlines() if "to check: " in line and ": PGA " in line)
    assert "strong_NS.txt" in warned
    assert "if its numbers are in m/s², it is 0.3" in warned
    page = (tmp_path / "out/report.html").read_text("utf-8")
    (noted,) = re.findall(r'<a href="#records">[^<]* to check</a>, .*? check the unit\.', page)
    assert "strong_NS.txt" in noted
    assert "if its numbers are in m/s², it is 0.3" in noted
