"""Overturning of a slender block on a rigid base by a pulse: between which amplitudes it survives."""

import math

import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from slender_block import HALF_SINE, ONE_SINE, SLENDER, E, W, energy_after_impact, outward

import rockbatch as rb
from rockbatch.pier import Pier, RigidBase
from rockbatch.simulation import run_fixed

BRACKETS = ((2.5, 4.5), (4.5, 6.8), (6.8, 8.0))


# The slender limit


def test_conditions_of_the_slender_limit_give_the_known_amplitudes():
    """Outward motion at the end of the pulse is, but for a factor, √(A²−1) ± A exp(−(phase − asin 1/A)/W) − W.

    The one-sine's three are within 0.01 of the brackets known from Zhang & Makris (2001): 3.00–3.01, 6.32–6.33,
    7.17–7.18.
    """
    half = brentq(lambda a: math.sqrt(a**2 - 1) + a * math.exp(-(math.pi - math.asin(1 / a)) / W) - W, 1.1, 9)
    full = brentq(lambda a: math.sqrt(a**2 - 1) - a * math.exp(-(2 * math.pi - math.asin(1 / a)) / W) - W, 1.1, 9)
    assert half == pytest.approx(HALF_SINE, abs=1e-10)
    assert full == pytest.approx(7.168128797071, abs=1e-10)
    assert brentq(outward, 1.1, 9, args=(math.pi,)) == pytest.approx(half, abs=1e-10)
    assert brentq(outward, 1.1, 9, args=(2 * math.pi,)) == pytest.approx(full, abs=1e-10)
    found = [brentq(energy_after_impact, *bracket) for bracket in BRACKETS[:2]] + [full]
    assert found == pytest.approx(ONE_SINE, abs=1e-6)
    for amplitude, printed in zip(found, ((3.00, 3.01), (6.32, 6.33), (7.17, 7.18)), strict=True):
        assert printed[0] - 0.01 < amplitude < printed[1] + 0.01


# The project


def overturns(shape: str, alpha: float, amplitude: float, samples: int, w: float = W) -> bool:
    """Return whether ``amplitude`` g tan α overturns a pier with p = 1 rad/s; ``samples`` per period, ``w`` = ω_p/p."""
    pier = Pier(alpha, 1.0)
    period = 2 * math.pi / w
    motion = rb.pulse(
        shape,
        name=shape,
        amplitude=amplitude * pier.gravity * math.tan(alpha),
        period=period,
        dt=period / samples,
        duration=period,
    )
    outcome = run_fixed(pier, RigidBase(restitution=E), motion, 1, 0.0)
    assert outcome.status in ("ok", "overturned")
    return outcome.status == "overturned"


def transition(shape: str, alpha: float, bracket: tuple[float, float], samples: int) -> float:
    """Amplitude at which the outcome changes, by bisection to 1e-9; it must differ at the ends of ``bracket``."""
    low, high = bracket
    below = overturns(shape, alpha, low, samples)
    assert overturns(shape, alpha, high, samples) is not below
    while high - low > 1e-9:
        middle = 0.5 * (low + high)
        if overturns(shape, alpha, middle, samples) is below:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


CASES = [
    pytest.param("half-sine", (2.0, 5.0), HALF_SINE, id="half-sine"),
    *(
        pytest.param("sine", bracket, brentq(energy_after_impact, *bracket), id=f"one-sine-{name}-impact")
        for name, bracket in zip(("from", "until"), BRACKETS[:2], strict=True)
    ),
    pytest.param("sine", BRACKETS[2], 7.168128797071, id="one-sine-without-impact"),
]


@pytest.mark.parametrize(("shape", "bracket", "exact"), CASES)
def test_amplitudes_of_overturning_converge_to_those_of_the_slender_limit(shape, bracket, exact):
    """A sine that is linear between samples is off by dt²: each halving quarters the difference; then extrapolated.

    2e-7 after extrapolation: what dt⁴, α² and the bisection leave.
    """
    found = [transition(shape, SLENDER, bracket, samples) for samples in (200, 400, 800)]
    gaps = [value - exact for value in found]
    assert gaps[0] / gaps[1] == pytest.approx(4.0, abs=0.02)
    assert gaps[1] / gaps[2] == pytest.approx(4.0, abs=0.02)
    assert found[2] + (found[2] - found[1]) / 3 == pytest.approx(exact, abs=2e-7)


