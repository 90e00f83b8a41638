"""Which of the components of a set is the vertical one, where names and headers do not say it plainly."""

from itertools import product
from string import ascii_uppercase

import numpy as np
import pytest
from motion_files import wiggle, write_at2
from waveform_files import channel_xml, station_xml, trace, write_mseed

from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.labels.orientation import in_numbered_sets, split_stem

COMPONENTS = [wiggle(seed=seed) for seed in (1, 2, 3)]


def write_three(folder, names, title="Made-up, 1/17/1994, Test Station"):
    """Write three components that no other one resembles."""
    for name, values in zip(names, COMPONENTS, strict=True):
        write_at2(folder, f"{name}.AT2", values, title=title)


@pytest.mark.parametrize("label", ["HN", "x.HN", "x_H", "x_hor"])
def test_of_names_numbered_to_three_any_may_be_vertical(tmp_path, label):
    write_three(tmp_path, [f"{label}{i}" for i in (1, 2, 3)])
    found = read_motions(tmp_path)
    assert not found.motions
    assert all("direction not known" in file.reason for file in found.unusable)


@pytest.mark.parametrize("end", ["x", "y", "V", "N", "rec", "H1"])
@pytest.mark.parametrize("directions", [("000", "090", "UP"), ("N", "E", "Z")])
def test_an_end_that_all_names_of_a_set_share_is_no_direction(tmp_path, directions, end):
    write_three(tmp_path, [f"a_{way}_{end}" for way in directions])
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == sorted(f"a_{way}_{end}.AT2" for way in directions[:2])
    assert {motion.vertical_source for motion in found.motions} == {f"a_{directions[2]}_{end}.AT2"}
    azimuths = {f"a_{way}_{end}.AT2": azimuth for way, azimuth in zip(directions, (0.0, 90.0), strict=False)}
    assert {motion.source: motion.azimuth for motion in found.motions} == azimuths


@pytest.mark.parametrize(
    ("names", "upright"),
    [
        (("TAKN", "TAKE", "TAKZ"), 2),
        (("eq1_TAKL", "eq1_TAKT", "eq1_TAKV"), 2),
        (("TAK032", "TAK122", "TAKV"), 2),
        (("DAN", "DAV", "KOV"), 0),  # words, of which any letter may be the last
        (("TAK032", "TAK122", "KOBV"), 0),
    ],
)
def test_an_end_glued_to_the_station_is_a_direction_among_three_with_a_vertical(tmp_path, names, upright):
    for seed, name in enumerate(names):
        write_at2(tmp_path, f"{name}.AT2", wiggle(seed=seed), title="nothing said")
    assert [motion.vertical_source for motion in read_motions(tmp_path).motions].count(f"{names[2]}.AT2") == upright


@pytest.mark.parametrize(
    ("names", "title", "azimuth"),
    [
        ([f"GM{letter}" for letter in ascii_uppercase], "nothing said", None),
        (["GMN", "GME", "GMV", "GMA"], "nothing said", None),
        (["GMN", "GME", "GMV", "GM_B"], "nothing said", None),
        (["BRAN", "BRAE", "BRAV"], "Made-up, 1/17/1994, Station {}, 090", 90.0),
        (["VALE", "VALN", "VALZ"], "Made-up, 1/17/1994, Station {}", None),
    ],
)
def test_an_end_glued_to_the_station_is_no_direction_among_more_or_against_a_title(tmp_path, names, title, azimuth):
    for seed, name in enumerate(names):
        write_at2(tmp_path, f"{name}.AT2", wiggle(seed=seed), title=title.format(seed))
    found = read_motions(tmp_path, options=ReadOptions(role="horizontal"))
    assert [(motion.name, motion.azimuth) for motion in found.motions] == [(name, azimuth) for name in sorted(names)]


@pytest.mark.parametrize(("head", "columns"), [("time(s) N(g) E(g) Z(g)", 3), ("Azimuth: 90\ntime(s) acc(g)", 1)])
def test_a_glued_end_is_no_direction_of_tables_that_state_theirs(tmp_path, head, columns):
    for seed, name in enumerate(("BRKE", "BRKN", "BRKV")):
        rows = np.column_stack([0.01 * np.arange(200), *(wiggle(200, 3 * seed + i) for i in range(columns))])
        np.savetxt(tmp_path / f"{name}.txt", rows, "%.6f", header=head)
    found = read_motions(tmp_path)
    assert {motion.station for motion in found.motions} == {"BRKE", "BRKN", "BRKV"}


