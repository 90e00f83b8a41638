"""The report of finished results: one HTML file that needs nothing else. Never loads the compiler."""

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

from rockbatch.checks import read_verdicts
from rockbatch.files import write_whole
from rockbatch.report.compare import comparison
from rockbatch.report.document import Section, document, paragraphs
from rockbatch.report.finished import finished, read
from rockbatch.report.markup import tag
from rockbatch.report.page import page
from rockbatch.report.sections import accuracy, analyses
from rockbatch.results.opened import open_results
from rockbatch.results.response import Response
from rockbatch.study import Study

REPORT = "report.html"

__all__ = ["REPORT", "write_analyses", "write_comparison", "write_report"]


def write_report(directory: Path, responses: Sequence[Response] | None = None, *, out: Path | None = None) -> Path:
    """Write ``report.html`` beside the results it tells of.

    Parameters
    ----------
    directory : Path
        Folder with ``peaks.csv`` and ``run.json``, as ``rockbatch run`` leaves them. Histories, verdicts and what
        ``rockbatch accuracy`` measured are shown where ``histories.h5``, ``checks.csv`` and ``accuracy.csv`` are there.
    responses : sequence of Response, optional
        Runs whose histories are shown instead of those in ``histories.h5``.
    out : Path, optional
        File to write instead.

    Returns
    -------
    Path of the report. An earlier one is replaced as a whole, or not at all.

    Raises ``InputError`` where the results are missing, damaged or do not belong together.
    """
    directory = Path(directory)
    target = out or directory / REPORT
    results = open_results(directory)
    study = finished(results)
    levels = accuracy.read(directory / "accuracy.csv", study.info["study"]["sha256"])
    shown = results.responses if responses is None else responses
    write_whole(target, page(study, shown, levels, read_verdicts(directory)))
    return target


def write_comparison(first: Path, second: Path, *, out: Path | None = None) -> Path:
    """Write one page that sets two studies against each other, run by run, and return its path.

    ``out`` is ``compare-NAME.html`` in the first folder by default, with the name of the second. Raises ``InputError``
    where results are missing or damaged.
    """
    first, second = Path(first), Path(second)
    target = out or first / f"compare-{second.resolve().name}.html"
    write_whole(target, comparison((read(first), read_verdicts(first)), (read(second), read_verdicts(second))))
    return target


def write_analyses(directory: Path, study: Study) -> Path:
    """Write the report again with the analyses in it, if the folder holds results of the study; returns its path.

    Otherwise they get a page of their own, ``analyses.html``.
    """
    sha256 = hashlib.sha256(study.text.encode()).hexdigest()
    if _holds_results(directory, sha256):
        return write_report(directory)
    target = directory / "analyses.html"
    pages = [
        Section("Notes", "notes", paragraphs(*(part.strip() for part in study.notes.split("\n\n")))),
        *analyses.sections(directory, sha256),
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
