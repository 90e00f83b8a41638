"""General ODE solvers on the pier on springs: SciPy, CVODE of SUNDIALS (scikit-sundae), the Taylor method of heyoka.

All are used as their manuals have it: events located by the solver, a restart after each, steps no longer than a
sample. SciPy and CVODE call the core's right-hand side and event functions, compiled; heyoka compiles its own from expressions.
Here for first-order kinematics and n = 5. What follows from an event is the core's affair.
"""

import math
from collections.abc import Callable
from typing import Any

import numba
import numpy as np

from rockbatch.core.springs.lanes import static_state
from rockbatch.core.springs.laws import CODES
from rockbatch.core.springs.model import Contact, Springs, State, Supports
from rockbatch.core.springs.transitions import handle
from rockbatch.core.system import event_functions, rates
from rockbatch.core.types import Ground, Instant, Moment
from rockbatch.motions import Motion
from rockbatch.pier import ElasticBase, Pier
from rockbatch.simulation import ground_of, springs

MOST_EVENTS = 100_000
UPRIGHT, TURNING, FAILED = 4, 5, -1  # what may end a stretch, or be met on it, besides the four signals

Solve = Callable[[], tuple[str, float]]
"""One run, ready to be timed: status and θ_max [rad]."""

Stretch = Callable[[float, State, Contact, Supports], tuple[float, State, int | None, float]]
"""From an event, or the start, to the next: its time [s], state and number, None at the end; and the greatest |θ|."""


def watched(law: float, contact: Contact, supports: Supports, rest: float) -> tuple[float, ...]:
    """The four event functions of springs, linear in z and in a pivot's position or velocity, for either pivot.

    Contact: on its spring −z, else the gap to the support: (of z, of position, constant). Law: the velocity up or down,
    or what is left until yield: (of z, of velocity, constant).
    """

    def pivot(on_spring: float, yields: float, support: float) -> tuple[float, ...]:
        if on_spring == 0.0:
            return 0.0, 1.0, -support, 0.0, 0.0, 1.0
        if law == CODES["elastic"]:
            return -1.0, 0.0, 0.0, 0.0, 0.0, 1.0
        if yields != 0.0:
            return -1.0, 0.0, 0.0, 0.0, -1.0, -rest
        if law == CODES["bouc-wen"]:
            return -1.0, 0.0, 0.0, 0.0, 1.0, -rest
        return -1.0, 0.0, 0.0, 1.0, 0.0, 1.0

    left = pivot(contact.left, contact.left_yields, supports.left)
    return left + pivot(contact.right, contact.right_yields, supports.right)


@numba.njit(error_model="numpy")
def signals(m, y, contact, supports, ground):
    """Return the four event functions of a pier on springs; their slopes are not asked for."""
    values, _ = event_functions(m, None, Instant(y, y, contact, supports, ground))
    return values


