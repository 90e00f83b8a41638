"""Greatest displacements of the top of a shaft that bends; ``shaft`` has the shapes of its modes, as a FlexibleBlock does."""

from typing import NamedTuple

from rockbatch.core.flexure.modes import deflection_rates, deflections, dot
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.roots import excess, largest_within
from rockbatch.core.trigonometry import sine_and_cosine


class Displacements(NamedTuple):
    """Greatest displacements of a shaft's top so far."""

    deflection: float  # across the shaft [m]
    drift: float  # horizontal, from rest [m]


@inlined
def _bent(shaft, y):
    """Return the deflection of the top across the shaft [m], and its rate [m/s]."""
    return dot(shaft.end_shape, deflections(y)), dot(shaft.end_shape, deflection_rates(y))


@inlined
def _drift(shaft, y):
    """Return the horizontal displacement of the top from rest, to the right [m], and its rate [m/s]."""
    sine, cosine = sine_and_cosine(y.theta)
    u, u_rate = dot(shaft.top_shape, deflections(y)), dot(shaft.top_shape, deflection_rates(y))
    return shaft.top * sine + u * cosine, (shaft.top * cosine - u * sine) * y.omega + u_rate * cosine


@inlined
def displacements_in(shaft, y):
    """Return the Displacements in state ``y``."""
    return Displacements(abs(_bent(shaft, y)[0]), abs(_drift(shaft, y)[0]))


@inlined
def no_greater_inside(shaft, y, end, h, so_far):
    """Return a number that is negative if a displacement may exceed ``so_far`` between the ends of a sub-step, for a pass."""
    (way, rate), (way_end, rate_end) = _bent(shaft, y), _bent(shaft, end)
    bound = so_far.deflection - max(abs(way), abs(way_end)) - excess(rate, rate_end, h)
    bent = bound if rate * rate_end <= 0.0 else 1.0
    (way, rate), (way_end, rate_end) = _drift(shaft, y), _drift(shaft, end)
    bound = so_far.drift - max(abs(way), abs(way_end)) - excess(rate, rate_end, h)
    return min(bent, bound if rate * rate_end <= 0.0 else 1.0)


@inlined
def displacements_at_end(shaft, end, calm, so_far):
    """Return the Displacements ``so_far``, raised to those at the end of a ``calm`` sub-step, for a pass."""
    deflection, drift = displacements_in(shaft, end)
    return Displacements(max(so_far.deflection, deflection if calm else 0.0), max(so_far.drift, drift if calm else 0.0))


@kernel
def displacements_within(shaft, part, so_far):
    """Return the Displacements ``so_far``, raised to those of a Part."""
    y, end, length = part.start.y, part.end, part.length
    (way, rate), (way_end, rate_end) = _bent(shaft, y), _bent(shaft, end)
    deflection = largest_within(way, rate, way_end, rate_end, length, so_far.deflection)[1]
    (way, rate), (way_end, rate_end) = _drift(shaft, y), _drift(shaft, end)
    return Displacements(deflection, largest_within(way, rate, way_end, rate_end, length, so_far.drift)[1])
