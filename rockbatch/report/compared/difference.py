"""Differences between the study files, line by line, and between versions."""

import difflib

from rockbatch.report.document import Section
from rockbatch.report.markup import join, tag
from rockbatch.report.pair import Pair


def section(pair: Pair) -> Section:
    """Show the differing lines of the study files."""
    texts = [study.info["study"]["text"].splitlines() for study in pair.studies]
    lines = list(difflib.unified_diff(texts[0], texts[1], "A", "B", n=1, lineterm=""))
    versions = [
        " ".join(
            f"{name} {version}" for name, version in {"rockbatch": s.info["rockbatch"], **s.info["versions"]}.items()
        )
        for s in pair.studies
    ]
    differing = tag("p", f"Versions: A {versions[0]}; B {versions[1]}.") if versions[0] != versions[1] else ""
    shown = tag("pre", tag("code", "\n".join(lines))) if lines else tag("p", "The study files are the same.")
    return Section("How the study files differ", "difference", join(shown, differing))
