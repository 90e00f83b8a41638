"""One run in miniature: the curves of the paper's Fig. 5 thinned to the resolution of the picture, and its loops."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from rockbatch.pier import yield_deflection
from rockbatch.report.drawing.axes import Axes, Scale, spanning
from rockbatch.report.drawing.svg import Array, curve, lowered, text, thin
from rockbatch.report.markup import Markup, join
from rockbatch.simulation.response import Response

PIXELS = 200  # width of one history
QUANTITIES = ("θ/α", "θ̇/(αp)", "E/M [J/kg]", "üg/g")
SEPARATE = ("separation", "lift-off")
LOOPS_HEIGHT = 128.0  # px
MOST_DEVICES = 3
"""Most dampers and tendons of a run whose loops are drawn."""


@dataclass(frozen=True, eq=False)
class History:
    """The drawn parts of a :class:`Response`, without the response itself, since many are in memory at once.

    Attributes
    ----------
    curves : list
        Abscissae [s] and ordinates of each of :data:`QUANTITIES`, with every extremum that a pixel can show.
    impacts, separations, flights : ndarray
        Times of the events [s]; of impacts and separations only those that can be distinguished.
    peak : tuple of float
        Time and θ/α of the largest rotation.
    end : tuple of float
        Time and θ/α at the end.
    band : float
        |θ/α| up to which a weakly rocking pier keeps both supports: THEORY.md, eq. 10. Zero on the rigid base.
    loops : Markup
        Force against deflection of both springs if they can yield; else empty.
    devices : tuple of Markup
        Force against elongation of the first dampers and tendons, a picture of :data:`LOOPS_HEIGHT` each.
    """

    rigid: bool
    status: str
    curves: list[tuple[Array, Array]]
    impacts: Array
    separations: Array
    flights: Array
    peak: tuple[float, float]
    end: tuple[float, float]
    band: float
    loops: Markup
    devices: tuple[Markup, ...] = ()


def reduced(response: Response, left: float, width: float) -> History:
    """Return the response thinned for drawing; ``left`` and ``width`` [px] are the place of its loops."""
    pier, t = response.pier, response.t
    theta = response.theta / pier.alpha
    ground = response.history["ag_h"].to_numpy(dtype=np.float64) / pier.gravity
    ordinates = (theta, response.omega / (pier.alpha * pier.p), response.energy, ground)
    worst = int(np.nanargmax(np.abs(theta)))
    grain = max(float(t[-1]), 1e-9) / PIXELS

    def times(*kinds: str) -> Array:
        moments = response.events["t"][response.events["kind"].isin(kinds)].to_numpy(dtype=np.float64)
        return np.unique(np.rint(moments / grain)) * grain

    return History(
        not response.base.on_springs,
        response.status,
        [thin(t, y, PIXELS) for y in ordinates],
        times("impact"),
        times(*SEPARATE),
        times("flight"),
        (float(t[worst]), float(theta[worst])),
        (float(t[-1]), float(theta[-1])),
        _band(response),
        _loops(response, left, width) if response.base.yields else Markup(""),
        tuple(_device(response, name, left, width) for name in _devices(response)[:MOST_DEVICES]),
    )


def _devices(response: Response) -> list[str]:
    """Return the names of dampers and tendons; a pair at both pivots counts as one."""
    columns = () if response.restraints is None else response.restraints
    names = (str(name).removesuffix(" force") for name in columns if str(name).endswith(" force"))
    return list(dict.fromkeys(name.removesuffix(" left").removesuffix(" right") for name in names))


def _band(response: Response) -> float:
    base, pier = response.base, response.pier
    sine = (1 + pier.mu) / (pier.mu * base.beta**2 * math.sin(pier.alpha))
    return math.asin(min(sine, 1)) / pier.alpha


def _loops(response: Response, left: float, width: float) -> Markup:
    """Draw F/F_y against v/δ_y of the left and the right spring, side by side on one scale."""
    base: Any = response.base
    deflection = yield_deflection(response.pier, base)
    springs = [
        (response.history[f"v_{side}"].to_numpy(dtype=np.float64) / deflection, force)
        for side, force in (("left", response.z_left), ("right", response.z_right))
    ]
    # As in the paper, the axis ends where the spring unloads: a lifted pivot may be far above
    loaded = np.concatenate([v[z < 0] for v, z in springs])
    low, high = (float(loaded.min()), float(loaded.max())) if len(loaded) else (-1.0, 0.0)
    margin = 0.08 * (high - low) + 0.01
    across, down = Scale(low - margin, high + margin), Scale(-1.08, 0.1)
    gap = 10.0
    panel = (width - gap) / 2
    drawn = []
    for place, (v, z) in enumerate(springs):
        axes = Axes(left + place * (panel + gap), 17, panel, LOOPS_HEIGHT - 50, across, down)
        line = curve(axes.across(np.clip(v, across.low, across.high)), axes.down(z), "curve", "F/Fy")
        frame = axes.frame(across.ticks(2), [-1, -0.5, 0], y_numbers=place == 0)
        name = text(axes.left + 4, axes.top + axes.height - 5, "LR"[place], class_="q")
        drawn += [frame, axes.readable("plane", line, names="v/δy|F/Fy"), name]
        drawn.append(text(axes.left + panel / 2, LOOPS_HEIGHT - 3, lowered("v/δ", "y"), class_="m q"))
    drawn.append(text(left - 2, 11, lowered("F/F", "y"), class_="q"))
    return join(*drawn)


def _device(response: Response, name: str, left: float, width: float) -> Markup:
    """Draw force against elongation [mm] of a device, in kN if the mass is known; of a pair, the right one behind."""
    table, pier = response.restraints, response.pier
    assert table is not None
    sides = [side for side in (" right", " left", "") if f"{name}{side} force" in table]
    factor, unit = (1.0 / pier.gravity, "F/(M g)") if pier.mass_t is None else (pier.mass_t, "F [kN]")
    elongations = [1000.0 * table[f"{name}{side} elongation"].to_numpy(dtype=np.float64) for side in sides]
    forces = [factor * table[f"{name}{side} force"].to_numpy(dtype=np.float64) for side in sides]
    axes = Axes(left, 17, width, LOOPS_HEIGHT - 50, spanning(*elongations), spanning(*forces))
    lines = [
        curve(axes.across(u), axes.down(force), "curve" if side != " right" else "curve right", f"{unit}{side}")
        for side, u, force in zip(sides, elongations, forces, strict=True)
    ]
    return join(
        axes.frame(axes.x.ticks(4), axes.y.ticks(5)),
        axes.readable("plane", *lines, names=f"elongation [mm]|{unit}"),
        text(left - 2, 11, unit, class_="q"),
        text(left + width, 11, name, class_="e"),
        text(left + width / 2, LOOPS_HEIGHT - 3, "elongation [mm]", class_="m q"),
    )
