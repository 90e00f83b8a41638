"""The picture of the paper's Fig. 5: a column of histories per run, loops at its foot."""

import shlex
from collections.abc import Sequence
from operator import itemgetter
from typing import Any

from rockbatch.common.grouping import grouped
from rockbatch.reporting.finished import Finished, worst_first
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.reporting.svg import alike
from rockbatch.reporting.templates import render
from rockbatch.results.histories_file import Responses
from rockbatch.results.labelled import as_dicts
from rockbatch.results.run_json import FROM_PYTHON
from rockbatch.simulation.figures import WIDTH, History, history, reduced
from rockbatch.simulation.response import Response

MOST_COLUMNS = 40

Row = dict[str, Any]


def section(finished: Finished) -> Markup:
    """Draw the stored histories; empty if there are none."""
    if not len(finished.responses):
        return Markup("")
    words = list(map(str, finished.info["command"]))
    from_command = not any(word.endswith(FROM_PYTHON) for word in words)
    command = shlex.join([*words, "--history", "RECORD"]) if from_command else ""
    return render(
        "reporting/sections/histories.html", pictures=_pictures(finished, finished.responses), command=command
    )


def _pictures(finished: Finished, responses: Sequence[Response]) -> list[dict[str, Any]]:
    """Draw a picture for each pier: a column for every response, or for the worst of many; with what its caption depends on."""
    rows = _rows_of(finished, responses)
    numbers = _chosen(finished, rows)
    same_motion = itemgetter("record", "polarity", "scale", "pier")
    rigid = {same_motion(run): number for number, run in reversed([*enumerate(rows)]) if run["rigid"]}
    behind = {number: None if rows[number]["rigid"] else rigid.get(same_motion(rows[number])) for number in numbers}
    # A rigid base drawn behind another column needs none of its own
    columns = [number for number in numbers if number not in behind.values()]
    needed = sorted({number for number in (*columns, *behind.values()) if number is not None})
    chosen = responses.without_rows(needed) if isinstance(responses, Responses) else map(responses.__getitem__, needed)
    drawn: dict[int | None, History] = {
        number: reduced(response) for number, response in zip(needed, chosen, strict=True)
    }
    pictures = []
    for pier, of_pier in grouped(columns, lambda number: rows[number]["pier"]).items():
        of_pier.sort(key=lambda number: (not rows[number]["rigid"], rows[number]["index"]))
        histories = [drawn[number] for column in of_pier for number in (column, behind[column]) if number is not None]
        shown = [drawn[number] for number in of_pier]
        figures = [
            history(drawn[number], drawn.get(behind[number]), histories, finished.label(rows[number]["record"]))
            for number in of_pier
        ]
        cells = [
            tag("figure", tag("figcaption", _title(finished, rows[number])), picture)
            for number, picture in zip(of_pier, alike(figures), strict=True)
        ]
        grid = tag("div", *cells, class_="histories", style=f"--w:{WIDTH:.0f}px")
        pictures.append({
            "pier": finished.piers[pier], "grid": grid,
            "loops": any(one.springs for one in shown), "devices": any(one.devices for one in shown),
            "flights": any(len(one.flights) for one in shown), "bands": any(one.band for one in shown),
            "lines": any(behind[number] is not None for number in of_pier),
        })  # fmt: skip
    return pictures


def _rows_of(finished: Finished, responses: Sequence[Response]) -> list[Row]:
    """Return the runs that have histories, without reading these."""
    if isinstance(responses, Responses):
        runs = as_dicts(responses.runs)
    else:
        names = ("record", "case", "polarity", "scale", "status")
        runs = [{name: getattr(response, name) for name in names} | response.columns for response in responses]
    rows = []
    for run in runs:
        series, pier = finished.place(run["case"], run)
        foundation = finished.series[series]
        rows.append(run | {"series": series, "pier": pier, "rigid": foundation.rigid, "index": foundation.index})
    return rows


def _chosen(finished: Finished, rows: Sequence[Row]) -> list[int]:
    """Return the numbers of the runs to show: all, or of many the worst of each case, and of many cases the worst."""
    if len(rows) <= MOST_COLUMNS:
        return list(range(len(rows)))
    names = ["record", "polarity", "scale", "series", "pier"]
    number_of = {tuple(run[name] for name in names): number for number, run in enumerate(rows)}
    ordered = worst_first(finished.runs, len(finished.runs)).drop_duplicates(names)[names].itertuples(index=False)
    pairs, numbers = set(), []
    for key in map(tuple, ordered):
        if key in number_of and key[3:] not in pairs:
            pairs.add(key[3:])
            numbers.append(number_of[key])
    return numbers[:MOST_COLUMNS]


def _title(finished: Finished, run: Row) -> Markup:
    also = [f"scaled by {run['scale']:g}" if run["scale"] != 1 else "", "reversed" if run["polarity"] == "-" else ""]
    details = ", ".join(filter(None, also))
    record = tag("span", finished.named(run["record"]) + (f", {details}" if details else ""), class_="muted")
    return join(tag("span", finished.series[run["series"]].label), " ", record)
