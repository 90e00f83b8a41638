"""The peak of every record on every foundation, of configs/near_fault.toml."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import rockbatch as rb

STUDY = Path(__file__).parents[2] / "configs" / "near_fault.toml"


def draw() -> Figure:
    peaks = rb.run(STUDY)
    sizes = peaks["p"].unique()
    figure = Figure(figsize=(8.0, 4.6), layout="constrained")
    for axes, p in zip(figure.subplots(1, len(sizes), sharey=True), sizes, strict=True):
        of_size = peaks[peaks["p"] == p]
        for marker, (case, rows) in zip("osD", of_size.groupby("case", sort=False), strict=True):
            stood = rows["theta_max_over_alpha"].where(rows["status"] == "ok")
            axes.plot(stood, rows["record"], marker, label=case, mfc="none")
        flew = of_size[of_size["flight_s"].notna()]
        axes.plot(np.zeros(len(flew)), flew["record"], "^", color="0.3", label="flight on some foundation")
        axes.set(xlabel="θ_max/α", title=f"p = {p:g} rad/s")
        axes.grid(alpha=0.3)
    figure.axes[0].invert_yaxis()
    figure.axes[0].set_ylabel("record")
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    return figure
