"""Lines of headers by a layout or by keys, and dates and times in them; errors have the number of the line."""

import re
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime

from rockbatch.common.errors import InputError
from rockbatch.motions.formats.fixed_width import number_in

_LONGEST_OF_HEADER = 200  # characters of a header line that are read
_YEAR_FIRST = re.compile(r"(?P<year>\d{4})[-/. ](?P<month>\d{1,2}|[A-Z]{3,})[-/. ](?P<day>\d{1,2})(?!\d)", re.ASCII)
_DAY_FIRST = re.compile(
    r"(?P<day>\d{1,2})(?:[-/. ]| DEL? )(?P<month>\d{1,2}|[A-Z]{3,})(?:[-/., ]| DEL? )+(?P<year>\d{4})(?!\d)", re.ASCII
)
CLOCK = r"(?P<hour>\d{1,2}):(?P<minute>[ \d]\d):(?P<second>[ \d]\d(?:\.\d{1,6})?)"
"""Pattern of a time of day; Fortran writes "03:16: 8.0"."""

_MOMENTS = tuple(  # 20160214_001345.000, 2016/2/14-00:13:45, 14/02/2016 00:13:45
    re.compile(rf"{day}[-_ T](?P<hour>\d\d):?(?P<minute>\d\d):?(?P<second>\d\d(?:\.\d{{1,6}})?)", re.ASCII)
    for day in (
        r"(?P<year>\d{4})/?(?P<month>\d{1,2})/?(?P<day>\d{1,2})",
        r"(?P<day>\d\d)/(?P<month>\d\d)/(?P<year>\d{4})",
    )
)
_ENGLISH_MONTHS = ("JAN", "FEB", "MAR", "APR", "MAY", "JUN", "JUL", "AUG", "SEP", "OCT", "NOV", "DEC")
_SPANISH_MONTHS = {"ENE": 1, "ABR": 4, "AGO": 8, "SET": 9, "DIC": 12}  # the others are as in English
_MONTHS = {name: i for i, name in enumerate(_ENGLISH_MONTHS, start=1)} | _SPANISH_MONTHS


def match_line(pattern: re.Pattern[str], lines: Sequence[str], index: int, expected: str) -> re.Match[str]:
    """Return the match of ``pattern`` in ``lines[index]``; raise ``InputError`` for another line, or the file's end."""
    match = pattern.search(line_at(lines, index))
    if match is None:
        raise _mismatch(lines, index, f'"{expected}"')
    return match


def _mismatch(lines: Sequence[str], index: int, expected: str) -> InputError:
    """Return the error for ``lines[index]``, or the end of the file, in place of the ``expected`` text."""
    line = f'"{line_at(lines, index).strip()[:60]}"' if index < len(lines) else "the end of the file"
    return InputError(f"line {index + 1}: found {line}; expected {expected}")


HeaderLine = tuple[int, re.Pattern[str], str]


def layout(*lines: tuple[int, str, str]) -> tuple[HeaderLine, ...]:
    """Return the compiled layout of a header: for each line its offset from the first, its pattern and an example.

    The example is for messages; lines with an empty example are optional.
    """
    return tuple((offset, re.compile(pattern), example) for offset, pattern, example in lines)


def read_header(lines: Sequence[str], start: int, layout: Sequence[HeaderLine]) -> dict[str, str]:
    """Return by name the pattern groups of a header that begins at ``lines[start]``, "" for missing ones.

    Raises ``InputError`` with the first required line that does not match.
    """
    groups: dict[str, str] = {}
    for offset, pattern, expected in layout:
        match = pattern.search(line_at(lines, start + offset))
        if match is None and expected:
            raise _mismatch(lines, start + offset, f'"{expected}"')
        groups |= {name: (match[name] or "" if match else "") for name in pattern.groupindex}
    return groups


def past_mark(lines: Sequence[str], start: int, after: str) -> int:
    """Return the index after the mark "/&" at ``lines[start]``; raise ``InputError`` if it is not there ``after`` these data."""
    if not line_at(lines, start).startswith("/&"):
        raise _mismatch(lines, start, f'"/&" after {after}; fetch it again')
    return start + 1


def search_lines(pattern: re.Pattern[str], lines: Sequence[str]) -> re.Match[str] | None:
    """Return the first match of ``pattern`` in ``lines``, each up to 200 characters; ``None`` without one."""
    return next((match for line in lines if (match := pattern.search(line[:_LONGEST_OF_HEADER]))), None)


