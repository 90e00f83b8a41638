"""What is wrong about a text that is not TOML: the line, and how it was probably meant."""

import re
import tomllib
import unicodedata
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from rockbatch.common.files import legible
from rockbatch.toml.meant import number_meant
from rockbatch.toml.numerals import ascii_marks, numeral
from rockbatch.toml.section import Section

_LONGEST = 200  # characters of a line that are looked at: patterns may take the square of their number
_SHOWN = 80
_PAIR = re.compile(r"(?P<key>[^=\[]*?)\s*=\s*(?P<value>.*)")
_STRINGS = re.compile(r'("[^"]*"|\'[^\']*\')')
_BEHIND = re.compile(r"\s*(?:[;,.]|(?://|%|!|;|--)\s.*|/[*].*)$")
_TRUTH = re.compile(r"(true|yes|on)|(false|no|off)", re.IGNORECASE)


def syntax_error(path: Path, text: str, error: str, sections: Sequence[Section]) -> str:
    """Return the message about a text that a parser refuses with ``error``: its line, and what to write there."""
    place = re.search(r"\(at (?:line (\d+), column \d+|end of document)\)", error)
    reason = (error[: place.start()] if place else error)[:_LONGEST].strip()
    lines = text.split("\n")
    number = int(place.group(1)) if place and place.group(1) else max(1, len(text.rstrip().split("\n")))
    if re.search("overwrite|declare|twice|mutate", reason):
        advice = _second_time(lines, number, sections)
    else:
        number = _origin(lines, number)
        line = lines[number - 1][:_LONGEST]
        goes_on = _is_unclosed(line) and re.search(r"[\[,{]\s*(#.*)?$", line)
        advice = "the bracket that opens here does not close" if goes_on else _meant(line.strip(), sections)
    line = legible(lines[number - 1].strip()[:_SHOWN])
    because = f"{legible(advice)}; it reads" if advice else f"{reason[:1].lower()}{reason[1:]}"
    return f"{path}:{number}: not valid TOML: {because}: {line}"


def _origin(lines: list[str], number: int) -> int:
    """Return the line where a quote or bracket was opened that never closes, if the one where a parser stops is right itself."""
    if not _is_toml(lines[number - 1].strip()[:_LONGEST]):
        return number
    quoted = next((n for n, line in enumerate(lines[:number], 1) if _has_open_quote(line[:_LONGEST])), 0)
    return quoted or next((n for n in range(number, 0, -1) if _is_unclosed(lines[n - 1][:_LONGEST])), number)


def _has_open_quote(line: str) -> bool:
    value = line.partition("=")[2].strip()
    return value[:1] in ('"', "'") and not _STRINGS.match(value) and value[:3] not in ('"""', "'''")


def _is_unclosed(line: str) -> bool:
    """Return whether a list or table in braces begins in a line and does not end there."""
    value = _STRINGS.sub("", line).partition("=")[2].strip()
    return value[:1] in ("[", "{") and any(value.count(left) > value.count(right) for left, right in ("[]", "{}"))


def _second_time(lines: list[str], number: int, sections: Sequence[Section]) -> str:
    """Return what to write in place of a table or key that is there already."""
    line = lines[number - 1][:_LONGEST].strip()
    header = re.match(r"(\[\[?)\s*([\w.-]+)\s*\]", line)
    if header is None:
        return _second_key(lines, number)
    name, several = header[2], header[1] == "[["
    before = [(n, earlier[:_LONGEST].strip()) for n, earlier in enumerate(lines[: number - 1], 1)]
    inner = re.compile(rf"\[+\s*{re.escape(name)}\s*\.")
    same = re.compile(rf"\[\s*{re.escape(name)}\s*\]")
    first = next((n for n, earlier in before if same.match(earlier)), 0)
    if several and first:
        return f"write [[{name}]] in line {first}, too"
    if several:
        n, above = next(((n, earlier) for n, earlier in before if inner.match(earlier)), (0, ""))
        return f"{above} in line {n} stands before it: write it below the [[{name}]] that it belongs to" if n else ""
    section = next((section for section in sections if ".".join(section.at) == name), None)
    if section is None:
        return f"write [[{name}]] above each if it is one of several; else join both under one [{name}]"
    if section.many:
        return f"write [[{name}]] above each"
    return f"it is given a second time; write its keys under the [{name}] in line {first}"


