"""Intensity measures of the piecewise linear acceleration, against closed forms, eqsig and pyrotd."""

import math
import warnings
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest

from rockbatch.common.errors import InputError
from rockbatch.common.units import GRAVITY
from rockbatch.motions import Motion
from rockbatch.motions.description import entry, suite_spectra
from rockbatch.motions.intensity import measures
from rockbatch.motions.motion import Initial
from rockbatch.motions.motion_set import MotionSet
from rockbatch.motions.spectrum import PERIODS, spectral_acceleration

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # pyrotd asks pkg_resources, which is on its way out
    import eqsig
    import eqsig.im
    import eqsig.sdof
    import pyrotd

pyrotd.processes = 1


def shaking(dt: float = 0.01, seed: int = 3) -> np.ndarray:
    """Twenty seconds of noise below 5 Hz, in a bell [m/s²]: smooth at its samples, whatever they stand for between."""
    t = np.arange(round(20 / dt) + 1) * dt
    draw = np.random.default_rng(seed)
    waves = [draw.normal() * np.sin(2 * np.pi * f * t + draw.uniform(0, 6)) for f in np.arange(0.2, 5.0, 0.2)]
    return np.exp(-(((t - 8) / 3) ** 2)) * np.sum(waves, axis=0)


def test_constant_acceleration_gives_a_t_and_half_a_t_squared():
    a = np.full(101, 2.0)
    t = np.arange(101) * 0.01
    np.testing.assert_allclose(measures.velocity(a, 0.01), 2 * t, atol=1e-14)
    np.testing.assert_allclose(measures.displacement(a, 0.01), t**2, atol=1e-14)


def test_a_ramp_is_integrated_exactly_however_coarse_the_samples():
    for dt in (0.5, 0.1):
        t = np.arange(round(2 / dt) + 1) * dt
        np.testing.assert_allclose(measures.velocity(t, dt), t**2 / 2, atol=1e-14)
        np.testing.assert_allclose(measures.displacement(t, dt), t**3 / 6, atol=1e-14)


def test_samples_put_between_change_nothing():
    a = np.random.default_rng(5).normal(size=300)
    fine = np.interp(np.arange(299 * 7 + 1) / 7, np.arange(300), a)
    # the same polynomial, added up in another order: rounding of 2000 terms
    np.testing.assert_allclose(measures.displacement(fine, 0.02 / 7)[::7], measures.displacement(a, 0.02), atol=1e-12)


def test_peaks_are_absolute_values():
    a = np.array([0.0, -3.0, 0.0])
    assert measures.pga(a) == 3.0
    assert measures.pgv(a, 1.0) == 3.0
    assert measures.pgd(a, 1.0) == pytest.approx(3.0 / 6.0 + 3.0 - 3.0 / 6.0)


def test_velocity_and_displacement_begin_where_the_file_says():
    """A sine that is cut out of a longer one: ẋ = −(A/ω) cos ωt and x = −(A/ω²) sin ωt go on, without a drift."""
    dt, omega, amplitude, t0 = 0.002, 2 * math.pi, 3.0, 0.3
    t = t0 + np.arange(2001) * dt
    a = amplitude * np.sin(omega * t)
    initial = Initial(-amplitude / omega * math.cos(omega * t0), -amplitude / omega**2 * math.sin(omega * t0))
    assert measures.pgv(a, dt, initial) == pytest.approx(amplitude / omega, rel=1e-4)
    assert measures.pgd(a, dt, initial) == pytest.approx(amplitude / omega**2, rel=1e-4)
    assert measures.pgd(a, dt) > 4 * amplitude / omega**2  # from rest it drifts away


def test_the_state_at_a_time_is_that_of_the_series_and_of_a_finer_one():
    a, dt, initial = np.random.default_rng(3).normal(size=50), 0.02, Initial(0.4, -0.1)
    fine = np.interp(np.arange(49 * 8 + 1) / 8, np.arange(50), a)
    for k in (0, 7, 8, 101, 391, 392):
        state = measures.state_at(a, dt, initial, k * dt / 8)
        assert state.velocity == pytest.approx(measures.velocity(fine, dt / 8, initial)[k], abs=1e-12)
        assert state.displacement == pytest.approx(measures.displacement(fine, dt / 8, initial)[k], abs=1e-12)


def test_the_initial_state_is_found_from_a_file_s_velocities_and_displacements():
    a, dt, initial = np.random.default_rng(4).normal(size=400), 0.01, Initial(-0.02, 0.3)
    v, d = (series(a, dt, initial) for series in (measures.velocity, measures.displacement))
    found = measures.initial_of(a, dt, v, d)
    assert found is not None
    assert (found.velocity, found.displacement) == pytest.approx((-0.02, 0.3), abs=1e-12)
    assert measures.initial_of(a, dt, v, None) == Initial(found.velocity, 0.0)
    noise = np.random.default_rng(5).normal(size=400) * np.abs(v).max()
    assert measures.initial_of(a, dt, noise, d) is None  # of another record
    assert measures.initial_of(a, dt, v[:-1], d) is None
    assert measures.initial_of(a, dt, None, d) is None


