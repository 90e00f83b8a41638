"""Copies are searched for in time that grows with the number of records, and by samples that are alike."""

import tracemalloc
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from copies import title
from motion_files import wiggle, write_at2

from rockbatch.motions import alignment, read_motions
from rockbatch.motions.component import Component
from rockbatch.motions.identity import candidates, likeness
from rockbatch.motions.identity.planes import in_one_plane
from rockbatch.motions.labels.orientation import Orientation


@pytest.fixture
def correlations(monkeypatch):
    """The correlations that were computed, each of which takes a Fourier transform of the samples."""
    computed: list[float] = []
    plain = likeness.correlation

    def noted(one, two):
        computed.append(plain(one, two))
        return computed[-1]

    monkeypatch.setattr(likeness, "correlation", noted)
    return computed


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("events", [True, False])
def test_sets_are_found_in_time_that_grows_with_their_number(tmp_path, correlations, events):
    """Records of one station in many earthquakes, or without a header, are hardly compared sample by sample."""
    for i in range(60):
        if events:
            said = title("0", event=f"E{i}, 1/{i % 28 + 1}/{1960 + i}")
            write_at2(tmp_path, f"r{i}.AT2", wiggle(200, i + 1), title=said)
        else:
            rows = "".join(f"{0.01 * k:.2f} {value:.6f}\n" for k, value in enumerate(wiggle(200, i + 1)))
            (tmp_path / f"r{i}_NS.txt").write_text("time(s) a(g)\n" + rows)
    assert len(read_motions(tmp_path).motions) == 60
    assert len(correlations) < 60


def simulated(rng, count, samples=400):
    """Components of random motions of one length and envelope, all to the north, as a simulated suite has them."""
    t = np.arange(samples) / samples
    return [
        Component(f"r{i}", 0.02, a, Orientation("000", azimuth=0.0), sources=(f"r{i}.AT2",))
        for i, a in enumerate(rng.normal(size=(count, samples)) * t * np.exp(-4.0 * t))
    ]


