"""Folders: pairing of components, common samples, names, order, and a reason for every file that is not used."""

import os
from pathlib import Path

import numpy as np
import pytest
from motion_files import wiggle, write_at2

from rockbatch.common.errors import InputError
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.component import Component
from rockbatch.motions.identity import common_span
from rockbatch.motions.identity.pairing import to_motions
from rockbatch.motions.identity.stations import _may_join
from rockbatch.motions.labels.orientation import Orientation


def title(component: str, station: str = "Test Station") -> str:
    return f"Made-up, 1/17/1994, {station}, {component}"


def vertical_of(found) -> dict[str, str]:
    return {motion.name: motion.vertical_source for motion in found.motions}


def test_components_of_one_rsn_are_paired_and_g_is_the_studys(tmp_path):
    values = {"RRS228": wiggle(50, 1), "RRS318": wiggle(50, 2), "RRS-UP": wiggle(50, 3)}
    for name, data in values.items():
        write_at2(tmp_path, f"RSN1063_NORTHR_{name}.AT2", data, title=title(name[3:].lstrip("-")))
    found = read_motions(tmp_path, gravity=10.0)
    assert vertical_of(found) == {
        "RSN1063_NORTHR_RRS228": "RSN1063_NORTHR_RRS-UP.AT2",
        "RSN1063_NORTHR_RRS318": "RSN1063_NORTHR_RRS-UP.AT2",
    }
    np.testing.assert_allclose(found.motions[0].horizontal, values["RRS228"] * 10.0, rtol=1e-6)
    np.testing.assert_allclose(found.motions[0].vertical, values["RRS-UP"] * 10.0, rtol=1e-6)
    assert not found.unusable


def test_without_rsn_the_header_pairs_whatever_the_files_are_called(tmp_path):
    write_at2(tmp_path, "first.at2", wiggle(50, 1), title=title("228"))
    write_at2(tmp_path, "second.at2", wiggle(50, 2), title=title("UP"))
    write_at2(tmp_path, "third.at2", wiggle(50, 3), title=title("UP", "Elsewhere"))
    found = read_motions(tmp_path)
    assert vertical_of(found) == {"first": "second.at2"}
    assert [(u.name, "without a usable horizontal" in u.reason) for u in found.unusable] == [("third", True)]


def test_without_a_header_the_stem_pairs(tmp_path):
    for name, seed in (("A_E.AT2", 1), ("A_Z.AT2", 2), ("B_E.AT2", 3)):
        write_at2(tmp_path, name, wiggle(50, seed), title="nothing said")
    assert vertical_of(read_motions(tmp_path)) == {"A_E": "A_Z.AT2", "B_E": ""}


def test_components_in_different_folders_are_not_paired(tmp_path):
    write_at2(tmp_path / "a", "RSN7_X_Y000.AT2", wiggle(50), title=title("0"))
    write_at2(tmp_path / "b", "RSN7_X_Y-UP.AT2", wiggle(50), title=title("UP"))
    found = read_motions(tmp_path)
    assert vertical_of(found) == {"RSN7_X_Y000": ""}
    assert found.unusable[0].source == "b/RSN7_X_Y-UP.AT2"


@pytest.mark.parametrize(
    ("folders", "upright"), [(("000.D", "090.D", "UP.D"), 2), (("090", "000", "UP"), 0), (("a.D", "b.D", "UP.D"), 0)]
)
def test_components_in_folders_called_after_their_directions_are_paired(tmp_path, folders, upright):
    for seed, (folder, label) in enumerate(zip(folders, ("000", "090", "UP"), strict=True)):
        write_at2(tmp_path / "2019" / folder, f"x.{label}.AT2", wiggle(50, seed), title=title(label))
    assert [*vertical_of(read_motions(tmp_path)).values()].count("2019/UP.D/x.UP.AT2") == upright


def test_files_of_one_name_in_folders_of_directions_are_named_by_their_folders(tmp_path):
    for seed, (folder, label) in enumerate(zip(("EW", "NS", "UD"), ("90", "0", "UP"), strict=True)):
        write_at2(tmp_path / "given" / folder, "STA1.AT2", wiggle(50, seed), title=title(label))
    found = read_motions(tmp_path / "given")
    assert [(motion.name, motion.vertical_source) for motion in found.motions] == [
        ("EW/STA1", "UD/STA1.AT2"),
        ("NS/STA1", "UD/STA1.AT2"),
    ]


