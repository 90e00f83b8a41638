"""intensity.csv: measures of each run's motion, scaled for a rocking pier."""

import re
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from rockbatch.common.files import read_table
from rockbatch.common.lazy import pd
from rockbatch.observers.intensity import TABLE
from rockbatch.results.beside_peaks import present


class Measure(NamedTuple):
    """An intensity measure: its symbol, and its meaning with the unit."""

    symbol: str
    meaning: str


MEASURES = {
    "pga_over_g_tan_alpha": Measure(
        "PGA/(g tan α)", "PGA over g tan α, the ground acceleration that lifts the pier off rigid ground"
    ),
    "p_pgv_over_g_tan_alpha": Measure("p PGV/(g tan α)", "p PGV over g tan α"),
    "bracketed_s": Measure(
        "bracketed duration",
        "bracketed duration: from the first to the last time that the acceleration exceeds g tan α [s]",
    ),
    "uniform_s": Measure(
        "uniform duration", "uniform duration: all the time that the acceleration exceeds g tan α [s]"
    ),
    "cav_m_s": Measure("CAV", "cumulative absolute velocity, ∫|a| dt [m/s]"),
}
"""Measures by column, beside spectral accelerations."""

_OF_PAIRS = {"geomean": "geometric mean", "rotd50": "RotD50", "rotd100": "RotD100"}
"""Measures of the station's pair of horizontal components, empty without a pair, by their names in columns."""

_SPECTRAL = re.compile(rf"sa_(?P<period>[^_]+)s(?:_(?P<rule>{'|'.join(_OF_PAIRS)}))?_g")


def spectral_column(period: float, rule: str = "") -> str:
    """Return the column of the 5 % damped spectral acceleration [g] at a period [s], of a pair by a ``rule``."""
    return f"sa_{period:g}s_{rule}_g" if rule else f"sa_{period:g}s_g"


def measures_in(columns: Iterable[str]) -> dict[str, Measure]:
    """Return the measures among some columns: CAV, SA(0.5 s) of sa_0.5s_g, RotD100(0.5 s) of sa_0.5s_rotd100_g, by column."""
    measures = {}
    for column in columns:
        if spectral := _SPECTRAL.fullmatch(column):
            symbol = _OF_PAIRS.get(spectral["rule"], "SA")
            measures[column] = Measure(f"{symbol}({spectral['period']}\u00a0s)", "spectral acceleration [g]")
        elif column in MEASURES:
            measures[column] = MEASURES[column]
    return measures


def read(directory: Path) -> "pd.DataFrame":
    """Return the table; ``InputError`` without it, or if it is no CSV."""
    return read_table(present(directory / TABLE, "[output] intensity = true"))
