"""A measured footing on sand: moments at the peaks of five packets of slow cycles, and those of the bed.

    python benchmarks/measured_footing.py

Test SSG02_03 of Gajan & Kutter (2008): in prototype units a stiff wall of 285 kN, its centre of mass 4.5 m up, on a surface
footing of 2.8 by 0.65 m on dry dense sand of 814 kPa, pushed to and fro in a centrifuge. Peaks of its histories in the database
FoRCy (Hakhamaneshi et al. 2020, doi 10.13019/t0cq-qf64, Open Data Commons Attribution License). The bed is ``FootingBase``,
pushed once; the sand's shear modulus is the one number that was not measured.
"""

import math
from typing import NamedTuple

import numpy as np

import rockbatch as rb

WIDTH, LENGTH, HEIGHT = 2.8, 0.65, 4.5
"""Of the footing, in the plane of rocking and across it, and of the centre of mass [m]."""
WEIGHT_KN, BEARING_MPA, POISSON = 285.0, 0.814, 0.3
MODULI = (20.0, 40.0, 80.0)
"""Shear moduli [MPa]: a quarter, half and all of about what such sand has at small strains."""


class Packet(NamedTuple):
    """Three cycles of one amplitude."""

    rotation: float  # greatest [rad]
    forward: float  # greatest moment about the middle of the base, over W B/2
    back: float

    @property
    def mean(self) -> float:
        """Return the mean of the moments to both sides."""
        return 0.5 * (self.forward + self.back)


PACKETS = (
    Packet(0.0032, 0.525, 0.366),
    Packet(0.0066, 0.691, 0.623),
    Packet(0.0140, 0.779, 0.779),
    Packet(0.0296, 0.837, 0.908),
    Packet(0.0629, 0.874, 0.960),
)


def on_sand(shear_modulus_MPa: float) -> tuple[rb.Pier, rb.FootingBase]:
    """Return the wall, and its footing on sand of this shear modulus."""
    half = 0.5 * WIDTH
    pier = rb.Pier.from_size(math.atan2(half, HEIGHT), math.hypot(half, HEIGHT), mass_t=WEIGHT_KN / 9.81)
    base = rb.FootingBase.from_soil(
        pier, shear_modulus_MPa, POISSON, length_m=LENGTH, bearing_MPa=BEARING_MPA, kinematics="finite"
    )
    return pier, base


def moments(pier: rb.Pier, base: rb.FootingBase) -> tuple[np.ndarray, np.ndarray]:
    """Return rotations [rad], and the moment of the bed about the middle over W B/2, in a single push."""
    curve = rb.statics(pier, base).curve
    theta = curve["theta_rad"].to_numpy()
    return theta, (curve["moment_over_weight_m"].to_numpy() + pier.height * np.sin(theta)) / (0.5 * WIDTH)


def mobilised(theta: np.ndarray, moment: np.ndarray, share: float) -> float:
    """Return the rotation [rad] at which a moment over W B/2 is first reached, linear between the points."""
    first = int(np.argmax(moment >= share))
    return float(np.interp(share, moment[first - 1 : first + 1], theta[first - 1 : first + 1]))


def lines() -> list[str]:
    """Return the lines of the table."""
    beds = [on_sand(modulus) for modulus in MODULI]
    curves = [moments(*bed) for bed in beds]
    most = 1.0 - 1.0 / float(beds[0][1].safety_factor or math.inf)
    head = " | ".join(f"bed, G = {modulus:g} MPa" for modulus in MODULI)
    rows = [f"| rotation [mrad] | measured, forward and back | mean | {head} |", "| --- " * (3 + len(MODULI)) + "|"]
    for packet in PACKETS:
        found = " | ".join(f"{np.interp(packet.rotation, *curve):.2f}" for curve in curves)
        measured = f"{packet.forward:.2f}, {packet.back:.2f} | {packet.mean:.2f}"
        rows.append(f"| {1e3 * packet.rotation:.1f} | {measured} | {found} |")
    tested = np.array([(packet.rotation, packet.mean) for packet in PACKETS]).T
    reached = " | ".join(f"{1e3 * mobilised(*curve, 0.9 * most):.1f}" for curve in curves)
    rows.append(f"| at 0.9 (1 − 1/FS) = {0.9 * most:.2f} | | {1e3 * mobilised(*tested, 0.9 * most):.1f} | {reached} |")
    return rows


if __name__ == "__main__":
    print("\n".join(lines()))
