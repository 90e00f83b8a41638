"""Laws of devices one by one: what is stored and lost is what their force does, and forces by hand."""

import math

import numpy as np
import pytest
from core_samples import FIG5, filled, values_of

from rockbatch.core.block.model import Rocking, Stance
from rockbatch.core.devices.laws import (
    CLOSES,
    CONTACT,
    FRICTION,
    HYSTERETIC,
    MAXWELL,
    OPENS,
    SLACK,
    SPRING,
    STICKS,
    TAUT,
    TENDON,
    VISCOUS,
    YIELDING,
    force,
    mode_of,
    past_release,
    response,
    slip_rate,
    stop_force,
    stored,
)
from rockbatch.core.observe.peaks import Place, RecordedDevices
from rockbatch.core.observe.rows import Step
from rockbatch.core.types import Ground
from rockbatch.pier import RigidBase
from rockbatch.pier.first_loading import STEEL_EXPONENT
from rockbatch.simulation import block
from rockbatch.simulation.elements import IDLE

INF = math.inf
DAMPER = IDLE._replace(kind=VISCOUS, coefficient=3.0, exponent=0.5, linear_below=0.01, slope=3.0 * 0.01**-0.5)
LINEAR = IDLE._replace(kind=VISCOUS, coefficient=3.0, linear_below=INF, slope=3.0)
STEEL = IDLE._replace(kind=HYSTERETIC, strength=2.0, stiffness=50.0)
ON_BRACE = STEEL._replace(give=0.5)
TIE = IDLE._replace(kind=TENDON, strength=4.0, stiffness=30.0, prestress=1.0)
HUNG = IDLE._replace(kind=MAXWELL, stiffness=40.0, coefficient=3.0, exponent=0.5)
STOP = IDLE._replace(kind=CONTACT, stiffness=80.0, start=0.05, returned=0.36)
BAND = IDLE._replace(kind=SPRING, stiffness=25.0)
RUBS = IDLE._replace(kind=FRICTION, strength=2.0)


@pytest.mark.parametrize(
    ("of", "elongation", "speed", "state", "mode", "goes"),
    [
        (DAMPER, 0.1, 0.3, 0.0, TAUT, OPENS), (DAMPER, 0.1, -0.3, 0.0, TAUT, CLOSES), (DAMPER, 0.1, 0.004, 0.0, TAUT, OPENS),
        (LINEAR, 0.1, 0.3, 0.0, TAUT, OPENS), (LINEAR, 0.1, -0.3, 0.0, TAUT, CLOSES),
        (RUBS, 0.1, 0.3, 0.0, TAUT, OPENS), (RUBS, 0.1, -0.3, 0.0, TAUT, CLOSES), (BAND, -0.2, 0.3, 0.0, TAUT, OPENS),
        (TIE, 0.05, 0.3, 0.0, TAUT, OPENS), (TIE, 0.05, -0.3, 0.01, TAUT, CLOSES), (TIE, -0.2, 0.3, 0.0, SLACK, OPENS),
        (TIE, 0.12, 0.3, 0.02, YIELDING, OPENS), (HUNG, 0.1, 0.3, 1.2, TAUT, OPENS), (HUNG, 0.1, 0.3, -1.2, TAUT, OPENS),
        (STEEL, 0.1, 0.3, 0.8, TAUT, OPENS), (ON_BRACE, 0.1, 0.3, 0.8, TAUT, OPENS), (ON_BRACE, 0.1, -0.3, -0.8, TAUT, CLOSES),
        (STOP, 0.07, -0.3, 0.03, TAUT, CLOSES), (STOP, 0.02, 0.3, 0.0, SLACK, OPENS),
    ],
)  # fmt: skip
def test_what_a_force_does_is_stored_or_lost(of, elongation, speed, state, mode, goes):
    """Ė = F ė − loss, by a difference of the energy along the motion and the rate of the state."""
    found, short = response(of, elongation, speed, state, mode, goes), 1e-6
    ends = [
        stored(of, elongation + sign * short * speed, state + sign * short * found.state_rate) for sign in (-1.0, 1.0)
    ]
    gain = (ends[1] - ends[0]) / (2.0 * short)
    assert gain == pytest.approx(found.force * speed - found.loss_rate, rel=1e-5, abs=1e-8)
    assert force(of, elongation, speed, state, mode, goes) == found.force
    assert found.loss_rate >= 0.0
    lasts = of.kind in (HYSTERETIC, MAXWELL) or mode == YIELDING
    assert lasts or found.state_rate == 0.0
    assert found.force == 0.0 or mode != SLACK


