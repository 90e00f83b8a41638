"""The name of a record for people: event and year, station, direction; "Imperial Valley 1979, Meloland, 270"."""

import re
from dataclasses import dataclass
from html import unescape

from rockbatch.motions.orientation import Orientation

_LONGEST = 80  # characters of a text of a header that are looked at
_RECORD_OF = re.compile(r"^(?:record|rcrd) of +", re.IGNORECASE)
_QUAKE = re.compile(r"\b(?:earthquake|eq\.?)(?![a-z]).*", re.IGNORECASE)
_CLOCK = re.compile(r",?[ -]*\d{1,2}:\d\d.*|,? -\d{4}\b.*")
_STATE = re.compile(r", *[A-Z]{2,3}$")
_YEAR = re.compile(r"(?<!\d)(?:19|20)\d\d(?!\d)")
_SHORT_YEAR = re.compile(r"(?<!\d)\d{1,2}/\d{1,2}/(\d\d)(?!\d)")
_STAMP = re.compile(r"((?:19|20)\d\d)(0[1-9]|1[0-2])([0-3]\d)[ _T-]?(?:([0-2]\d)([0-5]\d)(?:\d\d)?)?")
_CENTURY = 30  # 29 is 2029, 30 is 1930: strong-motion records begin in 1933
_EVENT, _STATION = 34, 18  # characters in a line of a terminal
_CODE = 5  # letters that a word in capitals may have and be a code


@dataclass(frozen=True)
class Origin:
    """Event, station and direction of a record in words, as far as its header says it; empty where it does not."""

    event: str = ""  # name and year of the event, or its date: "Imperial Valley 1979"
    station: str = ""  # "Meloland"
    direction: str = ""  # of the horizontal component, as the header has it: "270", "N28W", "HNE"

    @property
    def label(self) -> str:
        """Event, station and direction; empty where the header tells neither event nor station."""
        if not self.event and not self.station:
            return ""
        return ", ".join(filter(None, (self.event, self.station, self.direction)))

    @property
    def short(self) -> "Origin":
        """With a station, and an event before its year, that fit into a line of a terminal beside numbers."""
        event = self.event
        if len(event) > _EVENT:
            event = (
                f"{event[: _EVENT - 6].rstrip()}… {event[-4:]}"
                if _YEAR.match(event[-4:])
                else f"{event[: _EVENT - 1]}…"
            )
        station = self.station if len(self.station) <= _STATION else f"{self.station[: _STATION - 1].rstrip(' -,')}…"
        return Origin(event, station, self.direction)


UNKNOWN_ORIGIN = Origin()
"""Of a record whose header tells nothing of it."""


def origin_of(event: str = "", station: str = "", date: str = "") -> Origin:
    """Return the origin by the words of a header: of the event and the station, and the line with the event's date."""
    return Origin(_event(event[:_LONGEST], date[:_LONGEST]), _in_words(station[:_LONGEST]))


def directed(origin: Origin, orientation: Orientation) -> Origin:
    """Return ``origin`` with the direction of a component: its label, three digits of an azimuth, or nothing."""
    label = re.sub(r"\s*deg(?:rees)?\.?$", "", orientation.label.strip(), flags=re.IGNORECASE)
    if label.isdecimal():
        label = f"{int(label):03d}"
    elif not label and orientation.azimuth is not None:
        label = f"{orientation.azimuth:03.0f}"
    return Origin(origin.event, origin.station, label)


def _event(text: str, date: str) -> str:
    """Return the name of an event with its year, without words that every header has; its date if it has no name."""
    year = _year(date) or _year(text)
    name = _CLOCK.sub("", _QUAKE.sub("", _RECORD_OF.sub("", " ".join(text.split())))).strip(" ,-")
    name = _in_words(_STATE.sub("", name))
    if stamp := _STAMP.fullmatch(name):
        return f"{stamp[1]}-{stamp[2]}-{stamp[3]}" + (f" {stamp[4]}:{stamp[5]}" if stamp[4] else "")
    if not name:
        return _CLOCK.sub("", " ".join(date.split())).strip(" ,-")
    return name if not year or _YEAR.search(name) else f"{name} {year}"


def _year(text: str) -> str:
    """Return the year of a date: four digits, or the last two of 10/15/79."""
    if year := _YEAR.search(text):
        return year[0]
    short = _SHORT_YEAR.search(text)
    return f"{19 if int(short[1]) >= _CENTURY else 20}{short[1]}" if short else ""


TURKISH = str.maketrans("ÐÝÞðýþ", "ĞİŞğış")
"""From Latin-1, in which text of unknown encoding is read, to Windows-1254."""


def _in_words(text: str) -> str:
    """Return a text without capitals throughout: "El Centro - Hwy 8/Meloland Overpass"; a code stays: "LGPC", "NP.8040"."""
    text = " ".join(unescape(text).split()).strip(" ,-")
    if not text.isupper() or (" " not in text and (len(text) <= _CODE or not text.isalpha())):
        return text
    return re.sub(r"(?<!\d)[^\W\d_]{2,}", lambda word: word[0].capitalize(), text)
