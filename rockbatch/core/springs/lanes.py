"""Lanes of piers on springs: what a table holds of them, how runs begin and end."""

from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.clock import COMMON, TIMING, ground_at, include_height
from rockbatch.core.ground import later
from rockbatch.core.history import write
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.rk4 import rk4
from rockbatch.core.roots import lowest_within
from rockbatch.core.springs import events  # noqa: F401  answers of the springs
from rockbatch.core.springs.ending import Waiting, base_of
from rockbatch.core.springs.laws import branch_when_pressed, curved, deflection, yield_point
from rockbatch.core.springs.loading import BranchChange, Loading, branch_change, branches
from rockbatch.core.springs.model import NUMBERS, Contact, Numbers, Springs, SpringTraits, State, Supports
from rockbatch.core.springs.passing import StepStatus
from rockbatch.core.springs.reversal import pivots
from rockbatch.core.springs.transitions import with_yield_points
from rockbatch.core.system import Kind, model, moment, rates
from rockbatch.core.table import get, lanes_of, put, taken
from rockbatch.core.types import BEFORE_EVENT, SPRING_LEFT, SPRING_RIGHT


class Lowest(NamedTuple):
    """Lowest positions of the pivots on their springs."""

    left: float  # [m]
    right: float
    plastic: float  # unstressed position of both supports at the start [m]


LANE = lanes_of(COMMON | {
    "model": Numbers, "now": State, "end": State, "rates": State, "contact": Contact, "supports": Supports,
    "loading": Loading, "lowest": Lowest, "step_status": StepStatus, "waiting": Waiting,
})  # fmt: skip


LINE = (
    *NUMBERS, *TIMING,
    ("read_after", float),  # samples from the end of the record to the earliest moment at which residuals are read
    ("read_wait", float),  # from there to the second reading, which tells how they drift; 0: once the peak is decided
    ("prestress", float),  # of tendons, over the mass [m/s²]
    ("v", float),  # where the pier is held at the start [m], if it is held at a rotation
    ("theta", float),  # [rad]; 0 for the static state
    ("z_left", float),
    ("z_right", float),
)  # fmt: skip
"""Fields of a run as it is asked for."""

Line = NamedTuple("Line", LINE)  # type: ignore[misc]


@inlined
def _typed(exponent, value):
    if isinstance(exponent, int):
        return int(value)
    if isinstance(exponent, float):
        return value
    return None


@system.model.of(SpringTraits)
def model_in(traits, lanes, i):
    """Return the Springs of lane ``i``, of the types that ``traits`` have."""
    m = get(lanes.model, i, Numbers)
    return Springs(
        m.half_width, m.height, m.inertia, m.gravity, m.yield_deflection, m.stiffness, m.yield_force, m.epsilon,
        m.damping, m.law, m.guided, _typed(traits.exponent, m.exponent), traits.finite, traits.damped, traits.pull,
    )  # fmt: skip


@system.moment.of(SpringTraits)
def moment_in(traits, lanes, i):
    """Return state, contact and supports of lane ``i``."""
    return get(lanes.now, i, State), get(lanes.contact, i, Contact), get(lanes.supports, i, Supports)


@system.put_moment.of(SpringTraits)
def put_moment(traits, lanes, i, y, contact, supports):
    """Write state, contact and supports of lane ``i``."""
    put(lanes.now, i, y)
    put(lanes.contact, i, contact)
    put(lanes.supports, i, supports)


@kernel
def static_state(m, load):
    """Return the equilibrium under the ``load`` [m/s²], of the weight and of tendons: z = −(1 + ψ)/η on first loading."""
    force = 0.5 * load / m.yield_force
    return State(-m.yield_deflection * deflection(m, force), 0.0, 0.0, 0.0, -force, -force)


@kernel
def static_contact(m, y):
    """Return contacts and supports in the static state ``y``, in first loading."""
    branch = 1.0 if curved(m.law) else 0.0
    point = yield_point(m.law, 0.0, y.z_left)
    return Contact(1.0, 1.0, branch, branch, 0.0), Supports(0.0, 0.0, point, point)


