"""Read a folder of results: ``peaks.csv`` and ``run.json``, each checked, then against each other."""

import csv
import json
import math
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rockbatch.common.arguments import checked
from rockbatch.common.errors import EditedTable, InputError, MissingColumns, NotFound, Problem, refuse
from rockbatch.common.files import (
    CHANGED,
    csv_plain,
    legible,
    opened,
    opened_text,
    read_text,
    sha256_of,
    sha256_of_lines,
)
from rockbatch.common.grouping import closest
from rockbatch.common.lazy import pd
from rockbatch.common.statuses import STATUSES
from rockbatch.common.version import __version__
from rockbatch.quantities.catalogue import COUNTS, FACTS, FIXED, TEXTS, TRAILING, UNBOUNDED, names
from rockbatch.quantities.rows import PEAKS
from rockbatch.results.columns import numbers_or_words
from rockbatch.results.labelled import Item
from rockbatch.results.run_json import INFO, SHAPE
from rockbatch.results.shape import unfit

ANALYSES_PAGE = "analyses.html"
"""Page of the analyses in a folder without runs."""

MOST_PROBLEMS = 20
MOST_COUNT = 1 << 53
"""Largest integer below which floats hold every integer."""


@dataclass(frozen=True, eq=False)
class Saved:
    """The results in a folder.

    Attributes
    ----------
    directory : Path
        The folder.
    info : dict
        ``run.json``.
    peaks : DataFrame
        ``peaks.csv`` with the types that ``rockbatch.run`` returns: missing texts are "", missing numbers NaN, missing
        counts <NA>; varied keys are numbers or texts.
    missing : tuple of str
        New columns, which the version that wrote the folder lacked: empty in ``peaks``.
    """

    directory: Path
    info: dict[str, Any]
    peaks: "pd.DataFrame"
    missing: tuple[str, ...] = ()

    @property
    def missing_in_words(self) -> str:
        """A predicate about the columns that ``peaks.csv`` lacks, "has no column x, …"; empty if it has all."""
        if not self.missing:
            return ""
        several = len(self.missing) > 1
        return (
            f"has no column{'s' if several else ''} {', '.join(self.missing)}, as an earlier version wrote it; "
            f"{'they count' if several else 'it counts'} as empty here; start `rockbatch run` again to have "
            f"{'them' if several else 'it'}"
        )


@checked
def read_saved(directory: Path) -> Saved:
    """Read the results that ``rockbatch run`` wrote into ``directory``.

    Raises ``InputError`` with every fault if a file is missing or damaged. Warns with ``MissingColumns`` for results of an
    earlier version, and with ``EditedTable`` for a table changed since.
    """
    directory = Path(directory)
    if directory.exists() and not directory.is_dir():
        folder = directory.parent if (directory.parent / INFO).exists() else Path("reports") / directory.stem
        raise InputError(f"{directory}: a file, not a folder of results; give the folder, such as {folder}")
    problems: list[Problem | str] = []
    info: dict[str, Any] = {}
    with _collecting_problems(problems):
        info = _read_info(directory / INFO)
    with _collecting_problems(problems):
        peaks = _read_peaks(directory / PEAKS, info.get("varied", []))
    if len(problems) == 2 and all(isinstance(problem, Problem) and problem.kind is NotFound for problem in problems):
        raise NotFound(f"{directory}: not there, or without results of `rockbatch run`; {_instead_of(directory)}")
    refuse([*problems, *_other_version(directory)] if problems else [])
    if unknown := {name for case in info["cases"] for name in case["columns"]} - set(info["varied"]):
        raise InputError(
            f"{directory / INFO}: cases vary {', '.join(sorted(unknown))}, which varied does not list; start `rockbatch run` "
            "again"
        )
    for name in info["varied"]:
        words = any(isinstance(case["columns"].get(name), str) for case in info["cases"])
        if not words and peaks[name].dtype != "float64":
            raise InputError(
                f"{directory / PEAKS}: {name} is a number in every case of {INFO}, and here it is not; the two files belong to "
                "different runs, or are damaged; start `rockbatch run` again"
            )
    if differs := edited(directory, info):
        warnings.warn(f"{directory / PEAKS}: {differs}; its present values are shown", EditedTable, stacklevel=2)
    missing = tuple(name for name in names(TRAILING) if name not in peaks)
    for name in missing:
        peaks[name] = "" if name in TEXTS else math.nan
    saved = Saved(directory, info, peaks, missing)
    if missing:
        warnings.warn(f"{directory / PEAKS}: {saved.missing_in_words}", MissingColumns, stacklevel=2)
    return saved