class Rocking:
    """A run: its model, its ground, and how it goes on from event to event."""

    def __init__(self, pier: Pier, base: ElasticBase, motion: Motion, quiet_s: float = 2.0) -> None:
        self.m, self.alpha, self.dt = springs(pier, base), pier.alpha, float(motion.dt)
        if self.m.finite is not None or self.m.exponent is not None:
            raise ValueError("only first-order kinematics and n = 5")
        self.rest = self.m.rest
        quiet = math.ceil(quiet_s / self.dt - 1e-9)
        self.ground = np.concatenate([ground_of(motion), np.zeros((quiet + 1, 4))])
        self.samples = motion.npts - 1 + quiet
        self.end = self.samples * self.dt
        omega_v, deflection = base.beta * pier.p, self.m.yield_deflection
        self.scale = np.array([deflection, pier.alpha, deflection * omega_v, pier.alpha * pier.p, 1.0, 1.0])
        self.cells = np.array([*self.m[:15], *[0.0] * 7, self.rest, self.dt])  # as :func:`_unpacked` reads them

    def put(self, contact: Contact, supports: Supports) -> None:
        """Contacts and supports of the next stretch, for the compiled functions."""
        self.cells[15:20], self.cells[20:22] = contact, supports[:2]

    def tolerances(self, tolerance: float) -> dict[str, Any]:
        """Relative, and absolute in units of δ_y for v, α for θ, these times ω_v and p for their rates, and 1 for z."""
        return {"rtol": tolerance, "atol": tolerance * self.scale}

    def solve(self, stretch: Stretch) -> tuple[str, float]:
        """Status and θ_max [rad], each stretch between two events integrated by ``stretch``."""
        m, rest = self.m, self.rest
        t, y, theta_max = 0.0, static_state(m, m.gravity), 0.0
        branch = 1.0 if m.law == CODES["bouc-wen"] else 0.0
        contact, supports = Contact(1.0, 1.0, branch, branch, 0.0), Supports(math.nan, math.nan)
        for _ in range(MOST_EVENTS):
            # An impact at one pivot may turn the other's velocity: that is an event before the next step
            values = signals(m, y, contact, supports, self._ground_at(t))
            which = next((i for i, value in enumerate(values) if value < -rest), None)
            if which is None:
                t, y, which, reached = stretch(t, y, contact, supports)
                theta_max = max(theta_max, reached)
                if which is None:
                    return "ok", theta_max
                if which in (UPRIGHT, FAILED):
                    return ("overturned" if which == UPRIGHT else "failed"), theta_max
            (y, contact, supports), _ = handle(m, Moment(y, contact, supports), which, self._ground_at(t))
            if contact.left == contact.right == contact.held == 0 and not m.guided:
                beyond = abs(y.theta) >= self.alpha and y.theta * y.omega > 0.0
                return ("overturned" if beyond else "flight"), theta_max
            if t >= self.end:
                return "ok", theta_max
        return "failed", theta_max

    def _ground_at(self, t: float) -> Ground:
        i = int(t / self.dt)
        a, a_slope, c, c_slope = self.ground[i].tolist()
        x = t - i * self.dt
        return Ground(a + x * a_slope, 0.0, c + x * c_slope, 0.0)


@numba.njit(error_model="numpy")
def _unpacked(t, y, cells, ground):
    """What the core's functions take, from plain arrays, which cross from Python to compiled code at the least cost."""
    m = Springs(
        cells[0], cells[1], cells[2], cells[3], cells[4], cells[5], cells[6], cells[7], cells[8], cells[9], cells[10], cells[11],
        cells[12], cells[13], cells[14], cells[22], None, None, None, None, None, None,
    )  # fmt: skip
    contact = Contact(cells[15], cells[16], cells[17], cells[18], cells[19])
    i = int(t / cells[23])
    x = t - i * cells[23]
    under = Ground(ground[i, 0] + x * ground[i, 1], 0.0, ground[i, 2] + x * ground[i, 3], 0.0)
    return m, State(y[0], y[1], y[2], y[3], y[4], y[5]), contact, under


@numba.njit(error_model="numpy")
def _rates(t, y, y_rates, cells, ground):
    m, state, contact, under = _unpacked(t, y, cells, ground)
    k = rates(m, state, contact, under)
    for i in range(6):
        y_rates[i] = k[i]


@numba.njit(error_model="numpy")
def _events(t, y, values, cells, ground):
    m, state, contact, under = _unpacked(t, y, cells, ground)
    rest = cells[22]
    found = signals(m, state, contact, Supports(cells[20], cells[21], -1.0, -1.0), under)
    for i in range(4):
        values[i] = found[i] if abs(found[i]) > rest else rest  # rounding does not cross
    values[4] = 0.5 * math.pi - abs(state.theta)
    values[5] = state.omega


