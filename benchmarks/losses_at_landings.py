"""Which damping ζ of the supports loses as much of a pier's energy, from swing to swing, as which restitution ε.

    python benchmarks/losses_at_landings.py

The tower of Fig. 7 on elastic springs, β = 80, after one sine of 0.25 g × 2.5 s: share of V = cos(α − θ) − cos α that is
kept from one extreme of the rotation to that of the other side, as the mean of four.
"""

import numpy as np
from tower import TOWER

import rockbatch as rb
from rockbatch.motions import Motion
from rockbatch.pier import ElasticBase

PERIOD, AMPLITUDE_G, DT = 2.5, 0.25, 0.01
SWINGS = 4


def kept(base: ElasticBase) -> float:
    """Share of the energy that is kept in a swing."""
    t = np.arange(4000) * DT
    push = np.where(t <= PERIOD, AMPLITUDE_G * TOWER.gravity * np.sin(2.0 * np.pi * t / PERIOD), 0.0)
    response = rb.simulate(TOWER, base, Motion("sine", DT, push), substeps=16, quiet_s=0.0, wait=False)
    theta = response.theta[response.t > PERIOD]
    sides = np.flatnonzero(np.diff(np.sign(theta))) + 1
    extremes = np.array([np.abs(swing).max() for swing in np.split(theta, sides)[: SWINGS + 1]])
    climbed = np.cos(TOWER.alpha - extremes) - np.cos(TOWER.alpha)
    return float((climbed[-1] / climbed[0]) ** (1.0 / SWINGS))


if __name__ == "__main__":
    print("| | share of the energy kept in a swing |\n| --- | --- |")
    for epsilon in (1.0, 0.9, 0.7, 0.5, 0.3, 0.0):
        print(f"| ε = {epsilon:g} | {kept(ElasticBase(80.0, epsilon, flight='guided')):.3f} |")
    for zeta in (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0):
        print(f"| ζ = {zeta:g} | {kept(ElasticBase(80.0, flight='guided', zeta=zeta)):.3f} |")
