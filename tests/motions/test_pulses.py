"""Pulses: their formulas, the sampling rule, and every mistake named at once."""

import re

import numpy as np
import pytest

from rockbatch.common.errors import InputError
from rockbatch.motions.intensity.measures import velocity
from rockbatch.motions.suites.pulses import LEAST_SAMPLES, SHAPES, pulse, pulse_length, unlikely


def make(shape, dt=0.005, period=0.5, amplitude=9.81, duration=10.0, **more):
    return pulse(shape, name="p", amplitude=amplitude, period=period, dt=dt, duration=duration, **more)


def test_a_sine_is_one_sine_then_zeros():
    motion = make("sine")
    t = np.arange(2001) * 0.005
    expected = np.where(t <= 0.5 + 1e-12, 9.81 * np.sin(2 * np.pi * t / 0.5), 0.0)
    np.testing.assert_allclose(motion.horizontal, expected, atol=1e-13)
    assert (motion.npts, motion.dt, motion.source, motion.vertical) == (2001, 0.005, "pulse", None)


def test_a_cosine_starts_and_ends_at_its_amplitude():
    motion = make("cosine", period=1.0)
    expected = np.r_[9.81 * np.cos(2 * np.pi * np.arange(201) / 200), np.zeros(1800)]
    np.testing.assert_allclose(motion.horizontal, expected, atol=1e-13)
    assert motion.notes == ("cosine pulse, peak 9.81 m/s², T = 1 s",)


@pytest.mark.parametrize("dt", [0.1 / 3, 0.01, 0.005, 0.7 / 49])
def test_a_sample_at_the_end_of_the_pulse_belongs_to_it_whatever_the_rounding(dt):
    motion = make("cosine", period=0.7 if dt == 0.7 / 49 else 1.0, dt=dt)
    last = int(np.flatnonzero(motion.horizontal)[-1])
    assert last == round((0.7 if dt == 0.7 / 49 else 1.0) / dt)


def test_a_pulse_that_ends_between_samples_has_none_behind_its_end():
    motion = make("cosine", period=0.5, dt=0.03)
    assert np.flatnonzero(motion.horizontal)[-1] == 16  # 0.48 s; 0.51 s lies behind


def test_a_half_sine_lasts_half_its_period_and_never_reverses():
    motion = make("half-sine", period=0.5)
    assert motion.horizontal.max() == pytest.approx(9.81)
    assert (motion.horizontal >= -1e-12).all()
    assert np.flatnonzero(motion.horizontal > 1e-9)[-1] == 49


def test_a_ricker_pulse_peaks_in_the_middle_and_starts_below_a_millionth():
    motion = make("ricker", period=0.6, dt=0.01)
    assert motion.horizontal.argmax() == 80  # 4/3 of the period
    assert motion.horizontal.max() == pytest.approx(9.81, rel=1e-12)
    assert abs(motion.horizontal[0]) < 1e-6 * 9.81
    spectrum = np.abs(np.fft.rfft(motion.horizontal, 2**16))
    assert np.fft.rfftfreq(2**16, 0.01)[spectrum.argmax()] == pytest.approx(1 / 0.6, abs=0.01)


@pytest.mark.parametrize(("gamma", "nu"), [(1.0001, 0.0), (1.5, 0.0), (2.0, 1.2), (3.3, -2.0), (5.0, np.pi)])
def test_mavroeidis_papageorgiou_is_the_derivative_of_the_published_velocity(gamma, nu):
    f, dt = 2.0, 1e-5
    motion = make("mavroeidis-papageorgiou", period=1 / f, dt=dt, duration=gamma / f + 0.01, gamma=gamma, nu=nu)
    t = np.arange(motion.npts) * dt
    inside = t <= gamma / f
    tau = t - gamma / (2 * f)
    v = 0.5 * (1 + np.cos(2 * np.pi * f / gamma * tau)) * np.cos(2 * np.pi * f * tau + nu) * inside
    slope = np.gradient(v, dt)
    # Central differences err by dt²/6 · |a''| ~ 1e-9 of the peak, and by 1e-4 at the end where a'' jumps.
    scale = 9.81 / np.abs(slope).max()
    np.testing.assert_allclose(motion.horizontal, scale * slope, atol=2e-3)
    np.testing.assert_allclose(velocity(motion.horizontal, dt), scale * v, atol=1e-5)


