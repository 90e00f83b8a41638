"""Lines of agencies' text files: what their headers say, clocks and dates, and numbers in columns or between blanks.

The fixed columns of Fortran programs need no blank between them: ``-11024.7-9733.1``. Errors have the number of the line.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from typing import TypeVar

import numpy as np

from rockbatch.errors import InputError
from rockbatch.motions.limits import HUGE
from rockbatch.motions.motion import Samples

T = TypeVar("T")

_LONGEST = 10**6  # characters of a line
_MANY = 100  # numbers that do not have the same number of decimals by chance

_LONGEST_OF_HEADER = 200  # characters of a header line that are looked at
_YEAR_FIRST = re.compile(r"(?P<year>\d{4})[-/. ](?P<month>\d{1,2}|[A-Z]{3,})[-/. ](?P<day>\d{1,2})(?!\d)", re.ASCII)
_DAY_FIRST = re.compile(
    r"(?P<day>\d{1,2})(?:[-/. ]| DEL? )(?P<month>\d{1,2}|[A-Z]{3,})(?:[-/., ]| DEL? )+(?P<year>\d{4})(?!\d)", re.ASCII
)
_MONTHS = {name: i for i, names in enumerate(
    ("JAN ENE", "FEB", "MAR", "APR ABR", "MAY", "JUN", "JUL", "AUG AGO", "SEP SET", "OCT", "NOV", "DEC DIC"), start=1
) for name in names.split()}  # fmt: skip

LOOKED_AT = 1000
"""How many numbers at the end of a file ``is_cut_short`` needs."""


def lines_of(text: str) -> list[str]:
    """Lines of a file with any of the three line ends, less what old programs write after the last one.

    ``str.splitlines`` would also break at the control characters that Latin-1 texts may hold. Raises ``InputError`` for
    a line that is longer than any of numbers, whose words would take thirty times its size.
    """
    lines = text.rstrip("\x00\x1a\r\n").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    too_long = next((i for i, line in enumerate(lines) if len(line) > _LONGEST), None)
    if too_long is not None:
        raise InputError(f"line {too_long + 1} has {len(lines[too_long]):,} characters; expected {_LONGEST:,} at most")
    return lines


def one_after_another(text: str, channel: Callable[[list[str], int], tuple[T, int]]) -> list[T]:
    """The channels of a file: ``channel`` reads the one that begins at a line, and tells where it ends.

    Raises ``InputError`` for a file without any.
    """
    lines = lines_of(text)
    channels = []
    at = 0
    while at < len(lines):
        if lines[at].strip():
            one, at = channel(lines, at)
            channels.append(one)
        else:
            at += 1
    if not channels:
        raise InputError("the file is empty")
    return channels


def fixed_numbers(lines: Sequence[str], first: int, count: int, width: int, per_line: int) -> tuple[Samples, int]:
    """Return ``count`` numbers from ``lines[first]`` on, shape (count,), and where the lines after them begin.

    There are ``per_line`` of ``width`` characters each: every line is full but the last, which holds the rest and nothing
    more. Raises ``InputError`` with the line for anything else; nothing is allocated before the lines are there.
    """
    needed = -(-count // per_line)
    if len(lines) - first < needed:
        raise InputError(
            f"{count} values from line {first + 1} on take {needed} lines, but the file ends with line {len(lines)}: "
            "it is cut; fetch it again"
        )
    values = np.empty(count)
    for i in range(needed):
        line = lines[first + i].rstrip()
        expected = min(per_line, count - i * per_line)
        fields = [line[at : at + width] for at in range(0, len(line), width)]
        if len(line) != expected * width:
            raise InputError(
                f'line {first + i + 1}: found "{line[:40]}…", {len(line)} characters; '
                f"expected {expected} values of {width} characters each"
            )
        values[i * per_line : i * per_line + expected] = [number_in(field, first + i) for field in fields]
    return values, first + needed


def refuse_more(lines: Sequence[str], end: int, declared: str) -> None:
    """Raise ``InputError`` for text from ``lines[end]`` on, after what a header has ``declared``: "the 40 values"."""
    after = next((i for i in range(end, len(lines)) if lines[i].strip()), None)
    if after is not None:
        raise InputError(f'line {after + 1}: found "{lines[after][:40]}" after {declared}')


def spaced_numbers(lines: Sequence[str], first: int, count: int, per_line: int) -> Samples:
    """``count`` numbers between blanks from ``lines[first]`` to the end of the file, shape (count,).

    Every line has ``per_line`` of them but the last, which has the rest. Raises ``InputError`` with the line for
    anything else; nothing is allocated before the lines are there.
    """
    needed = -(-count // per_line)
    end = next((i for i in range(len(lines), first, -1) if lines[i - 1].strip()), first)
    if end - first != needed:
        raise InputError(
            f"the header says {count} values, {needed} lines from line {first + 1} on, but there are {end - first}; "
            "fetch the file again"
        )
    values = np.empty(count)
    tokens: list[str] = []
    for i in range(first, end):
        fields = lines[i].split()
        at = (i - first) * per_line
        expected = min(per_line, count - at)
        if len(fields) != expected:
            raise InputError(f"line {i + 1}: found {len(fields)} numbers; expected {expected}")
        values[at : at + expected] = [number_in(field, i) for field in fields]
        tokens = [*tokens, *fields][-LOOKED_AT:] if i >= end - LOOKED_AT else fields
    if is_cut_short(tokens):
        raise InputError(f'line {end}: found "{tokens[-1][:40]}", shorter than all others: the file is cut')
    return values


def number_in(field: str, at: int) -> float:
    """The number in a field of the line with index ``at``, Fortran's D exponents included; else ``InputError``."""
    try:
        if "_" in field:  # Python would read 1_0 as ten
            raise ValueError
        value = float(field.upper().replace("D", "E"))
    except ValueError:
        value = np.nan
    if not abs(value) < HUGE:
        raise InputError(f'line {at + 1}: found "{field.strip()[:40]}"; expected a number')
    return value


