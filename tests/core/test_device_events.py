"""Events of single devices: what each waits for, what it becomes behind it, and when friction lets go."""

import math

import pytest
from core_samples import FIG5, after_event, device_signals, friction_signals, held_motion, longest_step, values_of

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
)
from rockbatch.core.types import Ground, Moment
from rockbatch.pier import Pier, RigidBase
from rockbatch.simulation import block
from rockbatch.simulation.elements import IDLE

REST, LENGTH = 1e-9, 1e-12
TIE = IDLE._replace(kind=TENDON, strength=4.0, stiffness=30.0, prestress=1.0)
HUNG = IDLE._replace(kind=MAXWELL, stiffness=40.0, coefficient=3.0, exponent=1.0)
STOP = IDLE._replace(kind=CONTACT, stiffness=80.0, start=0.05, returned=0.36)
RUBS, STEEL = IDLE._replace(kind=FRICTION, strength=2.0), IDLE._replace(kind=HYSTERETIC, strength=2.0, stiffness=50.0)
OIL, BAND = IDLE._replace(kind=VISCOUS, coefficient=3.0, exponent=0.5), IDLE._replace(kind=SPRING, stiffness=25.0)
NONE = 1.0, 0.0


@pytest.mark.parametrize(
    ("of", "mode", "goes", "at", "turns", "slackens", "gives"),
    [
        # a tendon taut: its force 1 + 30 (e − u_0) to 0 and to 4; slack: from below to 0; yielding: until it shortens
        (TIE, TAUT, OPENS, (0.02, 0.3, 5.0, 0.01), NONE, (1.3, 9.0), (2.7, -9.0)),
        (TIE, SLACK, OPENS, (-0.05, 0.3, 5.0, 0.01), NONE, (0.8, -9.0), NONE),
        (TIE, YIELDING, CLOSES, (0.2, 0.3, -5.0, 0.01), (0.3, -5.0), NONE, NONE),
        (TIE, YIELDING, OPENS, (0.2, 0.0, 5.0, 0.01), (REST, 5.0), NONE, NONE),
        (TIE, TAUT, OPENS, (-1.0 / 30.0, 0.3, 5.0, 0.0), NONE, (30.0 * LENGTH, 9.0), (4.0, -9.0)),  # just taut
        (TIE, TAUT, OPENS, (-1.0 / 30.0, 0.01, 5.0, 0.0), NONE, (30.0 * LENGTH, 0.3), (4.0, -0.3)),
        (TIE, TAUT, OPENS, (0.1, -0.3, 5.0, 0.0), NONE, (4.0, -9.0), (30.0 * LENGTH, 9.0)),
        (TIE, SLACK, OPENS, (-1.0 / 30.0, 0.0, 5.0, 0.0), NONE, (30.0 * LENGTH, 0.0), NONE),  # it hangs there
        (TIE._replace(strength=math.inf), TAUT, OPENS, (0.02, 0.3, 5.0, 0.0), NONE, (1.6, 9.0), NONE),
        # a brace: until its force changes its sign
        (HUNG, TAUT, CLOSES, (0.1, 0.3, 5.0, -1.2), (1.2, -40.0 * (0.3 + 0.4)), NONE, NONE),
        (HUNG, TAUT, OPENS, (0.1, 0.3, 5.0, 0.0), (40.0 * LENGTH, 12.0), NONE, NONE),
        # dampers that go: until they turn
        (RUBS, TAUT, CLOSES, (0.1, -0.3, 5.0, 0.0), (0.3, -5.0), NONE, NONE),
        (RUBS, TAUT, CLOSES, (0.1, 0.0, -5.0, 0.0), (REST, 5.0), NONE, NONE),
        (RUBS, TAUT, STICKS, (0.1, 0.0, -5.0, 0.0), NONE, NONE, NONE),
        (STEEL, TAUT, OPENS, (0.1, 0.3, 5.0, 0.2), (0.3, 5.0), NONE, NONE),
        (OIL, TAUT, CLOSES, (0.1, -0.3, 5.0, 0.2), (0.3, -5.0), NONE, NONE),
        (OIL._replace(linear_below=math.inf), TAUT, CLOSES, (0.1, -0.3, 5.0, 0.2), NONE, NONE, NONE),
        # a stop on its first loading: until it turns; then until it is let go or pressed deeper; open: until it is met
        (STOP, YIELDING, OPENS, (0.07, 0.3, -5.0, 0.0), (0.3, -5.0), NONE, NONE),
        (STOP, YIELDING, OPENS, (0.07, 0.0, 5.0, 0.0), (REST, 5.0), NONE, NONE),
        (STOP, YIELDING, OPENS, (0.07, 0.0, -5.0, 0.0), (0.0, -5.0), NONE, NONE),
        (STOP, TAUT, OPENS, (0.075, -0.3, 5.0, 0.03), NONE, (0.025 - 0.03 * 0.64, -0.3), (0.005, 0.3)),
        (STOP, TAUT, OPENS, (0.08, -0.3, 5.0, 0.03), NONE, (0.03 * 0.36, -0.3), (LENGTH, 0.3)),
        (STOP, SLACK, OPENS, (0.02, 0.3, 5.0, 0.0), NONE, (0.03, -0.3), NONE),
        (STOP, SLACK, OPENS, (0.06, -0.3, 5.0, 0.03), NONE, (0.03 * 0.64 - 0.01, 0.3), (0.01, -0.3)),
    ],
)  # fmt: skip
def test_a_device_waits_for_its_events(of, mode, goes, at, turns, slackens, gives, uncompiled):
    """Values and slopes by hand; what has just changed, or hangs on zero, is above it by rounding."""
    values, slopes = uncompiled(device_signals, of, mode, goes, at)
    expected = turns, slackens, gives
    assert values == pytest.approx([value for value, _ in expected], rel=1e-9, abs=1e-15)
    assert slopes == pytest.approx([slope for _, slope in expected], rel=1e-9, abs=1e-15)


