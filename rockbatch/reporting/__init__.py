"""The report of finished results: one self-contained HTML file. Never loads the compiler."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from rockbatch.checks import as_table
from rockbatch.checks.verdicts import CHECKS
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError, NotFound
from rockbatch.common.files import made_folder, write_output, write_whole
from rockbatch.common.grouping import closest
from rockbatch.common.lazy import pd
from rockbatch.common.naming import chosen
from rockbatch.common.showing import shown
from rockbatch.outcome.response import Response
from rockbatch.quantities.cases import names_along
from rockbatch.reporting.finished import Finished, read
from rockbatch.reporting.finished_analysis import Contents
from rockbatch.reporting.margins import headline
from rockbatch.reporting.page import comparison, page
from rockbatch.reporting.pair import Pair, pair
from rockbatch.reporting.pdf import installed
from rockbatch.reporting.sections.statement.statements import statements
from rockbatch.reporting.sheet import sheet_of
from rockbatch.results.opened import Results
from rockbatch.results.reading import ANALYSES_PAGE
from rockbatch.results.run_json import describe_study, is_of
from rockbatch.study import Study

REPORT, SHEET, SHEET_PDF = "report.html", "sheet.html", "sheet.pdf"

__all__ = ["REPORT", "Report", "report", "statement", "write_analyses", "write_report"]


def write_report(
    directory: Path,
    responses: Sequence[Response] | None = None,
    saved: Results | None = None,
) -> Path:
    """Write the report of the results in ``directory`` into ``report.html`` beside them; return its path.

    ``directory`` holds ``peaks.csv`` and ``run.json`` as written by ``rockbatch run``; pass ``saved`` if they were read already.
    Histories (``responses`` instead of ``histories.h5``, if given), verdicts and the measurement of ``rockbatch accuracy`` are
    shown if they exist. An earlier report is replaced completely or not at all.

    Raises ``InputError`` if the results are missing, damaged or do not belong together.
    """
    return _write(read(Path(directory), responses, saved))


def write_analyses(directory: Path, study: Study) -> Path:
    """Write the analyses of a folder into its report, or into ``analyses.html`` without results of ``study``; return the path."""
    description = describe_study(study)
    if is_of(directory, description["sha256"]):
        return write_report(directory)
    target = directory / ANALYSES_PAGE
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
    answer : str
        Which of two studies passes, and by how much; empty for one.
    pairs : dict
        Cases of the second study by those of the first with which they are compared, if it was asked for.
    pdf : Path or None
        The calculation sheet as PDF, if it was written.
    paper : str
        Size of the PDF's pages: "A4" or "Letter".
    """

    path: Path
    folders: tuple[Path, ...]
    peaks: "pd.DataFrame"
    checks: "pd.DataFrame"
    is_sheet: bool = False
    answer: str = ""
    pairs: Mapping[str, str] = field(default_factory=dict)
    pdf: Path | None = None
    paper: str = "A4"

    def __repr__(self) -> str:
        return f"<{'sheet' if self.is_sheet else 'report'} of {' and '.join(map(str, self.folders))}: {self.path}>"

    def save(self, folder: str | os.PathLike[str]) -> Path:
        """Write the page, made anew from the results, into ``folder`` under its present name; return its path.

        Of a sheet this is the HTML or the PDF alone, as ``path`` is; sections are folded as by default.
        """
        directory = made_folder(Path(folder))
        contents, target = _contents(self.folders, self.pairs), directory / self.path.name
        if isinstance(contents, Finished) and self.is_sheet:
            return _write_sheet(contents, target, self.paper)[0]
        return _write(contents, target)