def is_cut_short(tokens: Sequence[str]) -> bool:
    """Whether the last number has fewer characters after its point than the others before it, which agree.

    A file that was cut within it has all its values, and the last one wrong.
    """

    def tail(token: str) -> int:
        return len(token) - token.rfind(".")

    if len(tokens) < _MANY or "." not in tokens[-2]:
        return False
    usual = tail(tokens[-2])
    return tail(tokens[-1]) < usual and all(tail(token) == usual for token in tokens[-LOOKED_AT:-1])


def found(pattern: re.Pattern[str], lines: Sequence[str], at: int, expected: str) -> re.Match[str]:
    """The match of ``pattern`` in ``lines[at]``; ``InputError`` where the line is another one, or none."""
    line = line_at(lines, at)
    match = pattern.search(line)
    if match is None:
        what = f'"{line.strip()[:60]}"' if at < len(lines) else "the end of the file"
        raise InputError(f'line {at + 1}: found {what}; expected "{expected}"')
    return match


Line = tuple[int, re.Pattern[str], str]
"""Of a header: how many lines after the first it stands, its pattern, and how it should look; "" if it may be another."""


def read_header(lines: Sequence[str], at: int, layout: Sequence[Line]) -> dict[str, str]:
    """Return the groups of the lines of a header that begins at ``lines[at]``, "" for those that are not in them.

    Raises ``InputError`` with the line where one that is needed is another one, or none.
    """
    groups: dict[str, str] = {}
    for offset, pattern, expected in layout:
        match = (
            found(pattern, lines, at + offset, expected) if expected else pattern.search(line_at(lines, at + offset))
        )
        groups |= {name: (match[name] or "" if match else "") for name in pattern.groupindex}
    return groups


def past_mark(lines: Sequence[str], at: int, after: str) -> int:
    """Return where the lines behind the mark "/&" at ``lines[at]`` begin; ``InputError`` where it is not ``after`` its data."""
    if not line_at(lines, at).startswith("/&"):
        what = f'"{lines[at].strip()[:60]}"' if at < len(lines) else "the end of the file"
        raise InputError(f'line {at + 1}: found {what}; expected "/&" after {after}; fetch it again')
    return at + 1


