"""The worst run of each case: the pier at its peak, which the page's script moves by the curves of the histories."""

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from rockbatch.outcome.figures import GROUND, OUTCOMES, OVER, Drawn
from rockbatch.pier import Pier
from rockbatch.reporting.markup import Markup, number, tag
from rockbatch.reporting.svg import svg

HEIGHT = 150.0
"""Height of a pier [px]."""
MOST_DRAWN = 0.25
"""Rotation [rad] up to which a smaller largest one is enlarged."""
FACTORS = (1000, 500, 200, 100, 50, 20, 10, 5, 2)
PUSH = 50.0
"""Length of the arrow of the greatest ground acceleration [px]."""
GROUND_AT = 9.0
"""Depth of the arrow below the ground [px]."""


class Played(NamedTuple):
    """A run whose curves stand on the page: in the picture of this number, as the curve of this number.

    ``shown`` are the times [s] between which the picture shows the run.
    """

    case: str
    title: str
    run: Drawn
    pier: Pier
    picture: int
    curve: int
    shown: tuple[float, float]


def player(runs: Iterable[Played]) -> Markup:
    """Return a figure for each run, the first one chosen; empty without runs."""
    figures = [_figure(run, place == 0) for place, run in enumerate(runs)]
    return tag("div", *figures, class_="player") if figures else Markup("")


def _figure(played: Played, chosen: bool) -> Markup:
    """Return the figure of a run's pier at its peak, with what the script needs to move it.

    A peak beyond :data:`OVER` times α is drawn there; small rotations are drawn larger, by one of :data:`FACTORS`.
    """
    history, alpha = played.run.history, played.pier.alpha
    time, peak = history.peak
    most = min(abs(peak), OVER) * alpha
    factor = next((factor for factor in FACTORS if factor * most <= MOST_DRAWN), 1)
    times, accelerations = history.curves[GROUND]
    greatest = float(np.abs(accelerations).max()) or 1.0
    drawn = _Drawing(played.pier, factor * most)
    turned = math.copysign(factor * most, peak)
    push = PUSH * float(np.interp(time, times, accelerations)) / greatest
    enlarged = f"rotation drawn {factor} times as large" if factor > 1 else "rotation to scale"
    peak_words = history.outcome if history.status in OUTCOMES else f"θ/α = {history.outcome}"
    words = f"{peak_words}; {enlarged}; arrow: ground acceleration, {number(greatest, '.3g')} g at its longest"
    caption = tag("figcaption", tag("strong", played.case), tag("span", f" under {played.title}", class_="muted"))
    description = f"The pier of {played.case} at its peak, {words}"
    return tag(
        "figure",
        caption,
        tag("div", drawn.picture(turned, push, description), class_="stage"),
        tag("p", words, ".", class_="legend"),
        class_="chosen" if chosen else None,
        data_picture=played.picture,
        data_curve=played.curve,
        data_turn=f"{math.degrees(factor * alpha):.6g}",
        data_half=f"{drawn.half_width:.1f}",
        data_push=f"{PUSH / greatest:.6g}",
        data_times=f"{played.shown[0]:.6g} {played.shown[1]:.6g} {time:.6g}",
    )


class _Drawing:
    """A pier to scale, from its left pivot to the right one, with room for a rotation of ``most`` [rad] to either side."""

    def __init__(self, pier: Pier, most: float) -> None:
        scale = HEIGHT / pier.highest
        self.half_width = scale * pier.half_width
        self.side = max(self.half_width + HEIGHT * math.sin(most), PUSH) + 12.0
        self.centre = scale * pier.height

    def picture(self, turned: float, push: float, description: str) -> Markup:
        """Draw the pier turned by ``turned`` [rad] about its pivot, on the ground, with an arrow of ``push`` px below."""
        b = self.half_width
        pivot = math.copysign(b, turned)
        outline = f"M{-b:.1f} 0V{-HEIGHT:.1f}H{b:.1f}V0z"
        pier = tag(
            "g",
            tag("path", d=outline, class_="band"),
            tag("path", d=outline, class_="rigid"),
            tag("path", d=f"M0 {-self.centre:.1f}h0", class_="centre"),
            class_="moves",
            transform=f"rotate({math.degrees(turned):.3f} {pivot:.1f} 0)",
        )
        ground = tag("path", d=f"M{-self.side:.1f} 0H{self.side:.1f}", class_="edge")
        height = HEIGHT + 2.0 * GROUND_AT + 2.0 * b * math.sin(abs(turned)) + 8.0
        moved = f"translate({self.side:.1f} {height - 2.0 * GROUND_AT:.1f})"
        content = tag("g", ground, pier, tag("path", d=arrow(push), class_="push"), transform=moved)
        return svg(2.0 * self.side, height, content, description=description, class_="plot pier")


def arrow(push: float) -> str:
    """Return the path of an arrow from the middle of the base, ``push`` px to the right."""
    head = math.copysign(4.0, push)
    return f"M0 {GROUND_AT}h{push:.1f}" + (f"m{-head} -3l{head} 3l{-head} 3" if abs(push) > 4.0 else "")
