"""Figures that notebooks show as they are, and that of a run. Loads matplotlib: imported where one is drawn."""

import math
from io import BytesIO
from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure

from rockbatch.pier import Base, Pier

if TYPE_CHECKING:
    import pandas as pd


class ShownFigure(Figure):
    """A matplotlib Figure that is not pyplot's, and shows itself in a notebook nevertheless, also without ``%matplotlib``."""

    def _repr_png_(self) -> bytes:
        picture = BytesIO()
        self.savefig(picture, format="png")
        return picture.getvalue()


def plot(history: "pd.DataFrame", events: "pd.DataFrame", pier: Pier, base: Base, title: str) -> Figure:
    """See :meth:`rockbatch.Response.plot`, which hands over its tables ``history`` and ``events``."""
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