def test_two_numbered_names_beside_a_vertical_are_horizontal(tmp_path):
    write_three(tmp_path, ["x.HN1", "x.HN2", "x.HNZ"])
    assert [motion.vertical_source for motion in read_motions(tmp_path).motions] == ["x.HNZ.AT2"] * 2


@pytest.mark.parametrize(
    ("names", "used"),
    [
        (("x_NS1", "x_NS2", "x_NS3"), 2),  # letters give the azimuth, and of NS3 nothing is known
        (("x_EW1", "x_EW2", "x_UD3"), 2),
        (("GM_H1", "GM_H2", "GM_H3", "GM_H4"), 2),  # the digits count
        (("x.HN1", "x.HN2", "x.HN3", "x.HNZ"), 2),  # of HN3 nothing is known
    ],
)
def test_a_digit_tells_nothing_where_letters_or_other_files_do(tmp_path, names, used):
    for i, name in enumerate(names):
        write_at2(tmp_path, f"{name}.AT2", wiggle(seed=i + 1), title=f"Made-up, 1/17/1994, Test Station {i}")
    assert len(read_motions(tmp_path).motions) == used


def test_channels_1_and_2_beside_a_vertical_are_horizontal_though_there_is_a_third(tmp_path):
    channels = ("HN1", "HN2", "HN3", "HNZ")
    write_mseed(
        tmp_path / "x.mseed",
        *(trace(c, np.round(1e6 * wiggle(seed=i)).astype("i4")) for i, c in enumerate(channels, 1)),
    )
    station_xml(tmp_path, *(channel_xml(c, None, None) for c in channels))
    used = [(motion.name, motion.vertical_source) for motion in read_motions(tmp_path).motions]
    assert used == [(f"CI.LRL..HN{i}", "x.mseed (CI.LRL..HNZ)") for i in (1, 2)]


@pytest.mark.parametrize("known", [True, False])
def test_angles_tell_which_of_channels_1_to_3_is_vertical(tmp_path, known):
    channels = ("HN1", "HN2", "HN3")
    angles = [(90.0, 0.0), (0.0, -90.0), (0.0, 0.0)] if known else [(0.0, 0.0)] * 3
    write_mseed(
        tmp_path / "x.mseed",
        *(trace(c, np.round(1e6 * a).astype("i4")) for c, a in zip(channels, COMPONENTS, strict=True)),
    )
    station_xml(tmp_path, *(channel_xml(c, *pair) for c, pair in zip(channels, angles, strict=True)))
    found = read_motions(tmp_path)
    if known:
        used = [(motion.name, motion.azimuth, motion.vertical_source) for motion in found.motions]
        assert used == [("CI.LRL..HN1", 90.0, "x.mseed (CI.LRL..HN2)"), ("CI.LRL..HN3", 0.0, "x.mseed (CI.LRL..HN2)")]
    else:
        assert not found.motions
        assert [file.reason.startswith("direction not known") for file in found.unusable] == [True] * 3


@pytest.mark.parametrize("third", ["045", "180"])
def test_a_third_horizontal_that_is_no_combination_of_two_is_remarked(tmp_path, third):
    for folder, values in (("apart", COMPONENTS[2]), ("plane", None)):
        a, b = COMPONENTS[:2]
        angle = np.radians(float(third))
        values = a * np.cos(angle) + b * np.sin(angle) if values is None else values
        for name, samples in (("000", a), ("090", b), (third, values)):
            write_at2(tmp_path / folder, f"x_{name}.AT2", samples)
    doubted = {
        folder: [
            any("no motion in a plane" in note for note in motion.notes) for motion in read_motions(tmp_path / folder)
        ]
        for folder in ("plane", "apart")
    }
    assert doubted == {"plane": [False] * 3, "apart": [True] * 3}
    (tmp_path / "apart" / "motions.toml").write_text(f'[[record]]\nfile = "x_{third}.AT2"\nrole = "vertical"\n')
    assert [motion.vertical_source for motion in read_motions(tmp_path / "apart").motions] == [f"x_{third}.AT2"] * 2