@kernel
def held_contact(m, y, z_static, plastic):
    """Return contacts and supports as the pier is let go in state ``y``, to which it was pulled from the static one.

    The side that was lifted is pressed next, and the one that was pressed is unloaded; a support without its pivot waits where it
    is unstressed, at ``plastic`` [m].
    """
    pressed, left, right = branch_when_pressed(m.law), y.z_left < 0.0, y.z_right < 0.0
    left_yields = pressed if left and y.theta > 0.0 else 0.0
    right_yields = pressed if right and y.theta < 0.0 else 0.0
    point = yield_point(m.law, 0.0, z_static)
    supports = Supports(plastic, plastic, yield_point(m.law, point, y.z_left), yield_point(m.law, point, y.z_right))
    return Contact(1.0 if left else 0.0, 1.0 if right else 0.0, left_yields, right_yields, 0.0), supports


@system.begin.of(SpringTraits)
def begin(traits, lanes, i, run):
    """Put the model of ``run`` into lane ``i``, in its static state or where it is held at a rotation."""
    put(lanes.model, i, taken(run, Numbers))
    pier = model(traits, lanes, i)
    y = static_state(pier, run.gravity + run.prestress)
    level, plastic = y.v, y.v - run.yield_deflection * y.z_left
    contact, supports = static_contact(pier, y)
    if run.theta != 0.0:
        z_static, y = y.z_left, State(run.v, run.theta, 0.0, 0.0, run.z_left, run.z_right)
        contact, supports = held_contact(pier, y, z_static, plastic)
    left, right = pivots(pier, y)
    unstressed_left = left.position - run.yield_deflection * y.z_left
    unstressed_right = right.position - run.yield_deflection * y.z_right
    put_moment(traits, lanes, i, y, contact, supports)
    put(lanes.loading, i, Loading(unstressed_left, y.z_left, 0.0, unstressed_right, y.z_right, 0.0))
    put(lanes.lowest, i, Lowest(min(level, left.position), min(level, right.position), plastic))
    lanes.step_status.watched[i] = 1.0


@system.include.of(SpringTraits)
def include(traits, lanes, i, m, y, k, end, k_end, contact, h):
    """Bring the lowest positions up to those of a smooth part of ``h`` [s]."""
    left, right = pivots(m, y)
    left_end, right_end = pivots(m, end)
    lowest = lanes.lowest
    if contact.left != 0.0:
        lowest.left[i] = lowest_within(
            left.position, left.velocity, left_end.position, left_end.velocity, h, lowest.left[i]
        )
    if contact.right != 0.0:
        lowest.right[i] = lowest_within(
            right.position, right.velocity, right_end.position, right_end.velocity, h, lowest.right[i]
        )


@system.after_event.of(SpringTraits)
def after_event(traits, lanes, i, m, before, after, y):
    """Keep where the branches of the springs began, and the plastic work of those that have ended."""
    put(lanes.loading, i, branches(m, get(lanes.loading, i, Loading), before, after, branch_change(m, y)))


@system.after_step.of(SpringTraits)
def after_step(traits, lanes, i, marks, contact, whole):
    """Let the pass take the next sub-step by itself, if all event functions are clear of zero at its start."""
    clear = whole and contact.held == 0.0 and min(marks.now[0], marks.now[1]) > 0.0
    for j in (2, 3):  # a velocity leaves zero
        clear = clear and (marks.now[j] > 0.0 or marks.now_slopes[j] > 0.0)
    lanes.step_status.watched[i] = 0.0 if clear else 1.0


@system.attend.of(SpringTraits)
def attend(traits, lanes, i, substep, history):
    """Take in extremes and reversals of a sub-step of lane ``i`` that stands; the lane goes on from its end."""
    m, h = model(traits, lanes, i), lanes.clock.step[i]
    y, end, contact = get(lanes.now, i, State), get(lanes.end, i, State), get(lanes.contact, i, Contact)
    if system.airborne(m, contact):
        include_height(lanes, i, m, get(lanes.supports, i, Supports), y, end, h)
    include(traits, lanes, i, m, y, y, end, end, contact, h)
    if lanes.step_status.keeps[i] < 0.0:
        _change_branches(traits, lanes, i, m, substep, history)
    put(lanes.now, i, end)


