"""Both studies, and records that are not the same motion in both."""

import math

from rockbatch.report.document import Section, paragraphs
from rockbatch.report.finished import Finished
from rockbatch.report.labels import counted
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.pair import SIDES, Pair
from rockbatch.report.sections.answer import worst
from rockbatch.report.sections.studied import studied


def section(pair: Pair) -> Section:
    """Describe both studies."""
    parts: list[object] = [
        tag("p", f"{counted(len(pair.matched.runs[0]), 'pair')} of runs with the same ground motion and case name.")
    ]
    for name, study in zip(SIDES, pair.studies, strict=True):
        title = study.info["study"]["title"] or ""
        heading = join(f"{name}: {title} ", tag("code", study.saved.directory))
        parts += [tag("h3", heading), worst(study), studied(study, level="h4")]
    return Section("What is compared", "studied", join(*parts, paragraphs(_other_motions(*pair.studies))))


def _other_motions(a: Finished, b: Finished) -> Markup:
    """List records of one name that are not the same motion."""
    keys = ("pga_g", "pga_v_g", "npts", "dt_s")
    other = [
        name for name in a.records
        if name in b.records and any(not _same(a.records[name][key], b.records[name][key]) for key in keys)
    ]  # fmt: skip
    if not other:
        return Markup("")
    listed = ", ".join(other[:8]) + (f" and {len(other) - 8} more" if len(other) > 8 else "")
    return join(tag("span", "Not the same motion in both", class_="alarm"), f", though of one name: {listed}.")


def _same(a: float | None, b: float | None) -> bool:
    return a is b if a is None or b is None else math.isclose(a, b, rel_tol=1e-9)
