"""A rocking spectrum: the sizes of pier that are safe under the records, on rigid ground and on yielding pads."""

from pathlib import Path

from matplotlib.figure import Figure

import rockbatch as rb

RECORDS = Path(__file__).parents[2] / "motions" / "near_fault"
STUDY = f"""
[pier]
alpha = 0.15
p = 1.0

[motions]
path = '{RECORDS}'
vertical = false

[[case]]
name = "rigid"
base = "rigid"

[[case]]
name = "pads"
base = "yielding"
beta = 40
eta = 2.5
epsilon = 0.05

[spectrum]
alpha = 0.15
two_pi_over_p_s = [2.0, 14.0]
points = 25
"""


def draw() -> Figure:
    return rb.spectrum(rb.Study.from_toml(STUDY)).plot()