@kernel
def _change_branches(traits, lanes, i, m, substep, history):
    """Let the springs of lane ``i`` change their branches where their velocities reversed in its sub-step."""
    before, at, step_status = get(lanes.contact, i, Contact), get(lanes.step_status, i, BranchChange), lanes.step_status
    left, right = before.left_yields, before.right_yields
    after = Contact(
        before.left, before.right,
        1.0 - left if step_status.left[i] >= 0.0 else left, 1.0 - right if step_status.right[i] >= 0.0 else right, 0.0,
    )  # fmt: skip
    put(lanes.contact, i, after)
    put(lanes.loading, i, branches(m, get(lanes.loading, i, Loading), before, after, at))
    put(lanes.supports, i, with_yield_points(m, at, before, after, get(lanes.supports, i, Supports)))
    if history.rows.shape[0] > 0:
        _write_reversals(traits, lanes, i, m, substep, before, after, history)


@system.finish.of(SpringTraits)
def finish(traits, lanes, i, t, result):
    """Write residuals, extremes and plastic work of the run in lane ``i``."""
    m = model(traits, lanes, i)
    y, contact, supports = moment(traits, lanes, i)
    waiting, lowest = lanes.waiting, lanes.lowest
    t_read, base_left, base_right = waiting.read[i] * lanes.clock.dt[i], waiting.read_left[i], waiting.read_right[i]
    if waiting.read[i] < 0.0:
        t_read = t
        base_left, base_right = base_of(m, y, contact, supports)
    loading = branches(
        m, get(lanes.loading, i, Loading), contact, Contact(0.0, 0.0, 0.0, 0.0, 0.0), branch_change(m, y)
    )
    result.base_left = base_left - lowest.plastic[i]
    result.base_right = base_right - lowest.plastic[i]
    result.deepest_left = lowest.left[i]
    result.deepest_right = lowest.right[i]
    result.dissipated_left = m.yield_force * loading.work_left
    result.dissipated_right = m.yield_force * loading.work_right
    result.t_read = t_read
    result.drift_left = waiting.drift_left[i]
    result.drift_right = waiting.drift_right[i]
    result.v_end, result.theta_end = y.v, y.theta


@kernel
def _write_reversals(traits, lanes, i, m, substep, contact, after, history):
    """Write both sides of the reversals that change the ``contact`` of lane ``i`` to that ``after`` its sub-step."""
    start, number = substep * lanes.clock.step[i], int(lanes.clock.number[i])
    t, ground = lanes.clock.sample[i] * lanes.clock.dt[i] + start, ground_at(lanes, i, start)
    y, left, right, at = get(lanes.now, i, State), lanes.step_status.left[i], lanes.step_status.right[i], 0.0
    for _ in range(2):
        of_left = left >= 0.0 and (right < 0.0 or left <= right)
        when = left if of_left else right
        if when < 0.0:
            return
        k = rates(m, y, contact, ground.horizontal, ground.vertical)
        y = rk4(m, None, y, k, contact, ground, when - at)
        write(history, number, t + when, BEFORE_EVENT, m, None, y, contact, ground)
        if of_left:
            contact = Contact(contact.left, contact.right, after.left_yields, contact.right_yields, 0.0)
            left = -1.0
        else:
            contact = Contact(contact.left, contact.right, contact.left_yields, after.right_yields, 0.0)
            right = -1.0
        write(history, number, t + when, SPRING_LEFT if of_left else SPRING_RIGHT, m, None, y, contact, ground)
        ground, at = later(ground, when - at), when


def kind_of(m):
    """Return the Kind of the pier ``m`` (Springs): what its runs are compiled for."""
    return Kind(SpringTraits(m.exponent, m.finite, m.damped), Line, LANE, State._fields + Contact._fields)


def line_of(m, *timing):
    """Return the Line of a run of the pier ``m`` (Springs); ``timing`` is what Line has from ``dt`` on."""
    exponent = 5.0 if m.exponent is None else float(m.exponent)
    return Line(*m[:-4], exponent, *timing)
