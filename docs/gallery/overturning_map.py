"""Pulses that overturn a pier: amplitude against frequency, with the safe band between the two ways to overturn."""

import numpy as np
from matplotlib.figure import Figure

import rockbatch as rb

STUDY = """
[pier]
alpha = 0.15
p = 1.0

[[motions.pulse]]
name = "none of the map's own"
shape = "sine"
amplitude_g = 0.1
period_s = 1.0
dt_s = 0.01
duration_s = 2.0

[[case]]
name = "rigid"
base = "rigid"

[spectrum]

[[spectrum.map]]
name = "one-sine"
shape = "sine"
frequency = [1.0, 7.0]
frequencies = 13
amplitude = [1.0, 10.0]
amplitudes = 19
"""


def draw() -> Figure:
    regions = rb.spectrum(rb.Study.from_toml(STUDY)).overturning_map
    figure = Figure(figsize=(7.0, 5.0), layout="constrained")
    axes = figure.subplots()
    frequencies = regions["omega_p_over_p"].unique()  # closer where boundaries begin or end
    edges = np.concatenate([frequencies[:1], (frequencies[1:] + frequencies[:-1]) / 2, frequencies[-1:]])
    colours = zip(("#e8eef4", "#d98c3f", "#8c3b2e"), regions.groupby("outcome", sort=False), strict=True)
    for colour, (outcome, rows) in colours:
        place = np.searchsorted(frequencies, rows["omega_p_over_p"])
        left, width, height = edges[place], edges[place + 1] - edges[place], rows["high"] - rows["low"]
        axes.bar(left, height, width, bottom=rows["low"], align="edge", color=colour, ec=colour, lw=0.2, label=outcome)
    axes.set(xlabel="ω_p/p", ylabel="a_p/(g tan α)", title="One-sine on rigid ground, α = 0.15", ylim=(1, 10))
    axes.legend(loc="upper left", framealpha=1)
    return figure