@pytest.mark.parametrize("at", [0.1, 0.3, 0.5, 0.9])
def test_a_straight_line_runs_away_and_a_lasting_displacement_does_not(at):
    t = np.linspace(0, 1, 2001)
    step = 2.0 * (t > at)
    assert not measures.runs_away(step)
    assert measures.runs_away(step + 30.0 * t)
    assert not measures.runs_away(np.zeros(10))


def test_a_motion_times_a_factor_has_all_of_it_times_that_factor():
    m = Motion("m", 0.01, np.array([1.0, 2.0]), np.array([3.0, 4.0]), initial=Initial(0.5, 0.25))
    for made, along in ((m.times(2.0), 2.0), (m.times(2.0, reverse=True), -2.0)):
        assert made.horizontal.tolist() == [along, 2 * along]
        assert made.vertical is not None
        assert made.vertical.tolist() == [6.0, 8.0]
        assert made.initial == Initial(0.5 * along, 0.25 * along)
        assert made.pga == 2 * abs(along) != m.pga
        assert not made.horizontal.flags.writeable
        assert not made.vertical.flags.writeable


def test_a_motion_times_too_large_a_factor_names_the_sample_that_is_no_number():
    m = Motion("m", 0.01, np.array([1.0, 200.0]), np.array([3.0, 4.0]))
    with np.errstate(over="ignore"), pytest.raises(InputError, match=r'"m": horizontal sample 1 .* is inf'):
        m.times(1e307)


def test_arias_intensity_of_whole_cycles_of_a_sine_is_its_closed_form():
    """∫ sin² over whole cycles is half their time; trapezoids of it are exact, as of any wave sampled evenly."""
    dt, omega, amplitude = 0.05, 2 * math.pi, 3.0
    t = np.arange(101) * dt
    found = measures.arias_intensity(amplitude * np.sin(omega * t), dt, gravity=10.0)
    assert found == pytest.approx(math.pi / 20.0 * amplitude**2 * 2.5, rel=1e-12)


def test_significant_duration_of_constant_acceleration_is_nine_tenths():
    padded = np.concatenate((np.zeros(300), np.full(1001, -2.0), np.zeros(500)))
    # the two slopes at the ends hold a third of a sample's energy each
    assert measures.significant_duration(padded, 0.01) == pytest.approx(9.0, abs=0.01)
    assert measures.significant_duration(padded, 0.01, 0.25, 0.75) == pytest.approx(5.0, abs=0.01)


def test_a_record_without_motion_has_no_significant_duration():
    assert measures.significant_duration(np.zeros(10), 0.01) == 0.0


def test_measures_agree_with_eqsig():
    """Its displacement is by trapezoids of v, ours by cubics; its D5–95 is between whole samples."""
    dt, a = 0.01, shaking()
    signal = eqsig.AccSignal(a, dt)
    assert measures.pga(a) == pytest.approx(signal.pga, rel=1e-12)
    assert measures.pgv(a, dt) == pytest.approx(signal.pgv, rel=1e-9)
    assert measures.pgd(a, dt) == pytest.approx(signal.pgd, rel=1e-6)
    arias = float(eqsig.im.calc_arias_intensity(signal)[-1])
    assert measures.arias_intensity(a, dt, gravity=9.81) == pytest.approx(arias, rel=1e-12)
    start, end = eqsig.im.calc_sig_dur_vals(a, dt, se=True)
    assert measures.significant_duration(a, dt) == pytest.approx(end - start, abs=2 * dt)


def test_spectrum_agrees_with_eqsig_s_nigam_and_jennings():
    """The same solution by another route, whose coefficients lose digits: 8e-9 from 80-bit arithmetic, ours 2e-15.

    Below 20 samples a period (0.2 s) ours puts samples between.
    """
    dt, a = 0.01, shaking()
    periods = np.geomspace(0.2, 5.0, 25)
    _, _, ours = eqsig.sdof.pseudo_response_spectra(a, dt, periods, 0.05)
    np.testing.assert_allclose(spectral_acceleration(a, dt, periods), ours, rtol=1e-7)