def scipy(rocking: Rocking, tolerance: float, method: str) -> Solve:
    """SciPy's ``solve_ivp``, ``method`` "DOP853" or "LSODA"; tolerances as in :meth:`Rocking.tolerances`."""
    from scipy.integrate import solve_ivp

    values = np.empty(6)

    def right_hand_side(t: float, y: Any) -> Any:
        y_rates = np.empty(6)
        _rates(t, y, y_rates, rocking.cells, rocking.ground)
        return y_rates

    def event(i: int) -> Callable[[float, Any], float]:
        def signal(t: float, y: Any) -> float:
            _events(t, y, values, rocking.cells, rocking.ground)
            return float(values[i])

        signal.terminal, signal.direction = i != TURNING, 0.0 if i == TURNING else -1.0  # type: ignore[attr-defined]
        return signal

    settings = {"method": method, "max_step": rocking.dt, "events": [event(i) for i in range(6)]}
    settings |= rocking.tolerances(tolerance)

    def stretch(t: float, y: State, contact: Contact, supports: Supports) -> tuple[float, State, int | None, float]:
        rocking.put(contact, supports)
        found = solve_ivp(right_hand_side, (t, rocking.end), np.array(y), **settings)
        turned = [abs(state[1]) for state in found.y_events[TURNING]]
        ended = [i for i, times in enumerate(found.t_events[:TURNING]) if len(times)]
        which = FAILED if found.status < 0 else next(iter(ended), None)
        reached = float(max(np.abs(found.y[1]).max(), *turned, 0.0))
        return float(found.t[-1]), State(*found.y[:, -1].tolist()), which, reached

    return lambda: rocking.solve(stretch)


def cvode(rocking: Rocking, tolerance: float, method: str) -> Solve:
    """CVODE, ``method`` "Adams" or "BDF"; tolerances as in :meth:`Rocking.tolerances`."""
    from sksundae.cvode import CVODE

    def right_hand_side(t: float, y: Any, y_rates: Any) -> None:
        _rates(t, y, y_rates, rocking.cells, rocking.ground)

    def events(t: float, y: Any, values: Any) -> None:
        _events(t, y, values, rocking.cells, rocking.ground)

    events.terminal, events.direction = [True] * 5 + [False], [-1] * 5 + [0]  # type: ignore[attr-defined]
    settings = {"method": method, "max_step": rocking.dt, "eventsfn": events, "num_events": 6}
    settings |= rocking.tolerances(tolerance)

    def stretch(t: float, y: State, contact: Contact, supports: Supports) -> tuple[float, State, int | None, float]:
        rocking.put(contact, supports)
        # An object that is used again keeps the events of before
        found = CVODE(right_hand_side, **settings).solve([t, rocking.end], y)
        reached = float(np.abs(found.y[:, 1]).max())
        which = None if found.t[-1] >= rocking.end else FAILED
        if found.i_events is not None and len(found.i_events):
            reached = max(reached, float(np.abs(found.y_events[:, 1]).max()))
            ended = np.flatnonzero(found.i_events[-1][:TURNING])
            which = int(ended[0]) if len(ended) else which
        return float(found.t[-1]), State(*found.y[-1].tolist()), which, reached

    return lambda: rocking.solve(stretch)


