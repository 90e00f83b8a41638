"""Tables of numbers in text: comment and header lines, and columns with the separators of programs and Excel."""

import re
from array import array
from collections.abc import Sequence
from itertools import chain

import numpy as np

from rockbatch.common.errors import InputError, NoRecord, Truncated, Unstated
from rockbatch.motions.formats.column_header import columns_named, stated_count
from rockbatch.motions.formats.fixed_width import is_cut_short, lines_of, without_end_marks
from rockbatch.motions.formats.spelled_out import spelled_out
from rockbatch.motions.formats.time_steps import grows_evenly
from rockbatch.motions.limits import HUGE
from rockbatch.motions.motion import Samples

_COMMENT = ("#", "%")
_WRAPPED = {"layout": "wrapped"}  # a possible statement about a table with a shorter last row
_LONGEST, _MOST_HEADER = 300, 300  # characters of a header line, and header lines, that are read
_MOST_COUNTS = 3  # greatest count of numbers above a table that state its size
_FEWEST_PAIRS = 5
_PIECE = 10_000  # lines parsed at once
_TOUCHING = re.compile(  # with points, unlike a date such as 2010-11-14; possessive: digits may end one number or begin the next
    r"\s*+(?:[-+]?\d*+\.\d++(?:[EDed][-+]?\d++)?\s*+)+"  # but for the groups: Python 3.11.2 errs there
)
_CONTINUED = "\\ \t"  # ends of lines by some programs
_SIGN = re.compile(r"(?<=[\d])-(?=[\d.])")
_NUMERIC = re.compile(r'[-+.,;"\s]*[0-9][-+0-9.,;eEdD"\s]*')


def read_table(
    text: str, wrapped: bool = False, named: bool = True, stated: Sequence[str] = ()
) -> tuple[list[str], Samples]:
    """Return the header lines, without comment signs, and the table of numbers, shape (npts, columns).

    Columns are separated by blanks, tabs, commas or semicolons. Commas are decimal only if they can be nothing else: between
    semicolons, tabs or blanks in a file without decimal points. A ``wrapped`` table is one column that continues from line
    to line, shape (npts, 1), as is one whose header states as many samples as there are numbers; its last row may be shorter.
    Columns with names in the header are not wrapped, unless ``named`` is False. Pairs of time and value, several on a line, are
    a table of two columns. ``stated`` lines go before the header; numbers above the table that state its size go into it.

    Raises ``InputError`` with the line for a row unlike those above it, and for commas of unclear meaning.
    """
    header: list[str] = list(stated)
    counts: list[tuple[float, InputError]] = []  # stated above the rows, each with the error if they are others
    text = without_end_marks(text)
    remainder: list[float] = []
    rows, row_lines, width, end = array("d"), array("q"), 0, 0
    lines = [line.rstrip(_CONTINUED) for line in lines_of(text)] if "\\" in text else lines_of(text)
    separators = _separators(text, lines)
    for i, line in enumerate(lines):
        if i < end:  # read with the block of rows above
            continue
        stripped = line.strip()
        comment = stripped.startswith(_COMMENT)
        row = None if comment else _numbers(stripped, *separators)
        if row and len(row) < width and not any(map(str.strip, lines[i + 1 :])):
            remainder = row
        elif row:
            if width and len(row) != width:
                error = _table_error(lines, f"line {i + 1}: found {len(row)} numbers; expected {width} as above")
                statement = _count_and_step(rows) if len(rows) <= _MOST_COUNTS else None
                if statement is None:
                    raise error
                counts.append((statement[0], error))
                header.insert(len(stated) + len(counts) - 1, statement[1])
                rows, row_lines, width = array("d"), array("q"), 0
                separators = _separators(text, lines[i:])  # the count may have a point above decimal commas
                row = _numbers(stripped, *separators) or row
            block = [] if width else _even_rows(lines[i + 1 : -1], len(row), *separators)
            width = len(row)
            end = i + 1 + len(block) // width
            rows.extend(chain(row, block))
            row_lines.extend(range(i, end))
        elif stripped.strip(' ;,\t"'):
            if rows and not comment:
                raise _table_error(lines, f'line {i + 1}: found "{stripped[:60]}"; expected {width} numbers as above')
            if len(header) < _MOST_HEADER:
                header += spelled_out(stripped.lstrip("#% \t")[:_LONGEST])
    if not rows:
        raise NoRecord("no columns of numbers found in it")
    pairs = None if wrapped and not named else _pairs(rows, remainder, width)
    if width > 1 and (wrapped or stated_count(header) == len(rows) + len(remainder)):
        wrapped = not (named and columns_named(header, width))
    if remainder and pairs is None and not wrapped:
        reason = f"line {len(lines)}: found {len(remainder)} numbers; expected {width} as above"
        refusal = _table_error(lines, reason)
        may_be_wrapped = width > 2 and not isinstance(refusal, NoRecord)
        raise Unstated(reason, keys=("layout",), choices=(_WRAPPED,)) if may_be_wrapped else refusal
    table = np.array(rows).reshape(-1, width)
    wild = ~(np.abs(table) < HUGE).all(axis=1)
    if wild.any():
        i = row_lines[int(wild.argmax())]
        raise InputError(f'line {i + 1}: found "{lines[i].strip()[:60]}"; expected finite numbers')
    if is_cut_short(lines[i].split()[-1].replace(",", ".") for i in reversed(row_lines)):
        raise Truncated(
            f"line {row_lines[-1] + 1}: its last number is shorter than all others: the file is cut; fetch it again"
        )
    if pairs is not None:
        statement = None if grows_evenly(pairs[:, 0]) else _count_and_step(list(pairs[0]))
        header, table = (header, pairs) if statement is None else ([*header, statement[1]], pairs[1:])
    elif wrapped:
        table = np.append(table.ravel(), remainder).reshape(-1, 1)
    for count, error in reversed(counts):
        if count not in (table.size, len(table)):
            raise error
    return header, table


