"""The pages of the report: a line for each section, in order."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

from rockbatch.common.analyses import doors, from_analysis
from rockbatch.common.observers import from_observer, report_parts
from rockbatch.reporting import compared
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.finished_analysis import Contents
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.overview import by_foundation
from rockbatch.reporting.pair import Pair
from rockbatch.reporting.sections import (
    answer,
    assumptions,
    devices,
    distribution,
    histories,
    motions,
    peaks,
    published,
    reproduce,
    statement,
    statics,
    statistics,
    studied,
    target,
    verdicts,
)
from rockbatch.reporting.sections.studied import in_a_line
from rockbatch.reporting.templates import Section, document, render


class Part(NamedTuple):
    """A section in the list of a page."""

    heading: str
    anchor: str
    content: Callable[..., Markup]
    """Function that draws the section's body; the section is left out if it returns nothing."""
    folded: bool = False
    kind: type = Finished
    """Type of the argument of ``content``: results of a run, or contents of any folder."""

    def drawn(self, contents: Contents | Pair) -> Section:
        """Return the section of one folder, or of two."""
        return Section(self.heading, self.anchor, self.content(contents), self.folded)


def _template(name: str) -> Callable[[Contents], Markup]:
    """Return a function that renders a section made of a template alone."""
    return lambda contents: render(f"reporting/sections/{name}.html", contents=contents)


def of_analyses() -> Iterator[Part]:
    """Yield the sections of all analyses; their modules load when a section is drawn."""
    for name, door in doors().items():
        for part in door.parts:
            yield Part(part.heading, part.anchor, partial(_of_analysis, name, part.function), kind=Contents)


def _of_analysis(name: str, function: str, contents: Contents) -> Markup:
    """Return a section of an analysis; empty, without loading its modules, if the folder has no files of it."""
    if not any((contents.directory / f"{name}.{kind}").exists() for kind in ("json", "csv")):
        return Markup("")
    content: Markup = from_analysis(name, function)(contents)
    return content


def of_observers(behind: str | None = None) -> Iterator[Part]:
    """Yield the sections of observers, all or those that stand behind an anchor; their modules load when a section is drawn."""
    for name, part in report_parts():
        if behind in (None, part.behind):
            yield Part(part.heading, part.anchor, partial(_of_observer, name, part.function), part.folded)


def _of_observer(name: str, function: str, finished: Finished) -> Markup:
    """Return the section of an observer, empty if it has nothing to show."""
    content: Markup = from_observer(name, function)(finished)
    return content


_OWN = (
    Part("Scorecard", "answer", answer.section),
    Part("Under each bound", "bounds", verdicts.under_each_bound),
    Part("Greatest responses", "responses", answer.responses_beside_checks, folded=True),
    Part("Peaks by foundation", "figure", by_foundation),
    *of_analyses(),
    Part("Every run", "peaks", peaks.section),
    Part("Checks", "checks", verdicts.section),
    Part("Statement for the calculation file", "statement", statement.section, folded=True),
    Part("Compared with published values", "references", published.section),
    Part("Devices", "devices", devices.section),
    Part("Histories", "histories", histories.section),
    Part("Statistics of the suite", "suite", statistics.section, folded=True),
    Part("One record and the suite", "distribution", distribution.section, folded=True),
    Part("What was studied", "studied", studied.section),
    Part("What is assumed", "assumptions", assumptions.section),
    Part("Statics", "statics", statics.section, folded=True),
    Part("Ground motions", "records", motions.section),
    Part("The suite against its target spectrum", "target", target.section),
    Part("Not used", "unusable", motions.unusable),
    Part("Notes", "notes", _template("notes"), kind=Contents),
    Part("How to reproduce", "reproduce", reproduce.section, folded=True),
)

PARTS = tuple(part for own in _OWN for part in (own, *of_observers(own.anchor)))
"""Sections of one folder, from ``sections/``, in the order of the page: the answer first, then results, then inputs."""

STUDY_FILE = Part("The study file", "study", _template("study"), kind=Contents)
"""Last section of a folder that has analyses only."""

PARTS_OF_TWO = (
    Part("The answer", "answer", compared.answer),
    Part("Does it pass", "checks", compared.checks),
    Part("What differs in the inputs", "inputs", compared.inputs),
    Part("Peak rotations", "figure", compared.figures),
    Part("Every pair of runs", "peaks", compared.pairs),
    Part("Statistics of the suite", "suite", compared.suites, folded=True),
    Part("Runs in one study only", "only", compared.only_in_one),
    Part("What is compared", "studied", compared.studies, folded=True),
    Part("How the study files differ", "difference", compared.difference),
)
"""Sections of a comparison, in the order of the page."""


def sections(contents: Contents) -> list[Section]:
    """Draw the sections of one folder, without empty ones: without results those of analyses, notes and the study file."""
    parts = PARTS if isinstance(contents, Finished) else (*PARTS, STUDY_FILE)
    drawn = (part.drawn(contents) for part in parts if isinstance(contents, part.kind))
    return [section for section in drawn if section.content]


def page(contents: Contents, whole: bool = False) -> str:
    """Return the report of one folder as HTML; with ``whole`` folded sections are unfolded and printed."""
    title = contents.study["title"] or "Rocking piers"
    if isinstance(contents, Finished):
        return document(title, in_a_line(contents), sections(contents), contents.info["rockbatch"], whole)
    return document(title, "", sections(contents), whole=whole)


def comparison(pair: Pair, whole: bool = False) -> str:
    """Return the page that compares two studies as HTML; with ``whole`` folded sections are unfolded and printed."""
    a, b = (study.study["title"] or study.directory.name for study in pair.studies)
    versions = " and ".join(dict.fromkeys(study.info["rockbatch"] for study in pair.studies))
    shown = [part.drawn(pair) for part in PARTS_OF_TWO]
    title = f"{a} against {b}" if a != b else f"{a}: two studies"
    return document(title, f"A: {pair.studies[0].directory}; B: {pair.studies[1].directory}", shown, versions, whole)
