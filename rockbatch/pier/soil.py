"""Stiffness of a rigid rectangular footing on soil, and how its bed of springs follows from it (THEORY.md, A footing).

Stiffnesses in MN/m and MN m/rad from a shear modulus in MPa and lengths in m. The footing rocks in the plane of its ``width``.
"""

import math
from collections.abc import Callable
from typing import Literal, NamedTuple

Formula = Literal["gazetas", "pais-kausel"]


class Soil(NamedTuple):
    """Soil under and beside a footing: G [MPa], ν, depth of embedment [m]."""

    shear_modulus_MPa: float  # noqa: N815 (the study's key)
    poisson: float
    embedment_m: float = 0.0


class Stiffness(NamedTuple):
    """Vertical [MN/m] and rocking stiffness [MN m/rad] of a footing."""

    vertical: float
    rocking: float


def gazetas(width: float, length: float, soil: Soil) -> Stiffness:
    """Return the static stiffness after Gazetas (1991), with full contact of the walls along the embedment."""
    b, long = min(width, length), max(width, length)
    modulus, d = soil.shear_modulus_MPa / (1.0 - soil.poisson), soil.embedment_m
    vertical = modulus * long * (0.73 + 1.54 * (b / long) ** 0.75)
    walls = 2.0 * d * (width + length)
    vertical *= (1.0 + d / (10.5 * b) * (1.0 + 1.3 * b / long)) * (
        1.0 + 0.2 * (walls / (width * length)) ** (2.0 / 3.0)
    )
    inertia = length * width**3 / 12.0
    if width <= length:
        rocking = modulus * inertia**0.75 * (long / b) ** 0.25 * (2.4 + 0.5 * b / long)
        embedded = 1.26 * (2.0 * d / b) * (1.0 + (2.0 * d / b) * math.sqrt(b / long))
    else:
        rocking = modulus * inertia**0.75 * 3.0 * (long / b) ** 0.15
        embedded = 0.92 * (2.0 * d / b) ** 0.6 * (1.5 + (2.0 * d / long) ** 1.9)
    return Stiffness(vertical, rocking * (1.0 + embedded))


def pais_kausel(width: float, length: float, soil: Soil) -> Stiffness:
    """Return the static stiffness after Pais & Kausel (1988), as in NIST GCR 12-917-21."""
    b, long = 0.5 * min(width, length), 0.5 * max(width, length)
    modulus, ratio, d = soil.shear_modulus_MPa / (1.0 - soil.poisson), long / b, soil.embedment_m / b
    vertical = modulus * b * (3.1 * ratio**0.75 + 1.6) * (1.0 + (0.25 + 0.25 / ratio) * d**0.8)
    rocking = 3.2 * ratio + 0.8 if width <= length else 3.73 * ratio**2.4 + 0.27
    power = 1.0 if width <= length else 4.0
    embedded = 1.0 + d + 1.6 / (0.35 + ratio**power) * d * d
    return Stiffness(vertical, modulus * b**3 * rocking * embedded)


FORMULAS: dict[Formula, Callable[[float, float, Soil], Stiffness]] = {"gazetas": gazetas, "pais-kausel": pais_kausel}
"""Formulas by the names that users write."""


def bed_stiffness(width: float, length: float, rocking: float) -> float:
    """Return the stiffness [MN/m³] of a uniform bed with this ``rocking`` stiffness [MN m/rad]."""
    return 12.0 * rocking / (width**3 * length)


def radiated(width: float, length: float, soil: Soil, density: float) -> float:
    """Return the vertical dashpot [MN s/m] of the waves that the footing radiates: ρ V_La A, V_La = 3.4 V_s/(π(1 − ν)).

    ``density`` [t/m³]. Per area it is that of high frequencies, and overstates the damping of rocking at those of piers.
    """
    shear_wave = math.sqrt(1000.0 * soil.shear_modulus_MPa / density)
    return density * 3.4 * shear_wave / (math.pi * (1.0 - soil.poisson)) * width * length / 1000.0
