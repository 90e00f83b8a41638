"""Histories: a picture for each motion with its cases, hysteresis loops below."""

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import accumulate
from typing import NamedTuple

from rockbatch.common.figures.description import COLOURS, DASHES, Axis, Figure, Look, marks_of
from rockbatch.common.grouping import grouped
from rockbatch.outcome.figures import PEAK, Drawn, reduced, together
from rockbatch.outcome.response import Response
from rockbatch.pier import Pier
from rockbatch.reporting.finished import Finished, worst_first
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.player import Played, player
from rockbatch.reporting.structure import pier_of
from rockbatch.reporting.svg import drawn, key_of, timed
from rockbatch.reporting.templates import render
from rockbatch.results.histories_file import Responses
from rockbatch.results.labelled import Row, as_dicts
from rockbatch.results.labels import Series
from rockbatch.results.run_json import MOTIONS_FROM_PYTHON, STUDY_FROM_PYTHON

MOST_HISTORIES = 40
"""Number of histories at which no further picture is begun."""
MOST_PLAYED = 40
"""Most cases whose worst run can be played."""
MOST_TOGETHER = 7
"""Most foundations in one picture, beside rigid ground: as many as there are colours."""

MOTION = ("record", "polarity", "scale", "pier")
"""Columns that identify a picture: equal for all of its runs."""


class Picture(NamedTuple):
    """The drawings of one motion, and facts for its caption."""

    title: str
    cut: Axis | None
    """Axis of the time shown, None if it is the ``whole``."""
    whole: Axis
    key: Markup
    curves: Markup
    loops: Markup
    springs: bool
    devices: bool
    left_out: int
    """Number of cases that are not drawn."""


def section(finished: Finished) -> Markup:
    """Return a picture of the stored histories of each motion; empty if no history is stored."""
    if not len(finished.responses):
        return Markup("")
    words = list(map(str, finished.info["command"]))
    from_python = {STUDY_FROM_PYTHON, MOTIONS_FROM_PYTHON} & {*words}
    command = "" if from_python else shlex.join([*words, "--history", "RECORD"])
    pictures, played = _pictures(finished)
    return render("reporting/sections/histories.html", pictures=pictures, player=player(played), command=command)


def _pictures(finished: Finished) -> tuple[list[Picture], list[Played]]:
    """Draw a picture for each motion, worst first, of many for the worst ones; return the worst drawn run of each case, too."""
    responses = finished.responses
    rows = _rows_of(finished, responses)
    rank = _ranks(finished, rows)
    pictures: list[Picture] = []
    played: list[tuple[Row, Played]] = []
    for numbers in _motions(rows, rank):
        shown = _shown(finished, [rows[number] | {"number": number} for number in numbers])
        places = [row["number"] for row in shown]
        chosen = (
            responses.without_rows(places) if isinstance(responses, Responses) else map(responses.__getitem__, places)
        )
        runs = [_drawn(finished.series[row["series"]], response) for row, response in zip(shown, chosen, strict=True)]
        pictures.append(_picture(_title(finished, shown[0]), runs, len(numbers) - len(shown)))
        for curve, (row, run) in enumerate(zip(shown, runs, strict=True)):
            case = finished.cases.get((row["series"], row["pier"]))  # none if rows were taken out of the table by hand
            pier = pier_of(case) if case else None
            if pier:
                played.append((row, _played(finished, row, run, pier, pictures, curve)))
    worst = sorted(played, key=lambda own: rank.get(_key(own[0]), len(rank)))
    of_case = grouped(worst, lambda own: _key(own[0])[-2:])
    return pictures, [own[0][1] for own in of_case.values()][:MOST_PLAYED]


def _played(finished: Finished, row: Row, run: Drawn, pier: Pier, pictures: Sequence[Picture], curve: int) -> Played:
    """Return a run that can be played: it is drawn as this ``curve`` of the last of ``pictures``."""
    case = finished.named_place(row["series"], row["pier"])
    shown = pictures[-1].cut or pictures[-1].whole
    return Played(case, _of_motion(finished, row), run, pier, len(pictures) - 1, curve, (shown.low, shown.high))