THETA, OMEGA = 0.1, 0.2
RIGHT, LEFT = Stance(0.0, 1.0, 1.0, 1.0), Stance(1.0, 0.0, -1.0, -1.0)


M = block(FIG5, RigidBase())


def rocking(omega: float, m=M) -> Moment:
    """A block on its right pivot: a device at its left one lengthens."""
    b, h = m.half_width, m.height
    v = b * math.sin(THETA) - h * (1.0 - math.cos(THETA))
    return Moment(Rocking(v, THETA, (b * math.cos(THETA) - h * math.sin(THETA)) * omega, omega), RIGHT, None)


LIFT = 4.0 * FIG5.half_width * math.sin(0.5 * THETA)  # 2 d sin(θ/2), d = 2b


@pytest.mark.parametrize(
    ("of", "mode", "goes", "state", "what", "omega", "after"),
    [
        (TIE, TAUT, OPENS, 0.0, 1, OMEGA, (SLACK, OPENS, 0.0, 1.0)),
        (TIE, SLACK, OPENS, 0.0, 1, OMEGA, (TAUT, OPENS, 0.0, 0.0)),
        (TIE, TAUT, OPENS, 0.0, 2, OMEGA, (YIELDING, OPENS, 0.0, 0.0)),
        (TIE, YIELDING, OPENS, 0.3, 0, OMEGA, (TAUT, OPENS, 0.3, 0.0)),
        (TIE._replace(prestress=0.0), TAUT, OPENS, 0.0, 1, OMEGA, (SLACK, OPENS, 0.0, 0.0)),
        (TIE._replace(prestress=0.0), TAUT, OPENS, 0.01, 1, OMEGA, (SLACK, OPENS, 0.01, 1.0)),
        (STOP, YIELDING, OPENS, 0.0, 0, OMEGA, (TAUT, OPENS, LIFT - 0.05, 0.0)),
        (STOP, TAUT, OPENS, 0.1, 1, OMEGA, (SLACK, OPENS, 0.1, 0.0)),
        (STOP, TAUT, OPENS, 0.1, 2, OMEGA, (YIELDING, OPENS, 0.1, 0.0)),
        (STOP._replace(returned=1.0), TAUT, OPENS, 0.1, 1, OMEGA, (SLACK, OPENS, 0.0, 0.0)),
        (STOP._replace(returned=1.0), TAUT, OPENS, 0.1, 2, OMEGA, (YIELDING, OPENS, 0.1, 0.0)),
        (STOP, SLACK, OPENS, 0.1, 2, OMEGA, (SLACK, OPENS, 0.0, 0.0)),
        (STOP, SLACK, OPENS, 0.1, 1, OMEGA, (TAUT, OPENS, 0.1, 0.0)),
        (STOP, SLACK, OPENS, 0.0, 1, OMEGA, (YIELDING, OPENS, 0.0, 1.0)),
        (HUNG, TAUT, OPENS, 0.0, 0, OMEGA, (TAUT, CLOSES, 0.0, 0.0)),
        (STEEL, TAUT, OPENS, 0.5, 0, OMEGA, (TAUT, CLOSES, 0.5, 0.0)),
        (OIL, TAUT, CLOSES, 0.0, 0, OMEGA, (TAUT, OPENS, 0.0, 0.0)),
        # behind an impact of the pier
        (TIE, YIELDING, OPENS, 0.3, None, -OMEGA, (TAUT, OPENS, 0.3, 0.0)),
        (TIE, YIELDING, OPENS, 0.3, None, OMEGA, (YIELDING, OPENS, 0.3, 0.0)),
        (TIE, TAUT, OPENS, LIFT - 0.1, None, OMEGA, (YIELDING, OPENS, LIFT - 0.1, 0.0)),
        (TIE, TAUT, OPENS, LIFT - 0.1, None, -OMEGA, (TAUT, OPENS, LIFT - 0.1, 0.0)),
        (TIE, TAUT, OPENS, LIFT - 0.09, None, OMEGA, (TAUT, OPENS, LIFT - 0.09, 0.0)),
        (STOP, YIELDING, OPENS, 0.0, None, -OMEGA, (TAUT, OPENS, LIFT - 0.05, 0.0)),
        (STOP, YIELDING, OPENS, 0.0, None, OMEGA, (YIELDING, OPENS, 0.0, 0.0)),
        (STOP, TAUT, OPENS, LIFT - 0.06, None, OMEGA, (YIELDING, OPENS, LIFT - 0.06, 0.0)),
        (STOP, TAUT, OPENS, LIFT - 0.04, None, OMEGA, (TAUT, OPENS, LIFT - 0.04, 0.0)),
        (STOP, TAUT, OPENS, LIFT - 0.06, None, -OMEGA, (TAUT, OPENS, LIFT - 0.06, 0.0)),
        (HUNG, TAUT, OPENS, 0.7, None, -OMEGA, (TAUT, OPENS, 0.7, 0.0)),
        (STEEL, TAUT, OPENS, 0.7, None, -OMEGA, (TAUT, CLOSES, 0.7, 0.0)),
        (RUBS, TAUT, CLOSES, 0.0, None, OMEGA, (TAUT, OPENS, 0.0, 0.0)),
        (STEEL, TAUT, OPENS, 0.7, None, 0.0, (TAUT, OPENS, 0.7, 0.0)),
        (RUBS._replace(strength=200.0), TAUT, OPENS, 0.0, None, 0.0, (TAUT, STICKS, 0.0, 0.0)),
        (RUBS._replace(strength=0.0), TAUT, OPENS, 0.0, None, 0.0, (TAUT, OPENS, 0.0, 0.0)),
        (RUBS._replace(strength=0.01), TAUT, OPENS, 0.0, None, 0.0, (TAUT, CLOSES, 0.0, 0.0)),  # the weight takes it along
        # friction that turns holds if it can, else goes on; that lets go goes where the weight takes it
        (RUBS._replace(strength=200.0), TAUT, OPENS, 0.0, 0, 0.0, (TAUT, STICKS, 0.0, 0.0)),
        (RUBS._replace(strength=0.01), TAUT, OPENS, 0.0, 0, 0.0, (TAUT, CLOSES, 0.0, 0.0)),
        (RUBS._replace(strength=0.01), TAUT, STICKS, 0.0, 2, 0.0, (TAUT, CLOSES, 0.0, 0.0)),
    ],
)  # fmt: skip
def test_a_device_is_behind_an_event_what_it_has_become(of, mode, goes, state, what, omega, after, uncompiled):
    """Mode, direction, state and how often it has gone slack or been met; an elongation of 4 b sin(θ/2)."""
    of = of._replace(offset=-FIG5.half_width)
    found = uncompiled(after_event, block(FIG5, RigidBase()), rocking(omega), of, mode, goes, state, what)
    assert found == pytest.approx(after, rel=1e-9)


