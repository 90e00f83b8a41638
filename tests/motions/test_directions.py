"""Which way components point: the names that agencies use, numbers that are none, and a question where nothing tells."""

import tomllib
import zlib

import numpy as np
import pytest
from agency_files import dyna_text, geonet_text
from fixed_column_files import cosmos_text
from messages import assert_states
from motion_files import wiggle, write_at2
from obspy import Trace
from studies import FOLDER_STUDY, write_study

from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.component import Component, Sensor
from rockbatch.motions.identity.directions import _skew_pair
from rockbatch.motions.labels.orientation import Orientation, counted, orientation_in, orientation_of, split_stem
from rockbatch.motions.manifest_draft import write_manifest
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions


def write_text(folder, name, columns: int = 1, header: str = "# time(s) a(g)"):
    """A text file of time and accelerations in g, of which no two are alike."""
    accelerations = wiggle(seed=zlib.crc32(name.encode()))
    rows = [
        f"{0.01 * i:.2f} " + " ".join(f"{(k + 1) * a:.6f}" for k in range(columns)) for i, a in enumerate(accelerations)
    ]
    (folder / name).write_text("\n".join([header, *rows, ""]))


# Names


@pytest.mark.parametrize(
    "label",
    [
        *("BHZ", "BHZ00", "HHZ", "HLZ", "ENZ", "HNZ", "BNZ", "HGZ", "LHZ"),
        *("vert-axis", "VRT", "VERT", "Ver", "Vertical", "vertical_acc", "UD2", "UD1", "U/D"),
        *("Up-Dn", "Z-up", "acc_z", "a_Z", "CCC_HNZ", "SYL-UP", "AOM003.UD"),
    ],
)
def test_these_columns_are_vertical(label):
    found = orientation_in(label)
    assert (found.known, found.vertical, found.down, found.label) == (True, True, False, label)


@pytest.mark.parametrize("label", ["Z-down", "Zdown", "Z_DN", "V-down", "vertical down", "DWN", "Dn"])
def test_these_columns_are_vertical_and_positive_down(label):
    found = orientation_in(label)
    assert (found.known, found.vertical, found.down) == (True, True, True)


@pytest.mark.parametrize("label", ["F-L", "I-Z", "S-J", "K-Ny", "É-D", "V-J"])
def test_pairs_of_letters_in_an_unknown_language_are_no_direction(label, tmp_path):
    assert not orientation_in(label).known
    write_text(tmp_path, f"{label}.csv")
    assert "direction not known" in read_motions(tmp_path).unusable[0].reason


def test_a_letter_before_a_direction_in_several_files_is_their_station(tmp_path):
    for way in "NEZ":
        write_text(tmp_path, f"A-{way}.csv")
    assert [motion.vertical_source for motion in read_motions(tmp_path).motions] == ["A-Z.csv"] * 2


@pytest.mark.parametrize(
    "head",
    [
        "time (s),N (g),Z (positive down) (g)",
        "time (s),N (g),Vertical (g) (+ is downward)",
        "time[s],N[g],Vert (+ down) [g]",
        "Column 1: Time (s)\nColumn 2: N (g) (+ is northward)\nColumn 3: Up-down acceleration (g) (+ is downward)",
    ],
)
@pytest.mark.parametrize(("word", "sign"), [("down", -1.0), ("up", 1.0)])
def test_a_sign_in_brackets_turns_a_vertical(tmp_path, head, word, sign):
    head = (
        head.replace("downward", f"{word}ward")
        .replace("(positive down)", f"(positive {word})")
        .replace("+ down", f"+ {word}")
    )
    write_text(tmp_path, "x.csv", 2, head)
    (motion,) = read_motions(tmp_path).motions
    assert motion.vertical is not None
    assert np.allclose(motion.vertical, sign * 2.0 * motion.horizontal, atol=2e-4)


def test_a_y_that_points_up_beside_z_is_asked_for(tmp_path):
    write_text(tmp_path, "x.csv", 3, "t (s),X (g),Y up (g),Z (g)")
    found = read_motions(tmp_path)
    assert not found.motions
    assert "one direction, but other samples" in found.unusable[1].reason