def line_with(pattern: re.Pattern[str], lines: Sequence[str], most: int, expected: str) -> tuple[int, re.Match[str]]:
    """Return index and match of the first of ``most`` lines that match ``pattern``; raise ``InputError`` without one."""
    for index in range(min(most, len(lines))):
        if match := pattern.search(line_at(lines, index)):
            return index, match
    raise InputError(f'no line "{expected}" in the first {most} lines')


def keys_of(lines: Sequence[str], *needed: str, once: bool = False) -> dict[str, str]:
    """Return the values of header lines ``KEY : value``, the first of each key; other lines are skipped.

    Raises ``InputError`` with all ``needed`` keys that are missing or without a value, and for a repeated key if ``once``.
    """
    header: dict[str, str] = {}
    for index in range(len(lines)):
        key, colon, value = line_at(lines, index).partition(":")
        if once and key.strip() in header:
            raise InputError(
                f'line {index + 1}: "{key.strip()[:40]}" a second time; expected the values of one component'
            )
        if colon:
            header.setdefault(key.strip(), value.strip())
    require(header, *needed)
    return header


def require(header: Mapping[str, str], *keys: str) -> None:
    """Raise ``InputError`` with all ``keys`` that are missing in a header or without a value."""
    if lacking := [key for key in keys if not header.get(key)]:
        raise InputError(f"the header lacks {', '.join(lacking)}")


def number_of(header: Mapping[str, str], key: str) -> float:
    """Return the number under ``key`` of a header; raise ``InputError`` if the key is missing or its value is no number."""
    if key not in header:
        raise InputError(f"the header lacks {key}")
    try:
        return number_in(header[key], 0)
    except InputError:
        raise InputError(f'the header says {key}: "{header[key][:40]}"; expected a number') from None


def count_and_step(header: Mapping[str, str], count: str, step: str) -> tuple[int, float]:
    """Return the number of samples and the sampling interval [s] under two keys.

    Raises ``InputError`` unless the number is whole, 2 or more, and the interval above 0 and below 10 s.
    """
    npts, dt = number_of(header, count), number_of(header, step)
    if npts != int(npts) or npts < 2 or not 0 < dt < 10:
        raise InputError(f"the header says {npts:g} values every {dt:g} s; expected a whole number and an interval")
    return int(npts), dt


def line_at(lines: Sequence[str], index: int) -> str:
    """Return ``lines[index]`` up to 200 characters; "" after the last line."""
    return lines[index][:_LONGEST_OF_HEADER] if index < len(lines) else ""


def date_in(text: str) -> tuple[int, int, int] | None:
    """Return year, month and day of a text that begins with a date; ``None`` for others.

    "2000/07/21", "21/JUL/2000", "21 de julio de 2000": if the year is last, the day is first. Months may be English or
    Spanish.
    """
    text = " ".join(text[:_LONGEST_OF_HEADER].upper().split())
    match = _YEAR_FIRST.match(text) or _DAY_FIRST.match(text)
    if match is None:
        return None
    month = int(match["month"]) if match["month"].isdecimal() else _MONTHS.get(match["month"][:3], 0)
    return (int(match["year"]), month, int(match["day"])) if 1 <= month <= 12 else None


def moment_of(groups: Mapping[str, str]) -> float | None:
    """Return the time [s since 1970, UTC] of the groups ``year`` to ``second``; ``None`` if one is missing or impossible."""
    try:
        year, month, day, hour, minute = (int(groups[name]) for name in ("year", "month", "day", "hour", "minute"))
        return moment(year, month, day, hour, minute, float(groups["second"].replace(",", ".")))
    except (KeyError, ValueError):
        return None


def moment_in(text: str) -> float | None:
    """Return the time [s since 1970, UTC] at the beginning of a text, its date in digits; ``None`` without one."""
    match = next(filter(None, (pattern.match(text) for pattern in _MOMENTS)), None)
    return moment_of(match.groupdict()) if match else None


def moment(year: int, month: int, day: int, hour: int, minute: int, second: float) -> float | None:
    """Return a date and time in UTC as [s since 1970]; ``None`` for an impossible one."""
    try:
        whole = datetime(year, month, day, hour, minute, tzinfo=UTC).timestamp()
    except (ValueError, OverflowError):
        return None
    return whole + second if 0 <= second < 61 else None  # 60 in a leap second
