"""Equilibrium of a pier that is turned slowly on its base, from rest up to overturning (THEORY.md, Statics).

Forces are over the weight M g, moments about the pivot that bears more over M g [m]. The pier turns to the right; its mirror
image stands for the other direction.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from rockbatch.pier.bases import Base, ElasticBase, YieldingBase
from rockbatch.pier.block import Pier
from rockbatch.pier.first_loading import Array, Spring, steel
from rockbatch.pier.frequencies import static_deflection
from rockbatch.pier.places import places, prestress_over_weight
from rockbatch.pier.restraints import Damper, DeckSpring, Restraint, Stop, Tendon

MOST_STEPS, NEAR = 64, 1e-8
"""Most iterations of the vertical balance, and its final bracket over the deflection under the whole weight."""

BALANCED = 1e-14
"""Residual of the vertical balance, over the weight, that is rounding."""

PASSES, PARTS = 5, 64
"""Passes of the search for kinks, and the parts into which each pass divides a step that contains one."""

ONSET = 1e-12
"""Rotation [rad] just above 0, at which friction is fully mobilised and stiffnesses have added nothing."""


def bracketed(excess: Callable[[Array], Array], low: Array, high: Array, near: float) -> tuple[Array, Array, Array]:
    """Return a bracket of the zero of the increasing ``excess``: its ends, and the position of the zero in it, 0 to 1.

    Bisection and regula falsi alternate; where friction makes ``excess`` jump across 0, the bracket encloses the jump.
    Without a zero between ``low`` and ``high`` it shrinks to the end that is nearest to one.
    """
    below, above = excess(low), excess(high)
    for step in range(MOST_STEPS):
        converged = (np.minimum(np.abs(below), np.abs(above)) < BALANCED) | (high - low < near)
        if converged.all():
            break
        share = _secant(below, above) if step % 2 else 0.5
        middle = low + share * (high - low)
        excess_at_middle = excess(middle)
        up = excess_at_middle > 0.0
        low, below = np.where(up, low, middle), np.where(up, below, excess_at_middle)
        high, above = np.where(up, middle, high), np.where(up, excess_at_middle, above)
    return low, high, _secant(below, above)


def _secant(low: Array, high: Array) -> Array:
    """Return the position, 0 to 1, of the zero of the chord between the values ``low`` and ``high``; 0.5 if they are equal."""
    gap = high - low
    return np.clip(np.divide(-low, gap, out=np.full_like(gap, 0.5), where=gap > 0.0), 0.0, 1.0)


def without_dampers(restraints: tuple[Restraint, ...]) -> tuple[Restraint, ...]:
    """Return the tendons, stops and deck springs among ``restraints``: their forces depend on the rotation alone."""
    return tuple(device for device in restraints if not isinstance(device, Damper))


@dataclass(frozen=True)
class Place:
    """A device at one place, at an ``offset`` [m] from the middle of the base towards the more heavily loaded pivot.

    At the deck it has a ``height`` [m], and its elongation is ``way`` times the deck's displacement towards that pivot.
    """

    device: Restraint
    offset: float
    stiffness: float  # of a tendon, stop, deck spring or brace, over the weight [1/m]
    height: float = 0.0
    way: float = 1.0

    def pull(self, elongation: Array, since: float) -> Array:
        """Return the tension over the weight at an ``elongation`` [m], reached monotonically from ``since``, and that from 0.

        A tendon has 0 if slack, its strength at most. Friction has its full force in the direction of motion from ``since``.
        """
        device = self.device
        if isinstance(device, Tendon):
            return np.clip(device.psi + self.stiffness * elongation, 0.0, device.strength)
        if isinstance(device, DeckSpring) and device.linear:
            return self.stiffness * elongation
        if isinstance(device, Stop | DeckSpring):
            return self.stiffness * np.maximum(elongation - device.gap_m, 0.0)
        if device.kind == "friction":
            return device.f * np.sign(elongation - since)
        compliance = device.f / (self.stiffness * device.yield_m)
        curve, total = steel(compliance), elongation / device.yield_m
        start = math.copysign(float(curve.force(np.array([abs(since) / device.yield_m]))[0]), since)
        back = start + (elongation - since) / (device.yield_m * (1.0 + compliance))
        turned = (elongation - since) * since < 0.0
        x = np.where(turned, back, total)
        loaded = np.sign(x) * curve.force(np.abs(x))
        return device.f * np.where(turned & (back * start > 0.0), back, loaded)  # unloading is elastic


@dataclass(frozen=True)
class Equilibria:
    """The pier in equilibrium at rotations ``theta`` [rad]; all arrays of the shape of ``theta``."""

    theta: Array
    # contributions to the righting moment about the more heavily loaded pivot, over the weight [m]; ``weight`` contains the P–Δ
    # moment, ``stops`` that of deck springs
    weight: Array
    tendons: Array
    stops: Array
    dampers: Array
    lever: Array  # lever arm of the horizontal inertia force [m]
    # forces over the weight of the more heavily loaded support and of the other
    toe: Array
    heel: Array
    depth: Array  # depth of the toe below its unstressed place [m]; 0 on rigid ground

    @property
    def moment(self) -> Array:
        """Return the righting moment over the weight [m]."""
        return self.weight + self.tendons + self.stops + self.dampers

    @property
    def acceleration(self) -> Array:
        """Return the steady horizontal ground acceleration that holds the pier there [g]."""
        return self.moment / self.lever


def spring_of(pier: Pier, base: ElasticBase) -> Spring:
    """Return one support of ``base`` under ``pier``: stiffness and yield force over the weight, the force inf if elastic."""
    yield_force = 0.5 * base.eta if isinstance(base, YieldingBase) else math.inf
    return Spring(0.5 / static_deflection(pier, base), yield_force, base.first_loading)


class SlowTurn:
    """A pier with a straight shaft on a base, turned slowly from rest to the right (``side`` 1) or to the left (−1).

    ``restraints`` are the acting devices: all of the base by default. Impossible values were refused before.
    """

    def __init__(
        self, pier: Pier, base: Base, restraints: tuple[Restraint, ...] | None = None, side: float = 1.0
    ) -> None:
        devices = base.restraints if restraints is None else restraints
        self.pier, self.finite = pier, base.kinematics == "finite"
        self.b, self.h = pier.size * math.sin(pier.alpha), pier.height
        self.places = list[Place]()
        for device in devices:
            if isinstance(device, Damper) and device.f == 0.0:
                continue  # viscous: no force in a slow turn
            stiffness = (device.brace if isinstance(device, Damper) else device.lam) * pier.size / pier.half_width**2
            for place in places(pier, device):
                offset = side * place.offset + self.b - pier.half_width  # a frame's block is wider than its columns
                self.places.append(Place(device, offset, stiffness, place.height, side * place.way or 1.0))
        self.spring = spring_of(pier, base) if isinstance(base, ElasticBase) else None
        self.on_pivots = not base.on_springs
        self.at_rest = 0.5 * (1.0 + prestress_over_weight(pier, devices))
        """Force of each support at rest, over the weight."""
        self.settled = 0.0 if self.spring is None else self.spring.depth(self.at_rest)
        """Depth of both pivots at rest [m]."""

    # Geometry: finite rotations, or linearised

    def _rise(self, theta: Array) -> Array:
        """Return the rise of one pivot, and the fall of the other, relative to the middle of the base [m]."""
        return self.b * (np.sin(theta) if self.finite else theta)

    def elongation(self, place: Place, theta: Array, depth: Array) -> Array:
        """Return the elongation of a device since rest [m] at rotation ``theta`` [rad], with the toe at a ``depth`` [m]."""
        if place.height:
            if not self.finite:
                return place.way * place.height * theta
            return place.way * (place.height * np.sin(theta) + self._swing * (1.0 - np.cos(theta)))
        if not self.finite:
            return self.settled - depth + (self.b - place.offset) * theta
        return (self.settled - depth + (self.b - place.offset) * np.sin(theta)) / np.cos(0.5 * theta)

    @property
    def _swing(self) -> float:
        """Horizontal distance [m] of the deck's axis from the pivot about which the pier turns; 0 on springs."""
        return self.b if self.on_pivots else 0.0

    def _by_v(self, theta: Array) -> Array:
        """Return the derivative of a device's elongation by the height of the pier: the vertical part of its tension."""
        return 1.0 / np.cos(0.5 * theta) if self.finite else np.ones_like(theta)

    def _arm(self, place: Place, theta: Array, elongation: Array) -> Array:
        """Return the arm of a device's tension about the toe [m], positive where it rights the pier."""
        if place.height:
            height = place.height * np.cos(theta) + self._swing * np.sin(theta) if self.finite else place.height
            return np.full_like(theta, place.way) * height
        distance = self.b - place.offset
        if not self.finite:
            return np.full_like(theta, distance)
        return distance * np.cos(theta) / np.cos(0.5 * theta) + 0.5 * np.tan(0.5 * theta) * elongation

    def _toe_arm(self, theta: Array) -> Array:
        """Return the arm of the weight about the toe [m]; negative when the centre of mass is past the toe."""
        if not self.finite:
            return self.b - self.h * theta
        return self.b * np.cos(theta) - self.h * np.sin(theta)

    # Balance of the vertical forces

    def _heel(self, theta: Array, depth: Array) -> Array:
        """Return the force of the heel over the weight: elastic from rest, up to its strength; 0 on rigid ground or lifted."""
        if self.spring is None:
            return np.zeros_like(theta)
        risen = self.settled - depth + 2.0 * self._rise(theta)
        return np.clip(self.at_rest - self.spring.stiffness * risen, 0.0, self.spring.strength)

    def _pulls(self, theta: Array, depth: Array, since: list[float]) -> list[Array]:
        """Return the tension of each device over the weight; ``since`` has the elongations [m] from which they move."""
        starts = zip(self.places, since, strict=True)
        return [place.pull(self.elongation(place, theta, depth), start) for place, start in starts]

    def _excess(self, theta: Array, depth: Array, pulls: list[Array], heel: Array) -> Array:
        """Return the upward force of the supports less weight and tensions, over the weight."""
        assert self.spring is not None
        vertical = (pull for place, pull in zip(self.places, pulls, strict=True) if not place.height)
        down = 1.0 + self._by_v(theta) * sum(vertical, start=np.zeros_like(theta))
        return self.spring.force(depth) + heel - down

    @cached_property
    def lift_off(self) -> float | None:
        """The rotation at which the heel leaves its support [rad]: 0 on rigid ground, None if the toe yields before."""
        return None if self._lift_off is None else self._lift_off[0]

    @cached_property
    def _lift_off(self) -> tuple[float, list[float]] | None:
        """Rotation [rad] of lift-off and the devices' elongations [m] there; None if the toe yields before."""
        if self.spring is None:
            return 0.0, [0.0] * len(self.places)
        spring, risen = self.spring, self.at_rest / self.spring.stiffness

        def theta_of(depth: Array) -> Array:
            rise = 0.5 * (depth - self.settled + risen)
            return np.arcsin(np.clip(rise / self.b, -1.0, 1.0)) if self.finite else rise / self.b

        def excess(depth: Array) -> Array:
            theta = theta_of(depth)
            pulls = self._pulls(theta, depth, [0.0] * len(self.places))
            return self._excess(theta, depth, pulls, np.zeros_like(theta))

        limit = self.settled - risen + 2.0 * self.b * (1.0 if self.finite else 0.5 * math.pi)
        if not self.places:
            bears = spring.strength > 1.0 or (spring.strength == 1.0 and spring.curve.corner)
            depth = spring.depth(1.0) if bears else math.inf
        else:
            start, near = np.array([self.settled - risen]), NEAR / spring.stiffness
            low, high, share = bracketed(excess, start, np.array([limit]), near)
            depth = float((low + share * (high - low))[0])
            depth = depth if float(excess(np.array([limit]))[0]) > 0.0 else math.inf
        if not depth < limit:
            return None
        depths, theta = np.array([depth]), theta_of(np.array([depth]))
        return float(theta[0]), [float(self.elongation(place, theta, depths)[0]) for place in self.places]

    def _without_devices(self, theta: Array, on_both: bool) -> tuple[Array, Array]:
        """Return depth of the toe [m] and force of the heel of a pier without devices."""
        assert self.spring is not None
        spring, rise = self.spring, self._rise(theta)
        if not on_both:
            return np.full_like(theta, spring.depth(1.0)), np.zeros_like(theta)
        if spring.curve.corner:
            heel = np.maximum(0.5 - spring.stiffness * rise, max(1.0 - spring.strength, 0.0))
            return self.settled + 2.0 * rise - (0.5 - heel) / spring.stiffness, heel
        bears = self.settled + 2.0 * rise - self.at_rest / spring.stiffness  # depth below which the heel is in contact
        depth = self.settled + rise  # of an elastic toe; Newton's method from there never goes past the root
        for _ in range(MOST_STEPS):
            toe, lifted = spring.force(depth), depth < bears
            slope = np.where(lifted, 0.0, 1.0) + spring.curve.tangent(toe / spring.yield_force)
            excess = 1.0 - toe - self._heel(theta, depth)
            step = excess / (spring.stiffness * np.maximum(slope, NEAR))
            depth, before = np.where(lifted, np.minimum(depth + step, bears), depth + step), depth
            if ((np.abs(excess) < BALANCED) | (np.abs(depth - before) < BALANCED * np.abs(depth))).all():
                break
        return depth, self._heel(theta, depth)

    def _balanced(self, theta: Array, since: list[float], heel: bool) -> tuple[Array, list[Array], Array]:
        """Return depth of the toe [m], tensions and the heel's force; friction that sticks takes the rest of the balance."""
        assert self.spring is not None

        def heel_at(depth: Array) -> Array:
            return self._heel(theta, depth) if heel else np.zeros_like(theta)

        def excess(depth: Array) -> Array:
            return self._excess(theta, depth, self._pulls(theta, depth, since), heel_at(depth))

        room = self.settled + 4.0 * np.abs(self._rise(theta)) + 1.0 / self.spring.stiffness
        low, high, share = bracketed(excess, -room, room, NEAR / self.spring.stiffness)

        def between(a: Array, b: Array) -> Array:
            return (1.0 - share) * a + share * b

        ends = zip(self._pulls(theta, low, since), self._pulls(theta, high, since), strict=True)
        return between(low, high), [between(*pulls) for pulls in ends], between(heel_at(low), heel_at(high))

    def _parts(self, theta: Array, on_both: bool) -> Equilibria:
        """Return the equilibria at ``theta``, all of them before lift-off (``on_both``) or all after it."""
        since = [0.0] * len(self.places) if on_both or self._lift_off is None else self._lift_off[1]
        if self.spring is None:
            depth, heel = np.zeros_like(theta), np.zeros_like(theta)
            pulls = self._pulls(theta, depth, since)
        elif not self.places:
            depth, heel, pulls = *self._without_devices(theta, on_both), []
        else:
            depth, pulls, heel = self._balanced(theta, since, on_both)
        of_devices, down = self._moments(theta, depth, pulls), np.ones_like(theta)
        for place, pull in zip(self.places, pulls, strict=True):
            down += 0.0 if place.height else pull * self._by_v(theta)
        width = 2.0 * self.b * (np.cos(theta) if self.finite else 1.0)
        level = self.h * np.cos(theta) if self.finite else np.full_like(theta, self.h)
        lever = level if on_both and self.spring is not None else level + self._rise(theta)
        of_weight = self._toe_arm(theta) - heel * width
        return Equilibria(theta, of_weight, *of_devices, lever, down - heel, heel, depth)

    def _moments(self, theta: Array, depth: Array, pulls: list[Array]) -> tuple[Array, Array, Array]:
        """Return the moments of tendons, of stops and deck springs, and of dampers about the toe [m], from their pulls."""
        of_tendons, of_stops, of_dampers = np.zeros_like(theta), np.zeros_like(theta), np.zeros_like(theta)
        for place, pull in zip(self.places, pulls, strict=True):
            moment = pull * self._arm(place, theta, self.elongation(place, theta, depth))
            if isinstance(place.device, Damper):
                of_dampers += moment
            elif isinstance(place.device, Tendon):
                of_tendons += moment
            else:
                of_stops += moment
        return of_tendons, of_stops, of_dampers

    def at(self, theta: Array) -> Equilibria:
        """Return the equilibria at rotations ``theta`` > 0 [rad]; at that of lift-off the pier still stands on both supports."""
        if self.spring is None:
            return self._parts(theta, False)
        in_contact = theta <= (math.inf if self.lift_off is None else self.lift_off)
        if in_contact.all() or not in_contact.any():
            return self._parts(theta, bool(in_contact.all()))
        first, second = self._parts(theta[in_contact], True), self._parts(theta[~in_contact], False)
        joined = {name: np.empty_like(theta) for name in vars(first)}
        for name, values in joined.items():
            values[in_contact], values[~in_contact] = getattr(first, name), getattr(second, name)
        return Equilibria(**joined)

    # Rotations at which the regime changes

    @cached_property
    def unstable(self) -> float | None:
        """The rotation from which on the righting moment is negative [rad].

        If there is none up to π/2, it is None with devices, and π/2 without.
        """
        if not self.places:  # a toe that cannot carry the weight alone yields, and carries its strength only
            share = 1.0 if self.spring is None else min(1.0, 2.0 * self.spring.strength - 1.0)
            tangent = share * math.tan(self.pier.alpha)
            return math.atan(tangent) if self.finite else min(tangent, 0.5 * math.pi)
        return self.search_unstable()

    def search_unstable(self) -> float | None:
        """Return the rotation from which on the righting moment is negative [rad], by finer and finer grids; None if none is."""
        low, high, parts = 0.0, 0.5 * math.pi, 96
        for _ in range(5):
            grid = np.linspace(low, high, parts + 1)[1:]
            moments = self.at(grid).moment
            negative = np.flatnonzero(moments < 0.0)
            if len(negative) == 0:
                return None
            i, step, parts = int(negative[0]), (high - low) / parts, 16
            low, high = float(grid[i]) - step, float(grid[i])
            previous = float(moments[i - 1]) if i else math.inf
        return high - step * float(moments[i] / (moments[i] - previous))

    def curve(self, until: float, before: int = 12, after: int = 100) -> Equilibria:
        """Return the equilibria from rest to ``until`` [rad], in ``before`` steps to lift-off and ``after`` growing ones beyond.

        If the toe yields before lift-off, twice ``before`` steps go to twice the rotation at which it yields.
        """
        start = self.lift_off
        if start is None and self.spring is not None:
            # twice the rotation at which the toe, elastic up to there, yields
            start = 2.0 * (self.spring.strength - self.at_rest) / self.spring.stiffness / self.b
            before *= 2
        start = min(start or 0.0, until)
        beyond = [] if self.lift_off is None else [float(np.nextafter(start, 2.0))]
        grid = [ONSET, *beyond, *np.linspace(0.0, start, before + 1)]
        grid += [*(start + (until - start) * np.linspace(0.0, 1.0, after + 1) ** 2)]
        return self._from_rest(grid)

    def _from_rest(self, grid: Sequence[float] | Array) -> Equilibria:
        """Return the equilibria at the sorted, unique rotations of ``grid``; 0 is solved at :data:`ONSET`."""
        equilibria = self.at(np.unique(np.maximum(grid, ONSET)))
        return replace(equilibria, theta=np.where(equilibria.theta > ONSET, equilibria.theta, 0.0))

    def with_rotations(self, curve: Equilibria, rotations: Array) -> Equilibria:
        """Return a curve with further ``rotations`` [rad] inserted; those outside it are left out."""
        inside = rotations[(rotations > curve.theta[0]) & (rotations < curve.theta[-1])]
        parts = zip(vars(curve).values(), vars(self.at(inside)).values(), strict=True)
        _, places = np.unique(np.concatenate((curve.theta, inside)), return_index=True)
        return Equilibria(*(np.concatenate(both)[places] for both in parts))

    def kinks(self, curve: Equilibria) -> Array:
        """Return the rotations [rad] within a curve at which its slope jumps, beside lift-off; empty if it does not.

        There a support or tendon yields, a tendon slackens, or a stop or deck spring engages.
        """
        changes = self._changes(curve)
        for _ in range(PASSES):
            if len(changes):
                grid = np.linspace(curve.theta[changes], curve.theta[changes + 1], PARTS + 1)
                curve = self._from_rest(grid.ravel())
                changes = self._changes(curve)
        return curve.theta[changes + 1]

    def _changes(self, curve: Equilibria) -> npt.NDArray[np.intp]:
        """Return the indices of ``curve`` after which the regime of a support or a device changes."""
        regimes = [np.zeros(len(curve.theta), dtype=bool)]
        if self.spring is not None:
            regimes += [curve.heel >= self.spring.strength]
            if self.spring.curve.corner:
                regimes += [curve.depth * self.spring.stiffness >= self.spring.strength]
            regimes += [
                curve.depth >= self.spring.depth(kink * self.spring.yield_force) for kink in self.spring.curve.kinks
            ]
        for place in self.places:
            device, elongation = place.device, self.elongation(place, curve.theta, curve.depth)
            if isinstance(device, Tendon):
                pull = device.psi + place.stiffness * elongation
                regimes += [pull >= device.strength, pull <= 0.0]
            elif isinstance(device, Stop | DeckSpring):
                regimes += [elongation > device.gap_m]
        return np.flatnonzero(np.any([regime[1:] != regime[:-1] for regime in regimes], axis=0))

    def strongest(self, quantity: str, curve: Equilibria, kinks: Array) -> tuple[float, float]:
        """Return the greatest value of "moment" [m] or "acceleration" [g] along the curve, and the rotation there [rad]."""
        corners = (0.0, self.lift_off, *kinks)
        for _ in range(5):
            values = getattr(curve, quantity)
            i = int(np.argmax(values))
            neighbours = max(i - 1, 0), min(i + 1, len(values) - 1)
            if curve.theta[i] in corners or min(values[j] for j in neighbours) > (1.0 - 1e-7) * values[i]:
                break
            low, high = (float(curve.theta[j]) for j in neighbours)
            curve = self._from_rest([*np.linspace(low, high, 17), curve.theta[i]])
        values = getattr(curve, quantity)
        i = int(np.argmax(values))
        return float(values[i]), float(curve.theta[i])
