"""Direction of a component, from the many labels that agencies give it.

A direction that no label states stays unknown: a vertical component would otherwise be run as a horizontal one.
"""

import re
from collections import Counter
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

from rockbatch.common.grouping import grouped
from rockbatch.motions.labels.direction_words import WORDS, folded, pairs, words

MOST_KEPT = 8192
"""Labels and stems of which the result is kept: those of a large folder, which several readers ask for."""


@dataclass(frozen=True)
class Orientation:
    """Direction of a component."""

    label: str  # as in the file: "228", "NS", "DWN", "HNZ"; empty without one
    vertical: bool = False
    azimuth: float | None = None  # of a horizontal component [degrees clockwise from north, 0 ≤ azimuth < 360]
    down: bool = False  # whether a vertical component is positive down
    known: bool = True  # whether it is known to be horizontal or vertical

    @property
    def without_azimuth(self) -> bool:
        """Return whether it is known to be horizontal, of an unknown azimuth."""
        return self.known and not self.vertical and self.azimuth is None


def unknown(label: str = "") -> Orientation:
    """Return an unknown orientation, neither horizontal nor vertical, with its ``label``."""
    return Orientation(label, known=False)


UNKNOWN = unknown()
"""For a file without a direction."""

_VERTICAL = words("vertical") | pairs("up", "down") | pairs("above", "below")
_UP, _DOWN = words("up"), words("down")
_VERTICAL_WITH_SIGN = _VERTICAL - {"U"}  # U-Down is a pair
_AZIMUTHS = {
    **dict.fromkeys(words("north") | words("ns") | pairs("north", "south"), 0.0),
    **dict.fromkeys(words("east") | words("ew") | pairs("east", "west"), 90.0),
    **dict.fromkeys(words("south"), 180.0),
    **dict.fromkeys(words("west"), 270.0),
}
_HORIZONTAL = words("horizontal")
_ENGLISH = {word for of_meaning in WORDS["English"].values() for word in of_meaning.split()}
_ELSEWHERE_IN_NAMES = (
    {  # places are called Nord and Est, and people have initials
        word for meaning in ("north", "south", "east", "west", "ns", "ew") for word in words(meaning)
    }
    - _ENGLISH
    - {"NORTE", "SUR", "ESTE", "OESTE"}
)

# SEED channel codes with or without location: band, instrument (N, L, G: accelerometers; H: seismometers), direction.
_CHANNEL = re.compile(r"(?!CH\d)[BCDEFGHLMSV][NLGH]([ZUVNE12RTXY])(?:\d\d)?")
_CHANNEL_IN_NAME = re.compile(r"[BEHLS][NLGH][ZNE12](?:\d\d)?")  # three letters of a name may be anything else
_SENSOR = re.compile(r"(UD|NS|EW)[12]")  # KiK-net: 1 in the borehole, 2 at the surface
_QUADRANT = re.compile(r"([NS])(\d{1,2})([EW])")
_FILLING = "|".join(sorted(words("filling"), key=len, reverse=True))
_NOISE = re.compile(
    rf"^A(?=[-_ ])|ACCELERATIONS|COMPONENTE?S|{_FILLING}|ACCELERATION|ACCEL|ACC|COMPONENT|COMP|"
    r"CHAN(?:NEL)?(?=[\W\d_]*[^\W\d_])|AXIS|DIRECTION|DIR|DEG(?:REES)?|[\W_]"
)


