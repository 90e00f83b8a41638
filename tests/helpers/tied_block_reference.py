"""A rigid pier with devices on rigid ground: Runge–Kutta in plain Python, every event by bisection, the row that comes of it.

The height v of the centre of mass and the rotation θ are coordinates on the ground and in flight alike; on a pivot v follows θ.
Friction dampers are for piers that do not fly. It shares nothing with the product but the equations of THEORY.md.
"""

import math
from dataclasses import dataclass, field

import numpy as np

import rockbatch as rb

REST, ROCKS, STICKS, FLIES = range(4)
HALVINGS = 52
LEAST_BOUNCE = 1e-13
"""Height of a bounce over α below which the block rests."""


@dataclass
class Device:
    """A device of one place: its kind, offset from the middle, or height and way at the deck, and the numbers of its law."""

    kind: str
    offset: float = 0.0
    height: float = 0.0
    way: float = 0.0
    force: float = 0.0  # F_d, prestress or C
    stiffness: float = math.inf  # of a tendon, stop or brace
    more: float = 0.0  # exponent, u_y, strength, or restitution
    least: float = 0.0  # gap, or the speed below which a power law is linear
    state: float = 0.0  # z, F of a braced oil damper, plastic elongation, or greatest deflection of the blow
    used: dict = field(
        default_factory=lambda: dict.fromkeys(("most", "stroke", "speed", "work", "travel", "times"), 0.0)
    )
    last: tuple = ()

    def pull(self, e, rate, q):
        if self.kind == "oil":
            speed = max(abs(rate), self.least if self.more < 1.0 else 0.0)
            return self.force * speed ** (self.more - 1.0) * rate if speed else 0.0
        if self.kind == "braced oil":
            return q
        if self.kind == "steel":
            return self.force * q
        if self.kind == "tendon":
            return min(max(self.force + self.stiffness * (e - q), 0.0), self.more)
        if self.kind == "spring":
            return self.stiffness * e
        depth, loss = e - self.least, 1.0 - self.more**2
        return max(0.0, min(self.stiffness * depth, self.stiffness / self.more**2 * (depth - loss * max(q, depth))))

    def own_rate(self, rate, q):
        """Rate of the damper itself, without its brace; and the rate of its state."""
        if self.kind == "braced oil":
            own = math.copysign((abs(q) / self.force) ** (1.0 / self.more), q)
            return own, self.stiffness * (rate - own)
        if self.kind == "steel":
            share = 1.0 - min(abs(q), 1.0) ** 5 if rate * q > 0.0 else 1.0
            own = rate / (1.0 + self.force / (self.stiffness * self.more) * share)
            return own, own / self.more * share
        return rate, 0.0

    def branch(self, e, rate, q):
        """Number of the smooth part of the law."""
        if self.kind in ("oil", "steel"):
            return (rate > 0.0) + 2 * (q > 0.0) + 4 * (abs(rate) < self.least)
        if self.kind == "tendon":
            pull = self.force + self.stiffness * (e - q)
            return (pull > 0.0) + (pull > self.more)
        depth, loss = e - self.least, 1.0 - self.more**2
        return (depth > 0.0) + (depth > loss * max(q, depth)) + (depth >= q) if self.kind == "stop" else 0

    def settled(self, e):
        """State behind a step that ends at the elongation e."""
        if self.kind == "tendon":
            return max(self.state, e - (self.more - self.force) / self.stiffness) if self.stiffness else self.state
        if self.kind == "stop":
            return max(self.state, e - self.least) if e > self.least else 0.0
        return self.state

    def stored(self):
        """Energy that a stop still holds."""
        return 0.5 * (self.more * self.last[0]) ** 2 / self.stiffness if self.kind == "stop" else 0.0

    def take(self, e, pull, rate):
        """Include a state in demands and work; elongation and rate of the damper itself."""
        used = self.used
        own = e - pull / self.stiffness if self.kind in ("braced oil", "steel") else e
        speed = self.own_rate(rate, self.state)[0]
        used["most"], used["speed"] = max(used["most"], abs(pull)), max(used["speed"], abs(speed))
        used["stroke"] = max(used["stroke"], max(0.0, own - self.least) if self.kind == "stop" else abs(own))
        if self.last:
            if self.kind == "friction":
                used["work"] += self.force * abs(own - self.last[1])
            else:
                used["work"] += 0.5 * (pull + self.last[0]) * (own - self.last[1])
            used["travel"] += abs(own - self.last[1])
            closes = self.kind == "stop" and self.last[1] <= self.least < own
            slack = self.kind == "tendon" and self.last[0] > 0.0 >= pull
            used["times"] += closes or slack
        self.last = (pull, own)