@pytest.mark.parametrize(
    ("label", "azimuth"),
    [
        *(("BHN", 0), ("HHE", 90), ("ENE", 90), ("HNE00", 90), ("NS2", 0), ("EW1", 90), ("WE", 90), ("a_N", 0)),
        *(("CCC_HNE", 90), ("N28W", 332), ("270 deg", 270), ("COMP 228", 228), ("COMPONENT 021", 21), ("90", 90)),
        *(("HN1", None), ("L", None), ("T", None), ("Transverse", None), ("radial", None), ("X-axis", None)),
    ],
)
def test_these_columns_are_horizontal(label, azimuth):
    found = orientation_in(label)
    assert (found.known, found.vertical, found.azimuth) == (True, False, azimuth)


@pytest.mark.parametrize(
    "label",
    [
        *(
            "comp1",
            "COMP 3",
            "Component 2",
            "ch1",
            "CH 2",
            "chan 2",
            "CHAN14",
            "channel 101",
            "accel 3",
            "axis 1",
            "1",
            "3",
        ),
        *("HN3", "H3", "a", "acc", "", "foo"),
    ],
)
def test_numbers_of_components_and_words_are_no_direction(label):
    found = orientation_in(label)
    assert (found.known, found.azimuth, found.label) == (False, None, label)


@pytest.mark.parametrize(
    ("stem", "site", "label"),
    [
        ("RSN9_IU.CCM.BHZ.00", "RSN9_IU.CCM", "BHZ.00"),
        ("st_HNZ_corrected", "st_corrected", "HNZ"),
        ("chy080v", "chy080", "v"),
        ("TKYH121103111446UD2", "TKYH121103111446", "UD2"),
        ("AOM0031801241951.UD2", "AOM0031801241951", "UD2"),
        ("sylmar_VRT", "sylmar", "VRT"),
        ("sta_vert-axis", "sta", "vert-axis"),
        ("sta_U-D", "sta", "U-D"),
        ("ABBAR--V (2)", "ABBAR (2)", "V"),
        ("SLE_HNZ", "SLE", "HNZ"),
        ("HI.ARS1..HNZ.D.20190728.160908.C.ACC", "HI.ARS1.D.20190728.160908.C.ACC", "HNZ"),
        ("UP", "", "UP"),
    ],
)
def test_these_names_are_of_verticals_and_tell_their_station(stem, site, label):
    part, found = split_stem(stem)
    assert found is not None
    assert (part, found.label, found.vertical) == (site, label, True)


def test_north_south_in_a_name_is_north_and_not_south():
    for stem, azimuth in (("st_N-S", 0.0), ("st_E-W", 90.0), ("st_S", 180.0), ("st_N-S_corr", 0.0)):
        found = split_stem(stem)[1]
        assert found is not None
        assert found.azimuth == azimuth


@pytest.mark.parametrize(
    "stem",
    [
        *(
            "20190706031100",
            "20190110",
            "record_2019",
            "X.2019.187",
            "rec_001",
            "120111",
            "TCU052",
            "AOM003",
            "x_TKYH012",
        ),
        *(
            "st_ch101",
            "rec_120",
            "AOM0031801241151",
            "st_comp1",
            "st_ch2",
            "rec_one",
            "HNZ_BLE",
            "st_HNZ_T",
            "x",
            "run10s",
        ),
    ],
)
def test_dates_stations_and_numbers_are_no_azimuths_and_two_directions_none(stem):
    assert split_stem(stem) == (stem, None)


def test_files_counted_from_008_are_numbers_and_perpendicular_pairs_azimuths():
    assert counted(["GM_008", "GM_009", "GM_010", "L01021", "L01111", "CPM000", "CPM090"]) == {
        "GM_008",
        "GM_009",
        "GM_010",
    }


@pytest.mark.parametrize("word", ["NEW", "CORRECTIONS", "DENVER", "GROUP"])
def test_words_that_end_in_letters_of_a_direction_hide_none_beside_them(tmp_path, word):
    for label in ("UP", "NS", "EW"):
        write_text(tmp_path, f"{label}_{word}.csv")
    found = read_motions(tmp_path)
    assert sorted(m.azimuth for m in found.motions) == [0.0, 90.0]
    assert {m.vertical_source for m in found.motions} == {f"UP_{word}.csv"}
    assert not found.unusable


