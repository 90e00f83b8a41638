"""The message about a text that is not TOML, with the line as it was probably meant."""

import re
import tomllib
from functools import partial
from itertools import islice
from pathlib import Path

from rockbatch.common.files import legible

_LONGEST = 80  # characters of a reason, and of a line, that are shown

_RULES = "texts stand in quotes, decimals behind a point, and a number alone; [[…]] above each of several tables"

_MOST_LINES, _MOST_TRIED = 2_000, 10  # lines that are searched for a slip, and meanings of which the text is tried
_LONGEST_LINE = 300

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


def syntax_error(path: Path, text: str, error: str) -> str:
    """Return the message about a text that the parser refuses with ``error``: its line, and what was meant or TOML's rules."""
    place = re.search(r" *\(at (?:line (\d+), column \d+|end of document)\)", error)
    reason = error[: place.start()] if place else error
    lines = text.split("\n")
    number = int(place[1]) if place and place[1] else max(1, len(text.rstrip().split("\n")))
    because = legible(f"{reason[:1].lower()}{reason[1:_LONGEST]}")
    meant = meant_line(lines[number - 1].strip())
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
    match = re.fullmatch(r"([\w.\"-]+)[ \t]*(?:==|:=|[=:])[ \t]*([^#]*?)[ \t;]*(#.*)?", line)
    if not match or _is_toml(line):
        return ""
    key, value, comment = match.groups()
    for mend in (str, _backslashes, _quotes, _word, _number, _values, partial(_without_unit, key)):
        meant = f"{key} = {mend(value)}"
        if value and _is_toml(meant):
            return f"{meant}  {comment}" if comment else meant
    return ""


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
    """Return a text with the same quotes at both ends; a value without quotes, or with quotes inside, as it is."""
    inside = value.strip("\"'“”‘’„")
    return f'"{_backslashes(inside)}"' if inside != value and not re.search("[\"'“”]", inside) else value


def _word(value: str) -> str:
    """Return a truth value, as "yes" or "Off", in TOML's words, another single word or path in quotes, and all else as it is."""
    truth = {"true": "true", "yes": "true", "on": "true", "false": "false", "no": "false", "off": "false"}
    if value.lower() in truth:
        return truth[value.lower()]
    return f'"{_backslashes(value)}"' if re.fullmatch(r"[^\W\d][\w./\\-]*|[A-Za-z]:[\w./\\-]*", value) else value


def _number(value: str) -> str:
    """Return a number as TOML writes it: digits around the point, no blanks or commas between thousands; others as they are.

    A single comma may be one of decimals or of a list, or of thousands, and stays.
    """
    number = re.sub(r"(?<=\d)[ '](?=\d{3}\b)", "", value)
    if re.fullmatch(r"[-+]?\d{1,3}(?:,\d{3})+\.\d*|[-+]?\d{1,3}(?:,\d{3}){2,}", number):
        number = number.replace(",", "")
    return _written(number) if re.fullmatch(_NUMBER, number) else value


def _without_unit(key: str, value: str) -> str:
    """Return a number without the unit in which its key ends, "4.0" for "4.0 m" of width_m; all else as it is."""
    number, _, unit = value.rpartition(" ")
    same = unit and key.lower().endswith("_" + re.sub(r"[ /·*^]", "_", unit).replace("²", "2").lower())
    return _number(number.strip()) if same else value


def _written(number: str) -> str:
    """Return a number with a digit at each side of its point, and no zeros before it, which TOML refuses."""
    number = re.sub(r"(?<!\d)\.", "0.", re.sub(r"\.(?!\d)", ".0", number))
    return re.sub(r"^([-+]?)0+(?=\d)", r"\1", number)


def _values(value: str) -> str:
    """Return several values as a list: in brackets, with a comma between each two; a single value, or another, as it is.

    Without brackets, a comma and a space have to separate them: "1,5" may be a number, and "1 800" too.
    """
    inside = re.fullmatch(r"[\[({](.*?)[\])}]?", value)
    words = re.split(r"[ \t]*[;,][ \t]*|[ \t]+", inside[1].strip()) if inside else re.split(r"[;,][ \t]+", value)
    if len(words) < 2 or not all(re.fullmatch(rf"{_NUMBER}|\"[^\"]*\"", word) for word in words):
        return value
    return f"[{', '.join(word if word.startswith(chr(34)) else _written(word) for word in words)}]"
