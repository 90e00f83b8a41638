"""The pier on springs with SciPy's ``solve_ivp``, as one would write it without this library: a reference solver for speed.

Right-hand side, event functions and transitions are the core's compiled functions, so that only the solver is timed: steps no
longer than a sample, terminal events, a restart after each. Only ``rockbatch accuracy`` and tests import this module, for SciPy
takes a second to load.
"""

import math
import time
from typing import Any

import numpy as np

from rockbatch.core import system
from rockbatch.core.kernel import kernel
from rockbatch.core.springs.lanes import static_contact, static_state
from rockbatch.core.springs.model import Springs, State
from rockbatch.core.springs.transitions import handle
from rockbatch.core.system import event_functions
from rockbatch.core.types import Ground, Instant, Moment
from rockbatch.motions.motion import Motion
from rockbatch.pier import ElasticBase, Pier, vertical_frequency
from rockbatch.simulation.models import springs

MOST_EVENTS = 100_000


@kernel
def rates(m, y, contact, ground):  # type: ignore[no-untyped-def]
    """Return the right-hand side, compiled."""
    return system.rates(m, y, contact, ground)


@kernel
def event_values(m, now, ground):  # type: ignore[no-untyped-def]
    """Return the values of the event functions, compiled; rates matter to slopes only."""
    return event_functions(m, None, Instant(now.y, now.y, now.contact, now.supports, ground))[0]


class OutOfTimeError(Exception):
    """A solver that did not finish in the time that it was given."""


class _SmoothPart:
    """Right-hand side and event functions between two events, for SciPy: functions of time [s] and state."""

    def __init__(self, m: Springs, motion: Motion, until: float) -> None:
        self.m, self.until = m, until
        self.horizontal = _ground(motion.horizontal, float(motion.dt))
        self.vertical = _ground(motion.vertical, float(motion.dt))
        state = static_state(m, m.gravity)
        self.now: Any = Moment(state, *static_contact(m, state))

    def rates(self, t: float, y: Any) -> Any:
        if time.monotonic() > self.until:
            raise OutOfTimeError
        return rates(self.m, State(*y.tolist()), self.now.contact, self.ground(t))

    def ground(self, t: float) -> Ground:
        return Ground(self.horizontal(t), 0.0, self.vertical(t), 0.0)

    def values(self, t: float, state: State) -> Any:
        return event_values(self.m, self.now._replace(y=state), self.ground(t))

    def event(self, i: int) -> Any:
        def event(t: float, y: Any) -> float:
            value = float(self.values(t, State(*y.tolist()))[i])
            return value if abs(value) > self.m.rest else self.m.rest  # rounding does not cross

        return _terminal(event)

    def handle(self, t: float, number: int) -> None:
        """Continue after an event."""
        self.now, _ = handle(self.m, self.now, number, self.ground(t))


def solve(
    pier: Pier,
    base: ElasticBase,
    motion: Motion,
    method: str,
    tolerance: float,
    quiet_s: float = 2.0,
    seconds: float = math.inf,
) -> tuple[str, float]:
    """Return status and θ_max [rad] of a run on springs.

    Parameters
    ----------
    method : str
        Of :func:`scipy.integrate.solve_ivp`, such as "DOP853" or "LSODA".
    tolerance : float
        Relative, and absolute in units of δ_y for v, α for θ, these times ω_v and p for their rates, and 1 for z.
    quiet_s : float
        Time after the record [s]; the run ends there even if the pier might still overturn.
    seconds : float
        Time that the solver may take [s]; raises :class:`OutOfTimeError` beyond it.

    Returns
    -------
    status : "ok", "overturned", "flight" or "failed"
    theta_max : greatest |θ| until the end [rad]
    """
    from scipy.integrate import solve_ivp

    m, dt, omega_v = springs(pier, base), float(motion.dt), vertical_frequency(pier, base)
    end = (motion.npts - 1 + math.ceil(quiet_s / dt - 1e-9)) * dt
    scale = [m.yield_deflection, pier.alpha, m.yield_deflection * omega_v, pier.alpha * pier.p, 1.0, 1.0]
    settings = {"method": method, "max_step": dt, "rtol": tolerance, "atol": tolerance * np.array(scale)}
    part = _SmoothPart(m, motion, time.monotonic() + seconds)
    events = [*(part.event(i) for i in range(4)), _terminal(_upright), _velocity_reversal]
    t, theta_max = 0.0, 0.0
    for _ in range(MOST_EVENTS):
        # An impact at one pivot may reverse the other's velocity: that is an event before the next step
        number = next((i for i, value in enumerate(part.values(t, part.now.y)) if value < -m.rest), None)
        if number is None:
            solution = solve_ivp(part.rates, (t, end), np.array(part.now.y), events=events, **settings)
            reached = [theta_max, *np.abs(solution.y[1]), *(abs(y[1]) for y in solution.y_events[-1])]
            theta_max = float(max(reached))
            if solution.status <= 0 or not math.isfinite(theta_max):
                return "ok" if solution.status == 0 and math.isfinite(theta_max) else "failed", theta_max
            number = next(i for i, times in enumerate(solution.t_events) if len(times))
            if number == 4:
                return "overturned", theta_max
            t, part.now = float(solution.t[-1]), part.now._replace(y=State(*solution.y[:, -1].tolist()))
        part.handle(t, number)
        y, contact = part.now.y, part.now.contact
        if contact.left == contact.right == contact.held == 0 and not m.guided:
            beyond = abs(y.theta) >= pier.alpha and y.theta * y.omega > 0.0
            return "overturned" if beyond else "flight", theta_max
        if t >= end:
            return "ok", theta_max
    return "failed", theta_max


def _ground(samples: Any, dt: float) -> Any:
    """Return the ground acceleration [m/s²] as a function of time [s]: linear between samples, zero after the last."""
    if samples is None:
        return lambda t: 0.0
    values = [*samples.tolist(), 0.0]

    def acceleration(t: float) -> float:
        i = int(t / dt)
        if i >= len(values) - 1:
            return 0.0
        return float(values[i] + (t / dt - i) * (values[i + 1] - values[i]))

    return acceleration


def _terminal(event: Any) -> Any:
    """Return ``event`` as one that ends the integration where it falls through zero."""
    event.terminal, event.direction = True, -1.0
    return event


def _upright(t: float, y: Any) -> float:
    return 0.5 * math.pi - abs(y[1])


def _velocity_reversal(t: float, y: Any) -> float:
    return float(y[3])