def test_a_dwn_component_is_turned_up_and_it_is_said(tmp_path):
    up = wiggle(50, 2)
    write_at2(tmp_path, "RSN7_X_Y000.AT2", wiggle(50), title=title("0"))
    write_at2(tmp_path, "RSN7_X_YDWN.AT2", -up, title=title("DWN"))
    (motion,) = read_motions(tmp_path, gravity=1.0).motions
    np.testing.assert_allclose(motion.vertical, up, rtol=1e-6)
    assert "vertical: DWN is positive down, sign reversed" in motion.notes


def test_unequal_lengths_are_cut_to_the_common_span_and_it_is_said(tmp_path):
    write_at2(tmp_path, "RSN7_X_Y--L.AT2", wiggle(50, 1), title=title("L"))
    write_at2(tmp_path, "RSN7_X_Y--T.AT2", wiggle(44, 2), title=title("T"))
    write_at2(tmp_path, "RSN7_X_Y--V.AT2", wiggle(48, 3), title=title("V"))
    longer, shorter = read_motions(tmp_path).motions
    assert (longer.npts, shorter.npts) == (48, 44)
    assert longer.vertical is not None
    assert len(longer.vertical) == 48
    np.testing.assert_allclose(longer.horizontal / 9.81, wiggle(50, 1)[:48], rtol=1e-6)  # from the first sample
    assert "common span: 0.47 s of 0.49 s horizontal and 0.47 s vertical" in longer.notes


def test_a_vertical_that_ends_before_the_horizontal_peak_is_not_used(tmp_path):
    write_at2(tmp_path, "RSN7_X_Y000.AT2", wiggle(100, 1), title=title("0"))
    write_at2(tmp_path, "RSN7_X_Y-UP.AT2", wiggle(100, 2)[:20], title=title("UP"))
    (motion,) = read_motions(tmp_path).motions
    assert (motion.npts, motion.vertical) == (100, None)
    assert any("does not last over the horizontal peak" in note for note in motion.notes)


def test_the_coarser_component_is_interpolated_and_keeps_its_own_samples(tmp_path):
    fine, coarse = wiggle(101, 1), wiggle(51, 2)
    write_at2(tmp_path, "RSN7_X_Y000.AT2", fine, title=title("0"), dt=".0050")
    write_at2(tmp_path, "RSN7_X_Y-UP.AT2", coarse, title=title("UP"), dt=".0100")
    (motion,) = read_motions(tmp_path, gravity=1.0).motions
    assert (motion.dt, motion.npts) == (0.005, 101)
    assert motion.vertical is not None
    np.testing.assert_allclose(motion.vertical[::2], coarse, rtol=1e-6)
    np.testing.assert_allclose(motion.vertical[1::2], (coarse[:-1] + coarse[1:]) / 2, rtol=1e-5, atol=1e-9)
    assert any(note.startswith("vertical interpolated linearly to dt = 0.005 s") for note in motion.notes)


def component(values, dt=0.01, vertical=False, start=None, **more):
    return Component("c", dt, np.asarray(values, float), Orientation("x", vertical), "S", "/f", ("c.x",), start, **more)


def test_a_coarse_horizontal_is_brought_to_the_vertical_samples():
    (motion,) = to_motions([component([0, 1, 0], 0.02), component([0, 1, 2, 3, 4], 0.01, True)]).motions
    np.testing.assert_allclose(motion.horizontal, [0, 0.5, 1, 0.5, 0])
    np.testing.assert_array_equal(motion.vertical, [0, 1, 2, 3, 4])
    assert motion.dt == 0.01
    assert any(note.startswith("horizontal interpolated") for note in motion.notes)


