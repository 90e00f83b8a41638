"""A copy whose sensor was turned is found as a set, and what only resembles it stays."""

import numpy as np
import pytest
from copies import shaken, title
from motion_files import write_at2

from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.component import Component, Sensor
from rockbatch.motions.identity import doubles, likeness
from rockbatch.motions.labels.orientation import Orientation


def write_set(folder, first, second, upright, labels=("000", "090"), titled=title):
    for way, values in ((labels[0], first), (labels[1], second), ("UP", upright)):
        write_at2(folder, f"{folder.name}{way}.AT2", values, title=titled(way))


def turned(first, second, angle: float):
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return c * first + s * second, c * second - s * first


FRAMES = {
    "turned by 37°": (lambda a, b: turned(a, b, 37.0), ("037", "127")),
    "turned by 37°, as if it were not": (lambda a, b: turned(a, b, 37.0), ("000", "090")),
    "an azimuth that is off by 180°": (lambda a, b: (a, b), ("180", "090")),
    "both reversed": (lambda a, b: (-a, -b), ("000", "090")),
    "swapped": (lambda a, b: (b, a), ("010", "100")),
    "H1 and H2": (lambda a, b: turned(a, b, 12.0), ("H1", "H2")),
    "a mirror image, 1.02 times as strong": (lambda a, b: (1.02 * b, 1.02 * a), ("020", "110")),
}  # fmt: skip
"""What was done to the horizontal components of a copy, and how they are labelled."""


@pytest.mark.parametrize("frame", FRAMES)
def test_a_copy_in_another_frame_is_left_out_whole(tmp_path, frame):
    change, labels = FRAMES[frame]
    first, second, upright = shaken(10)
    write_set(tmp_path / "a", first, second, upright)
    write_set(tmp_path / "longer", *change(first, second), upright, labels)
    found = read_motions(tmp_path, confirmed=["*"], options=ReadOptions(role="horizontal"))
    assert len(found.motions) == 2
    assert {motion.source.partition("/")[0] for motion in found.motions} == {"a"}
    assert all(motion.vertical_source == "a/aUP.AT2" for motion in found.motions)
    assert sorted(double.source.partition("/")[0] for double in found.left_out) == ["longer"] * 3


def test_a_cut_copy_is_left_out_whole_though_one_component_has_grown(tmp_path):
    first, second, upright = (a * np.hanning(1500) ** 4 for a in shaken(5))
    second = second + 0.012 * np.random.default_rng(1).standard_normal(
        1500
    )  # goes on from the first to the last sample
    write_set(tmp_path / "a", first, second, upright)
    write_set(
        tmp_path / "longer", *(a[250:1250] for a in (first, second, upright)), titled=lambda way: f"a copy, {way}"
    )
    found = read_motions(tmp_path, confirmed=["*"])
    assert [motion.source for motion in found.motions] == ["a/a000.AT2", "a/a090.AT2"]
    assert len(found.left_out) == 3


@pytest.mark.parametrize("share", [0.0, 0.9])
def test_a_set_that_shares_its_vertical_only_is_another_recording(tmp_path, share):
    """As of a neighbour's, whose horizontal components are alike to ``share``: they are used, in any frame."""
    first, second, upright = shaken(1)
    others = [share * a + np.sqrt(1.0 - share**2) * b for a, b in zip((first, second), shaken(51), strict=False)]
    write_set(tmp_path / "a", first, second, upright)
    write_set(tmp_path / "longer", *turned(*others, 25.0), upright, ("025", "115"))
    found = read_motions(tmp_path, confirmed=["*"])
    assert len(found.motions) == 4
    assert all(motion.vertical is not None for motion in found.motions)
    remarks = [[finding.text for finding in motion.findings if finding.what == "vertical"] for motion in found.motions]
    text = "its vertical component longer/longerUP.AT2 is a/aUP.AT2, of other horizontals: check which of them has it"
    assert remarks == [[], [], [text], [text]]


def earthquake(seed: int, n: int = 4000):
    """Return two horizontal components [g] at 100 Hz that grow for 6 s and fade, with most energy around 2 Hz."""
    t, f = np.arange(n) / 100, np.fft.rfftfreq(n, 0.01)
    amplitude = f / (f + 0.2) / np.hypot(1.0 - (f / 2.0) ** 2, 0.6 * f)
    noise = np.fft.rfft(np.random.default_rng(seed).standard_normal((2, n)))
    a = (t / 6) ** 2 * np.exp(2 - t / 3) * np.fft.irfft(amplitude * noise, n)
    return 0.3 * a / np.abs(a).max()


