"""Fragility curves: the probability of overturning at a peak ground velocity, on two foundations."""

from pathlib import Path

from matplotlib.figure import Figure

import rockbatch as rb

RECORDS = Path(__file__).parents[2] / "motions" / "near_fault"
STUDY = f"""
[pier]
width_m = 2.0
height_m = 15.0

[motions]
path = '{RECORDS}'
vertical = false

[fragility]
measure = "PGV"
levels_m_s = [0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0]

[[case]]
name = "rigid"
base = "rigid"

[[case]]
name = "pads"
base = "yielding"
beta = 80
eta = 2.5
epsilon = 0.05
"""


def draw() -> Figure:
    return rb.fragility(rb.Study.from_toml(STUDY)).plot()
