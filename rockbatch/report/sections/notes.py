"""Notes of the study file."""

from rockbatch.report.contents import Contents
from rockbatch.report.document import Section, paragraphs


def section(contents: Contents) -> Section | None:
    """Return the notes of the study, paragraph by paragraph; None if it has none."""
    notes = paragraphs(*(part.strip() for part in (contents.study["notes"] or "").split("\n\n")))
    return Section("Notes", "notes", notes) if notes else None
