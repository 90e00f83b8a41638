"""The figure of a run. Loads matplotlib: imported where it is drawn."""

import math
from typing import TYPE_CHECKING, Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockbatch.figures import COLOURS, figure, line, styled
from rockbatch.pier import YieldingBase

if TYPE_CHECKING:
    from rockbatch.simulation.response import Response

_ROWS_MM, _LOOPS_MM = 30.0, 48.0
_NARROW_MM = 120.0  # below it the loops stand below each other


@styled
def plot(response: "Response", title: str, width_mm: float) -> Figure:
    """See :meth:`rockbatch.Response.plot`."""
    history, pier, base = response.history, response.pier, response.base
    devices = (
        []
        if response.restraints is None
        else [name[:-6] for name in map(str, response.restraints) if name.endswith(" force")]
    )
    loops = (["left", "right"] if base.on_springs else []) + devices
    times = ["rotation", "velocity", "energy", "ground"]
    columns = 2 if width_mm >= _NARROW_MM else 1
    rows = [loops[i : i + columns] for i in range(0, len(loops), columns)]
    mosaic: list[Any] = [[name] * columns for name in times] + [row + ["."] * (columns - len(row)) for row in rows]
    drawn = figure(width_mm, _ROWS_MM * len(times) + _LOOPS_MM * len(rows) + 8.0)
    axes = drawn.subplot_mosaic(mosaic, height_ratios=[_ROWS_MM] * len(times) + [_LOOPS_MM] * len(rows))
    t = history["t"].to_numpy()
    for name, values, label in (
        ("rotation", history["theta"] / pier.alpha, r"$\theta/\alpha$"),
        ("velocity", history["omega"] / (pier.alpha * pier.p), r"$\dot\theta/(\alpha p)$"),
        ("energy", history["energy"], "energy [J/kg]"),
        ("ground", history["ag_h"] / pier.gravity, r"$\ddot u_g/g$"),
    ):
        axes[name].plot(t, values, color=COLOURS[0], linewidth=0.7)
        axes[name].set(ylabel=label, xlim=(t[0], t[-1]))
        if name != "rotation":
            axes[name].sharex(axes["rotation"])
        axes[name].tick_params(labelbottom=name == "ground")
    for impact in response.events["t"][response.events["kind"] == "impact"]:
        axes["rotation"].axvline(impact, ymax=0.04, color="0.4", linewidth=0.6)
    axes["ground"].set_xlabel("time [s]")
    for side in loops[: 2 * base.on_springs]:
        _support(axes[side], side, response)
    for name in devices:
        assert response.restraints is not None
        extension, force = response.restraints[f"{name} elongation"], response.restraints[f"{name} force"]
        axes[name].plot(1000.0 * extension, force / pier.gravity, color=COLOURS[0], linewidth=0.7)
        axes[name].set(xlabel="elongation [mm]", ylabel=r"$F/(Mg)$", title=name)
    drawn.suptitle(title)
    return drawn


def _support(axes: Axes, side: str, response: "Response") -> None:
    """Draw the force of a support over its deflection, while loaded, and its yield force."""
    force = response.history[f"force_{side}"] / response.pier.gravity
    loaded = force < 0
    position = 1000.0 * response.history[f"v_{side}"].where(loaded, math.nan)
    axes.plot(position, force.where(loaded, math.nan), color=COLOURS[0], linewidth=0.7)
    if isinstance(response.base, YieldingBase):
        axes.axhline(-0.5 * response.base.eta, **line(1), linewidth=0.8, label=r"$-F_y$")
        axes.legend(loc="upper left")
    axes.set(xlabel=r"$v$ of the pivot [mm]", ylabel=r"$F/(Mg)$", title=f"{side} support")
