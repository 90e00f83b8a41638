"""The name of a record for people: event and year, station, direction; "Imperial Valley 1979, Meloland, 270"."""

import re
from dataclasses import dataclass
from datetime import datetime
from html import unescape

from rockbatch.motions.labels.orientation import Orientation

_LONGEST = 80  # characters of a header's text that are read
_RECORD_OF = re.compile(r"^(?:record|rcrd) of +", re.IGNORECASE)
_QUAKE = re.compile(r"\b(?:earthquake|eq\.?)(?![a-z]).*", re.IGNORECASE)
_CLOCK = re.compile(r",?[ -]*\d{1,2}:\d\d.*|,? -\d{4}\b.*")
_STATE = re.compile(r", *[A-Z]{2,3}$")
_YEAR = re.compile(r"(?<!\d)(?:19|20)\d\d(?!\d)")
_SHORT_YEAR = re.compile(r"(?<!\d)\d{1,2}/\d{1,2}/(\d\d)(?!\d)")
_STAMP = re.compile(r"((?:19|20)\d\d)(0[1-9]|1[0-2])([0-3]\d)[ _T-]?(?:([0-2]\d)([0-5]\d)(?:\d\d)?)?")
_MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")
_DAY = re.compile(
    rf"(?:Mon|Tue|Wed|Thu|Fri|Sat|Sun)[a-z]*,? +({'|'.join(_MONTHS)}) +(\d{{1,2}}), *(\d{{4}})", re.IGNORECASE
)
_DATED = re.compile(r"\d{1,2}/\d{1,2}/(?:\d{4}|\d{2})(?!\d)(?: +\d{4}\b)?")
_DISTANCE = re.compile(
    r"^\d+(?:\.\d+)? ?km (?:[NSEW]{1,3}|(?:(?:north|south|east|west)-?)+) (?:of|from) ", re.IGNORECASE
)
_KINDS = re.compile(
    r"(?: (?:emergency|civil|community|fire|police|pumping|power|receiving|recording|centre|center|hospital|library|school"
    r"|station|sta|building|bldg|bld|site)\.?)+$",
    re.IGNORECASE,
)
"""Words for buildings at the end of a station's name."""
_EVENT, _STATION = 34, 20  # characters that fit beside numbers
_PART = 6  # characters of a part of a station's name that can stand for it
_CODE = 5  # letters that a word in capitals may have and be a code


@dataclass(frozen=True)
class Origin:
    """Event, station and direction of a record in words, from its header; empty where unknown."""

    event: str = ""  # name and year of the event, or its date: "Imperial Valley 1979"
    station: str = ""  # "Meloland"
    direction: str = ""  # of the horizontal component, as the header has it: "270", "N28W", "HNE"

    @property
    def label(self) -> str:
        """Return event, station and direction, shortened for tables; empty if neither event nor station is known."""
        return Origin(self.short_event, self.short_station, self.direction).full_label

    @property
    def full_label(self) -> str:
        """Return event, station and direction in full; empty if neither event nor station is known."""
        if not self.event and not self.station:
            return ""
        return ", ".join(filter(None, (self.event, self.station, self.direction)))

    @property
    def short_event(self) -> str:
        """Return the event in 34 characters at most, cut with "…" at its end, or before a year that ends it."""
        if len(self.event) <= _EVENT:
            return self.event
        if _YEAR.match(self.event[-4:]):
            return f"{self.event[: _EVENT - 6].rstrip()}… {self.event[-4:]}"
        return f"{self.event[: _EVENT - 1]}…"

    @property
    def short_station(self) -> str:
        """Return the station in 20 characters at most, without the event's place; of a long name the end, without "School"."""
        place = self.event.partition(" ")[0]
        station = self.station.removesuffix(f" {place}") if place else self.station
        if len(station) > _STATION:
            parts = [part for part in re.split(r" - |[/;]", station) if len(part.strip()) >= _PART]
            station = _KINDS.sub("", (parts or [station])[-1].strip())
        if len(station) <= _STATION:
            return station
        words = re.match(r"(.*[^ ,])[ ,]", station[:_STATION])
        return f"{words[1] if words else station[: _STATION - 1]}…"


UNKNOWN_ORIGIN = Origin()
"""For a record whose header states none."""


def origin_of(event: str = "", station: str = "", date: str = "") -> Origin:
    """Return the origin by a header's words for ``event`` and ``station``, 80 characters of each, and its text with the date."""
    return Origin(_event(event[:_LONGEST], date[:_LONGEST]), _without_capitals(station[:_LONGEST]))


def with_direction(origin: Origin, orientation: Orientation) -> Origin:
    """Return ``origin`` with a component's direction, its label or else azimuth, numbers in three digits, or ""."""
    label = re.sub(r"\s*deg(?:rees)?\.?$", "", orientation.label.strip(), flags=re.IGNORECASE)
    if label.isdecimal():
        label = f"{int(label):03d}"
    elif not label and orientation.azimuth is not None:
        label = f"{orientation.azimuth:03.0f}"
    return Origin(origin.event, origin.station, label)


def _event(text: str, date: str) -> str:
    """Return an event's name and year without "Record of", "earthquake", clock and state; its date if it has no name."""
    year = _year(date) or _year(text)
    name = _CLOCK.sub("", _QUAKE.sub("", _RECORD_OF.sub("", " ".join(text.split())))).strip(" ,-")
    if day := _DAY.fullmatch(name):
        return f"{day[3]}-{_MONTHS.index(day[1].capitalize()) + 1:02d}-{int(day[2]):02d}"
    if _DATED.fullmatch(name):
        return name
    name = _DATED.sub("", name).strip(" ,-")
    name = _without_capitals(_DISTANCE.sub("", _STATE.sub("", name)))
    if stamp := _STAMP.fullmatch(name):
        return f"{stamp[1]}-{stamp[2]}-{stamp[3]}" + (f" {stamp[4]}:{stamp[5]}" if stamp[4] else "")
    if not name:
        return _CLOCK.sub("", " ".join(date.split())).strip(" ,-")
    return name if not year or _YEAR.search(name) else f"{name} {year}"


def _year(text: str) -> str:
    """Return the year in a date or text, "" if none or in the future: "10/15/79 1817" gives "1979"."""
    today = datetime.now().year  # four digits behind a short date may be a clock time
    if short := _SHORT_YEAR.search(text):
        return str(2000 + int(short[1]) if 2000 + int(short[1]) <= today else 1900 + int(short[1]))
    return next((year for year in _YEAR.findall(text) if int(year) <= today), "")


TURKISH = str.maketrans("ÐÝÞðýþ", "ĞİŞğış")
"""From Latin-1, in which text of unknown encoding is read, to Windows-1254."""


def _without_capitals(text: str) -> str:
    """Return a text in capitals as words: "EL CENTRO - HWY 8" gives "El Centro - Hwy 8"; codes stay: "LGPC", "NP.8040"."""
    text = " ".join(unescape(text).split()).strip(" ,-")
    if not text.isupper() or (" " not in text and (len(text) <= _CODE or not text.isalpha())):
        return text
    return re.sub(r"(?<!\d)[^\W\d_]{2,}", lambda word: word[0].capitalize(), text)
