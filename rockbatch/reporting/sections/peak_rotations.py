"""The figures of the peaks, as the paper's Fig. 7, with their numbers: one for each pier and scale."""

import math
from collections.abc import Sequence
from itertools import islice

from rockbatch.common.lazy import pd
from rockbatch.reporting.finished import Finished, worst_first
from rockbatch.reporting.markup import Markup, figure, join, tag
from rockbatch.reporting.overview import by_foundation
from rockbatch.reporting.sections.peaks import at_a_glance
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import THETA
from rockbatch.results.figures import peaks
from rockbatch.results.labelled import ceiling
from rockbatch.results.suite_statistics import NO_PEAK, worst_records
from rockbatch.simulation.outcome import LEANS

MOST_RECORDS = 60
MOST_SERIES = 24
"""Most foundations side by side in a panel; if there are more, each has a row of its own."""
MOST_FIGURES = 12
INVISIBLE = 0.02
"""Share of the axis below which a marker lies on it."""
LEAST_QUIET = 4
"""Least number of records with only such markers that share a sentence instead of a panel each."""
MOST_MARKS = 12_000  # on the page: a megabyte and a half
MOST_OF_A_FIGURE = 2_000  # foundations under one record, each with its line in the legend


def section(finished: Finished) -> Markup:
    """Draw a figure for each pier and scale, with its numbers."""
    if finished.runs.empty:
        return Markup("")
    runs = finished.runs
    caption = [
        "Largest rotation over slenderness, ", THETA, ", records in order of peak ground acceleration",
        "; lines: rigid base" if any(series.rigid for series in finished.series) else "",
        "; open markers and dashed lines: horizontal component reversed" if finished.both_directions else "", ".",
    ]  # fmt: skip
    if finished.grouped["series"].nunique().max() > MOST_SERIES:
        return by_foundation(finished)
    pictures = figures(finished, caption)
    stood = runs[runs["status"] == "ok"]
    marks = {
        "f": ("both pivots left the ground on the way; the pier was guided down.", stood["flight_s"].notna()),
        LEANS: (
            "mostly the lean of a base that has yielded, not rocking; see the note of the run.",
            stood["theta_max_is"] == LEANS,
        ),
    }
    legend = (
        tag("p", tag("sup", mark), " ", words, class_="legend") for mark, (words, mask) in marks.items() if mask.any()
    )
    return join(pictures, *legend)


def chosen(finished: Finished, runs: "pd.DataFrame", figures: int = 1) -> list[str]:
    """Return the records that have a panel, by PGA: all of them, or of many those with the worst runs."""
    names = list(runs["record"].unique())
    room = max(1, min(MOST_RECORDS, MOST_MARKS * len(names) // max(1, len(runs) * figures)))
    return finished.by_pga(worst_records(runs, room) if len(names) > room else names)


def _quiet(runs: "pd.DataFrame", records: Sequence[str], top: float) -> list[str]:
    """Return the records whose markers would all lie on the axis; none if these are few, or all of them."""
    worst = runs["theta_max_over_alpha"].where(runs["status"] == "ok", math.inf).groupby(runs["record"]).max()
    quiet = [name for name in records if worst[name] < INVISIBLE * top]
    return quiet if LEAST_QUIET <= len(quiet) < len(records) else []


def _of_quiet(finished: Finished, quiet: Sequence[str], top: float) -> str:
    if not quiet:
        return ""
    names = "; ".join(map(finished.label, quiet))
    return f" Without a panel: {len(quiet)} records under which no pier rotates by more than {INVISIBLE * top:.2g} α ({names})."


def figures(finished: Finished, caption: Sequence[object], *, side: str = "polarity") -> Markup:
    """Draw a figure for each pier and scale, or for the first of many; ``caption`` is common to them.

    Runs whose column ``side`` has the second of two values are drawn with open markers.
    """
    groups = finished.grouped.ngroups
    shown = []
    for words, runs in islice(finished.groups(), MOST_FIGURES):
        # Piers are compared on one axis; larger motions have their own
        top = ceiling(finished.runs[finished.runs["scale"] == runs["scale"].iloc[0]])
        records = chosen(finished, runs, min(groups, MOST_FIGURES))
        quiet = _quiet(runs, records, top)
        records = [name for name in records if name not in quiet]
        every, all_of_them = runs["record"].nunique() - len(quiet), len(runs)
        if runs["record"].value_counts().max() > MOST_OF_A_FIGURE:
            runs = worst_first(runs[runs["record"].isin(records)], MOST_OF_A_FIGURE)
            records = [name for name in records if name in set(runs["record"])]
        parts = [
            tag("strong", f"{words}. ") if words else "", *caption,
            _of_quiet(finished, quiet, top),
            " Symbols in the shaded strip are runs without a largest rotation: the pier overturned, or left the ground."
            if runs["status"].isin(NO_PEAK).any() else "",
            f" Shown are the {len(runs):,} worst of {all_of_them:,} runs." if len(runs) < all_of_them else
            f" Shown are the {len(records):,} records with the worst runs of {every:,}." if len(records) < every else "",
        ]  # fmt: skip
        captions = {name: _captions(finished, name, runs) for name in records}
        described = peaks(runs.assign(side=runs[side]), finished.series, captions, top)
        shown.append(figure(drawn(described), *parts))
        shown.append(
            at_a_glance(finished, runs, finished.by_pga([*records, *quiet])) if side == "polarity" else Markup("")
        )
    if groups > MOST_FIGURES:
        shown.append(tag("p", f"The first {MOST_FIGURES} of {groups} combinations of pier and scale are shown."))
    return join(*shown)


def _captions(finished: Finished, record: str, runs: "pd.DataFrame") -> tuple[str, str]:
    """Return the caption of a record's panel, and its name in tables and peak ground acceleration."""
    pga = float(runs.loc[runs["record"] == record, "pga"].iloc[0])
    label = finished.label(record)
    parts = ("" if label == record else record, f"PGA = {pga:.3f}\u00a0g" if math.isfinite(pga) else "")
    return label, ", ".join(filter(None, parts))