@lru_cache(maxsize=MOST_KEPT)
def orientation_of(label: str) -> Orientation | None:
    """Return the orientation of a label such as "UP", "DWN", "S62W", "21", "N-S", "HNZ"; ``None`` for other texts.

    "X", "L" and "H1" are horizontal without azimuth. One or two digits behind a word are no azimuth: "COMP 3" is the third
    component, not 3°.
    """
    label = label.strip()
    key = _key(label)
    if key in _VERTICAL or key in _UP:
        return Orientation(label, vertical=True)
    if key in _DOWN or re.sub("(?:DOWN|DWN)$", "", key) in _VERTICAL_WITH_SIGN - {key}:
        return Orientation(label, vertical=True, down=True)
    if key in _AZIMUTHS:
        return Orientation(label, azimuth=_AZIMUTHS[key])
    if key in _HORIZONTAL:
        return Orientation(label)
    if sensor := _SENSOR.fullmatch(key):
        return Orientation(label, vertical=sensor[1] == "UD", azimuth=_AZIMUTHS.get(sensor[1]))
    if re.fullmatch(r"\d{1,3}", key) and int(key) <= 360:
        counted = len(key) < 3 and re.search(r"[A-Z]", re.sub("DEG(?:REES)?", "", label.upper()))
        return None if counted else Orientation(label, azimuth=float(int(key) % 360))
    if quadrant := _QUADRANT.fullmatch(key):
        pole, angle, side = quadrant[1], float(quadrant[2]), quadrant[3]
        azimuth = (0.0 if pole == "N" else 180.0) + (angle if (pole == "N") == (side == "E") else -angle)
        return Orientation(label, azimuth=azimuth % 360.0)
    if channel := _CHANNEL.fullmatch(key):
        if channel[1] in "ZUV":
            return Orientation(label, vertical=True)
        return Orientation(label, azimuth=_AZIMUTHS.get(channel[1]))
    return None


def _key(label: str) -> str:
    """Return the letters and digits of a label in capitals, without accents and without words such as "component"."""
    return _NOISE.sub("", folded(label))


def is_upward(label: str) -> bool:
    """Return whether a label means positive up, "UP"; False for "V", which is vertical only, and for other labels."""
    return _key(label) in _UP


def is_place_or_direction(label: str) -> bool:
    """Return whether a label is an English word for a direction that may end a place's name: "North", "West"; not "N"."""
    return len(key := _key(label)) > 2 and key in _ENGLISH and key in _AZIMUTHS


def orientation_in(label: str) -> Orientation:
    """Return the orientation of a column's label, with or without its station: "Z", "CCC_HNZ"; unknown for other labels.

    A number is an azimuth if it has three digits, or is 0 or 90, which do not number columns.
    """
    bare = label.strip()
    if re.fullmatch(r"\d{1,2}", bare) and bare not in ("0", "00", "90"):
        return unknown(bare)
    if _is_unknown_pair(bare):
        return unknown(bare)
    site, at_end = split_stem(bare)
    before = orientation_of(site) if at_end else None
    if before and at_end and (before.vertical, before.azimuth) != (at_end.vertical, at_end.azimuth):
        at_end = None  # two directions contradict each other
    orientation = orientation_of(bare) or at_end
    return (
        Orientation(bare, orientation.vertical, orientation.azimuth, orientation.down) if orientation else unknown(bare)
    )