@checked
def report(
    directory: str | os.PathLike[str],
    other: str | os.PathLike[str] | None = None,
    *,
    out: str | os.PathLike[str] | None = None,
    whole: bool = False,
    sheet: bool = False,
    paper: Literal["A4", "Letter"] = "A4",
    pairs: Mapping[str, str] | None = None,
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
        Whether to write the calculation sheet instead, for paper, of one study only: ``sheet.html`` in the folder and, where
        typst is installed, ``sheet.pdf``; or ``out`` alone, a PDF if its name ends in ``.pdf``.
    paper : {"A4", "Letter"}, optional
        Size of the PDF's pages.
    pairs : dict, optional
        Cases of the second study by those of the first with which to compare them. By default cases of one name go together,
        and those that are left by the inputs that differ least.

    Returns
    -------
    Report
        With the tables ``peaks`` and ``checks``.

    Raises
    ------
    InputError
        If results are missing, damaged or do not belong together, a sheet of two studies is asked for, or a PDF without typst.

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
    contents = _contents(folders, pairs)
    if sheet and isinstance(contents, Pair):
        raise InputError(
            "a calculation sheet is of one study; write one for each folder, or compare the two without it"
        )
    target = None if out is None else Path(out)
    if sheet and isinstance(contents, Finished):
        path, pdf = _write_sheet(contents, target, paper)
    else:
        path, pdf = _write(contents, target, whole), None
    finished = contents.studies if isinstance(contents, Pair) else (contents,)
    tables = [(results.saved.peaks, as_table(results.verdicts)) for results in finished]
    peaks, checks = (_stacked(of_studies) for of_studies in zip(*tables, strict=True))
    answer = headline(contents) if isinstance(contents, Pair) else ""
    return Report(path, folders, peaks, checks, sheet, answer, dict(pairs or {}), pdf, paper)


@checked
def statement(directory: str | os.PathLike[str], case: str | None = None) -> str:
    """Return a statement on each case of finished results, for a calculation file: a paragraph each, with empty lines between.

    A statement says whether the case passes, under which motions and bounds it was run, what each check came to by which limit
    and record, what is assumed and what is not covered. It is on the report and on the calculation sheet, too.

    Parameters
    ----------
    directory : path
        A folder that ``rockbatch run``, or :func:`rockbatch.run` with ``out``, has written.
    case : str, optional
        Name of the case, or a glob of names; by default all cases.

    Returns
    -------
    str

    Raises
    ------
    InputError
        If results are missing, damaged or do not belong together; ``NotFound`` if there is no such case.

    Examples
    --------
    >>> print(rb.statement("reports/pier4", case="pads"))
    Case "pads" meets its only check, but is not decided: no check limits its mean settlement, residual tilt, ductility. ...
    """
    finished = read(Path(directory), ())
    names = names_along(finished.info["cases"])
    if unknown := {verdict.case for verdict in finished.verdicts if verdict.case} - {*names}:
        text = (
            f"has verdicts on case {shown(min(unknown))}, which run.json does not list; start `rockbatch check` again"
        )
        raise InputError(f"{finished.directory / CHECKS}: {text}")
    wanted = names if case is None else chosen(case, names)
    if not wanted:
        nearest = closest(str(case), names)
        instead = f"did you mean {shown(nearest)}?" if nearest else f"there is {', '.join(map(shown, names))}"
        raise NotFound(f"case {shown(case)}: there is no such case; {instead}")
    paragraphs = [said.text for said in statements(finished) if said.case in wanted]
    return "\n\n".join(paragraphs or ["No ground motion could be used: there are no results."])


def _contents(folders: Sequence[Path], pairs: Mapping[str, str] | None) -> Finished | Pair:
    """Read the results of one folder, or of two without their histories, which a comparison does not show.

    Raises ``InputError`` for ``pairs`` with one folder.
    """
    if len(folders) == 1:
        if pairs:
            raise InputError("cases are paired between two folders; give the second one, too")
        return read(Path(folders[0]))
    first, second = (read(Path(folder), ()) for folder in folders)
    return pair(first, second, pairs)


def _write(contents: Finished | Pair, out: Path | None = None, whole: bool = False) -> Path:
    """Write the report of one folder or the comparison of two, to ``out`` or into the first folder; return its path."""
    if isinstance(contents, Pair):
        first, second = (study.directory for study in contents.studies)
        content, target = comparison(contents, whole), first / f"compare-{second.resolve().name}.html"
    else:
        content, target = page(contents, whole), contents.directory / REPORT
    (write_output if out else write_whole)(out or target, content)
    return out or target


def _write_sheet(contents: Finished, out: Path | None, paper: str) -> tuple[Path, Path | None]:
    """Write the calculation sheet of one folder; return its path, and that of its PDF or None.

    To ``out``, a PDF if its name ends in ".pdf"; without it as HTML into the folder, and as PDF where that can be made.
    """
    sheet = sheet_of(contents)
    if out is not None:
        is_pdf = out.suffix.lower() == ".pdf"
        write_output(out, sheet.pdf(paper) if is_pdf else sheet.html())
        return out, out if is_pdf else None
    path, pdf = contents.directory / SHEET, contents.directory / SHEET_PDF
    write_whole(path, sheet.html())
    if not installed():
        return path, None
    write_whole(pdf, sheet.pdf(paper))
    return path, pdf


def _stacked(tables: "Sequence[pd.DataFrame]") -> "pd.DataFrame":
    """Return a single table unchanged; stack two under a first column ``study``, "A" or "B"."""
    if len(tables) == 1:
        return tables[0]
    return pd.concat(dict(zip("AB", tables, strict=True)), names=["study"]).reset_index("study").reset_index(drop=True)
