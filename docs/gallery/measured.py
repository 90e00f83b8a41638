"""Shares of shake-table tests that overturn, and of those that the block predicts, of benchmarks/measured.csv."""

from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

ROWS = Path(__file__).parents[2] / "benchmarks" / "measured.csv"
MEASURES = {"pgv_m_s": ("PGV [m/s]", (0.02, 0.05, 0.1, 0.2, 0.4)), "pga_g": ("PGA [g]", (0.05, 0.1, 0.2, 0.5, 1.0))}


def draw() -> Figure:
    rows = pd.read_csv(ROWS)
    figure = Figure(figsize=(8.0, 5.4), layout="constrained")
    for line, (specimen, of_specimen) in zip(
        figure.subplots(2, 2, sharex="col", sharey=True), rows.groupby("specimen"), strict=True
    ):
        for axes, (measure, (words, ticks)) in zip(line, MEASURES.items(), strict=True):
            bins = of_specimen[of_specimen["measure"] == measure]
            middle = (bins["from"] * bins["to"]) ** 0.5
            outside = [bins["observed"] - bins["low"], bins["high"] - bins["observed"]]
            axes.errorbar(middle, bins["observed"], outside, fmt="ok", ms=4, lw=0.8, capsize=2, label="observed, 95 %")
            axes.plot(middle, bins["block"], "s-", color="C0", mfc="none", ms=4, lw=1.0, label="block, unseen tests")
            axes.set(xscale="log", ylim=(-0.05, 1.05))
            axes.minorticks_off()
            axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
            axes.grid(alpha=0.3)
            if specimen == 2:
                axes.set_xlabel(words)
        line[0].set_ylabel(f"overturned, specimen {specimen}")
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    return figure
