"""Numbers in the fixed columns of Fortran programs, with or without blanks between them, ``-11024.7-9733.1``, and lines of a
known count of numbers between blanks."""

import re
from collections.abc import Callable, Iterable, Sequence
from itertools import islice
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from rockbatch.common.errors import InputError, Truncated
from rockbatch.motions.limits import HUGE
from rockbatch.motions.motion import Samples

T = TypeVar("T")
_LONGEST = 10**6  # characters of a line
_END_MARK = re.compile(  # "-inf" is none
    r"[*=/&~_-]+|(?:[*/&!=]|--)[*/&!=~_ -]*[a-z].*|"
    r"(?:[#$%@;:<(\[{]+\s*|-\s+)?(?:end|eof|eod|fin|fine|ende|stop)(?:[ _.:-]*(?:of|data|file|record)\b.*)?\W*",
    re.IGNORECASE,
)
_MOST_MARKS, _LONGEST_MARK = 10, 300  # lines, and characters of one
_ALIGNED = 20  # lines whose numbers are hardly right-aligned by chance
_WORD = re.compile(r"\S+")
_MANY = 100  # numbers that hardly have the same number of decimals by chance
_PRINTED = re.compile(r" *[-+]?\d*(?P<fraction>\.\d+)?(?P<power>[Ee][-+]\d\d?)?")
_OTHER, _BLANK, _PLUS, _MINUS, _DIGIT, _POINT, _POWER = 0x00, 0x20, 0x40, 0x50, 0x60, 0x80, 0xA0
_KINDS = {" ": _BLANK, "+": _PLUS, "-": _MINUS, ".": _POINT, "E": _POWER, "e": _POWER}
_KINDS |= {str(digit): _DIGIT + digit for digit in range(10)}
_CODES = bytes(_KINDS.get(chr(i), _OTHER) for i in range(256))
"""Codes of characters: three bits for their kind, which rises along a number, one for the sign, four for a digit."""
_DIGITS = 15  # decimal digits that a float holds exactly
_POWERS = np.array([float(f"1e{power}") for power in range(23)])  # exact, too
LOOKED_AT = 1000
"""Numbers at the end of a file that ``is_cut_short`` reads."""


def lines_of(text: str) -> list[str]:
    """Return the lines of a file with any line ends, without NULs, Ctrl-Z and line breaks at its end.

    ``str.splitlines`` would also break at control characters of Latin-1 texts. Raises ``InputError`` for a line longer than
    any line of numbers: its words would take thirty times its size.
    """
    lines = text.rstrip("\x00\x1a\r\n").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    if len(text) > _LONGEST:
        for number, line in enumerate(lines, 1):
            if len(line) > _LONGEST:
                raise InputError(f"line {number} has {len(line):,} characters; expected {_LONGEST:,} at most")
    return lines


def without_end_marks(text: str) -> str:
    """Return a text without blanks and up to ten end marks at its end: "*** End Data ***", "*ENDDATA", "<EOF>", "====="."""
    for _ in range(_MOST_MARKS):
        text = text.rstrip()
        last = text[-_LONGEST_MARK:].splitlines()[-1:]
        if not last or len(last[0]) == _LONGEST_MARK or not _END_MARK.fullmatch(last[0].strip()):
            break
        text = text[: -len(last[0])]
    return text


def one_after_another(text: str, channel: Callable[[list[str], int], tuple[T, int]]) -> list[T]:
    """Return the channels of a file: ``channel`` takes the lines and an index, and returns the channel and its end.

    Raises ``InputError`` for a file without channels.
    """
    lines = lines_of(text)
    channels = []
    index = 0
    while index < len(lines):
        if lines[index].strip():
            recording, index = channel(lines, index)
            channels.append(recording)
        else:
            index += 1
    if not channels:
        raise InputError("the file is empty")
    return channels