def _second_key(lines: list[str], number: int) -> str:
    """Return what to do about a key that is there already, perhaps because the header of another table is missing."""
    header = next((line.strip() for line in reversed(lines[:number]) if line.lstrip().startswith("[")), "")
    again = f", or write {header[:_LONGEST]} above if another one begins here" if header.startswith("[[") else ""
    return f"it is given a second time; keep one{again}"


def _meant(line: str, sections: Sequence[Section]) -> str:
    """Return what to write in place of a line: itself with one slip corrected, or with all that it has; empty if unclear."""
    line = re.sub(r"\s#.*", "", line)
    if re.fullmatch(r"[^=]*=\s*", line):
        return "the value is missing behind the equals sign"
    for slip in (*_SLIPS, _all_slips):
        for meant in slip(line, sections):
            if meant != line and _is_toml(meant):
                return _written(line, meant, slip, sections)
    pair = _PAIR.fullmatch(line)
    has_unit = pair is not None and numeral(pair["value"]).unit
    return "write the number alone, in the unit of the key" if has_unit else ""


def _written(line: str, meant: str, slip: "Slip", sections: Sequence[Section]) -> str:
    readings = [reading for reading in slip(line, sections) if reading != meant and _is_toml(reading)]
    instead = f", or {readings[0]} if the comma parts decimals" if readings else ""
    return f"write {meant}{instead}"


def _is_toml(line: str) -> bool:
    try:
        return bool(tomllib.loads(line))
    except (ValueError, RecursionError):
        return False


Slip = Callable[[str, Sequence[Section]], Iterator[str]]


def _pair_slip(correct: Callable[[str, str], str]) -> Slip:
    """Return a slip of key and value."""

    def slip(line: str, sections: Sequence[Section]) -> Iterator[str]:
        pair = _PAIR.fullmatch(line)
        if pair:
            value, quoted = pair["value"], '"' in pair["value"] or "'" in pair["value"]
            yield correct(pair["key"], value if quoted else value.partition("#")[0].rstrip())

    return slip


def _typography(line: str, sections: Sequence[Section]) -> Iterator[str]:
    """Yield the line with the marks and letters of the keyboard outside of straight quotes; Greek ones of a key by name."""
    parts = _STRINGS.split(line)
    plain = "".join(part if n % 2 else ascii_marks(part) for n, part in enumerate(parts))
    key, equals, value = plain.partition("=")
    key = "".join(map(_latin, key))
    yield f"{key.strip()} = {value.strip()}" if equals else key


def _latin(letter: str) -> str:
    name = unicodedata.name(letter, "")
    return name.rpartition(" ")[2].lower().replace("lamda", "lambda") if name.startswith("GREEK ") else letter


def _equals(line: str, sections: Sequence[Section]) -> Iterator[str]:
    """Yield the line with one equals sign between key and value, and keys of one word."""
    pair = re.match(r"([A-Za-z][\w.-]*)\s*(?::=|==|:|<-|=>|<=)\s*(.+)", line) or re.match(
        r"([A-Za-z][\w.-]*)\s+(?!=)([^\s=].*)", line
    )
    if pair and "=" not in _STRINGS.sub("", pair[2]):
        yield f"{pair[1]} = {pair[2]}"
    slash = re.match(r"([A-Za-z]\w*)/(\w+)\s*=\s*(.+)", line)
    if slash:
        yield f"{slash[1]}_{slash[2]} = {slash[3]}"
    words = re.match(r"([A-Za-z][\w.-]*)\s*[\s\[(]\s*([A-Za-z][\w/.-]*)\s*[\])]?\s*=\s*(.+)", line)
    if words:
        yield f"{words[1]}_{words[2].replace('/', '_')} = {words[3]}"


