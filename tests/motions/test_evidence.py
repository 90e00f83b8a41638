"""Directions by all evidence: what agrees is used, what contradicts itself is held back, and what people state is believed."""

from dataclasses import replace

import numpy as np
import pytest
from agency_files import knet_text
from motion_files import wiggle, write_at2
from waveform_files import channel_xml, station_xml, trace, write_mseed

from rockbatch.common.errors import Contradiction
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.component import Component
from rockbatch.motions.identity.directions import _without_statement
from rockbatch.motions.labels.evidence import Kind, Statement, same_direction
from rockbatch.motions.labels.orientation import Orientation, orientation_in
from rockbatch.motions.manifest_draft import write_manifest

SHAKES = {"a": 1, "b": 2, "c": 3}
"""Seeds of three series that do not resemble each other."""


def write_titled(folder, titles: dict[str, str], station: str = "Town Hall", scale: float = 0.1) -> None:
    """AT2 files of these names, whose titles have these components, each of another series."""
    for seed, (name, component) in enumerate(titles.items(), start=1):
        write_at2(folder, name, wiggle(500, seed, scale), title=f"Big One, 1/17/1994, {station}, {component}")


def write_channels(folder, **angles: tuple[float | None, float | None]) -> None:
    """MiniSEED files of these channels, with the azimuths and dips of a StationXML beside them."""
    lines = []
    for seed, (code, (azimuth, dip)) in enumerate(angles.items(), start=1):
        write_mseed(folder / f"{code}.mseed", trace(code, (wiggle(500, seed) * 1e6).astype(np.int32)))
        line = channel_xml(code, azimuth or 0.0, dip or 0.0)
        line = line.replace("<Azimuth>0.0</Azimuth>", "") if azimuth is None else line
        lines.append(line.replace("<Dip>0.0</Dip>", "") if dip is None else line)
    station_xml(folder, *lines)


def write_sac(folder, **headers: tuple[str, float | None, float | None]) -> None:
    """SAC files of these names: channel, CMPAZ and CMPINC of each."""
    for seed, (name, (channel, azimuth, inclination)) in enumerate(headers.items(), start=1):
        one = trace(channel, wiggle(500, seed).astype(np.float32))
        angles = {"cmpaz": azimuth, "cmpinc": inclination}
        one.stats.sac = {key: value for key, value in angles.items() if value is not None}
        one.write(str(folder / f"{name}.sac"), format="SAC")


def used(folder, **options) -> dict[str, tuple[float | None, str]]:
    """Return azimuth and vertical of what is used, by the file; there must be nothing that is not."""
    found = read_motions(folder, **options)
    assert not found.unusable
    return {motion.source: (motion.azimuth, motion.vertical_source) for motion in found.motions}


def held(folder, **options) -> list[str]:
    """Return why the files of a folder are held back, of which none may be used."""
    found = read_motions(folder, **options)
    assert not found.motions
    assert {unusable.kind for unusable in found.unusable} == {Contradiction}
    return [unusable.reason for unusable in found.unusable]


G = {"options": ReadOptions(unit="g")}


# Headers of three files


@pytest.mark.parametrize("component", ["0", "UP", "LONG", "N45W"])
@pytest.mark.parametrize(
    "names",
    [
        ("x045.AT2", "x135.AT2", "xUP.AT2"),
        ("QUAKE-E.AT2", "QUAKE-N.AT2", "QUAKE-V.AT2"),
        ("a_090_corr.AT2", "a_000_corr.AT2", "a_DWN_corr.AT2"),
        ("sta.nord.txt", "sta.est.txt", "sta.verticale.txt"),
        ("2016_L_sta.AT2", "2016_T_sta.AT2", "2016_UP_sta.AT2"),
    ],
)
def test_a_header_that_was_copied_to_all_files_gives_way_to_their_names(tmp_path, names, component):
    write_titled(tmp_path, dict.fromkeys(names, component))
    first, second, upright = names
    found = read_motions(tmp_path)
    assert not found.unusable
    assert not found.left_out
    assert {motion.source: motion.vertical_source for motion in found.motions} == {first: upright, second: upright}
    assert all("direction" in [finding.what for finding in motion.findings] for motion in found.motions)


