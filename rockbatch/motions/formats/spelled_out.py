"""Header lines that state a sign, a direction or a whole series in words, as labels and keys that others state them by."""

import re
from collections.abc import Sequence

from rockbatch.motions.labels.direction_words import folded, words

KEYED = re.compile(
    r"^(?P<key>[^\W\d_][^:=;\t]*?)\.?(?: (?:name|code))?(?: ?[(\[]deg(?:rees)?[)\]])?\s*[:=;\t]\s*(?P<label>\S.*?)\s*$",
    re.IGNORECASE,
)
"""Pattern of a header line with a key and what it states."""

DIRECTION_KEYS = words("filling") | {"COMP", "COMPONENT", "CHANNEL", "DIR", "DIRECTION", "ORIENTATION", "AZIMUTH"}
"""Keys of lines that state a direction, folded."""

_UNIT = r"(?P<unit>\s*[(\[][^()\[\]]*[)\]])?"
_SIGNED = re.compile(  # behind a label, and perhaps its unit: Up-down (cm/s/s) (+ is downward)
    rf"{_UNIT}\s*[(\[]\s*(?:\+|positive|pos\.?)\s*(?:is|:|=)?\s*"
    r"(?:(?P<down>down(?:wards?)?|dwn)|(?:up|north|east)(?:wards?)?)\s*[)\]]",
    re.IGNORECASE,
)
_ALONG = re.compile(  # of SCEC's broadband platform: Column 2: H1 component ground acceleration (+ is 035)
    rf"^(?P<column>column\s+\d{{1,3}}\s*[:=]\s*)(?=[^()\[\]]*\bacc)[^()\[\]]*+{_UNIT}\s*"
    r"[(\[]\s*\+ is (?P<azimuth>\d{1,3})(?:\.0*)?\s*[)\]]$",
    re.IGNORECASE,
)
_OF_SERVICE = re.compile(  # of EarthScope's time series, in pairs or lists
    r"^TIMESERIES\s+\S+,\s*(?P<npts>\d{1,9}) samples,\s*(?P<rate>[\d.]{1,12}) sps,.*,\s*(?P<unit>[^\s,]+)$",
    re.IGNORECASE,
)
_BETWEEN_KEYS = re.compile(r"\s*[,;]\s+|\s{2,}|\t")
_WIDE_SIGNS = str.maketrans("：＝；（）", ":=;()")
_COUNT_FIRST = re.compile(r"^(?P<npts>\d{1,9})[,\s]+(?P<dt>[\d.]{1,12})[,\s]+NPTS\s*,?\s*DT\b", re.IGNORECASE)
_VERTICAL_DOWN = re.compile(  # a whole line: others may speak of depth, or of the signs before a conversion
    r"vertical(?: (?:component|axis|acceleration|channel))?\s*(?:[:=]|\bis\b)?\s*(?:positive|pos\.?)(?: is)? ?down(?:wards?)?\.?",
    re.IGNORECASE,
)
_OF_SIGN = re.compile(r"(?=.*\bvertical\b)(?=.*\b(?:positive|pos)\b).*\bdown", re.IGNORECASE)


def spelled_out(line: str) -> list[str]:
    """Return a header line, and a named line for each property it states without a name; signs in brackets are in its labels.

    "TIMESERIES XX_AAA__HNE_D, 3000 samples, 100 sps, …, M/S**2" has a count, a rate and a unit; "Z (positive down)" is Z-down,
    "Column 2: H1 (+ is 35.0)" is 035, and "500 0.01 NPTS DT" a count and a step. What has a name beside a direction has its line.
    """
    line = line.translate(_WIDE_SIGNS)
    fields = _BETWEEN_KEYS.split(line)
    keyed = [match for field in fields if (match := KEYED.match(field))]
    if 1 < len(keyed) == len(fields) and any(folded(match["key"]).strip() in DIRECTION_KEYS for match in keyed):
        return fields
    if first := _COUNT_FIRST.match(line):
        return [f"NPTS = {first['npts']}, DT = {first['dt']}"]
    if along := _ALONG.match(line):
        return [f"{along['column']}{along['azimuth'].zfill(3)}{along['unit'] or ''}"]
    if service := _OF_SERVICE.match(line):
        return [line, f"NPTS = {service['npts']}", f"sampling rate = {service['rate']} Hz", f"unit: {service['unit']}"]
    return [_SIGNED.sub(lambda sign: ("-down" if sign["down"] else "") + (sign["unit"] or ""), line)]


def is_down(header: Sequence[str]) -> bool:
    """Return whether a line says only that vertical components are positive down, as ``vertical component positive down``."""
    return any(_VERTICAL_DOWN.fullmatch(line.strip(' #\t",;')) for line in header)


def line_about_sign(header: Sequence[str]) -> str:
    """Return the first line with the words vertical, positive and down, in whatever sense; empty without one."""
    return next((line for line in header if _OF_SIGN.match(line)), "")