def test_a_word_alone_that_ends_in_letters_of_a_direction_is_asked_for(tmp_path):
    write_text(tmp_path, "STATIONS.csv")
    write_text(tmp_path, "ORRDWN.csv")
    assert [file.reason[:19] for file in read_motions(tmp_path).unusable] == ["direction not known"] * 2
    write_text(tmp_path, "ORR021.csv")
    (motion,) = read_motions(tmp_path).motions
    assert motion.vertical_source == "ORRDWN.csv"


@pytest.mark.parametrize("stem", ["RSN1120_KOBE_TAKNS", "ElCentroNS", "KobeNS", "RSN1120_KOBE_TAKUP"])
def test_letters_of_a_direction_count_whatever_files_lie_beside(tmp_path, stem):
    write_text(tmp_path, f"{stem}.csv")
    write_text(tmp_path, "TaftEW.csv")
    assert not [file for file in read_motions(tmp_path).unusable if "direction not known" in file.reason]


def test_two_letters_before_a_direction_are_no_pair(tmp_path):
    assert [orientation_in(f"AC-{way}").vertical for way in "NEZ"] == [False, False, True]
    assert all(orientation_in(f"AC-{way}").known for way in "NEZ")


def test_a_series_of_numbered_files_asks_though_single_numbers_could_be_azimuths(tmp_path):
    for name in ("GM_010.txt", "GM_011.txt", "GM_012.txt"):
        write_text(tmp_path, name)
    found = read_motions(tmp_path)
    assert (len(found.motions), ["direction not known" in u.reason for u in found.unusable]) == (0, [True] * 3)


# What is not known


@pytest.mark.parametrize(
    ("name", "header"),
    [
        ("mine.txt", "# time(s) a(g)"),
        ("mine.txt", "# time(s) comp1(g)"),
        ("mine.txt", "# time(s) COMP 3(g)"),
        ("mine_comp2.txt", "# time(s) acc(g)"),
        ("mine.txt", ""),
    ],
)
def test_a_component_of_unknown_direction_is_refused_with_what_to_write(tmp_path, name, header):
    write_text(tmp_path, name, header=header)
    found = read_motions(tmp_path, options=ReadOptions() if header else ReadOptions(unit="g"))
    assert not found.motions
    (asked,) = found.unusable
    for said in ('role = "horizontal" or "vertical"', "azimuth", "motions.toml", "--write-manifest", "under [motions]"):
        assert said in asked.reason


@pytest.mark.parametrize(
    ("name", "header", "title"),
    [
        ("st_HNZ_corrected.txt", "# time(s) a(g)", None),
        ("chy080v.txt", "# time(s) a(g)", None),
        ("TKYH121103111446UD2.txt", "# time(s) a(g)", None),
        ("sylmar_VRT.txt", "# time(s) a(g)", None),
        ("x.txt", "# time(s) vert-axis(g)", None),
        ("x.txt", "# time(s) Z-down(g)", None),
        ("RSN9_IU.CCM.BHZ.00.AT2", "", "CCM, BHZ00"),
        ("a.AT2", "", "Made-up, 1/17/1994, CCM, BHZ00"),
    ],
)
def test_a_vertical_is_no_horizontal_motion_whatever_it_is_called(tmp_path, name, header, title):
    if title is None:
        write_text(tmp_path, name, header=header)
    else:
        write_at2(tmp_path, name, wiggle(), title=title)
    found = read_motions(tmp_path, options=ReadOptions(role="horizontal"))
    assert not found.motions
    assert "a vertical component without a usable horizontal one" in found.unusable[0].reason


def test_verticals_are_paired_by_their_names(tmp_path):
    for name in ("chy080n.txt", "chy080v.txt", "st_HNE_corrected.txt", "st_HNZ_corrected.txt"):
        write_text(tmp_path, name)
    found = read_motions(tmp_path)
    assert [(m.name, m.vertical_source) for m in found.motions] == [
        ("chy080n", "chy080v.txt"),
        ("st_HNE_corrected", "st_HNZ_corrected.txt"),
    ]