def devices_of(pier, base):
    """Devices of a base, with the names of their kinds, and the fastest rate among them."""
    b, height, weight = pier.half_width, pier.deck, pier.gravity
    per_lambda = weight * pier.size / b**2
    about, made, rates = pier.inertia_about_pivot, [], [pier.p]
    for device in base.restraints:
        at = getattr(device, "at", "deck")
        places = [-b, b] if at is None else [{"left": -b, "right": b, "deck": 0.0}.get(at, at)]
        for s in places:
            place = {"height": height, "way": 1.0} if at == "deck" else {"offset": s}
            reach = (height**2 + b**2 if at == "deck" else (b + abs(s)) ** 2) / about
            if isinstance(device, rb.Damper):
                brace = per_lambda * device.brace
                if device.kind == "friction":
                    one = Device("friction", force=device.f * weight, **place)
                elif device.kind == "hysteretic":
                    one = Device("steel", force=device.f * weight, more=device.yield_m, stiffness=brace, **place)
                    rates.append(math.sqrt(one.force / one.more * reach))
                else:
                    c, a = device.nu * pier.p, device.exponent
                    least = (c * reach / (100.0 * pier.p)) ** (1.0 / (1.0 - a)) if a < 1.0 else 0.0
                    kind = "braced oil" if device.brace < math.inf else "oil"
                    one = Device(kind, force=c, more=a, least=least, stiffness=brace, **place)
                    rates.append(2.0 * brace / c if device.brace < math.inf else c * reach)
                made.append(("damper", one))
                continue
            stiffness = per_lambda * device.lam
            if isinstance(device, rb.Tendon):
                strength = device.strength * weight
                made.append(
                    ("tendon", Device("tendon", force=device.psi * weight, stiffness=stiffness, more=strength, **place))
                )
                rates.append(math.sqrt(stiffness * reach))
                continue
            kind = "stop" if isinstance(device, rb.Stop) else "deck_spring"
            linear = kind == "deck_spring" and device.linear
            law = {} if linear else {"least": device.gap_m, "more": device.restitution}
            ways = {"both": (1.0, -1.0), "right": (1.0,), "left": (-1.0,)}[
                "right" if linear else getattr(device, "side", "right")
            ]
            for way in ways:
                place |= {"way": way} if kind == "deck_spring" else {}
                made.append((kind, Device("spring" if linear else "stop", stiffness=stiffness, **law, **place)))
            rates.append(math.sqrt(stiffness * reach) / device.restitution)
    return made, max(rates)


