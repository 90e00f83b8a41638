"""Seismic hazard and added dispersion in a study file: [fragility.hazard] and [[fragility.dispersion]]."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from rockbatch.common.errors import InputError
from rockbatch.common.showing import shown
from rockbatch.common.units import Usual
from rockbatch.motions.suites.hazard import HazardCurve, problems
from rockbatch.toml.csv_columns import columns_of
from rockbatch.toml.kinds import Number, choice, positive, text
from rockbatch.toml.reader import Table, TomlFile, in_table
from rockbatch.toml.section import CONFIRM, Clash, Key, Section

YEARS = (50.0,)
"""Periods for which probabilities are given, unless the study names others."""


@dataclass(frozen=True)
class Hazard:
    """[fragility.hazard]: the hazard curve of the site, in the unit of the levels, and the periods asked about.

    :data:`HAZARD` says what each key means. ``file`` is the path of the table if it came from one.
    """

    curve: HazardCurve
    years: tuple[float, ...] = YEARS
    source: str = ""
    file: str = ""


@dataclass(frozen=True)
class Dispersion:
    """[[fragility.dispersion]]: a standard deviation of ln x that the records do not show.

    ``without`` names the inputs of [fragility.uncertain] whose scatter it does not contain: all that are drawn.
    """

    name: str
    value: float
    source: str = ""
    without: tuple[str, ...] = ()


IN_G = Usual(10.0, "g: the strongest earthquakes had a PGA of 2 to 4 g, and Sa to 8 g")
IN_M_S = Usual(10.0, "m/s: the strongest earthquakes had some 3 m/s")
"""Usual levels of intensity, small ones too: slender blocks overturn at next to nothing."""

_RATES = ("rate_per_year", "return_period_years")
HAZARD = Section(
    ("fragility", "hazard"),
    (
        "The hazard of the site, which turns fragilities into annual rates and probabilities: how often each intensity is "
        "exceeded. Points stand here or in a file; between them, and beyond, the curve is straight in logarithms."
    ),
    {
        "levels_g": Key(positive, "[0.1, 0.2, 0.4]", "Intensities of the points, of PGA or Sa.", many=True, usual=IN_G),
        "levels_m_s": Key(positive, "[0.1, 0.2, 0.4]", "Intensities of the points, of PGV.", many=True, usual=IN_M_S),
        "levels": Key(
            positive, "[0.5, 1.0, 2.0]", "Intensities of the points, of another measure in its unit.", many=True
        ),
        "rate_per_year": Key(
            positive,
            "[0.01, 0.0021, 0.0004]",
            "Mean annual rates at which they are exceeded.",
            many=True,
            usual=Usual(2.0, "per year: hazard is given for 0.1 to 1e-6; return periods are return_period_years"),
        ),
        "return_period_years": Key(
            positive,
            "[100, 475, 2475]",
            "Reciprocals of these rates, to be given instead.",
            many=True,
            usual=Usual(math.inf, "years: hazard is given for 10 to 1e6 years; rates are rate_per_year", 0.5),
        ),
        "file": Key(
            text,
            '"hazard.csv"',
            "A CSV file with the points, relative to the study: columns levels_g, levels_m_s or levels, and rate_per_year or "
            "return_period_years.",
        ),
        "slope": Key(
            positive,
            "3.0",
            "k of a rate that falls as 1/x^k, through a single point; of ground accelerations it is of the order of 3.",
        ),
        "shape": Key(
            choice("points", "quadratic"),
            '"quadratic"',
            '"points": straight lines between the points in logarithms; "quadratic": one parabola through three points, or by '
            "least squares through more.",
            default="points",
        ),
        "years": Key(positive, "[50, 100]", "Periods for which probabilities are given.", many=True, default=YEARS),
        "source": Key(text, '"national model 2020, site class B"', "Source of the curve, for the report."),
        **CONFIRM,
    },
    clashes=(
        Clash(("rate_per_year", "return_period_years"), "rate_per_year and return_period_years are given; keep one"),
        Clash(("file", "levels_g"), "file and levels_g are given; keep one"),
        Clash(("file", "levels_m_s"), "file and levels_m_s are given; keep one"),
        Clash(("file", "levels"), "file and levels are given; keep one"),
        Clash(
            ("file", "rate_per_year"),
            "file and rate_per_year are given; write the rates into the file, or the levels here",
        ),
        Clash(
            ("file", "return_period_years"),
            "file and return_period_years are given; write the periods into the file, or the levels here",
        ),
    ),
)
DISPERSION = Section(
    ("fragility", "dispersion"),
    (
        "Dispersion that the records do not show, such as that of the model or of the limit itself: added to theirs by the root "
        "of the squares, as in FEMA P-695 and P-58. Write one for each source."
    ),
    {
        "name": Key(text, '"modelling"', "What it is, for table and report.", required=True),
        "value": Key(
            Number("a number above 0 and at most 2", low=0.0, high=2.0, above=True),
            "0.3",
            "Standard deviation of the logarithm of the intensity.",
            required=True,
        ),
        "source": Key(text, '"judgement: good model, no tests"', "Source of the value, for the report."),
        "without": Key(
            text,
            '["alpha", "restitution"]',
            "The inputs of [fragility.uncertain], whose scatter this value must not contain: it is in the curve already.",
            many=True,
        ),
    },
    many=True,
    homes=(Dispersion,),
)


def read_hazard(file: TomlFile, levels: str) -> Hazard | None:
    """Return the hazard of a study; None without the table, or with mistakes in it, which become problems of ``file``.

    ``levels`` is the key of the levels of the measure, such as "levels_g".
    """
    table = file.table("fragility", "hazard")
    if table is None:
        return None
    problems_before = len(file.problems)
    read = table.read(HAZARD)
    wrong_keys = {"levels_g", "levels_m_s", "levels"} - {levels}
    for name in wrong_keys & table.data.keys():
        table.complain(f"{name}: the levels of [fragility] are {levels}; the hazard must have the same measure", name)
    points = _from_file(table, read["file"], levels) if "file" in read else read
    if not file.is_sound_since(problems_before):
        return None
    curve = _curve(table, points, levels, read)
    if curve is None:
        return None
    path = str(file.path.parent / read["file"]) if "file" in read else ""
    return Hazard(curve, tuple(read.get("years", YEARS)), read.get("source", ""), path)


def _from_file(table: Table, name: str, levels: str) -> dict[str, Sequence[Any]]:
    path = table.file.path.parent / name
    with table.noting("file"):
        columns = columns_of(path, dict.fromkeys((levels, *_RATES), positive))
        if levels not in columns or len(columns) != 2:
            raise InputError(
                f"{path}: its columns are {', '.join(columns)}; it needs {levels} and one of {', '.join(_RATES)}"
            )
        return {name: tuple(values) for name, values in columns.items()}
    return {}


def _curve(table: Table, points: dict[str, Any], levels: str, read: dict[str, Any]) -> HazardCurve | None:
    rate_key = next((name for name in _RATES if name in points), "")
    if levels not in points or not rate_key:
        lacking = f"{HAZARD[levels].example} and rate_per_year = {HAZARD['rate_per_year'].example}"
        table.complain(f"it has no points; write for example {levels} = {lacking}, or file = {HAZARD['file'].example}")
        return None
    x, y = points[levels], points[rate_key]
    if "file" in read and "file" not in table.confirmed:
        doubts = [
            doubt for name in (levels, rate_key) for value in points[name] for doubt in HAZARD[name].doubts(name, value)
        ]
        for doubt in doubts[:1]:
            table.complain(in_table(replace(doubt, confirm="file")), "file")
    rates = tuple(1.0 / period for period in y) if rate_key == "return_period_years" else tuple(y)
    slope, shape = read.get("slope"), read.get("shape", "points")
    wrong = list(problems(x, rates, slope, shape))
    key = "file" if "file" in read else rate_key
    for place, message in wrong:
        table.complain(message, key, *(() if place is None or key == "file" else (place,)))
    return None if wrong else HazardCurve(tuple(x), rates, slope, shape)


def read_dispersions(file: TomlFile, drawn: Sequence[str] = ()) -> tuple[Dispersion, ...]:
    """Return a study's added dispersions that have a name and a value; mistakes become problems of ``file``.

    It is a mistake, too, if the ``without`` of one does not name each of the ``drawn`` inputs.
    """
    added: list[Dispersion] = []
    for table in file.tables("fragility", "dispersion", title="name"):
        read = table.read(DISPERSION)
        if any(read.get("name") == dispersion.name for dispersion in added):
            table.complain("its name is given twice; give each its own", "name")
        without = read.get("without", ())
        for n, name in enumerate(without):
            if name not in drawn:
                table.complain(
                    f"without = {shown(name)}: [fragility.uncertain] does not draw it; leave it out", "without", n
                )
        if open_ := [name for name in drawn if name not in without]:
            table.complain(
                f"the scatter of {', '.join(open_)} is drawn by [fragility.uncertain], and counts once: if the value does not "
                f"contain it, write without = {shown(list(drawn))}; else reduce it, or leave it out",
            )
        if read.keys() >= {"name", "value"}:
            added.append(Dispersion(**read))
    return tuple(added)


def root_of_squares(dispersions: Iterable[Dispersion]) -> float:
    """Return the root of the sum of the squares of the dispersions."""
    return math.sqrt(sum(dispersion.value**2 for dispersion in dispersions))