@pytest.mark.parametrize(("finer", "parts"), [(0.5, 2), (0.4, 3), (1.0 - 1e-7, 1)])
def test_horizontal_steps_are_cut_to_no_coarser_than_vertical_ones(finer, parts):
    """The last are the same but for rounding, and begin a quarter of a step apart."""
    h = component([0, 6, 0, 6], 0.01, start=1e9)
    v = component(np.arange(40.0), 0.01 * finer, True, start=1e9 - 0.0025)
    (motion,) = to_motions([h, v]).motions
    assert motion.dt == pytest.approx(0.01 / parts, rel=1e-12)
    np.testing.assert_allclose(motion.horizontal[: 3 * parts : parts], [0, 6, 0], atol=1e-12)
    t = motion.dt * np.arange(motion.npts) + 0.0025
    np.testing.assert_allclose(motion.vertical, t / v.dt, rtol=1e-4)


@pytest.mark.parametrize("late", [1e-4, -1e-4, 4.9e-4, 0.01 + 1e-4])
def test_starts_within_a_tenth_of_a_step_count_as_simultaneous(late):
    """0.1 ms between two clocks; the motion is linear between samples, so the error is below a tenth of a step's."""
    h, v = np.array([0.0, 0.3, 1.0, 0.2, -0.5, 0.1]), np.array([0.1, -0.9, 0.7, 0.4, 0.0, 0.2])
    (motion,) = to_motions(
        [component(h, 0.005, start=1e9), component(v, 0.005, vertical=True, start=1e9 + late)], confirmed=["*"]
    ).motions
    shift = round(late / 0.005)
    np.testing.assert_array_equal(motion.horizontal, h[shift:])
    np.testing.assert_array_equal(motion.vertical, v[: len(v) - shift])
    (note,) = [note for note in motion.notes if "simultaneous" in note]
    assert note.startswith(f"vertical {abs(late - shift * 0.005) * 1e3:.2g} ms {'late' if late > 0 else 'early'}")
    assert not any("interpolated" in note for note in motion.notes)
    t = 0.005 * np.arange(6)
    exact = np.interp(t + shift * 0.005 - late, t, v)[: len(v) - shift]
    inside = slice(1, -1)
    assert np.abs(motion.vertical - exact)[inside].max() < 0.1 * np.abs(np.diff(v)).max()


@pytest.mark.parametrize("late", [0.15, 0.5])
def test_starts_that_are_off_by_more_than_a_tenth_of_a_step_are_interpolated(late):
    ramp = np.arange(10.0)
    pair = [component(ramp, start=100.0), component(ramp, vertical=True, start=100.0 + 0.01 * late)]
    (motion,) = to_motions(pair).motions
    np.testing.assert_allclose(motion.horizontal, ramp[1:])
    np.testing.assert_allclose(motion.vertical, ramp[1:] - late, atol=1e-4)  # times since 1970 to 1e-7 s
    assert any("interpolated" in note for note in motion.notes)


def test_jitter_does_not_move_the_samples_of_a_finer_component_either():
    fine, coarse = wiggle(101, 1), wiggle(51, 2)
    pair = [component(fine, 0.005, start=1e9), component(coarse, 0.01, vertical=True, start=1e9 + 2e-4)]
    (motion,) = to_motions(pair).motions
    np.testing.assert_allclose(motion.horizontal, fine, rtol=1e-12)
    np.testing.assert_allclose(motion.vertical[::2], coarse, rtol=1e-12)


def test_steps_without_a_common_measure_cost_no_horizontal_peak():
    spike = [0, 0, 1, 0, 0]
    (motion,) = to_motions([component(spike, 0.02), component(np.arange(6), 0.015, True)]).motions
    assert motion.dt == 0.01  # the horizontal samples halved: no coarser than 0.015 s
    np.testing.assert_allclose(motion.horizontal, [0, 0, 0, 0.5, 1, 0.5, 0, 0])
    np.testing.assert_allclose(motion.vertical, np.arange(8) / 1.5)


def test_two_verticals_of_one_station_are_ambiguous_and_neither_is_used(tmp_path):
    write_at2(tmp_path, "RSN7_X_Y000.AT2", wiggle(50), title=title("0"))
    write_at2(tmp_path, "RSN7_X_Y-UP.AT2", wiggle(50, 2), title="nothing")
    write_at2(tmp_path, "RSN7_X_Y-V.AT2", wiggle(50, 3), title="nothing")
    found = read_motions(tmp_path)
    assert found.motions[0].vertical is None
    assert len(found.unusable) == 2
    assert all("several vertical components" in u.reason for u in found.unusable)


