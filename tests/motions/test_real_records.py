"""Real records in agencies' own formats: what a reader must find in them (skipped where they are missing)."""

import hashlib
import json
from collections import Counter
from functools import cache
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from motion_files import RECORDS, needs_records, real_components, real_motions, state_of

from rockbatch.motions import Motion, ReadOptions, fema_p695, read_motions
from rockbatch.motions.alignment import correlation
from rockbatch.motions.component import Component
from rockbatch.motions.formats import RecordFile, read_record
from rockbatch.motions.manifest_draft import write_manifest
from rockbatch.motions.quality.baseline import Offset, remove_offset
from rockbatch.motions.quality.plausible import FARTHEST_MEAN
from rockbatch.motions.sources.stationxml import Inventories

pytestmark = needs_records

G = 9.80665  # the records' own tables are in this g

READABLE = (
    *(".at2", ".mseed", ".sac", ".ew", ".ns", ".ud", ".ew2", ".ns2", ".ud2", ".bbp", ".acc"),
    *(".v1a", ".v2a", ".asc", ".v1", ".v1c", ".v2", ".raw", ".smc"),
)
STATED = {".sac": ReadOptions(unit="g"), ".acc": ReadOptions(unit="m/s2")}


READINGS = Path(__file__).with_name("real_records.txt")
"""A line for each component: source, name, step [s], count, unit, azimuth or V or H, digest of its samples."""


def reading_of(c: Component) -> str:
    """Return the line of a component in ``READINGS``."""
    azimuth = "H" if c.orientation.azimuth is None else f"{c.orientation.azimuth:g}"
    digest = hashlib.sha256(c.acceleration.tobytes()).hexdigest()[:12]
    way = "V" if c.orientation.vertical else azimuth
    return "|".join([c.source, c.name, f"{c.dt:.12g}", str(len(c.acceleration)), c.unit, way, digest])


def test_every_sample_name_step_and_unit_is_as_it_was_when_checked():
    """A line that changes needs its reason in CHANGELOG.md."""
    assert [reading_of(c) for c in real_components("m/s2")] == READINGS.read_text().splitlines()


def described() -> list:
    """One case per component that a meta.json describes, in a format that is read."""
    cases = []
    for meta in sorted(RECORDS.glob("*/*/meta.json")):
        for entry in json.loads(meta.read_text())["components"]:
            path = meta.parent / entry["file"]
            if path.suffix.lower() in READABLE:
                cases.append(pytest.param(path, entry, id=f"{path.parent.name}-{entry['label']}"))
    return cases


@cache
def components(path) -> list[Component]:
    options = STATED.get(path.suffix.lower(), ReadOptions())
    inventories = Inventories([(xml, xml.name, "") for xml in path.parent.glob("*.xml")])
    readings = read_record(RecordFile(path, path.name, path.read_bytes(), options, G, inventories))
    assert all(isinstance(reading, Component) for reading in readings)
    return [remove_offset(reading, Offset()) for reading in readings]


@pytest.mark.parametrize(("path", "entry"), described())
def test_count_step_and_signed_peak_are_those_of_the_description(path, entry):
    found = components(path)
    if len(found) > 1:  # one file of three components, labelled as there, or N, E and U there
        same = [c for c in found if c.orientation.label == entry["label"]]
        found = same or [c for c in found if c.orientation.label[0] == entry["label"][0]]
    (component,) = found
    a = component.acceleration / G
    assert component.orientation.vertical == (entry["kind"] == "V")
    assert len(a) == entry["npts"]
    assert component.dt == pytest.approx(entry["dt"], rel=1e-9)
    # 1 %: offsets are means over the record here, over the first seconds there; peaks are printed to 1e-4 g
    peak = a[np.abs(a).argmax()]
    assert peak == pytest.approx(entry["signed_peak_g"], rel=0.01, abs=6e-5)
    assert np.abs(a).argmax() * component.dt == pytest.approx(entry["t_peak_s"], abs=component.dt / 2 + 0.005)


@pytest.mark.parametrize(
    ("name", "dt", "pga"),
    [
        ("RSN779_LOMAP_LGP000", 0.005, 0.570),
        ("RSN821_ERZINCAN_ERZ-NS", 0.005, 0.515),
        ("RSN825_CAPEMEND_CPM000", 0.02, 1.497),
        ("RSN1086_NORTHR_SYL360", 0.02, 0.843),
        ("RSN1063_NORTHR_RRS228", 0.01, 0.874),
        ("RSN1120_KOBE_TAK000", 0.01, 0.618),
    ],
)
def test_table_1_of_the_paper_has_its_peaks(name, dt, pga):
    motions = {motion.name: motion for motion in real_motions("table1").motions}
    assert motions[name].dt == dt
    assert motions[name].pga / 9.81 == pytest.approx(pga, abs=6e-4)


def test_table_1_has_two_verticals_and_nothing_is_left_over():
    found = real_motions("table1")
    assert len(found.motions) == 6
    assert sorted(motion.vertical_source for motion in found.motions if motion.vertical is not None) == [
        "RSN1063_NORTHR_RRS-UP.AT2",
        "RSN1086_NORTHR_SYL-UP.AT2",
    ]
    assert not found.unusable


def test_the_suite_is_eleven_station_events_of_three_components():
    found = real_motions("suite")
    assert len(found.motions) == 22
    assert sorted(Counter(motion.station for motion in found.motions).values()) == [2] * 11
    assert all(motion.vertical is not None for motion in found.motions)
    assert {unusable.name for unusable in found.unusable} <= {"meta"}