def test_a_header_that_was_copied_holds_all_back_where_names_tell_nothing(tmp_path):
    write_titled(tmp_path, dict.fromkeys(("one.AT2", "two.AT2", "three.AT2"), "90"))
    for reason in held(tmp_path):
        assert "other samples" in reason
        assert reason.count(".AT2") >= 2


@pytest.mark.parametrize(
    ("titles", "said"),
    [
        ({"x000.AT2": "UP", "x090.AT2": "90", "x-UP.AT2": "0"}, ('"UP"', "x000.AT2")),
        ({"x000.AT2": "90", "x090.AT2": "0", "x-UP.AT2": "UP"}, ('"90"', "x000.AT2")),
        ({"x000.AT2": "0", "x090.AT2": "45", "x-UP.AT2": "UP"}, ('"45"', "x090.AT2")),
        ({"x000.AT2": "180", "x090.AT2": "90", "x-UP.AT2": "UP"}, ('"180"', "x000.AT2")),
        ({"x000.AT2": "0", "x090.AT2": "90", "x-UP.AT2": "DWN"}, ('"DWN"', "x-UP.AT2")),
        ({"e.AT2": "N", "n.AT2": "E", "z.AT2": "V"}, ('"N"', "e.AT2")),
        ({"NORTE-SUR.AT2": "Este-Oeste", "x090.AT2": "90", "UP.AT2": "UP"}, ('"Este-Oeste"', "NORTE-SUR.AT2")),
    ],
)
def test_a_title_and_a_name_that_contradict_each_other_hold_the_set_back(tmp_path, titles, said):
    write_titled(tmp_path, titles)
    reasons = held(tmp_path)
    assert len(reasons) == 3
    assert any(all(words in reason for words in said) for reason in reasons)
    assert all("motions.toml" in reason for reason in reasons)


def test_what_people_state_is_believed_whatever_header_and_name_say(tmp_path):
    write_titled(tmp_path, {"x000.AT2": "UP", "x090.AT2": "90", "x-UP.AT2": "0"})
    entries = (("x000.AT2", 'role = "vertical"'), ("x-UP.AT2", "azimuth = 0"))
    text = "".join(f'[[record]]\nfile = "{name}"\n{key}\n' for name, key in entries)
    (tmp_path / "motions.toml").write_text(text)
    assert used(tmp_path) == {"x-UP.AT2": (0.0, "x000.AT2"), "x090.AT2": (90.0, "x000.AT2")}
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "x000.AT2"\nuse = false\n')
    assert len(held(tmp_path)) == 2  # x-UP still contradicts itself


def test_columns_that_a_study_states_are_believed_before_the_name(tmp_path):
    rows = "".join(f"{i / 100} {value:.6f}\n" for i, value in enumerate(wiggle(500)))
    (tmp_path / "x090.txt").write_text(rows)
    assert used(tmp_path, options=ReadOptions(unit="g", columns=("time", "000"))) == {"x090.txt": (0.0, "")}


def test_the_draft_of_a_manifest_asks_for_what_contradicts_itself(tmp_path):
    write_titled(tmp_path, {"x000.AT2": "UP", "x090.AT2": "90", "x-UP.AT2": "0"})
    draft = write_manifest(tmp_path)
    text = draft.read_text(encoding="utf-8")
    assert text.count('# role = "horizontal"   # or "vertical": its header says') == 2
    assert len(held(tmp_path)) == 3  # a draft says nothing of its own
    first, second = 'role = "vertical"', 'role = "horizontal"'
    blocks = text.split("[[record]]")
    filled = [block.replace('# role = "horizontal"', first if "x000" in block else second) for block in blocks]
    draft.write_text("[[record]]".join(filled), encoding="utf-8")
    assert used(tmp_path) == {"x-UP.AT2": (0.0, "x000.AT2"), "x090.AT2": (90.0, "x000.AT2")}


