"""Text to a table of numbers: comment and header lines, and columns however a program or Excel separates them."""

import re
from array import array
from collections.abc import Sequence
from itertools import chain

import numpy as np

from rockbatch.common.errors import InputError, NoRecordError, UnstatedError
from rockbatch.motions.formats.column_header import columns_with_units, columns_without_units, stated_count
from rockbatch.motions.formats.fixed_width import is_cut_short, lines_of, without_end_marks
from rockbatch.motions.formats.time_steps import grows_evenly
from rockbatch.motions.limits import HUGE
from rockbatch.motions.motion import Samples

_COMMENT = ("#", "%")
_WRAPPED = {"layout": "wrapped"}  # what may be meant by numbers that go on from line to line
_LONGEST, _MOST_HEADER = 300, 300  # characters of a header line, and lines, that are looked at
_MOST_COUNTS = 3  # numbers of lines above a table that count its samples
_FEWEST_PAIRS = 5
_PIECE = 10_000  # lines that are read at once
_TOUCHING = re.compile(  # with points, unlike a date such as 2010-11-14; possessive: digits may end one number or begin the next
    r"\s*+(?:[-+]?\d*+\.\d++(?:[EDed][-+]?\d++)?\s*+)+"  # but for the groups: Python 3.11.2 errs there
)
_CONTINUED = "\\ \t"  # what some programs put behind each line
_SIGN = re.compile(r"(?<=[\d])-(?=[\d.])")
_NUMERIC = re.compile(r'[-+.,;"\s]*[0-9][-+0-9.,;eEdD"\s]*')


def read_table(
    text: str, wrapped: bool = False, named: bool = True, stated: Sequence[str] = ()
) -> tuple[list[str], Samples]:
    """Return the header lines, without their comment sign, and the table of numbers, shape (npts, columns).

    Columns stand between blanks, tabs, commas or semicolons. Decimal commas are understood where they cannot
    be anything else: between semicolons, tabs or blanks in a file without a decimal point. Raises
    ``InputError`` with the line for a row unlike those above it, and for commas that may be either. A ``wrapped`` table is one
    column that goes on from line to line, as is one whose header states as many samples as there are numbers; its last row
    may be shorter. Columns that the header names are not wrapped, unless ``named`` is False. Pairs of time and value, several on
    a line, are a table of two columns. ``stated`` lines are put before the header; a line of numbers that counts those below
    it becomes one of the header.
    """
    header: list[str] = list(stated)
    text = without_end_marks(text)
    remainder: list[float] = []
    rows, row_lines, width, end = array("d"), array("q"), 0, 0
    lines = [line.rstrip(_CONTINUED) for line in lines_of(text)] if "\\" in text else lines_of(text)
    separators = _separators(text, lines)
    for i, line in enumerate(lines):
        if i < end:  # of the rows that were read at once
            continue
        stripped = line.strip()
        comment = stripped.startswith(_COMMENT)
        row = None if comment else _numbers(stripped, *separators)
        if row and len(row) == (width or len(row)):
            block = [] if width else _even_rows(lines[i + 1 : -1], len(row), *separators)
            width = len(row)
            end = i + 1 + len(block) // width
            rows.extend(chain(row, block))
            row_lines.extend(range(i, end))
        elif row and len(row) < width and not any(map(str.strip, lines[i + 1 :])):
            remainder = row
        elif row:
            if len(rows) <= _MOST_COUNTS and (counted := _counted(lines, row_lines, rows, wrapped, named, stated)):
                return counted
            raise _table_error(lines, f"line {i + 1}: found {len(row)} numbers; expected {width} as above")
        elif stripped.strip(' ;,\t"'):
            if rows and not comment:
                raise _table_error(lines, f'line {i + 1}: found "{stripped[:60]}"; expected {width} numbers as above')
            if len(header) < _MOST_HEADER:
                header.append(stripped.lstrip("#% \t")[:_LONGEST])
    if not rows:
        raise NoRecordError("no columns of numbers found in it")
    pairs = None if wrapped and not named else _pairs(rows, remainder, width)
    if width > 1 and (wrapped or stated_count(header) == len(rows) + len(remainder)):
        wrapped = not (named and (columns_with_units(header, width) or columns_without_units(header, width)))
    if remainder and pairs is None and not wrapped:
        reason = f"line {len(lines)}: found {len(remainder)} numbers; expected {width} as above"
        refusal = _table_error(lines, reason)
        may_be_wrapped = width > 2 and not isinstance(refusal, NoRecordError)
        raise UnstatedError(reason, "layout", choices=(_WRAPPED,)) if may_be_wrapped else refusal
    table = np.array(rows).reshape(-1, width)
    wild = ~(np.abs(table) < HUGE).all(axis=1)
    if wild.any():
        i = row_lines[int(wild.argmax())]
        raise InputError(f'line {i + 1}: found "{lines[i].strip()[:60]}"; expected finite numbers')
    if is_cut_short(lines[i].split()[-1].replace(",", ".") for i in reversed(row_lines)):
        raise InputError(
            f"line {row_lines[-1] + 1}: its last number is shorter than all others: the file is cut; fetch it again"
        )
    if pairs is not None:
        return _below_its_count(header, pairs)
    return header, np.append(table.ravel(), remainder).reshape(-1, 1) if wrapped else table


