"""One pass over all lanes that rock: a step each, where arithmetic proves that nothing happens on the way.

The compiler makes vector instructions of the loop, because nothing in it branches and the numbers of a field lie next to
each other. A lane's arithmetic does not see its neighbours, so a run comes to the same bits in any company.
"""

from rockbatch.core.kernel import inlined
from rockbatch.core.outcome import ON_ITS_SIDE
from rockbatch.core.rigid.equations import acceleration, later, rocking_step
from rockbatch.core.rigid.landing import inner_points, stays
from rockbatch.core.rigid.lane import (
    ARRIVED,
    CALM,
    EVENTFUL,
    SAMPLED,
    block_in,
    ground_in,
    motion_in,
)


@inlined
def _pass_over(lanes, i):
    """Lane ``i`` a step further if the step is calm; and what news there are of it.

    It is calm if the block surely stays on its corner (``stays``); does not fall on its side; has no new peak but at the
    end of the step; and the ground, linear in time, carries it at both ends.
    """
    clock, ending, peak, window = lanes.clock, lanes.ending, lanes.peak, lanes.window
    m, y = block_in(lanes, i), motion_in(lanes, i)
    h, start = clock.step[i], clock.substep[i] * clock.step[i]
    ground = later(ground_in(lanes, i), start)
    k1 = acceleration(m, y.theta, y.side, ground.horizontal, ground.vertical)
    end = rocking_step(m, y, k1, ground, h)

    tilt_end = y.side * end.theta
    early, late = inner_points(y, end, h)
    turns = y.omega * end.omega < 0.0
    unseen = turns and max(early, late) > peak.theta[i]
    carried = min(ground.vertical, ground.vertical + h * ground.vertical_slope) > -m.gravity
    calm = stays(y, end, h) and tilt_end < ON_ITS_SIDE and carried and not unseen

    substep = clock.substep[i] + 1.0
    sampled = calm and substep == clock.substeps[i]
    sample = clock.sample[i] + (1.0 if sampled else 0.0)
    higher = calm and tilt_end > peak.theta[i]
    seen = calm and turns and ending.ground_rests[i] != 0.0
    peak.theta[i] = tilt_end if higher else peak.theta[i]
    peak.time[i] = clock.time[i] + start + h if higher else peak.time[i]
    ending.turned[i] = 1.0 if seen else ending.turned[i]
    lanes.now.theta[i] = end.theta if calm else y.theta
    lanes.now.omega[i] = end.omega if calm else y.omega
    clock.substep[i] = (0.0 if sampled else substep) if calm else clock.substep[i]
    clock.sample[i] = sample
    clock.time[i] = sample * clock.dt[i]
    lanes.tally.events[i] = 0.0 if sampled else lanes.tally.events[i]
    arrived = sample >= ending.milestone[i]
    greater = sampled and not arrived and not tilt_end <= window.greatest[i]
    window.greatest[i] = tilt_end if greater else window.greatest[i]
    stepped = (ARRIVED if arrived else SAMPLED) if sampled else CALM
    lanes.report.news[i] = stepped if calm else EVENTFUL


@inlined
def one_pass(lanes, count):
    """The first ``count`` lanes, none of them at rest."""
    for i in range(count):
        _pass_over(lanes, i)