def test_forces_of_dampers_are_those_of_their_laws():
    assert force(DAMPER, 0.0, 0.25, 0.0, TAUT, OPENS) == pytest.approx(3.0 * 0.25**0.5)
    assert force(DAMPER, 0.0, -0.25, 0.0, TAUT, CLOSES) == pytest.approx(-3.0 * 0.25**0.5)
    assert force(DAMPER, 0.0, 0.005, 0.0, TAUT, OPENS) == pytest.approx(0.5 * 3.0 * 0.01**0.5)  # linear below 0.01 m/s
    assert force(DAMPER._replace(linear_below=0.0), 0.0, 0.0, 0.0, TAUT, OPENS) == 0.0
    assert [force(LINEAR, 0.1, speed, 0.0, TAUT, OPENS) for speed in (0.25, -0.25, 0.0)] == [0.75, -0.75, 0.0]
    assert [force(RUBS, 0.3, 0.0, 0.0, TAUT, goes) for goes in (OPENS, CLOSES, STICKS)] == [2.0, -2.0, 0.0]
    assert slip_rate(HUNG, 1.5) == pytest.approx(0.25)
    assert slip_rate(HUNG, -1.5) == pytest.approx(-0.25)
    assert response(HUNG, 0.0, 0.3, 1.5, TAUT, OPENS).state_rate == pytest.approx(40.0 * (0.3 - 0.25))


@pytest.mark.parametrize("give", [0.0, 0.5])
def test_a_hysteretic_damper_yields_as_it_goes_on_and_springs_back_at_once(give):
    """ż = (u̇/u_y)(1 − |z|⁵) of the steel, whose brace takes give times its elastic way."""
    steel = STEEL._replace(give=give)
    for z, speed, goes in (
        (0.8, 0.3, OPENS),
        (-0.8, -0.3, CLOSES),
        (0.8, -0.3, CLOSES),
        (-0.8, 0.3, OPENS),
        (1.2, 0.3, OPENS),
    ):
        share = 1.0 - min(abs(z), 1.0) ** 5 if goes * z > 0.0 else 1.0
        found = response(steel, 0.0, speed, z, TAUT, goes)
        assert found.force == pytest.approx(2.0 * z)
        assert found.state_rate == pytest.approx(speed * 50.0 * share / (1.0 + give * share), abs=1e-12)
        assert found.loss_rate == pytest.approx(2.0 * z * speed / (1.0 + give * share))  # the brace has the rest
    assert stored(steel, 0.1, 0.5) == pytest.approx(0.5 * give / 50.0 * 2.0 * 0.5**2)


def test_a_tendon_is_taut_between_slack_and_yield():
    """Taut from u₀ − P0/k = u₀ − 1/30 on, with strength 4 up to u₀ + 0.1."""
    for permanent in (0.0, 0.02):
        slack, most = permanent - 1.0 / 30.0, permanent + 0.1
        for off, goes, mode in ((-0.01, OPENS, SLACK), (0.01, CLOSES, TAUT)):
            assert mode_of(TIE, slack + off, permanent, goes) == mode
        for off, goes, mode in ((-0.01, OPENS, TAUT), (0.01, OPENS, YIELDING), (0.01, CLOSES, TAUT)):
            assert mode_of(TIE, most + off, permanent, goes) == mode
        assert force(TIE, permanent + 0.05, 0.3, permanent, TAUT, OPENS) == pytest.approx(1.0 + 30.0 * 0.05)
        assert force(TIE, most, 0.3, permanent, YIELDING, OPENS) == 4.0
        assert stored(TIE, permanent + 0.05, permanent) == pytest.approx(0.5 * 2.5**2 / 30.0)
        assert stored(TIE, slack - 0.1, permanent) == 0.0
        assert stored(TIE, most + 0.1, permanent) == pytest.approx(0.5 * 4.0**2 / 30.0)
    free = TIE._replace(prestress=0.0)
    assert (mode_of(free, 0.0, 0.0, OPENS), mode_of(free, 0.0, 0.0, CLOSES)) == (TAUT, SLACK)
    assert mode_of(TIE._replace(prestress=4.0), 0.0, 0.0, OPENS) == YIELDING
    dead = TIE._replace(stiffness=0.0, strength=INF)
    assert stored(dead, 0.3, 0.0) == pytest.approx(0.3)  # a weight on a rope


def test_a_stop_is_loaded_along_k_and_lets_go_along_a_steeper_line():
    """k δ on the way in, k/e² from (1 − e²) of the deepest on on the way out: e² of the work comes back."""
    deepest = 0.03
    for depth in (0.005, 0.02, 0.03, 0.04):
        back = max(80.0 / 0.36 * (depth - 0.64 * deepest), 0.0)
        assert past_release(STOP, 0.05 + depth, deepest) == pytest.approx(depth - 0.64 * deepest)
        assert stop_force(STOP, 0.05 + depth, deepest) == pytest.approx(min(80.0 * depth, back))
        assert force(STOP, 0.05 + depth, -0.3, deepest, TAUT, CLOSES) == pytest.approx(
            80.0 / 0.36 * (depth - 0.64 * deepest)
        )
        first = response(STOP, 0.05 + depth, 0.3, depth, YIELDING, OPENS)
        assert first.force == pytest.approx(80.0 * depth)
        assert first.loss_rate == pytest.approx(0.64 * 80.0 * depth * 0.3)
        assert stored(STOP, 0.05 + depth, depth) == pytest.approx(0.36 * 0.5 * 80.0 * depth**2)
    assert stop_force(STOP, 0.01, 0.0) == force(STOP, 0.01, 0.3, 0.0, SLACK, OPENS) == 0.0
    assert [mode_of(STOP, at, 0.0, OPENS) for at in (0.04, 0.05, 0.06)] == [SLACK, YIELDING, YIELDING]
    assert (mode_of(STOP, 0.05, 0.0, CLOSES), mode_of(STOP, 0.06, 0.0, CLOSES)) == (SLACK, YIELDING)
    assert (
        response(STOP, 0.06, 0.3, 0.01, YIELDING, OPENS).state_rate == 0.0
    )  # how deep it is pressed is noted as it turns
    assert mode_of(BAND, -0.1, 0.0, OPENS) == mode_of(DAMPER, 0.1, 0.0, CLOSES) == TAUT
    assert force(BAND, -0.2, 0.3, 0.0, TAUT, OPENS) == pytest.approx(-5.0)