class Taylor:
    """heyoka's integrator of the model of a run, compiled once (about a second) for all of its stretches.

    What an event changes, the contacts, and the ground between two samples are parameters. It does not know pivots that
    are held between contact and flight: such a run fails.
    """

    CONTACT, WATCH, GROUND = 0, 4, 16  # offsets into the parameters; ground: a, its slope, c, its slope, time of sample

    def __init__(self, rocking: Rocking, tolerance: float) -> None:
        import heyoka as hy

        self.rocking = rocking
        self.reached = reached = [0.0]

        def turned(integrator: Any, t: float, _: int) -> None:
            integrator.update_d_output(t)
            reached[0] = max(reached[0], abs(integrator.d_output[1]))

        equations, watched = self._model(hy, rocking.m)
        falling = hy.event_direction.negative
        terminal = [hy.t_event(signal, direction=falling) for signal in watched]
        turning = hy.nt_event(equations[1][1], callback=turned)
        self.integrator = hy.taylor_adaptive(
            equations,
            [0.0] * 6,
            tol=tolerance,
            pars=[0.0] * 21,
            t_events=terminal,
            nt_events=[turning],
            compact_mode=True,
        )

    def _model(self, hy: Any, m: Springs) -> tuple[list[Any], list[Any]]:
        """Right-hand side (``springs.equations``) and signals (:func:`watched`) as expressions."""
        v, theta, v_rate, omega, z_left, z_right = state = hy.make_vars("v", "theta", "v_rate", "omega", "zl", "zr")
        on_left, on_right, yields_left, yields_right = (hy.par[self.CONTACT + i] for i in range(4))
        x = hy.time - hy.par[self.GROUND + 4]
        horizontal = hy.par[self.GROUND] + hy.par[self.GROUND + 1] * x
        vertical = hy.par[self.GROUND + 2] + hy.par[self.GROUND + 3] * x
        b, h = m.half_width, m.height
        left, right = m.yield_force * z_left, m.yield_force * z_right
        lever = h + (on_right - on_left) * b * theta
        moment = -left * (b + h * theta) - right * (-b + h * theta) - lever * horizontal
        left_rate, right_rate = v_rate + b * omega, v_rate - b * omega
        z_rates = [
            on * rate * m.stiffness * (1.0 + yields * (z * z) * (z * z) * z)  # z**5 divides by z
            for on, rate, yields, z in (
                (on_left, left_rate, yields_left, z_left),
                (on_right, right_rate, yields_right, z_right),
            )
        ]
        rates = [v_rate, omega, -m.gravity - vertical - left - right, moment / (m.inertia + h * h), *z_rates]
        w = [hy.par[self.WATCH + i] for i in range(12)]
        contacts = [w[0] * z_left + w[1] * (v + b * theta) + w[2], w[6] * z_right + w[7] * (v - b * theta) + w[8]]
        laws = [w[3] * z_left + w[4] * left_rate + w[5], w[9] * z_right + w[10] * right_rate + w[11]]
        half_turn = (0.5 * math.pi) ** 2 - theta * theta
        return list(zip(state, rates, strict=True)), [*contacts, *laws, half_turn]

    def stretch(
        self, t: float, y: State, contact: Contact, supports: Supports
    ) -> tuple[float, State, int | None, float]:
        """See :data:`Stretch`."""
        rocking, integrator = self.rocking, self.integrator
        if contact.held:
            return t, y, FAILED, abs(y.theta)
        self.reached[0] = abs(y.theta)
        integrator.time = t
        integrator.state[:] = y
        pars = integrator.pars
        pars[self.CONTACT : self.WATCH] = contact[:4]
        found = np.array(watched(rocking.m.law, contact, supports, rocking.rest))
        found[[5, 11]] = np.abs(found[[5, 11]])  # a velocity that starts from zero is on the right side of it
        pars[self.WATCH : self.GROUND] = found
        for i in range(int(t / rocking.dt), rocking.samples):
            pars[self.GROUND : self.GROUND + 4], pars[self.GROUND + 4] = rocking.ground[i], i * rocking.dt
            ended = int(integrator.propagate_until((i + 1) * rocking.dt)[0])
            if not np.isfinite(integrator.state).all():
                return integrator.time, y, FAILED, self.reached[0]
            if -5 <= ended < 0:  # which terminal event, counted from −1
                return self._here(-ended - 1)
        return self._here(None)

    def _here(self, which: int | None) -> tuple[float, State, int | None, float]:
        y = State(*self.integrator.state.tolist())
        return self.integrator.time, y, which, max(self.reached[0], abs(y.theta))


def heyoka(rocking: Rocking, tolerance: float) -> Solve:
    """heyoka's Taylor method, its order and steps chosen by ``tolerance``."""
    taylor = Taylor(rocking, tolerance)
    return lambda: rocking.solve(taylor.stretch)