@pytest.mark.parametrize(
    ("name", "station", "component"),
    [
        ("STA123.AT2", "STA123", "E"),  # a station's number
        ("Bologna_North.AT2", "Bologna North", "E"),
        ("e.AT2", "Town", "N"),  # five files may be called a to e
        ("x_360.AT2", "Town", "0"),
        ("x_EW.AT2", "Town", "92"),
        ("x_L.AT2", "Town", "270"),
    ],
)
def test_names_that_may_mean_something_else_contradict_nothing(tmp_path, name, station, component):
    write_titled(tmp_path, {name: component}, station)
    assert list(used(tmp_path)) == [name]


def test_another_set_of_the_folder_is_used_all_the_same(tmp_path):
    write_titled(tmp_path, {"x000.AT2": "UP", "x090.AT2": "90", "x-UP.AT2": "0"})
    write_titled(tmp_path, {"y000.AT2": "0", "y-UP.AT2": "UP"}, "Church", 0.2)
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["y000.AT2"]
    assert len(found.unusable) == 3


def test_a_copy_under_another_direction_is_a_copy_all_the_same(tmp_path):
    for name in ("x000.AT2", "x090.AT2"):
        write_at2(tmp_path, name, wiggle(500), title="Big One, 1/17/1994, Town Hall, 0")
    found = read_motions(tmp_path)
    assert [(motion.source, motion.azimuth) for motion in found.motions] == [("x000.AT2", 0.0)]
    assert found.left_out[0].reason.startswith("a copy of x000.AT2, which is used")


def test_a_file_of_k_net_whose_suffix_is_not_its_direction_is_held_back(tmp_path):
    for seed, (direction, suffix) in enumerate((("E-W", "EW"), ("U-D", "NS"), ("N-S", "UD")), start=1):
        (tmp_path / f"TST0031801241951.{suffix}").write_text(knet_text(direction, seed=seed)[0])
    assert any("TST0031801241951.NS" in reason for reason in held(tmp_path))


# Sets of one station


def test_two_sets_of_one_header_are_two_records_if_their_names_tell_them_apart(tmp_path):
    for seed, run in ((10, "run1"), (20, "run2")):
        for k, way in enumerate(("000", "090", "UP")):
            write_at2(
                tmp_path, f"{run}_{way}.AT2", wiggle(500, seed + k), title=f"Big One, 1/17/1994, Town Hall, {way}"
            )
    found = read_motions(tmp_path)
    assert {motion.source: motion.vertical_source for motion in found.motions} == {
        f"run{i}_{way}.AT2": f"run{i}_UP.AT2" for i in (1, 2) for way in ("000", "090")
    }
    assert all("header" in [finding.what for finding in motion.findings] for motion in found.motions)


def test_two_sensors_of_a_station_have_a_set_each_though_they_point_alike(tmp_path):
    lines = []
    for location, seed in (("00", 1), ("10", 11)):
        for k, (code, azimuth, dip) in enumerate((("HNE", 90.0, 0.0), ("HNN", 0.0, 0.0), ("HNZ", 0.0, -90.0))):
            one = trace(code, (wiggle(500, seed + k) * 1e6).astype(np.int32))
            one.stats.location = location
            write_mseed(tmp_path / f"{location}.{code}.mseed", one)
            lines.append(channel_xml(code, azimuth, dip).replace('locationCode=""', f'locationCode="{location}"'))
    station_xml(tmp_path, *lines)
    assert used(tmp_path) == {
        f"{location}.{code}.mseed": (azimuth, f"{location}.HNZ.mseed")
        for location in ("00", "10") for code, azimuth in (("HNE", 90.0), ("HNN", 0.0))
    }  # fmt: skip


def test_stations_of_one_code_in_two_networks_are_told_apart_by_these(tmp_path):
    for seed, network in ((1, "XX"), (5, "YY")):
        for k, code in enumerate(("HNE", "HNZ")):
            one = trace(code, wiggle(500, seed + k).astype(np.float32))
            one.stats.network = network
            one.write(str(tmp_path / f"{network}.{code}.mseed"), format="MSEED")
    found = read_motions(tmp_path, **G)
    assert [motion.station for motion in found.motions] == ["XX.LRL", "YY.LRL"]


# Angles


