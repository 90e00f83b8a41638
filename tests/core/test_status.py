"""When a run is over, at single samples: of a block, of one on springs, and of one whose shaft bends."""

import math
from dataclasses import replace

import pytest
from core_samples import FIG5, status_of

from rockbatch.core.block.model import Rocking, Stance
from rockbatch.core.devices.laws import FRICTION
from rockbatch.core.flexure.model import Flexing
from rockbatch.core.types import RESTLESS, RUNNING, SURVIVED, UNDECIDED, Moment
from rockbatch.pier import Pier, RigidBase, YieldingBase
from rockbatch.simulation import block, springs
from rockbatch.simulation.elements import IDLE
from rockbatch.simulation.models import flexible_block

BOTH, NONE, RIGHT, LEFT = Stance(1, 1, 0, 0), Stance(0, 0, 1, 1), Stance(0, 1, 1, 1), Stance(1, 0, -1, -1)
COMMON = {
    "clock__sample": 120.0, "clock__samples": 110.0, "clock__npts": 100.0, "clock__dt": 0.01,
    "ground__horizontal": 0.0, "ground__vertical": 0.0, "peak__theta": 0.05,
}  # fmt: skip
BLOCK = COMMON | {"ending__longest": 150.0, "ending__omega": 0.0, "ending__turned": 0.0}
PIER = Pier(0.2, 2.5)
LIFTED, ROCKS = 0.04, 0.9  # rad; of p, enough to overturn
BRAKE = IDLE._replace(kind=FRICTION, strength=50.0, offset=-PIER.half_width)


@pytest.mark.parametrize(
    ("contact", "theta", "omega", "values", "status"),
    [
        (BOTH, 0.0, 0.0, {}, SURVIVED),
        (BOTH, 0.0, 0.0, {"clock__sample": 109.0}, RUNNING),  # the quiet time goes on
        (BOTH, 0.0, 0.0, {"clock__sample": 110.0}, SURVIVED),
        (RIGHT, LIFTED, 0.0, {}, SURVIVED),  # it reaches 0.04 of a peak of 0.05
        (LEFT, -LIFTED, 0.0, {}, SURVIVED),
        (RIGHT, LIFTED, 0.0, {"peak__theta": 0.0401}, SURVIVED),
        (RIGHT, LIFTED, 0.0, {"peak__theta": 0.0399}, RUNNING),
        (LEFT, -LIFTED, 0.0, {"peak__theta": 0.0399}, RUNNING),
        (RIGHT, LIFTED, 0.0, {"peak__theta": 0.0399, "ending__turned": 1.0}, SURVIVED),
        (RIGHT, LIFTED, -0.01, {"peak__theta": 0.0399, "ending__omega": 0.01}, SURVIVED),  # it has just turned
        (RIGHT, LIFTED, -0.01, {"peak__theta": 0.0399, "ending__omega": 0.01, "ground__vertical": 0.1}, RUNNING),
        (RIGHT, LIFTED, -0.01, {"peak__theta": 0.0399, "ending__omega": -0.01}, RUNNING),
        (RIGHT, LIFTED, 0.0, {"ground__horizontal": 0.1}, RUNNING),  # never while the ground moves
        (RIGHT, LIFTED, ROCKS, {"ending__turned": 1.0}, RUNNING),
        (NONE, LIFTED, 0.0, {}, RUNNING),  # nor in flight
        (RIGHT, LIFTED, ROCKS, {"clock__sample": 149.0}, RUNNING),
        (RIGHT, LIFTED, ROCKS, {"clock__sample": 150.0}, UNDECIDED),
        (RIGHT, LIFTED, 0.0, {"clock__sample": 150.0, "peak__theta": 0.03}, RESTLESS),
        (RIGHT, 0.001, 0.15, {"clock__sample": 150.0, "peak__theta": 0.03}, RESTLESS),
        (RIGHT, 0.21, 0.0, {"clock__sample": 150.0, "peak__theta": 0.21}, UNDECIDED),  # beyond α
        (RIGHT, LIFTED, ROCKS, {"ending__longest": 110.0}, SURVIVED),  # nothing is waited for
    ],
)  # fmt: skip
def test_a_run_of_a_block_is_over_when_nothing_can_exceed_its_peak(contact, theta, omega, values, status, uncompiled):
    m, moment = block(PIER, RigidBase()), Moment(Rocking(0.0, theta, 0.0, omega * PIER.p), contact, None)
    found, due, _ = uncompiled(status_of, m, moment, BLOCK | values)
    assert (found, due) == (status, values.get("clock__sample", 120.0) + 1.0)