_LETTER = r"[^\W\d_]"
_PAIR = re.compile(rf"{_LETTER} ?- ?{_LETTER}")  # of opposite directions, in a language that is not known
_PART = r"(?P<site>.*[^-_. ])[-_. ]+"
_GLUED = r"DWN|UP|(?:UD|EW|NS)[12]?|VER|VERT|VRT"  # in names that they end without a separator
_SITES_AND_LABELS = (
    (_PART, rf"(?i:N-S|S-N|E-W|W-E|U-D|Up-D(?:ow)?n|{_LETTER}+-axis|{_LETTER}+-(?:up|d(?:ow|w)?n))"),
    (_PART, rf"{_LETTER}+-{_LETTER}+"),  # Norte-Sur
    (_PART, r"[A-Z][NLGH][ZNE12][-_. ]+\d\d"),
    (_PART, rf"{_LETTER}+|\d{{3}}|[A-Za-z]+\d+[A-Za-z]*"),
    (r"(?P<site>.*[A-Za-z0-9])", rf"\d{{3}}|{_GLUED}"),
    (r"(?P<site>.*\d)", r"(?i:DWN|UP|UD|EW|NS|VERT?|VRT)"),
    (r"(?P<site>.*\d\d)", r"(?i:[VZUNEW])"),  # chy080v
)
_ENDS = tuple(re.compile(rf"{site}(?P<label>{label})") for site, label in _SITES_AND_LABELS)
_PREFECTURES = (  # and parts of Hokkaido
    "ABS|HDK|HYM|IBR|IKR|ISK|IWT|KKW|KMM|KNG|KOC|KSR|KYT|KGS|KGW|MIE|MYG|MYZ|NAR|NGN|NGS|NIG|NMR|OIT|OKN|OKY|OSK|OSM|RMI|"
    "SAG|SBS|SIG|SIT|SMN|SOY|SRC|SZO|TCG|TKC|TKS|TKY|TTR|TYM|WKY|YMG|YMN|YMT|AIC|AKT|AOM|CHB|EHM|FKI|FKO|FKS|GIF|GNM|HKD|HRS|"
    "HYG|IBU"
)
KIK_NET = re.compile(rf"(?:{_PREFECTURES})H\d\d", re.IGNORECASE)
"""Code of a station of KiK-net."""
_STATION = re.compile(  # codes of TSMIP, K-NET and KiK-net end in a number, as PEER's file names do in an azimuth
    rf"(?:^|[^A-Z])(?:TCU|CHY|HWA|ILA|KAU|TAP|TTN|{_PREFECTURES})H?\d{{3}}$"
)
_CHANNELS = re.compile(
    r"(?:^|[-_. ])(?:ch|chan|channel|sensor|run|rec|record|no|nr|(?:gm)?rot[di])[-_. ]*\d+$", re.IGNORECASE
)
_MOMENT = (  # in UTC, not vertical, and with ESM's stage: .20090406.013239.U is uncorrected, not up
    r"(?:\d{8}|\d{4}-\d\d-\d\d)(?:T\d\d[-:_.]?\d\d(?:[-:_.]?\d\d(?:\.\d+)?)?Z?|\.\d{6}\.[A-Z]{1,2})"
)
_AT_MOMENT = re.compile(_MOMENT + "$", re.IGNORECASE)
_PROCESSING = re.compile(
    _PART
    + rf"(?:{_MOMENT}|(?:un)?(?:cor|corr|corrected|filt|filtered|proc|processed)|raw|acc|accel|acceleration|th|cut|copy|"
    r"g|gal|cm|cms2|ms2|v[0-3][ac]?|\(\d+\))",
    re.IGNORECASE,
)


@lru_cache(maxsize=MOST_KEPT)
def split_stem(stem: str) -> tuple[str, Orientation | None]:
    """Return the station's part of a file's stem and the orientation at its end, before times and words such as "corrected".

    "RSN1063_NORTHR_RRS228" gives "RSN1063_NORTHR_RRS" and 228°, "ABBAR--V" gives "ABBAR" and vertical, "UP" gives "" and
    vertical; a stem without a direction gives itself and ``None``. Numbers count as azimuths only with three digits, unless they
    are dates, times, stations or files counted from 001. Names with a horizontal direction and a vertical channel's code have no
    orientation.
    """
    whole = orientation_of(stem) if stem.isalnum() and not _is_number("", stem, stem) else None
    if whole and (whole.vertical or whole.azimuth is not None):
        return "", whole
    site, behind = stem, ""
    while True:
        for end in _ENDS:
            match = end.fullmatch(site)
            if match is None or _is_number(match["site"], match["label"], site) or _is_unknown_pair(site):
                continue
            if orientation := _name_orientation(match["label"]):
                return (stem, None) if _contradicted(orientation, stem) else (match["site"] + behind, orientation)
        processing = _PROCESSING.fullmatch(site)
        if processing is None:
            break
        site, behind = processing["site"], site[len(processing["site"]) :] + behind
    for orientation in reversed(_channel_orientations(stem)):
        if not _contradicted(orientation, stem):
            return re.sub(rf"(^|[-_. ]+){re.escape(orientation.label)}(?=[-_. ])", "", stem, count=1), orientation
    return stem, None


