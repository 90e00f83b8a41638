"""The report of finished results: one HTML file that needs nothing else. Never loads the compiler."""

from collections.abc import Sequence
from pathlib import Path

from rockbatch.files import write_whole
from rockbatch.report import accuracy
from rockbatch.report.finished import read
from rockbatch.report.page import page
from rockbatch.response import Response

__all__ = ["write_report"]


def write_report(directory: Path, responses: Sequence[Response] = ()) -> Path:
    """Write ``report.html`` beside the results it tells of.

    Parameters
    ----------
    directory : Path
        Folder with ``peaks.csv`` and ``run.json``, as ``rockbatch run`` leaves them; what ``rockbatch accuracy``
        measured for the same study is shown where its ``accuracy.csv`` is there too.
    responses : sequence of Response
        Runs whose histories are shown, as in Figs. 5 and 6 of Palmeri & Makris (2007).

    Returns
    -------
    Path of the report. An earlier one is replaced as a whole, or not at all.

    Raises ``InputError`` where the two files are missing, damaged or do not belong together.
    """
    directory = Path(directory)
    target = directory / "report.html"
    finished = read(directory)
    levels = accuracy.read(directory / "accuracy.csv", finished.info["study"]["sha256"])
    write_whole(target, page(finished, responses, levels))
    return target
