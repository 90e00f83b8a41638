"""The figures of the peaks, as the paper's Fig. 7, with their numbers: one for each pier and scale."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from rockbatch.report.document import figure
from rockbatch.report.drawing.panels import draw
from rockbatch.report.finished import Finished
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.sections.peaks import at_a_glance
from rockbatch.results.suite_statistics import NO_PEAK

if TYPE_CHECKING:
    import pandas as pd

MOST_RECORDS = 60
MOST_FIGURES = 12
MOST_MARKS = 12_000  # on the page: a megabyte and a half


def ceiling(runs: "pd.DataFrame") -> float:
    """Top of the axis [θ_max/α] that holds all of ``runs`` that stood."""
    stood = runs[runs["status"] == "ok"]
    highest = (stood["theta_max_over_alpha"] + stood["theta_max_error"].fillna(0)).max()
    return 1.1 * float(highest) if highest > 0 else 1.0


def chosen(finished: Finished, runs: "pd.DataFrame", figures: int = 1) -> list[str]:
    """Records that have a panel, in order of PGA: all of them, or of many those with the worst runs."""
    names = list(runs["record"].unique())
    room = max(1, min(MOST_RECORDS, MOST_MARKS * len(names) // max(1, len(runs) * figures)))
    if len(names) > room:
        badness = runs["theta_max_over_alpha"].where(~runs["status"].isin(NO_PEAK), math.inf)
        worst = badness.groupby(runs["record"]).max().sort_values(ascending=False, kind="stable")
        names = list(worst.index[:room])
    return finished.by_pga(names)


def figures(finished: Finished, caption: Sequence[object], *, side: str = "polarity") -> Markup:
    """A figure for each pier and scale, or for the first of many; ``caption`` is common to them.

    Runs whose column ``side`` has the second of two values are drawn with open markers.
    """
    groups = finished.groups()
    shown = []
    for words, runs in groups[:MOST_FIGURES]:
        # Piers are compared on one axis; larger motions have their own
        top = ceiling(finished.runs[finished.runs["scale"] == runs["scale"].iloc[0]])
        records = chosen(finished, runs, min(len(groups), MOST_FIGURES))
        every = runs["record"].nunique()
        told = [
            tag("strong", f"{words}. ") if words else "", *caption,
            " Symbols in the shaded strip are runs without a largest rotation: the pier overturned, or left the ground."
            if runs["status"].isin(NO_PEAK).any() else "",
            f" Shown are the {len(records):,} records with the worst runs of {every:,}." if len(records) < every else "",
        ]  # fmt: skip
        shown.append(figure(draw(finished, runs, records, top, side), *told))
        shown.append(at_a_glance(finished, runs, records) if side == "polarity" else Markup(""))
    if len(groups) > MOST_FIGURES:
        shown.append(tag("p", f"The first {MOST_FIGURES} of {len(groups)} combinations of pier and scale are shown."))
    return join(*shown)
