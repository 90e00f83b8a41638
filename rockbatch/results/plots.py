"""Distribution of peaks over a suite as a figure, for notebooks and papers; the report draws its own."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rockbatch.checks.suite import counts_as, simulated
from rockbatch.lazy import pd
from rockbatch.results.suite_statistics import NO_PEAK, distribution

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def plot_cdf(peaks: "pd.DataFrame", varied: Sequence[str], count: str) -> "Figure":
    """See :meth:`rockbatch.results.opened.Results.plot_cdf`, which hands over the rows of peaks.csv, the varied keys,
    and what counts as one record."""
    from rockbatch.simulation.plots import ShownFigure

    figure = ShownFigure(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.subplots()
    runs = simulated(peaks[peaks["case"] != ""])
    keys = [name for name in ("case", *varied, "scale") if name == "case" or runs[name].nunique() > 1]
    largest = float(runs["theta_max_over_alpha"].where(runs["status"] == "ok").max())
    right = 1.06 * largest if largest > 0 else 1.0
    for values, same in runs.groupby(keys, sort=False, dropna=False):
        theta, share = distribution(
            same["theta_max_over_alpha"].to_numpy(dtype=float),
            same["status"].to_list(),
            counts_as(same, count)[0].to_list(),
        )
        told = [_named(key, value) for key, value in zip(keys, values, strict=True) if value == value]
        reached = [0.0, *share, share[-1] if len(share) else 0.0]
        (drawn,) = axes.step([0.0, *theta, right], reached, where="post", linewidth=1.2, label=", ".join(told))
        if same["status"].isin(NO_PEAK).any():
            axes.plot(right, reached[-1], "x", color=drawn.get_color(), clip_on=False)
    axes.set(xlabel="θ$_{max}$/α", ylabel="share of the records that do not exceed it", xlim=(0, right), ylim=(0, 1.01))
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")
    return figure


def _named(key: str, value: object) -> str:
    """A key and its value in a legend; a case goes without the word."""
    if key == "case":
        return str(value)
    return f"{key} = {value:g}" if isinstance(value, float) else f"{key} = {value}"