def _count_and_step(numbers: Sequence[float]) -> tuple[float, str] | None:
    """Return the count of samples and its header line: (4000.0, "NPTS = 4000"), with ", DT = 0.005 s" if a step is given.

    The ``numbers`` are the count, alone or with the step [s] before or after it; a third one, such as RspMatch's count of
    leading zeros, is ignored. None if the count is not whole or below 2, or the step not between 0 and 1 s.
    """
    first, *others = numbers
    step = others[0] if others else None
    if step is not None and 0.0 < first < 1.0:
        first, step = step, first
    if not first.is_integer() or first < 2 or not (step is None or 0.0 < step < 1.0):
        return None
    return first, f"NPTS = {first:.0f}" + ("" if step is None else f", DT = {step:.12g} s")


def _pairs(rows: Sequence[float], remainder: Sequence[float], width: int) -> Samples | None:
    """Return numbers as pairs of time and value, shape (npts, 2); ``None`` unless at least five whose times grow evenly.

    Programs for structures write several pairs on a line; they differ from other tables by these times. Several on a line may
    have the value first.
    """
    numbers = np.array([*rows, *remainder]) if remainder else np.array(rows)
    if width % 2 or len(numbers) % 2 or len(numbers) < 2 * _FEWEST_PAIRS:
        return None
    pairs = numbers.reshape(-1, 2)
    if not np.isfinite(pairs).all():
        return None
    if grows_evenly(pairs[1:, 0]):  # a count and a step may stand above them
        return pairs
    return pairs[:, ::-1] if width > 2 and grows_evenly(pairs[:, 1]) else None


def _table_error(lines: list[str], reason: str) -> InputError:
    """Return the error of a bad table: ``NoRecord`` if fewer than half of the lines are numbers only."""
    written = [line for line in lines if line.strip()]
    numbers = sum(_NUMERIC.fullmatch(line) is not None for line in written)
    return InputError(reason) if 2 * numbers >= len(written) else NoRecord(reason)


def _separators(text: str, lines: list[str]) -> tuple[str, str]:
    """Return the separator of columns besides blanks, and the decimal comma or "": (";", "") for numbers without commas."""
    if not _in_numbers(",", text, lines):
        return ";", ""
    semicolon, point, tab = (_in_numbers(sign, text, lines) for sign in ";.\t")
    if point and not (semicolon or tab):  # the usual case; the others need another pass over the lines
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
    """Return whether the character ``sign`` occurs in a line of numbers only."""
    return sign in text and any(sign in line and _NUMERIC.fullmatch(line) for line in lines)


def _even_rows(lines: Sequence[str], width: int, between: str, decimal: str) -> "array[float]":
    """Return the numbers of the ``lines`` before the first piece of :data:`_PIECE` with a line unlike ``width`` plain numbers.

    They equal those of :func:`_numbers`, but are faster. In pieces, since all words at once would take thirty times the size of
    the text.
    """
    rows = array("d")
    for first in range(0, len(lines), _PIECE):
        text = _plain("\n".join(lines[first : first + _PIECE]), between, decimal)
        words = [line.split() for line in text.split("\n")]
        if "_" in text or set(map(len, words)) != {width}:
            break
        try:
            rows.extend(list(map(float, chain.from_iterable(words))))
        except ValueError:
            break
    return rows


def _plain(text: str, between: str, decimal: str) -> str:
    """Return a text with blanks in place of quotation marks and separators, and points in place of decimal commas."""
    text = text.replace('"', " ")
    text = text.replace(between, " ") if between else text
    return text.replace(decimal, ".") if decimal else text


def _numbers(line: str, between: str, decimal: str) -> list[float] | None:
    """Return the numbers of a line, also touching ones and with D exponents; [] for a blank line, ``None`` for other texts."""
    if "_" in line:  # Python would read 1_0 as ten
        return None
    line = _plain(line, between, decimal)
    if _SIGN.search(line) and _TOUCHING.fullmatch(line):  # the second is slower, and few lines reach it
        line = _SIGN.sub(r" \g<0>", line)
    try:
        return [float(token) for token in line.split()]
    except ValueError:
        pass
    try:
        return [float(token) for token in line.upper().replace("D", "E").split()]  # Fortran's double precision
    except ValueError:
        return None
