"""Components of one station in one earthquake are one record, wherever and however often its files lie."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from motion_files import wiggle

import rockbatch as rb
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.component import Component, Sensor
from rockbatch.motions.identity import stations
from rockbatch.motions.identity.stations import station_names
from rockbatch.motions.labels.orientation import Orientation

RECORDS = Path(rb.__file__).parents[1] / "motions" / "near_fault"
WTMC = RECORDS / "kaikoura2016_wtmc" / "20161113_110259_WTMC_20.V2A"
HOUR = 3600.0 * 300_000  # in 2004
NOISE = np.random.default_rng(1)


def component(name: str, *, samples: int = 500, **more: object) -> Component:
    return Component(name, 0.01, NOISE.normal(size=samples), Orientation("H", azimuth=0.0), **more)


def text_record(path: Path, samples: np.ndarray) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    rows = [f"{0.01 * i:.2f} {value:.6f}" for i, value in enumerate(samples)]
    path.write_text("time 000\n" + "\n".join(rows) + "\n")


def counted(path: Path, **more: object) -> dict[str, int]:
    """How many horizontal components each station has."""
    found = [motion.station for motion in rb.read_motions(path, **more).motions]
    return {station: found.count(station) for station in found}


def test_the_packaged_records_are_five_stations_of_two_components():
    assert counted(RECORDS) == {"NBLC": 2, "PRPC": 2, "1336": 2, "HSES": 2, "WTMC": 2}


def test_every_angle_that_a_pair_is_turned_to_is_a_direction_of_its_station():
    assert counted(WTMC.parent, azimuths=(0.0, 30.0, 60.0)) == {"WTMC": 3}


def test_a_station_whose_files_are_used_twice_counts_once(tmp_path):
    """A manifest may say that both are used; they are one record all the same."""
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        shutil.copy(WTMC, tmp_path / name)
    assert counted(tmp_path) == {"WTMC": 2}
    for name in ("a", "b"):
        (tmp_path / name / "motions.toml").write_text(f'[[record]]\nfile = "{WTMC.name}"\nuse = true\n')
    assert counted(tmp_path) == {"WTMC": 4}


def test_a_scaled_copy_is_of_the_station_that_it_copies(tmp_path):
    """Nothing in the file says so, and its name neither; its samples do, as far as they are printed."""
    wave = NOISE.normal(size=400)
    for name, samples in (("quake/one", wave), ("twice/half as much again", -1.5 * wave), ("else/other", wave[::-1])):
        text_record(tmp_path / f"{name}.txt", samples)
    stations = [motion.station for motion in rb.read_motions(tmp_path, options=ReadOptions(unit="m/s2")).motions]
    assert len(stations) == 3
    assert len(set(stations)) == 2


def test_two_formats_of_one_recording_are_one_record_by_their_headers():
    """Corrected and uncorrected files name stations differently, and lie in folders of their own."""
    v1 = component("v1", station="LGPC, uncorrected", folder="/v1", sensor=Sensor("LGPC"), event="1989", samples=480)
    v2 = component("v2", station="LGPC, corrected", folder="/v2", sensor=Sensor("lgpc", "CI"), event="1989")
    sac = component("sac", station="CI.LGPC.00", folder="/sac", sensor=Sensor("LGPC", "CI"), start=5.0)
    later = component("later", station="CI.LGPC.00", folder="/sac", sensor=Sensor("LGPC", "CI"), start=500.0)
    names = station_names([[v1], [v2], [sac], [later]])
    assert names[0] == names[1]
    assert len(set(names)) == 3, "without a time in common nothing says that they are of one event"


@pytest.mark.parametrize("short", [-10.0, 1.0])
def test_recordings_across_a_full_hour_are_one_earthquake_if_they_overlap(short):
    """The long one lasts from 15 s before it to 15 s after it; what begins with its last sample is another."""
    long = component("long", sensor=Sensor("S", location="00"), start=HOUR - 15.0, samples=3000)
    found = [
        long,
        component("short", sensor=Sensor("S", location="10"), start=HOUR + short, samples=200),
        component("later", sensor=Sensor("S", location="20"), start=long.start + long.duration, samples=200),
    ]
    names = station_names([[each] for each in found])
    assert names[0] == names[1] != names[2]


@pytest.mark.parametrize(
    ("more", "stations"),
    [
        ([{"site": "RSN825", "folder": "/a"}, {"site": "RSN825", "folder": "/b"}], 1),
        ([{"site": "RSN825"}, {"site": "RSN828"}], 2),
        (
            [{"site": "LGPC", "folder": "/a"}, {"site": "LGPC", "folder": "/b"}],
            2,
        ),  # by name alone: two earthquakes, maybe
        ([{"sensor": Sensor("LGPC"), "event": "A"}, {"sensor": Sensor("LGPC"), "event": "B"}], 2),
        ([{"sensor": Sensor("7", "CI"), "event": "A"}, {"sensor": Sensor("7", "NC"), "event": "A"}], 2),
        # Parts of a long recording, and sensors of a structure, shake in one earthquake
        ([{"station": "S", "folder": "/a", "event": "1994"}, {"station": "S", "folder": "/a", "event": "1994"}], 1),
        ([{"station": "S", "folder": "/a"}, {"station": "S", "folder": "/a"}], 2),  # at times that nobody knows
        (
            [
                {"sensor": Sensor("S", location="00"), "event": "A"},
                {"sensor": Sensor("S", location="10"), "event": "A"},
            ],
            1,
        ),
    ],
)
def test_what_headers_and_names_say_decides(more, stations):
    found = station_names([[component(f"c{i}", **each)] for i, each in enumerate(more)])
    assert len(set(found)) == stations


@pytest.mark.parametrize("when", [lambda i: {"event": f"E{i}"}, lambda i: {"start": 1e9 + 86400.0 * i}, lambda i: {}])
def test_records_of_a_station_in_many_earthquakes_are_not_all_compared(monkeypatch, when):
    compared = []
    together = stations._share_record
    monkeypatch.setattr(stations, "_share_record", lambda a, b: compared.append(1) or together(a, b))
    records = [[component(f"c{i}", station="S", folder="/a", sensor=Sensor("7"), **when(i))] for i in range(200)]
    assert len(set(station_names(records))) == 200
    assert len(compared) < 1000


def test_several_records_of_one_station_differ_in_event_time_or_folder():
    kobe, niigata = ([component("c", sensor=Sensor("TAK"), event=event)] for event in ("1995", "2004"))
    assert station_names([kobe, niigata]) == ["TAK 1995", "TAK 2004"]
    july, august = ([component("c", sensor=Sensor("TAK"), start=moment)] for moment in (1562383163.0, 1565061563.0))
    assert station_names([july, august]) == ["TAK 2019-07-06 03:19", "TAK 2019-08-06 03:19"]
    one, two = ([component("c", site="LGP", folder=f"/{folder}")] for folder in ("loma", "other"))
    assert station_names([one, two]) == ["LGP loma", "LGP other"]
    assert station_names([[component("x")], [component("x")]]) == ["x", "x (2)"]


@pytest.mark.parametrize(
    ("given", "named"), [(["x", "x", "x (2)"], ["x", "x (3)", "x (2)"]), (["x (2)", "x", "x"], ["x (2)", "x", "x (3)"])]
)
def test_a_number_gives_no_station_the_name_of_another(given, named):
    assert station_names([[component(name)] for name in given]) == named


def test_a_motion_that_is_made_in_python_is_a_record_of_its_own():
    assert rb.pulse("sine", name="p", amplitude=1.0, period=1.0, dt=0.01, duration=2.0).of_station == "p"


def test_a_pair_that_was_turned_to_directions_before_it_is_read_is_one_station(tmp_path):
    """Of three, one is a combination of the others; two may be any two components, and noise is none."""
    rng = np.random.default_rng(1)
    first, second, other = rng.normal(size=(3, 400))
    for degrees in (20, 50, 80, 110):
        angle = np.radians(degrees)
        text_record(tmp_path / f"ST{degrees}_000.txt", np.cos(angle) * first + np.sin(angle) * second)
    text_record(tmp_path / "OTHER_000.txt", 0.6 * first + 0.8 * other)
    assert sorted(counted(tmp_path, options=ReadOptions(unit="m/s2")).values()) == [1, 4]
    for name in ("ST20_000.txt", "ST110_000.txt"):
        (tmp_path / name).unlink()
    assert sorted(counted(tmp_path, options=ReadOptions(unit="m/s2")).values()) == [1, 1, 1]


@pytest.mark.parametrize(
    ("starts", "events", "same"),
    [
        ((HOUR, HOUR + 4.0), ("A", "B"), True),
        ((HOUR, HOUR + 6.0), ("A", "A"), False),
        ((HOUR, None), ("A", "A"), True),
        ((HOUR, None), ("A", "B"), False),
        ((None, None), ("", ""), False),
    ],
)
def test_two_components_are_of_one_event_by_their_times_else_by_what_headers_say(starts, events, same):
    """Each lasts five seconds."""
    one, other = (component("x", start=start, event=event) for start, event in zip(starts, events, strict=True))
    assert stations.in_one_event(one, other) is same


@pytest.mark.parametrize(
    ("events", "azimuths", "records"),
    [(("A", "A"), (0.0, 0.0), 1), (("", ""), (0.0, 90.0), 1), (("A", ""), (0.0, 90.0), 1), (("", "A"), (0.0, 0.0), 2)],
)
def test_components_without_times_are_one_record_unless_one_repeats_a_direction(events, azimuths, records):
    """An event that both headers state is as good as a time."""
    both = [
        replace(
            component("x", event=event, site=f"site {i}", sources=(f"x{i}.txt",)),
            orientation=Orientation("H", azimuth=azimuth),
        )
        for i, (event, azimuth) in enumerate(zip(events, azimuths, strict=True))
    ]
    assert len(stations._by_time(both)) == records


def test_a_number_at_the_end_of_a_file_of_three_components_is_the_station_s(tmp_path):
    for seed, station in enumerate(("ce12149", "ce12170")):
        columns = [wiggle(200, 3 * seed + k) for k in (1, 2, 3)]
        rows = "".join(
            f"{0.01 * i:.2f} {a:.6f} {b:.6f} {c:.6f}\n" for i, (a, b, c) in enumerate(zip(*columns, strict=True))
        )
        (tmp_path / f"{station}.txt").write_text("time(s) N(g) E(g) Z(g)\n" + rows)
    assert {motion.of_station for motion in read_motions(tmp_path)} == {"ce12149", "ce12170"}


@pytest.mark.parametrize(
    ("horizontals", "vertical"),
    [("T068_horizontal.txt", "T068_vertical.txt"), ("TAF021.txt", "TAF-UP.txt"), ("P_H.txt", "P_V.txt")],
)
def test_both_horizontals_in_one_file_have_the_vertical_beside_it(tmp_path, horizontals, vertical):
    for name, head, seeds in ((horizontals, "N(g) E(g)", (1, 2)), (vertical, "Z(g)", (3,))):
        rows = np.column_stack([0.01 * np.arange(200), *(wiggle(200, seed) for seed in seeds)])
        np.savetxt(tmp_path / name, rows, "%.6f", header=f"time(s) {head}")
    assert [motion.vertical_source for motion in read_motions(tmp_path)] == [vertical] * 2


@pytest.mark.parametrize(
    ("lines", "upright"),
    [
        ("Station: ABC", 2),
        ("Station: ABC\nMax. acceleration 0.9{} g at 5.0{} s\nNPTS = 200", 2),
        ("Station: ABC\nDate: {}", 0),
        ("Station: ABC\nTrigger: 2019-07-0{} 03:19:53, dt = 0.01 s", 0),
        ("Station: ABC\nMagnitude: 5.{}", 0),
        ("Station: ABC\nSensor depth: {}0 m", 0),
        ("Memo: ABC", 0),
    ],
)
def test_tables_of_one_station_and_time_by_their_headers_are_one_record(tmp_path, lines, upright):
    for i, way in enumerate(("N-S", "E-W", "Up")):
        rows = "".join(f"{a:.6f}\n" for a in wiggle(seed=i))
        head = f"{lines.format(i, i)}\nComponent: {way}\nacceleration (g)\ndt = 0.01 s\n"
        (tmp_path / f"A{i}.txt").write_text(head + rows)
    assert [motion.vertical_source for motion in read_motions(tmp_path).motions].count("A2.txt") == upright


@pytest.mark.parametrize(("folders", "upright"), [(("", ""), 0), (("first", "second"), 4)])
def test_of_two_sets_of_one_station_without_dates_each_needs_its_folder(tmp_path, folders, upright):
    for i, way in enumerate(("N-S", "E-W", "Up") * 2):
        rows = "".join(f"{a:.6f}\n" for a in wiggle(seed=i))
        (tmp_path / folders[i // 3]).mkdir(exist_ok=True)
        text = f"Station: ABC\nComponent: {way}\nacceleration (g)\ndt = 0.01 s\n{rows}"
        (tmp_path / folders[i // 3] / f"A{i}.txt").write_text(text)
    found = read_motions(tmp_path)
    assert sum(motion.vertical is not None for motion in found.motions) == upright
    reasons = [one.reason for one in found.unusable]
    said = "a vertical component of one of several sets that state one station: give each set a folder of its own"
    assert reasons == [said] * (0 if upright else 2)
