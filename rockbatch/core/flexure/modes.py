"""Numbers of the modes of a shaft, one for each, and their sums."""

from typing import NamedTuple

from rockbatch.core.kernel import inlined

MOST_MODES = 4
"""Greatest number of modes; those that a pier lacks have no share in its motion, and stay at 0."""


class PerMode(NamedTuple):
    """A number of each mode."""

    first: float
    second: float
    third: float
    fourth: float


@inlined
def times(a, b):
    """Return the products, mode by mode, of two PerMode."""
    return PerMode(a.first * b.first, a.second * b.second, a.third * b.third, a.fourth * b.fourth)


@inlined
def scaled(a, factor):
    """Return the PerMode ``a`` times a ``factor``."""
    return PerMode(a.first * factor, a.second * factor, a.third * factor, a.fourth * factor)


@inlined
def dot(a, b):
    """Return the sum over the modes of the products of two PerMode."""
    return a.first * b.first + a.second * b.second + a.third * b.third + a.fourth * b.fourth


@inlined
def deflections(y):
    """Return the coordinates of the modes in a state, or their rates in its rates."""
    return PerMode(y.u_1, y.u_2, y.u_3, y.u_4)


@inlined
def deflection_rates(y):
    """Return the rates of the coordinates of the modes in a state, or their accelerations in its rates."""
    return PerMode(y.u_1_rate, y.u_2_rate, y.u_3_rate, y.u_4_rate)
