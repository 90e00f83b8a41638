"""Work of devices in a run: cumulative travel, energy and half cycles of each damper, and strain of each tendon."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from rockbatch.motions.motion import Samples
from rockbatch.pier import Base, Damper, Pier, Tendon, places


class Courses(NamedTuple):
    """Elongation [m], force [N/kg] and energy taken [J/kg] of all devices at every row; shape (rows, devices) each.

    If ``lost`` is None, the energy is the work of the force between rows, by the trapezoidal rule. With the times ``t`` [s] of
    the rows and the ``speed`` [m/s] of each device without its brace, extremes between rows count, too: :func:`with_turns`.
    """

    elongation: Samples
    pull: Samples
    lost: Samples | None = None
    t: Samples | None = None
    speed: Samples | None = None


class Work(NamedTuple):
    """Work of each device; shape (devices,) each, ``strain`` NaN for all but tendons that can yield."""

    travel: Samples  # [m]
    lost: Samples  # [J/kg]
    half_cycles: Samples
    strain: Samples  # greatest, over the yield strain


def rainflow(course: Sequence[float] | Samples) -> tuple[Samples, Samples]:
    """Return the ranges of a ``course`` and their half cycles, 1 or 2, by rainflow counting (ASTM E1049-85, 5.4.4).

    Both are empty if the course is constant.
    """
    values = np.asarray(course, dtype=np.float64)
    values = values[np.concatenate([[True], np.diff(values) != 0.0])]
    steps = np.diff(values)
    turns = np.concatenate([[True], steps[1:] * steps[:-1] < 0.0, [True]])[: len(values)]
    ranges, counts, points = list[float](), list[int](), list[float]()

    def count(width: float, halves: int) -> None:
        ranges.append(width)
        counts.append(halves)

    for value in values[turns].tolist():
        points.append(value)
        while len(points) >= 3 and abs(points[-1] - points[-2]) >= (width := abs(points[-2] - points[-3])):
            if len(points) == 3:  # the range contains the starting point: half a cycle
                count(width, 1)
                del points[0]
            else:
                count(width, 2)
                del points[-3:-1]
    for first, second in pairwise(points):
        count(abs(second - first), 1)
    return np.array(ranges), np.array(counts, dtype=np.float64)


def with_turns(t: Samples, way: Samples, speed: Samples) -> Samples:
    """Return the ``way`` [m] at times ``t`` [s] with an extreme inserted wherever ``speed`` [m/s] changes sign between rows.

    The extreme is that of the cubic Hermite polynomial between the two rows.
    """
    h = np.diff(t)
    rows = np.flatnonzero((h > 0.0) & (speed[:-1] * speed[1:] < 0.0))
    h, start, travel = h[rows], way[rows], way[rows + 1] - way[rows]
    first, last = h * speed[rows], h * speed[rows + 1]
    # the rate is first + 2 linear s + square s²; its signs at the ends differ, so one zero is between them but for rounding
    square, linear = 3.0 * (first + last - 2.0 * travel), 3.0 * travel - 2.0 * first - last
    larger = -(linear + np.copysign(np.sqrt(np.maximum(linear**2 - square * first, 0.0)), linear))
    with np.errstate(divide="ignore"):
        one, other = first / larger, larger / square
    s = np.clip(np.where(np.abs(one - 0.5) <= np.abs(other - 0.5), one, other), 0.0, 1.0)
    turns = start + s * travel + s * (1.0 - s) * ((1.0 - s) * (first - travel) + s * (travel - last))
    return np.insert(way, rows + 1, turns)


def work_of(pier: Pier, base: Base, courses: Courses, least_stroke: float) -> Work:
    """Return the work of all devices; half cycles are counted if their range is at least ``least_stroke`` [m].

    Travel and half cycles of a damper are its own, without its brace.
    """
    devices = [device for device in base.restraints for _ in places(pier, device)]
    elongation, pull, lost, t, speed = courses
    per_lambda = pier.gravity * pier.size / pier.half_width**2  # stiffness over the mass [1/s²] of λ = 1
    braces = [per_lambda * device.brace if isinstance(device, Damper) else math.inf for device in devices]
    way = elongation - pull / np.array(braces)
    halves, travels, strain = [], [], np.full(len(devices), math.nan)
    for j, device in enumerate(devices):
        course = way[:, j] if t is None or speed is None else with_turns(t, way[:, j], speed[:, j])
        travels.append(np.abs(np.diff(course)).sum())
        ranges, counts = rainflow(course)
        halves.append(counts[ranges >= least_stroke].sum())
        if isinstance(device, Tendon) and device.strength < math.inf:
            most = device.psi * pier.gravity + device.lam * per_lambda * course.max()
            strain[j] = max(most, 0.0) / (device.strength * pier.gravity)
    taken = (0.5 * (pull[1:] + pull[:-1]) * np.diff(way, axis=0)).sum(axis=0) if lost is None else lost[-1] - lost[0]
    return Work(np.array(travels), taken, np.array(halves), strain)