def _counted(
    lines: Sequence[str],
    places: Sequence[int],
    numbers: Sequence[float],
    wrapped: bool,
    named: bool,
    stated: Sequence[str],
) -> tuple[list[str], Samples] | None:
    """Return header and table if the lines at ``places`` are the count, or count and step, of all that follow, else None."""
    said = _count_and_step(numbers)
    if said is None:
        return None
    npts, words = said
    below = "\n".join("" if i in places else line for i, line in enumerate(lines))
    header, table = read_table(below, wrapped, named, [*stated, words])
    return (header, table) if npts in (table.size, len(table)) else None


def _count_and_step(numbers: Sequence[float]) -> tuple[float, str] | None:
    """Return the count that one to three numbers are, with a step before or behind it, and the line of a header that says so.

    A third number, such as RspMatch's count of zeros in front, says nothing here.
    """
    first, *others = numbers
    step = others[0] if others else None
    if step is not None and 0.0 < first < 1.0:
        first, step = step, first
    if not first.is_integer() or first < 2 or not (step is None or 0.0 < step < 1.0):
        return None
    return first, f"NPTS = {first:.0f}" + ("" if step is None else f", DT = {step:.12g} s")


def _pairs(rows: Sequence[float], remainder: Sequence[float], width: int) -> Samples | None:
    """Return pairs of time and value, shape (npts, 2), of numbers that are pairs, one or several on a line; ``None`` if not.

    Programs for structures write them so; the times, which grow evenly from pair to pair, tell them from any other table.
    """
    numbers = np.array([*rows, *remainder]) if remainder else np.array(rows)
    if width % 2 or len(numbers) % 2 or len(numbers) < 2 * _FEWEST_PAIRS:
        return None
    pairs = numbers.reshape(-1, 2)
    times = pairs[1:, 0]  # a count and a step may stand above them
    return pairs if np.isfinite(pairs).all() and grows_evenly(times) else None


def _below_its_count(header: list[str], pairs: Samples) -> tuple[list[str], Samples]:
    """Return header and pairs, of which the first is no pair where it is count and step of those below it."""
    said = _count_and_step(list(pairs[0]))
    if said is None or grows_evenly(pairs[:, 0]):
        return header, pairs
    return [*header, said[1]], pairs[1:]


def _table_error(lines: list[str], reason: str) -> InputError:
    """Return the error of a table, or of a text with some numbers in it: less than half of its lines hold numbers only."""
    written = [line for line in lines if line.strip()]
    numbers = sum(_NUMERIC.fullmatch(line) is not None for line in written)
    return InputError(reason) if 2 * numbers >= len(written) else NoRecordError(reason)


def _separators(text: str, lines: list[str]) -> tuple[str, str]:
    """Return the characters between columns besides blanks, and the decimal comma, "" without one."""
    if not _in_numbers(",", text, lines):
        return ";", ""
    semicolon, point, tab = (_in_numbers(sign, text, lines) for sign in ";.\t")
    if point and not (semicolon or tab):  # most are; one look more at each line tells the others apart
        return ",", ""
    body = [line for line in lines if _NUMERIC.fullmatch(line)]
    if semicolon or (tab and any("," in field.strip(" ,") for line in body for field in line.split("\t"))):
        if point:
            raise InputError(
                'found numbers with both points and commas, such as "1.234,5"; write them with points only'
            )
        return ";", ","
    if point or any(re.search(r",\s|\s,|^\s*,|,\s*$", line) for line in body):
        return ",", ""
    if any(re.search(r"\S\s+\S", line) for line in body):
        return "", ","
    raise InputError(
        f'found "{next(line for line in body if "," in line).strip()[:40]}": a comma may be decimal or between '
        'columns; write points in numbers, or ";" between columns'
    )


def _in_numbers(sign: str, text: str, lines: list[str]) -> bool:
    """Return whether a character stands in one of the lines that hold numbers only."""
    return sign in text and any(sign in line and _NUMERIC.fullmatch(line) for line in lines)


def _even_rows(lines: Sequence[str], width: int, between: str, decimal: str) -> "array[float]":
    """Return the numbers of the first ``lines``, as far as all hold ``width`` of them, as plainly written as most are.

    They are those that :func:`_numbers` gives. A piece after the other: all words at once would take thirty times their size.
    """
    rows = array("d")
    for first in range(0, len(lines), _PIECE):
        text = "\n".join(lines[first : first + _PIECE]).replace('"', " ")
        if between:
            text = text.replace(between, " ")
        if decimal:
            text = text.replace(decimal, ".")
        words = [line.split() for line in text.split("\n")]
        if "_" in text or set(map(len, words)) != {width}:
            break
        try:
            rows.extend(list(map(float, chain.from_iterable(words))))
        except ValueError:
            break
    return rows


def _numbers(line: str, between: str, decimal: str) -> list[float] | None:
    """Return the numbers of a line, ``None`` if it holds anything else."""
    if "_" in line:  # Python would read 1_0 as ten
        return None
    if '"' in line:
        line = line.replace('"', " ")
    if between:
        line = line.replace(between, " ")
    if decimal:
        line = line.replace(decimal, ".")
    if _SIGN.search(line) and _TOUCHING.fullmatch(line):  # few lines get to the second, which is slower
        line = _SIGN.sub(r" \g<0>", line)
    try:
        return [float(token) for token in line.split()]
    except ValueError:
        pass
    try:
        return [float(token) for token in line.upper().replace("D", "E").split()]  # Fortran's double precision
    except ValueError:
        return None
