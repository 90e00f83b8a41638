"""Which of the components of a set is the vertical one, where names and headers do not say it plainly."""

import numpy as np
import pytest
from motion_files import wiggle, write_at2
from waveform_files import channel_xml, station_xml, trace, write_mseed

from rockbatch.motions import read_motions

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


def test_two_numbered_names_beside_a_vertical_are_horizontal(tmp_path):
    write_three(tmp_path, ["x.HN1", "x.HN2", "x.HNZ"])
    assert [motion.vertical_source for motion in read_motions(tmp_path).motions] == ["x.HNZ.AT2"] * 2


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
def test_a_third_horizontal_has_to_be_a_combination_of_two(tmp_path, third):
    for folder, values in (("apart", COMPONENTS[2]), ("plane", None)):
        a, b = COMPONENTS[:2]
        angle = np.radians(float(third))
        values = a * np.cos(angle) + b * np.sin(angle) if values is None else values
        for name, samples in (("000", a), ("090", b), (third, values)):
            write_at2(tmp_path / folder, f"x_{name}.AT2", samples)
    assert len(read_motions(tmp_path / "plane").motions) == 3
    found = read_motions(tmp_path / "apart")
    assert not found.motions
    assert all("is one vertical?" in file.reason for file in found.unusable)
