"""Verdicts, and their rows in checks.csv."""

import csv
import functools
import json
import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import MISSING, dataclass, fields
from pathlib import Path
from typing import Any

from rockbatch.checks.capacity import Curve, problems
from rockbatch.checks.omissions import MODES, OMISSIONS
from rockbatch.checks.rules import COUNTS, is_ban
from rockbatch.common.errors import InputError
from rockbatch.common.files import csv_plain, csv_text, is_plain, legible, opened_text, sha256_of_lines, write_whole
from rockbatch.common.lazy import pd
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.design import BOUND
from rockbatch.quantities.rows import PEAKS
from rockbatch.quantities.statistics import STATISTICS

PASS, FAIL, NOT_DECIDED, DOES_NOT_APPLY = "pass", "fail", "not decided", "does not apply"
CHECKS = "checks.csv"
"""File of the verdicts, beside peaks.csv."""
NOTE = "note"
"""Column of checks.csv with the remarks in one line, for people."""
JUDGED = "peaks_sha256"
"""Column of checks.csv with the digest of the peaks.csv that was judged."""
MEAN_OVER_TARGET = "mean_over_target"
"""Demand of the verdict on the mean spectrum of the suite."""
_CONDITIONS = ("stations", "pairs", "shortest_period", "longest_period", "zero_period", "verticals", "share", "damping")
_FACTORS = ("least_record", "greatest_record", "least_family", "greatest_family")
OF_SUITE = (
    MEAN_OVER_TARGET,
    *(f"suite_{name}" for name in _CONDITIONS),
    *(f"suite_{name}_factor" for name in _FACTORS),
)
"""Demands of the verdicts on the suite itself."""


UNWRITTEN = -1
"""Number that checks.csv of an earlier version does not have."""


@dataclass(frozen=True)
class Verdict:
    """The outcome of a check for one case at one scale, or for the suite itself."""

    # Name of the rule; the case, its varied values, and the scale of its suite. The check of the suite itself has the case "".
    check: str
    case: str
    columns: dict[str, float | str]
    scale: float
    # names of both; ``statistic`` is empty for a demand that is the same for all records
    demand: str
    statistic: str
    words: str  # both in words: "mean of theta_max_over_alpha"
    # number of records that count, and of all runs of the suite
    records: int
    runs: int
    # The statistic, and the bounds that errors and unknown runs leave, infinite if unknown. The value is NaN if nothing is
    # known of it; all are without a record.
    value: float
    low: float
    high: float
    # "at most" or "at least", and the limit
    sense: str
    limit: float
    ratio: float  # demand over limit, or limit over demand where more is better: above 1 is too much
    margin: float  # distance to the limit in the unit of the demand; negative beyond it
    # "pass", "fail", "not decided" (the bounds straddle the limit, or records are missing) or "does not apply"
    verdict: str
    # where the limit comes from
    basis: str
    reason: str
    # how runs that ended early count, and their number; empty without any
    counting: str
    counted: str
    # reason of an undecided verdict, and remarks; checks.csv has them as JSON, and in words in the column ``note``
    remarks: tuple[str, ...]
    # the way to count records, one of :data:`rockbatch.checks.rules.COUNTS`; empty for a demand of the case
    count: str = ""
    unit: str = ""  # of value, bounds, limit and margin; empty for a pure number
    # the run that governs: whose demand is the largest, or, where nothing is decided, may be; empty without one
    station: str = ""
    record: str = ""
    polarity: str = ""
    governing: float = math.nan  # demand of that run; NaN without one
    # height above the pivots at which the demand is read [m]: of drift, or of a section; NaN of others
    at_m: float = math.nan
    # what the demand leaves out, the gravest first: names of :data:`rockbatch.checks.omissions.OMISSIONS`
    omits: tuple[str, ...] = ()
    axes: str = ""  # how the demands on both axes of a pier combine, in words; empty on one axis
    capacity: str = ""  # points of the capacity that depends on the axial force, as JSON; empty of other checks
    # least number of records, and greatest of one event, with which anything passes, as the check asks; 0 if it does not,
    # :data:`UNWRITTEN` if an earlier version did not write them
    least: int = UNWRITTEN
    per_event: int = UNWRITTEN

    @property
    def curve(self) -> Curve:
        """Return the points (N, E_Rd) of the capacity that depends on the axial force; () for other checks."""
        return tuple((float(n), float(e)) for n, e in json.loads(self.capacity or "[]"))

    @property
    def note(self) -> str:
        """Return the remarks in one line, with semicolons between them; "" for none."""
        return "; ".join(self.remarks)

    @property
    def left_open(self) -> str:
        """Return the first omission that leaves the demand without an upper bound, by name; empty if there is none."""
        return next((name for name in self.omits if not OMISSIONS[name].decides), "")

    @property
    def why_open(self) -> str:
        """Return why a verdict is not decided, by its omission without an upper bound, else its first remark; "" of others."""
        if self.verdict != NOT_DECIDED:
            return ""
        return OMISSIONS[self.left_open].remark if self.left_open else next(iter(self.remarks), "")

    @property
    def is_lower_bound(self) -> bool:
        """True if the upper bound alone is infinite: the demand is at least its value. False if that is for modes left out."""
        return math.isinf(self.high) and math.isfinite(self.value) and MODES not in self.omits

    @property
    def is_ban(self) -> bool:
        """True if the check asks that an event happens under no record, so that its demand is yes or no."""
        return is_ban(self.demand, self.statistic, self.limit)