@pytest.mark.parametrize("vertical", range(4))
def test_four_horizontals_that_are_no_motion_in_a_plane_are_remarked(tmp_path, vertical):
    names, angles = ("000", "090", "045", "135"), np.radians((0.0, 90.0, 45.0, 135.0))
    for folder, other in (("apart", COMPONENTS[2]), ("plane", None)):
        for i, (name, angle) in enumerate(zip(names, angles, strict=True)):
            a = COMPONENTS[0] * np.cos(angle) + COMPONENTS[1] * np.sin(angle)
            write_at2(tmp_path / folder, f"x_{name}.AT2", a if other is None or i != vertical else other)
        doubted = [any("plane" in note for note in motion.notes) for motion in read_motions(tmp_path / folder).motions]
        assert doubted == [other is not None] * 4


def test_a_vertical_with_another_number_of_peer_is_of_another_record(tmp_path):
    for name, label, values in zip(
        ("RSN1_X000", "RSN1_X090", "RSN2_X-UP"), ("000", "090", "UP"), COMPONENTS, strict=True
    ):
        write_at2(tmp_path, f"{name}.AT2", values, title=f"Made-up, 1/17/1994, Test Station, {label}")
    found = read_motions(tmp_path)
    assert [motion.vertical_source for motion in found.motions] == ["", ""]
    (unused,) = found.unusable
    assert (unused.source, "(RSN2)" in unused.reason) == ("RSN2_X-UP.AT2", True)


@pytest.mark.parametrize(("sign", "said"), [(-1.0, False), (1.0, True)])
def test_copies_of_a_vertical_upwards_and_downwards_differ_in_sign(tmp_path, sign, said):
    for name, values in zip(("000", "UP", "DWN"), (*COMPONENTS[:2], sign * COMPONENTS[1]), strict=True):
        write_at2(tmp_path, f"x_{name}.AT2", values)
    (motion,) = read_motions(tmp_path).motions
    assert any("the same samples times -1" in note for note in motion.notes) is said


@pytest.mark.parametrize(
    ("line", "label", "sign"),
    [
        ("vertical component positive downwards", "V", -1.0),
        ("Vertical: positive is down", "Z", -1.0),
        ("vertical component positive downwards", "UP", 1.0),
        ("vertical component positive up", "V", 1.0),
        ("vertical axis converted from positive down to positive up", "V", 1.0),
        ("vertical (Z) not positive down but positive up", "Z", 1.0),
        ("vertical component positive up; depth positive down", "V", 1.0),
        ("vertical component positive down until 1990, positive up since", "V", 1.0),
        ("vertical exaggeration of plots 2x, depth axis positive downwards", "V", 1.0),
    ],
)
def test_a_line_of_a_table_s_header_says_that_its_vertical_is_down(tmp_path, line, label, sign):
    rows = [f"{0.01 * i:.2f} {a:.6f} {2.0 * a:.6f}" for i, a in enumerate(COMPONENTS[0])]
    (tmp_path / "x.txt").write_text("\n".join([f"# {line}", f"# t(s) N(g) {label}(g)", *rows, ""]))
    (motion,) = read_motions(tmp_path).motions
    assert motion.vertical is not None
    assert np.allclose(motion.vertical, 2.0 * sign * motion.horizontal, atol=2e-4)
    assert any("positive up, though" in note for note in motion.notes) is (sign > 0.0 and "down" in line)


@pytest.mark.parametrize("form", ["S_{}", "S_{}_rec"])
@pytest.mark.parametrize(("way", "used"), [("V", True), ("UP", False)])
def test_a_line_on_the_sign_is_compared_with_the_file_s_name(tmp_path, form, way, used):
    for stem, values in zip(map(form.format, ("000", "090", way)), COMPONENTS, strict=True):
        rows = "\n".join(f"{a:.6f}" for a in values)
        (tmp_path / f"{stem}.txt").write_text(f"# vertical component positive down\n# unit: g\n# dt = 0.01 s\n{rows}\n")
    found = read_motions(tmp_path)
    assert len(found.motions) == (2 if used else 0)
    for motion in found.motions:
        assert motion.vertical is not None
        assert motion.vertical @ COMPONENTS[2] < 0.0
    assert (
        any('says "vertical down", but its file is called "S_UP' in file.reason for file in found.unusable) is not used
    )


@pytest.mark.parametrize("of_vertical", [True, False])
def test_as_many_samples_at_another_step_are_remarked(tmp_path, of_vertical):
    for i, (label, values) in enumerate(zip(("000", "090", "UP"), COMPONENTS, strict=True)):
        write_at2(tmp_path, f"x_{label}.AT2", values, dt=".0200" if i == (2 if of_vertical else 1) else ".0100")
    said = "x_000.AT2 has as many samples with a step of 0.01 s, not 0.02 s: check which step is right"
    remarks = [
        [note for note in motion.notes if "as many samples" in note] for motion in read_motions(tmp_path).motions
    ]
    assert remarks == ([[f"vertical: {said}"]] * 2 if of_vertical else [[], [said]])