FRAME = Pier.frame(Pier.rectangle(2.0, 12.0, mass_t=60.0), 4, 180.0)


@pytest.mark.parametrize("pier", [FIG5, FRAME], ids=["block", "frame"])
@pytest.mark.parametrize("offset", [-1.0, 0.0])
@pytest.mark.parametrize("push", [0.0, 3.0, -5.0])
def test_friction_holds_a_block_until_weight_and_ground_exceed_it(offset, push, pier, uncompiled):
    """F 2d cos(θ/2)/2 = −(g + v̈_g) ∂v/∂θ − ü_g H about the pivot, d away; it lets go towards what exceeds it.

    Of a frame, d is measured on a column, narrower than the equivalent block.
    """
    m = block(pier, RigidBase())
    b, h, y, width = m.half_width, m.height, rocking(0.0, m).y, pier.half_width
    ground = Ground(push, 7.0, 0.4, -2.0)
    slope, height = b * math.cos(THETA) - h * math.sin(THETA), h * math.cos(THETA) + b * math.sin(THETA)
    arm = (1.0 - offset) * width * math.cos(0.5 * THETA)
    holds = -((pier.gravity + 0.4) * slope + push * height) / arm
    change = -(-2.0 * slope + 7.0 * height) / arm
    for factor in (0.999, 1.001):
        strength = factor * abs(holds)
        values, slopes, goes = uncompiled(friction_signals, m, y, RIGHT, ground, offset * width, strength)
        assert values == pytest.approx([1.0] * 6 + [strength - abs(holds)], rel=1e-9, abs=1e-9)
        assert slopes == pytest.approx([0.0] * 6 + [-math.copysign(change, holds * change)], rel=1e-3)
        assert goes == (STICKS if factor > 1.0 else math.copysign(1.0, holds))


