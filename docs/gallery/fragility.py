"""Fragility curves: the probability of overturning at a peak ground velocity, on two foundations."""

from pathlib import Path
from statistics import NormalDist

import numpy as np
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
    result = rb.fragility(rb.Study.from_toml(STUDY))
    figure = Figure(figsize=(7.0, 4.2), layout="constrained")
    axes = figure.subplots()
    levels = np.linspace(0.05, 4.0, 200)
    for marker, curve in zip("os", result.curves, strict=True):
        name = curve.case.name
        counted = result.fragility[result.fragility["case"] == name]
        (points,) = axes.plot(counted["level"], counted["exceeded"] / counted["n"], marker, mfc="none")
        fitted = curve.fitted
        probability = [NormalDist(np.log(fitted.median), fitted.dispersion).cdf(level) for level in np.log(levels)]
        axes.plot(levels, probability, color=points.get_color(), label=f"{name}: median {fitted.median:.2f} m/s")
    axes.set(
        xlabel="PGV [m/s]", ylabel="P(overturning)", title="2 m × 15 m, ten components of five near-fault stations"
    )
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)
    return figure