def with_copies(rng, suite):
    """The suite with copies of some of its motions behind it: shifted, reversed, scaled, filtered, with noise, in any order."""
    changes = [
        lambda a: np.roll(a, int(rng.integers(1, 30))),
        lambda a: -a,
        lambda a: 100.0 * a,
        lambda a: np.convolve(a, [0.25, 0.5, 0.25], "same"),
        lambda a: a + rng.uniform(0.1, 0.5) * a.std() * rng.normal(size=len(a)),
    ]
    changed = [rng.choice(changes)(suite[i].acceleration) for i in rng.integers(len(suite), size=len(suite) // 2)]
    copies = [replace(suite[0], name=f"c{i}", sources=(f"c{i}.AT2",), acceleration=a) for i, a in enumerate(changed)]
    return [(suite + copies)[i] for i in rng.permutation(len(suite) + len(copies))]


def test_a_simulated_suite_of_one_length_and_envelope_is_not_compared_in_pairs(correlations):
    suite = simulated(np.random.default_rng(3), 60)
    assert not likeness.pairs_of_one_recording(suite).pairs
    assert len(correlations) < 6


@pytest.mark.parametrize("seed", range(6))
def test_full_spectra_rule_out_no_pair_that_a_comparison_of_all_pairs_finds(monkeypatch, seed):
    rng = np.random.default_rng(seed)
    suite = with_copies(rng, simulated(rng, 16))
    found = likeness.pairs_of_one_recording(suite)
    monkeypatch.setattr(candidates.Candidates, "_similar_in_full", lambda self, i, j: np.ones(len(j), dtype=bool))
    assert found.pairs
    assert found == likeness.pairs_of_one_recording(suite)


def test_no_correlation_is_above_the_product_of_spectra():
    rng = np.random.default_rng(2)
    for samples in (1, 2, 3, 50, 257, 512):
        for _ in range(20):
            pair = rng.normal(size=(2, samples)) * np.exp(
                -rng.uniform(0.0, 9.0, size=(2, 1)) * np.arange(samples) / samples
            )
            product = candidates._spectrum(pair[0]) @ candidates._spectrum(pair[1])
            assert np.isnan(product) if samples == 1 else alignment.correlation(*pair) <= product * (1.0 + 1e-12)


@pytest.mark.parametrize("change", ["half the step", "reversed", "noise", "cut", "another scale"])
def test_spectra_rule_out_no_copy_that_the_samples_tell(change):
    """A correlation is computed, and decides, however a recording of a narrow band was changed on its way."""
    a = np.convolve(wiggle(4000, 5), np.hanning(40), "same")
    b, dt = {
        "half the step": (np.interp(np.arange(0, 3999, 0.5), np.arange(4000), a), 0.005),
        "reversed": (-np.roll(a, 7), 0.01),
        "noise": (a + 0.12 * a.std() * np.random.default_rng(1).normal(size=len(a)), 0.01),
        "cut": (a[100:3900], 0.01),
        "another scale": (981.0 * a, 0.01),
    }[change]
    north = Orientation("000", azimuth=0.0)
    one, two = Component("a", 0.01, a, north, sources=("a",)), Component("b", dt, b, north, sources=("b",))
    assert list(candidates.Candidates([one, two]).similar_pairs()) == [(0, 1)]


def test_steps_that_differ_by_half_a_per_cent_are_not_one_step():
    """After 40 s they are 0.2 s apart: sample by sample, one recording would look like two."""
    t, fine = np.arange(0.0, 40.0, 0.01), np.arange(0.0, 40.0, 0.01005)
    north, noise = Orientation("000", azimuth=0.0), np.random.default_rng(5).normal(size=400)

    def shaken(times):
        return np.interp(times, np.linspace(0.0, 40.0, 400), noise)

    one, two = (
        Component("a", 0.01, shaken(t), north, sources=("a",)),
        Component("b", 0.01005, shaken(fine), north, sources=("b",)),
    )
    assert likeness._are_one_recording(one, two)


def test_series_that_never_move_have_no_independent_values():
    assert alignment._independent_values(np.ones(100), np.ones(100)) == 0.0
    moving = np.random.default_rng(0).normal(size=(2, 4096))  # of white noise each sample is one, to its scatter
    assert alignment._independent_values(*moving) == pytest.approx(4096.0, rel=0.1)


def test_turned_triples_are_all_rows_in_one_plane_and_take_little_memory():
    """A matrix of all correlations takes the square of the number of records: 7 GB of 20,000 of one length."""
    rng = np.random.default_rng(8)
    rows = np.linalg.qr(rng.normal(size=(100, 24)))[0].T + 0.02 * rng.normal(size=(24, 100))
    for turned, (one, two), angle in ((7, (3, 21), 0.6), (12, (0, 23), 2.0), (18, (16, 17), 1.1)):
        rows[turned] = np.cos(angle) * rows[one] + np.sin(angle) * rows[two]
    pair = np.linalg.qr(rng.normal(size=(100, 2)))[0].T  # three lines 60° apart, as far as three in a plane can be
    rows[[4, 9, 14]] = [np.cos(angle) * pair[0] + np.sin(angle) * pair[1] for angle in np.radians([10.0, 70.0, 130.0])]
    rows /= np.linalg.norm(rows, axis=1)[:, None]
    least = {three: np.linalg.svd(rows[list(three)])[1][-1] for three in combinations(range(24), 3)}
    planes = {three for three, of_plane in least.items() if of_plane < 1e-6}
    assert len(planes) == 4
    assert {tuple(sorted(three)) for three in in_one_plane(rows, 1e-4)} == planes

    many = rng.normal(size=(4000, 100))
    many /= np.linalg.norm(many, axis=1)[:, None]
    tracemalloc.start()
    assert list(in_one_plane(many, 1e-4)) == []
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 0.25 * 8 * len(many) ** 2


@pytest.mark.parametrize("copies", [0, 14])
def test_turned_triples_of_close_rows_are_those_of_a_brute_force_search(copies):
    """Records of a narrow band are correlated, and copies of a row have no azimuth about it."""
    rng = np.random.default_rng(3)
    rows = np.sin(np.linspace(0.0, 9.0, 60)) + 0.1 * rng.normal(size=(24, 60))
    rows[5] = 0.6 * rows[1] + 0.3 * rows[2]
    rows[9] = rows[8] - 0.2 * rows[5]
    rows[24 - copies :] = rows[0] * rng.choice([-1.0, 1.0], size=(copies, 1))
    rows /= np.linalg.norm(rows, axis=1)[:, None]
    lines = rows[: 24 - copies or None]
    three_lines = [
        three for three in combinations(range(len(lines)), 3) if np.linalg.svd(rows[list(three)])[1][-1] < 1e-9
    ]
    assert len(three_lines) == 2
    copied = range(len(lines), 24)
    of_copies = {tuple(sorted((0, a, b))) for a in range(1, len(lines)) for b in copied}
    of_copies |= {(a, *two) for a in range(1, len(lines)) for two in combinations(copied, 2)}
    assert {tuple(sorted(three)) for three in in_one_plane(rows, 1e-4)} == {*three_lines, *of_copies}


def test_any_two_samples_lie_in_one_plane_and_tell_nothing_of_turned_copies(tmp_path):
    for name, direction, samples in (("A", "000", (1.0, 0.5)), ("B", "030", (0.9, -0.3)), ("C", "060", (0.4, 1.0))):
        write_at2(tmp_path, f"{name}{direction}.AT2", samples, title=title(direction, station=name))
    assert len(read_motions(tmp_path).motions) == 3


@pytest.mark.parametrize(("squares", "places"), [([1.0, 0.0, 0.0, 0.0, 1.0], (0, 4)), ([1.0, 0.0, 0.0, 30.0], (3, 3))])
def test_the_strong_part_of_a_series_is_of_all_its_samples(squares, places):
    """Of 1, 1, 1, 1, 2 the sum passes 5 % at the first and 95 % at the last; of 1, 1, 1, 31 both at the last."""
    assert tuple(alignment.places_of_energy(np.sqrt(squares), (0.05, 0.95))) == places