def test_every_file_is_a_motion_or_has_a_reason_and_read_me_files_are_neither(tmp_path):
    write_at2(tmp_path, "good.AT2", wiggle(50), title="nothing, 000")
    write_at2(tmp_path, "short.AT2", wiggle(50), count="NPTS= 60, DT= .01 SEC")
    write_at2(tmp_path, "one.AT2", [0.1], title="nothing, 000")
    for name in ("empty.AT2", "archive.zip", "README.md", ".hidden.AT2", "StationXML.xml"):
        (tmp_path / name).touch()
    for name in ("notes.docx", "meta.json", "good.VT2", "_SearchResults.csv"):
        (tmp_path / name).touch()
    (tmp_path / ".git").mkdir()
    (tmp_path / ".git" / "x.AT2").touch()
    found = read_motions(tmp_path)
    assert [motion.name for motion in found.motions] == ["good"]
    reasons = {u.source: u.reason for u in found.unusable}
    assert list(reasons) == ["archive.zip", "empty.AT2", "one.AT2", "short.AT2"]
    assert reasons["empty.AT2"] == "the file is empty"
    assert reasons["archive.zip"] == "the file is empty"
    assert {left.source: left.reason for left in found.left_out} == {
        "_SearchResults.csv": "no record: a table about the records",
        "good.VT2": "no record: the velocity of a record",
        "meta.json": "no record: text about the records",
        "notes.docx": "no record: text about the records",
    }
    assert "at least two" in reasons["one.AT2"]
    assert "NPTS = 60" in reasons["short.AT2"]


def test_links_that_lead_out_are_not_followed_and_it_is_said(tmp_path):
    outside = write_at2(tmp_path / "outside", "x.AT2", wiggle(50))
    inside = tmp_path / "inside"
    write_at2(inside, "a.AT2", wiggle(50), title="nothing, 000")
    (inside / "b.AT2").symlink_to(outside)
    (inside / "c").symlink_to(outside.parent)
    (inside / "below").mkdir()
    (inside / "f").symlink_to(inside / "below")
    (inside / "d.AT2").symlink_to(inside / "d.AT2")
    os.mkfifo(inside / "e.AT2")
    found = read_motions(inside)
    assert [motion.name for motion in found.motions] == ["a"]
    reasons = {u.source: u.reason for u in found.unusable}
    assert "leads out" in reasons["b.AT2"]
    assert "leads out" in reasons["c"]
    assert reasons["d.AT2"] == reasons["e.AT2"] == "not a regular file"
    assert reasons["f"] == "a link to a folder, not followed"


def test_a_folder_that_cannot_be_opened_is_named_as_such(tmp_path, monkeypatch):
    """As if it were another's: an administrator opens every folder."""
    write_at2(tmp_path, "a.AT2", wiggle(50), title="nothing, 000")
    (tmp_path / "theirs").mkdir()
    scan = os.scandir

    def refusing(path):
        if Path(path).name == "theirs":
            raise PermissionError(13, "Permission denied", str(path))
        return scan(path)

    monkeypatch.setattr(os, "scandir", refusing)
    found = read_motions(tmp_path)
    assert [motion.name for motion in found.motions] == ["a"]
    assert [(u.source, u.reason) for u in found.unusable] == [("theirs", "a folder that cannot be opened")]


def test_a_reader_that_fails_costs_one_file_and_its_exception_is_named(tmp_path, monkeypatch):
    write_at2(tmp_path, "good.AT2", wiggle(50), title="nothing, 000")
    (tmp_path / "bad.txt").write_text("1 2\n")
    from rockbatch.motions import folder

    honest = folder.read_record

    def failing(file):
        if file.path.suffix == ".txt":
            raise ZeroDivisionError("by design")
        return honest(file)

    monkeypatch.setattr(folder, "read_record", failing)
    found = read_motions(tmp_path)
    assert len(found.motions) == 1
    assert found.unusable[0].reason == "its reader failed: ZeroDivisionError: by design"