_KINDS: dict[str, Any] = {field.name: field.type for field in fields(Verdict)}
"""Types of the columns, by name."""
_WORDS: dict[str, Collection[str]] = {
    "verdict": (PASS, FAIL, NOT_DECIDED, DOES_NOT_APPLY),
    "sense": ("at most", "at least"),
    "statistic": ("", *STATISTICS),
    "demand": (*DEMANDS, *OF_SUITE),
    "count": ("", *COUNTS),
}
"""Columns of words that readers look up."""
_LATER = {field.name for field in fields(Verdict) if field.default is not MISSING}
"""Columns that an earlier version did not write yet."""


def as_table(verdicts: Iterable[Verdict]) -> "pd.DataFrame":
    """Return one row for each verdict; the varied values have columns of their own."""
    columns, rows = _table(verdicts)
    return pd.DataFrame(rows, columns=columns)


def _table(verdicts: Iterable[Verdict]) -> tuple[list[str], list[dict[str, object]]]:
    """Return the names of the columns of checks.csv, those of varied values behind ``case``, and a mapping for each row."""
    rows: list[dict[str, object]] = []
    varied: dict[str, None] = {}
    for verdict in verdicts:
        lists = {"remarks": json.dumps(verdict.remarks, ensure_ascii=False), "omits": ", ".join(verdict.omits)}
        rows.append(vars(verdict) | {NOTE: verdict.note} | lists | verdict.columns)
        varied |= dict.fromkeys(verdict.columns)
    first, last = ("check", "case"), [name for name in _KINDS if name not in ("check", "case", "columns")]
    last.insert(last.index("remarks"), NOTE)
    return [*first, *varied, *last], rows


def write_verdicts(directory: Path, verdicts: Iterable[Verdict]) -> Path:
    """Write checks.csv into ``directory``, whole or not at all; return its path."""
    path = Path(directory) / CHECKS
    columns, rows = _table(verdicts)
    judged = {JUDGED: _digest_of_peaks(path)}
    write_whole(path, csv_text([*columns, *judged], [row | judged for row in rows]))
    return path


def _digest_of_peaks(path: Path) -> str:
    """Return the digest of the peaks.csv beside checks.csv at ``path``, the same with any line endings; "" without one."""
    peaks = path.with_name(PEAKS)
    return sha256_of_lines(peaks) if is_plain(peaks) else ""


def read_verdicts(directory: Path) -> list[Verdict] | None:
    """Read checks.csv in ``directory``; empty without one, None if it judges another peaks.csv than the one beside it.

    Raises ``InputError`` if it is damaged; an earlier version did not write which it judged.
    """
    path = Path(directory) / CHECKS
    plain = functools.cache(lambda cell: legible(csv_plain(cell), keep="\t\r\n"))  # most cells occur many times
    try:
        with opened_text(path) as file:
            rows = [{name: plain(cell) for name, cell in row.items()} for row in csv.DictReader(file)]
        verdicts = [_from_row(row) for row in rows]
    except FileNotFoundError:
        return []
    except InputError:
        raise
    except (AttributeError, KeyError, RecursionError, TypeError, ValueError, csv.Error) as error:
        raise InputError(f"{path}: damaged ({error}); start `rockbatch check` again") from None
    return None if {row.get(JUDGED, "") for row in rows} - {"", _digest_of_peaks(path)} else verdicts


def _from_row(row: Mapping[str, str]) -> Verdict:
    """Return the verdict in a row of checks.csv. Raises ``KeyError`` or ``ValueError`` for a damaged one."""
    values: dict[str, Any] = {}
    for name, kind in _KINDS.items():
        if name not in ("columns", "remarks", "omits") and (name in row or name not in _LATER):
            values[name] = kind(row[name] or ("nan" if kind is float else ""))
    values["remarks"] = tuple(legible(str(remark), keep="\t\r\n") for remark in json.loads(row["remarks"]))
    values["omits"] = tuple(row["omits"].split(", ")) if row.get("omits") else ()
    for name, words in _WORDS.items():
        if values.get(name, "") not in words:
            raise ValueError(f"{name} = {values[name]!r}")
    if not {*values["omits"]} <= OMISSIONS.keys():
        raise ValueError(f"omits = {values['omits']!r}")
    columns = {
        name: text if name == BOUND else _value(text)
        for name, text in row.items()
        if name not in {*_KINDS, NOTE, JUDGED}
    }
    verdict = Verdict(
        columns={name: value for name, value in columns.items() if value != "" or name == BOUND}, **values
    )
    if verdict.capacity and any(problems(verdict.curve)):
        raise ValueError(f"capacity = {verdict.capacity!r}")
    return verdict


def _value(text: str) -> float | str:
    """Return the value of a varied key: a number, or a text. Raises ``ValueError`` for NaN or an infinite number."""
    try:
        number = float(text)
    except ValueError:
        return text
    if not math.isfinite(number):
        raise ValueError(f"{text} as a value of a case")
    return number