@pytest.mark.parametrize(
    ("angles", "azimuths"),
    [
        ({"HNE": (0.0, 0.0), "HNN": (0.0, 0.0), "HNZ": (0.0, 0.0)}, (90.0, 0.0)),  # all default
        ({"HNE": (0.0, None), "HNN": (0.0, None), "HNZ": (0.0, None)}, (90.0, 0.0)),
        ({"HN1": (0.0, 0.0), "HN2": (0.0, 0.0), "HNZ": (0.0, 0.0)}, (None, None)),
        ({"HN1": (0.0, 0.0), "HN2": (90.0, 0.0), "HNZ": (0.0, -90.0)}, (0.0, 90.0)),  # north is north
        ({"HN1": (33.0, None), "HN2": (123.0, None), "HNZ": (0.0, None)}, (33.0, 123.0)),  # without a dip
        ({"HNE": (120.0, 0.0), "HNN": (30.0, 0.0), "HNZ": (0.0, -90.0)}, (120.0, 30.0)),  # turned
        ({"HNE": (270.0, 0.0), "HNN": (0.0, 0.0), "HNZ": (0.0, 90.0)}, (270.0, 0.0)),  # reversed
        ({"HNX": (33.0, 0.0), "HNY": (303.0, 0.0), "HNZ": (0.0, -90.0)}, (33.0, 303.0)),
    ],
)
def test_angles_are_believed_but_for_those_that_programs_write_by_default(tmp_path, angles, azimuths):
    write_channels(tmp_path, **angles)
    first, second, _ = angles
    assert used(tmp_path) == {
        f"{code}.mseed": (azimuth, "HNZ.mseed") for code, azimuth in zip((first, second), azimuths, strict=True)
    }


@pytest.mark.parametrize(
    ("angles", "said"),
    [
        ({"HNE": (0.0, 0.0), "HNN": (90.0, 0.0), "HNZ": (0.0, -90.0)}, ('channel "HNN"', "azimuth 90°")),  # exchanged
        ({"HNE": (90.0, 0.0), "HNN": (0.0, 0.0), "HNZ": (45.0, 0.0)}, ('channel "HNZ"', "azimuth 45°")),
        ({"HNE": (90.0, -90.0), "HNN": (0.0, 0.0), "HNZ": (90.0, 0.0)}, ('channel "HNE"', "dip -90°")),
        ({"HNE": (90.0, None), "HNN": (0.0, None), "HNZ": (90.0, None)}, ('channel "HNZ"', "azimuth 90°")),
        ({"HN1": (45.0, 0.0), "HN2": (45.0, 0.0), "HNZ": (0.0, -90.0)}, ("azimuth 45°", "other samples")),
    ],
)
def test_angles_that_contradict_codes_or_samples_hold_the_set_back(tmp_path, angles, said):
    write_channels(tmp_path, **angles)
    reasons = held(tmp_path)
    assert len(reasons) == 3
    assert any(all(words in reason for words in said) for reason in reasons)


@pytest.mark.parametrize(("turned", "remarked"), [(0.0, False), (4.0, False), (6.0, True), (-30.0, True)])
def test_angles_are_remarked_on_only_where_they_differ_from_their_codes(tmp_path, turned, remarked):
    write_channels(tmp_path, HNE=(90.0 + turned, 0.0), HNN=(turned % 360.0, 0.0))
    found = read_motions(tmp_path, options=ReadOptions(sensitivity=1e6))
    texts = [finding.text for motion in found.motions for finding in motion.findings if finding.what == "direction"]
    assert [text.count("decided by: these angles") for text in texts] == [1] * (2 * remarked)
    for code, azimuth in zip(("HNE", "HNN"), (90.0 + turned, turned % 360.0), strict=True):
        assert remarked == any(f'"{code}"' in text and f"{azimuth:g}°" in text for text in texts)
    (tmp_path / "motions.toml").write_text(
        "".join(f'[[record]]\nfile = "{n}.mseed"\nuse = true\n' for n in ("HNE", "HNN"))
    )
    found = read_motions(tmp_path, options=ReadOptions(sensitivity=1e6))
    assert [motion.azimuth for motion in found.motions] == [90.0 + turned, turned % 360.0]
    assert "direction" not in [finding.what for motion in found.motions for finding in motion.findings]


