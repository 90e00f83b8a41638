"""The sections of what other commands than ``rockbatch run`` found about a study."""

import hashlib
import json
from pathlib import Path

from rockbatch.files import write_whole
from rockbatch.report import fragility, sensitivity, spectrum
from rockbatch.report.document import Section, document, paragraphs
from rockbatch.report.markup import tag
from rockbatch.study import Study


def sections(directory: Path, sha256: str | None) -> list[Section]:
    """A section for each analysis in the folder that is of the study with the digest ``sha256``; empty for others."""
    return [
        Section("Fragility", "fragility", fragility.section(directory, sha256)),
        Section("Rocking spectra and overturning", "spectrum", spectrum.section(directory, sha256)),
        Section("What the answer hangs on", "sensitivity", sensitivity.section(directory, sha256)),
    ]


def write(directory: Path, study: Study) -> Path:
    """Write the report again with the analyses in it, if the folder holds results of the study; returns its path.

    Otherwise they get a page of their own, ``analyses.html``.
    """
    from rockbatch.report import write_report  # which needs this module for its page

    sha256 = hashlib.sha256(study.text.encode()).hexdigest()
    if _holds_results(directory, sha256):
        return write_report(directory)
    target = directory / "analyses.html"
    pages = [
        Section("Notes", "notes", paragraphs(*(part.strip() for part in study.notes.split("\n\n")))),
        *sections(directory, sha256),
        Section("The study file", "study", tag("pre", tag("code", study.text))),
    ]
    write_whole(target, document("Rocking response of stepping piers", study.title, pages))
    return target


def _holds_results(directory: Path, sha256: str) -> bool:
    try:
        info = json.loads((directory / "run.json").read_text(encoding="utf-8"))
        return bool(info["study"]["sha256"] == sha256) and (directory / "peaks.csv").exists()
    except (OSError, ValueError, KeyError, TypeError):
        return False