def search_lines(pattern: re.Pattern[str], lines: Sequence[str]) -> re.Match[str] | None:
    """Return the match of ``pattern`` in the first of ``lines`` that it is in, as far as a header goes; ``None`` if in none."""
    return next((match for line in lines if (match := pattern.search(line[:_LONGEST_OF_HEADER]))), None)


def line_with(pattern: re.Pattern[str], lines: Sequence[str], most: int, expected: str) -> tuple[int, re.Match[str]]:
    """Return index and match of the first of ``most`` lines that ``pattern`` is in; ``InputError`` where it is in none."""
    for at in range(min(most, len(lines))):
        if match := pattern.search(line_at(lines, at)):
            return at, match
    raise InputError(f'no line "{expected}" in the first {most} lines')


def keys_of(lines: Sequence[str]) -> dict[str, str]:
    """Return the values of header lines ``KEY : value``, the first of each key; other lines are skipped."""
    header: dict[str, str] = {}
    for at in range(len(lines)):
        key, colon, value = line_at(lines, at).partition(":")
        if colon and key.strip():
            header.setdefault(key.strip(), value.strip())
    return header


def number_of(header: Mapping[str, str], key: str) -> float:
    """Return the number that a header states under ``key``; ``InputError`` where it has none."""
    if key not in header:
        raise InputError(f"the header lacks {key}")
    try:
        return number_in(header[key], 0)
    except InputError:
        raise InputError(f'the header says {key}: "{header[key][:40]}"; expected a number') from None


def count_and_step(header: Mapping[str, str], count: str, step: str) -> tuple[int, float]:
    """Return the number of samples and the sampling interval [s] under these keys; ``InputError`` where they are none."""
    npts, dt = number_of(header, count), number_of(header, step)
    if npts != int(npts) or npts < 2 or not 0 < dt < 10:
        raise InputError(f"the header says {npts:g} values every {dt:g} s; expected a whole number and an interval")
    return int(npts), dt


def line_at(lines: Sequence[str], at: int) -> str:
    """``lines[at]`` as far as a header goes; empty after the last line."""
    return lines[at][:_LONGEST_OF_HEADER] if at < len(lines) else ""


def number(text: str, at: int) -> float:
    """A number of digits and a point in the line with index ``at``; ``InputError`` for "1.2.3"."""
    try:
        return float(text)
    except ValueError:
        raise InputError(f'line {at + 1}: found "{text}"; expected a number') from None


def date_in(text: str) -> tuple[int, int, int] | None:
    """Return year, month and day of a date such as "2000/07/21", "21/JUL/2000" or "21 de julio de 2000"; ``None`` if none.

    The day stands before the month where the year is last. Months may be English or Spanish.
    """
    text = " ".join(text[:_LONGEST_OF_HEADER].upper().split())
    found = _YEAR_FIRST.match(text) or _DAY_FIRST.match(text)
    if found is None:
        return None
    month = int(found["month"]) if found["month"].isdecimal() else _MONTHS.get(found["month"][:3], 0)
    return (int(found["year"]), month, int(found["day"])) if 1 <= month <= 12 else None


def moment_of(groups: Mapping[str, str]) -> float | None:
    """Return the time in UTC [s since 1970] of the groups ``year`` to ``second``; ``None`` if they are empty, or no time."""
    try:
        year, month, day, hour, minute = (int(groups[name]) for name in ("year", "month", "day", "hour", "minute"))
        return moment(year, month, day, hour, minute, float(groups["second"].replace(",", ".")))
    except (KeyError, ValueError):
        return None


def moment_in(pattern: re.Pattern[str], text: str) -> float | None:
    """Return the time in UTC [s since 1970] that a text begins with; ``None`` where it is none of the ``pattern``."""
    match = pattern.match(text)
    return moment_of(match.groupdict()) if match else None


def moment(year: int, month: int, day: int, hour: int, minute: int, second: float) -> float | None:
    """A time in UTC [s since 1970]; ``None`` where the numbers are none, as headers have it that do not know."""
    try:
        whole = datetime(year, month, day, hour, minute, tzinfo=UTC).timestamp()
    except (ValueError, OverflowError):
        return None
    return whole + second if 0 <= second < 61 else None  # 60 in a leap second