def test_files_that_are_called_as_their_direction_are_of_the_station_of_their_folder(tmp_path):
    for name in ("000.txt", "090.txt", "UP.txt"):
        write_text(tmp_path, name)
    found = read_motions(tmp_path)
    assert [(m.name, m.vertical_source) for m in found.motions] == [("000", "UP.txt"), ("090", "UP.txt")]


def test_three_channels_are_asked_for_one_by_one_and_a_manifest_answers(tmp_path):
    write_text(tmp_path, "x.txt", 3, "# time(s) ch1(g) ch2(g) ch3(g)")
    asked = read_motions(tmp_path).unusable
    assert [u.name for u in asked] == ["x.ch1", "x.ch2", "x.ch3"]
    assert 'component = "ch1"' in asked[0].reason
    entries = [("ch1", 'role = "horizontal"'), ("ch2", "azimuth = 30"), ("ch3", 'role = "vertical"')]
    (tmp_path / "motions.toml").write_text(
        "".join(f'[[record]]\nfile = "x.txt"\ncomponent = "{name}"\n{key}\n' for name, key in entries)
    )
    found = read_motions(tmp_path)
    assert not found.unusable
    assert [(m.name, m.azimuth, m.vertical_source) for m in found.motions] == [
        ("x.ch1", None, "x.txt (ch3)"),
        ("x.ch2", 30.0, "x.txt (ch3)"),
    ]


def test_a_manifest_that_says_something_else_does_not_make_a_direction_known(tmp_path):
    write_text(tmp_path, "mine.txt")
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "mine.txt"\nmagnitude = 7\n')
    assert "direction not known" in read_motions(tmp_path).unusable[0].reason


def test_the_drafted_manifest_has_the_line_to_fill_in(tmp_path):
    write_text(tmp_path, "mine.txt")
    write_text(tmp_path, "three.txt", 3, "# time(s) ch1(g) ch2(g) ch3(g)")
    draft = write_manifest(tmp_path)
    text = draft.read_text(encoding="utf-8")
    assert text.count('# role = "horizontal"   # or "vertical"') == text.count("# azimuth =\n") == 4
    assert len(read_motions(tmp_path).unusable) == 4  # a draft says nothing of its own
    draft.write_text(text.replace('# role = "horizontal"', 'role = "horizontal"'), encoding="utf-8")
    found = read_motions(tmp_path)
    assert [m.name for m in found.motions] == ["mine", "three.ch1", "three.ch2", "three.ch3"]
    assert len(tomllib.loads(draft.read_text(encoding="utf-8"))["record"]) == 4


def test_one_line_in_the_study_or_one_option_speaks_for_a_folder_of_files(tmp_path, capsys):
    records = tmp_path / "records"
    records.mkdir()
    for i in range(1, 8):
        write_text(records, f"rec{i}.txt")
    write_text(records, "known_UP.txt")
    write_study(tmp_path, FOLDER_STUDY)
    with pytest.raises(InputError, match="direction not known"):
        ground_motions(load_study(tmp_path / "study.toml"))
    write_study(tmp_path, FOLDER_STUDY + 'role = "horizontal"\n')
    found = ground_motions(load_study(tmp_path / "study.toml"))
    assert [m.name for m in found.motions] == [f"rec{i}" for i in range(1, 8)]
    assert all("direction not known: horizontal, as stated" in m.notes for m in found.motions)
    assert [u.name for u in found.unusable] == ["known_UP"]  # what is known stays what it is
    assert main(["motions", "--all", str(records)]) == 1
    assert "0 records, 8 files not used" in capsys.readouterr().err
    assert main(["motions", "--all", str(records), "--role", "horizontal"]) == 1
    assert "7 records, 1 file not used" in capsys.readouterr().err


def test_a_study_cannot_say_that_all_unknown_components_are_vertical(tmp_path):
    (tmp_path / "study.toml").write_text(
        f'[pier]\nalpha = 0.13\np = 0.38\n[[case]]\nbase = "rigid"\n[motions]\npath = "{tmp_path}"\nrole = "vertical"\n'
    )
    with pytest.raises(InputError, match='role = "vertical": expected one of "horizontal"'):
        load_study(tmp_path / "study.toml")
    with pytest.raises(InputError, match="one by one"):
        ReadOptions(role="vertical")