@pytest.mark.parametrize(
    ("headers", "expected"),
    [
        ({"e": ("HNE", 328.0, 90.0), "n": ("HNN", 238.0, 90.0), "z": ("HNZ", 0.0, 0.0)}, {"e": 328.0, "n": 238.0}),
        ({"e": ("HNE", 0.0, 0.0), "n": ("HNN", 0.0, 0.0), "z": ("HNZ", 0.0, 0.0)}, {"e": 90.0, "n": 0.0}),
        ({"e": ("HNE", 0.0, 90.0), "n": ("HNN", 0.0, 90.0), "z": ("HNZ", 0.0, 90.0)}, {"e": 90.0, "n": 0.0}),
        ({"r1": ("HN1", 10.0, None), "r2": ("HN2", 100.0, None), "z": ("HNZ", None, None)}, {"r1": 10.0, "r2": 100.0}),
        ({"p": ("", 90.0, 90.0), "q": ("", 0.0, 90.0), "z": ("", 0.0, 0.0)}, {"p": 90.0, "q": 0.0}),
    ],
)
def test_angles_of_sac_are_believed_but_for_those_that_are_not_set(tmp_path, headers, expected):
    write_sac(tmp_path, **headers)
    assert used(tmp_path, **G) == {f"{name}.sac": (azimuth, "z.sac") for name, azimuth in expected.items()}


def test_a_vertical_of_sac_with_an_inclination_of_180_is_positive_down(tmp_path):
    write_sac(tmp_path, e=("HNE", 90.0, 90.0), z=("HNZ", 0.0, 180.0))
    (motion,) = read_motions(tmp_path, **G).motions
    raw = wiggle(500, 2) * 9.81
    np.testing.assert_allclose(motion.vertical, raw.mean() - raw, atol=1e-6)  # single precision


@pytest.mark.parametrize(
    "headers",
    [
        {"e": ("HNE", 0.0, 90.0), "n": ("HNN", 90.0, 90.0), "z": ("HNZ", 0.0, 0.0)},
        {"e": ("HNE", 90.0, 90.0), "n": ("HNN", 0.0, 90.0), "z": ("HNZ", 60.0, 90.0)},
        {"x.HNZ": ("HNE", 90.0, 90.0), "x.HNN": ("HNN", 0.0, 90.0), "x.HNE": ("HNZ", 0.0, 0.0)},  # swapped files
        {"x.090": ("HNE", 37.0, 90.0), "x.000": ("HNN", 0.0, 90.0), "x.UP": ("HNZ", 0.0, 0.0)},
    ],
)
def test_angles_of_sac_that_contradict_channels_or_names_hold_the_set_back(tmp_path, headers):
    write_sac(tmp_path, **headers)
    assert len(held(tmp_path, **G)) == 3


# Verticals


def pair_with(folder, upright) -> None:
    for name, values in (("x000.AT2", wiggle(500, 1)), ("x090.AT2", wiggle(500, 2)), ("x-UP.AT2", upright)):
        way = {"x000": "0", "x090": "90", "x-UP": "UP"}[name.removesuffix(".AT2")]
        write_at2(folder, name, values, title=f"Big One, 1/17/1994, Town Hall, {way}")


@pytest.mark.parametrize("upright", [np.zeros(500), np.full(500, 0.02)])
def test_a_dead_vertical_does_not_count_as_one(tmp_path, upright):
    pair_with(tmp_path, upright)
    found = read_motions(tmp_path)
    assert [motion.vertical for motion in found.motions] == [None, None]
    assert all("x-UP.AT2: it never moves" in motion.notes[0] for motion in found.motions)
    assert [unusable.source for unusable in found.unusable] == ["x-UP.AT2"]
    assert not read_motions(tmp_path, vertical="required").motions


