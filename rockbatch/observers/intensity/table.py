"""intensity.csv: measures of each run's motion, scaled for a rocking pier."""

from pathlib import Path

from rockbatch.common.files import read_table
from rockbatch.common.lazy import pd
from rockbatch.observers.intensity import TABLE
from rockbatch.results.beside_peaks import present

MEANING = {
    "pga_over_g_tan_alpha": "PGA over g tan α, the ground acceleration that lifts the pier off rigid ground",
    "p_pgv_over_g_tan_alpha": "p PGV over g tan α",
    "bracketed_s": "bracketed duration: from the first to the last time that the acceleration exceeds g tan α [s]",
    "uniform_s": "uniform duration: all the time that the acceleration exceeds g tan α [s]",
    "cav_m_s": "cumulative absolute velocity, ∫|a| dt [m/s]",
}
"""Measures by column. In addition, ``sa_Ts_g`` is the 5 % damped spectral acceleration [g] at T seconds, and
``sa_Ts_rotd100_g`` and the like are of the station's pair of horizontal components, empty without a pair."""


def read(directory: Path) -> "pd.DataFrame":
    """Return the table; ``InputError`` without it, or if it is no CSV."""
    return read_table(present(directory / TABLE, "[output] intensity = true"))