def _is_unknown_pair(name: str) -> bool:
    """Return whether a name is a pair of letters that is no direction as a whole: I-Z, F-L."""
    return _PAIR.fullmatch(name) is not None and orientation_of(name) is None


def _name_orientation(label: str) -> Orientation | None:
    """Return the orientation of a label at the end of a name; ``None`` for others, and words that name places, too (Nord)."""
    key = _key(label)
    pair = "-" not in label or (len(key) > 1 and (key in _AZIMUTHS or key in _VERTICAL | _UP | _DOWN))
    return orientation_of(label) if pair and key not in _ELSEWHERE_IN_NAMES else None


def direction_of_suffix(suffix: str) -> Orientation | None:
    """Return the orientation of a file's suffix such as K-NET's .EW and .UD2; ``None`` for other suffixes.

    Of numbers only .000, .090, .180, .270 and .360 count.
    """
    label = suffix.lstrip(".")
    if label.isdigit() and label not in ("000", "090", "180", "270", "360"):
        return None
    orientation = _name_orientation(label)
    return orientation if orientation and (orientation.vertical or orientation.azimuth is not None) else None


def _channel_orientations(stem: str) -> list[Orientation]:
    """Return the orientations of all channel codes in a name, in order: [vertical] for "CCM.BHZ.00.D"; [] without a code."""
    parts = [part for part in re.split(r"[-_. ]+", stem) if _CHANNEL_IN_NAME.fullmatch(part.upper())]
    return [orientation for part in parts if (orientation := orientation_of(part))]


def _contradicted(orientation: Orientation, stem: str) -> bool:
    """Return whether ``stem`` has a vertical channel's code and ``orientation`` is not vertical, but horizontal or unknown."""
    return not orientation.vertical and any(channel.vertical for channel in _channel_orientations(stem))


def _is_number(site: str, label: str, stem: str) -> bool:
    """Return whether digits ``label`` at a name's end are of a date, a station or a file; True too if the name ends in a time."""
    if _AT_MOMENT.search(stem):
        return True
    if not label.isdigit():
        return False
    if _STATION.search(stem) or _CHANNELS.search(stem):
        return True
    if not site or not stem[len(site)].isdigit():  # apart: 001, or 2019.187, the day of a year
        return re.fullmatch("00[1-9]", label) is not None or re.search(r"(?:19|20)\d\d$", site) is not None
    run = stem[len(stem.rstrip("0123456789")) :]
    if len(run) == 4:
        return 1900 <= int(run) < 2040
    day = re.fullmatch(r"(?:(?:19|20)\d\d|\d\d)(0[1-9]|1[0-2])(0[1-9]|[12]\d|3[01])", run)
    return day is not None or len(run) > 8


def counted(stems: Iterable[str]) -> set[str]:
    """Return the stems that end in three digits which are no azimuths: GM_010 and GM_011.

    Two that are otherwise equal are then neither parallel nor near a right angle.
    """
    numbered: set[str] = set()
    for group in grouped((stem for stem in stems if re.fullmatch(r".*\d{3}", stem)), lambda stem: stem[:-3]).values():
        if _in_series(int(stem[-3:]) for stem in group):
            numbered.update(group)
    return numbered


def numbered(stems: Iterable[str]) -> set[str]:
    """Return the horizontal stems without azimuth that are :func:`one_of_three`."""
    directions = {stem: split_stem(stem)[1] for stem in stems}
    return {
        stem
        for stem, orientation in directions.items()
        if orientation and orientation.without_azimuth and one_of_three(stem, directions)
    }


