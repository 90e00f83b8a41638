"""The report of finished results: one self-contained HTML file. Never loads the compiler."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rockbatch.checks import as_table
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.files import made_folder, write_output, write_whole
from rockbatch.common.lazy import pd
from rockbatch.outcome.response import Response
from rockbatch.reporting.finished import Finished, read
from rockbatch.reporting.finished_analysis import Contents
from rockbatch.reporting.page import comparison, page
from rockbatch.reporting.pair import pair
from rockbatch.reporting.sheet import sheet as sheet_of
from rockbatch.results.opened import Results
from rockbatch.results.run_json import describe_study, is_of
from rockbatch.study import Study

REPORT, SHEET = "report.html", "sheet.html"

__all__ = ["REPORT", "Report", "report", "write_analyses", "write_comparison", "write_report"]


def write_report(
    directory: Path,
    responses: Sequence[Response] | None = None,
    *,
    out: Path | None = None,
    saved: Results | None = None,
    whole: bool = False,
) -> Path:
    """Write the report of the results in ``directory`` to ``out``, by default ``report.html`` beside them; return its path.

    ``directory`` holds ``peaks.csv`` and ``run.json`` as written by ``rockbatch run``; pass ``saved`` if they were read already.
    Histories (``responses`` instead of ``histories.h5``, if given), verdicts and the measurement of ``rockbatch accuracy`` are
    shown if they exist. With ``whole`` folded sections are printed, too. An earlier report is replaced completely or not at all.

    Raises ``InputError`` if the results are missing, damaged or do not belong together.
    """
    return _write([read(Path(directory), responses, saved)], out, whole)


def write_comparison(first: Path, second: Path, *, out: Path | None = None, whole: bool = False) -> Path:
    """Write one page that compares two studies run by run; return its path.

    ``out`` defaults to ``compare-NAME.html`` in the first folder, NAME being the second folder's. Raises ``InputError``
    if results are missing or damaged.
    """
    return _write([read(Path(first), ()), read(Path(second), ())], out, whole)


def write_analyses(directory: Path, study: Study) -> Path:
    """Write the analyses of a folder into its report, or into ``analyses.html`` without results of ``study``; return the path."""
    description = describe_study(study)
    if is_of(directory, description["sha256"]):
        return write_report(directory)
    target = directory / "analyses.html"
    write_whole(target, page(Contents(directory, description)))
    return target


@dataclass(frozen=True, eq=False, repr=False)
class Report:
    """A written page and the tables it shows.

    Attributes
    ----------
    path : Path
        The page.
    folders : tuple of Path
        The one or two folders of results.
    peaks, checks : DataFrame
        The rows of ``peaks.csv`` and ``checks.csv``; for two studies with a first column ``study``, "A" or "B".
    is_sheet : bool
        Whether the page is the calculation sheet.
    """

    path: Path
    folders: tuple[Path, ...]
    peaks: "pd.DataFrame"
    checks: "pd.DataFrame"
    is_sheet: bool = False

    def __repr__(self) -> str:
        return f"<{'sheet' if self.is_sheet else 'report'} of {' and '.join(map(str, self.folders))}: {self.path}>"

    def save(self, folder: str | os.PathLike[str]) -> Path:
        """Write the page into ``folder`` under its present name; return its path."""
        directory = made_folder(Path(folder))
        return _write(_finished(self.folders), directory / self.path.name, sheet=self.is_sheet)


@checked
def report(
    directory: str | os.PathLike[str],
    other: str | os.PathLike[str] | None = None,
    *,
    out: str | os.PathLike[str] | None = None,
    whole: bool = False,
    sheet: bool = False,
) -> Report:
    """Write the report of finished results again, or of two studies side by side.

    Parameters
    ----------
    directory : path
        A folder that ``rockbatch run``, or :func:`rockbatch.run` with ``out``, has written.
    other : path, optional
        A second folder, to compare with the first.
    out : path, optional
        File to write, or "-" for the standard output, as on the command line; by default ``report.html`` in the folder, or
        ``compare-OTHER.html``.
    whole : bool, optional
        Whether sections that are folded on the screen are unfolded, and printed.
    sheet : bool, optional
        Whether to write the calculation sheet instead, for paper: ``sheet.html`` in the folder, of one study only.

    Returns
    -------
    Report
        With the tables ``peaks`` and ``checks``.

    Raises
    ------
    InputError
        If results are missing, damaged or do not belong together, or a sheet of two studies is asked for.

    Examples
    --------
    >>> table = rb.run("pier4.toml", out="reports/pier4")
    >>> rb.report("reports/pier4")
    <report of reports/pier4: reports/pier4/report.html>
    >>> rb.report("reports/pier4", "reports/pier4", out="both.html").peaks["study"].value_counts()
    study
    A    4
    B    4
    Name: count, dtype: int64
    """
    folders = (Path(directory),) if other is None else (Path(directory), Path(other))
    if sheet and other is not None:
        raise InputError(
            "a calculation sheet is of one study; write one for each folder, or compare the two without it"
        )
    finished = _finished(folders)
    path = _write(finished, None if out is None else Path(out), whole, sheet)
    tables = [(results.saved.peaks, as_table(results.verdicts)) for results in finished]
    peaks, checks = (_stacked(of_studies) for of_studies in zip(*tables, strict=True))
    return Report(path, folders, peaks, checks, sheet)


def _finished(folders: Sequence[Path]) -> list[Finished]:
    """Read the results of one folder, or of two without their histories, which a comparison does not show."""
    return [read(folder, () if len(folders) > 1 else None) for folder in folders]


def _write(finished: Sequence[Finished], out: Path | None, whole: bool = False, sheet: bool = False) -> Path:
    """Write the report or sheet of one folder or the comparison of two, to ``out`` or into the first folder; return its path."""
    if sheet:
        content, target = sheet_of(finished[0]), finished[0].directory / SHEET
    elif len(finished) > 1:
        content = comparison(pair(*finished), whole)
        target = finished[0].directory / f"compare-{finished[1].directory.resolve().name}.html"
    else:
        content, target = page(finished[0], whole), finished[0].directory / REPORT
    (write_output if out else write_whole)(out or target, content)
    return out or target


def _stacked(tables: "Sequence[pd.DataFrame]") -> "pd.DataFrame":
    """Return a single table unchanged; stack two under a first column ``study``, "A" or "B"."""
    if len(tables) == 1:
        return tables[0]
    return pd.concat(dict(zip("AB", tables, strict=True)), names=["study"]).reset_index("study").reset_index(drop=True)
