"""The peak that a header states is that of the samples, but for rounding; else the record waits to be confirmed."""

import re

import numpy as np
import pytest
from agency_files import A, B, C, dyna_text, knet_text, renadic_channel
from contradictions import CONTRADICTIONS, read_as

from rockbatch.motions import read_motions

# in text columns a peak is a warning at most
PEAKS = [wrong for wrong in CONTRADICTIONS if wrong.statement == "peak" and wrong.header.format != "text columns"]


@pytest.mark.parametrize("wrong", PEAKS, ids=lambda wrong: wrong.header.format)
def test_a_peak_that_the_samples_do_not_have_is_a_reason_not_to_use_the_record(tmp_path, wrong):
    sound = read_as(wrong.header, wrong.header.data)
    (tmp_path / wrong.header.file).write_bytes(wrong.data)
    refused = read_motions(tmp_path).unusable
    assert refused
    for unusable in refused:
        stated, has = map(
            float, re.search(r"states a peak of (\S+) \S+, and its samples have (\S+) ", unusable.reason).groups()
        )
        assert abs(abs(stated) - has) > 0.2 * has
        assert "if it is right, write confirm = [" in unusable.reason
    confirmed = read_motions(tmp_path, confirmed=["*"])
    for motion, before in zip(confirmed.motions, sound.motions, strict=True):
        np.testing.assert_array_equal(motion.horizontal, before.horizontal)
    notes = [note for motion in confirmed for note in motion.notes]
    assert any(note.startswith("confirmed: ") and "states a peak" in note for note in notes)


@pytest.mark.parametrize(
    ("off", "used", "noted", "warned"),
    [(1.0, 1, False, False), (1.004, 1, True, False), (0.953, 1, True, False), (1.06, 1, False, True), (0.9, 1, False, True),
     (1.24, 1, False, True), (1.26, 0, False, False), (0.79, 0, False, False), (9.81, 0, False, False), (0.001, 0, False, False)],
)  # fmt: skip
def test_a_peak_off_by_a_few_percent_is_noted_by_more_marked_and_by_a_quarter_waits(tmp_path, off, used, noted, warned):
    """Of some 570 motions of one archive 59 differ by rounding of less than a percent."""
    (tmp_path / "x.ASC").write_text(dyna_text(**{"PGA_CM/S^2": f"{off * np.abs(A).max():.2f}"}))
    found = read_motions(tmp_path)
    assert len(found.motions) == used
    if used:
        (motion,) = found.motions
        assert any("states a peak" in note for note in motion.notes) == (noted or warned)
        assert ("peak" in [finding.what for finding in motion.findings]) == warned


@pytest.mark.parametrize(
    ("stated", "noted"), [("810.00", False), ("810.01", False), ("8.2E+02", False), ("8.3E+02", True), ("7.9D2", True)]
)
def test_a_unit_of_the_last_digit_is_rounding_and_two_are_none(tmp_path, stated, noted):
    """Of a peak of 810 gal; in exponents a digit may be ten of them."""
    (tmp_path / "x.ASC").write_text(dyna_text(**{"PGA_CM/S^2": stated}))
    (motion,) = read_motions(tmp_path).motions
    assert any("states a peak" in note for note in motion.notes) == noted


def test_a_digit_lost_from_a_scale_and_lines_lost_from_the_data_are_found(tmp_path):
    text = knet_text()[0]
    (tmp_path / "x.EW").write_text(text.replace("/8223790", "/822379"))
    (unusable,) = read_motions(tmp_path).unusable
    assert re.search(
        r"states a peak of \d+\.\d+ gal, and its samples have \d+\.\d+ gal: check its scale", unusable.reason
    )
    lines = text.splitlines(keepends=True)
    for cut in (lines[:25] + lines[36:], [*lines, lines[20]], [*lines[:-1], lines[-1][:-10] + "\n"]):
        (tmp_path / "x.EW").write_text("".join(cut))
        (unusable,) = read_motions(tmp_path).unusable
        assert "200 values" in unusable.reason or "found 7 numbers; expected 8" in unusable.reason


def test_a_vertical_or_a_turned_component_with_another_peak_is_no_less_a_reason(tmp_path):
    for name, values, stream in (("n", A, "HNN"), ("e", B, "HNE"), ("z", C, "HNZ")):
        (tmp_path / f"{name}.ASC").write_text(dyna_text(values, stream))
    assert len(read_motions(tmp_path).motions) == 2
    peak = "PGA_CM/S^2"
    (tmp_path / "z.ASC").write_text(dyna_text(C, "HNZ", **{peak: "81.0"}))
    found = read_motions(tmp_path)
    assert (len(found.motions), len(found.unusable)) == (0, 2)
    assert all(unusable.reason.startswith("vertical: its header states a peak of 81.0") for unusable in found.unusable)
    assert len(read_motions(tmp_path, vertical=False).motions) == 2
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "z.ASC"\nconfirm = true\n')
    assert len(read_motions(tmp_path).motions) == 2
    (tmp_path / "e.ASC").write_text(dyna_text(B, "HNE", **{peak: "81.0"}))
    (turned,) = read_motions(tmp_path, azimuths=(30.0,)).unusable
    assert "states a peak of 81.0" in turned.reason


def test_film_is_compared_before_it_is_interpolated(tmp_path):
    times = np.cumsum([0, *np.random.default_rng(1).choice([0.005, 0.0065, 0.0083], len(A) - 1)])
    (tmp_path / "x.V1").write_text("\n".join(renadic_channel("N10E", A / 100, np.round(times, 4))), encoding="latin-1")
    (motion,) = read_motions(tmp_path).motions
    assert any("interpolated" in note for note in motion.notes)
