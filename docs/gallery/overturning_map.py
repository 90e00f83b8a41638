"""Pulses that overturn a pier: amplitude against frequency, with the safe band between the two ways to overturn."""

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
    return rb.spectrum(rb.Study.from_toml(STUDY)).plot()
