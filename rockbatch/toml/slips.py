"""The message about a text that is not TOML, with the line as it was probably meant."""

import re
import tomllib
from collections.abc import Iterable, Mapping
from functools import partial
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from rockbatch.common.files import legible
from rockbatch.common.units import NUMBER, number_in_unit_of

if TYPE_CHECKING:
    from rockbatch.toml.section import Section

_LONGEST = 80  # characters of a reason, and of a line, that are shown

_RULES = "texts belong in quotes, decimals take a point, and numbers no unit; [[…]] above each of several tables"

_MOST_LINES, _MOST_TRIED = 2_000, 10  # lines that are searched for a slip, and meanings of which the text is tried
_LONGEST_LINE = 300

_SIGN = re.compile(r"([^\s=:\[]+|[^=:\[\n]+?(?:\s*[\[(][^=:]*?[\])])?)[ \t]*(?:==|:=|[=:])|([\w\"-]+)[ \t]")
"""A key and the sign behind it, or the blank in its place; a unit in brackets may stand before the sign."""

_DECIMAL = r"\d+\.\d*(?:[eE]\+?\d+)?"


def syntax_error(path: Path, text: str, error: str, sections: "Iterable[Section]" = ()) -> str:
    """Return the message about a text that the parser refuses with ``error``: its line, and what was meant or TOML's rules.

    Of a key that is given before in its table it says where. A line that is the name of one of ``sections``, with other
    brackets or a colon, was meant as its header.
    """
    place = re.search(r" *\(at (?:line (\d+), column \d+|end of document)\)", error)
    reason = error[: place.start()] if place else error
    lines = text.split("\n")
    number = int(place[1]) if place and place[1] else max(1, len(text.rstrip().split("\n")))
    because = legible(f"{reason[:1].lower()}{reason[1:_LONGEST]}")
    headers = {".".join(section.at): section.header for section in sections}
    if first := _given_before(lines[:number]):
        return (
            f"{path}:{number}: {legible(lines[number - 1].strip()[:_LONGEST])}: given in line {first} already; keep one"
        )
    meant = _header(lines[number - 1].strip(), headers) or meant_line(lines[number - 1].strip())
    if not meant:
        number, meant = _earlier(lines) or (number, "")
    advice = f"write {meant}" if meant and len(meant) <= _LONGEST else _RULES
    return f"{path}:{number}: not valid TOML: {because}: {legible(lines[number - 1].strip()[:_LONGEST])}; {advice}"


def _earlier(lines: list[str]) -> tuple[int, str] | None:
    """Return the number of the first line that alone, written as :func:`meant_line` has it, makes the text TOML, and that line.

    None if none does, of the first 2,000 lines and ten lines with a meaning.

    The parser notices a text without its closing quotes, or a list without its bracket, only lines later.
    """
    meant = ((place, meant_line(line.strip())) for place, line in enumerate(lines[:_MOST_LINES]))
    for place, line in islice(((place, line) for place, line in meant if line), _MOST_TRIED):
        if _is_toml("\n".join([*lines[:place], line, *lines[place + 1 :]])):
            return place + 1, line
    return None


def meant_line(line: str) -> str:
    """Return a mistyped line "key = value" as it was probably meant: 'at = "left"' for "at = left".

    It is "" if the line is TOML already, is over 300 characters long, is no "key = value", or would still not be TOML, or could
    mean several things.
    """
    if len(line) > _LONGEST_LINE:
        return ""
    match = _SIGN.match(line)
    if not match or _is_toml(line):
        return ""
    key = re.sub(r"[ \t]+", "_", re.sub(r"[\[(].*", "", match[1] or match[2]).strip())
    parts = re.fullmatch(r"[ \t]*(.*?)[ \t;,]*(?:(?:#|//|[ \t][%!])[ \t]*(?=\D)(.*)|#(.*))?", line[match.end() :])
    if not re.fullmatch(r"[\w.\"-]+", key) or parts is None or "#" in parts[1]:
        return ""
    value, comment = parts[1], parts[2] or parts[3]
    for mend in (str, _backslashes, _quotes, _word, _number, _values, partial(_in_its_unit, key)):
        meant = f"{key} = {mend(value)}"
        if value and _is_toml(meant):
            return f"{meant}  # {comment}" if comment else meant
    return ""


def _given_before(lines: list[str]) -> int:
    """Return the number of the line that gives the key of the last of ``lines`` in the same table before; 0 if none does."""
    key = lines[-1].partition("=")[0].strip()
    if not key or not _is_toml(lines[-1]) or lines[-1].lstrip().startswith("["):
        return 0
    start = max((n for n, line in enumerate(lines) if line.lstrip().startswith("[")), default=-1)
    before = range(start + 1, len(lines) - 1)
    return next((n + 1 for n in before if lines[n].partition("=")[0].strip() == key and _is_toml(lines[n])), 0)


