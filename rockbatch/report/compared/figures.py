"""Figures of the peaks with the markers of both studies."""

from dataclasses import replace

from rockbatch.lazy import pd
from rockbatch.report.document import Section
from rockbatch.report.finished import worst_first
from rockbatch.report.pair import SIDES, Pair
from rockbatch.report.sections import peak_rotations
from rockbatch.report.table import THETA


def section(pair: Pair) -> Section | None:
    """Draw panels with the markers of both studies; of both directions, the worse one."""
    named, matched = pair.named, pair.matched
    if matched.runs[0].empty:
        return None
    worse = []
    for name, runs in zip(SIDES, matched.runs, strict=True):
        kept = worst_first(runs, len(runs)).drop_duplicates(["record", "series", "pier", "scale", "with_vertical"])
        worse.append(kept.assign(side=name))
    both = replace(named, runs=pd.concat(worse, ignore_index=True))
    lines = both.runs["series"].map(lambda place: named.series[place].rigid).any()
    caption = [
        "Largest rotation over slenderness, ", THETA, ": filled markers A, open markers B",
        "; lines: rigid base, B dashed" if lines else "",
        "; the worse direction of each motion" if matched.runs[0]["polarity"].nunique() > 1 else "", ".",
    ]  # fmt: skip
    return Section("Peak rotations", "figure", peak_rotations.figures(both, caption, side="side"))
