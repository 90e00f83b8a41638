"""What is no time history: spectra by their labels, velocities, and series that do not swing about zero."""

import numpy as np
import pytest
from motion_files import wiggle, write_at2

from rockbatch.motions import Motion, ReadOptions, read_motions
from rockbatch.motions.component import Component
from rockbatch.motions.quality.plausible import FARTHEST_MEAN, Candidate, no_zero_line

T = np.arange(80) * 0.05
SPECTRUM = np.where(T < 0.1, 0.4 + 6 * T, np.where(T < 0.5, 1.0, 0.5 / np.maximum(T, 0.5)))  # a code's, in g
A, B, C = (wiggle(80, seed) for seed in (1, 2, 3))


def write(folder, header, *columns, name="x_N.txt"):
    rows = [" ".join(f"{value:.6f}" for value in row) for row in zip(*columns, strict=True)]
    (folder / name).write_text("\n".join([*([header] if header else []), *rows, ""]))


def reason(folder, **options) -> str:
    found = read_motions(folder, options=ReadOptions(**options))
    assert not found.motions
    (unusable,) = found.unusable
    return unusable.reason


@pytest.mark.parametrize(
    "header",
    [
        *(
            "# T(s) Sa(g)",
            "T (s)\tSae (g)",
            "t(s) SA(g)",
            "Period (sec), PSA (g)",
            "# Period(s) acc(g)",
            "Periodo (s), Aceleracion (g)",
            "T Sa",
            "period,psa",
        ),
        *("T[s] Spectral acceleration [g]", "# Tn(s) PSa(g)", "Period (s) Sd", "T(s) Sv(g)", "T(s) RotD50(g)"),
    ],
)
def test_a_response_spectrum_is_refused_as_what_it_is(tmp_path, header):
    write(tmp_path, header, T, SPECTRUM)
    said = reason(tmp_path, unit=None if "(g)" in header or "[g]" in header else "g")
    assert "a response spectrum is no time history" in said


@pytest.mark.parametrize(
    "header",
    ["# freq(Hz) a(g)", "Frequency (Hz) Amplitude", "# f(Hz) FAS(g)", "Frequency (Hz), Fourier amplitude", "freq amp"],
)
def test_a_spectrum_over_frequency_is_refused_as_what_it_is(tmp_path, header):
    write(tmp_path, header, T, np.abs(A))
    assert "a spectrum over frequency is no time history" in reason(tmp_path, unit=None if "(g)" in header else "g")


def test_a_spectrum_of_several_columns_and_one_that_the_study_names_are_refused_too(tmp_path):
    write(tmp_path, "Period(s) Sa_N(g) Sa_E(g)", T, SPECTRUM, SPECTRUM)
    assert "a response spectrum" in reason(tmp_path)
    write(tmp_path, "", T, SPECTRUM)
    assert "a response spectrum" in reason(tmp_path, unit="g", columns=("T", "Sa"))
    write(tmp_path, "PSA", SPECTRUM)
    assert "a response spectrum" in reason(tmp_path, unit="g", dt=0.01)


def test_columns_without_labels_below_a_title_of_a_spectrum_are_not_taken_for_time(tmp_path):
    write(tmp_path, "# AFAD design response spectrum, DD-2, 5 % damping", T, SPECTRUM)
    assert "a spectrum is no time history" in reason(tmp_path, unit="g")
    write(tmp_path, "# matched to a spectrum", T, A)
    assert len(read_motions(tmp_path, options=ReadOptions(unit="g", columns=("time", "000"))).motions) == 1