@pytest.mark.parametrize(
    ("text", "name"),
    [
        (geonet_text().replace("Component S62W", "Component ????"), "x.V1A"),
        (dyna_text(stream="Q"), "x.ASC"),
        (cosmos_text(direction="Other", scnl=""), "x.V2c"),
    ],
)
def test_agencies_components_of_unknown_direction_are_asked_for_too(tmp_path, text, name):
    (tmp_path / name).write_text(text, encoding="latin-1")
    found = read_motions(tmp_path)
    assert any("direction not known from" in u.reason for u in found.unusable)
    assert all(m.azimuth is not None for m in found.motions)


def test_a_sac_component_that_is_neither_level_nor_upright_is_asked_for(tmp_path):
    for name, inclination in (("a.sac", 90.0), ("b.sac", 30.0), ("c.sac", -90.0)):
        trace = Trace(wiggle().astype(np.float32), {"sampling_rate": 100.0})
        trace.stats.sac = {"cmpaz": -90.0, "cmpinc": inclination}
        trace.write(str(tmp_path / name), format="SAC")
    found = read_motions(tmp_path, options=ReadOptions(unit="g"))
    assert [(m.name, m.azimuth) for m in found.motions] == [("a", 270.0)]
    assert [u.name for u in found.unusable] == ["b", "c"]


@pytest.mark.parametrize(("inclination", "sign"), [(0.0, 1.0), (180.0, -1.0)])
def test_a_sac_component_along_the_plumb_line_is_the_vertical_one_upwards(tmp_path, inclination, sign):
    level, upright = wiggle(), wiggle(seed=2)
    for name, values, inclined in (("a.sac", level, 90.0), ("b.sac", upright, inclination)):
        trace = Trace(values.astype(np.float32), {"sampling_rate": 100.0, "station": "AQK"})
        trace.stats.sac = {"cmpaz": 45.0, "cmpinc": inclined}
        trace.write(str(tmp_path / name), format="SAC")
    (motion,) = read_motions(tmp_path, options=ReadOptions(unit="m/s2")).motions
    assert (motion.name, motion.vertical_source) == ("a", "b.sac")
    np.testing.assert_allclose(motion.vertical, sign * (upright - upright.mean()), atol=1e-6)  # single precision


def test_agencies_numbers_of_one_digit_are_azimuths():
    """5° of an SMC or COSMOS header, or the last field of a PEER title, is no number of a component."""
    found = orientation_of("5")
    assert found is not None
    assert found.azimuth == 5.0


NORTH, EAST = Sensor("S1"), Sensor("S2")


@pytest.mark.parametrize(
    ("sensors", "azimuths", "skew"),
    [
        ((NORTH, NORTH), (10.0, 100.0), False),
        ((NORTH, NORTH), (10.0, 69.5), True),
        ((NORTH, NORTH), (10.0, 70.5), False),
        ((NORTH, NORTH), (10.0, 129.5), False),
        ((NORTH, NORTH), (10.0, 130.5), True),
        ((NORTH, NORTH), (350.0, 80.0), False),
        ((NORTH, NORTH), (350.0, 40.0), True),
        ((NORTH, NORTH), (200.0, 245.0), True),
        ((NORTH, EAST), (10.0, 55.0), False),
        ((NORTH, NORTH), (10.0, 10.0), False),
        ((NORTH, NORTH), (10.0, 190.0), True),
        ((NORTH, NORTH), (None, 55.0), False),
        ((NORTH, NORTH), (10.0, None), False),
    ],
)
def test_two_horizontals_of_one_sensor_are_skew_beyond_30_degrees_off_a_right_angle(sensors, azimuths, skew):
    pair = [
        Component(name, 0.01, wiggle(100), Orientation(name, azimuth=azimuth), sources=(name,), sensor=sensor)
        for name, sensor, azimuth in zip("ab", sensors, azimuths, strict=True)
    ]
    said = _skew_pair(*pair)
    assert bool(said) == skew
    if said:
        assert_states(said, "a", "b", abs(azimuths[0] - azimuths[1]))
