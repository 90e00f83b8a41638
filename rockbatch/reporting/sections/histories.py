"""Histories: a picture for each motion, with every case that was kept under it, loops at its foot."""

import shlex
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from rockbatch.common.figures.description import COLOURS, DASHES, Figure, Look, marks_of
from rockbatch.common.grouping import grouped
from rockbatch.reporting.finished import Finished, worst_first
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.svg import drawn, key_of, timed
from rockbatch.reporting.templates import render
from rockbatch.results.histories_file import Responses
from rockbatch.results.labelled import as_dicts
from rockbatch.results.labels import Series
from rockbatch.results.run_json import FROM_PYTHON
from rockbatch.simulation.figures import PEAK, Drawn, reduced, together
from rockbatch.simulation.response import Response

MOST_HISTORIES = 40
"""Most histories of a page, but for the last of its pictures."""
MOST_TOGETHER = 7
"""Most foundations in one picture, beside the rigid base: their colours differ."""

Row = dict[str, Any]
MOTION = ("record", "polarity", "scale", "pier")
"""What is alike for the runs of one picture."""


def section(finished: Finished) -> Markup:
    """Draw the stored histories; empty if there are none."""
    if not len(finished.responses):
        return Markup("")
    words = list(map(str, finished.info["command"]))
    from_command = not any(word.endswith(FROM_PYTHON) for word in words)
    command = shlex.join([*words, "--history", "RECORD"]) if from_command else ""
    pictures = _pictures(finished)
    kinds = {name: any(picture[name] for picture in pictures) for name in ("springs", "devices")}
    return render("reporting/sections/histories.html", pictures=pictures, command=command, **kinds)


def _pictures(finished: Finished) -> list[dict[str, Any]]:
    """Draw a picture for each motion, the worst first, or for the worst of many; with what its caption depends on."""
    responses = finished.responses
    rows = _rows_of(finished, responses)
    pictures = []
    for numbers in _motions(finished, rows):
        chosen = (
            responses.without_rows(numbers) if isinstance(responses, Responses) else map(responses.__getitem__, numbers)
        )
        runs = [
            _drawn(finished.series[rows[number]["series"]], response)
            for number, response in zip(numbers, chosen, strict=True)
        ]
        pictures.append(_picture(finished, rows[numbers[0]], runs))
    return pictures


def _picture(finished: Finished, motion: Row, runs: Sequence[Drawn]) -> dict[str, Any]:
    title = _title(finished, motion)
    figure, whole = together(runs, f"Rotation, velocity and ground acceleration against time under {title}")
    loops = [
        replace(panel, caption=f"{run.name}, {panel.caption}")
        for run in runs
        for panel in (*run.history.springs, *run.history.devices)
    ]
    x = figure.panels[-1].x
    kinds = {name: any(getattr(run.history, name) for run in runs) for name in ("springs", "devices")}
    return {
        "title": title, "whole": whole, "shown": x if x != whole else None, "curves": timed(figure, whole),
        "key": key_of(figure), "loops": drawn(Figure(loops, f"Force against deflection under {title}")) if loops else "",
    } | kinds  # fmt: skip


def _drawn(series: Series, response: Response) -> Drawn:
    """Return a run in the colour and with the mark that its foundation has everywhere on the page."""
    mark = PEAK if series.rigid else marks_of(series.index)
    rounds = series.index if series.rigid else series.index // COLOURS
    look = Look("rigid" if series.rigid else "curve", mark.colour, dash=rounds % DASHES)
    name = series.label if series.rigid else series.tick
    return Drawn(reduced(response, look), series.keyed, name, look, mark)


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
        rows.append(run | {"series": series, "pier": pier})
    return rows


def _motions(finished: Finished, rows: Sequence[Row]) -> list[list[int]]:
    """Return the numbers of the runs under each motion, the worst motion first; of many those that are worst for some case."""
    names = [*MOTION, "series"]
    number_of = {tuple(run[name] for name in names): number for number, run in enumerate(rows)}
    ordered = worst_first(finished.runs, len(finished.runs)).drop_duplicates(names)[names].itertuples(index=False)
    worst = [number_of[key] for key in map(tuple, ordered) if key in number_of]
    motions = grouped(worst, lambda number: tuple(rows[number][name] for name in MOTION))
    if len(rows) > MOST_HISTORIES:
        of_case = grouped(worst, lambda number: (rows[number]["series"], rows[number]["pier"]))
        needed = {numbers[0] for numbers in of_case.values()}
        motions = {motion: numbers for motion, numbers in motions.items() if needed.intersection(numbers)}
    chosen: list[list[int]] = []
    for numbers in motions.values():
        if sum(map(len, chosen)) >= MOST_HISTORIES:
            break
        rigid = [number for number in numbers if finished.series[rows[number]["series"]].rigid]
        others = [number for number in numbers if number not in rigid][:MOST_TOGETHER]
        chosen.append(sorted(rigid + others, key=lambda number: rows[number]["series"]))
    return chosen


def _title(finished: Finished, run: Row) -> str:
    also = [f"scaled by {run['scale']:g}" if run["scale"] != 1 else "", "reversed" if run["polarity"] == "-" else ""]
    return ", ".join(filter(None, [finished.named(run["record"]), *also, finished.piers[run["pier"]]]))
