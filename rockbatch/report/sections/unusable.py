"""Files and runs that gave no result or were left out, with reasons."""

from rockbatch.report.contents import Contents
from rockbatch.report.document import Section
from rockbatch.report.finished import Finished
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.table import Head, table


def section(contents: Contents) -> Section | None:
    """List files and runs without a result, and those left out; None if everything was used."""
    finished = contents.finished
    if finished is None:
        return None
    parts = []
    if finished.info["unusable"] or (finished.runs["status"] == "failed").any():
        parts.append(_unusable(finished))
    if finished.info.get("left_out"):
        parts += [tag("h3", "Left out"), _left_out(finished)]
    return Section("Not used", "unusable", join(*parts)) if parts else None


def _unusable(finished: Finished) -> Markup:
    """List files and runs that gave no result, with reasons."""
    rows = [[entry["name"], "", entry["source"], entry["reason"]] for entry in finished.info["unusable"]]
    failed = finished.runs[finished.runs["status"] == "failed"]
    rows += [[finished.shown(run["record"]), finished.which(run), "", run["reason"]] for _, run in failed.iterrows()]
    return table([Head("record"), Head("case"), Head("file"), Head("why")], rows, prose=True, name="Not used")


def _left_out(finished: Finished) -> Markup:
    """List files and records that were left out on purpose, or are no records, with reasons."""
    rows = [[entry["name"], entry["source"], entry["reason"]] for entry in finished.info["left_out"]]
    return table([Head("record"), Head("file"), Head("why")], rows, prose=True, name="Left out")