@pytest.mark.parametrize(
    ("header", "columns", "expected"),
    [
        ("t(s) a(g)", (T, A), {"x_N": A}),
        ("T(s) a(g)", (T, A), {"x_N": A}),
        ("T[sec] N[g]", (T, A), {"x_N": A}),
        ("# T N", (T, A), {"x_N": A}),
        ("L(g) T(g) V(g)", (A, B, C), {"x_N.L": A, "x_N.T": B}),
        ("T L V", (A, B, C), {"x_N.T": A, "x_N.L": B}),
        ("t T L V", (T, A, B, C), {"x_N.T": A, "x_N.L": B}),
        ("T L V", (T, A, C), {"x_N.L": A}),
        ("time(s) L(g) V(g) T(g)", (T, A, C, B), {"x_N.L": A, "x_N.T": B}),
    ],
)
def test_t_is_time_or_the_transverse_component_as_its_unit_and_its_numbers_have_it(tmp_path, header, columns, expected):
    write(tmp_path, header, *columns)
    has_time = any(column is T for column in columns)
    stated = ReadOptions(unit=None if "g" in header else "g", dt=None if has_time else 0.05)
    found = read_motions(tmp_path, options=stated, gravity=1.0)
    assert not found.unusable
    assert {motion.name for motion in found.motions} == set(expected)
    for motion in found.motions:
        assert motion.dt == 0.05
        np.testing.assert_allclose(motion.horizontal, expected[motion.name], atol=1e-6)  # six decimals


def test_velocities_and_displacements_are_left_out_and_it_is_said(tmp_path):
    write(tmp_path, "time acc_N vel_N disp_N", T, A, B, C)
    (motion,) = read_motions(tmp_path, options=ReadOptions(unit="g")).motions
    assert motion.notes == (
        'column 3 ("vel_N") left out: a velocity',
        'column 4 ("disp_N") left out: a displacement',
    )
    write(tmp_path, "time velocity", T, A)
    assert "found velocity; expected accelerations" in reason(tmp_path, unit="g")


# Series


@pytest.mark.parametrize("sign", [1, -1])
def test_a_series_that_never_changes_sign_is_used_only_when_it_is_confirmed(tmp_path, sign):
    write(tmp_path, "# time(s) N(g)", T, sign * SPECTRUM)
    assert "never changes sign, as spectra do" in reason(tmp_path)
    assert len(read_motions(tmp_path, confirmed=["x_*"]).motions) == 1


def test_a_series_with_an_offset_has_it_confirmed_or_taken_off(tmp_path):
    from rockbatch.motions.quality.baseline import Offset

    write(tmp_path, "# time(s) N(g)", T, A + 0.3 * np.abs(A).max())
    assert "has a mean of 2" in reason(tmp_path)  # 0.3 of a peak that has grown by it
    assert 'offset = "mean"' in reason(tmp_path)
    assert len(read_motions(tmp_path, confirmed=["x_N"]).motions) == 1
    assert len(read_motions(tmp_path, offset=Offset("mean")).motions) == 1


def test_a_vertical_that_never_changes_sign_is_asked_for_too(tmp_path):
    write(tmp_path, "# time(s) N(g) UP(g)", T, A, SPECTRUM)
    assert "its vertical component never changes sign" in reason(tmp_path)


def test_an_instruments_offset_is_taken_off_before_the_record_is_judged(tmp_path):
    from agency_files import knet_text

    text, counts = knet_text("E-W")
    assert abs(counts.mean()) > FARTHEST_MEAN * np.abs(counts).max()
    (tmp_path / "TST.EW").write_text(text)
    assert len(read_motions(tmp_path).motions) == 1


def test_few_samples_and_silence_tell_nothing():
    for samples in (np.array([0.1, 0.2, 0.3]), np.zeros(100)):
        motion, component = Motion("m", 0.01, samples), Component("m", 0.01, samples)
        assert no_zero_line(Candidate(motion, component, (), 9.81)) is None


def test_motions_made_in_python_are_nobodys_business(tmp_path):
    write_at2(tmp_path, "x000.AT2", wiggle())
    pulse = Motion("half-sine", 0.01, np.sin(np.linspace(0, np.pi, 100)))
    assert pulse.horizontal.min() > -1e-15
    assert len(read_motions(tmp_path).motions) == 1