def test_a_block_is_not_looked_at_before_its_record_ends(uncompiled):
    m, rests = block(PIER, RigidBase()), Moment(Rocking(0.0, 0.0, 0.0, 0.0), BOTH, None)
    found = uncompiled(status_of, m, rests, BLOCK | {"clock__sample": 20.0})
    assert found[:2] == (RUNNING, 99.0)


@pytest.mark.parametrize(
    ("contact", "omega", "before", "after"),
    [
        (RIGHT, 0.2, (0.1, 0.0), (0.2, 0.0)), (RIGHT, -0.2, (0.1, 0.0), (-0.2, 1.0)), (LEFT, 0.2, (-0.1, 0.0), (0.2, 1.0)),
        (RIGHT, 0.2, (0.1, 1.0), (0.2, 1.0)), (RIGHT, 0.2, (0.0, 0.0), (0.2, 0.0)), (NONE, 0.2, (-0.1, 1.0), (0.0, 0.0)),
        (LEFT, 0.2, (0.3, 1.0), (0.2, 1.0)),
    ],
)  # fmt: skip
def test_a_velocity_reversal_counts_while_the_block_is_on_the_ground_at_rest(contact, omega, before, after, uncompiled):
    m, moment = block(PIER, RigidBase()), Moment(Rocking(0.0, LIFTED, 0.0, omega), contact, None)
    values = BLOCK | dict(zip(("ending__omega", "ending__turned"), before, strict=True))
    *_, lane = uncompiled(status_of, m, moment, values)
    assert (lane["ending__omega"], lane["ending__turned"]) == after
    if contact != NONE:
        *_, lane = uncompiled(status_of, m, moment, values | {"ground__horizontal": 0.1})
        assert (lane["ending__omega"], lane["ending__turned"]) == before


@pytest.mark.parametrize(
    ("theta", "omega", "status"), [(0.1, 0.0, SURVIVED), (0.21, 0.0, UNDECIDED), (0.1, 0.5, RUNNING)]
)
def test_a_block_that_friction_holds_at_a_tilt_has_survived_below_its_slenderness(theta, omega, status, uncompiled):
    m, moment = block(PIER, RigidBase()), Moment(Rocking(0.0, theta, 0.0, omega), RIGHT, None)
    assert uncompiled(status_of, m, moment, BLOCK | {"peak__theta": 0.11}, [BRAKE])[0] == status


BENT = replace(Pier.rectangle(8.0, 40.0), flexural_period_s=0.9)
FLEXIBLE = COMMON | {"ending__longest": 150.0}


@pytest.mark.parametrize(
    ("contact", "theta", "u_rate", "values", "status"),
    [
        (BOTH, 0.0, 0.0, {}, SURVIVED),
        (BOTH, 0.0, 0.0, {"clock__sample": 109.0}, RUNNING),
        (BOTH, 0.0, 0.0, {"clock__sample": 110.0}, SURVIVED),
        (BOTH, 0.0, 0.0, {"ground__horizontal": 0.1}, RUNNING),
        (BOTH, 0.0, 5.0, {}, RUNNING),  # it may lift a foot
        (RIGHT, LIFTED, 0.0, {}, SURVIVED),
        (RIGHT, LIFTED, 0.0, {"peak__theta": 0.03}, RUNNING),
        (NONE, LIFTED, 0.0, {}, RUNNING),
        (NONE, LIFTED, 0.0, {"clock__sample": 149.0}, RUNNING),
        (NONE, LIFTED, 0.0, {"clock__sample": 150.0}, RESTLESS),
        (NONE, LIFTED, 99.0, {"clock__sample": 150.0}, UNDECIDED),
        (NONE, LIFTED, 99.0, {"ending__longest": 110.0}, SURVIVED),
    ],
)  # fmt: skip
def test_a_run_of_a_pier_that_bends_is_over_when_nothing_can_exceed_its_peak(
    contact, theta, u_rate, values, status, uncompiled
):
    m = flexible_block(BENT, RigidBase(shaft="elastic"))
    b, h = BENT.half_width, BENT.height
    v = b * math.sin(theta) - h * (1.0 - math.cos(theta))
    found, due, _ = uncompiled(
        status_of, m, Moment(Flexing(v, theta, *(6 * [0.0]), u_rate, 0.0, 0.0, 0.0), contact, None), FLEXIBLE | values
    )
    assert (found, due) == (status, values.get("clock__sample", 120.0) + 1.0)


