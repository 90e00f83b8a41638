"""A rocking frame as so many columns and a deck, each a body of its own: another way to what the equivalent block does.

Coordinates are the height z of the columns' centres and their rotation θ. Bodies follow by vectors from corner to corner;
accelerations by d'Alembert's principle with a multiplier for the feet's force; every impact by one projection: the impulses of
the constraints that hold after it do no work in the motions that these allow.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp


@dataclass
class Frame:
    """``deck`` rests on ``columns`` of ``mass`` and 2b × 2h. A tendon and a linear damper at ``offset`` below each of them."""

    b: float
    h: float
    mass: float
    columns: int
    deck: float
    gravity: float = 9.81
    prestress: float = 0.0
    stiffness: float = 0.0
    damper: float = 0.0
    offset: float = 0.0
    events: list = field(default_factory=list)

    def at(self, theta, x, y):
        """Return the vector from a column's centre to a point of it, turned clockwise by ``theta``."""
        return np.array([x * math.cos(theta) + y * math.sin(theta), -x * math.sin(theta) + y * math.cos(theta)])

    def jacobians(self, theta, key, top):
        """Return mass or inertia, Jacobian, and what its rate adds to the acceleration over θ̇², of each body's coordinates."""
        foot, head = self.at(theta, key * self.b, -self.h), self.at(theta, -top * self.b, self.h)
        column, bend = np.array([[0.0, -foot[1]], [1.0, 0.0]]), np.array([foot[0], 0.0])
        deck, deck_bend = column + np.array([[0.0, head[1]], [0.0, -head[0]]]), bend - head
        inertia = self.mass * (self.b**2 + self.h**2) / 3.0
        bodies = []
        for _ in range(self.columns):
            bodies += [(self.mass, column, bend), (inertia, np.array([[0.0, 1.0]]), np.zeros(1))]
        return [*bodies, (self.deck, deck, deck_bend)]

    def lifts(self, q, side):
        """Return height, velocity of the corner on ``side``, its Jacobian, and what that adds to its acceleration over θ̇²."""
        corner = self.at(q[1], side * self.b, -self.h)
        row = np.array([1.0, -corner[0]])
        return q[0] + corner[1], row @ q[2:], row, -corner[1]

    def devices(self, q):
        """Return the generalised force of all columns' devices, and the energy stored in tendons."""
        foot, half = self.at(q[1], self.offset, -self.h), 0.5 * q[1]
        rise, row = q[0] + foot[1], np.array([1.0, -foot[0]])
        longer = rise / math.cos(half)
        by_q = row / math.cos(half) + np.array([0.0, 0.5 * rise * math.tan(half) / math.cos(half)])
        tension = self.prestress + self.stiffness * longer + self.damper * (by_q @ q[2:])
        return -self.columns * tension * by_q, self.columns * (self.prestress + 0.5 * self.stiffness * longer) * longer

    def accelerations(self, q, key, top, stands, ground):
        """Return z̈, θ̈ and the force of the ground on all feet, 0 in flight."""
        matrix, load = np.zeros((3, 3)), np.zeros(3)
        for mass, jacobian, bend in self.jacobians(q[1], key, top):
            outside = np.array([ground[0], self.gravity + ground[1]]) if len(bend) == 2 else np.zeros(1)
            matrix[:2, :2] += mass * jacobian.T @ jacobian
            load[:2] -= mass * jacobian.T @ (bend * q[3] ** 2 + outside)
        load[:2] += self.devices(q)[0]
        _, _, row, bend = self.lifts(q, key)
        matrix[2, 2] = 1.0
        if stands:
            matrix[:2, 2], matrix[2, :2], matrix[2, 2], load[2] = -row, row, 0.0, -bend * q[3] ** 2
        return np.linalg.solve(matrix, load)

    def energy(self, q, key, top):
        """Return kinetic, potential and tendons' energy."""
        bodies = self.jacobians(q[1], key, top)
        kinetic = sum(0.5 * mass * np.sum((jacobian @ q[2:]) ** 2) for mass, jacobian, _ in bodies)
        heads = q[0] + self.at(q[1], -top * self.b, self.h)[1]
        return kinetic + self.gravity * (self.columns * self.mass * q[0] + self.deck * heads) + self.devices(q)[1]

    def after(self, q, before, now, stands):
        """Return the velocities after an impact between the keys ``before`` and ``now``, on the foot of it if it ``stands``."""
        allowed = np.eye(2)
        if stands:
            row = self.lifts(q, now[0])[2]
            allowed = np.array([[-row[1]], [1.0]])
        matrix = moment = 0.0
        for (mass, was, _), (_, jacobian, _) in zip(
            self.jacobians(q[1], *before), self.jacobians(q[1], *now), strict=True
        ):
            own = jacobian @ allowed
            matrix, moment = matrix + mass * own.T @ own, moment + mass * own.T @ (was @ q[2:])
        return allowed @ np.linalg.solve(matrix, moment)

    def run(self, dt, horizontal, vertical, theta, t_end):
        """Return times and states (z, θ, ż, θ̇) at samples, from rest at ``theta`` on the corner towards which it leans.

        Motions are linear between samples. ``events`` has kind, time, energy before and after each.
        """
        key = top = math.copysign(1.0, theta)
        q, stands, samples = np.array([-self.at(theta, key * self.b, -self.h)[1], theta, 0.0, 0.0]), True, []
        for i in range(round(t_end / dt)):
            samples.append(q.copy())
            ends = [[motion[n] if n < len(motion) else 0.0 for n in (i, i + 1)] for motion in (horizontal, vertical)]
            t = i * dt
            while t < (i + 1) * dt - 1e-13:

                def ground(now, i=i, ends=ends):
                    share = now / dt - i
                    return [(1.0 - share) * first + share * last for first, last in ends]

                def rates(now, y, key=key, top=top, stands=stands, ground=ground):
                    return [y[2], y[3], *self.accelerations(y, key, top, stands, ground(now))[:2]]

                def tilts(now, y, top=top):
                    return top * y[1]

                def bears(now, y, key=key, top=top, stands=stands, ground=ground):
                    return self.accelerations(y, key, top, True, ground(now))[2] if stands else self.lifts(y, top)[0]

                for event in (tilts, bears):
                    event.terminal, event.direction = True, -1
                done = solve_ivp(rates, (t, (i + 1) * dt), q, "DOP853", events=(tilts, bears), rtol=1e-11, atol=1e-13)
                t, q = done.t[-1], done.y[:, -1].copy()
                if done.status != 1:
                    continue
                before, kind = (key, top), ("impact" if stands else "deck")
                if len(done.t_events[1]):
                    kind, stands = ("take-off", False) if stands else ("landing", True)
                    key = key if not stands else top
                else:
                    q[1], top = 0.0, -top
                    key = top if stands else key
                energy = self.energy(q, *before)
                if kind != "take-off":
                    q[2:] = self.after(q, before, (key, top), stands)
                self.events.append((kind, t, energy, self.energy(q, key, top)))
                if stands and self.accelerations(q, key, top, True, ground(t))[2] < 0.0:  # it goes on flying
                    stands = False
                    self.events.append(("take-off", t, 0.0, 0.0))
        return dt * np.arange(len(samples)), np.array(samples)
