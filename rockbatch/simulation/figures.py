"""The figure of a run: the histories of the paper's Fig. 5, thinned to the resolution of the picture, and its loops."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rockbatch.common.figures.description import (
    Array,
    Axis,
    Figure,
    Look,
    Mark,
    Panel,
    Points,
    Polyline,
    Rule,
    Span,
    Words,
    sign_of,
    spanning,
    thin,
    without_repeats,
)
from rockbatch.pier import yield_deflection

Response = Any
"""A :class:`rockbatch.Response`, whose module imports this one."""

WIDTH = 224.0
HEIGHTS = (94.0, 60.0, 60.0, 60.0)
LOOPS = 78.0
QUANTITIES = ("θ/α", "θ̇/(αp)", "E/M [J/kg]", "ü_g/g")
SEPARATE = ("separation", "lift-off")
MOST_DEVICES = 3
"""Most dampers and tendons of a run whose loops are drawn."""
LOADED = 1e-3
"""Share of the largest force below which a spring is not loaded: that of Bouc-Wen tends to nothing as its pivot rises."""
OVER = 1.5
"""Rotation over α beyond which the picture of a pier that overturns ends."""


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
    springs, devices : tuple of Panel
        Force against deflection of both springs; force against elongation of the first dampers and tendons.
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
    springs: tuple[Panel, ...] = ()
    devices: tuple[Panel, ...] = ()


def reduced(response: Response, pixels: int = 200, most_devices: int | None = MOST_DEVICES) -> History:
    """Return the response thinned for drawing, ``pixels`` wide."""
    pier, t = response.pier, response.t
    theta = response.theta / pier.alpha
    ground = response.history["ag_h"].to_numpy(dtype=np.float64) / pier.gravity
    ordinates = (theta, response.omega / (pier.alpha * pier.p), response.energy, ground)
    worst = int(np.nanargmax(np.abs(theta)))
    grain = max(float(t[-1]), 1e-9) / pixels

    def times(*kinds: str) -> Array:
        moments = response.events["t"][response.events["kind"].isin(kinds)].to_numpy(dtype=np.float64)
        return np.unique(np.rint(moments / grain)) * grain

    return History(
        not response.base.on_springs,
        response.status,
        [thin(t, y, pixels) for y in ordinates],
        times("impact"),
        times(*SEPARATE),
        times("flight"),
        (float(t[worst]), float(theta[worst])),
        (float(t[-1]), float(theta[-1])),
        _band(response),
        _springs(response, pixels),
        tuple(_device(response, name, pixels) for name in _devices(response)[:most_devices]),
    )


def history(own: History, behind: History | None, shown: Sequence[History], record: str, title: str = "") -> Figure:
    """Return the figure of a history, with another one ``behind`` it, on scales that hold all that are ``shown``."""
    end = max(own.end[0], behind.end[0] if behind else 0.0) or 1.0
    panels = []
    for row, height in enumerate(HEIGHTS):
        y = _scale(shown, row) if own.status == "ok" else spanning(QUANTITIES[row], _standing(own, row))
        last = row == len(HEIGHTS) - 1
        x = Axis("t [s]" if last else "", 0.0, end, about=4, numbered=last)
        name = y.plain
        marks: list[Mark] = [Polyline(*own.curves[row], name, look=Look("curve", 0 if own.rigid else 1))]
        if behind is not None and row < 3:
            marks.insert(0, Polyline(*behind.curves[row], f"{name}, rigid base", look=Look("behind")))
        if row == 0:
            marks += _events(own, y, end)
        panels.append(Panel(x, replace(y, about=5 if row == 0 else 4), marks, width=WIDTH, height=height, reads="time"))
    description = f"Rotation, velocity, energy and ground acceleration against time under {record}"
    return Figure([*panels, *own.springs, *own.devices], description, title, stacked=True)


def of_one(response: Response, title: str) -> Figure:
    """Return the figure of a response alone, as fine as it is printed."""
    own = reduced(response, 2000, None)
    return history(own, None, [own], response.record, title)


def _scale(histories: Sequence[History], row: int) -> Axis:
    """Return one scale for all columns, not stretched by piers that overturned."""
    stood = [one for one in histories if one.status == "ok"] or histories
    bands = [np.array([-one.band, one.band]) for one in stood] if row == 0 else []
    margin = 0.15 if row == 0 else 0.06  # strokes of events stand beyond the curve
    return spanning(QUANTITIES[row], *(one.curves[row][1] for one in stood), *bands, margin=margin)


def _standing(one: History, row: int) -> Array:
    """Return a quantity until the pier overturns, since later values would hide how it rocked."""
    t, theta = one.curves[0]
    beyond = np.flatnonzero(np.abs(theta) > OVER)
    times, values = one.curves[row]
    return values[times <= t[beyond[0]]] if len(beyond) else values


def _events(one: History, y: Axis, end: float) -> Iterator[Mark]:
    """Yield impacts at the foot, separations at the top, flights across, the peak with its value, and the end of the run."""
    if one.band:
        yield Span("y", max(-one.band, y.low), min(one.band, y.high), look=Look("band"), label="both supports loaded")
    kinds = (one.impacts, 0.0, 0.05, "event", "impact"), (one.separations, 0.95, 1.0, "event", "separation")
    for times, low, high, kind, label in (*kinds, (one.flights, 0.0, 1.0, "flown", "both pivots off the ground")):
        if len(times):
            yield Rule("x", times, low, high, look=Look(kind), label=label)
    peak = one.peak[0], float(np.clip(one.peak[1], y.low, y.high))
    if one.status == "ok" and one.peak[1] != 0:
        yield Points(np.full(1, peak[0]), np.full(1, peak[1]), look=Look("peak", shape="dot"))
        yield Words(*peak, f"{abs(one.peak[1]):.4f}", -1 if peak[0] > 0.75 * end else 1, look=Look("peak"))
    if one.status in ("overturned", "flight"):
        last = one.end[0], float(np.clip(one.end[1], y.low, y.high))
        yield Points(np.full(1, last[0]), np.full(1, last[1]), look=sign_of(one.status), label=one.status)


def _band(response: Response) -> float:
    base, pier = response.base, response.pier
    sine = (1 + pier.mu) / (pier.mu * base.beta**2 * math.sin(pier.alpha))
    return math.asin(min(sine, 1)) / pier.alpha


def _springs(response: Response, pixels: int) -> tuple[Panel, ...]:
    """Return force against deflection of both springs, while they are loaded: over those at yield if they can yield."""
    base, pier, sides = response.base, response.pier, ("left", "right")
    if not base.on_springs:
        return ()
    names = ("v/δ_y", "F/F_y") if base.yields else ("v [mm]", "F/(M g)")
    unit = yield_deflection(pier, base) if base.yields else 1e-3
    forces = [response.z_left, response.z_right] if base.yields else [
        response.history[f"force_{side}"].to_numpy(dtype=np.float64) / pier.gravity for side in sides
    ]  # fmt: skip
    least = LOADED * max(float(np.abs(force).max(initial=0.0)) for force in forces)
    forces = [np.where(force < -least, force, np.nan) for force in forces]
    v = [response.history[f"v_{side}"].to_numpy(dtype=np.float64) / unit for side in sides]
    # As in the paper, the axis ends where the spring unloads: a lifted pivot may be far above
    loaded = np.concatenate([own[~np.isnan(force)] for own, force in zip(v, forces, strict=True)])
    low, high = (float(loaded.min()), float(loaded.max())) if len(loaded) else (-1.0, 0.0)
    margin = 0.08 * (high - low) + 0.01
    x = Axis(names[0], low - margin, high + margin, about=3)
    y = Axis(names[1], -1.08, 0.1, about=3) if base.yields else spanning(names[1], *forces, about=3)
    yields = Rule("y", -np.ones(1), look=Look("edge", dash=1), label="force at which a support yields")
    panels = []
    for side, own, force in zip(sides, v, forces, strict=True):
        marks: list[Mark] = [Polyline(*without_repeats(own, force, pixels), y.plain, look=Look("curve", 1))]
        scale = replace(y, numbered=side == "left")
        panels.append(
            Panel(x, scale, marks + [yields] * base.yields, side, width=WIDTH / 2, height=LOOPS, reads="plane")
        )
    return tuple(panels)


def _devices(response: Response) -> list[str]:
    """Return the names of dampers and tendons; a pair at both pivots counts as one."""
    columns = () if response.restraints is None else response.restraints
    names = (str(name).removesuffix(" force") for name in columns if str(name).endswith(" force"))
    return list(dict.fromkeys(name.removesuffix(" left").removesuffix(" right") for name in names))


def _device(response: Response, name: str, pixels: int) -> Panel:
    """Return force against elongation [mm] of a device, in kN if the mass is known; of a pair, the right one behind."""
    table, pier = response.restraints, response.pier
    assert table is not None
    sides = [side for side in (" right", " left", "") if f"{name}{side} force" in table]
    factor, unit = (1.0 / pier.gravity, "F/(M g)") if pier.mass_t is None else (pier.mass_t, "F [kN]")
    elongations = [1000.0 * table[f"{name}{side} elongation"].to_numpy(dtype=np.float64) for side in sides]
    forces = [factor * table[f"{name}{side} force"].to_numpy(dtype=np.float64) for side in sides]
    marks = [
        Polyline(*without_repeats(u, force, pixels), f"{unit}{side}", look=Look("right" if side == " right" else "curve", 1),
             label=f"at the{side} pivot" if side else "")
        for side, u, force in zip(sides, elongations, forces, strict=True)
    ]  # fmt: skip
    axes = spanning("elongation [mm]", *elongations, about=4), spanning(unit, *forces)
    return Panel(*axes, marks, name, width=WIDTH, height=LOOPS, reads="plane")
