"""Intensity measures are computed from the motions of runs, and stand beside their peaks."""

import math
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any

import numpy as np

from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.motions import Motion
from rockbatch.motions.intensity import measures
from rockbatch.motions.intensity.pairs import pairing_obstacle, station_spectra
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.observers.intensity import TABLE
from rockbatch.observers.intensity.order import Array
from rockbatch.observers.intensity.study import Measures
from rockbatch.observers.intensity.table import MEASURES, spectral_column
from rockbatch.results import beside_peaks
from rockbatch.study import Study


def intensities(peaks: "pd.DataFrame", study: Study, motions: Sequence[Motion]) -> Iterator[dict[str, Any]]:
    """Yield the rows of intensity.csv, one for each run of ``peaks`` that was simulated."""
    settings = study.output.of(Measures)
    periods, rules = settings.sa_periods_s, settings.sa_pairs
    stations = grouped(motions, lambda motion: motion.of_station)

    @cache
    def of_pair(station: str) -> dict[str, Array]:
        """Return spectral accelerations [m/s²] of a station's pair, by the study's rules; NaN without one."""
        if pairing_obstacle(stations[station]):
            return dict.fromkeys(rules, np.full(len(periods), math.nan))
        return station_spectra(stations[station], periods, 0.05)

    @cache
    def of_record(motion: Motion) -> tuple[float, float, Array]:
        """Return PGV [m/s], CAV [m/s] and spectral accelerations [m/s²] of a motion before the study's scale."""
        a, dt = motion.horizontal, motion.dt
        pgv = measures.pgv(a, dt, motion.initial)
        return pgv, measures.cumulative_absolute_velocity(a, dt), spectral_acceleration(a, dt, periods)

    @cache
    def durations(motion: Motion, threshold: float) -> tuple[float, float]:
        a, dt = motion.horizontal, motion.dt
        return measures.bracketed_duration(a, dt, threshold), measures.uniform_duration(a, dt, threshold)

    for row, motion, scale, pier in beside_peaks.runs(peaks, study, motions):
        uplift = pier.gravity * math.tan(pier.alpha)
        pgv, cav, sa = of_record(motion)
        bracketed, uniform = durations(motion, uplift / scale)
        values = (scale * motion.pga / uplift, pier.p * scale * pgv / uplift, bracketed, uniform, scale * cav)
        of_spectrum = {
            spectral_column(period): scale * float(s) / pier.gravity for period, s in zip(periods, sa, strict=True)
        }
        for rule in rules:
            pair = of_pair(motion.of_station)[rule]
            of_spectrum |= {
                spectral_column(period, rule): scale * float(s) / pier.gravity
                for period, s in zip(periods, pair, strict=True)
            }
        yield {**row, **dict(zip(MEASURES, values, strict=True)), **of_spectrum}


def requested_table(study: Study) -> str:
    """Return the name of the table beside peaks.csv if a study asks for it; else ""."""
    return TABLE if study.output.of(Measures).intensity else ""


TABLE_OF_PEAKS = (requested_table, intensities)