def test_the_order_is_that_of_the_paths_and_sources_are_short(tmp_path):
    for seed, name in enumerate(("b/z.AT2", "b/a.AT2", "a/k.AT2", "c.AT2")):
        write_at2((tmp_path / name).parent, name.rsplit("/", 1)[-1], wiggle(50, seed), title="nothing, 000")
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["a/k.AT2", "b/a.AT2", "b/z.AT2", "c.AT2"]


def test_several_paths_are_read_in_the_given_order_and_no_file_twice(tmp_path):
    first = write_at2(tmp_path / "a", "x.AT2", wiggle(50), title="nothing, 000")
    write_at2(tmp_path / "b", "y.AT2", wiggle(50, 2), title="nothing, 000")
    found = read_motions([tmp_path / "b", first, tmp_path / "a"])
    assert [motion.source for motion in found.motions] == ["b/y.AT2", "x.AT2"]


def test_motions_of_one_name_get_their_folder_in_front(tmp_path):
    for seed, name in enumerate(("a/x.AT2", "b/x.AT2", "b/y.AT2")):
        write_at2(tmp_path / name[0], name[2:], wiggle(50, seed), title="nothing, 000")
    assert [motion.name for motion in read_motions(tmp_path).motions] == ["a/x", "b/x", "y"]


def test_folders_of_one_name_are_told_apart_by_those_above(tmp_path):
    for seed, folder in enumerate(("st1/acc", "st2/acc")):
        write_at2(tmp_path / folder, "N.AT2", wiggle(200, seed), title="nothing")
    found = read_motions(tmp_path)
    assert [(m.name, m.of_station) for m in found.motions] == [("st1/acc/N", "acc st1"), ("st2/acc/N", "acc st2")]


def test_all_missing_paths_are_one_error_with_suggestions(tmp_path):
    (tmp_path / "records").mkdir()
    with pytest.raises(InputError) as caught:
        read_motions([tmp_path / "recods", tmp_path / "nowhere"])
    assert len(caught.value.messages) == 2
    assert f"did you mean {tmp_path / 'records'}?" in caught.value.messages[0]


def test_an_empty_folder_is_an_empty_set(tmp_path):
    found = read_motions(tmp_path)
    assert (found.motions, found.unusable) == ([], [])


@pytest.mark.parametrize("scale", [100.0, 0.0005])
@pytest.mark.parametrize("confirmed", ["x", "[x]*", "?"])
def test_an_unlikely_peak_is_used_only_when_it_is_confirmed(tmp_path, scale, confirmed):
    write_at2(tmp_path, "x.AT2", wiggle(50, scale=scale), title="nothing, 000")
    (refused,) = read_motions(tmp_path).unusable
    assert "check the unit" in refused.reason
    assert 'confirm_pga = ["x"]' in refused.reason
    assert len(read_motions(tmp_path, confirmed=["y*"]).motions) == 0
    assert len(read_motions(tmp_path, confirmed=[confirmed]).motions) == 1
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "x.AT2"\nconfirm_pga = true\n')
    assert len(read_motions(tmp_path).motions) == 1


def test_an_unlikely_vertical_is_asked_for_too(tmp_path):
    write_at2(tmp_path, "RSN7_X_Y000.AT2", wiggle(50), title=title("0"))
    write_at2(tmp_path, "RSN7_X_Y-UP.AT2", wiggle(50, scale=100.0), title=title("UP"))
    (refused,) = read_motions(tmp_path).unusable
    assert refused.source == "RSN7_X_Y000.AT2, RSN7_X_Y-UP.AT2"
    assert ", vertical " in refused.reason


def test_the_header_pairs_before_the_name_does(tmp_path):
    """Two stations whose files were given one RSN by mistake stay apart by their headers, each with its vertical."""
    for station, seed in (("First", 1), ("Second", 2)):
        write_at2(tmp_path, f"RSN7_{station}_000.AT2", wiggle(50, seed), title=title("0", station))
        write_at2(tmp_path, f"RSN7_{station}_UP.AT2", wiggle(50, seed + 5), title=title("UP", station))
    found = read_motions(tmp_path)
    assert vertical_of(found)["RSN7_First_000"] == "RSN7_First_UP.AT2"
    assert vertical_of(found)["RSN7_Second_000"] == "RSN7_Second_UP.AT2"


