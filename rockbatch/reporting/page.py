"""The pages: their sections, in order, one line each."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

from rockbatch.common.analyses import doors, from_analysis
from rockbatch.common.version import __version__
from rockbatch.reporting import compared
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.finished_analysis import Contents
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.pair import Pair
from rockbatch.reporting.sections import (
    answer,
    cost,
    distribution,
    forces,
    histories,
    intensity,
    motions,
    peak_rotations,
    peaks,
    published,
    shocks,
    statics,
    statistics,
    studied,
    target,
    verdicts,
)  # fmt: skip
from rockbatch.reporting.templates import Section, document, render


class Part(NamedTuple):
    """A section in the list of a page."""

    heading: str
    anchor: str
    content: Callable[[Any], Markup]
    """Function that returns what stands under the heading; empty if the section does not apply, which is then left out."""
    kind: type = Finished
    """Argument of ``content``: the results of a run, or the contents of any folder."""


def _template(name: str) -> Callable[[Contents], Markup]:
    """Return the content of a section that is a template alone."""
    return lambda contents: render(f"reporting/sections/{name}.html", contents=contents)


def _of_analyses() -> Iterator[Part]:
    """Yield the parts that the analyses bring, each loaded when it is drawn."""
    for name, door in doors().items():
        for part in door.parts:
            yield Part(part.heading, part.anchor, partial(_of_analysis, name, part.function), Contents)


def _of_analysis(name: str, function: str, contents: Contents) -> Markup:
    content: Markup = from_analysis(name, function)(contents)
    return content


PARTS = (
    Part("The answer", "answer", answer.section),
    Part("Peak rotations", "figure", peak_rotations.section),
    Part("Every check", "checks", verdicts.section),
    Part("Compared with published values", "references", published.section),
    Part("Every run", "peaks", peaks.section),
    Part("Shock by shock", "shocks", shocks.section),
    Part("Forces", "forces", forces.section),
    Part("The suite in each case", "suite", statistics.section),
    Part("One record and the suite", "distribution", distribution.section),
    Part("Intensity measures", "intensity", intensity.section),
    *_of_analyses(),
    Part("Histories", "histories", histories.section),
    Part("What was studied", "studied", studied.section),
    Part("Statics", "statics", statics.section),
    Part("The suite against its target spectrum", "target", target.section),
    Part("Ground motions", "records", motions.section),
    Part("Not used", "unusable", motions.unusable),
    Part("Speed and error", "accuracy", cost.section),
    Part("Notes", "notes", _template("notes"), Contents),
    Part("How to reproduce", "reproduce", _template("reproduce")),
)
"""Sections of one folder, from ``sections/``, in the order of the page: the answer first, then results, then inputs."""

ALONE = Part("The study file", "study", _template("study"), Contents)
"""The section that stands at the end if the folder has analyses only."""

PARTS_OF_TWO = (
    Part("The answer", "answer", compared.answer),
    Part("Does it pass", "checks", compared.checks),
    Part("What differs in the inputs", "inputs", compared.inputs),
    Part("Peak rotations", "figure", compared.figures),
    Part("Every pair of runs", "peaks", compared.pairs),
    Part("The suite in each case", "suite", compared.suites),
    Part("Only in one", "only", compared.only_in_one),
    Part("What is compared", "studied", compared.studies),
    Part("How the study files differ", "difference", compared.difference),
)
"""Sections of two folders, from ``compared.py``, in the order of the page."""


def sections(contents: Contents) -> list[Section]:
    """Return the sections of one folder that apply."""
    parts = PARTS if isinstance(contents, Finished) else (*PARTS, ALONE)
    drawn = [
        Section(part.heading, part.anchor, part.content(contents)) for part in parts if isinstance(contents, part.kind)
    ]
    return [section for section in drawn if section.content]


def page(contents: Contents) -> str:
    """Return the report of one folder as HTML."""
    version = contents.info["rockbatch"] if isinstance(contents, Finished) else __version__
    title = contents.study["title"] or "Rocking piers"
    return document("Rocking response of stepping piers", title, sections(contents), version)


def comparison(pair: Pair) -> str:
    """Return the page that compares two studies as HTML."""
    a, b = (study.study["title"] or study.directory.name for study in pair.studies)
    versions = " and ".join(dict.fromkeys(study.info["rockbatch"] for study in pair.studies))
    shown = [Section(part.heading, part.anchor, part.content(pair)) for part in PARTS_OF_TWO]
    title = f"{a} against {b}" if a != b else f"{a}: two studies"
    return document("Rocking response of stepping piers, two studies", title, shown, versions)