class TiedBlock:
    """A run of a pier on rigid ground under a motion, until ``end`` [s]; ``row`` has what peaks.csv has."""

    def __init__(self, pier, base, motion, end, step=0.05):
        self.b, self.h, self.inertia, self.g = pier.half_width, pier.height, pier.inertia, pier.gravity
        self.alpha, self.e = pier.alpha, base.restitution
        if self.e is None:
            self.e = max(0.0, 1.0 - 2.0 * pier.mu / (1.0 + pier.mu) * math.sin(pier.alpha) ** 2)
        self.named, rate = devices_of(pier, base)
        self.devices = [device for _, device in self.named]
        self.rubs = [device for device in self.devices if device.kind == "friction"]
        self.mode, self.side, self.y, self.slides = REST, 1.0, [0.0] * 4, 0.0
        self.counts = dict.fromkeys(("impacts", "separations", "flights"), 0)
        self.peak, self.t_peak, self.high, self.duration, self.began = 0.0, 0.0, 0.0, 0.0, math.nan
        self.shear = self.normal = 0.0
        self.status = "ok"
        vertical = motion.vertical if motion.vertical is not None else np.zeros(motion.npts)
        rows = math.ceil(end / motion.dt - 1e-9)
        ground = np.zeros((max(rows, motion.npts) + 1, 2))
        ground[: motion.npts] = np.column_stack([motion.horizontal, vertical])
        self.dt, parts = motion.dt, max(6, math.ceil(rate * motion.dt / step))
        for row in range(rows):
            self.start, self.now = row * self.dt, ground[row].tolist()
            self.rate = ((ground[row + 1] - ground[row]) / self.dt).tolist()
            for part in range(parts):
                if self.status == "ok":
                    self._advance(part * self.dt / parts, (part + 1) * self.dt / parts)
        if self.mode == FLIES and self.status == "ok":
            self.duration += rows * self.dt - self.began
        self.row = self._row(pier)

    def shaken(self, x):
        return self.now[0] + self.rate[0] * x, self.now[1] + self.rate[1] * x

    def lever(self, theta, key):
        """H and H′ with the key in its place."""
        s, c = math.sin(theta), math.cos(theta)
        return self.h * c + key * self.b * s, -self.h * s + key * self.b * c

    def gap(self, device, v, theta, side):
        """Elongation e, ∂e/∂v and ∂e/∂θ."""
        s, c = math.sin(theta), math.cos(theta)
        if device.way:
            lean = math.copysign(1.0, theta) if theta else side
            return (
                device.way * (device.height * s + lean * self.b * (1.0 - c)),
                0.0,
                device.way * (device.height * c + lean * self.b * s),
            )
        half = math.cos(0.5 * theta)
        rise = v - device.offset * s + self.h * (1.0 - c)
        turn = (-device.offset * c + self.h * s) / half + 0.5 * rise * math.sin(0.5 * theta) / half**2
        return rise / half, 1.0 / half, turn

    def rates(self, y, states, x, mode, side, slides):
        """Rates of y and of states; with the normal force by v, the moment and what friction can bear, V and N of the ground."""
        horizontal, vertical = self.shaken(x)
        v, theta, v_rate, omega = y
        s, c = math.sin(theta), math.cos(theta)
        H, slope = self.lever(theta, side)
        W, bend = side * self.b * c - self.h * s, -side * self.b * s - self.h * c
        by_v = by_theta = along = down = bears = friction = 0.0
        changes = []
        for device, q in zip(self.devices, states, strict=True):
            e, e_v, e_theta = self.gap(device, v, theta, side)
            rate, arm = e_v * v_rate + e_theta * omega, e_theta + W * e_v
            if device.kind == "friction":
                pull = device.force * math.copysign(1.0, arm * slides) if slides and abs(arm) > 1e-9 else 0.0
                bears += device.force * abs(arm) if abs(arm) > 1e-9 else 0.0
                friction += pull * arm
            else:
                pull = device.pull(e, rate, q)
            changes.append(device.own_rate(rate, q)[1])
            by_v, by_theta = by_v + pull * e_v, by_theta + pull * e_theta
            along += pull * (device.way or math.sin(0.5 * theta))
            down += 0.0 if device.way else pull * math.cos(0.5 * theta)
        if mode == FLIES:
            up = -self.g - vertical - by_v
            turn = -(H * slope * omega**2 + H * horizontal + by_theta) / (self.inertia + H**2)
            moment = 0.0
        else:
            moment = -(self.g + vertical) * W - horizontal * H - by_theta - W * by_v
            turn = moment / (self.inertia + self.b**2 + self.h**2) if mode == ROCKS else 0.0
            up = W * turn + bend * omega**2
        normal = self.g + vertical + up
        moves = [v_rate, omega, up, turn] if mode in (ROCKS, FLIES) else [0.0] * 4
        shear = horizontal + H * turn + slope * omega**2 + along
        return moves, changes, (normal + by_v, moment + friction, bears, shear, 0.0 if mode == FLIES else normal + down)

    def stepped(self, x, h):
        """State and devices' states a Runge–Kutta step later."""
        start, states = self.y, [device.state for device in self.devices]
        sums, more, y, q = [0.0] * 4, [0.0] * len(states), start, states
        moves, changes = sums, more
        for weight, share in ((1, 0.0), (2, 0.5), (2, 0.5), (1, 1.0)):
            if share:
                y = [a + share * h * k for a, k in zip(start, moves, strict=True)]
                q = [a + share * h * k for a, k in zip(states, changes, strict=True)]
            moves, changes, _ = self.rates(y, q, x + share * h, self.mode, self.side, self.slides)
            sums = [a + weight * k for a, k in zip(sums, moves, strict=True)]
            more = [a + weight * k for a, k in zip(more, changes, strict=True)]
        y = [a + h / 6.0 * k for a, k in zip(start, sums, strict=True)]
        if self.mode in (ROCKS, STICKS):
            y[0] = self.side * self.b * math.sin(y[1]) - self.h * (1.0 - math.cos(y[1]))
            y[2] = (self.side * self.b * math.cos(y[1]) - self.h * math.sin(y[1])) * y[3]
        return y, [a + h / 6.0 * k for a, k in zip(states, more, strict=True)]

    def pivots(self, y):
        """Heights and velocities of the left and the right pivot."""
        s, c = math.sin(y[1]), math.cos(y[1])
        return [
            (y[0] + i * self.b * s + self.h * (1.0 - c), y[2] + (i * self.b * c + self.h * s) * y[3])
            for i in (1.0, -1.0)
        ]

    def ways(self, y):
        """Angular velocity and, in flight, the velocity of the lower pivot: what turns at a peak."""
        return y[3], min(self.pivots(y))[1] if self.mode == FLIES else 0.0

    def branches(self, y, states):
        found = []
        for device, q in zip(self.devices, states, strict=True):
            e, e_v, e_theta = self.gap(device, y[0], y[1], self.side)
            found.append(device.branch(e, e_v * y[2] + e_theta * y[3], q))
        return found

    def lifts(self, side, x):
        """Acceleration towards ``side`` of the block at rest, were it to rock there."""
        states = [device.state for device in self.devices]
        return side * self.rates([0.0] * 4, states, x, ROCKS, side, side)[0][3]

    def happens(self, y, states, x, branches, ways):
        """The event that a state is behind, None for none."""
        if self.mode == REST:
            lifts = {side: self.lifts(side, x) for side in (1.0, -1.0)}
            if self.rates(y, states, x, REST, 0.0, 0.0)[2][0] < 0.0:
                return "take-off"
            side = max(lifts, key=lifts.get)
            return ("lift-off", side) if lifts[side] > 1e-13 else None
        if abs(y[1]) >= 0.5 * math.pi:
            return "falls"
        forces = self.rates(y, states, x, self.mode, self.side, self.slides)[2]
        if self.mode == STICKS:
            return "slides" if abs(forces[1]) > forces[2] else None
        if self.mode == ROCKS and self.side * y[1] < 0.0:
            return "impact"
        if self.mode == ROCKS and forces[0] < 0.0:
            return "take-off"
        if self.mode == FLIES:
            landed = [
                side for side, (height, rate) in zip((-1.0, 1.0), self.pivots(y), strict=True) if height < 0.0 > rate
            ]
            if landed:
                return ("lands", landed)
        if any(before * now < 0.0 for before, now in zip(ways, self.ways(y), strict=True)):
            return "turns"
        return None if self.branches(y, states) == branches else "branch"

    def _advance(self, x, end):
        while x < end - 1e-14 and self.status == "ok":
            h = end - x
            moves = self.rates(self.y, [d.state for d in self.devices], x, self.mode, self.side, self.slides)[0]
            if self.mode == ROCKS and self.y[1] == 0.0 and self.side * moves[3] < 0.0:
                hop = 2.5 * abs(self.y[3] / moves[3])
                h = min(h, hop) if hop > 0.0 else h
            soon = self.stepped(x, 1e-7 * h)
            branches, ways = self.branches(*soon), self.ways(soon[0])
            y, states = self.stepped(x, h)
            event = self.happens(y, states, x + h, branches, ways)
            if event:
                low, high = 0.0, h
                for _ in range(HALVINGS):
                    middle = 0.5 * (low + high)
                    y, states = self.stepped(x, middle)
                    found = self.happens(y, states, x + middle, branches, ways)
                    low, high, event = (low, middle, found) if found else (middle, high, event)
                h = high
                if event == "branch" and h < 1e-9 * (end - x):  # a kink that stays within rounding
                    h, event = 1e-3 * (end - x), None
                y, states = self.stepped(x, h)
            self.y, x = y, x + h
            self._take(states, x)
            if event not in (None, "turns", "branch") or (event == "turns" and self.rubs):
                self._change(event, x)
                self._take([device.state for device in self.devices], x)

    def _take(self, states, x):
        y = self.y
        if abs(y[1]) > self.peak:
            self.peak, self.t_peak = abs(y[1]), self.start + x
        for device, q in zip(self.devices, states, strict=True):
            device.state = q
            e, e_v, e_theta = self.gap(device, y[0], y[1], self.side)
            device.state, rate = device.settled(e), e_v * y[2] + e_theta * y[3]
            pull = (
                math.copysign(device.force, rate) if device.kind == "friction" else device.pull(e, rate, device.state)
            )
            device.take(e, pull if device.kind != "friction" or abs(rate) > 1e-12 else 0.0, rate)
        if abs(y[1]) <= self.alpha:
            *_, shear, normal = self.rates(y, [d.state for d in self.devices], x, self.mode, self.side, self.slides)[2]
            self.shear, self.normal = max(self.shear, abs(shear)), max(self.normal, normal)
        if self.mode == FLIES:
            self.high = max(self.high, min(height for height, _ in self.pivots(y)))

    def _on_pivot(self, x):
        """Mode of a block with a pivot down, by what the ground would have to bear."""
        states, omega = [device.state for device in self.devices], self.y[3]
        self.slides = math.copysign(1.0, omega) if omega else 0.0
        if not omega and self.rubs:
            _, moment, bears, *_ = self.rates(self.y, states, x, STICKS, self.side, 0.0)[2]
            if abs(moment) <= bears:
                return STICKS
            self.slides = math.copysign(1.0, moment)
        return FLIES if self.rates(self.y, states, x, ROCKS, self.side, self.slides)[2][0] < 0.0 else ROCKS

    def _change(self, event, x):
        before, kind = self.mode, event if isinstance(event, str) else event[0]
        if kind == "falls":
            self.status = "overturned"
            self.duration += self.start + x - self.began if self.mode == FLIES else 0.0
            return
        if kind == "take-off":
            self.mode, self.side = FLIES, self.side if before == ROCKS else 0.0
        elif kind == "lift-off":
            self.mode, self.side, self.slides, self.y = ROCKS, event[1], event[1], [0.0] * 4
            self.counts["separations"] += 1
        elif kind in ("turns", "slides"):
            if self.mode != FLIES:
                self.y[2:] = [0.0, 0.0]
                self.mode = self._on_pivot(x)
        elif kind == "impact":
            self.side, omega = -self.side, self.e * self.y[3]
            self.y = [0.0, 0.0, self.side * self.b * omega, omega]
            self.counts["impacts"] += 1
            self.mode = self._on_pivot(x)
            slow, other = self.lifts(self.side, x), self.lifts(-self.side, x)
            if self.mode == ROCKS and max(slow, other) < 0.0:
                next_one = max(omega**2 / -slow, (self.e * omega) ** 2 / -other)
                lasts = 2.0 * abs(omega) * (1.0 / -slow + self.e / -other) / (1.0 - self.e**2)
                if 0.5 * next_one < LEAST_BOUNCE * self.alpha and lasts < self.dt:
                    self.mode, self.slides, self.y = REST, 0.0, [0.0] * 4
        elif kind == "lands":
            self._land(event[1], x)
        if self.mode == FLIES and before != FLIES:
            self.counts["flights"] += 1
            self.began = self.start + x
        if before == FLIES and self.mode != FLIES:
            self.duration += self.start + x - self.began

    def _land(self, landed, x):
        heights = self.pivots(self.y)
        if max(height for height, _ in heights) <= 1e-13 and max(rate for _, rate in heights) < 0.0:
            self.mode, self.y = REST, [0.0] * 4
            self.counts["impacts"] += 2
            return
        v, theta, v_rate, omega = self.y
        i = landed[0]
        arm = self.h * math.sin(theta) - i * self.b * math.cos(theta)
        kept, own = self.lever(theta, i)[0], self.lever(theta, self.side)[0]
        omega = ((self.inertia + kept * own) * omega - arm * v_rate) / (self.inertia + self.b**2 + self.h**2)
        self.side, self.y = i, [v, theta, -arm * omega, omega]
        self.mode = self._on_pivot(x)
        self.counts["impacts"] += self.mode == FLIES or abs(theta) < self.alpha

    def _row(self, pier):
        row = {
            "status": self.status, "theta_max_over_alpha": self.peak / self.alpha, "t_max_s": self.t_peak, **self.counts,
            "flight_duration_s": self.duration, "flight_height_m": self.high,
            "base_shear_m_s2": self.shear, "normal_force_m_s2": self.normal,
        }  # fmt: skip
        for kind in dict.fromkeys(name for name, _ in self.named):
            used = [device.used for name, device in self.named if name == kind]
            most = {key: max(each[key] for each in used) for key in used[0]}
            lost = sum(d.used["work"] - d.stored() for name, d in self.named if name == kind and d.kind != "spring")
            times = sum(each["times"] for each in used)
            row[f"{kind}_force_over_weight"] = most["most"] / self.g
            if kind == "damper":
                row |= {
                    "damper_stroke_m": most["stroke"],
                    "damper_speed_m_s": most["speed"],
                    "damper_energy_J_kg": lost,
                }
                row |= {"damper_travel_m": most["travel"], "damper_work_J_kg": most["work"]}
            elif kind == "tendon":
                row["tendon_slack"] = times
            else:
                row |= {f"{kind}_deflection_m": most["stroke"], f"{kind}_blows": times, f"{kind}_energy_J_kg": lost}
        return row
