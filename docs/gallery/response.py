"""One run in full: rotation, velocity, energy, ground, and the force of each support over its deflection."""

from matplotlib.figure import Figure

import rockbatch as rb


def draw() -> Figure:
    pier = rb.Pier(alpha=0.13, p=0.38)
    pads = rb.YieldingBase(beta=40, eta=2.5, epsilon=0.05)
    pulse = rb.pulse("sine", name="sine pulse, 0.4 g, 2 s", amplitude=0.4 * 9.81, period=2.0, dt=0.005, duration=12.0)
    return rb.simulate(pier, pads, pulse).plot()