@pytest.mark.parametrize("offset", [-1.0, 0.0])
def test_the_force_of_friction_that_holds_is_a_tension_where_a_device_would_lengthen(offset, uncompiled):
    """The weight closes a tilted block, so friction pushes; a ground that accelerates to the left opens it."""
    rubs, y = RUBS._replace(offset=offset * FIG5.half_width), rocking(0.0).y
    for push, sign in ((0.0, -1.0), (-5.0, 1.0)):
        motion = uncompiled(held_motion, M, y, RIGHT, Ground(push, 0.0, 0.0, 0.0), [rubs])
        assert motion.free.omega * sign > 0.0
        assert motion.forces[0] * sign > 0.0
        assert motion.held.omega == pytest.approx(0.0, abs=1e-12)


B = FIG5.half_width
ABOVE = IDLE._replace(height=9.0, way=1.0)


@pytest.mark.parametrize(
    ("of", "right", "left", "aloft"),
    [
        (IDLE, OPENS, OPENS, OPENS),
        (IDLE._replace(offset=0.9 * B), OPENS, OPENS, OPENS),
        (IDLE._replace(offset=1.1 * B), CLOSES, OPENS, OPENS),
        (IDLE._replace(offset=-1.1 * B), OPENS, CLOSES, OPENS),
        (IDLE._replace(offset=B), STICKS, OPENS, OPENS),
        (ABOVE, OPENS, CLOSES, OPENS),
        (ABOVE._replace(way=-1.0), CLOSES, OPENS, OPENS),
    ],
)
def test_a_device_lengthens_or_shortens_by_where_it_is_as_the_pier_begins_to_turn(of, right, left, aloft, uncompiled):
    """Below the base it lengthens but for one beyond the pivot or at it; at the deck towards its own side."""
    m, stances = block(FIG5, RigidBase()), (RIGHT, LEFT, Stance(0.0, 0.0, 1.0, 1.0))
    found = uncompiled(values_of, [("devices.pull", "way_of_opening", m, of, stance) for stance in stances])
    assert tuple(found) == (right, left, aloft)


def test_a_hysteretic_damper_is_drawn_out_by_half_its_yield_deflection_in_a_step(uncompiled):
    """Of a sample's length, at a speed beside which the acceleration adds a hundredth."""
    speed, dt = 2.0 * B * math.cos(0.5 * THETA) * 20.0, 0.01
    for stiffness in (50.0, 100.0):
        steel = STEEL._replace(offset=-B, stiffness=stiffness)
        longest = uncompiled(longest_step, block(FIG5, RigidBase()), rocking(20.0), steel, dt)
        assert longest * speed == pytest.approx(0.5 / stiffness, rel=0.02)


def test_a_brace_whose_damper_still_rests_is_resolved_by_the_speed_of_its_ends(uncompiled):
    """The step is 0.2 over the rate of relaxation, which grows with |ė| to the power of 1 − a."""
    m, dt = block(FIG5, RigidBase()), 0.01
    hung = HUNG._replace(offset=-B, exponent=0.5, quickest=1e3)
    for omega in (OMEGA, 4.0 * OMEGA):
        speed = 2.0 * B * math.cos(0.5 * THETA) * omega
        longest = uncompiled(longest_step, m, rocking(omega), hung, dt)
        assert longest == pytest.approx(0.2 / (1e3 * math.sqrt(speed)), rel=1e-9)
        assert longest < dt
