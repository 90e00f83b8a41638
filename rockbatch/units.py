"""Units at the border: everything inside is SI, angles are in radians."""

import re

GRAVITY = 9.81
"""Acceleration of gravity [m/s²] that the reference paper uses (its R0 = 7.36 m for p = 1 rad/s, μ = 3)."""

LEAST, MOST = 1e-15, 1e15
"""Bounds of any number that a user states, but for 0, whatever its unit: products and powers of some stay finite."""

_ACCELERATION_IN_M_S2 = {
    "m/s2": 1.0,
    "cm/s2": 0.01,
    "gal": 0.01,
    "mm/s2": 1e-3,
    "um/s2": 1e-6,
    "nm/s2": 1e-9,
}

_LENGTH_IN_M = {"mm": 0.001, "cm": 0.01, "m": 1.0}


def length_factor(unit: str) -> float | None:
    """Return the factor that turns "cm", or a "cm/sec", into m, or m/s; ``None`` for another unit."""
    return _LENGTH_IN_M.get(unit.strip().lower().partition("/")[0])


def acceleration_factor(unit: str, gravity: float = GRAVITY) -> float:
    """Return the factor that turns an acceleration in ``unit`` into m/s².

    Spellings such as ``cm/s/s``, ``cm/s²``, ``CM/SEC**2``, ``nm/(s^2)``, ``m*s**-2`` and ``G`` are understood; "g"
    is ``gravity`` [m/s²], the same that the pier weighs with, so that ratios ü_g/g survive. Raises ``ValueError`` for
    anything else.
    """
    key = unit.strip().lower().replace("²", "2").replace("sec", "s")
    key = re.sub(r"[\^() ]|\*\*", "", key.replace("µ", "u").replace("μ", "u"))
    key = re.sub(r"/s/s|\*?s-2", "/s2", key)
    if key == "g":
        return gravity
    if key in ("g/10", "0.1g"):
        return gravity / 10.0
    if key not in _ACCELERATION_IN_M_S2:
        known = ", ".join(["g", "g/10", *_ACCELERATION_IN_M_S2])
        raise ValueError(f'unknown acceleration unit "{unit}"; write one of {known}')
    return _ACCELERATION_IN_M_S2[key]