@pytest.mark.parametrize(
    ("upright", "said"),
    [
        (wiggle(500, 2), "has the samples of the horizontal one x090"),
        (-wiggle(500, 1), "has the samples of the horizontal one x000"),
        (20.0 * wiggle(500, 3), "20 times that of the horizontal ones"),
        (wiggle(500, 3) / 96.0, "0.0104 times that of the horizontal ones"),
        (np.append(np.zeros(4), wiggle(500, 2)), "has the samples of the horizontal one x090, 0.04 s later: check"),
        (-wiggle(500, 1)[7:], "has the samples of the horizontal one x000 times -1, 0.07 s earlier: check"),
        (9.81 * wiggle(500, 2), "has the samples of the horizontal one x090 times 9.81: check"),
        (0.01 * np.random.default_rng(1).standard_normal(500), "noise"),
    ],
)
def test_a_vertical_that_is_none_of_this_ground_holds_its_motions_back(tmp_path, upright, said):
    pair_with(tmp_path, upright)
    found = read_motions(tmp_path)
    assert not found.motions
    assert all(said in unusable.reason for unusable in found.unusable)
    assert len(read_motions(tmp_path, confirmed=["*"]).motions) == 2
    assert len(read_motions(tmp_path, vertical=False).motions) == 2


def test_a_vertical_that_is_a_share_of_the_horizontal_one_is_used_and_says_so(tmp_path):
    """As codes once had it: two thirds."""
    pair_with(tmp_path, 2.0 / 3.0 * wiggle(500, 1))
    found = read_motions(tmp_path)
    assert len(found.motions) == 2
    assert all(finding.text.count("x000 times 0.667") for motion in found.motions for finding in motion.findings)


@pytest.mark.parametrize(
    ("upright", "said"),
    [
        (-0.5 * np.append(np.zeros(9), wiggle(500, 1)), "the horizontal one x000 times -0.5, 0.09 s later: check"),
        (
            0.5 * 9.81 * wiggle(500, 3),
            ", as in few records; m/s² under a header of g make it 9.81 times: check its unit",
        ),
        (wiggle(500, 3) / 9.81, "is 0.102 times that of the horizontal ones, as in few records; "),
        (2.5 * wiggle(500, 3), ""),
        (0.2 * wiggle(500, 3), ""),
    ],
)
def test_a_vertical_of_another_unit_or_delay_is_a_finding_unless_its_size_is_usual(tmp_path, upright, said):
    pair_with(tmp_path, upright)
    found = read_motions(tmp_path)
    assert len(found.motions) == 2
    for motion in found:
        texts = [finding.text for finding in motion.findings if finding.what == "vertical"]
        assert [said in text for text in texts] == ([True] if said else [])


def test_a_horizontal_that_is_a_delayed_copy_of_the_other_one_is_a_finding(tmp_path):
    for way, values in (("000", wiggle(500, 1)), ("090", -0.7 * np.append(np.zeros(5), wiggle(500, 1)))):
        write_at2(tmp_path, f"x{way}.AT2", values, title=f"Big One, 1/17/1994, Town Hall, {way}")
    first, second = read_motions(tmp_path)
    assert any("samples of x090 times -1.43, 0.05 s earlier, square to it" in note for note in first.notes)
    assert any("samples of x000 times -0.7, 0.05 s later, square to it" in note for note in second.notes)


def test_waves_of_one_period_are_no_copies_of_each_other(tmp_path):
    """A cosine is a sine that comes a quarter of its period earlier."""
    times = 0.01 * np.arange(1500)
    burst = np.exp(-np.square((times - 7.0) / 4.0))
    for way, wave in (("000", np.sin), ("090", np.cos)):
        title = f"Big One, 1/17/1994, Town Hall, {way}"
        write_at2(tmp_path, f"x{way}.AT2", 0.2 * burst * wave(2.0 * np.pi * times / 2.0), title=title)
    assert not [finding for motion in read_motions(tmp_path) for finding in motion.findings if finding.what == "copy"]


# Copies


