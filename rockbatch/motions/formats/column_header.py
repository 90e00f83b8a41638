"""Headers of tables, as people and programs write them: columns, units, count."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from rockbatch.common.errors import NoRecord
from rockbatch.common.units import acceleration_factor, length_factor
from rockbatch.motions.formats.spelled_out import DIRECTION_KEYS, KEYED, is_down
from rockbatch.motions.formats.stated import Stated
from rockbatch.motions.formats.stated_step import OF_OTHER_DATA, SECOND, SECONDS, STEP
from rockbatch.motions.labels.direction_words import folded
from rockbatch.motions.labels.orientation import orientation_in, orientation_of
from rockbatch.motions.quality.places import Stand, stand
from rockbatch.motions.sources.record_file import ReadOptions

# possessive (*+), so that matching any header line takes the square of its length at most
_UNIT = r"[(\[]\s*+(?P<unit>[^()\[\]]*[^()\[\]\s])\s*+[)\]]"
_NUMBERED = re.compile(rf"^column\s+(?P<at>\d{{1,3}})\s*[:=]\s*(?P<label>[^()\[\]]*?)\s*+(?:{_UNIT}|$)", re.IGNORECASE)
_OF_SENSOR = r"(?:sensor|instrument|gau?ge) (?:location|place|position|site)|position"
_SITES = (
    "(?:recording |station )?(?:station|site|location|place)|sensor|gau?ge|estaci[oó]n|sitio|lugar|ubicaci[oó]n|esta[cç][aã]o|"
    "stazione|luogo|posizione|lieu|emplacement|istasyon|konum|yer|ort|standort|地点|観測点|設置場所|台站|測站|测点|位置|"
    "σταθμ[οό]ς|станция"
)
_PLACE = re.compile(
    rf"^(?:(?P<of_sensor>{_OF_SENSOR})|{_SITES})(?: ?(?:name|location|nombre|名))?\s*[:=;\t]\s*"
    r"(?P<words>.*[^\W\d_]{3,}.*|\S*[^\x00-\x7f].*)$",
    re.IGNORECASE,
)
_STATION = re.compile(rf"^(?:{_SITES})(?: ?(?:name|code|id|no|number|nombre|名)\.?)?\s*[:=;\t]", re.IGNORECASE)
_OF_SOIL = re.compile(r"rock\b|\bsoil|water\b|\bvs|\bclass\b", re.IGNORECASE)
_LABELLED = re.compile(rf"(?P<label>[^\s,;()\[\]](?:[^,;\t()\[\]]*[^\s,;()\[\]])?)\s*+{_UNIT}")
_WORD = re.compile(rf"(?P<label>[^\s,;()\[\]]+)(?:\s*{_UNIT})?")  # a label of one word, perhaps with its unit
_FIELD = re.compile(rf"(?P<label>[^()\[\]]*[^()\[\]\s])\s*(?:{_UNIT})?")  # a label between commas or tabs
_VALUE = re.compile(
    r"[:=]|\d\.\d|(?<!\w)\.\d|^\*[A-Za-z&-]+ *,"
)  # the last alternative is a keyword of MIDAS or Abaqus
_KEYED = re.compile(r"[^()\[\],;\t]*[:=]|\*[A-Za-z&-]+ *,")  # "File type: accelerations (g)" is no label
_COMPONENTS = re.compile(r"^(?:components?|channels?|columns)\s*[:=]\s*(?P<labels>\S.*)$", re.IGNORECASE)
_STATED = re.compile(
    r"^(?:units?|field[_]unit|unidad(?:e?s)?|unidade|unit[ée]s?|unit[àa](?: di misura)?|einheit(?:en)?|birimi?|eenheid|"
    r"μονάδ[αε]ς?|единиц[аы]|単位|单位|單位)\s*[:=;\t]\s*(?:UTC,\s*)?(?P<unit>(?:\d*\.?\d+ )?\S+)",
    re.IGNORECASE,
)
_ACCELERATION = r"(?:acc(?:el|[eé]l[eé]ra(?:tion|zion)\w*)?s?|acel(?:era\w*)?|beschl(?:eunigung\w*)?|ivme\w*)\.?"
_OF_SERIES = r"(?:[ _]*(?:data|values|units?|time series|time history|record))?\s*"
_SAID = re.compile(  # acceleration in g; UNITS OF CM/S/S; units are g; Acceleration unit: gal; Acc. (cm/s2); acceleration, g
    rf"(?:\bunits?(?: of acc\w*)?\s*(?:\b(?:of|is|are)\b|[:=])|^(?:(?:un)?corrected )?{_ACCELERATION}\s*(?:[,/]|- )(?=\s*\S+$)|"
    rf"\b(?:{_ACCELERATION}|(?:amplitude|data)s?|values){_OF_SERIES}(?:[:=(\[]|"
    r"(?:(?:is|are|measured|expressed|given)\s+)*\b(?:in|en|em)\b(?: units? of| fractions? of)?))"
    r"\s*[(\[]?(?!units?\b)(?P<unit>(?:(?<=units of )\d*\.?\d+ )?[^\s,;()\[\]]+)",
    re.IGNORECASE,
)
_PEAK = re.compile(r"\b(?:pga|peak|max(?:imum)?)\b", re.IGNORECASE)
_COUNT = re.compile(
    r"\b(?:npts|sample[_]count|(?:number|no\.?) of (?:points|samples)|n[uú]mero de (?:datos|muestras|puntos|dados|amostras))"
    r"\s*[:=]?\s*(?P<npts>[0-9]{1,12})\b",
    re.IGNORECASE,
)
_OF_PEAK = re.compile(
    r"\b(?:pga|(?:peak|max(?:imum)?\.?)(?: ground)? acc[a-z]*\.?)\s*(?:[(\[](?P<before>[^)\]]*)[)\]])?\s*[:=]\s*"
    r"(?P<number>[-+]?\d*\.?\d+(?:e[-+]?\d+)?)\s*(?P<behind>[^\s,;]*)",
    re.IGNORECASE,
)
_OF_DURATION = re.compile(
    r"(?:^|[,;] *)(?:total |record )?(?:duration|record length|duraci[oó]n|dauer)"
    r"\s*(?:[(\[]\s*(?:s|secs?|seconds|segundos)\s*[)\]])?\s*[:=]\s*(?P<number>\d*\.?\d+)(?=\s*(?:$|[,;]|(?:s|secs?|seconds|segundos)\b))",
    re.IGNORECASE,
)
_OF_FACTOR = re.compile(
    r"(?:\b(?:scale|scaling|multiplication|conversion)[ _]?factor\s*[:=]?|\bfactor de escala\s*[:=]?"
    r"|\b(?:g|gals?|cm/s/s|[cm]?m/s\^?2)\s*[x×*])\s*(?P<number>(?:\d++(?:\.\d*+)?|\.\d++)(?:e[-+]?\d++)?)"
    r"(?![\d.]|e[-+]?\d|\s*(?:per\b|[^\s/]*/|g\b|gals?\b))",  # with a unit it is a constant: 980.665 cm/s2 per g, 1.2345 V/g
    re.IGNORECASE,
)
_OF_NO_SAMPLES = re.compile(
    r"\b(?:target|design|arias|significant|bracketed|threshold|trigger|range|full[ -]scale|bedrock|gravity)\b",
    re.IGNORECASE,
)
_BEYOND_ROUNDING = {"peak": (0.05, math.inf), "duration": (0.01, math.inf)}  # of another stage of processing, perhaps
_SHORT = {"NORTHSOUTH": "NS", "EASTWEST": "EW", "UPDOWN": "UD"}
_TIME = {"time", "times", "elapsed", "elapsedtime", "zeit", "tiempo", "temps", "tempo", "zaman", "時間", "时间"}
_SECONDS = [prefix + word for word in SECOND if len(word) > 2 for prefix in ("", "in", "en")]
_TIMES = _TIME | {time + seconds for time in ("", "t", *_TIME) for seconds in _SECONDS}
_TIMES |= {"timestamp", "datetime", "date", "utc", "timeutc", "utctime", "datetimeutc"}
_INDEX = re.compile(
    r'^\s*"?(?:unnamed: ?\d+|index|idx|id|no\.?|nr\.?|num(?:ber)?|#|n|i|k|sample(?:[ _]?(?:no\.?|number|index))?|row|point|step)?'
    r'"?\s*[,;\t]\s*',
    re.IGNORECASE,
)
_MIDAS = re.compile(r"^\*UNIT&TYPE\s*,\s*(?P<unit>\w+)\s*,\s*(?P<kind>\w+)", re.IGNORECASE)
_MIDAS_UNITS = {"GRAV": "g"} | {unit.upper(): f"{unit}/s2" for unit in ("m", "cm", "mm", "in", "ft")}
_SUFFIXED = re.compile(
    r"(?P<label>a[gxyz]?|acc(?:el|eleration)?|.*[_ -]acc(?:el|eleration)?)_(?P<unit>g|gal|[cm]?m_?s2)", re.IGNORECASE
)
_PERIODS = {"PERIOD", "PERIODS", "PERIODO", "PERIODOS", "PERIODE", "PERIODEN", "PERIYOT", "TN"}
_FREQUENCIES = {"FREQ", "FREQS", "FREQUENCY", "FREQUENCIES", "HZ", "OMEGA"}
_PER_SECOND = {"hz", "1/s", "rad/s", "rad/sec"}
_ORDINATE = re.compile(r"P?S[AVD]E?|PSEUDO|SPECTR(?:AL|UM|A)|ROTD\d+|GMROT[DI]\d+|FAS|FOURIER", re.IGNORECASE)
_SPECTRA = re.compile(r"\b(?:(?i:spectr(?:al|um|a)|fourier)|PSA|Sae?|FAS)\b")
_VELOCITY = "VEL VELO VELOC VELOCITY VELOCITIES VELOCIDAD VELOCIDADE VELOCITA VITESSE GESCHWINDIGKEIT HIZ"
_DISPLACEMENT = (
    "DIS DISP DISPL DISPLACEMENT DISPLACEMENTS DESPLAZAMIENTO DESLOCAMENTO SPOSTAMENTO DEPLACEMENT VERSCHIEBUNG DEPLASMAN "
    "YERDEGISTIRME"
)
_OTHERS = {
    **dict.fromkeys(_VELOCITY.split(), "velocity"),
    **dict.fromkeys(_DISPLACEMENT.split(), "displacement"),
}
_BY_LETTER = {"A": "acceleration", "V": "velocity", "D": "displacement"}
_INITIAL = re.compile(r"[VD](?=[-_. ])", re.IGNORECASE)
_COUNTS = {"count", "counts", "ct", "cts", "v", "mv", "volt", "volts"}
_OTHER_SERIES = re.compile(
    r"^(?:(?:ground|corrected|uncorrected|relative) )*(?:velocity|displacement)(?: *[(\[][^)\]]*[)\]])?"
    r"(?: *(?:time|histor|series|data|record|trace|in units?)\w*[^:=]*)?$"
    r"|^(?:data |record |file )?(?:quantity|type)\s*[:=]\s*(?:vel|disp)\w*(?: time histor\w*)?$",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class Column:
    """A column of a table."""

    label: str
    unit: str | None = None  # None if unknown
    stated: bool = False  # whether the study states the label

    @property
    def is_time(self) -> bool:
        """Return whether it holds times, by its label or by a unit of time, but not the periods of a spectrum."""
        key = re.sub(r"[\W\d_]", "", self.label.lower())
        return key in _TIMES or (seconds_in(self.unit or "") is not None and not self.is_abscissa)

    @property
    def may_be_time(self) -> bool:
        """Return whether its label is T or Ts without a unit: time, or the transverse component."""
        return self.unit is None and self.label.lower() in ("t", "ts")

    @property
    def is_abscissa(self) -> bool:
        """Return whether it holds the periods or frequencies of a spectrum."""
        return bool((_PERIODS | _FREQUENCIES) & self._words) or (self.unit or "").lower() in _PER_SECOND

    @property
    def is_ordinate(self) -> bool:
        """Return whether it holds the values of a spectrum: Sa, PSA, Fourier amplitude."""
        return any(_ORDINATE.fullmatch(word) for word in self._words)

    @property
    def other(self) -> str:
        """Return "velocity" or "displacement" if its label says so, or its initial and unit, v_N (cm/s); empty for others."""
        if (initial := _INITIAL.match(self.label)) and _is_of_motion(self.unit or ""):
            return _BY_LETTER[initial[0].upper()]
        return next((_OTHERS[word] for word in sorted(self._words) if word in _OTHERS), "")

    @property
    def _words(self) -> set[str]:
        """Return the words of its label in capitals."""
        return set(re.findall(r"[A-Z]+\d*", folded(self.label)))


def with_quantities(columns: Sequence[Column]) -> list[Column]:
    """Return the columns, those called V and D beside an A as velocity and displacement: V is no vertical one there."""
    if not _BY_LETTER.keys() <= {column.label.upper() for column in columns}:
        return list(columns)
    return [replace(column, label=_BY_LETTER.get(column.label.upper(), column.label)) for column in columns]


def spectrum_in(columns: Sequence[Column]) -> str:
    """Return the labels of columns of a spectrum and its kind, '"PSA": a response spectrum'; empty for time histories."""
    telling = [column for column in columns if column.is_abscissa or column.is_ordinate]
    if not telling:
        return ""
    words = set().union(*(column._words for column in telling))
    frequency = bool(words & {"FAS", "FOURIER"}) or any(
        column.is_abscissa and not _PERIODS & column._words for column in telling
    )
    labels = " and ".join(f'"{column.label}"' for column in telling)
    return f"{labels}: a {'spectrum over frequency' if frequency else 'response spectrum'}"


def seconds_in(unit: str) -> float | None:
    """Return a unit of time in seconds, 0.001 for "ms"; ``None`` for other units."""
    return SECONDS.get(unit.strip().lower().rstrip("."))


def columns_named(header: Sequence[str], width: int) -> list[Column] | None:
    """Return the columns that a header names, with or without units; ``None`` if it names another number."""
    return columns_with_units(header, width) or _columns_without_units(header, width)


def columns_with_units(header: Sequence[str], width: int) -> list[Column] | None:
    """Return the columns if the header states label and unit of all ``width``; else ``None``.

    ``Column 2: North-south acceleration (cm/s/s)``, without unit if they are time and directions, or in one line
    ``time(sec) N-S(cm/s/s) …``, of which one unit at least is known and the last such line counts, or in two, the labels and
    their units, of which some may be "" or "-".
    """
    by_number = {int(m["at"]): _column(m) for line in header if (m := _NUMBERED.match(line))}
    numbered = [by_number[at] for at in sorted(by_number)] if sorted(by_number) == list(range(1, width + 1)) else []
    if numbered and all(column.unit for column in numbered):
        return numbered
    for line in reversed(header):
        labelled = [] if _KEYED.match(line) else [_column(match) for match in _LABELLED.finditer(line)]
        # "PGA (g): 0.5" is no label, and "Final (Baseline corrected)" has no unit
        complete = len(labelled) == width and not _LABELLED.sub("", line).strip(' \t,;"')
        if complete and any(_is_unit(column.unit or "") for column in labelled):
            return labelled
    directions = [column.label for column in numbered if not column.is_time]
    telling = len(directions) < len(numbered) and all(map(orientation_of, directions))
    return _with_unit_row(header, width) or (numbered if telling else None)


def _with_unit_row(header: Sequence[str], width: int) -> list[Column] | None:
    """Return the columns by two neighbouring lines of labels and units, in either order; ``None`` without such lines.

    One unit at least is of acceleration; "" and "-" become None.
    """
    for pair in pairwise(header):
        for labels, units in (pair, pair[::-1]):
            of_columns = [unit.strip(" ()[]") for unit in _fields(units)]
            names = _fields(labels)
            if len(names) != width or len(of_columns) != width or not any(map(is_acceleration, of_columns)):
                continue
            if all(unit in ("", "-") or _is_unit(unit) for unit in of_columns) and not any(map(_is_unit, names)):
                pairs = zip(names, of_columns, strict=True)
                return [Column(_short_label(name), None if unit in ("", "-") else unit) for name, unit in pairs]
    return None


def _fields(line: str) -> list[str]:
    """Return the fields of a line between commas, semicolons or tabs if it has any of these, else its words."""
    fields = re.split(r"[,;\t]", line) if re.search(r"[,;\t]", line) else line.split()
    return [field.strip(' "') for field in fields]


def _is_unit(text: str) -> bool:
    """Return whether a text is a unit of time, acceleration, velocity or displacement."""
    return is_acceleration(text) or seconds_in(text) is not None or _is_of_motion(text)


def _is_of_motion(unit: str) -> bool:
    """Return whether a unit is one of velocity or displacement: "cm/s", "mm"; False for "cm/s2"."""
    length, slash, time = re.sub(r"[() ]", "", unit.lower()).partition("/")
    return length_factor(length) is not None and (not slash or time in SECONDS)


def without_index_name(header: Sequence[str]) -> list[str]:
    """Return the header lines that begin with the name of a row index, "", "index" or "No.", without that name."""
    return [_INDEX.sub("", line) for line in header if _INDEX.match(line)]


def _columns_without_units(header: Sequence[str], width: int) -> list[Column] | None:
    """Return the columns if the header states the labels of all ``width``, with or without units, ``t, NS, UD``; else None.

    A line "channels: NS EW UD" counts first, else the last line whose first label is time, or period or frequency of a spectrum,
    or whose labels are all directions or time, or a single Sa: other lines of as many words are text, as are lines with a value.
    """
    if named := next((match for line in header if (match := _COMPONENTS.match(line))), None):
        labels = [Column(_short_label(word)) for word in re.split(r"[\s,;]+", named["labels"].strip())]
        if len(labels) == width and all(orientation_in(column.label).known for column in labels):
            return labels
    for line in reversed(header):
        if _VALUE.search(line) or STEP.search(line) or is_down([line]):
            continue
        for columns in _labels_of(line.replace('"', "").strip(" ,;")):
            if len(columns) == width and (
                columns[0].is_time
                or columns[0].may_be_time
                or columns[0].is_abscissa
                or all(column.is_time or orientation_in(column.label).known for column in columns)
                or (width == 1 and columns[0].is_ordinate)
            ):
                return columns
    return None


def _labels_of(line: str) -> list[list[Column]]:
    """Return the ways to read a line of labels as columns: by words, if they cover it, and by commas, semicolons or tabs."""
    words = [_column(match) for match in _WORD.finditer(line)]
    fields = [match for field in re.split(r"[,;\t]", line) if (match := _FIELD.fullmatch(field.strip()))]
    by_words = [] if _WORD.sub("", line).strip(" \t,;") else [words]
    return [*by_words, [_column(match) for match in fields]]


def _column(match: re.Match[str]) -> Column:
    """Return the column of a matched label and unit; the unit may be the end of the label: acc_g, acc_cm_s2."""
    label, unit = match["label"].strip('"'), match["unit"]
    if unit is None and (suffixed := _SUFFIXED.fullmatch(label)):
        label, unit = suffixed["label"], re.sub("_?s2$", "/s2", suffixed["unit"])
    return Column(_short_label(label), unit)


def other_series(header: Sequence[str]) -> str:
    """Return the first header line that calls the samples velocities or displacements; "" if none does, or one accelerations."""
    if any(re.search(r"\bacc", line, re.IGNORECASE) for line in header):
        return ""
    return next((line for line in header if _OTHER_SERIES.search(line.strip())), "")


def line_about_spectra(header: Sequence[str]) -> str:
    """Return the first header line with a word for spectra; empty without one."""
    return next((line for line in header if _SPECTRA.search(line)), "")


def stated_directions(header: Sequence[str]) -> list[str]:
    """Return the directions in lines such as ``Component: N 12 E``, ``Channel = HNZ`` and ``Azimuth: 12``.

    A vertical one is first, then an azimuth. Numbers of components and channels are none.
    """
    keyed = [(folded(match["key"]).strip(), match["label"]) for match in map(KEYED.match, header) if match]
    labels = [f"{label} deg" if key == "AZIMUTH" else label for key, label in keyed if key in DIRECTION_KEYS]
    return sorted(
        (label for label in labels if orientation_in(label).known),
        key=lambda label: (not orientation_in(label).vertical, not label.endswith(" deg")),
    )


def stated_place(header: Sequence[str]) -> str | None:
    """Return the words in lines such as ``Station: Bay Bridge, pier 3`` and ``Sensor location: deck`` that place a sensor.

    ``None`` unless they place it on a structure or in a borehole. All but those of a sensor are names, of a town perhaps. Phrases
    on the soil, whose depths are not the sensor's, do not count.
    """
    stated = [(bool(match["of_sensor"]), match["words"].split(",")) for match in map(_PLACE.match, header) if match]
    place, name = (
        ",".join(
            phrase for kind, phrases in stated if kind is of_sensor for phrase in phrases if not _OF_SOIL.search(phrase)
        )
        for of_sensor in (True, False)
    )
    where, words = stand(place, name)
    return None if where is Stand.GROUND else words


def stated_record(header: Sequence[str], width: int) -> str:
    """Return the header of a table of ``width`` columns as a key that the files of one record share; "" without a station.

    Lines of direction, peak, unit and columns are left out of it, and counts and steps.
    """
    if not any(map(_STATION.match, header)):
        return ""
    shared = (line for line in header if not _is_of_component(line, width))
    return "; ".join(" ".join(STEP.sub("", _COUNT.sub("", line)).upper().split()) for line in shared)


def _is_of_component(line: str, width: int) -> bool:
    """Return whether a line states a direction, a peak or a unit, or names columns: components of a record may differ in it."""
    keyed = KEYED.match(line)
    if keyed and folded(keyed["key"]).strip() in DIRECTION_KEYS:
        return True
    of_columns = _NUMBERED.match(line) or columns_named([line], width)
    return bool(of_columns or is_down([line]) or _STATED.match(line) or _PEAK.search(re.split(r"[:=;\d]", line)[0]))


def stated_unit(header: Sequence[str]) -> str | None:
    """Return the unit as written in a line ``unit: cm/s2``, else a known one as in ``acceleration in units of cm/s/s``.

    A record file of MIDAS has that of its line *UNIT&TYPE, and raises ``NoRecord`` if this is of no accelerations. None without
    any.
    """
    if midas := next((match for line in header if (match := _MIDAS.match(line))), None):
        if not midas["kind"].upper().startswith("ACC"):
            raise NoRecord(f'found "{midas[0]}"; expected accelerations, *UNIT&TYPE, GRAV, ACCEL')
        return _MIDAS_UNITS.get(midas["unit"].upper(), midas["unit"])
    stated = next((match["unit"].rstrip(".,;") for line in header if (match := _STATED.match(line))), None)
    if stated and is_acceleration(first := stated.partition("(")[0]):  # gal(cm/s/s)
        return first
    lines = (line for line in header if not _PEAK.search(line) and _names_one_unit(line))
    units = (
        m["unit"].rstrip(".") for line in lines for m in _SAID.finditer(line) if _is_of_samples(line[: m.start("unit")])
    )
    return stated or next((unit for unit in units if is_acceleration(unit)), None)


def _names_one_unit(line: str) -> bool:
    """Return whether a line has words for one unit of acceleration at most, unlike "values in g, converted to m/s2"."""
    words = (word.rstrip(".") for word in re.split(r"[\s,;:=()\[\]]+", line))
    return len({acceleration_factor(word) for word in words if is_acceleration(word)}) < 2


def _is_of_samples(before: str) -> bool:
    """Return whether the words ``before`` a unit, from a semicolon on, may be of the samples: not "originally", "trigger …"."""
    clause = before.rpartition(";")[2]
    return not (_OF_NO_SAMPLES.search(clause) or OF_OTHER_DATA.search(clause))


def is_of_another_quantity(unit: str) -> bool:
    """Return whether a unit is one of velocity or displacement, or of counts and volts: "cm/s", "Counts"."""
    return _is_of_motion(unit) or unit.strip().lower() in _COUNTS


def believed_unit(own: str | None, options: ReadOptions) -> str | None:
    """Return the unit that a file states, or the study's if it states none that is known; one of another quantity stays.

    Such a unit, as cm/s or counts, gives way only to a manifest's for this file.
    """
    if own and (is_acceleration(own) or (is_of_another_quantity(own) and "unit" not in options.instead)):
        return own
    return options.unit or own


def is_acceleration(unit: str) -> bool:
    """Return whether a unit is one of acceleration."""
    try:
        acceleration_factor(unit)
    except ValueError:
        return False
    return True


def stated_of_samples(header: Sequence[str]) -> tuple[Stated, ...]:
    """Return what lines such as ``PGA: 312.4 cm/s2`` and ``Duration (s) = 60`` state of the samples; a warning at most."""
    statements = []
    for quantity, pattern in (("peak", _OF_PEAK), ("duration", _OF_DURATION)):
        lines = [line for line in header if not _OF_NO_SAMPLES.search(line)]
        for match in (match for line in lines for match in pattern.finditer(line)):
            units = (match["behind"], match["before"]) if quantity == "peak" else ()
            unit = next((unit for unit in units if unit and is_acceleration(unit)), "")
            statements.append(Stated(quantity, match["number"], unit, limits=_BEYOND_ROUNDING[quantity]))
    return tuple(statements)


def stated_factor(header: Sequence[str]) -> str:
    """Return the factor other than 1 in a line such as ``Scale factor: 0.5`` or ``acceleration in g x 0.001``; "" without one."""
    numbers = (match["number"] for line in header for match in _OF_FACTOR.finditer(line))
    return next((number for number in numbers if float(number) not in (0.0, 1.0)), "")


def stated_count(header: Sequence[str]) -> int | None:
    """Return the number of samples in a line such as ``NPTS = 4000``; None without one."""
    return next((int(match["npts"]) for line in header if (match := _COUNT.search(line))), None)


def _short_label(label: str) -> str:
    """Return a column's label shortened for names and tables: "N-S" and "North-south acceleration" give "NS".

    One that gives no direction loses its word for an acceleration, unless nothing else is left.
    """
    label = label.strip('"')
    bare = re.sub(r"(?i)\s*(?:ground\s*)?acc(?:eleration|el)?\b\.?\s*", " ", label).strip()
    key = re.sub(r"[^A-Z]", "", bare.upper())
    if key in _SHORT:
        return _SHORT[key]
    if len(parts := re.split(r"\s*-\s*", bare)) == 2 and all(len(p) > 1 and orientation_of(p) for p in parts):
        return "-".join(parts)  # Norte-Sur
    return re.sub(r"[-\s]+", "", bare) if orientation_of(bare) else bare or label
