"""Copies are searched for in time that grows with the number of records, and by samples that are alike."""

import numpy as np
import pytest
from copies import title
from motion_files import wiggle, write_at2

from rockbatch.motions import likeness, read_motions
from rockbatch.motions.component import Component
from rockbatch.motions.orientation import Orientation


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
    one, two = Component("a", 0.01, a, north, source="a"), Component("b", dt, b, north, source="b")
    assert list(likeness._Table([one, two]).similar_pairs()) == [(0, 1)]


def test_steps_that_differ_by_half_a_per_cent_are_not_one_step():
    """After 40 s they are 0.2 s apart: sample by sample, one recording would look like two."""
    t, fine = np.arange(0.0, 40.0, 0.01), np.arange(0.0, 40.0, 0.01005)
    north, noise = Orientation("000", azimuth=0.0), np.random.default_rng(5).normal(size=400)

    def shaken(times):
        return np.interp(times, np.linspace(0.0, 40.0, 400), noise)

    one, two = (
        Component("a", 0.01, shaken(t), north, source="a"),
        Component("b", 0.01005, shaken(fine), north, source="b"),
    )
    assert likeness._are_one_recording(one, two)


def test_series_that_never_move_have_no_independent_values():
    assert likeness._independent_values(np.ones(100), np.ones(100)) == 0.0
    moving = np.random.default_rng(0).normal(size=(2, 4096))  # of white noise each sample is one, to its scatter
    assert likeness._independent_values(*moving) == pytest.approx(4096.0, rel=0.1)
