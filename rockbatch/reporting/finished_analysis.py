"""Results of an analysis in a folder: NAME.json and its tables."""

import functools
import hashlib
import json
import warnings
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rockbatch.common.errors import EditedTable, InputError
from rockbatch.common.files import read_table, read_text, sha256_of
from rockbatch.common.lazy import pd
from rockbatch.common.showing import capital
from rockbatch.quantities.cases import Case
from rockbatch.quantities.labels import in_full
from rockbatch.reporting.labels import counted
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.results.labelled import Item

MOST_NAMES = 60

_DAMAGE = (KeyError, IndexError, TypeError, ValueError, AttributeError, ArithmeticError)
"""Exceptions raised while drawing an analysis whose files are damaged."""


@dataclass(frozen=True, eq=False)
class Contents:
    """A folder with its analyses, and its study's ``path``, ``title``, ``notes``, ``text`` and ``sha256``."""

    directory: Path
    study: Item

    def analysis(self, name: str) -> "FinishedAnalysis | None":
        """Return the analysis in NAME.json; None if it is missing or of another version of the study."""
        return read(self.directory, name, self.study["sha256"])


@dataclass(frozen=True)
class FinishedAnalysis:
    """A finished analysis: the contents of NAME.json, and its folder."""

    directory: Path
    info: Item

    def provenance(self) -> Markup:
        """Return the analysis's ground motions, up to 60 by name, and versions of packages as HTML; empty if it has neither."""
        motions = [str(motion["label"]) for motion in self.info.get("under", ())]
        versions = {"rockbatch": self.info["rockbatch"], **self.info["versions"]} if "versions" in self.info else {}
        parts = []
        if motions:
            more = f"; and {len(motions) - MOST_NAMES} more" if len(motions) > MOST_NAMES else ""
            parts.append(f"{counted(len(motions), 'ground motion')}: {'; '.join(motions[:MOST_NAMES])}{more}")
        if versions:
            parts.append(f"made with {', '.join(f'{name} {version}' for name, version in versions.items())}")
        sentences = ". ".join(map(capital, parts))
        return tag("p", sentences, ".", class_="legend") if parts else Markup("")

    def table(self, name: str, columns: Collection[str]) -> "pd.DataFrame | None":
        """Return a table of the analysis; None if NAME.json does not list it, or if it is empty, damaged or lacks a column.

        Warns with ``EditedTable`` if the table was changed after it was written.
        """
        if name not in self.info.get("files", []):
            return None
        path, noted = self.directory / name, self.info.get("digests", {}).get(name, {}).get("sha256")
        try:
            if noted and sha256_of(path) != noted:
                _warn_edited(path)
            table = read_table(path)
        except (OSError, ValueError):
            return None
        return table if len(table) and set(columns) <= set(table.columns) else None


def read(directory: Path, name: str, sha256: str) -> FinishedAnalysis | None:
    """Return the analysis ``name`` of a folder; None if missing, damaged or of a study without the digest ``sha256``.

    Warns with ``EditedTable`` if NAME.json was changed after it was written, or is damaged.
    """
    path = Path(directory) / f"{name}.json"
    try:
        info = json.loads(read_text(path))
        of_study = info["study"]["sha256"]
        intact = "sha256" not in info or info["sha256"] == digest_of(info)
    except FileNotFoundError:
        return None
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        of_study, intact = None, False
    if not intact:
        _warn_edited(path)
    return FinishedAnalysis(Path(directory), info) if of_study == sha256 else None


def digest_of(info: Item) -> str:
    """Return the SHA-256 of the contents of NAME.json except its own ``sha256``."""
    content = {key: value for key, value in info.items() if key != "sha256"}
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()


def _warn_edited(path: Path) -> None:
    """Warn that a file was changed after it was written."""
    message = f"{path}: edited or damaged since it was written; its readable parts are shown"
    warnings.warn(message, EditedTable, stacklevel=3)


def of_analysis(
    name: str, **tables: Collection[str]
) -> Callable[[Callable[..., Markup]], Callable[[Contents], Markup]]:
    """Decorate ``drawn(analysis, *tables)`` as a section of the analysis ``name``; empty if it has none or lacks a table.

    ``tables`` gives the columns each table needs. A sentence stands in place of the section if NAME.json lists a table that
    cannot be used. The section raises ``InputError`` if NAME.json and its tables are
    inconsistent, or if arithmetic on their numbers overflows.
    """

    def section_of(drawn: Callable[..., Markup]) -> Callable[[Contents], Markup]:
        @functools.wraps(drawn)
        def section(contents: Contents) -> Markup:
            try:
                analysis = contents.analysis(name)
                if analysis is None:
                    return Markup("")
                files = {f"{table}.csv": columns for table, columns in tables.items()}
                by_file = {file: analysis.table(file, columns) for file, columns in files.items()}
                if lacking := [file for file, table in by_file.items() if table is None]:
                    listed = [file for file in lacking if file in analysis.info.get("files", ())]
                    return _again(name, f"{', '.join(listed)}: edited or damaged") if listed else Markup("")
                with np.errstate(divide="raise", over="raise", invalid="raise"):
                    return drawn(analysis, *by_file.values())
            except InputError:
                raise
            except _DAMAGE as error:
                fault = f"do not fit each other, or are damaged ({type(error).__name__}: {error})"
                raise InputError(f"{name}.json and its tables {fault}; start `rockbatch {name}` again") from error

        return section

    return section_of


def of_earlier_version(name: str) -> Markup:
    """Return what stands in place of a section of the analysis ``name`` whose files an earlier version wrote."""
    return _again(name, "Of an earlier version")


def _again(name: str, fault: str) -> Markup:
    return tag("p", tag("span", f"{fault}; run `rockbatch {name}` again.", class_="undecided"))


def answered(*paragraphs: str, remarks: Iterable[str] = ()) -> Markup:
    """Return paragraphs that state the result of an analysis, with a line for each remark below."""
    lines = (tag("p", tag("span", remark, class_="undecided")) for remark in remarks)
    return join(*(tag("p", paragraph, class_="lead") for paragraph in paragraphs), *lines)


def sentence(said: str, left_open: Iterable[str] = ()) -> Markup:
    """Return a sentence, its reservations behind it after semicolons, marked as undecided, and a full stop at the end."""
    return join(said, *(join("; ", tag("span", words, class_="undecided")) for words in left_open), ".")


def named(info: Item, values: Mapping[str, object], shown: Sequence[str]) -> str:
    """Return the name of a case with its values of the keys ``shown``, without NaN: "pads: β = 40".

    ``info``, the content of NAME.json, supplies the exponent in a viscous damper's unit.
    """
    columns = {key: values[key] for key in shown if key != "case" and values[key] == values[key]}
    return in_full(str(values["case"]), columns, case_of(info, values["case"], columns))


def case_of(info: Item, name: object, columns: Mapping[str, object]) -> Case | None:
    """Return the entry of a case in NAME.json, with these varied values; None if an earlier version wrote the file."""
    entry = next((case for case in info.get("cases", ()) if case["case"] == name), None)
    return entry and {**entry, "columns": columns}