@pytest.mark.parametrize(("station", "used"), [("IBRH11", 0), ("IBR011", 1), ("EQKH10", 1)])
def test_kik_net_s_first_sensor_is_in_a_borehole_in_any_format(tmp_path, station, used):
    rows = "\n".join(f"{a:.6f}" for a in COMPONENTS[0])
    (tmp_path / f"{station}1801241951.EW1.txt").write_text(f"# acceleration in g\n# dt = 0.01 s\n{rows}\n")
    found = read_motions(tmp_path)
    assert len(found.motions) == used
    assert all("is in a borehole" in file.reason for file in found.unusable)


def test_a_vertical_in_a_borehole_is_not_of_the_surface(tmp_path):
    for i, label in enumerate(("NS1", "EW1", "UD1", "NS2", "EW2", "UD2"), 1):
        rows = "\n".join(f"{a:.6f}" for a in wiggle(seed=i))
        (tmp_path / f"IBRH11_{label}.txt").write_text(f"# acceleration in g\n# dt = 0.01 s\n{rows}\n")
    found = read_motions(tmp_path)
    assert [motion.vertical_source for motion in found.motions] == ["IBRH11_UD2.txt"] * 2
    assert [file.name for file in found.unusable] == ["IBRH11_EW1", "IBRH11_NS1"]


def test_a_vertical_of_one_of_two_numbered_records_is_asked_for(tmp_path):
    names = {"RSN1_X000": "000", "RSN2_X090": "090", "X-UP": "UP"}
    for (name, label), values in zip(names.items(), COMPONENTS, strict=True):
        write_at2(tmp_path, f"{name}.AT2", values, title=f"Made-up, 1/17/1994, Test Station, {label}")
    (unused,) = read_motions(tmp_path).unusable
    assert unused.reason == "a vertical component of RSN1 or RSN2: begin its name with the number"


def test_numbers_of_rotated_measures_are_no_azimuths():
    assert split_stem("x_RotD100") == ("x_RotD100", None)
    assert split_stem("x_GMRotI050") == ("x_GMRotI050", None)


@pytest.mark.parametrize("ways", [("NS", "EW", "UD"), ("n", "e", "z"), ("North", "East", "Up")])
@pytest.mark.parametrize("sets", [2, 3])
def test_a_number_behind_the_direction_is_that_of_the_set(tmp_path, ways, sets):
    numbers = range(1, sets + 1)
    for i, (way, number) in enumerate(product(ways, numbers)):
        write_at2(tmp_path, f"site_{way}{number}.AT2", wiggle(seed=i), title="Made-up, 1/17/1994, Test Station")
    found = read_motions(tmp_path)
    of_motions = {(m.source, m.vertical_source, m.azimuth) for m in found.motions}
    assert of_motions == {
        (f"site_{way}{number}.AT2", f"site_{ways[2]}{number}.AT2", azimuth)
        for way, azimuth in zip(ways, (0.0, 90.0), strict=False)
        for number in numbers
    }


def test_numbered_horizontals_with_one_vertical_are_no_sets():
    assert in_numbered_sets(["a_NS1", "a_EW1", "a_UD1", "a_NS2", "a_EW2"]) == {}
    assert in_numbered_sets(["a_N1", "a_E1", "a_N2", "a_E2"]) == {}
    assert in_numbered_sets(["a_H1", "a_V1", "a_H2", "a_V2"]) == {}
    assert in_numbered_sets([f"IBRH11_{way}{sensor}" for way in ("NS", "EW", "UD") for sensor in (1, 2)]) == {}


@pytest.mark.parametrize("names", [("A_000", "A_090", "B_045", "B_135"), ("000", "090", "045", "135")])
def test_columns_of_two_records_in_one_table_need_not_be_in_a_plane(tmp_path, names):
    rows = np.column_stack([0.01 * np.arange(len(COMPONENTS[0])), *COMPONENTS, wiggle(seed=4)])
    np.savetxt(tmp_path / "x.txt", rows, "%.6f", header="time(s) " + " ".join(f"{name}(g)" for name in names))
    found = read_motions(tmp_path).motions
    assert [any("plane" in note for note in motion.notes) for motion in found] == [names[0] == "000"] * 4
