"""The column of Palmeri & Makris (2007), Fig. 5, with matplotlib: for notebooks and papers. The report draws its own."""

import math
from typing import TYPE_CHECKING, Any

from rockbatch.structure import RigidBase

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rockbatch.response import Response


def plot(response: "Response") -> "Figure":
    """See :meth:`rockbatch.Response.plot`."""
    from matplotlib.figure import Figure

    pier, history = response.pier, response.history
    loops = not isinstance(response.base, RigidBase)
    figure = Figure(figsize=(7.0, 9.0 if loops else 7.0), layout="constrained")
    names: list[Any] = [["rotation"] * 2, ["velocity"] * 2, ["energy"] * 2, ["ground"] * 2]
    axes = figure.subplot_mosaic([*names, ["left", "right"]] if loops else names)
    t = response.t
    for name, values, label in (
        ("rotation", response.theta / pier.alpha, "θ/α"),
        ("velocity", response.omega / (pier.alpha * pier.p), "θ̇/(αp)"),
        ("energy", response.energy, "E [J/kg]"),
        ("ground", history["ag_h"] / pier.gravity, "üg/g"),
    ):
        axes[name].plot(t, values, linewidth=0.9)
        axes[name].set(ylabel=label, xlim=(t[0], t[-1]))
        axes[name].grid(alpha=0.3)
        if name != "rotation":
            axes[name].sharex(axes["rotation"])
    for impact in response.events["t"][response.events["kind"] == "impact"]:
        axes["rotation"].axvline(impact, ymax=0.04, color="gray", linewidth=0.7)
    axes["ground"].set_xlabel("t [s]")
    if loops:
        for side in ("left", "right"):
            force, position = history[f"force_{side}"] / pier.gravity, history[f"v_{side}"]
            loaded = force < 0
            axes[side].plot(1000 * position.where(loaded, math.nan), force.where(loaded, math.nan), linewidth=0.8)
            axes[side].set(xlabel=f"v of the {side} pivot [mm]", ylabel="F/(Mg)")
            axes[side].grid(alpha=0.3)
    sign = f", polarity {response.polarity}" if response.polarity != "+" else ""
    figure.suptitle(f"{response.record} × {response.scale:g}{sign}, {response.case}: {response.status}")
    return figure