def _picture(title: str, runs: Sequence[Drawn], left_out: int) -> Picture:
    """Draw the curves and loops of ``runs`` under one motion."""
    figure, whole = together(runs, title)
    panels = [(run.name, panel) for run in runs for panel in (*run.history.springs, *run.history.devices)]
    loops = [replace(panel, caption=f"{name}, {panel.caption}") for name, panel in panels]
    x = figure.panels[-1].x
    return Picture(
        title,
        cut=x if x != whole else None,
        whole=whole,
        key=key_of(figure),
        curves=timed(figure, whole),
        loops=drawn(Figure(loops, f"Force against deflection under {title}")) if loops else Markup(""),
        springs=any(run.history.springs for run in runs),
        devices=any(run.history.devices for run in runs),
        left_out=left_out,
    )


def _drawn(series: Series, response: Response) -> Drawn:
    """Return a run with the colour and mark that its foundation has throughout the page."""
    mark = PEAK if series.rigid else marks_of(series.index)
    rounds = series.index if series.rigid else series.index // COLOURS
    look = Look("rigid" if series.rigid else "curve", mark.colour, dash=rounds % DASHES)
    name = series.label if series.rigid else series.tick
    return Drawn(reduced(response, look), series.keyed, name, look, mark)


def _rows_of(finished: Finished, responses: Sequence[Response]) -> list[Row]:
    """Return identity, status, varied values, series and pier of each run that has a history, without reading the history.

    Raises ``InputError`` for a run whose case peaks.csv does not list.
    """
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


def _ranks(finished: Finished, rows: Sequence[Row]) -> dict[tuple[object, ...], int]:
    """Return the rank of each run, by its key, among all runs under the motions of ``rows``: 0 for the worst."""
    runs = finished.runs[finished.runs["record"].isin({row["record"] for row in rows})]
    ordered = map(_key, as_dicts(worst_first(runs, len(runs))[[*MOTION, "series"]]))
    return {key: place for place, key in enumerate(dict.fromkeys(ordered))}


def _motions(rows: Sequence[Row], rank: Mapping[tuple[object, ...], int]) -> list[list[int]]:
    """Return the indices into ``rows`` of each motion's runs, worst motion first; no motion is begun after 40 histories.

    Of more than :data:`MOST_HISTORIES` only motions that are the worst for some case.
    """
    numbers = sorted(range(len(rows)), key=lambda number: rank.get(_key(rows[number]), len(rank)))
    motions = [*grouped(numbers, lambda number: _key(rows[number])[:-1]).values()]
    if len(rows) > MOST_HISTORIES:
        of_case = grouped(numbers, lambda number: (rows[number]["series"], rows[number]["pier"]))
        needed = {own[0] for own in of_case.values()}
        motions = [own for own in motions if needed.intersection(own)]
    before = accumulate(map(len, motions), initial=0)
    return [own for own, count in zip(motions, before, strict=False) if count < MOST_HISTORIES]


def _key(row: Row) -> tuple[object, ...]:
    """Return the key of a run: record, polarity, scale to ten digits as peaks.csv has it, pier and series."""
    return row["record"], row["polarity"], float(f"{row['scale']:.10g}"), row["pier"], row["series"]


def _shown(finished: Finished, rows: Sequence[Row]) -> list[Row]:
    """Return the runs to draw: those on rigid ground, then the first :data:`MOST_TOGETHER` others of ``rows``, worst first.

    Both are in the order of their foundations.
    """
    rigid = [row for row in rows if finished.series[row["series"]].rigid]
    others = [row for row in rows if row not in rigid][:MOST_TOGETHER]
    return sorted(rigid + others, key=lambda row: (row not in rigid, finished.series[row["series"]].index))


def _title(finished: Finished, run: Row) -> str:
    """Return the name of a run's motion and pier: "Kobe, Takatori, 0° (TAK000), scaled by 2, reversed, p = 1.2 rad/s"."""
    return ", ".join(filter(None, [_of_motion(finished, run), finished.piers[run["pier"]]]))


def _of_motion(finished: Finished, run: Row) -> str:
    """Return the name of a run's motion: "Kobe, Takatori, 0° (TAK000), scaled by 2, reversed"."""
    also = [f"scaled by {run['scale']:g}" if run["scale"] != 1 else "", "reversed" if run["polarity"] == "-" else ""]
    return ", ".join(filter(None, [finished.named(run["record"]), *also]))
