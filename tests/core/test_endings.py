"""How a run ends: not before nothing that comes later can exceed the peak."""

import math
from copy import deepcopy
from types import SimpleNamespace

import pytest
from core_samples import FIG5, half_sine, values_of, waiting_after

from rockbatch.core.block.ending import reach_of
from rockbatch.core.block.model import Rocking, Stance
from rockbatch.core.devices.laws import CONTACT, HYSTERETIC, MAXWELL, SPRING, TENDON
from rockbatch.core.springs.model import Contact, State, Supports
from rockbatch.core.types import GROWING, RESTLESS, SURVIVED, UNDECIDED, Moment
from rockbatch.pier import ElasticBase, Pier, RigidBase, YieldingBase
from rockbatch.simulation import block, run_fixed, run_to_tolerance, springs
from rockbatch.simulation.elements import IDLE


@pytest.mark.parametrize("quiet_s", [0.0, 2.0, 20.0])
def test_a_pier_beyond_the_capacity_of_its_supports_is_followed_until_it_lies(quiet_s):
    """η = 1.3: beyond 0.3 tan α the far support is plastic, and there is no way back, far below α/2. The independent
    reference (benchmarks/independent) finds it on its side at 7.7615 s; cut off after 2 s it leans by 0.496 α."""
    base = YieldingBase(50.0, 0.1, eta=1.3, spring="epp")
    outcome = run_to_tolerance(FIG5, base, half_sine(0.416, 0.5, 2.0), 1e-4, quiet_s)
    assert outcome.status == "overturned"
    assert outcome.t_end == pytest.approx(7.7615, abs=2e-3)
    early = run_fixed(FIG5, base, half_sine(0.416, 0.5, 2.0), 4, 2.0, wait=False)
    assert early.theta_max / FIG5.alpha == pytest.approx(0.496, abs=1e-3)


@pytest.mark.parametrize(
    "base",
    [
        ElasticBase(50.0, 0.2),
        YieldingBase(50.0, 0.2, eta=1.5, spring="epp"),
        YieldingBase(50.0, 0.2, eta=1.5, spring="hardening"),
        ElasticBase(50.0, impact="housner"),
        RigidBase(),
    ],
    ids=["elastic", "epp", "hardening", "housner", "rigid"],
)
def test_how_long_a_run_is_asked_to_go_on_does_not_change_what_it_says(base):
    """Amplitudes on either side of overturning: outcome and peak are those of a run that is followed five times longer."""
    statuses = set()
    for amplitude in (0.3, 0.5, 0.7, 0.9):
        for quiet_s in (0.5, 2.0):
            motion = half_sine(amplitude, 1.0, 0.5)
            found = run_to_tolerance(FIG5, base, motion, 1e-4, quiet_s)
            longer = run_to_tolerance(FIG5, base, motion, 1e-4, 10.0)
            assert found.status == longer.status
            statuses.add(found.status)
            if found.status == "ok":
                assert found.theta_max == pytest.approx(longer.theta_max, abs=1e-4 * FIG5.alpha)
    assert statuses == {"ok", "overturned"}


@pytest.mark.parametrize("quiet_s", [0.0, 2.0, 20.0])
def test_the_peak_that_comes_after_a_short_record_is_waited_for(quiet_s):
    """Rigid base, half-sine of 0.5 s: 0.489 α after two quiet seconds; the reference's peak is 0.5911617118 α at 4.32387 s."""
    outcome = run_to_tolerance(Pier(0.13, 0.38), RigidBase(), half_sine(1.0913, 1.0, 0.5), 1e-4, quiet_s)
    assert outcome.theta_max / 0.13 == pytest.approx(0.5911617118, abs=1e-8)
    assert outcome.t_max == pytest.approx(4.32387, abs=1e-5)


@pytest.mark.parametrize("theta", [0.02, 0.19])
def test_free_rocking_reaches_the_amplitude_of_its_energy(theta):
    """½ θ̇² = p² [cos(α − θ₁) − cos(α − θ)] on the way down from rest at θ₁ (Housner 1963)."""
    for share in (0.1, 0.5, 0.9):
        now = share * theta
        omega = 2.5 * math.sqrt(2.0 * (math.cos(0.2 - theta) - math.cos(0.2 - now)))
        assert reach_of(now, omega, 0.2, 2.5) == reach_of(-now, -omega, 0.2, 2.5) == pytest.approx(theta, rel=1e-9)
    assert reach_of(0.19, 2.5 * 0.011, 0.2, 2.5) == reach_of(0.21, 0.0, 0.2, 2.5) == math.inf


TIE = IDLE._replace(kind=TENDON, strength=math.inf, stiffness=30.0, prestress=1.0, offset=0.7)


STEEL = IDLE._replace(kind=HYSTERETIC, strength=2.0, stiffness=50.0, give=0.25)


HUNG = IDLE._replace(kind=MAXWELL, stiffness=40.0, coefficient=3.0, exponent=0.5)


STOP = IDLE._replace(kind=CONTACT, stiffness=80.0, start=0.05, returned=0.36, height=9.0, swing=1.5, way=1.0)


