"""Forces over the height of the shaft: the envelope of every case over its records."""

from collections.abc import Iterator
from itertools import islice

from rockbatch.common.lazy import pd
from rockbatch.common.statuses import CUT_SHORT
from rockbatch.observers.sections import TABLE
from rockbatch.observers.sections.figure import over_height
from rockbatch.quantities.demands import OF_SECTIONS
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import Head, alarm, table
from rockbatch.reporting.templates import render
from rockbatch.results.labelled import groups_of
from rockbatch.results.sections import columns_in

MOST_GROUPS = 4
"""Most piers and scales whose envelopes are drawn."""


def section(finished: Finished) -> Markup:
    """Return the report's section of forces in sections of the shaft; empty if the study asks for none."""
    rows = finished.sections
    if rows.empty:
        return Markup("")
    runs = finished.runs.merge(rows, on=[name for name in rows if name not in OF_SECTIONS])
    if runs.empty:
        return Markup("")
    groups = list(groups_of(runs, finished.piers))
    return render(
        "observers/sections/section.html",
        file=TABLE,
        shown=min(len(groups), MOST_GROUPS),
        groups=len(groups),
        picture=drawn(over_height(islice(groups, MOST_GROUPS), finished.series)),
        table=table(_heads(runs), _rows(finished, groups), sortable=True, name="Forces in every section"),
        bounds=bool(runs["status"].isin(CUT_SHORT).any()),
    )


def _heads(runs: "pd.DataFrame") -> list[Head]:
    columns = columns_in(runs)
    words = {"axial_at_moment": "with the moment, ", "axial_least": "least ", "axial_greatest": "greatest "}
    order = ("shear", "moment", "axial_at_moment", "axial_least", "axial_greatest")
    forces = [
        Head(words.get(name, "") + own.symbol, ".3f" if own.over_mass else ".0f", OF_SECTIONS[own.name], unit=own.unit)
        for name in order
        for own in [columns[name]]
    ]
    return [
        Head("case"),
        Head("height", ".2f", OF_SECTIONS["height_m"], unit="m"),
        *forces,
        Head("±", ".0e", OF_SECTIONS["sections_error"]),
        Head("runs", note="that went through, of all"),
        Head("record with the moment"),
    ]


def _rows(finished: Finished, groups: "list[tuple[str, pd.DataFrame]]") -> Iterator[list[object]]:
    """Yield a row for each case and height: the worst of its runs, N with the greatest of their moments."""
    for words, group in groups:
        columns = {name: column.name for name, column in columns_in(group).items()}
        for _, runs in group.groupby(["series", "height_m"], sort=False):
            bent = runs.iloc[int(runs[columns["moment"]].argmax())]
            label = finished.series[bent["series"]].label
            ended = int(runs["status"].isin(CUT_SHORT).sum())
            counts, error = f"{len(runs) - ended} of {len(runs)}", runs["sections_error"].max()
            yield [
                f"{label} ({words})" if words else label,
                bent["height_m"],
                runs[columns["shear"]].max(),
                bent[columns["moment"]],
                bent[columns["axial_at_moment"]],
                runs[columns["axial_least"]].min(),
                runs[columns["axial_greatest"]].max(),
                error,
                alarm(counts) if ended else counts,
                finished.shown(bent["record"]),
            ]