def _header(line: str, headers: Mapping[str, str]) -> str:
    """Return the header of the table that a line of brackets, or one that ends in a colon, names.

    "" for another line, an unknown name, or if the line is this header. ``headers`` has those of all tables by their names.
    """
    match = re.fullmatch(r"([\[({<]*)[ \t]*([A-Za-z_][\w.]*)[ \t]*([\])}>]*:?)", line)
    name = match[2].lower() if match and (match[1] or match[3]) else ""
    header = headers.get(name, "")
    return header if header != line else ""


def _is_toml(text: str) -> bool:
    try:
        tomllib.loads(text)
    except (ValueError, RecursionError):
        return False
    return True


def _backslashes(value: str) -> str:
    """Return ``value`` with slashes for backslashes: every system reads these, and TOML takes backslashes for characters."""
    return value.replace("\\", "/")


def _quotes(value: str) -> str:
    """Return a text with quotes of any kind at either end in double ones, without a prefix such as r, and with slashes.

    A value without such quotes, or with ", ', “ or ” inside, is returned as it is.
    """
    inside = re.sub(r"^[rbuf](?=[\"'])", "", value).strip("\"'“”‘’„«»")
    return f'"{_backslashes(inside)}"' if inside != value and not re.search("[\"'“”]", inside) else value


def _word(value: str) -> str:
    """Return a truth value, as "yes" or "Off", in TOML's words; another single word, or a path, in quotes; others unchanged.

    Backslashes of a path become slashes. A word begins with a letter, a path with that of a drive or as a word.
    """
    truth = {"true": "true", "yes": "true", "on": "true", "false": "false", "no": "false", "off": "false"}
    if value.lower() in truth:
        return truth[value.lower()]
    return f'"{_backslashes(value)}"' if re.fullmatch(r"[^\W\d][\w./\\-]*|[A-Za-z]:[\w./\\-]*", value) else value


def _number(value: str) -> str:
    """Return a number as TOML writes it: digits around the point, no blanks, ' or commas between thousands, e for × 10^ and d.

    A single comma without a point behind it may be one of decimals, of a list or of thousands: that number, as other values, is
    returned as it is.
    """
    number = re.sub(r"(?<=\d)[ '](?=\d{3}\b)", "", value)
    number = re.sub(r"[ ]*[×x*·][ ]*10[ ]*(?:\^|\*\*)[ ]*(?=[-+]?\d)", "e", number)
    number = re.sub(r"(?<=[\d.])[ ]*[dDeE][ ]*(?=[-+]?\d)", "e", number)
    if re.fullmatch(r"[-+]?\d{1,3}(?:,\d{3})+\.\d*|[-+]?\d{1,3}(?:,\d{3}){2,}", number):
        number = number.replace(",", "")
    return _written(number) if re.fullmatch(NUMBER, number) else value


def _in_its_unit(key: str, value: str) -> str:
    """Return a number with a unit in that in which its key ends, "4.0" for "4.0 m" or "4000 mm" of width_m; all else as it is."""
    number = number_in_unit_of(key, value)
    return _number(number) if number else value


def _written(number: str) -> str:
    """Return a number with a digit at each side of its point, and without leading zeros but one, as TOML requires."""
    number = re.sub(r"(?<!\d)\.", "0.", re.sub(r"\.(?!\d)", ".0", number))
    return re.sub(r"^([-+]?)0+(?=\d)", r"\1", number)


def _values(value: str) -> str:
    """Return several numbers or texts in quotes as a list: in brackets, with a comma between each two; others as they are.

    Without brackets, a comma or semicolon and a space have to separate them: "1,5" may be a number, and "1 800" too; "0.4-4.0"
    and "0.4 4.0" are two numbers.
    """
    if ends := re.fullmatch(rf"({_DECIMAL})(?:[ ]*(?:-|–|\.\.|:|to)[ ]*|[ ]+)({_DECIMAL})", value):
        value = f"[{ends[1]}, {ends[2]}]"
    inside = re.fullmatch(r"[\[({](.*?)[\])}]?", value)
    words = re.split(r"[ \t]*[;,][ \t]*|[ \t]+", inside[1].strip()) if inside else re.split(r"[;,][ \t]+", value)
    if len(words) < 2 or not all(re.fullmatch(rf"{NUMBER}|\"[^\"]*\"", word) for word in words):
        return value
    return f"[{', '.join(word if word.startswith(chr(34)) else _written(word) for word in words)}]"