def test_spectrum_agrees_with_pyrotd_s_fourier_solution():
    """pyrotd's motion is a sum of waves, ours of chords, which lose (ωΔ)²/12 = 0.2 % at 5 Hz; its peaks are found
    between samples, ours at them; 0.12 % is measured, and twice that granted."""
    dt = 0.005
    a = np.concatenate((shaking(dt), np.zeros(40_000)))  # pyrotd's motion is periodic: all comes to rest in between
    periods = np.geomspace(0.1, 5.0, 20)
    theirs = pyrotd.calc_spec_accels(dt, a, 1 / periods, 0.05).spec_accel
    np.testing.assert_allclose(spectral_acceleration(a, dt, periods), theirs, rtol=3e-3)


@pytest.mark.parametrize("period", [0.013, 0.4, 3.0])
def test_an_undamped_oscillator_under_a_constant_acceleration_doubles_it(period):
    """u = −a/ω² (1 − cos ωt): the largest is twice the static one, met to 1 − cos(π/20) by its 20 samples a period."""
    a = np.full(1000, 1.5)
    found = spectral_acceleration(a, 0.01, [period], damping=0.0)[0]
    assert 3.0 * (1 - (1 - math.cos(math.pi / 20)) / 2) <= found <= 3.0 + 1e-9


def test_a_damped_oscillator_overshoots_a_constant_acceleration_by_its_closed_form():
    zeta = 0.05
    overshoot = 1 + math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2))
    assert spectral_acceleration(np.full(5000, 2.0), 0.001, [1.0])[0] == pytest.approx(2.0 * overshoot, rel=1e-5)


@pytest.mark.parametrize("npts", [2, 63, 64, 65, 128, 129])
def test_the_spectrum_does_not_depend_on_where_blocks_end(npts):
    """Against the recursion one sample after the other; zeros after the record must not count."""
    a = np.random.default_rng(npts).normal(size=npts)
    dt, omega, zeta = 0.01, 2 * math.pi / 1.0, 0.05
    s = complex(-zeta * omega, omega * math.sqrt(1 - zeta**2))
    c1 = (np.exp(s * dt) - 1 - s * dt) / (s**2 * dt)
    c0 = (np.exp(s * dt) - 1) / s - c1
    z, largest = 0j, 0.0
    for here, there in pairwise(a):
        z = np.exp(s * dt) * z - c0 * here - c1 * there
        largest = max(largest, abs(z.imag / s.imag))
    assert spectral_acceleration(a, dt, [1.0])[0] == pytest.approx(omega**2 * largest, rel=1e-10)


def test_spectra_of_a_suite_are_in_g_and_in_order():
    motions = [Motion(str(scale), 0.01, scale * shaking()) for scale in (1.0, 2.0)]
    found = suite_spectra(motions, gravity=10.0)
    assert found["damping"] == 0.05
    assert len(found["period_s"]) == len(PERIODS) == len(found["sa_g"][0])
    np.testing.assert_allclose(found["sa_g"][1], 2 * np.array(found["sa_g"][0]), rtol=2e-3)  # four digits are kept
    np.testing.assert_allclose(
        found["sa_g"][0], spectral_acceleration(motions[0].horizontal, 0.01, PERIODS) / 10, rtol=1e-3
    )


def test_a_displacement_that_runs_away_is_no_peak_unless_the_ground_moved_before():
    """A sine from rest leaves the ground with the velocity a/ω, and one that begins with its reverse stays where it is."""
    t, dt = np.arange(20_001) * 0.001, 0.001
    sine = 3.0 * np.sin(10.0 * t)
    assert measures.believable_pgd(Motion("from rest", dt, sine)) is None
    known = Motion("known", dt, sine, initial=Initial(0.0, 0.01))
    assert measures.believable_pgd(known) == pytest.approx(measures.pgd(sine, dt, known.initial))
    begun = Motion("begun", dt, sine, initial=Initial(-0.3, 0.0))
    assert measures.believable_pgd(begun) == pytest.approx(0.03, rel=2e-3)


def test_every_measure_of_the_table_grows_with_amplitude_and_time_as_its_unit_does():
    """Twice the acceleration, at twice the step: powers of two, with no other rounding; the sign does not count."""
    a = shaking()
    first, turned, other = (
        Motion("a", dt, factor * a, 0.4 * factor * a[::-1]) for dt, factor in ((0.01, 1.0), (0.01, -1.0), (0.02, 2.0))
    )
    table = MotionSet([first, turned, other], [], []).table()
    factors = {
        "dt_s": 2.0, "duration_s": 2.0, "pga_h_g": 2.0, "pga_v_g": 2.0, "pgv_h_m_s": 4.0, "pgd_h_m": 8.0, "arias_m_s": 8.0,
        "d5_95_s": 2.0,
    }  # fmt: skip
    pd.testing.assert_series_equal(table.iloc[0], table.iloc[1], check_names=False)
    numbers = table.select_dtypes("number").dropna(axis="columns")
    assert (numbers.iloc[2] / numbers.iloc[0]).to_dict() == pytest.approx(factors | {"npts": 1.0}, rel=1e-12)
    assert table["pga_h_g"][0] == pytest.approx(np.abs(a).max() / GRAVITY)
    assert table["pga_v_g"][0] == pytest.approx(0.4 * table["pga_h_g"][0])
    assert table["duration_s"][0] == pytest.approx((len(a) - 1) * 0.01)
    told, row = entry(first, "a", GRAVITY, with_pulse=False), table.iloc[0]
    names = {name: name.replace("_h_", "_") for name in (*factors, "npts")}
    assert {name: told[names[name]] for name in names} == pytest.approx({name: row[name] for name in names}, rel=1e-12)