@pytest.mark.parametrize(("shape", "bracket", "exact"), CASES)
def test_amplitudes_of_overturning_approach_the_slender_limit_as_alpha_squared(shape, bracket, exact):
    """Halving α from 0.10 quarters the difference but for the term in α⁴: 4 ± 0.2, 4 ± 0.05 from 0.05.

    All with 400 samples, so that their error is common to all and drops out of the differences.
    """
    limit = transition(shape, SLENDER, bracket, 400)
    gaps = [transition(shape, alpha, bracket, 400) - limit for alpha in (0.10, 0.05, 0.025)]
    assert gaps[0] / gaps[1] == pytest.approx(4.0, abs=0.2)
    assert gaps[1] / gaps[2] == pytest.approx(4.0, abs=0.05)


def test_a_one_sine_overturns_with_and_without_impact_and_spares_in_between():
    """Four amplitudes around the three transitions: survival, fall after an impact, survival, fall outright."""
    assert [overturns("sine", SLENDER, amplitude, 400) for amplitude in (3.0, 5.0, 6.7, 7.2)] == [
        False,
        True,
        False,
        True,
    ]


@pytest.mark.parametrize(("w", "exact"), [(1.0, 1.3224), (3.0, 2.2939), (5.0, 3.2891)])
def test_half_sine_overturns_below_housners_amplitude(w, exact):
    """√(A²−1) + A exp(−(π − asin 1/A)/W) = W, where A just overturns; √(1+W²) of Housner (1963) is 7 to 55 % too high.

    5e-4 of A either way: 400 samples a period leave 2e-5.
    """

    def margin(a: float) -> float:
        return math.sqrt(a * a - 1.0) + a * math.exp(-(math.pi - math.asin(1.0 / a)) / w) - w

    boundary = brentq(margin, 1.0, 9.0)
    assert boundary == pytest.approx(exact, abs=5e-5)
    assert boundary == pytest.approx(brentq(outward, 1.0, 9.0, args=(math.pi, w)), abs=1e-10)
    assert 1.06 < math.sqrt(1.0 + w * w) / boundary < 1.56
    assert not overturns("half-sine", SLENDER, boundary * (1.0 - 5e-4), 400, w)
    assert overturns("half-sine", SLENDER, boundary * (1.0 + 5e-4), 400, w)


def overturns_by_scipy(alpha: float, amplitude: float) -> bool:
    """Return what (14) and (16) say of a one-sine of ``amplitude`` g tan α, p = 1 rad/s, by DOP853 from lift-off on."""
    peak, lift = amplitude * math.tan(alpha), math.asin(1.0 / amplitude) / W

    def rates(t, y):
        side = -1.0 if leg % 2 == 0 else 1.0
        ground = peak * math.sin(W * t) if t < 2 * math.pi / W else 0.0
        return y[1], -(math.sin(alpha * side - y[0]) + ground * math.cos(alpha * side - y[0]))

    def landing(t, y):
        return y[0]

    def fallen(t, y):
        return abs(y[0]) - 1.5

    landing.terminal = fallen.terminal = True
    time, state = lift, [0.0, 0.0]
    for leg in range(8):
        landing.direction = 1.0 if leg % 2 == 0 else -1.0
        run = solve_ivp(
            rates, (time, time + 40.0), state, "DOP853", events=(landing, fallen), rtol=1e-10, atol=1e-13, max_step=0.2
        )
        if run.t_events[1].size:
            return True
        if not run.t_events[0].size:
            return False
        time, state = float(run.t_events[0][0]), [0.0, E * float(run.y_events[0][0][1])]
    return False


@pytest.mark.parametrize(("bracket", "amplitude"), [*zip(BRACKETS, (2.9689, 6.6018, 7.3361), strict=True)])
def test_large_rotations_move_the_amplitudes_of_a_one_sine_by_some_percent(bracket, amplitude):
    """At α = 0.25 they are 1.6 % below, 4.5 and 2.3 % above those of the slender block, by SciPy; ours within 10⁻⁴."""
    above = overturns_by_scipy(0.25, amplitude * (1.0 + 5e-5))
    assert overturns_by_scipy(0.25, amplitude * (1.0 - 5e-5)) is not above
    assert overturns_by_scipy(0.25, bracket[1]) is above
    assert transition("sine", 0.25, bracket, 400) == pytest.approx(amplitude, rel=1e-4)
