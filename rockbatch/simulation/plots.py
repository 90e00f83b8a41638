"""The figure of a run. Loads matplotlib: imported where it is drawn."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure

from rockbatch.common.figures import COLOURS, figure, line, styled
from rockbatch.pier import Base, Pier, YieldingBase

if TYPE_CHECKING:
    import pandas as pd

_ROWS_MM, _LOOPS_MM = 30.0, 48.0
_NARROW_MM = 120.0  # below it the loops stand below each other


@styled
def plot(
    tables: tuple["pd.DataFrame", "pd.DataFrame", "pd.DataFrame | None"],
    pier: Pier,
    base: Base,
    title: str,
    width_mm: float,
) -> Figure:
    """See :meth:`rockbatch.Response.plot`, which hands over its history, events and devices."""
    history, events, devices = tables
    loops = {loop[0]: loop for loop in (*_supports(history, base), *_devices(devices))}
    times = ["rotation", "velocity", "energy", "ground"]
    columns = 2 if width_mm >= _NARROW_MM else 1
    rows = [list(loops)[i : i + columns] for i in range(0, len(loops), columns)]
    mosaic: list[Any] = [[name] * columns for name in times] + [row + ["."] * (columns - len(row)) for row in rows]
    drawn = figure(width_mm, _ROWS_MM * len(times) + _LOOPS_MM * len(rows) + 8.0)
    axes = drawn.subplot_mosaic(mosaic, height_ratios=[_ROWS_MM] * len(times) + [_LOOPS_MM] * len(rows))
    thin = {"color": COLOURS[0], "linewidth": 0.7}
    t = history["t"].to_numpy()
    for name, values, label in (
        ("rotation", history["theta"] / pier.alpha, r"$\theta/\alpha$"),
        ("velocity", history["omega"] / (pier.alpha * pier.p), r"$\dot\theta/(\alpha p)$"),
        ("energy", history["energy"], "energy [J/kg]"),
        ("ground", history["ag_h"] / pier.gravity, r"$\ddot u_g/g$"),
    ):
        axes[name].plot(t, values, **thin)
        axes[name].set(ylabel=label, xlim=(t[0], t[-1]))
        if name != "rotation":
            axes[name].sharex(axes["rotation"])
        axes[name].tick_params(labelbottom=name == "ground")
    for impact in events["t"][events["kind"] == "impact"]:
        axes["rotation"].axvline(impact, ymax=0.04, color="0.4", linewidth=0.6)
    axes["ground"].set_xlabel("time [s]")
    for name, label, deflection, force in loops.values():
        axes[name].plot(1000.0 * deflection, force / pier.gravity, **thin)
        axes[name].set(xlabel=label, ylabel=r"$F/(Mg)$", title=name)
        if name in _SUPPORTS and isinstance(base, YieldingBase):
            axes[name].axhline(-0.5 * base.eta, label=r"$-F_y$", **line(1) | {"linewidth": 0.8})
            axes[name].legend(loc="upper left")
    drawn.suptitle(title)
    return drawn


_SUPPORTS = {"left support": "left", "right support": "right"}
_Loop = tuple[str, str, "pd.Series[float]", "pd.Series[float]"]


def _supports(history: "pd.DataFrame", base: Base) -> Iterator[_Loop]:
    """Yield name, axis, deflection [m] and force [N/kg] of both supports, while they are loaded."""
    for name, side in _SUPPORTS.items() if base.on_springs else ():
        force = history[f"force_{side}"]
        yield (
            name,
            r"$v$ of the pivot [mm]",
            history[f"v_{side}"].where(force < 0, math.nan),
            force.where(force < 0, math.nan),
        )


def _devices(devices: "pd.DataFrame | None") -> Iterator[_Loop]:
    """Yield name, axis, elongation [m] and force [N/kg] of dampers and tendons."""
    for column in [] if devices is None else map(str, devices):
        name = column.removesuffix(" force")
        if name != column and devices is not None:
            yield name, "elongation [mm]", devices[f"{name} elongation"], devices[column]
