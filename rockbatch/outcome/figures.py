"""Figures of runs: histories as in the paper's Fig. 5, thinned to the resolution of the figure, and loops."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from rockbatch.common.errors import InputError
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
from rockbatch.common.statuses import Status
from rockbatch.pier import device_names, yield_deflection

Response = Any
"""A :class:`rockbatch.Response`, whose module imports this one."""

QUANTITIES = ("θ/α", "θ̇/(αp)", "E/M [J/kg]", "ü_g/g")
GROUND = 3
"""Index of the ground acceleration in :data:`QUANTITIES`: it is the same for all piers."""
HEIGHTS = (94.0, 60.0, 60.0, 60.0)
WIDTH = 320.0
"""Width of the figure of one run [px]; loops are half as wide."""
LOOPS = 112.0
ON_PAGE = {0: 200.0, 1: 110.0, GROUND: 90.0}
"""Indices of the quantities of :func:`together`, with the heights of their panels [px]."""
ACROSS = 900.0
"""Width of :func:`together` [px]."""
SEPARATE = ("separation", "lift-off")
MOST_DEVICES = 3
"""Greatest number of devices of a run whose loops are drawn."""
MOST_LANES = 4
"""Greatest number of piers whose events are drawn together, each in its own lane."""
LOADED = 1e-3
"""Share of the largest force up to which a spring counts as unloaded."""
OVER = 1.5
"""Rotation over α at which the curve of an overturning pier is cut."""
MOVES = 0.02
"""Share of the largest rotation, or of α if that is smaller, above which a pier counts as moving."""
CUT = 0.9
"""Share of the record from which on it is drawn whole, instead of the stretch in which piers move."""


@dataclass(frozen=True, eq=False)
class History:
    """The curves and events of a :class:`Response` that are drawn, thinned, since many are in memory at once."""

    status: Status
    # abscissae [s] and ordinates of each of :data:`QUANTITIES`, with every extremum that a pixel resolves
    curves: list[tuple[Array, Array]]
    # times of the events [s], rounded to a pixel; events of a kind in the same pixel appear once
    impacts: Array
    separations: Array
    flights: Array
    peak: tuple[float, float]  # time and θ/α, with its sign, of the largest |θ|
    end: tuple[float, float]  # time and θ/α at the end
    # times [s] at which θ/α is first beyond :data:`MOVES` from 0, and last from its final value
    moving: tuple[float, float]
    # |θ/α| up to which both supports of a weakly rocking pier stay loaded (THEORY.md, eq. 10); 0 on the rigid base.
    band: float = 0.0
    # force against deflection of each spring, or loops of a footing's bed; force against elongation of the first devices
    springs: tuple[Panel, ...] = ()
    devices: tuple[Panel, ...] = ()

    @property
    def outcome(self) -> str:
        """Return the largest |θ|/α with its time, "0.2345 at 12.3 s", or how the run ended early: "overturned at 8.1 s"."""
        if self.status in OUTCOMES:
            return f"{OUTCOMES[self.status]} at {self.end[0]:.1f} s"
        return f"{abs(self.peak[1]):.4f} at {self.peak[0]:.1f} s"


OUTCOMES = {"overturned": "overturned", "flight": "left the ground"}
"""Statuses of runs that end early, as text."""


PEAK = Look("peak", shape="dot")
"""Look of the largest rotation of a pier without a mark of its own."""


class Drawn(NamedTuple):
    """A history in a figure: its ``label`` in the legend, its ``name`` where values are read, and its style.

    ``look`` styles its curves, ``mark`` its largest rotation.
    """

    history: History
    label: str
    name: str
    look: Look
    mark: Look


def reduced(response: Response, look: Look, pixels: int = 900, most_devices: int | None = MOST_DEVICES) -> History:
    """Return the response thinned to ``pixels`` while the pier moves, with loops in ``look``, thinned to an eighth.

    They are those of the supports and of the first ``most_devices`` devices, of all for None.
    """
    pier, t = response.pier, response.t
    theta = response.theta / pier.alpha
    ground = response.history["ag_h"].to_numpy(dtype=np.float64) / pier.gravity
    ordinates = (theta, response.omega / (pier.alpha * pier.p), response.energy, ground)
    worst = int(np.nanargmax(np.abs(theta)))
    moving = _moving(t, theta)
    grain = max(moving[1] - moving[0], 1e-9) / pixels
    events = [*zip(response.events["t"], response.events["kind"], strict=True)]

    def times(*kinds: str) -> Array:
        moments = np.array([moment for moment, kind in events if kind in kinds])
        return np.unique(np.rint(moments / grain)) * grain

    return History(
        response.status,
        [_thinned(t, y, moving, pixels) for y in ordinates],
        times("impact"),
        times(*SEPARATE),
        times("flight"),
        (float(t[worst]), float(theta[worst])),
        (float(t[-1]), float(theta[-1])),
        moving,
        _band(response),
        _springs(response, look, pixels // 8),
        tuple(
            _device(response, name, look, pixels // 8) for name in device_names(response.base.restraints)[:most_devices]
        ),
    )


def _moving(t: Array, theta: Array) -> tuple[float, float]:
    """Return the times [s] from which θ/α, shape (n,), differs from 0, and until which it differs from its final value, by a
    threshold.

    The threshold is ``MOVES``, 2 %, of the greatest |θ/α|, and of 1 at most; both ends of the history if it is never exceeded.
    """
    least = MOVES * min(float(np.nanmax(np.abs(theta))), 1.0)
    left, away = np.abs(theta) > least, np.abs(theta - theta[-1]) > least
    if not left.any() or not away.any():
        return float(t[0]), float(t[-1])
    return float(t[left.argmax()]), float(t[np.flatnonzero(away)[-1]])


def _thinned(t: Array, y: Array, moving: tuple[float, float], pixels: int) -> tuple[Array, Array]:
    """Return times and values of a history thinned to ``pixels`` while the pier moves.

    What is before and after that is thinned to ``pixels`` times its share of the whole time.
    """
    first, last = np.searchsorted(t, moving)
    parts = []
    for part in (slice(0, first), slice(first, last + 1), slice(last + 1, len(t))):
        inside = t[part]
        if len(inside):
            share = 1.0 if part.start == first else (inside[-1] - inside[0]) / (t[-1] - t[0])
            parts.append(thin(inside, y[part], max(1, math.ceil(pixels * share))))
    return np.concatenate([x for x, _ in parts]), np.concatenate([y for _, y in parts])


def together(runs: Sequence[Drawn], record: str) -> tuple[Figure, Axis]:
    """Return a figure of piers under one motion while any of them moves, with margins, and a time axis of the whole record.

    Rotation, velocity and ground acceleration; of the whole record if piers move during more than :data:`CUT` of it.
    """
    end = max(run.history.end[0] for run in runs) or 1.0
    low, high = min(run.history.moving[0] for run in runs), max(run.history.moving[1] for run in runs)
    margin = 0.03 * (high - low)
    low, high = max(low - margin, 0.0), min(high + margin, end)
    if high - low > CUT * end:
        low, high = 0.0, end
    figure = history(runs, ON_PAGE, (low, high), ACROSS, record)
    return figure, replace(figure.panels[-1].x, low=0.0, high=end)


def of_one(response: Response, title: str) -> Figure:
    """Return the figure of a single response at the resolution of print, with the loops of supports and all devices below."""
    look = Look("curve", int(response.base.on_springs))
    own = reduced(response, look, 2000, None)
    runs, heights, shown = [Drawn(own, "", "", look, PEAK)], dict(enumerate(HEIGHTS)), (0.0, own.end[0] or 1.0)
    return history(runs, heights, shown, WIDTH, response.record, title, [*own.springs, *own.devices])


def rotation(response: Response) -> Figure:
    """Return the panel of θ/α against time of a single response, with its events and its largest value."""
    look = Look("curve", int(response.base.on_springs))
    own = reduced(response, look, 2000, 0)
    return history([Drawn(own, "", "", look, PEAK)], {0: HEIGHTS[0]}, (0.0, own.end[0] or 1.0), WIDTH, response.record)


def loops(response: Response) -> Figure:
    """Return the loops of all devices, then of the supports, of a single response: a panel each.

    Raises ``InputError`` if it has neither.
    """
    own = reduced(response, Look("curve", 1), 2000, None)
    panels = [*own.devices, *own.springs]
    if not panels:
        raise InputError("there are no loops: the pier stands on rigid ground, without devices")
    return Figure(panels, f"Force against deformation under {response.record}")


def history(
    runs: Sequence[Drawn],
    heights: Mapping[int, float],
    shown: tuple[float, float],
    width: float,
    record: str,
    title: str = "",
    loops: Sequence[Panel] = (),
) -> Figure:
    """Return a figure with a panel per quantity of ``heights`` [px] against time ``shown`` [s], and ``loops`` below.

    The ground acceleration is drawn once, of the run in which the pier moves longest.
    """
    panels = []
    for row, height in heights.items():
        last = row == max(heights)
        if row == GROUND:
            drawn = [max(runs, key=lambda run: np.ptp(run.history.moving))._replace(name="", look=Look("curve"))]
        else:
            drawn = list(runs)
        y = _scale([run.history for run in drawn], row)
        marks = list[Mark]()
        for run in drawn:
            label = _entry(run) if row == 0 else ""
            marks.append(
                Polyline(*run.history.curves[row], f"{y.plain} {run.name}".strip(), look=run.look, label=label)
            )
        if row == 0:
            marks += _events(runs, y, shown)
        x = Axis("t [s]" if last else "", *shown, about=8, numbered=last)
        panels.append(Panel(x, replace(y, about=4 + (row == 0)), marks, width=width, height=height, reads="time"))
    description = f"Rotation, velocity and ground acceleration against time under {record}"
    return Figure([*panels, *loops], description, title, stacked=True)


def _scale(histories: Sequence[History], row: int) -> Axis:
    """Return the axis of quantity ``row``, for the values of the runs that stood, or of all if none did, up to :data:`OVER`.

    The rotation's axis of a single history also holds its band without uplift, and has room for strokes of events.
    """
    stood = [history for history in histories if history.status == "ok"] or histories
    bands = (
        [np.array([-history.band, history.band]) for history in stood[:1]] if row == 0 and len(histories) == 1 else []
    )
    # Strokes of events stand beyond the curves
    margin = 0.06 + 1.3 * len(histories) * _lane(len(histories)) * (row == 0)
    return spanning(QUANTITIES[row], *(_standing(history, row) for history in stood), *bands, margin=margin)


def _lane(runs: int) -> float:
    """Return the height of the strokes of one pier's events over that of the panel: 0.05 of one run, 0.03 up to four, then 0."""
    return 0.05 if runs == 1 else 0.03 if runs <= MOST_LANES else 0.0