def test_down_verticals_of_the_suite_are_turned():
    turned = [m.name for m in real_motions("suite/at2").motions if any("sign reversed" in n for n in m.notes)]
    assert turned == [
        "RSN164_IMPVALL.H_H-CPE147",
        "RSN164_IMPVALL.H_H-CPE237",
        "RSN57_SFERN_ORR021",
        "RSN57_SFERN_ORR291",
        "RSN70_SFERN_L01021",
        "RSN70_SFERN_L01111",
    ]


def test_manjil_is_cut_to_what_its_components_share():
    motions = {m.name: m for m in real_motions("suite/at2").motions}
    assert motions["RSN1633_MANJIL_ABBAR--L"].npts == 2671
    assert motions["RSN1633_MANJIL_ABBAR--T"].npts == 2300


def test_ground_comes_nearly_to_rest_in_records_whose_offset_was_removed():
    found = real_motions("formats/tohoku2011_tkyh12")
    for motion in found.motions:
        assert abs(motion.horizontal.mean()) < 1e-12


def test_every_file_of_every_agency_is_a_motion_or_has_a_reason():
    found = real_motions("formats", unit="g")
    files = [p for p in (RECORDS / "formats").rglob("*") if p.is_file() and p.suffix != ".xml"]
    told = " ".join([*(m.files for m in found.motions), *(u.source for u in (*found.unusable, *found.left_out))])
    assert [p for p in files if p.relative_to(RECORDS / "formats").as_posix() not in told] == []
    assert not any("reader failed" in u.reason or "direction not known" in u.reason for u in found.unusable)
    assert len({(m.dt, m.horizontal.tobytes()) for m in found.motions}) == len(found.motions) > 30


# All of them: here, so that they are read once


@pytest.mark.slow
def test_no_real_record_is_asked_for():
    found = real_motions()
    assert len(found.motions) > 50
    assert not any("direction not known" in u.reason for u in found.unusable)


@pytest.mark.slow
def test_every_real_record_swings_about_zero_by_a_wide_margin():
    motions = [*real_motions().motions, *real_motions("formats/ridgecrest_csn_t001230", unit="g").motions]
    motions += [Motion(c.name, c.dt, c.acceleration) for c in fema_p695.all_components()]
    assert len(motions) > 150
    shares = [
        abs(samples.mean()) / np.abs(samples).max()
        for motion in motions
        for samples in (motion.horizontal, motion.vertical)
        if samples is not None
    ]
    assert max(shares) < FARTHEST_MEAN / 100
    assert not any(finding.what == "zero line" for motion in motions for finding in motion.findings)


@pytest.mark.slow
def test_needs_of_some_files_cost_nothing_to_formats_that_have_theirs():
    """SAC files need a unit; those beside them from GeoNet, CGS, USGS, DYNA have theirs, in mm/s² and cm/s²."""
    before = {motion.name: motion for motion in real_motions("formats").motions}
    after = {m.name: m for m in real_motions("formats", unit="g").motions}
    assert len(before) > 25
    assert {"20190706031952.CJ.T001230.HNE"} <= after.keys() - before.keys()
    for name, motion in before.items():
        assert after[name].pga == motion.pga


@pytest.mark.slow
def test_all_real_records_at_once_hold_each_recording_once():
    found = real_motions()
    samples = [(motion.dt, motion.horizontal.tobytes()) for motion in found.motions]
    assert len(set(samples)) == len(samples)


@pytest.mark.slow
def test_real_files_of_one_recording_correlate_and_those_of_other_records_do_not():
    """The limit lies between both; halves of a record stand for the parts of a long one."""
    components = real_components()
    short = [component for component in components if len(component.acceleration) < 8000]

    def way(component: Component) -> tuple[object, ...]:
        orientation = component.orientation
        return orientation.vertical, orientation.azimuth, orientation.azimuth is None and orientation.label

    of_one = [
        correlation(one.acceleration, two.acceleration)
        for one, two in combinations(components, 2)
        if one.sensor.may_be_same_as(two.sensor)
        and way(one) == way(two)
        and one.dt == two.dt
        and one.source != two.source
    ]
    of_others = [
        correlation(one.acceleration, two.acceleration)
        for one, two in combinations(short, 2)
        if not one.sensor.may_be_same_as(two.sensor) and one.folder != two.folder and one.dt == two.dt
    ]
    halves = [(c.acceleration[: len(c.acceleration) // 2], c.acceleration[len(c.acceleration) // 2 :]) for c in short]
    assert len(of_one) > 15
    assert min(of_one) > 0.98
    assert len(of_others) > 400
    assert max(of_others) < 0.64
    assert max(correlation(*half) for half in halves) < 0.47


@pytest.mark.parametrize(
    "folder",
    ["table1", *(pytest.param(name, marks=pytest.mark.slow) for name in ("formats", "open", "suite"))],
)
def test_the_draft_of_real_records_loads_and_changes_no_name_and_no_number(tmp_path, folder):
    for path in sorted((RECORDS / folder).rglob("*")):
        target = tmp_path / "copy" / path.relative_to(RECORDS)
        if path.is_file():
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(path.read_bytes())
    write_manifest(tmp_path / "copy" / folder)
    assert state_of(read_motions(tmp_path / "copy" / folder)) == state_of(real_motions(folder)) != []
