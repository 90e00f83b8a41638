"""The calculation sheet: the values of the report in a layout for paper, of A4 or Letter, with nothing folded or cut off."""

import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

from rockbatch.common.observers import from_observer, report_parts
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.page import analyses
from rockbatch.reporting.sections import (
    answer,
    assumptions,
    devices,
    histories,
    identity,
    inputs,
    motions,
    peaks,
    published,
    statement,
    statics,
    target,
    verdicts,
)
from rockbatch.reporting.svg import markers
from rockbatch.reporting.table import on_paper
from rockbatch.reporting.templates import Section, render, styles

Draw = Callable[[Finished], Markup]


class Part(NamedTuple):
    """A section of the sheet: its heading, and the function of a section that draws it for paper."""

    heading: str
    anchor: str
    content: Draw


def _of_observers(finished: Finished) -> Iterator[Section]:
    """Yield a section for each observer that has one in reports, without content if the folder has no results of it."""
    for name, part in report_parts():
        yield Section(part.heading, part.anchor, from_observer(name, "section.section")(finished))


BEFORE = (
    Part("Result", "answer", answer.section),
    Part("Inputs", "inputs", inputs.section),
    Part("What is assumed", "assumptions", assumptions.section),
    Part("Ground motions", "records", motions.section),
    Part("The suite against its target spectrum", "target", target.section),
    Part("Checks", "checks", verdicts.section),
    Part("Statement", "statement", statement.section),
    Part("Every run", "peaks", peaks.section),
)
AFTER = (
    Part("Devices", "devices", devices.section),
    Part("Compared with published values", "references", published.section),
    Part("Histories", "histories", histories.section),
    Part("Statics", "statics", statics.section),
    Part("Left out, and not used", "unusable", motions.unusable),
    Part("Digests", "digests", identity.section),
    Part("The study file", "study", lambda finished: render("reporting/sections/study.html", contents=finished)),
)


def sheet(finished: Finished) -> str:
    """Return the calculation sheet of one folder as HTML; it needs no script, and prints on paper of any size from A5."""
    with on_paper():
        sections = [
            *(Section(part.heading, part.anchor, part.content(finished)) for part in BEFORE),
            *_of_observers(finished),
            *(Section(part.heading, part.anchor, part.content(finished)) for part in AFTER),
            *analyses(finished),
        ]
    info = finished.info
    commit = info["versions"].get("commit", "")
    return render(
        "reporting/sheet.html",
        title=info["study"]["title"] or "Rocking piers",
        path=info["study"]["path"],
        version=f"rockbatch {info['rockbatch']}" + (f" ({commit})" if commit else ""),
        date=str(info["created"])[:10],
        sections=[_unfolded(section) for section in sections if section.content],
        markers=markers(),
        style=styles("style.css", "sheet.css"),
    )


def _unfolded(section: Section) -> Section:
    """Return a section with its folds open; words of a record cannot be mistaken for a fold, since they are escaped."""
    return section._replace(content=Markup(re.sub(r"<details(?! open)", "<details open", section.content)))
