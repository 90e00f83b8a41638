"""An example: the estimates of design practice beside the computed peaks of piers on rigid ground.

    python configs/code_estimates.py configs/suite_to_spectrum.toml

They take the rocking pier as an elastic oscillator whose period grows with its rotation. Priestley, Evison & Carr (1978, Bull. NZ
Nat. Soc. Earthq. Eng. 11(3), 141–150) take the period of free rocking (Housner 1963),

    T(φ) = (4/p) arcosh(1/(1 − φ)),   φ = θ/α,

and a constant damping that stands for the impacts, read the displacement off the elastic spectrum, and go on from the rotation
S_d(T, ζ)/R0 until it repeats itself. FEMA 356 (2000) took the method over. Of r, the share of the energy that an impact leaves,
ζ = −0.34 ln r (Makris & Konstantinidis 2003) or ζ = 0.4 (1 − √r) (FEMA 356). Makris & Konstantinidis (2003, Earthq. Eng. Struct.
Dyn. 32(2), 265–289) show why a rocking block is no such oscillator. None of these formulas could be checked against its source.
"""

import math
import sys
from collections.abc import Callable

import numpy as np
import pandas as pd

import rockbatch as rb
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.study.suite import ground_motions

START = 0.5
"""φ at which the iteration begins."""

DAMPING: dict[str, Callable[[float], float]] = {
    "priestley": lambda restitution: -0.34 * math.log(restitution**2),
    "fema_356": lambda restitution: 0.4 * (1.0 - restitution),
}
"""Equivalent damping ζ of a pier on rigid ground: r = e²."""


def rocking_period(share: float, p: float) -> float:
    """Return the period of free rocking [s] with amplitude φ = θ/α, below 1, of a slender block."""
    return 4.0 / p * math.acosh(1.0 / (1.0 - share))


def fixed_point(rotation: Callable[[float], float]) -> float:
    """Return φ that ``rotation`` gives back: 0 for a pier that stays, infinite if it overturns, NaN without convergence."""
    share = START
    for _ in range(200):
        following = rotation(share)
        if following >= 1.0 or following <= 1e-3:
            return math.inf if following >= 1.0 else 0.0
        if abs(following - share) <= 1e-4 * following:
            return following
        share = following
    return math.nan


def estimate(pier: rb.Pier, motion: rb.Motion, method: str) -> float:
    """Return θ_max/α of a pier under a motion, as :func:`fixed_point`."""
    if motion.pga <= pier.gravity * math.tan(pier.alpha):
        return 0.0
    damping = DAMPING[method](pier.restitution)

    def rotation(share: float) -> float:
        period = rocking_period(share, pier.p)
        (sa,) = spectral_acceleration(motion.horizontal, motion.dt, [period], damping)
        return float(sa) * (period / (2.0 * math.pi)) ** 2 / (pier.size * pier.alpha)

    return fixed_point(rotation)


def main(path: str) -> pd.DataFrame:
    """Return the peaks of a study on rigid ground without devices, with the estimates of both methods beside them."""
    study = rb.load_study(path)
    plain = [case for case in study.cases if case.base.name == "rigid" and not case.base.restraints]
    peaks = rb.run(study)
    motions = {motion.name: motion for motion in ground_motions(study)}
    rows = []
    for case in plain:
        matches = (peaks["polarity"] == study.motions.simulated) & (peaks["case"] == case.name)
        for name, value in case.columns.items():
            matches &= peaks[name] == value
        for run in peaks[matches].to_dict("records"):
            motion = motions[run["record"]].times(float(run["scale"]))
            estimates = {method: estimate(case.pier, motion, method) for method in DAMPING}
            rows.append(
                {name: run[name] for name in ("record", "case", *case.columns, "theta_max_over_alpha")} | estimates
            )
    return pd.DataFrame(rows)


if __name__ == "__main__":
    table = main(sys.argv[1])
    print(table.to_string(index=False, float_format="%.4f"))
    for method in DAMPING:
        over = (table[method] / table["theta_max_over_alpha"]).replace([0.0, np.inf], np.nan).median()
        print(f"{method}: {over:.2f} of the computed peak in the median")