def test_the_cav_of_a_sine_is_four_amplitudes_over_omega_each_period():
    omega, dt = 2 * math.pi, 0.001
    a = 3.0 * np.sin(omega * np.arange(5001) * dt)
    assert measures.cumulative_absolute_velocity(a, dt) == pytest.approx(5 * 4 * 3.0 / omega, rel=1e-5)


@pytest.mark.parametrize("dt", [0.02, 0.01, 0.005])
def test_the_cav_is_that_of_eqsig_at_any_sampling(dt):
    """Trapezoids of |a|, by eqsig; to rounding."""
    theirs = eqsig.im.calc_cav(eqsig.AccSignal(shaking(dt), dt))[-1]
    assert measures.cumulative_absolute_velocity(shaking(dt), dt) == pytest.approx(theirs, rel=1e-12)


@pytest.mark.parametrize("samples", [5, 7, 12])
def test_the_cav_of_a_coarse_sine_is_the_closed_sum_of_its_samples(samples):
    """Of N samples a half-period, Σ|sin| = cot(π/2N) from zero to zero; Σ|cos| = 1/sin(π/2N) if N is odd, with zeros between
    samples, and as of the sine if it is even.
    """
    phase = math.pi / samples * np.arange(4 * samples + 1)
    half = math.pi / (2 * samples)
    of_cosine = math.sin(half) if samples % 2 else math.tan(half)
    for wave, expected in ((np.sin(phase), 4 / math.tan(half)), (np.cos(phase), 4 / of_cosine)):
        assert measures.cumulative_absolute_velocity(wave, 0.01) == pytest.approx(0.01 * expected, rel=1e-12)
    assert measures.cumulative_absolute_velocity(np.array([3.0, -1.0]), 2.0) == 4.0
    assert measures.cumulative_absolute_velocity(np.zeros(3), 1.0) == 0.0


def test_durations_of_a_rectangle_are_its_length_and_of_two_their_sum_and_span():
    a = np.zeros(1001)
    a[100:201], a[600:651] = 2.0, -3.0
    ramps = 4 * 0.01 * 0.5  # on either side half of an interval is above half the height
    assert measures.bracketed_duration(a, 0.01, 1.0) == pytest.approx(5.5 + 0.005 + 0.01 * 2 / 3)
    assert measures.uniform_duration(a, 0.01, 1.0) == pytest.approx(1.0 + 0.5 + 2 * 0.005 + 2 * 0.01 * 2 / 3)
    assert measures.uniform_duration(np.abs(np.minimum(a, 2)), 0.01, 1.5) < 1.5 + ramps
    assert measures.bracketed_duration(a, 0.01, 3.0) == measures.uniform_duration(a, 0.01, 3.0) == 0.0


def test_durations_above_a_level_of_a_sine_are_those_of_its_arc():
    dt, level = 1e-4, 0.5
    a = np.sin(2 * math.pi * np.arange(20001) * dt)  # two periods
    above = 1 - 2 * math.asin(level) / math.pi  # share of the time that |sin| > level
    assert measures.uniform_duration(a, dt, level) == pytest.approx(2 * above, rel=1e-6)
    assert measures.bracketed_duration(a, dt, level) == pytest.approx(
        2 - 2 * math.asin(level) / (2 * math.pi), rel=1e-6
    )


def test_durations_are_those_of_the_straight_lines_between_samples():
    a = shaking(0.02)
    fine = np.interp(np.arange((len(a) - 1) * 50 + 1) / 50, np.arange(len(a)), a)
    above = np.abs(fine) > 2.0
    places = np.flatnonzero(above)
    assert measures.uniform_duration(a, 0.02, 2.0) == pytest.approx(above.sum() * 0.0004, abs=0.02)
    assert measures.bracketed_duration(a, 0.02, 2.0) == pytest.approx((places[-1] - places[0]) * 0.0004, abs=0.001)
    edge = np.array([5.0, 1.0, 5.0])  # above at both ends of the record
    assert measures.bracketed_duration(edge, 1.0, 2.0) == 2.0
    assert measures.uniform_duration(edge, 1.0, 2.0) == pytest.approx(1.5)