SPRINGS = COMMON | {
    "peak__decided_at": -1.0, "tally__moved": 0.5, "waiting__earliest": 100.0, "waiting__patience": 80.0,
    "waiting__longest": 190.0, "waiting__read_wait": 30.0, "waiting__read_by": 180.0, "waiting__read": -1.0,
    "waiting__last_read": -1.0, "waiting__load": FIG5.gravity, "waiting__period": 0.05, "waiting__midway": math.inf,
    "waiting__midway_tilt": math.inf, "clock__alpha": FIG5.alpha,
}  # fmt: skip


@pytest.mark.parametrize(
    ("values", "status", "decided", "read"),
    [
        ({"clock__sample": 99.0}, RUNNING, -1.0, -1.0),
        ({}, RUNNING, 120.0, 120.0),  # it stands: the peak is final, and residuals are read for the first time
        ({"tally__moved": 1.18}, RUNNING, 120.0, -1.0),  # a pivot moved less than a period of rocking ago
        ({"ground__horizontal": 0.1}, RUNNING, -1.0, -1.0),
        ({"peak__decided_at": 115.0}, RUNNING, 115.0, 120.0),
        ({"peak__decided_at": 115.0, "tally__moved": 1.18}, RUNNING, 115.0, -1.0),
        ({"peak__decided_at": 115.0, "tally__moved": 1.18, "waiting__read_by": 120.0}, RUNNING, 115.0, 120.0),
        ({"ground__horizontal": 0.1, "waiting__read_by": 120.0}, RUNNING, -1.0, 120.0),
        ({"peak__decided_at": 101.0, "waiting__read": 101.0, "waiting__last_read": 101.0}, RUNNING, 101.0, 101.0),
        ({"peak__decided_at": 90.0, "waiting__read": 90.0, "waiting__last_read": 90.0}, SURVIVED, 90.0, 90.0),
        ({"peak__decided_at": 90.0, "waiting__read": 90.0, "waiting__last_read": 90.0, "clock__samples": 121.0},
         RUNNING, 90.0, 90.0),
        ({"waiting__read": 91.0, "waiting__last_read": 91.0}, RUNNING, 120.0, 91.0),
        ({"waiting__read": 90.0, "waiting__last_read": 90.0}, SURVIVED, 120.0, 90.0),
        ({"waiting__read": 0.0, "waiting__last_read": 90.0}, SURVIVED, 120.0, 0.0),
        ({"waiting__read_wait": 0.0}, SURVIVED, 120.0, 120.0),
        ({"waiting__read_wait": 0.0, "peak__decided_at": 105.0}, SURVIVED, 105.0, -1.0),
        ({"waiting__read_wait": 0.0, "peak__decided_at": 105.0, "clock__samples": 121.0}, RUNNING, 105.0, -1.0),
        ({"ground__horizontal": 0.1, "waiting__longest": 121.0}, RUNNING, -1.0, -1.0),
        ({"ground__horizontal": 0.1, "waiting__longest": 120.0}, RESTLESS, -1.0, -1.0),
        ({"ground__horizontal": 0.1, "waiting__longest": 120.0, "waiting__patience": 0.0}, SURVIVED, -1.0, -1.0),
    ],
)  # fmt: skip
def test_a_run_on_springs_is_over_when_its_residuals_have_been_read_twice(values, status, decided, read, uncompiled):
    m = springs(FIG5, YieldingBase(50.0, 0.1, eta=3.0))
    found, _, lane = uncompiled(status_of, m, None, SPRINGS | values)
    assert (found, lane["peak__decided_at"], lane["waiting__read"]) == (status, decided, read)


@pytest.mark.parametrize(
    ("samples", "longest", "noted"), [(110.0, 131.0, True), (110.0, 132.0, False), (110.0, 130.0, True)]
)
def test_half_of_the_waiting_is_noted_between_the_quiet_time_and_its_end(samples, longest, noted, uncompiled):
    m = springs(FIG5, YieldingBase(50.0, 0.1, eta=3.0))
    values = SPRINGS | {"clock__samples": samples, "waiting__longest": longest, "ground__horizontal": 0.1}
    *_, lane = uncompiled(status_of, m, None, values)
    assert (lane["waiting__midway"], lane["waiting__midway_tilt"]) == ((0.05, 0.0) if noted else (math.inf, math.inf))