def _entry(run: Drawn) -> str:
    """Return a run's legend entry with its largest rotation or ending; "" without a label."""
    return f"{run.label}: {run.history.outcome}" if run.label else ""


def _standing(history: History, row: int) -> Array:
    """Return the values of quantity ``row`` up to the first |θ|/α beyond :data:`OVER`, 1.5; all of them if none is beyond."""
    t, theta = history.curves[0]
    beyond = np.flatnonzero(np.abs(theta) > OVER)
    times, values = history.curves[row]
    return values[times <= t[beyond[0]]] if len(beyond) else values


def _events(runs: Sequence[Drawn], y: Axis, shown: tuple[float, float]) -> Iterator[Mark]:
    """Yield the marks of events in the panel of rotations.

    The band without uplift of a single run; impacts at the foot and separations at the top, unless there are more than
    :data:`MOST_LANES` runs; flights; peaks of the runs that stood, the largest with its value; early ends.
    """
    if len(runs) == 1 and (band := runs[0].history.band):
        yield Span("y", max(-band, y.low), min(band, y.high), look=Look("band"), label="no uplift")
    lane = _lane(len(runs))
    for kind, where in (("impacts", "at the foot"), ("separations", "at the top")) if lane else ():
        times = [getattr(run.history, kind) for run in runs]
        if any(map(len, times)):  # grey in the legend
            yield Rule("x", np.empty(0), look=Look("event"), label=f"{kind}, {where}")
        for place, (run, own) in enumerate(zip(runs, times, strict=True)):
            low = place * lane if kind == "impacts" else 1.0 - (place + 1) * lane
            yield Rule("x", own, low, low + 0.9 * lane, look=Look("event", run.look.colour))
    flights = np.concatenate([run.history.flights for run in runs])
    if len(flights):
        yield Rule("x", flights, look=Look("flown"), label="off the ground")
    stood = [run for run in runs if run.history.status == "ok" and run.history.peak[1] != 0]
    for run in stood:
        yield Points(*_clipped(run.history.peak, y), look=run.mark, label=_entry(run))
    if stood:
        worst = max((run.history.peak for run in stood), key=lambda peak: abs(peak[1]))
        side = -1 if worst[0] > 0.25 * shown[0] + 0.75 * shown[1] else 1
        yield Words(worst[0], float(np.clip(worst[1], y.low, y.high)), f"{abs(worst[1]):.4f}", side, look=Look("peak"))
    for run in runs:
        if run.history.status in OUTCOMES:
            yield Points(
                *_clipped(run.history.end, y), look=sign_of(run.history.status), label=OUTCOMES[run.history.status]
            )


