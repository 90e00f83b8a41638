"""A pier with a shaft that bends, as the product takes it and as mass points, and a motion that rocks it."""

import math
from dataclasses import replace
from itertools import pairwise

import flexible_reference
import numpy as np

import rockbatch as rb
from rockbatch.motions.motion import Motion

G, DT = 9.81, 0.02


def pier_of(
    width: float, height: float, shaft: tuple[float, float], deck: tuple[float, float], period: float
) -> rb.Pier:
    """A shaft of a mass [t] and a half distance between its legs [m], and a deck of a mass and a radius, 5 % above it."""
    (mass, spread), (above, radius) = shaft, deck
    parts = [
        rb.Part(mass, 0.5 * height, mass * (height**2 / 12.0 + spread**2), height),
        rb.Part(above, 1.05 * height, above * radius**2, 0.0),
    ]
    return replace(rb.Pier.of_parts(width, parts), flexural_period_s=period)


def points_of(
    width: float,
    height: float,
    shaft: tuple[float, float],
    deck: tuple[float, float],
    period: float,
    base: rb.RigidBase,
    cuts: tuple[float, ...] = (),
) -> flexible_reference.Points:
    """The same pier as mass points, with the shapes of its modes; its shaft in pieces between ``cuts``."""
    (mass, spread), (above, radius) = shaft, deck
    ends = cuts or (0.0, height)
    pieces = [(mass * (b - a) / height, a, b, spread) for a, b in pairwise(ends)]
    modes, stiff = base.modes(pier_of(width, height, shaft, deck, period)), base.flexural_damping_kind == "stiffness"
    return flexible_reference.points_of(
        [*pieces, (above, 1.05 * height, 1.05 * height, radius)],
        modes.along,
        half_width=0.5 * width,
        frequency=modes.frequency,
        damping_ratio=base.flexural_damping * np.where(stiff, modes.frequency / modes.frequency[0], 1.0),
        gravity=G,
    )


def shaken(amplitude: float, period: float, upwards: float = 0.0, duration: float = 4.0) -> Motion:
    """A wave packet around 1.5 s, and one up and down."""
    t = np.arange(0.0, duration, DT)
    packet = np.exp(-(((t - 1.5) / 0.9) ** 2))
    return Motion(
        "shaken", DT, amplitude * np.sin(2 * math.pi * t / period) * packet,
        upwards * G * np.sin(2 * math.pi * t / 0.37) * packet,
    )  # fmt: skip


TOWER = (8.0, 40.0, (3000.0, 2.5), (1500.0, 2.0), 0.9)