def fixed_numbers(lines: Sequence[str], first: int, count: int, width: int, per_line: int) -> tuple[Samples, int]:
    """Return ``count`` numbers from ``lines[first]`` on, shape (count,), and the index of the line after them.

    There are ``per_line`` of ``width`` characters each: every line is full but the last, which has exactly the rest; blanks may
    follow. Raises ``InputError`` with the line for anything else, before memory is allocated for a count beyond the lines.
    """
    needed = -(-count // per_line)
    if len(lines) - first < needed:
        raise Truncated(
            f"{count} values from line {first + 1} on take {needed} lines, but the file ends with line {len(lines)}: "
            "it is cut; fetch it again"
        )

    def fields(line: str, index: int, expected: int) -> list[str]:
        line = line.rstrip()
        if len(line) != expected * width:
            raise InputError(
                f'line {index + 1}: found "{line[:40]}…", {len(line)} characters; '
                f"expected {expected} values of {width} characters each"
            )
        return [line[k : k + width] for k in range(0, len(line), width)]

    return _numbers(lines[first : first + needed], first, count, per_line, width, fields), first + needed


def _numbers(
    lines: Sequence[str],
    first: int,
    count: int,
    per_line: int,
    width: int,
    fields: Callable[[str, int, int], list[str]],
) -> Samples:
    """Return the numbers of lines, the first of index ``first``; ``fields`` splits a line, given its index and count.

    Lines of aligned columns of ``width`` characters, full but for the last, are parsed without it.
    """
    full = bool(count) and len(lines[0]) == min(per_line, count) * width
    aligned = aligned_numbers(lines, width) if full else None
    if aligned is not None and len(aligned) == count and (np.abs(aligned) < HUGE).all():
        return aligned
    values = np.empty(count)
    for i, line in enumerate(lines):
        place = i * per_line
        row = fields(line, first + i, min(per_line, count - place))
        try:
            numbers = list(map(float, row))  # suffices for all but Fortran's D exponents
        except ValueError:
            numbers = [np.nan]
        if "_" in line or not sum(map(abs, numbers)) < HUGE:
            numbers = [number_in(field, first + i) for field in row]
        values[place : place + per_line] = numbers
    return values


def aligned_numbers(lines: Sequence[str], width: int) -> Samples | None:
    """Return the numbers of lines in columns of one ``width``, all in the format of the first: F8.3, E15.7; else ``None``.

    They equal those of ``float``: a decimal of up to 15 digits, times or over a power of ten up to 22, is rounded once
    (Clinger, 1990). All columns are parsed at once, digit by digit.
    """
    full, text = len(lines[0]), "".join(lines)
    printed = _PRINTED.fullmatch(text[:width]) if width else None
    if printed is None or full % width or len(lines[-1]) % width or not text.isascii():
        return None
    power = printed.start("power") if printed["power"] else width
    point = printed.start("fraction") if printed["fraction"] else power
    if power > _DIGITS or not set(map(len, lines[:-1])) <= {full}:
        return None
    codes = np.frombuffer(text.encode().translate(_CODES), np.uint8).reshape(-1, width).T.copy()
    digits = codes & 0x0F
    if not _are_printed_alike(codes & np.uint8(0xE0), point):
        return None
    values, exponents = np.zeros(codes.shape[1]), np.zeros(codes.shape[1], dtype=int)
    for row in (*digits[:point], *digits[point + 1 : power]):
        values = 10.0 * values + row
    for row in digits[power + 2 :]:
        exponents = 10 * exponents + row
    exponents[(codes[power + 1 : power + 2] == _MINUS).any(axis=0)] *= -1
    exponents -= max(power - point - 1, 0)
    if np.abs(exponents).max() >= len(_POWERS):
        return None
    powers = _POWERS[np.abs(exponents)]
    values = np.where(exponents < 0, values / powers, values * powers)
    return np.where((codes[:point] == _MINUS).any(axis=0), -values, values)


def _are_printed_alike(kinds: npt.NDArray[np.uint8], point: int) -> bool:
    """Return whether kinds of characters, shape (width, numbers), are blanks, a sign and digits before ``point``, then equal."""
    whole, tail = kinds[:point], kinds[point:]
    in_order = ((whole > _OTHER) & (whole <= _DIGIT)).all() and (whole[1:] >= whole[:-1]).all()
    one_sign = ((whole == _PLUS).sum(axis=0) <= 1).all()  # a minus has the kind of a plus
    ends_in_digit = len(tail) > 0 or (whole[-1] == _DIGIT).all()
    return bool(in_order and one_sign and (tail == tail[:, :1]).all() and ends_in_digit)


def refuse_more(lines: Sequence[str], end: int, declared: str) -> None:
    """Raise ``InputError`` for text from ``lines[end]`` on, after the ``declared`` numbers: "the 40 values"."""
    number = next((i for i in range(end, len(lines)) if lines[i].strip()), None)
    if number is not None:
        raise InputError(f'line {number + 1}: found "{lines[number][:40]}" after {declared}')


def spaced_numbers(lines: Sequence[str], first: int, count: int, per_line: int) -> Samples:
    """Return ``count`` numbers between blanks from ``lines[first]`` to the end of the file, shape (count,).

    Every line has ``per_line`` of them but the last, which has the rest. Raises ``InputError`` with the line for anything else,
    before memory is allocated for more numbers than there are lines, and if the last number is cut short.
    """
    needed = -(-count // per_line)
    end = next((i for i in range(len(lines), first, -1) if lines[i - 1].strip()), first)
    if end - first != needed:
        raise InputError(
            f"{count} values from line {first + 1} on take {needed} lines, but there are {end - first}; fetch the file again"
        )

    def fields(line: str, index: int, expected: int) -> list[str]:
        row = line.split()
        if len(row) != expected:
            raise InputError(f"line {index + 1}: found {len(row)} numbers; expected {expected}")
        return row

    width = len(lines[first]) // min(per_line, count)
    values = _numbers(lines[first:end], first, count, per_line, width, fields)
    backwards = (field for index in range(end - 1, first - 1, -1) for field in reversed(lines[index].split()))
    if is_cut_short(backwards) or _ends_within_a_column(lines[first:end], per_line):
        raise Truncated(
            f'line {end}: found "{lines[end - 1].split()[-1][:40]}", shorter than all others: the file is cut'
        )
    return values


def _ends_within_a_column(lines: Sequence[str], per_line: int) -> bool:
    """Return whether the last number ends before its column, given that the lines before are right-aligned.

    This finds a file cut within a whole number, whose lost digits ``is_cut_short`` cannot count.
    """
    *full, last = ([match.end() for match in _WORD.finditer(line)] for line in lines[-_ALIGNED - 1 :])
    return per_line > 1 and len(full) > 1 and full.count(full[0]) == len(full) and last[-1] < full[0][len(last) - 1]


def number_in(field: str, index: int) -> float:
    """Return the number in a field of ``lines[index]``, also with Fortran's D exponent; raise ``InputError`` for others."""
    try:
        if "_" in field:  # Python would read 1_0 as ten
            raise ValueError
        value = float(field.upper().replace("D", "E"))
    except ValueError:
        value = np.nan
    if not abs(value) < HUGE:
        raise InputError(f'line {index + 1}: found "{field.strip()[:40]}"; expected a number')
    return value


def is_cut_short(backwards: Iterable[str]) -> bool:
    """Return whether the last number has fewer decimals than up to 1000 before it, which agree; False for fewer than 100 in all.

    A file cut within its last number has the right count, but a wrong value. The numbers come ``backwards``; only two are read
    unless the last one is short.
    """
    tokens = islice(backwards, LOOKED_AT)
    last_tail, tail_before = next(tokens, ""), next(tokens, "")
    usual = _tail(tail_before)
    if "." not in tail_before or _tail(last_tail) >= usual:
        return False
    tails = list(map(_tail, tokens))
    return len(tails) + 2 >= _MANY and set(tails) == {usual}


def _tail(token: str) -> int:
    """Return the number of characters from a number's point on; its length + 1 without a point."""
    return len(token) - token.rfind(".")
