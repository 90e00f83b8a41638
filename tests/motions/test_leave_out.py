"""Stations of what cannot be used, and records, files and stations that are left out by name."""

import pytest
from motion_files import wiggle, write_at2

from rockbatch.common.errors import InputError
from rockbatch.motions import read_motions
from rockbatch.study import Study
from rockbatch.study.suite import ground_motions

UNITLESS = "# time acc\n" + "\n".join(f"{i / 100} {v}" for i, v in enumerate(wiggle(50)))


@pytest.fixture
def folder(tmp_path):
    """Two stations: of RSN7 one horizontal component is cut, of RSN9 no file states its unit."""
    for seed, name in enumerate(("RSN7_A_B000", "RSN7_A_B090", "RSN7_A_B-UP")):
        write_at2(tmp_path, f"{name}.AT2", wiggle(50, seed), title=f"Made-up, 1/17/1994, B, {name[8:].strip('-')}")
    cut = tmp_path / "RSN7_A_B090.AT2"
    cut.write_text("\n".join(cut.read_text().splitlines()[:-2]))
    (tmp_path / "lobby").mkdir()
    for name in ("RSN9_C_D000", "RSN9_C_D090"):
        (tmp_path / "lobby" / f"{name}.txt").write_text(UNITLESS)
    return tmp_path


def test_every_file_that_cannot_be_used_has_the_station_that_it_would_count_as(folder):
    found = read_motions(folder)
    assert [(motion.name, motion.station) for motion in found] == [("RSN7_A_B000", "RSN7")]
    assert [(file.name, file.station) for file in found.unusable] == [
        ("RSN7_A_B090", "RSN7"), ("RSN9_C_D000", "RSN9"), ("RSN9_C_D090", "RSN9"),
    ]  # fmt: skip


def test_a_channel_that_cannot_be_used_is_of_the_station_of_the_others_in_its_file(tmp_path):
    rows = "\n".join(f"{i / 100} {v} {'nan' if i == 9 else v} {v}" for i, v in enumerate(wiggle(50)))
    (tmp_path / "x_y.txt").write_text(f"# time(s) NS(g) EW(g) UD(g)\n{rows}\n")
    found = read_motions(tmp_path)
    stations = {motion.of_station for motion in found} | {file.station for file in found.unusable}
    assert len(stations) == 1


@pytest.mark.parametrize(
    "patterns",
    [["RSN9"], ["RSN9_*"], ["lobby"], ["lobby/*.txt"], ["RSN9_C_D000", "RSN9_C_D090.txt"], ["lobby/RSN9_C_D?[09]0.txt"]],
)  # fmt: skip
def test_a_station_is_left_out_by_its_name_its_files_their_records_or_their_folder(folder, patterns):
    found = read_motions(folder, leave_out=patterns)
    assert [file.station for file in found.unusable] == ["RSN7"]
    assert [(file.name, file.station, file.named) for file in found.left_out] == [
        ("RSN9_C_D000", "RSN9", True), ("RSN9_C_D090", "RSN9", True),
    ]  # fmt: skip
    assert f'leave_out = ["{patterns[0]}"]' in found.left_out[0].reason


def test_a_usable_record_is_left_out_and_one_of_a_manifest_counts_as_named(folder):
    found = read_motions(folder, leave_out=["RSN7*"])
    assert not found.motions
    assert {file.name for file in found.left_out} == {"RSN7_A_B000", "RSN7_A_B090", "RSN7_A_B-UP"}
    (folder / "motions.toml").write_text('[[record]]\nfile = "lobby/RSN9_C_D000.txt"\nuse = false\n')
    (left,) = read_motions(folder).left_out
    assert (left.station, left.named) == ("RSN9", True)


def test_what_a_manifest_leaves_out_keeps_its_reason_where_a_name_fits_it_too(folder):
    (folder / "motions.toml").write_text('[[record]]\nfile = "lobby/RSN9_C_D000.txt"\nuse = false\n')
    found = read_motions(folder, leave_out=["RSN9"])
    reasons = {file.name: file.reason for file in found.left_out}
    assert sorted(reasons) == ["RSN9_C_D000", "RSN9_C_D090"]
    assert ["leave_out" in reasons[name] for name in sorted(reasons)] == [False, True]


@pytest.mark.parametrize(("azimuths", "left"), [((0.0, 30.0), "X_az030"), ((30.0,), "X_UNTURNED000")])
def test_what_comes_of_turning_a_pair_is_left_out_by_its_own_name(tmp_path, azimuths, left):
    for name in ("X_000", "X_090", "X_UNTURNED000"):
        write_at2(tmp_path, f"{name}.AT2", wiggle(50, len(name)), title=f"Made-up, 1/17/1994, {name[:3]}, {name[-3:]}")
    all_of_them = read_motions(tmp_path, azimuths=azimuths)
    found = read_motions(tmp_path, azimuths=azimuths, leave_out=[left])
    (gone,) = found.left_out
    assert (gone.name, gone.named) == (left, True)
    assert "X_" in gone.source
    for kept, before in ((found.motions, all_of_them.motions), (found.unusable, all_of_them.unusable)):
        assert [one.name for one in kept] == [one.name for one in before if one.name != left]


def test_a_name_that_matches_nothing_is_refused_with_the_one_that_was_meant(folder):
    with pytest.raises(InputError) as caught:
        read_motions(folder, leave_out=["RSN9_C_D001", "RSN9*", "nobody"])
    first, second = caught.value.messages
    assert '"RSN9_C_D001"' in first
    assert 'did you mean "RSN9_C_D0' in first
    assert '"nobody"' in second
    assert "`rockbatch motions FOLDER` lists them" in second


def study(folder, **motions):
    tables = {"pier": {"alpha": 0.2, "p": 1.0}, "case": [{"base": "rigid"}], "motions": {"path": ".", **motions}}
    return Study.from_dict(tables, folder / "study.toml")


def test_a_study_leaves_out_what_it_names_and_is_strict_about_the_rest(folder):
    with pytest.raises(InputError, match="RSN9_C_D000"):
        ground_motions(study(folder, strict=True))
    found = ground_motions(study(folder, strict=True, leave_out=["RSN9", "RSN7_A_B090"]))
    assert [motion.name for motion in found] == ["RSN7_A_B000"]


def test_the_names_of_a_study_are_about_its_own_sources(folder):
    """Other motions, as by --motions, need not have what it leaves out."""
    changed = study(folder, leave_out=["RSN9"]).with_(motions=folder / "RSN7_A_B000.AT2")
    assert [motion.name for motion in ground_motions(changed)] == ["RSN7_A_B000"]


def test_a_record_that_is_not_selected_for_want_of_a_magnitude_keeps_its_station(folder):
    (folder / "motions.toml").write_text('[[record]]\nfile = "RSN7_A_B000.AT2"\nmagnitude = 7\n')
    write_at2(folder, "RSN8_A_B000.AT2", wiggle(50, 9), title="Made-up, 1/17/1994, C, 000")
    found = ground_motions(study(folder, select={"magnitude": [6.0, 8.0]}))
    assert ("RSN8_A_B000", "RSN8") in [(file.name, file.station) for file in found.unusable]