def test_the_exponent_that_pages_state_of_hysteretic_dampers_is_that_of_their_law():
    """ż = (ė/u_y)(1 − |z|ⁿ) in loading."""
    loading = response(STEEL, 0.0, 1.0, 0.5, TAUT, OPENS)
    assert loading.state_rate == pytest.approx(STEEL.stiffness * (1.0 - 0.5**STEEL_EXPONENT), rel=1e-14)


def error_of_a_step(time, h, a):
    """Error of a Runge–Kutta step of ``h`` in the velocity that a force τᵃ takes, from ``time`` to a reversal on."""
    simpson = h / 6.0 * (time**a + 4.0 * (time - 0.5 * h) ** a + (time - h) ** a)
    return abs(simpson - (time ** (a + 1.0) - (time - h) ** (a + 1.0)) / (a + 1.0))


@pytest.mark.parametrize("a", [0.1, 0.3, 0.5])
def test_steps_towards_a_reversal_all_have_about_the_same_error(a, uncompiled):
    """Within a factor of 6 from a sample before the reversal to a thousandth of it; of steps ~ τ by one of 1000."""
    times, step = [10.0 ** (-0.25 * k) for k in range(13)], 0.02  # of a run, over the sampling interval
    calls = [("devices.pull", "share_near_reversal", DAMPER._replace(linear_below=0.0), time, 1.0) for time in times]
    errors = [
        error_of_a_step(time, step * share, a) for time, share in zip(times, uncompiled(values_of, calls), strict=True)
    ]
    assert max(errors) < 6.0 * min(errors)


def test_a_step_a_sample_before_a_reversal_is_half_and_not_less_in_the_linear_part(uncompiled):
    """At 2 m/s a sample; the damper is linear below 0.01 m/s."""
    half, linear, still = uncompiled(
        values_of, [("devices.pull", "share_near_reversal", DAMPER, speed, 2.0) for speed in (-2.0, 0.01, 0.0)]
    )
    assert half == 0.5
    assert still == linear == pytest.approx(0.5 * 0.005**0.75)


def test_the_devices_of_a_step_pull_by_their_laws_inside_it(uncompiled):
    """A damper 2b from the pivot, C ė^½, and a spring at the deck; inside the step the block turns four times as fast."""
    theta, cosine = 0.1, math.cos(0.05)
    m, b, h = block(FIG5, RigidBase()), FIG5.half_width, FIG5.height
    oil, band = DAMPER._replace(offset=-b), BAND._replace(height=9.0, swing=b, way=-1.0)
    slope, on_right = b * math.cos(theta) - h * math.sin(theta), Stance(0.0, 1.0, 1.0, 1.0)

    def turning(omega):
        return Rocking(b * math.sin(theta) - h * (1.0 - math.cos(theta)), theta, slope * omega, omega)

    def force(omega):
        return 3.0 * math.sqrt(2.0 * b * cosine * omega) / cosine

    y, still = turning(0.2), Ground(0.0, 0.0, 0.0, 0.0)
    place = Place(1, Step(y, y, y, y, on_right, 0.01, still, still), 0.5)
    pulls, pushes = np.array([[force(0.2) + 0.7, 0.0]] * 2), np.full(2, 9.0)
    of_foot, of_deck = (
        RecordedDevices([oil], np.zeros((2, 1)), 0.0),
        RecordedDevices([oil, band], np.zeros((2, 2)), 0.0),
    )
    call = ("observe.peaks", "under_devices_within", of_foot, m, pulls, place, turning(0.8))
    (under,) = uncompiled(values_of, [call])
    assert under.pull.force == pytest.approx(force(0.8) + 0.7, rel=1e-9)  # 0.7 of friction at both ends
    found = uncompiled(filled, ("observe.peaks", "push_deck_within", of_deck, m, place, y), pushes)
    assert found.tolist() == pytest.approx(
        [9.0, 25.0 * (9.0 * math.sin(theta) + b * (1.0 - math.cos(theta)))], rel=1e-9
    )
