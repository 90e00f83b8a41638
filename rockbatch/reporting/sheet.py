"""The calculation sheet: the values of the report in a layout for paper, of A4 or Letter, with nothing folded or cut off."""

import re
from dataclasses import dataclass

from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.page import STUDY_FILE, Part, of_analyses, of_observers
from rockbatch.reporting.pdf import compiled, frame
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
from rockbatch.reporting.typeset import Setting, blocks, parsed, words

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
    STUDY_FILE,
)


@dataclass(frozen=True)
class Sheet:
    """The calculation sheet of one folder."""

    # title and path of the study file
    title: str
    path: str
    version: str  # version and commit of the rockbatch that computed the results, and the date
    sections: list[Section]  # those with content, with their folds open

    def html(self) -> str:
        """Return the sheet as HTML, which needs no script and prints on paper of any size from A5."""
        values = vars(self) | {"markers": markers(), "style": styles("style.css", "sheet.css")}
        return render("reporting/sheet.html", **values)

    def pdf(self, paper: str = "A4") -> bytes:
        """Return the sheet as PDF on ``paper``, "A4" or "Letter", ``KeyError`` for another; ``InputError`` without Typst."""
        setting = Setting({})
        sections = (
            f"\n= {place} {words(section.heading)}\n{blocks(parsed(section.content), setting)}"
            for place, section in enumerate(self.sections, start=1)
        )
        start = frame(self.title, (f"{self.title}: calculation sheet", self.version), self.path, "9.5pt", paper=paper)
        return compiled(start + _STYLE + "#title()\n" + "".join(sections), setting.pictures)


_STYLE = """
#set table(stroke: (x, y) => (bottom: 0.25pt + luma(200)), inset: (x: 3pt, y: 2pt))
#show table: set text(6.8pt)
#show table: set par(leading: 0.4em)
#show table.cell.where(y: 0): set text(gray.darken(50%))
#show raw: set text(size: 0.9em)
#show raw.where(block: true): it => text(6.5pt, columns(2, it))
"""


def sheet_of(finished: Finished) -> Sheet:
    """Return the calculation sheet of one folder: its sections with content, drawn for paper, with their folds open."""
    with on_paper():
        sections = [part.drawn(finished) for part in (*BEFORE, *of_observers(), *AFTER, *of_analyses())]
    info = finished.info
    commit = info["versions"].get("commit", "")
    version = f"rockbatch {info['rockbatch']}" + (f" ({commit})" if commit else "")
    return Sheet(
        info["study"]["title"] or "Rocking piers",
        info["study"]["path"],
        f"{version}, {str(info['created'])[:10]}",
        [_unfolded(section) for section in sections if section.content],
    )


def _unfolded(section: Section) -> Section:
    """Return a section with its folds open; words of a record cannot be mistaken for a fold, since they are escaped."""
    return section._replace(content=Markup(re.sub(r"<details(?! open)", '<details open=""', section.content)))