def _clipped(point: tuple[float, float], y: Axis) -> tuple[Array, Array]:
    """Return a point as arrays of one element, moved to the edge of the panel if it lies above or below."""
    return np.full(1, point[0]), np.full(1, np.clip(point[1], y.low, y.high))


def _band(response: Response) -> float:
    """Return |θ|/α up to which both supports stay loaded; 0 on the rigid base."""
    base, pier = response.base, response.pier
    sine = (1 + pier.mu) / (pier.mu * base.beta**2 * math.sin(pier.alpha))
    return math.asin(min(sine, 1)) / pier.alpha


def _springs(response: Response, look: Look, pixels: int) -> tuple[Panel, ...]:
    """Return a panel of force against deflection of each spring while it is loaded; () on rigid ground.

    Both are over the values at yield if springs yield, else F/(M g) over mm. Of a footing, the panels of :func:`_bed`.
    """
    base, pier, sides = response.base, response.pier, ("left", "right")
    if not base.on_springs:
        return ()
    if not base.two_springs:
        return _bed(response, look, pixels)
    # A viscoelastic spring recovers while its pivot is in the air, far above: it is loaded while the support bears
    borne = [response.history[f"force_{side}"].to_numpy(dtype=np.float64) for side in sides]
    names = ("v/δ_y", "F/F_y") if base.yields else ("v [mm]", "F/(M g)")
    unit = yield_deflection(pier, base) if base.yields else 1e-3
    forces = [response.z_left, response.z_right] if base.yields else [load / pier.gravity for load in borne]
    least = LOADED * max(float(np.abs(force).max(initial=0.0)) for force in borne)
    forces = [np.where(load < -least, force, np.nan) for load, force in zip(borne, forces, strict=True)]
    v = [response.history[f"v_{side}"].to_numpy(dtype=np.float64) / unit for side in sides]
    # As in the paper, the axis ends where the spring unloads, since a lifted pivot may be far above
    loaded = np.concatenate([own[~np.isnan(force)] for own, force in zip(v, forces, strict=True)])
    low, high = (float(loaded.min()), float(loaded.max())) if len(loaded) else (-1.0, 0.0)
    margin = 0.08 * (high - low) + 0.01
    x = Axis(names[0], low - margin, high + margin, about=3)
    bounded = base.yields and min((np.nanmin(force, initial=0.0) for force in forces), default=0.0) >= -1.0
    y = Axis(names[1], -1.08, 0.1, about=3) if bounded else spanning(names[1], *forces, about=3)
    corners = base.backbone[:-1] if base.has_points else ()
    label = "force at a corner of the backbone" if corners else "force at which a support yields"
    at = -np.array([force for _, force in corners] or [1.0])
    yields = Rule("y", at[at >= y.low], look=Look("edge", dash=1), label=label)
    panels = []
    for side, own, force in zip(sides, v, forces, strict=True):
        marks: list[Mark] = [Polyline(*without_repeats(own, force, pixels), y.plain, look=look)]
        panels.append(Panel(x, y, marks + [yields] * base.yields, side, width=WIDTH / 2, height=LOOPS, reads="plane"))
    return tuple(panels)


