"""Verdicts on the piers of both studies."""

from rockbatch.report.document import Section
from rockbatch.report.markup import join, tag
from rockbatch.report.pair import SIDES, Pair
from rockbatch.report.sections import verdicts


def section(pair: Pair) -> Section:
    """Report the answer of each study, and every check in every case."""
    parts: list[object] = []
    for name, study, judged in zip(SIDES, pair.studies, pair.verdicts, strict=True):
        parts += [tag("h3", name), tag("div", verdicts.answer(judged, study))]
        if judged:
            parts += [verdicts.legend(), verdicts.matrix(judged)]
    return Section("Does it pass", "checks", join(*parts))