def test_the_name_pairs_where_one_header_says_nothing(tmp_path):
    write_at2(tmp_path, "A_E.AT2", wiggle(50, 1), title=title("E"))
    write_at2(tmp_path, "A_Z.AT2", wiggle(50, 2), title="nothing said")
    assert vertical_of(read_motions(tmp_path)) == {"A_E": "A_Z.AT2"}


def test_names_that_a_terminal_would_obey_are_shown_instead(tmp_path):
    write_at2(tmp_path, "\x1b[31mred\n.AT2", wiggle(50), title="nothing, 000")
    (motion,) = read_motions(tmp_path).motions
    assert (motion.name, motion.source) == ("\\x1b[31mred\\x0a", "\\x1b[31mred\\x0a.AT2")


@pytest.mark.parametrize(
    ("unit", "factor"), [("G", 10.0), ("CM/SEC/SEC", 0.01), ("CM/S**2", 0.01), ("G. FILTER POINTS: HP=0.07 Hz", 10.0)]
)
def test_the_unit_line_of_at2_is_obeyed(tmp_path, unit, factor):
    write_at2(tmp_path, "x.AT2", wiggle(50), unit=f"ACCELERATION TIME HISTORY IN UNITS OF {unit}")
    (motion,) = read_motions(tmp_path, gravity=10.0, confirmed=["x"]).motions
    np.testing.assert_allclose(motion.horizontal, wiggle(50) * factor, rtol=1e-6)


def test_at2_without_a_unit_takes_the_stated_one_or_none(tmp_path):
    write_at2(tmp_path, "x.AT2", wiggle(50), unit="ACCELERATION TIME SERIES")
    assert 'unit = "g"' in read_motions(tmp_path).unusable[0].reason
    assert len(read_motions(tmp_path, options=ReadOptions(unit="g")).motions) == 1


@pytest.mark.parametrize("late", [0.004, 0.0895])
def test_a_vertical_without_two_samples_in_common_with_its_horizontal_is_not_used(late):
    """They overlap by 6 ms without a sample in common, or by half a millisecond."""
    h, v = component([0, 1, 0, 1, 0, 1, 0, 1, 0, 1], start=100.0), component([5, 6], vertical=True, start=99.996)
    if late > 0.01:
        v = component([5, 6, 5], vertical=True, start=100.0 + late)
    (motion,) = to_motions([h, v]).motions
    assert (motion.npts, motion.vertical) == (10, None)
    assert any("does not last over the horizontal peak" in note for note in motion.notes)


@pytest.mark.parametrize(("first", "second", "delay"), [(None, 3.0, 0.0), (3.0, None, 0.0), (1.0, 3.0, 2.0)])
def test_components_without_both_starts_begin_together(first, second, delay):
    one, other = (
        Component(name, 0.01, np.ones(500), Orientation(name), start=start)
        for name, start in (("000", first), ("090", second))
    )
    assert common_span._offset(one, other, "090") == (delay, [])


def test_a_pattern_that_nothing_fits_is_answered_with_its_folder(tmp_path):
    (tmp_path / "records").mkdir()
    with pytest.raises(
        InputError, match=r"no file fits this pattern: give the folder, .*records, which is read"
    ) as error:
        read_motions(tmp_path / "records" / "*.AT2")
    assert "did you mean" not in str(error.value)
    with pytest.raises(InputError) as error:
        read_motions(tmp_path / "nowhere" / "*.AT2")
    assert "fits this pattern" not in str(error.value)


@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        ("HV", "HV", False),
        ("HV", "HHV", False),
        ("HV", "H", True),
        ("H", "HV", True),
        ("HV", "V", True),
        ("V", "HV", True),
        ("H", "V", True),
        ("HH", "H", True),
    ],
)
@pytest.mark.parametrize("late", [0.0, 0.85, 0.95])
def test_groups_of_one_name_join_if_they_overlap_and_not_both_are_complete(first, second, expected, late):
    """Ten samples last 0.9 s."""
    groups = (
        [component(range(10), 0.1, kind == "V", 100.0 + own) for kind in of]
        for of, own in ((first, 0.0), (second, late))
    )
    assert _may_join(*groups) is (expected and late < 0.9)
