"""The pages: their sections, in order, one line each."""

from collections.abc import Callable

from rockbatch._version import __version__
from rockbatch.report.compared import (
    answer as compared_answer,
)
from rockbatch.report.compared import checks, difference, figures, inputs, only_in_one, pairs, studies, suites
from rockbatch.report.contents import Contents
from rockbatch.report.document import Section, document
from rockbatch.report.pair import Pair
from rockbatch.report.sections import (
    accuracy,
    answer,
    distribution,
    estimate,
    forces,
    fragility,
    ground_motions,
    histories,
    intensity,
    notes,
    peak_rotations,
    peaks,
    published,
    reproduce,
    sensitivity,
    spectrum,
    statistics,
    studied,
    target,
    unusable,
    verdicts,
)

SECTIONS: tuple[Callable[[Contents], Section | None], ...] = (
    answer.section,
    peak_rotations.section,
    verdicts.section,
    published.section,
    peaks.section,
    forces.section,
    statistics.section,
    distribution.section,
    intensity.section,
    estimate.section,
    fragility.section,
    spectrum.section,
    sensitivity.section,
    histories.section,
    studied.section,
    target.section,
    ground_motions.section,
    unusable.section,
    accuracy.section,
    notes.section,
    reproduce.section,
)
"""Sections of one folder, from ``sections/``, in the order of the page: the answer first, then results, then inputs."""

SECTIONS_OF_TWO: tuple[Callable[[Pair], Section | None], ...] = (
    compared_answer.section,
    checks.section,
    inputs.section,
    figures.section,
    pairs.section,
    suites.section,
    only_in_one.section,
    studies.section,
    difference.section,
)
"""Sections of two folders, from ``compared/``, in the order of the page."""


def page(contents: Contents) -> str:
    """Return the report of one folder as HTML."""
    title = contents.study["title"] or "Rocking piers"
    made = __version__ if contents.finished is None else contents.finished.info["rockbatch"]
    return document("Rocking response of stepping piers", title, [section(contents) for section in SECTIONS], made)


def comparison(pair: Pair) -> str:
    """Return the page that compares two studies as HTML."""
    a, b = (study.info["study"]["title"] or study.saved.directory.name for study in pair.studies)
    title = f"{a} against {b}" if a != b else f"{a}: two studies"
    sections = [section(pair) for section in SECTIONS_OF_TWO]
    made = " and ".join(dict.fromkeys(study.info["rockbatch"] for study in pair.studies))
    return document("Rocking response of stepping piers, two studies", title, sections, made)