def one_of_three(label: str, labels: Collection[str]) -> bool:
    """Return whether a label ends in 1 or 2, and of ``labels`` one like it in 3, but none in 4 to 9: any may be vertical."""
    beginning = label[:-1]
    if label[-1:] not in ("1", "2") or beginning[-1:].isdigit() or f"{beginning}3" not in labels:
        return False
    return not any(f"{beginning}{digit}" in labels for digit in range(4, 10))


def accidental(stems: Iterable[str]) -> set[str]:
    """Return the stems that end in letters of a direction by chance: STATIONS in NS, DENVER in VER.

    So may a word in capitals alone, a word in VER, and one beside another direction: UP_GROUP. Their letters are a direction only
    if another stem differs in its direction alone: ORRDWN beside ORR021.
    """
    split = {stem: split_stem(stem) for stem in stems}
    of_site = Counter(site for site, orientation in split.values() if orientation)
    return {
        stem
        for stem, (site, orientation) in split.items()
        if orientation and of_site[site] < 2 and _is_end_of_word(orientation.label, stem)
    }


def _is_end_of_word(label: str, stem: str) -> bool:
    """Return whether a direction's letters may be the end of a word in a stem: True for DENVER, False for KobeNS, KOBE_TAKNS."""
    if not re.fullmatch(_GLUED, label) or not re.search(rf"[A-Z]{label}", stem):
        return False
    words = [orientation_of(word) for word in re.split(r"[-_. ]+", stem) if not word.isdigit()]
    directed = any(word and (word.vertical or word.azimuth is not None) for word in words)
    return directed or label.startswith("VER") or (stem.isalpha() and stem.isupper())


def told_apart(stems: Iterable[str]) -> dict[str, tuple[str, Orientation]]:
    """Return station's part and orientation of stems that differ in one word only, each time in another direction: a_UP, a_000.

    The directions must have a vertical, or two at a right angle. Words count here that also name places, such as nord; numbers of
    files do not.
    """
    split_stems: dict[str, tuple[str, Orientation]] = {}
    groups: dict[tuple[str, ...], dict[str, Orientation]] = {}
    for stem in dict.fromkeys(stems):
        for separator in (r"([_. ]+)", r"([-_. ]+)"):  # norte-sur is one word, or two
            words = re.split(separator, stem)
            for i in range(0, len(words), 2):
                orientation = orientation_of(words[i])
                if orientation and (not words[i].isdigit() or len(words[i]) == 3):
                    groups.setdefault((*words[:i], "", *words[i + 1 :]), {})[stem] = orientation
    for around, group in groups.items():
        directions = {(o.vertical, o.azimuth, o.azimuth is None and o.label.upper()) for o in group.values()}
        numbers = [int(o.label) for o in group.values() if o.label.isdigit()]
        upright = any(o.vertical for o in group.values())
        azimuths = [o.azimuth for o in group.values() if o.azimuth is not None]
        square = any(not not_square(a, b, "") for a, b in combinations(azimuths, 2))  # N and S may be streets
        if 1 < len(group) == len(directions) and (upright or square) and not _in_series(numbers):
            site = re.sub(r"([-_. ])[-_. ]*", r"\1", "".join(around)).strip("-_. ")
            for stem, orientation in group.items():
                split_stems.setdefault(stem, (site, orientation))
    return split_stems


def glued(stems: Iterable[str]) -> dict[str, tuple[str, Orientation]]:
    """Return station's part and orientation of stems whose last letter or azimuth is a direction: TAKN, TAKE, TAKV; TAK032, …

    Of a station they are three, two horizontal ones at a right angle and a vertical, and no other stem begins like them.
    """
    names = list(dict.fromkeys(stems))
    parted = [parts for name in names if (parts := re.fullmatch(r"(.*[A-Za-z])([A-Za-z]|\d{3})", name))]
    split_stems: dict[str, tuple[str, Orientation]] = {}
    for site, group in grouped(parted, lambda parts: parts[1]).items():
        ways = {parts[0]: way for parts in group if (way := orientation_of(parts[2]))}
        level = [way for way in ways.values() if not way.vertical]
        if len(ways) == 3 and len(level) == 2 and sum(name.startswith(site) for name in names) == 3:
            a, b = level
            if (a.azimuth is None) == (b.azimuth is None) and not not_square(a.azimuth, b.azimuth, ""):
                split_stems |= {name: (site, way) for name, way in ways.items()}
    return split_stems


