"""Numbers as people write them, and as TOML wants them."""

import re
import unicodedata
from typing import NamedTuple

_LONGEST = 60  # characters of a number that is looked at
_NUMBER = re.compile(
    r"(?P<sign>[+-]?)(?P<digits>[\d.](?:[\d.,'_ ]*[\d.])?)"
    r"(?:(?:e|\s*[x×*·]\s*10\s*(?:\^|\*\*)\s*)(?P<exponent>[+-]?\d+))?\s*(?P<unit>[^\d\s.,][^,;]*)?",
    re.IGNORECASE,
)
_BEARING = re.compile(r"([NS])\s*(\d+(?:\.\d+)?)\s*°?\s*([EW])", re.IGNORECASE)


class Numeral(NamedTuple):
    """The numbers that a text may mean, as TOML writes them, the likelier one first, and the unit behind."""

    values: list[str]
    unit: str = ""


def ascii_marks(text: str) -> str:
    """Return the text with the plain marks and digits of the keyboard for those of a word processor or of wide letters."""
    text = re.sub(r"(?<=\d)\s*[×·]\s*(?=1)", "*", text.replace("²", "2"))
    text = unicodedata.normalize("NFKC", re.sub(r"(?<=[«‹])\s+|\s+(?=[»›])", "", text))
    return text.translate(_PLAIN)


_PLAIN = str.maketrans({
    **dict.fromkeys("“”„‟«»「」『』", '"'), **dict.fromkeys("‘’‚‛‹›", "'"), **dict.fromkeys("−–—", "-"), "、": ",", "。": ".",
})  # fmt: skip


def numeral(text: str) -> Numeral:
    """Return what a text means as a number; no values if it has none. "1,800" is 1800, or 1.8 where the comma parts decimals."""
    text = ascii_marks(text[:_LONGEST]).strip()
    bearing = _BEARING.fullmatch(text)
    if bearing:
        first, angle, second = bearing.groups()
        east = float(angle) if second.upper() == "E" else -float(angle)
        return Numeral([f"{(east if first.upper() == 'N' else 180.0 - east) % 360.0:g}"])
    match = _NUMBER.fullmatch(re.sub(r"^10\s*(?:\^|\*\*)\s*(?=[+-]?\d+$)", "1e", text))
    if match is None:
        return Numeral([])
    power = f"e{match['exponent']}" if match["exponent"] else ""
    return Numeral([f"{match['sign']}{value}{power}" for value in _readings(match["digits"])], match["unit"] or "")


def _readings(digits: str) -> list[str]:
    """Return the readings of digits with points, commas and other marks between them."""
    digits = re.sub(r"(?<=\d)['_ ]+(?=\d{3}(?!\d))", "", digits)
    if not re.fullmatch(r"[\d.,]*\d[\d.,]*", digits):
        return []
    marks = re.sub(r"\d", "", digits)
    place = max(digits.rfind(","), digits.rfind("."))
    whole, decimals = re.sub("[.,]", "", digits[: max(place, 0)]), digits[place + 1 :]
    decimal = f"{whole.lstrip('0') or '0'}.{decimals or '0'}"
    thousands = re.sub("[.,]", "", digits)
    grouped = len(set(marks)) == 1 and re.fullmatch(r"[1-9]\d{0,2}(?:[.,]\d{3})+", digits) is not None
    if not marks:
        return [digits.lstrip("0") or "0"]
    if marks == "," and grouped:
        return [thousands, f"{float(decimal):g}"]
    if len(marks) == 1 or (len(set(marks)) == 2 and marks.count(marks[-1]) == 1):
        return [decimal]
    return [thousands] if grouped else []
