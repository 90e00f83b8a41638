"""The worst drift of two designs under each of their bounds."""

from pathlib import Path

from matplotlib.figure import Figure

import rockbatch as rb

STUDY = rb.load_study(Path(__file__).parents[2] / "configs" / "pier_with_bounds.toml")


def draw() -> Figure:
    peaks = rb.run(STUDY, progress=False)
    names = ["", *(bound.name for bound in STUDY.bounds)]
    figure = Figure(figsize=(8.0, 3.0), layout="constrained")
    axes = figure.subplots()
    for marker, (case, of_case) in zip("os", peaks.groupby("case", sort=False), strict=True):
        worst = of_case.groupby("bound")["top_drift_m"].max().loc[names]
        axes.plot(worst, range(len(names)), marker, label=case)
    limit = next(check.limit for check in STUDY.checks if check.demand == "top_drift_m")
    axes.axvline(limit, color="tab:red", lw=1.0, label="limit")
    axes.set_yticks(range(len(names)), ["nominal", *names[1:]])
    axes.invert_yaxis()
    axes.legend(frameon=False)
    axes.set(xlabel="worst drift of five records [m]", ylabel="bound", xlim=(0, None))
    return figure