def in_band(a, low: float, high: float):
    """Return what a Butterworth filter of order 4, run forwards and backwards, leaves."""
    f = np.fft.rfftfreq(a.shape[-1], 0.01)[1:]
    gain = np.append(0.0, 1.0 / (1.0 + (low / f) ** 8) / (1.0 + (f / high) ** 8))
    return np.fft.irfft(gain * np.fft.rfft(a), a.shape[-1])


CHANGES = {
    "turned": lambda a: np.array(turned(*a, 37.0)),
    "cut to 1-11 s": lambda a: a[:, 100:1100],
    "cut to 5.5 s": lambda a: a[:, 100:650],
    "cut and turned": lambda a: np.array(turned(*a[:, 100:1100], 61.0)),
    "filtered to 1-5 Hz": lambda a: in_band(a, 1.0, 5.0),
    "filtered to 1-5 Hz, cut and turned": lambda a: np.array(turned(*in_band(a, 1.0, 5.0)[:, 100:1100], 110.0)),
    "filtered to 0.3-8 Hz, reversed, half as strong": lambda a: -0.5 * in_band(a, 0.3, 8.0),
}  # fmt: skip
"""What was done to a copy without a vertical, of which no component is as it was."""


def write_pair(folder, pair, labels=("000", "090"), **header):
    for label, values in zip(labels, pair, strict=True):
        write_at2(folder, f"{folder.name}{label}.AT2", values, title=f"nothing, {label}", **header)


@pytest.mark.parametrize("change", CHANGES)
def test_a_copy_without_a_vertical_of_which_no_component_is_alike_is_left_out_whole(tmp_path, change):
    first = earthquake(1)
    write_pair(tmp_path / "a", first)
    write_pair(tmp_path / "longer", CHANGES[change](first), ("037", "127") if "turned" in change else ("000", "090"))
    found = read_motions(tmp_path, confirmed=["*"])
    (used,) = {motion.source.partition("/")[0] for motion in found.motions}
    assert (len(found.motions), len(found.left_out)) == (2, 2)
    for double in found.left_out:
        assert double.source.partition("/")[0] != used
        assert double.reason.startswith(f"the same recording as {used}/")


def test_the_likeness_of_two_sets_is_the_greatest_of_all_alignments():
    """By trying them: half a degree apart, of which the cosine costs 1e-5."""
    rng = np.random.default_rng(4)
    a, b = rng.standard_normal((2, 2, 400)) * np.hanning(400) ** 2
    b[:, :350] += 2.0 * np.array(turned(a[1], a[0], 37.0))[:, 50:]
    a, b = (x - x.mean(axis=1, keepdims=True) for x in (a, b))
    north = Orientation("000", azimuth=0.0)
    sets = ([Component(str(k), 0.01, x, north) for k, x in enumerate(side)] for side in (a, b))
    angles, tried = np.radians(np.arange(0.0, 360.0, 0.5)), []
    for shift in range(-100, 101):
        x, y = a[:, max(0, shift) : 400 + min(0, shift)], b[:, max(0, -shift) : 400 - max(0, shift)]
        (xx, xy), (yx, yy) = each = x @ y.T
        turning = np.cos(angles) * (xx + yy) + np.sin(angles) * (xy - yx)
        mirrored = np.cos(angles) * (xx - yy) + np.sin(angles) * (xy + yx)
        best = max(turning.max(), mirrored.max()) / np.sqrt((x * x).sum() * (y * y).sum())
        tried.append((best, shift, each))
    best, shift, each = max(tried, key=lambda one: one[0])
    found = likeness._greatest_likeness(*sets, 1)
    assert shift == 50
    assert found.correlation == pytest.approx(best, rel=2e-5)
    np.testing.assert_allclose(found.each, np.abs(each))
    slow = np.sin(np.linspace(0.0, 30.0, 1000))[None]
    assert likeness._coherence(slow, slow, 0.01) == 0.0  # of too few bands


def test_a_decimated_and_turned_copy_is_left_out_whole(tmp_path):
    first = in_band(earthquake(3), 0.1, 15.0)
    write_pair(tmp_path / "a", first)
    write_pair(tmp_path / "longer", turned(*first[:, ::2], 20.0), ("020", "110"), dt=".0200")
    found = read_motions(tmp_path, confirmed=["*"])
    assert [motion.source for motion in found.motions] == ["a/a000.AT2", "a/a090.AT2"]


def neighbour(a, seed: int, per_hz: float | None = None, r: float = 0.975):
    """Return what an instrument nearby records: alike to ``r``, or less and less with the frequency."""
    f = np.fft.rfftfreq(a.shape[-1], 0.01)
    coherence = r if per_hz is None else np.exp(-per_hz * f)
    own = np.fft.rfft(earthquake(seed))
    return np.fft.irfft(coherence * np.fft.rfft(a) + np.sqrt(1.0 - coherence**2) * own, a.shape[-1])


def basin_waves(seed: int):
    """Return waves of 0.5 Hz that last, as deep basins have them."""
    rng, t = np.random.default_rng(seed), np.arange(6000) / 100
    phases = np.pi * t + rng.uniform(0.0, 6.0, (2, 1))
    slow = np.sin(t / 17 + rng.uniform(0.0, 6.0)) + 2.0
    return 0.05 * slow * np.sin(phases) + 0.002 * rng.standard_normal((2, 6000))


OTHERS = {
    "another seed of one spectrum": lambda a: earthquake(51),
    "a neighbour": lambda a: neighbour(a, 52),
    "a close neighbour": lambda a: neighbour(a, 57, r=0.983),
    "a near one": lambda a: neighbour(a, 53, 0.005),
    "a neighbour, filtered": lambda a: in_band(neighbour(a, 54), 1.0, 5.0),
    "a near one, filtered": lambda a: in_band(neighbour(a, 55, 0.005), 1.0, 5.0),
    "an aftershock": lambda a: 0.4 * (0.3 * a + np.roll(earthquake(56), 70, axis=1)),
}  # fmt: skip


@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("seed", [1, 2])
def test_what_only_resembles_a_set_in_another_frame_is_another_recording(tmp_path, other, seed):
    first = earthquake(seed)
    write_pair(tmp_path / "a", first)
    write_pair(tmp_path / "longer", turned(*OTHERS[other](first), 60.0), ("060", "150"))
    assert len(read_motions(tmp_path, confirmed=["*"]).motions) == 4


def test_waves_of_basins_are_no_copies_of_each_other_in_any_frame(tmp_path):
    for seed in range(4):
        write_pair(tmp_path / f"r{seed}", basin_waves(seed), (f"{10 * seed:03d}", f"{10 * seed + 90:03d}"))
    assert len(read_motions(tmp_path, confirmed=["*"]).motions) == 8


@pytest.mark.parametrize(("other", "same"), [(Sensor("B", "CI"), False), (Sensor("B", "NP"), True)])
def test_a_turned_copy_at_another_station_of_the_network_is_another_recording(other, same):
    """Two instruments on one pad: of two networks, which name the station as they like, one is used and names the other."""
    first = earthquake(1)
    sets = (("a", Sensor("A", "CI"), first, 0.0), ("b", other, turned(*first, 30.0), 30.0))
    components = [
        Component(f"{name}{k}", 0.01, values, Orientation("", azimuth=azimuth + 90.0 * k), sources=(f"{name}{k}",), folder=name,
                  sensor=sensor, station=name)
        for name, sensor, pair, azimuth in sets for k, values in enumerate(pair)
    ]  # fmt: skip
    kept, left = doubles.without_doubles(components)
    assert len(kept) == (2 if same else 4)
    assert all("the same recording as a" in double.reason for double in left)


def test_other_recordings_are_hardly_compared_in_any_frame(monkeypatch):
    """Each comparison takes four Fourier transforms; their number may not grow with the square of that of the sets."""
    compared = []
    plain = likeness._greatest_likeness
    monkeypatch.setattr(likeness, "_greatest_likeness", lambda *sets: (compared.append(sets), plain(*sets))[1])
    components = [
        Component(f"{n}.{k}", 0.01, values, Orientation("", azimuth=90.0 * k), sources=(f"{n}.{k}",), station=str(n))
        for n in range(60) for k, values in enumerate(earthquake(n))
    ]  # fmt: skip
    assert len(doubles.without_doubles(components)[0]) == 120
    assert len(compared) < 6  # of 1770
