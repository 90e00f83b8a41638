"""The same pier under the same record on three foundations."""

from pathlib import Path

from matplotlib.figure import Figure

import rockbatch as rb

RECORDS = Path(__file__).parents[2] / "motions" / "near_fault" / "imperialvalley1979_meloland"
PIER = rb.Pier(alpha=0.13, p=0.76)
FOUNDATIONS = {
    "rigid": rb.RigidBase(),
    "stiff, strong (β = 80, η = 3.5)": rb.YieldingBase(beta=80, eta=3.5, spring="epp", zeta=0.05),
    "soft, weak (β = 40, η = 2.5)": rb.YieldingBase(beta=40, eta=2.5, spring="epp", zeta=0.05),
}


def draw() -> Figure:
    motion = rb.read_motions(RECORDS).motions[0]
    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    above, below = figure.subplots(2, sharex=True, height_ratios=(3, 1))
    for name, base in FOUNDATIONS.items():
        history = rb.simulate(PIER, base, motion).history
        above.plot(history["t"], history["theta"] / PIER.alpha, lw=1.1, label=name)
    below.plot(history["t"], history["ag_h"] / PIER.gravity, lw=0.8, color="0.4")
    above.legend(frameon=False)
    above.set(ylabel=r"$\theta/\alpha$", title="Meloland, Imperial Valley 1979; p = 0.76 rad/s", xlim=(0, 30))
    below.set(xlabel="t [s]", ylabel=r"$\ddot u_g/g$")
    return figure