BAND = IDLE._replace(kind=SPRING, stiffness=2.5, height=9.0, swing=1.5, way=-1.0)


def over_ground(at: float, of) -> float:
    """Elongation of a device under a block that rocks by ``at`` about a pivot of FIG5."""
    b, side = FIG5.half_width, math.copysign(1.0, at)
    if of.height:
        return of.way * (of.height * math.sin(at) + side * of.swing * (1.0 - math.cos(at)))
    return 2.0 * (side * b - of.offset) * math.sin(0.5 * at)


def standing_on(theta: float) -> Stance:
    side = math.copysign(1.0, theta)
    return Stance(float(side < 0.0), float(side > 0.0), side, side)


def kept_by(at: float, offset: float) -> float:
    """Energy [J/kg] of tie, stop and band under a block: squares of their forces."""
    tie, stop, band = (over_ground(at, of) for of in (TIE._replace(offset=offset), STOP, BAND))
    return (1.0 + 30.0 * tie) ** 2 / 60.0 + 0.5 * 80.0 * 0.36 * max(stop - 0.05, 0.0) ** 2 + 0.5 * 2.5 * band**2


@pytest.mark.parametrize("offset", [0.7, -0.7])
def test_a_block_with_devices_is_over_once_its_energy_falls_short_of_the_peak(offset, uncompiled):
    """By a thousandth, to the side with less; a damper of steel may give back F z² (1 + give)/2k, a brace F²/2k besides."""
    m, elements, x = (
        block(FIG5, RigidBase()),
        [TIE._replace(offset=offset), STEEL, HUNG, STOP, BAND],
        [0.0, -0.3, 0.9, 1e3, 0.0],
    )
    devices = SimpleNamespace(elements=elements, x=x, level=[0.0])
    back, inertia = 0.5 * 2.0 * 0.09 * 1.25 / 50.0 + 0.5 * 0.81 / 40.0, FIG5.inertia_about_pivot
    b, h, calls, expected = FIG5.half_width, FIG5.height, [], []

    def rise(theta):
        return FIG5.gravity * (b * math.sin(abs(theta)) - h * (1.0 - math.cos(theta)))

    for theta, peak in ((0.03, 0.08), (-0.03, 0.08), (0.01, 0.15), (-0.05, 0.12), (0.02, 0.5)):
        y, contact = Rocking(rise(theta) / FIG5.gravity, theta, 0.0, 0.0), standing_on(theta)
        devices.x[3] = max(0.0, over_ground(theta, STOP) - 0.05)  # it is on its first loading
        calls.append(("block.ending", "stored_by_devices", m, deepcopy(devices), y, contact))
        kept = kept_by(theta, offset)
        expected.append((kept, back))
        least = min(rise(limit) + kept_by(limit, offset) for limit in (min(peak, 0.2), -min(peak, 0.2)))
        for factor in (0.999, 1.001):
            omega = math.sqrt(2.0 * (factor * least - rise(theta) - kept - back) / inertia)
            now = SimpleNamespace(y=y._replace(omega=omega), contact=contact)
            calls.append(("block.ending", "_cannot_reach", m, deepcopy(devices), now, peak))
            expected.append(factor < 1.0)
    lies = SimpleNamespace(y=Rocking(rise(0.35) / FIG5.gravity, 0.35, 0.0, 0.0), contact=standing_on(0.35))  # beyond α
    calls.append(("block.ending", "_cannot_reach", m, SimpleNamespace(elements=[], x=[], level=[0.0]), lies, 0.15))
    expected.append(False)
    for call, found, wanted in zip(calls, uncompiled(values_of, calls), expected, strict=True):
        assert found == pytest.approx(wanted, rel=1e-9), call