def _header(line: str, sections: Sequence[Section]) -> Iterator[str]:
    """Yield the header of a section with its brackets closed."""
    header = re.fullmatch(r"([\[({<]*)\s*([A-Za-z][\w. -]*?)\s*([\])}>]*)\s*[:;]?", line)
    if header is None:
        return
    name, several = re.sub(r"[ -]+", "_", header[2]), max(len(header[1]), len(header[3])) > 1
    known = next((section.header for section in sections if section.at and ".".join(section.at) == name), "")
    if known or header[1] or header[3] or line.endswith(":"):
        yield known or (f"[[{name}]]" if several else f"[{name}]")


def _behind(key: str, value: str) -> str:
    """Return a pair without a mark, or a comment of another language, behind the value."""
    return f"{key} = {_BEHIND.sub('', value)}"


def _truth(key: str, value: str) -> str:
    written = _TRUTH.fullmatch(value)
    return f"{key} = {'true' if written[1] else 'false'}" if written else ""


def _list(key: str, value: str) -> str:
    """Return a pair with a list in square brackets that are closed, and commas in it."""
    items = re.split(r"\s*;\s*|,\s+", value)
    if len(items) > 1 and all(numeral(item).values for item in items):
        return f"{key} = [{', '.join(items)}]"
    inner = re.fullmatch(r"[\[({]\s*([^\[\](){}=:]*?)\s*[,;]?\s*[\])}]?", value)
    return f"{key} = [{', '.join(map(str.strip, inner[1].split(';')))}]" if inner else ""


def _quotes(key: str, value: str) -> str:
    """Return a pair with a text, or a list of texts, in quotes that close and hold no escapes."""
    listed = re.fullmatch(r"\[(.*)\]", value)
    values = [_quoted(item.strip()) for item in (listed[1].split(",") if listed else [value])]
    return f"{key} = [{', '.join(values)}]" if listed else f"{key} = {values[0]}"


def _quoted(value: str) -> str:
    bare = value.strip("\"'")
    if numeral(bare).values or not re.search(r"[A-Za-z+*-]", bare) or re.search(r"[\"'=>{]", bare):
        return value
    return f'"{bare.replace(chr(92), "/")}"'


def _numbers(line: str, sections: Sequence[Section]) -> Iterator[str]:
    """Yield the line with the readings of its number, or its list of numbers, in the unit of the key."""
    pair = _PAIR.fullmatch(line)
    if pair is None:
        return
    key, value = pair["key"], pair["value"]
    unit = next((section[key].unit for section in sections if key in section), "")
    listed = re.fullmatch(r"\[(.*)\]", value)
    if listed is None:
        yield from (f"{key} = {number}" for number in number_meant(key, unit, value))
        return
    items = [item.strip() for item in re.split(";" if ";" in listed[1] else ",", listed[1])]
    readings = [number_meant(key, unit, item)[:1] for item in items if item]
    if all(readings):
        yield f"{key} = [{', '.join(reading[0] for reading in readings)}]"


def _all_slips(line: str, sections: Sequence[Section]) -> Iterator[str]:
    """Yield the line with one slip after the other corrected, as far as it is needed."""
    for slip in _SLIPS * 2:
        corrected = next(slip(line, sections), "")
        if corrected and corrected != line:
            line = corrected
            yield line


_SLIPS: tuple[Slip, ...] = (
    _typography, _pair_slip(_truth), _numbers, _equals, _header, _pair_slip(_list), _pair_slip(_behind), _pair_slip(_quotes),
)  # fmt: skip
"""In the order in which they are tried."""