def _bed(response: Response, look: Look, pixels: int) -> tuple[Panel, ...]:
    """Return two panels over θ [mrad]: moment of the bed about the middle of the foot, over M g [m], and its depth there [mm]."""
    pier, history = response.pier, response.history
    theta = 1000.0 * response.theta
    left, right = (history[f"force_{side}"].to_numpy(dtype=np.float64) for side in ("left", "right"))
    moment = pier.half_width * (left - right) / pier.gravity
    deep = -500.0 * (history["v_left"] + history["v_right"]).to_numpy(dtype=np.float64)
    panels = []
    for name, values in (("moment/(M g) [m]", moment), ("depth of the foot [mm]", deep)):
        x, y = spanning("θ [mrad]", theta, about=3), spanning(name, values, about=3)
        marks = [Polyline(*without_repeats(theta, values, pixels), y.plain, look=look)]
        panels.append(Panel(x, y, marks, "bed", width=WIDTH / 2, height=LOOPS, reads="plane"))
    return tuple(panels)


def _device(response: Response, name: str, look: Look, pixels: int) -> Panel:
    """Return a panel of force against elongation [mm] of a device, the right one of a pair behind the left.

    The force is in kN if the mass is known, else over M g.
    """
    table, pier = response.restraints, response.pier
    assert table is not None
    sides = [side for side in (" right", " left", "") if f"{name}{side} force" in table]
    factor, unit = (1.0 / pier.gravity, "F/(M g)") if pier.mass_t is None else (pier.mass_t, "F [kN]")
    elongations = [1000.0 * table[f"{name}{side} elongation"].to_numpy(dtype=np.float64) for side in sides]
    forces = [factor * table[f"{name}{side} force"].to_numpy(dtype=np.float64) for side in sides]
    looks = {" right": replace(look, kind="right")}
    marks = []
    for side, u, force in zip(sides, elongations, forces, strict=True):
        label, style = f"at the{side} pivot" if side else "", looks.get(side, look)
        marks.append(Polyline(*without_repeats(u, force, pixels), f"{unit}{side}", look=style, label=label))
    axes = spanning("elongation [mm]", *elongations, about=3), spanning(unit, *forces)
    return Panel(*axes, marks, name, width=WIDTH / 2, height=LOOPS, reads="plane")