def test_devices_on_springs_add_to_the_load_and_may_give_energy_back(uncompiled):
    """A tie's energy lies above its tangent where the base has come to; what stop and band bear at the peak is not given back."""
    m = springs(FIG5, ElasticBase(50.0))
    y, contact, supports = (
        State(-0.01, 0.006, 0.0, 0.0, 0.0, 0.0),
        Contact(0.0, 0.0, 0.0, 0.0, 0.0),
        Supports(-0.02, -0.04),
    )
    for offset, strength in ((0.7, math.inf), (-0.4, math.inf), (0.0, 0.5)):
        tie = TIE._replace(offset=offset, strength=strength)
        devices = SimpleNamespace(elements=[tie, STEEL, HUNG, BAND], x=[0.001, -0.3, 0.9, 0.0], level=[0.001])
        sunk, here = -0.03 + 0.02, -0.01 - 0.001 - offset * 0.006
        pull, now = (min(1.0 + 30.0 * (each - 0.001), strength) for each in (sunk, here))
        tied = (now**2 - pull**2) / 60.0 - pull * (here - sunk)
        back = 0.5 * 2.0 * 0.09 * 1.25 / 50.0 + 0.5 * 0.81 / 40.0 + 0.5 * 2.5 * (9.0 * 0.006) ** 2
        turned = abs(pull * offset) * (0.006 + 0.01)
        given = devices, Moment(y, contact, supports)
        values = {"lowest__plastic": -0.02, "peak__theta": 0.01}
        _, waiting = uncompiled(waiting_after, ("springs.ending", "_set_load_and_energy"), values, m, *given)
        assert waiting["load"] == pytest.approx(FIG5.gravity + pull, rel=1e-12)
        expected = max(tied + back, 0.0) + turned - 0.5 * 2.5 * (9.0 * 0.01) ** 2
        assert waiting["stored"] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    ("values", "due"),
    [
        ({"clock__sample": 90.0}, 100.0),  # not before residuals may be read
        ({"peak__decided_at": -1.0}, 111.0),
        ({"waiting__read_wait": 0.0}, 200.0),  # nothing to read twice: the end of the quiet time
        ({"waiting__read_wait": 0.0, "clock__samples": 50.0}, 111.0),
        ({}, 150.0),  # it stands a period of rocking after a pivot moved last
        ({"tally__moved": 1.27}, 177.0),
        ({"waiting__read_by": 130.0}, 130.0),
        ({"waiting__read_by": 105.0}, 111.0),
        ({"waiting__read": 105.0, "waiting__last_read": 105.0}, 111.0),  # a mean is taken
        ({"waiting__read": 85.0, "waiting__last_read": 105.0}, 125.0),
        ({"waiting__read": 85.0, "waiting__last_read": 105.0, "clock__samples": 115.0}, 115.0),
        ({"waiting__read": 85.0, "waiting__last_read": 105.0, "clock__samples": 110.0}, 111.0),
    ],
)  # fmt: skip
def test_a_run_is_next_looked_at_when_it_may_be_over_or_has_something_to_read(values, due, uncompiled):
    common = {
        "clock__sample": 110.0, "clock__samples": 200.0, "clock__npts": 100.0, "clock__dt": 0.01, "tally__moved": 0.5,
        "peak__decided_at": 105.0, "waiting__earliest": 100.0, "waiting__read_wait": 20.0, "waiting__read_by": 190.0,
        "waiting__read": -1.0, "waiting__period": 0.5 + 1e-9,
    }  # fmt: skip
    assert uncompiled(waiting_after, ("springs.ending", "_next_due"), common | values)[0] == due


@pytest.mark.parametrize("spring", ["bouc-wen", "epp"])
def test_a_run_that_nothing_decided_says_what_it_was_doing(spring, uncompiled):
    """Cut off as it is, out of balance, leaning further in rotation and in the tilt of its base, or restless."""
    base = YieldingBase(50.0, 0.1, eta=3.0, spring=spring)
    m, b, alpha = springs(FIG5, base), FIG5.half_width, FIG5.alpha
    tilted = 0.001
    flat, lying = Supports(-0.01 + tilted * b, -0.01 - tilted * b), State(0.0, 0.9 * math.pi, 0.0, 0.0, 0.0, 0.0)
    y, air = State(0.0, 0.01, 0.0, 0.0, 0.0, 0.0), Contact(0.0, 0.0, 0.0, 0.0, 0.0)
    common = {"waiting__patience": 50.0, "waiting__load": FIG5.gravity, "clock__alpha": alpha, "peak__theta": 0.02}
    behind = GROWING if spring == "bouc-wen" else RESTLESS
    for changes, state, status in (
        ({"waiting__patience": 0.0}, lying, SURVIVED),
        ({}, lying, UNDECIDED),
        ({}, y, behind),
        ({"waiting__midway": 0.02 - 0.9e-4 * alpha}, y, RESTLESS),
        ({"waiting__midway": 0.02 - 1.1e-4 * alpha, "waiting__midway_tilt": tilted - 1.1e-4 * alpha}, y, behind),
        ({"waiting__midway_tilt": tilted - 0.9e-4 * alpha}, y, RESTLESS),
    ):
        values = common | {"waiting__midway": 0.01, "waiting__midway_tilt": 0.0} | changes
        now = Moment(state, air, flat)
        assert uncompiled(waiting_after, ("springs.ending", "_given_up"), values, m, now)[0] == status, changes


def test_a_pier_stands_once_both_pivots_have_borne_for_a_period(uncompiled):
    common = {
        "clock__dt": 0.01,
        "clock__npts": 100.0,
        "tally__moved": 1.2,
        "waiting__period": 0.1 - 1e-9,
        "waiting__read_by": 150.0,
    }
    for sample, left, right, stands in ((130, 1, 1, True), (129, 1, 1, False), (130, 0, 1, False), (130, 1, 0, False)):
        contact, values = Contact(left, right, 0.0, 0.0, 0.0), common | {"clock__sample": float(sample)}
        for name in ("_stands", "_legible"):
            assert uncompiled(waiting_after, ("springs.ending", name), values, contact)[0] == stands
        due = values | {"waiting__read_by": float(sample)}
        assert uncompiled(waiting_after, ("springs.ending", "_legible"), due, contact)[0]
