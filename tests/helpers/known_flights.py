"""Flights above the rigid base that are known: α = 0.2, p = 1, μ = 3, g = 9.81, from another event-driven solver.

It printed heights of the highest of many samples, too low by 1e-8 m: here are those of its maxima (S1: in closed form).
"""

import numpy as np
import pytest

from rockbatch.core.types import LEFT, NEITHER, RIGHT
from rockbatch.motions.motion import Motion
from rockbatch.pier import Pier

PIER = Pier(alpha=0.2, p=1.0)


def given(horizontal, vertical) -> Motion:
    """Samples in g every 0.05 s, zeros after them, 3 s in all."""
    ground = (
        np.pad(np.array(values, float) * PIER.gravity, (0, 61 - len(values))) for values in (horizontal, vertical)
    )
    return Motion("given", 0.05, *ground)


MOTIONS = {
    "S1": given([0], [0, -1.5, -1.5, -1.5, 0]),
    "S2": given([0, 0.3, 0.3, 0.3, -0.1, 0], [0, -0.5, -1.3, -1.3, -0.4, 0.3, 0]),
    "S3": given([0, 0.4, 0.8, 0.4, 0, -0.3, -0.3, 0], [0, 0, 0, -1.6, -1.6, 0, 0.5, 0]),
}

KNOWN_ENDS = pytest.mark.parametrize(
    ("name", "off", "on"),
    [
        ("S1", (0.033333333, 0.0, 0.0), (0.355826237, 0.0, 0.0)),
        ("S2", (0.0840627, -2.35821e-4, -0.0108852), (0.2595392, -5.39385e-3, -0.0231916)),
        ("S3", (0.1336854, -1.60352e-3, -0.0407583), (0.3401056, -0.01131013, -0.0121420)),
    ],
)
"""Time, θ and θ̇ as printed, to six to nine digits, at take-off and landing; after the landing for θ̇."""

KNOWN_PEAKS = pytest.mark.parametrize(
    ("name", "height", "theta_max", "t_max"),
    [
        ("S1", 0.06392395833, 0.0, 0.0),
        ("S2", 0.01154272190, 0.033450660, 0.375071),
        ("S3", 0.02934591372, 0.058402522, 0.402892),
    ],
)
"""Height of the lower pivot [m], θ_max/α and its time."""

KNOWN_LANDINGS = pytest.mark.parametrize(
    ("pivot", "theta", "omega", "v_rate", "speed", "after"),
    [
        (RIGHT, 0.02, 0.1, -0.5, -0.631721009, {RIGHT: 0.088471280, LEFT: 0.087884940, NEITHER: 0.088178110}),
        (RIGHT, 0.02, -0.1, -0.5, -0.368278991, {RIGHT: -0.106720982, LEFT: -0.106134642, NEITHER: -0.106427812}),
        (LEFT, -0.03, 0.05, -0.8, -0.737762043, {RIGHT: 0.062282879, LEFT: 0.062723376, NEITHER: 0.062503128}),
    ],
)
"""Velocity of the pivot that lands, and θ̇ after it by the pivot that has borne last, to nine decimals."""


def check_ends(off, on, rows):
    """Hold time, θ and θ̇ at take-off and landing, ``rows``, against those known."""
    for row, expected in zip(rows, (off, on), strict=True):
        assert row[0] == pytest.approx(expected[0], abs=6e-8)
        assert row[1] == pytest.approx(expected[1], rel=3e-6, abs=1e-15)
        assert row[2] == pytest.approx(expected[2], rel=5e-6, abs=1e-15)