def in_numbered_sets(stems: Iterable[str]) -> dict[str, tuple[str, Orientation]]:
    """Return station's part and orientation of stems whose direction is followed by the number of their set: a_NS1, a_EW1, a_NS2.

    Of a station two sets at least must have the same directions, north, east and vertical among them: an array may number its
    sites, whose headers tell other azimuths. KiK-net numbers its sensors.
    """
    sets: dict[str, dict[str, dict[str, Orientation]]] = {}
    for stem in stems:
        parts = re.fullmatch(r"(.*[-_. ])?([A-Za-z]+)(\d{1,2})", stem)
        orientation = orientation_of(parts[2]) if parts and not KIK_NET.match(stem) else None
        if parts and orientation:
            sets.setdefault(parts[1] or "", {}).setdefault(parts[3], {})[stem] = orientation
    split_stems: dict[str, tuple[str, Orientation]] = {}
    for site, of_site in sets.items():
        first, *others = (Counter((o.vertical, o.azimuth) for o in members.values()) for members in of_site.values())
        complete = {(False, 0.0), (False, 90.0)} <= first.keys() and any(vertical for vertical, _ in first)
        if complete and others and all(other == first for other in others):
            for number, members in of_site.items():
                split_stems |= {stem: (f"{site}{number}", orientation) for stem, orientation in members.items()}
    return split_stems


def _in_series(numbers: Iterable[int]) -> bool:
    """Return whether two of the numbers, as azimuths [degrees], are more than 45° off a right angle and not parallel."""
    return any(0 < abs((a - b + 90) % 180 - 90) < 45 for a, b in combinations(set(numbers), 2))


SAME_AZIMUTH = 1.0
"""Degrees within which azimuths agree."""


def same_azimuth(a: float | None, b: float | None) -> bool:
    """Return whether two azimuths [degrees] agree within 1°, 360 and 0 being the same; False if one is unknown."""
    return a is not None and b is not None and angle_between(b, a) <= SAME_AZIMUTH


def not_square(a: float | None, b: float | None, names: str) -> str:
    """Return a message on two azimuths [degrees] that are not at a right angle within 1°; "" if they are, or one is unknown."""
    if a is None or b is None:
        return ""
    angle = angle_between(a, b)
    skew = abs(angle - 90.0) > SAME_AZIMUTH  # agencies round their azimuths
    return f"{names} are {angle:g}° apart, not square to each other" if skew else ""


def angle_between(a: float, b: float) -> float:
    """Return the angle between two azimuths [degrees], 0 to 180."""
    return abs((b - a + 180.0) % 360.0 - 180.0)


_CLOCKS = re.compile(r"(?:INT|EXT)(?:T?C|CLOCK|CLK)|TCG?|CLOCK|CLK|TIME(?:CODE|MARKS?)|IRIG[A-Z]?|WWVB?|DCF|[ALV]C[EQ]")


_SEISMOMETER = re.compile(r"[BCDEFGHLMSV][H][ZUVNE123RTXY]")


def not_acceleration(channel: str) -> str:
    """Return "velocities (channel HHN)" for the SEED channel code of a seismometer; empty for others."""
    return f"velocities (channel {channel})" if _SEISMOMETER.fullmatch(channel.strip().upper()) else ""


def is_clock(label: str) -> bool:
    """Return whether a channel's label means the recorder's clock, such as "INTC", or SEED's "LCQ"; its digits do not matter."""
    return _CLOCKS.fullmatch(re.sub(r"[^A-Z]", "", label.upper())) is not None
