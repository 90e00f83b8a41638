"""The picture of the paper's Figs. 5 and 6: a column of histories per foundation, loops at its foot."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rockbatch.report.markup import Markup
from rockbatch.report.svg import ALARM, BAND, GRID, INK, SERIES, arrow, drawing, inline, thin
from rockbatch.response import Response
from rockbatch.structure import ElasticBase, RigidBase, YieldingBase

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ABREAST = 5  # columns of one figure
PIXELS = 240  # of one history, across
QUANTITIES = ("θ/α", "θ̇/(αp)", "E/M [J/kg]", "üg/g")


def groups(responses: Sequence[Response]) -> list[list[Response]]:
    """Responses that share a record and a pier, at most five foundations at a time, the rigid base first.

    The rigid response goes with every group as the line behind; alone, it is the column.
    """
    together: dict[tuple[object, ...], list[Response]] = {}
    for response in responses:
        together.setdefault((response.record, response.pier), []).append(response)
    found = []
    for same in together.values():
        rigid = [response for response in same if isinstance(response.base, RigidBase)][:1]
        springs = [response for response in same if not isinstance(response.base, RigidBase)]
        size = math.ceil(len(springs) / max(1, math.ceil(len(springs) / ABREAST)))
        parts = [springs[i : i + size] for i in range(0, len(springs), size)] if springs else [[]]
        found += [[*rigid, *part] for part in parts]
    return found


def draw(group: Sequence[Response], titles: Sequence[str], name: str) -> Markup:
    """Histories of one of :func:`groups` as SVG; ``titles`` go over the columns, one per response."""
    from matplotlib.figure import Figure

    behind = group[0] if isinstance(group[0].base, RigidBase) and len(group) > 1 else None
    shown = [pair for pair in zip(group, titles, strict=True) if pair[0] is not behind]
    count = len(shown)
    loops = any(isinstance(response.base, YieldingBase) for response, _ in shown)
    width = 10.0 if count > 2 else (6.5, 9.0)[count - 1]
    height = 6.0 + 2.0 * loops
    with drawing(name):
        figure = Figure(figsize=(width, height))
        margins = {"left": 0.65 / width, "right": 1 - 0.1 / width}
        foot = (0.45 + 2.05 * loops) / height
        histories = figure.add_gridspec(4, count, **margins, top=1 - 0.5 / height, bottom=foot, hspace=0.12, wspace=0.1)
        first: list[Axes] = []
        for column, (response, title) in enumerate(shown):
            for row, label in enumerate(QUANTITIES):
                axes = figure.add_subplot(histories[row, column], sharey=first[row] if column else None)
                if column == 0:
                    first.append(axes)
                    axes.set_ylabel(label)
                axes.grid()
                axes.axhline(0, color=GRID, linewidth=1)
                axes.tick_params(labelleft=column == 0, labelbottom=row == 3)
                axes.set_xlim(0, max(response.t[-1], behind.t[-1] if behind else 0))
                if row == 0:
                    axes.set_title(title, fontsize=8)
                    _contact_band(axes, response)
                if behind is not None and row < 3:
                    _curve(axes, behind, row, INK, 0.7)
                _curve(axes, response, row, INK if isinstance(response.base, RigidBase) else SERIES[0], 1.1)
                if row == 0 and response.status in ("overturned", "flight"):
                    marker = "X" if response.status == "overturned" else arrow()
                    end = response.theta[-1:] / response.pier.alpha
                    axes.plot(response.t[-1:], end, marker=marker, color=ALARM, markersize=7, clip_on=False)
            axes.set_xlabel("t [s]")
        if loops:
            _loops(figure, [response for response, _ in shown], margins, height)
        named = ", ".join(response.case for response, _ in shown)
        said = "Histories of rotation, velocity, energy and ground motion"
        return inline(figure, f"{said}: {group[0].record}, {named}")


def _curve(axes: "Axes", response: Response, row: int, colour: str, width: float) -> None:
    pier = response.pier
    ordinate = (
        response.theta / pier.alpha,
        response.omega / (pier.alpha * pier.p),
        response.energy,
        response.history["ag_h"].to_numpy(dtype=np.float64) / pier.gravity,
    )[row]
    axes.plot(*thin(response.t, ordinate, PIXELS), color=colour, linewidth=width)


def _contact_band(axes: "Axes", response: Response) -> None:
    """Rotations at which a weakly rocking pier keeps both supports: paper, eq. 10."""
    if isinstance(response.base, ElasticBase):
        pier = response.pier
        sine = (1 + pier.mu) / (pier.mu * response.base.beta**2 * math.sin(pier.alpha))
        limit = math.asin(min(sine, 1)) / pier.alpha
        axes.axhspan(-limit, limit, color=BAND, linewidth=0)


def _loops(figure: "Figure", responses: Sequence[Response], margins: dict[str, float], height: float) -> None:
    grid = figure.add_gridspec(1, len(responses), **margins, top=1.85 / height, bottom=0.45 / height, wspace=0.1)
    for column, response in enumerate(responses):
        cell = grid[0, column]
        if not isinstance(response.base, YieldingBase):
            axes = figure.add_subplot(cell)
            axes.axis("off")
            axes.text(0.5, 0.5, "springs do not yield", ha="center", va="center", transform=axes.transAxes)
            continue
        deflection = response.base.eta * response.pier.gravity / (response.base.beta * response.pier.p) ** 2
        halves = cell.subgridspec(1, 2, wspace=0.12)
        left = figure.add_subplot(halves[0])
        right = figure.add_subplot(halves[1], sharex=left, sharey=left)
        under_load: list[float] = []
        for axes, side in ((left, "left"), (right, "right")):
            v = response.history[f"v_{side}"].to_numpy(dtype=np.float64) / deflection
            z = response.z_left if side == "left" else response.z_right
            axes.plot(v, z, color=SERIES[0], linewidth=0.8)
            under_load += v[z < 0].tolist()
            axes.set_ylim(-1.08, 0.08)
            axes.set_yticks([-1, -0.5, 0])
            axes.grid()
            axes.locator_params(axis="x", nbins=2, steps=[1, 2, 5, 10])
            axes.tick_params(labelleft=column == 0 and side == "left")
            axes.text(0.95, 0.06, side[0].upper(), transform=axes.transAxes, weight="bold", ha="right")
            axes.set_xlabel("v/δy")
        # As in the paper, the axis ends where the spring lets go: a lifted pivot may be far above
        margin = 0.08 * (max(under_load) - min(under_load)) + 0.01
        left.set_xlim(min(under_load) - margin, max(under_load) + margin)
        if column == 0:
            left.set_ylabel("F/Fy")