@pytest.mark.parametrize(("gamma", "nu"), [(1.2, 0.3), (2.7, 1.9)])
def test_the_amplitude_of_mavroeidis_papageorgiou_is_the_peak_acceleration(gamma, nu):
    motion = make("mavroeidis-papageorgiou", period=1.0, dt=1e-4, duration=5, amplitude=-3.0, gamma=gamma, nu=nu)
    # samples miss the peak by (ω dt)²/8 ~ 5e-8 at most, a little more for the shorter components
    assert motion.pga == pytest.approx(3.0, rel=1e-6)
    assert motion.pga <= 3.0 * (1 + 1e-9)


@pytest.mark.parametrize("shape", SHAPES)
def test_every_shape_may_last_exactly_as_long_as_the_motion(shape):
    length = {"half-sine": 0.3, "ricker": 1.6, "mavroeidis-papageorgiou": 1.2}.get(shape, 0.6)
    more = {"gamma": 2.0, "nu": 0.0} if shape.startswith("mav") else {}
    assert make(shape, period=0.6, dt=0.1, duration=length, **more).npts == round(length / 0.1) + 1


def test_all_mistakes_come_at_once():
    with pytest.raises(InputError) as caught:
        pulse("sine", name=" ", amplitude=float("nan"), period=-1.0, dt=0.0, duration=float("inf"), gamma=2.0)
    text = "\n".join(caught.value.messages)
    for word in ("period = -1", "dt = 0", "duration = inf", "amplitude = nan", "gamma and nu", "name = "):
        assert word in text


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"shape": "cosin"}, 'did you mean "cosine"'),
        ({"shape": "Half-Sin"}, 'did you mean "half-sine"'),
        ({"shape": "sine", "duration": 0.4}, "the pulse lasts 0.5 s"),
        ({"shape": "sine", "dt": 0.5}, "dt = 0.5: must be below the period"),
        ({"shape": "mavroeidis-papageorgiou"}, "number of oscillations"),
        ({"shape": "mavroeidis-papageorgiou", "gamma": 1.0, "nu": 0.0}, "above 1"),
        ({"shape": "ricker", "nu": 1.0}, "gamma and nu have no meaning"),
    ],
)
def test_a_mistake_says_what_to_write(wrong, message):
    with pytest.raises(InputError, match=message):
        make(**wrong)


def test_an_amplitude_that_only_a_wrong_unit_explains_is_refused_as_typed_and_in_g():
    with pytest.raises(InputError, match=re.escape("amplitude = 40: 4.08 g are more than 3 g")):
        make("sine", amplitude=40.0)
    confirmed = make("sine", amplitude=40.0, confirm=["amplitude"])
    assert confirmed.pga == pytest.approx(40.0, rel=1e-6)


def test_the_least_samples_in_a_period_are_enough_and_one_in_a_hundred_fewer_are_not():
    assert unlikely(0.5, LEAST_SAMPLES * 0.01, 0.01) == {}
    assert list(unlikely(0.5, 0.99 * LEAST_SAMPLES * 0.01, 0.01)) == ["dt"]


def test_the_length_of_each_shape_is_known_from_its_period():
    lengths = [
        pulse_length(shape, 0.6, 1.5) for shape in ("sine", "half-sine", "cosine", "ricker", "mavroeidis-papageorgiou")
    ]
    assert lengths == pytest.approx([0.6, 0.3, 0.6, 1.6, 0.9])


@pytest.mark.parametrize("nu", [None, np.nan, np.inf])
def test_a_phase_that_is_no_number_is_refused(nu):
    with pytest.raises(
        InputError, match=f"nu{'' if nu is None else f' = {nu}'}: a mavroeidis-papageorgiou pulse needs its phase"
    ):
        make("mavroeidis-papageorgiou", gamma=1.5, nu=nu)
