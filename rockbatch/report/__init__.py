"""The report of finished results: one HTML file that needs nothing else. Never loads the compiler."""

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

from rockbatch.checks import read_verdicts
from rockbatch.files import write_whole
from rockbatch.report.contents import Contents, read
from rockbatch.report.finished import read as read_finished
from rockbatch.report.page import comparison, page
from rockbatch.report.pair import pair
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
    write_whole(target, page(read(directory, responses)))
    return target


def write_comparison(first: Path, second: Path, *, out: Path | None = None) -> Path:
    """Write one page that sets two studies against each other, run by run, and return its path.

    ``out`` is ``compare-NAME.html`` in the first folder by default, with the name of the second. Raises ``InputError``
    where results are missing or damaged.
    """
    first, second = Path(first), Path(second)
    target = out or first / f"compare-{second.resolve().name}.html"
    studies = read_finished(first), read_finished(second)
    verdicts = read_verdicts(first), read_verdicts(second)
    write_whole(target, comparison(pair(studies, verdicts)))
    return target


def write_analyses(directory: Path, study: Study) -> Path:
    """Write the report again with the analyses in it, if the folder holds results of the study; returns its path.

    Otherwise they get a page of their own, ``analyses.html``.
    """
    sha256 = hashlib.sha256(study.text.encode()).hexdigest()
    if _holds_results(directory, sha256):
        return write_report(directory)
    target = directory / "analyses.html"
    told = {"title": study.title, "notes": study.notes, "text": study.text, "sha256": sha256}
    write_whole(target, page(Contents(directory, told)))
    return target


def _holds_results(directory: Path, sha256: str) -> bool:
    try:
        info = json.loads((directory / "run.json").read_text(encoding="utf-8"))
        return bool(info["study"]["sha256"] == sha256) and (directory / "peaks.csv").exists()
    except (OSError, ValueError, KeyError, TypeError):
        return False
