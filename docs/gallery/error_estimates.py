"""True errors against reported ones, of every row of benchmarks/error_estimates.csv."""

from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

ROWS = Path(__file__).parents[2] / "benchmarks" / "error_estimates.csv"


def draw() -> Figure:
    rows = pd.read_csv(ROWS)
    figure = Figure(figsize=(8.0, 4.2), layout="constrained")
    for axes, quantity, title in zip(
        figure.subplots(1, 2, sharex=True, sharey=True),
        ("theta_max", "theta_res"),
        (r"$\theta_{\max}/\alpha$", r"$\theta_{res}/\alpha$"),
        strict=True,
    ):
        for i, (base, of_base) in enumerate(rows.groupby("base", sort=False)):
            complete = of_base.dropna(subset=[f"{quantity}_reported", f"{quantity}_true"])
            if len(complete):
                reported, true = complete[f"{quantity}_reported"], complete[f"{quantity}_true"].clip(lower=1e-13)
                axes.loglog(reported, true, "osD^v"[i], color=f"C{i}", label=base, mfc="none", ms=4, mew=0.7)
        axes.axline((1e-12, 1e-12), (1e-4, 1e-4), color="k", lw=0.8)
        axes.set(title=title, xlabel="reported error", xlim=(5e-13, 2e-4), ylim=(5e-14, 2e-4))
        axes.grid(alpha=0.3)
    figure.axes[0].set_ylabel("true error")
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure
