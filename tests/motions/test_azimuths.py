"""Pairs of horizontal components turned to other directions."""

import math

import numpy as np
import pytest
from motion_files import wiggle, write_at2

from rockbatch.motions import read_motions
from rockbatch.motions.identity.azimuths import along_azimuth, azimuths_every


def write_pair(folder, north, east, *, second: str = "090", **more) -> None:
    for azimuth, values in (("000", north), (second, east)):
        write_at2(folder, f"RSN7_X_STA{azimuth}.AT2", values, title=f"X, 1/17/1994, STA, {azimuth}", **more)


@pytest.mark.parametrize(("first", "second"), [(0.0, 90.0), (32.0, 302.0), (350.0, 80.0)])
def test_a_motion_along_one_line_is_given_back_along_it_and_vanishes_across(first, second):
    """A motion along 20° has the components cos and sin of what is between, whichever lies to the right."""
    along = wiggle(100)
    a, b = (along * math.cos(math.radians(20.0 - azimuth)) for azimuth in (first, second))
    np.testing.assert_allclose(along_azimuth(a, first, b, second, 20.0), along, atol=1e-15)
    np.testing.assert_allclose(along_azimuth(a, first, b, second, 110.0), 0.0, atol=1e-15)
    np.testing.assert_allclose(along_azimuth(a, first, b, second, 200.0), -along, atol=1e-15)
    np.testing.assert_allclose(along_azimuth(a, first, b, second, first), a, atol=1e-15)


def test_every_angle_below_half_a_turn_comes_once():
    assert azimuths_every(45.0) == (0.0, 45.0, 90.0, 135.0)
    assert azimuths_every(90.0) == (0.0, 90.0)
    assert azimuths_every(70.0) == (0.0, 70.0, 140.0)
    assert len(azimuths_every(180.0 / 7.0)) == 7  # 7 · (180/7) may be a little below 180 in floating point


def test_a_pair_becomes_one_motion_along_the_axis_with_the_vertical_of_its_station(tmp_path):
    north, east, up = wiggle(80, 1), wiggle(70, 2), wiggle(80, 3)
    write_pair(tmp_path, north, east)
    write_at2(tmp_path, "RSN7_X_STA-UP.AT2", up, title="X, 1/17/1994, STA, UP")
    (motion,) = read_motions(tmp_path, azimuths=(30.0,), gravity=1.0).motions
    expected = north[:70] * math.cos(math.pi / 6) + east * math.sin(math.pi / 6)
    np.testing.assert_allclose(motion.horizontal, expected, rtol=1e-5, atol=1e-7)  # AT2 has seven digits
    np.testing.assert_allclose(motion.vertical, up[:70], rtol=1e-6)
    assert (motion.name, motion.azimuth) == ("RSN7_X_STA_az030", 30.0)
    assert motion.sources == ("RSN7_X_STA000.AT2", "RSN7_X_STA090.AT2", "RSN7_X_STA-UP.AT2")
    assert motion.source == "RSN7_X_STA000.AT2, RSN7_X_STA090.AT2"
    assert "turned to 30° from RSN7_X_STA000 and RSN7_X_STA090" in motion.notes
    assert any(note.startswith("common span: 0.69 s of 0.79 s RSN7_X_STA000") for note in motion.notes)


def test_pairs_are_turned_to_every_direction_that_is_asked_for(tmp_path):
    write_pair(tmp_path, wiggle(50, 1), wiggle(50, 2))
    found = read_motions(tmp_path, azimuths=azimuths_every(60.0))
    assert [m.name for m in found.motions] == ["RSN7_X_STA_az000", "RSN7_X_STA_az060", "RSN7_X_STA_az120"]


@pytest.mark.parametrize(("second", "reason"), [("088", "are 88° apart"), ("180", "are 180° apart")])
def test_components_that_are_not_square_are_not_turned_and_it_is_said(tmp_path, second, reason):
    write_pair(tmp_path, wiggle(50, 1), wiggle(50, 2), second=second)
    found = read_motions(tmp_path, azimuths=(30.0,))
    assert not found.motions
    assert len(found.unusable) == 2
    assert all(reason in u.reason for u in found.unusable)


def test_components_of_steps_far_apart_are_not_turned(tmp_path):
    for azimuth, dt in (("000", ".0200"), ("090", ".0005")):
        write_at2(tmp_path, f"RSN7_X_STA{azimuth}.AT2", wiggle(50), title=f"X, 1/17/1994, STA, {azimuth}", dt=dt)
    reason = "RSN7_X_STA090: dt = 0.0005 s beside 0.02 s of RSN7_X_STA000, more than 20 times apart"
    refused = read_motions(tmp_path, azimuths=(30.0,)).unusable
    assert [unusable.reason for unusable in refused] == [f"cannot be turned: {reason}"] * 2


def test_agencies_may_round_an_azimuth_by_a_degree(tmp_path):
    write_pair(tmp_path, wiggle(50, 1), wiggle(50, 2), second="091")
    assert len(read_motions(tmp_path, azimuths=(30.0,)).motions) == 1


def test_components_of_unknown_azimuth_are_not_turned_and_the_remedy_is_named(tmp_path):
    for label, seed in (("L", 1), ("T", 2)):
        write_at2(tmp_path, f"RSN7_X_Y--{label}.AT2", wiggle(50, seed), title=f"X, 1/17/1994, Y, {label}")
    found = read_motions(tmp_path, azimuths=(30.0,))
    assert not found.motions
    assert "write it in motions.toml" in found.unusable[0].reason


def test_a_single_component_goes_on_only_if_it_lies_along_the_axis(tmp_path):
    write_at2(tmp_path, "RSN7_X_Y030.AT2", wiggle(50), title="X, 1/17/1994, Y, 030")
    assert [m.name for m in read_motions(tmp_path, azimuths=(30.0,)).motions] == ["RSN7_X_Y030"]
    (unusable,) = read_motions(tmp_path, azimuths=(31.5,)).unusable
    assert "only one horizontal component" in unusable.reason
