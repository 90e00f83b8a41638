"""Demand over limit of two designs, check by check, under the bounds of each."""

from pathlib import Path
from tempfile import TemporaryDirectory

from matplotlib.figure import Figure

import rockbatch as rb
from rockbatch.reporting import Report

STUDY = rb.load_study(Path(__file__).parents[2] / "configs" / "pier_with_bounds.toml")
GROUND = ["soft ground", "stiff ground"]


def compared(folder: Path) -> Report:
    """Run the design with dampers and that without into a folder, and compare them."""
    for side, case in (("with", "dampers"), ("without", "no dampers")):
        rb.run(STUDY.with_(case=case, bound=GROUND), folder / side, progress=False)
    return rb.report(folder / "with", folder / "without")


def draw() -> Figure:
    with TemporaryDirectory() as folder:
        checks = compared(Path(folder)).checks
    figure = Figure(figsize=(8.0, 2.6), layout="constrained")
    axes = figure.subplots()
    names = list(dict.fromkeys(checks["check"]))
    for marker, (side, of_study) in zip("os", checks.groupby("study"), strict=True):
        places = [names.index(name) + (0.12 if side == "B" else -0.12) for name in of_study["check"]]
        axes.plot(100 * of_study["ratio"], places, marker, label=f"{side}: {of_study['case'].iloc[0]}")
    axes.axvline(100, color="tab:red", lw=1.0, label="limit")
    axes.set_yticks(range(len(names)), names)
    axes.set(
        xlabel="demand over limit, nominal and under each bound [%]", ylabel="check", xlim=(0, None), ylim=(1.5, -0.5)
    )
    axes.legend(frameon=False)
    return figure