def test_a_copy_of_what_is_not_used_does_not_say_that_it_is(tmp_path):
    for folder in ("first", "second"):
        for seed, way in enumerate(("0", "90", "UP"), start=1):
            text = f"Big One, 1/17/1994, Town Hall Roof, {way}"
            write_at2(
                tmp_path / folder,
                f"x{way}.AT2".replace("x0.", "x000.").replace("x90", "x090"),
                wiggle(500, seed),
                title=text,
            )
    found = read_motions(tmp_path)
    assert (len(found.motions), len(found.left_out)) == (0, 3)
    for copy in found.left_out:
        assert copy.of in copy.reason
        assert "which is not used either" in copy.reason
    confirmed = read_motions(tmp_path, confirmed=["*"])
    assert all("which is used" in copy.reason for copy in confirmed.left_out)


def test_columns_of_one_label_hold_their_table_back(tmp_path):
    rows = "".join(
        f"{i / 100} {a:.6f} {b:.6f}\n" for i, (a, b) in enumerate(zip(wiggle(500, 1), wiggle(500, 2), strict=True))
    )
    (tmp_path / "x.txt").write_text("time(s) North-South(g) N-S(g)\n" + rows)
    assert all("one direction, but other samples" in reason for reason in held(tmp_path))


@pytest.mark.parametrize("second", [45.0, 225.0, 75.0])
def test_two_horizontals_of_a_sensor_that_are_not_square_hold_their_set_back(tmp_path, second):
    write_channels(tmp_path, HN1=(45.0, 0.0), HN2=(second, 0.0), HNZ=(0.0, -90.0))
    assert len(held(tmp_path)) == 3


def test_two_horizontals_with_the_same_samples_say_so(tmp_path):
    for name, way in (("x000.AT2", "0"), ("x090.AT2", "90")):
        write_at2(tmp_path, name, wiggle(500), title=f"Big One, 1/17/1994, Town Hall, {way}")
    found = read_motions(tmp_path)
    assert [[finding.what for finding in motion.findings] for motion in found.motions] == [["copy"], ["copy"]]


def test_a_draft_has_azimuths_in_full(tmp_path):
    write_sac(tmp_path, a=("HNE", 93.45678, 90.0), b=("HNN", 3.5, 90.0))
    options = ReadOptions(unit="m/s2")
    before = used(tmp_path, options=options)
    assert "azimuth = 3.5\n" in write_manifest(tmp_path, options).read_text(encoding="utf-8")
    assert used(tmp_path, options=options) == before


def test_a_void_angle_leaves_the_direction_to_what_else_tells_it_or_to_nothing():
    void = Statement(Kind.ANGLES, "azimuth 0°", Orientation("0", azimuth=0.0), default=True)
    code = Statement(Kind.NAME, 'channel "HNE"', Orientation("HNE", azimuth=90.0))
    bare = Component("c", 0.01, wiggle(100), Orientation("0", azimuth=0.0), statements=(void,))
    for component, azimuth, instead in (
        (bare, None, "its azimuth is stated nowhere else"),
        (replace(bare, statements=(void, code)), 90.0, 'decided by: channel "HNE"'),
    ):
        found = _without_statement(component, void, "all say so")
        assert found.orientation.azimuth == azimuth
        assert found.findings[-1].text == f"azimuth 0°, which tells nothing (all say so); {instead}"


@pytest.mark.parametrize(
    ("first", "second", "same"),
    [
        ("UP", "DOWN", True),
        ("UP", "N", False),
        ("N", "360", True),
        ("S89E", "90", True),
        ("S88E", "90", False),
        ("359", "001", False),
        ("N", "S", False),
        ("L", "l", True),
        ("L", "T", False),
        ("L", "N", False),
        ("12", "12", False),  # behind a word it may count components
        ("nobody", "nobody", False),
    ],
)
def test_directions_are_the_same_if_both_are_known_and_agree_within_a_degree(first, second, same):
    one, other = map(orientation_in, (first, second))
    assert same_direction(one, other) is same_direction(other, one) is same


@pytest.mark.parametrize("label", ["L", "000"])
def test_an_unknown_direction_is_not_that_of_a_known_one_of_its_label(label):
    known = orientation_in(label)
    for pair in ((known, replace(known, known=False)), (replace(known, known=False), known)):
        assert not same_direction(*pair)
    assert not same_direction(Orientation(""), Orientation(""))
