"""A rocking spectrum: the sizes of pier that are safe under the records, on rigid ground and on yielding pads."""

from pathlib import Path

import numpy as np
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
    result = rb.spectrum(rb.Study.from_toml(STUDY))
    figure = Figure(figsize=(8.0, 4.0), layout="constrained")
    cases = result.spectrum_suite["case"].unique()
    for axes, case in zip(figure.subplots(1, len(cases), sharey=True), cases, strict=True):
        of_case = result.spectrum[result.spectrum["case"] == case]
        for _, of_record in of_case.groupby("record", sort=False):
            stood = of_record["theta_max_over_alpha"].where(of_record["status"] != "overturned")
            axes.plot(of_record["two_pi_over_p_s"], stood, lw=0.7, color="0.65")
        suite = result.spectrum_suite[result.spectrum_suite["case"] == case]
        axes.plot(suite["two_pi_over_p_s"], suite["median"].replace(np.inf, np.nan), lw=2, label="median")
        axes.set(xlabel="2π/p [s]", ylabel="θ_max/α", title=case, ylim=(0, 1.1))
        axes.label_outer()
        axes.grid(alpha=0.3)
    figure.axes[0].legend(frameon=False)
    return figure
