"""Pictures with matplotlib, for notebooks and papers; the report draws its own.

The column of Palmeri & Makris (2007), Fig. 5, and the distribution of peaks over a suite.
"""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rockbatch.checks.suite import counts_as, simulated
from rockbatch.lazy import pd
from rockbatch.pier import Base, Pier
from rockbatch.results.suite_statistics import NO_PEAK, distribution

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def plot(history: "pd.DataFrame", events: "pd.DataFrame", pier: Pier, base: Base, title: str) -> "Figure":
    """See :meth:`rockbatch.Response.plot`, which hands over its tables ``history`` and ``events``."""
    from rockbatch.results.figure import ShownFigure

    loops = base.on_springs
    figure = ShownFigure(figsize=(7.0, 9.0 if loops else 7.0), layout="constrained")
    names: list[Any] = [["rotation"] * 2, ["velocity"] * 2, ["energy"] * 2, ["ground"] * 2]
    axes = figure.subplot_mosaic([*names, ["left", "right"]] if loops else names)
    t = history["t"].to_numpy()
    for name, values, label in (
        ("rotation", history["theta"] / pier.alpha, "θ/α"),
        ("velocity", history["omega"] / (pier.alpha * pier.p), "θ̇/(αp)"),
        ("energy", history["energy"], "E [J/kg]"),
        ("ground", history["ag_h"] / pier.gravity, "üg/g"),
    ):
        axes[name].plot(t, values, linewidth=0.9)
        axes[name].set(ylabel=label, xlim=(t[0], t[-1]))
        axes[name].grid(alpha=0.3)
        if name != "rotation":
            axes[name].sharex(axes["rotation"])
    for impact in events["t"][events["kind"] == "impact"]:
        axes["rotation"].axvline(impact, ymax=0.04, color="gray", linewidth=0.7)
    axes["ground"].set_xlabel("t [s]")
    if loops:
        for side in ("left", "right"):
            force, position = history[f"force_{side}"] / pier.gravity, history[f"v_{side}"]
            loaded = force < 0
            axes[side].plot(1000 * position.where(loaded, math.nan), force.where(loaded, math.nan), linewidth=0.8)
            axes[side].set(xlabel=f"v of the {side} pivot [mm]", ylabel="F/(Mg)")
            axes[side].grid(alpha=0.3)
    figure.suptitle(title)
    return figure


def plot_cdf(peaks: "pd.DataFrame", varied: Sequence[str], count: str) -> "Figure":
    """See :meth:`rockbatch.results.opened.Results.plot_cdf`, which hands over the rows of peaks.csv, the varied keys,
    and what counts as one record."""
    from rockbatch.results.figure import ShownFigure

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
