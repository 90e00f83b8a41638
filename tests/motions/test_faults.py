"""Faults of recorders: filled gaps, spikes, dead channels and missing parts are told, and no real record has any."""

import numpy as np
import pytest
from motion_files import needs_records, real_components, wiggle, write_at2

from rockbatch.motions import fema_p695, read_motions
from rockbatch.motions.component import Component, Sensor
from rockbatch.motions.identity.doubles import without_doubles
from rockbatch.motions.labels.orientation import Orientation
from rockbatch.motions.quality.faults import FILLED, filled_gap, is_spike, parts_missing

DT = 0.01
A, B, C = (wiggle(600, seed, 0.4) for seed in (1, 2, 3))
GAP = slice(280, 340)


def with_gap(kind: str) -> np.ndarray:
    a = A.copy()
    a[GAP] = {"zeros": 0.0, "held": a[GAP][0], "line": np.linspace(a[GAP][0], a[GAP][-1], 60)}[kind]
    return a


def with_spike(width: int) -> np.ndarray:
    a = A.copy()
    a[200 : 200 + width] += 2.0
    return a


def station(folder, first, second=B, up=C):
    for name, values in (("X000", first), ("X090", second), ("X-UP", up)):
        write_at2(folder, f"{name}.AT2", values)
    return read_motions(folder)


@pytest.mark.parametrize("kind", ["zeros", "held", "line"])
def test_a_filled_gap_holds_the_component_back_with_its_time(tmp_path, kind):
    found = station(tmp_path, with_gap(kind))
    assert [motion.name for motion in found.motions] == ["X090"]
    assert "a straight line of 0.58 s from 2.8 s on" in found.unusable[0].reason
    assert read_motions(tmp_path, confirmed=["X000"]).motions[0].findings[0].what == "gap"


@pytest.mark.parametrize(("count", "filled"), [(5, False), (12, True)])
def test_a_few_equal_samples_of_a_coarse_record_are_no_gap(count, filled):
    a = A.copy()
    a[200 : 200 + count] = 0.0
    assert (filled_gap(a, 0.1) is not None) == filled


@pytest.mark.parametrize("width", [1, 2])
def test_a_spike_holds_the_component_back_and_a_wider_peak_does_not(tmp_path, width):
    assert "spike" in station(tmp_path, with_spike(width)).unusable[0].reason
    assert not is_spike(with_spike(9))


@pytest.mark.parametrize(("share", "spike"), [(0.49, True), (0.51, False)])
def test_a_peak_is_a_spike_if_less_than_half_remains_without_it(share, spike):
    a = np.where(np.arange(600) < 300, 0.8, 1.0) * np.sin(np.arange(600) / 20)
    a[100] = np.abs(np.delete(a, 100)).max() / share
    assert is_spike(a) == spike


def test_gaps_and_spikes_of_a_vertical_hold_both_motions_back(tmp_path):
    for up, word in (
        (with_gap("zeros") / 2, "vertical: a straight line"),
        (with_spike(1), "vertical: its peak is a spike"),
    ):
        found = station(tmp_path, A, B, up)
        assert not found.motions
        assert all(word in file.reason for file in found.unusable)


def test_straight_lines_beside_the_strong_motion_and_those_of_film_are_no_gap():
    padded = np.concatenate([np.zeros(300), A, np.full(300, 1e-6)])
    assert filled_gap(padded, DT) is None
    points = np.interp(np.arange(6000), np.arange(0, 6000, 10), A)
    assert filled_gap(points, DT / 10) is None
    short = A.copy()
    short[300 : 300 + int(FILLED / DT)] = 0.0
    assert filled_gap(short, DT) is None
    assert filled_gap(np.zeros(50), DT) is None
    assert filled_gap(A[:3], DT) is None


def test_zeros_between_two_shocks_of_one_file_are_no_gap_and_others_are():
    envelope = np.interp(np.arange(600), (0, 80, 400, 500, 600), (0.0, 1.0, 1.0, 0.02, 0.0))
    shock = envelope * A
    shocks = np.concatenate([shock, np.zeros(300), 0.8 * shock])
    assert filled_gap(shocks, DT) is None
    cut_before = np.concatenate([shock[:300], np.zeros(300), 0.8 * shock])
    assert filled_gap(cut_before, DT) is not None
    shocks[300:360] = 0.0
    assert filled_gap(shocks, DT) == pytest.approx((3.0, 0.58), abs=0.03)


def test_a_dead_horizontal_is_called_dead_and_its_unit_is_not_doubted(tmp_path):
    found = station(tmp_path, A, 0.0 * B)
    (refused,) = found.unusable
    assert "it never moves: a dead channel" in refused.reason
    assert "unit" not in refused.reason
    assert found.motions[0].findings == ()


def test_noise_is_held_back_alone_and_a_wrong_gain_with_its_pair(tmp_path):
    noise = 0.002 * np.random.default_rng(0).standard_normal(len(B))
    found = station(tmp_path / "noise", A, noise)
    assert ([m.name for m in found.motions], [u.name for u in found.unusable]) == (["X000"], ["X090"])
    assert "noise" in found.unusable[0].reason
    assert len(station(tmp_path / "gain", A, B / 30.0).unusable) == 2
    assert len(station(tmp_path / "weak", A, B / 10.0).motions) == 2


def test_a_record_that_begins_or_ends_in_the_strong_motion_has_a_finding(tmp_path):
    peak = int(np.abs(A).argmax())
    turned = np.concatenate([A[peak:], A[: peak + 1]])
    for cut, parts in ((A[peak:], "begin"), (A[: peak + 1], "end"), (turned, "begin or end")):
        (finding,) = [
            f for m in station(tmp_path, cut).motions for f in m.findings if f.what == "cut" and m.name == "X000"
        ]
        assert finding.text.startswith(f"it does not {parts} at rest")
    assert parts_missing(A, DT) == []
    assert parts_missing(np.zeros(9), DT) == []


def test_copies_of_one_sample_a_second_cost_no_other_record():
    sensor, moment = Sensor("AAA", "XX", ""), 1.7e9
    fine = Component("fine", DT, A, Orientation("N", azimuth=0.0), sources=("f",), start=moment, sensor=sensor)
    slow = Component("slow", 1.0, A[::100], Orientation("N", azimuth=0.0), sources=("s",), start=moment, sensor=sensor)
    copy = Component("copy", 1.0, A[::100], Orientation("N", azimuth=0.0), sources=("c",), start=moment, sensor=sensor)
    used, left_out = without_doubles([fine, slow, copy])
    assert len(used) + len(left_out) == 3
    assert left_out


@needs_records
def test_no_real_record_has_a_fault():
    components = [*real_components("mm/s2"), *fema_p695.all_components()]
    assert len(components) > 200
    for c in components:
        samples = c.acceleration - (c.acceleration.mean() if c.raw else 0.0)
        assert (filled_gap(samples, c.dt), is_spike(samples), parts_missing(samples, c.dt)) == (None, False, []), (
            c.source
        )
