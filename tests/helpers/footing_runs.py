"""Runs of a Foot by the core alone."""

import math

import numpy as np
from footing_reference import GRAVITY, Foot

from rockbatch.core.footing.lanes import line_of, system_of
from rockbatch.core.footing.model import BEDS, MOST_STRIPS, Footing
from rockbatch.core.ground import ground_rows
from rockbatch.core.run import march


def model_of(foot: Foot, shifting=None, gap=0.0) -> Footing:
    """The core's numbers of a Foot; with a ``gap`` two strips at its edges, of that share of the width."""
    k, rows = foot.stiffness, BEDS[0] + max(0, foot.strips - MOST_STRIPS)
    return Footing(
        0.5 * foot.width, foot.height, foot.inertia, GRAVITY, k, foot.safety * GRAVITY, 2.0 * foot.zeta * math.sqrt(k),
        3.0 if gap else float(foot.strips), gap, 1.0, 1e-12, True if foot.finite else None, shifting,
        np.zeros((rows, BEDS[1])),
    )  # fmt: skip


def run(m, horizontal, dt, substeps, vertical=(), quiet_s=0.0, patience_s=0.0, copies=1):
    """Results of runs of ``m``, all alike."""
    ground = ground_rows(horizontal, vertical, dt)
    line = line_of(m, 0.0, 0.0, dt, substeps, math.ceil(quiet_s / dt), 0, len(horizontal), math.ceil(patience_s / dt))
    return march(system_of(m), [line] * copies, ground, np.zeros(1, np.uint8), substeps)


def closed_form(theta, width, stiffness, strength, weight):
    """Moment of a uniform bed about its middle at a rotation, pushed there once (THEORY.md, A footing)."""
    k, q, b = stiffness / width, strength / width, width
    if theta <= 2.0 * weight / (stiffness * b):
        if weight / b + 0.5 * k * theta * b <= q:
            return k * b**3 / 12.0 * theta
    elif k * theta * math.sqrt(2.0 * weight / (k * theta)) <= q:
        return weight * (0.5 * b - math.sqrt(2.0 * weight / (k * theta)) / 3.0)
    y = math.sqrt(2.0 * (q * b - weight) / (k * theta)) if math.isfinite(q) else math.inf
    if y <= b and q >= k * theta * y:
        return 0.5 * k * theta * y * y * (0.5 * b - y / 3.0)
    t = q / (k * theta)
    s = weight / q - 0.5 * t
    return q * s * (0.5 * b - 0.5 * s) + 0.5 * q * t * (0.5 * b - s - t / 3.0)
