"""A pier under a sine pulse by rockbatch and by OpenSees: the page of the OpenSees script has it."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import rockbatch as rb

CURVE = Path(__file__).parents[2] / "benchmarks" / "opensees_curve.csv"


def run() -> rb.Response:
    """Return the run that stands on the page beside the script."""
    pier = rb.Pier.rectangle(width_m=4.0, height_m=30.0, mass_t=2000.0)
    pads = rb.ElasticBase.from_stiffness(pier, 1e6, epsilon=1.0, kinematics="finite")
    pulse = rb.pulse("sine", name="pulse", amplitude=2.2, period=1.5, dt=0.005, duration=6.0)
    return rb.simulate(pier, pads, pulse)


def draw() -> Figure:
    response = run()
    t, theta = np.loadtxt(CURVE, delimiter=",", skiprows=1).T
    figure = Figure(figsize=(7.0, 3.0), layout="constrained")
    axes = figure.subplots()
    axes.plot(response.t, 1e3 * response.theta, label="rockbatch")
    axes.plot(t, 1e3 * theta, "k--", lw=1.0, label="OpenSees")
    axes.legend(frameon=False)
    axes.set(xlabel="t [s]", ylabel="θ [mrad]", xlim=(0.0, t[-1]))
    return figure
