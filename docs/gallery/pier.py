"""The pier: what is what, and which rotation is positive."""

import math

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Polygon

B, H, THETA = 1.0, 3.0, math.radians(8)
INK, FAINT, GROUND = "#1f3b57", "#9bb0c4", "#6b6b6b"


def draw() -> Figure:
    figure = Figure(figsize=(5.2, 6.2), layout="constrained")
    axes = figure.subplots()
    axes.add_patch(Polygon([(-B, 0), (B, 0), (B, 2 * H), (-B, 2 * H)], closed=True, fill=False, ls="--", ec=FAINT))
    corners = np.array([(-B, 0), (B, 0), (B, 2 * H), (-B, 2 * H)])
    axes.add_patch(Polygon(_turned(corners), closed=True, fc="#dfe8f1", ec=INK, lw=1.6))
    centre = _turned(np.array([(0.0, H)]))[0]
    left = _turned(np.array([(-B, 0.0)]))[0]
    axes.plot([B, centre[0]], [0, centre[1]], color=INK, lw=1.2)
    axes.plot(*centre, "o", color=INK)
    axes.plot([B, B], [0, 3.9], color=GROUND, lw=0.8, ls=":")
    axes.plot([B, 0], [0, H], color=FAINT, lw=1.2, ls="--")
    at_rest = math.degrees(math.atan2(H, -B))
    axes.add_patch(Arc((B, 0), 3.2, 3.2, theta1=90, theta2=at_rest, color=INK))
    axes.text(B - 0.24, 1.7, "α", ha="center", color=INK, fontsize=13)
    axes.text(0.02, 1.35, "R0", color=INK, fontsize=13)
    axes.add_patch(Arc((-B, 0), 9.6, 9.6, theta1=90 - math.degrees(THETA), theta2=90, color=INK))
    axes.text(-B + 0.24, 4.9, "θ", color=INK, fontsize=13)
    leader = {"arrowstyle": "-", "color": INK, "lw": 0.7}
    axes.annotate("centre of mass\nM, I0", centre, (2.2, 4.7), color=INK, arrowprops=leader)
    for pivot, name, side in ((left, "L", "right"), (np.array([B, 0.0]), "R", "left")):
        axes.plot(*pivot, "o", color="#c0392b", zorder=5)
        shift = -0.15 if side == "right" else 0.15
        axes.annotate(f"pivot {name}", pivot, (pivot[0] + shift, pivot[1] + 0.12), ha=side, color="#c0392b")
    for x in (-B, B):
        _spring(axes, x)
    axes.annotate(
        "support: stiffness K,\nyield force F_y, no tension", (-B, -0.5), (-B - 0.35, -0.55), ha="right", va="center"
    )
    axes.annotate(
        "", (-0.15 + 1.05, 2 * H + 0.62), (-0.15, 2 * H + 0.62), arrowprops={"arrowstyle": "->", "color": INK}
    )
    axes.text(0.35, 2 * H + 0.78, "θ > 0: the left pivot lifts", ha="center", color=INK, fontsize=12)
    _dimension(axes, (-B, -1.75), (0, -1.75), "b")
    _dimension(axes, (0, -1.75), (B, -1.75), "b")
    _dimension(axes, (B + 1.2, 0), (B + 1.2, H), "h")
    axes.annotate("", (-0.7, -1.28), (-1.9, -1.28), arrowprops={"arrowstyle": "->", "color": GROUND, "lw": 1.6})
    axes.text(-2.0, -1.28, "ground: ü_g > 0", ha="right", va="center", color=GROUND)
    axes.set(xlim=(-4.4, 3.2), ylim=(-2.3, 7.3), aspect="equal")
    axes.set_axis_off()
    return figure


def _turned(points: np.ndarray) -> np.ndarray:
    """Points of the block, shape (n, 2), once it has turned by THETA about the right pivot."""
    about = np.array([B, 0.0])
    turn = np.array([[math.cos(THETA), math.sin(THETA)], [-math.sin(THETA), math.cos(THETA)]])
    return about + (points - about) @ turn.T


def _spring(axes, x: float) -> None:
    zigzag = x + 0.12 * np.array([0, 0, 1, -1, 1, -1, 1, 0, 0])
    axes.plot(zigzag, np.linspace(0, -0.95, len(zigzag)), color=GROUND, lw=1.2)
    axes.plot([x - 0.4, x + 0.4], [-0.95, -0.95], color=GROUND, lw=2)


def _dimension(axes, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    axes.annotate("", end, start, arrowprops={"arrowstyle": "<->", "color": GROUND, "shrinkA": 0, "shrinkB": 0})
    middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
    axes.text(middle[0] + 0.12, middle[1] + 0.12, text, color=GROUND, fontsize=12)