def _instead_of(directory: Path) -> str:
    """Return advice for a folder without runs: the page of its analyses if it has one, else a folder with runs of similar name.

    Without either it is to give a folder that has runs.
    """
    path = directory / ANALYSES_PAGE
    if path.exists():
        return f"its analyses are in {path}"
    beside = closest(directory.name, (each.parent.name for each in directory.parent.glob(f"*/{INFO}")))
    return f"did you mean {directory.parent / beside}?" if beside else "give a folder that it has written"


def _other_version(directory: Path) -> list[str]:
    """Return a sentence on the other version that wrote a folder, in a list; [] if it was this one or is unknown."""
    try:
        version = str(json.loads(read_text(directory / INFO))["rockbatch"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return []
    if version == __version__:
        return []
    writer = legible(version[:40])
    return [f"{directory}: written by rockbatch {writer}, but this is {__version__}: read it with that version"]


def edited(directory: Path, info: Item) -> str:
    """Return words if the digest of ``peaks.csv`` differs from that in ``info``; empty if equal, but for the ends of lines, or
    unknown."""
    noted, path = info.get("peaks"), directory / PEAKS
    if noted is None or noted["sha256"] in (sha256_of(path), sha256_of_lines(path)):
        return ""
    return f"not as `rockbatch run` wrote it, with {noted['rows']} rows: it was edited, or is damaged"


@contextmanager
def _collecting_problems(problems: list[Problem | str]) -> Iterator[None]:
    """Append the problems of an ``InputError`` to ``problems`` instead of raising it."""
    try:
        yield
    except InputError as error:
        problems += error.problems


@contextmanager
def _as_input_error(path: Path, kind: str, *damages: type[Exception]) -> Iterator[None]:
    """Turn ``FileNotFoundError`` and ``damages`` into an ``InputError`` that the file is missing or not ``kind``.

    It has the line of a mistake in JSON; of bytes that are no text, and of nesting too deep, none is known.
    """
    try:
        yield
    except FileNotFoundError:
        raise NotFound(f"{path}: not there; start `rockbatch run` again") from None
    except InputError:
        raise
    except damages as error:
        line = f":{error.lineno}" if isinstance(error, json.JSONDecodeError) else ""
        raise InputError(f"{path}{line}: not {kind} ({error}); start `rockbatch run` again") from None


def _read_info(path: Path) -> dict[str, Any]:
    """Read run.json; raise ``InputError`` with the parts that do not fit :data:`SHAPE`, up to :data:`MOST_PROBLEMS`."""
    with _as_input_error(path, "JSON", ValueError, RecursionError):
        info: Any = _legible(json.loads(read_text(path)))
    misfits = list(unfit(info, SHAPE, MOST_PROBLEMS))
    missing = [problem.place for problem in misfits if problem.missing and problem.place in SHAPE]
    problems = [f"{path}: {misfit}; start `rockbatch run` again" for misfit in misfits if misfit.place not in missing]
    if missing:
        problems.insert(0, f"{path}: has no {', '.join(missing)}; start `rockbatch run` again with this version")
    refuse(problems)
    return dict(info)


def _legible(value: Any) -> Any:
    """Return a JSON value with control characters in its texts escaped, except line breaks and tabs."""
    if isinstance(value, str):
        return legible(value, keep="\t\r\n")
    if isinstance(value, list):
        return [_legible(item) for item in value]
    return {_legible(key): _legible(item) for key, item in value.items()} if isinstance(value, dict) else value


def _read_peaks(path: Path, varied: Sequence[str]) -> "pd.DataFrame":
    """Read peaks.csv with the types of its columns; raise ``InputError`` with the bad cells of :func:`_bad_cells`."""
    with _as_input_error(path, "a table", UnicodeDecodeError, csv.Error), opened_text(path) as file:
        head = next(csv.reader(file), [])
    if missing := [name for name in (*names(FIXED), *varied) if name not in head]:
        raise InputError(f"{path}:1: has no column {', '.join(missing)}; start `rockbatch run` again")
    if len(set(head)) < len(head) or "" in head:
        fault = "without a name" if "" in head else "twice"
        raise InputError(f"{path}:1: has a column {fault}; start `rockbatch run` again")
    texts = [name for name in head if name in TEXTS or name in varied or name == "vertical"]
    numbers = [name for name in head if name not in texts]
    try:
        # Only an empty number is missing: a record may be called "NA"
        with opened(path) as file, warnings.catch_warnings():
            warnings.simplefilter("error", pd.errors.ParserWarning)  # pandas would drop surplus cells of a row
            empty, types = (
                {name: [""] for name in numbers},
                dict.fromkeys(texts, "str") | dict.fromkeys(numbers, "float64"),
            )
            table = pd.read_csv(
                file, keep_default_na=False, na_values=empty, encoding="utf-8", index_col=False, dtype=types
            )
        infinite = np.isinf(table[[name for name in numbers if name not in UNBOUNDED]].to_numpy()).any()
        counts, facts = ([name for name in numbers if name in kind] for kind in (COUNTS, FACTS))
        zero_or_one = table[facts].to_numpy()
        if (np.abs(table[counts].to_numpy()) > MOST_COUNT).any() or np.nan_to_num(
            zero_or_one * (zero_or_one - 1.0)
        ).any():
            raise ValueError("a count is out of range")
        for name in counts:
            table[name] = table[name].astype("Int64")
        sound = table["status"].isin(STATUSES).all() and not infinite
        sound = sound and not (table["scale"].isna() & (table["case"] != "")).any()
    except (ValueError, TypeError, pd.errors.ParserWarning) as error:
        bad = _bad_cells(path, head, numbers)
        raise InputError(*(bad or [f"{path}: not a table ({error}); start `rockbatch run` again"])) from None
    if not sound:
        raise InputError(*(_bad_cells(path, head, numbers) or [f"{path}: {CHANGED}"]))
    for name in texts:
        originals = {cell: legible(csv_plain(cell), keep="\t\r\n") for cell in table[name].unique()}
        if any(cell != text for cell, text in originals.items()):
            table[name] = table[name].map(originals)
    for name in varied:
        if name not in TEXTS:
            table[name] = numbers_or_words(table[name])
    return table


def _bad_cells(path: Path, head: Sequence[str], numbers: Sequence[str]) -> list[str]:
    """Return a message with its line for each wrong row length, number, status and missing scale, up to 20, then "and more"."""
    bad: list[str] = []
    try:
        with opened_text(path) as file:
            reader = csv.reader(file)
            next(reader)
            for cells in reader:
                place = f"{path}:{reader.line_num}"
                if len(cells) != len(head):
                    bad.append(f"{place}: {len(cells)} cells: expected {len(head)}, as in the first line")
                    continue
                row = dict(zip(head, cells, strict=True))
                wrong = [name for name in numbers if not _is_number(row[name], name)]
                bad += [
                    f'{place}: {name} = "{row[name][:80]}": expected {_expected(name)} or nothing' for name in wrong
                ]
                if row["status"] not in STATUSES:
                    bad.append(f'{place}: status = "{row["status"][:80]}": expected {", ".join(STATUSES)}')
                if row["case"] and not row["scale"]:
                    bad.append(f"{place}: a run without scale")
                if len(bad) > MOST_PROBLEMS:
                    return [*bad[:MOST_PROBLEMS], f"{path}: and more"]
    except (UnicodeDecodeError, csv.Error) as error:
        bad.append(f"{path}: not a table ({error}); start `rockbatch run` again")
    return bad


def _expected(name: str) -> str:
    """Return the values that a column allows: "0, 1" for a fact, "a whole number" for a count, else "a number"."""
    if name in FACTS:
        return "0, 1"
    return "a whole number" if name in COUNTS else "a number"


def _is_number(text: str, name: str) -> bool:
    """Return whether a cell is empty or a number that column ``name`` allows."""
    try:
        value = float(text or 0)
    except ValueError:
        return False
    if name in FACTS:
        return value in (0.0, 1.0)
    if name in UNBOUNDED and value == math.inf:
        return True
    return math.isfinite(value) and (name not in COUNTS or (value.is_integer() and abs(value) <= MOST_COUNT))
