"""Entries of motions in run.json: sizes, measures and spectra, as numbers and texts only."""

import hashlib
import math
from collections.abc import Iterable
from dataclasses import asdict
from typing import NotRequired, TypedDict

import numpy as np
import numpy.typing as npt

from rockbatch.motions.intensity import measures
from rockbatch.motions.intensity.velocity_pulses import pulse_period
from rockbatch.motions.motion import Motion
from rockbatch.motions.spectrum import PERIODS, periods_over, spectral_acceleration
from rockbatch.motions.suites.spectrum_target import SpectrumTarget

MOST_SPECTRA = 200
"""Greatest number of motions whose spectra go into run.json; each takes about 10 ms."""


class Spectra(TypedDict):
    """Response spectra of a suite in run.json: ``sa_g`` in the order of the motions; ``None`` where undefined."""

    damping: float
    period_s: list[float]
    sa_g: list[list[float]]
    mean_sa_g: NotRequired[list[float | None]]
    target_sa_g: NotRequired[list[float | None]]


def entry(motion: Motion, label: str, gravity: float, with_pulse: bool) -> dict[str, object]:
    """Return the run.json entry of a motion with the short name ``label``: names, sizes, measures, and its pulse on demand."""
    vertical = motion.pga_vertical
    return {
        "record": motion.name,
        "station": motion.of_station,
        **({"stations_of_shocks": list(motion.stations)} if len(motion.stations) > 1 else {}),
        "label": label,
        "event": motion.origin.event,
        "station_name": motion.origin.station,
        "direction": motion.origin.direction,
        "dt_s": motion.dt,
        "npts": motion.npts,
        "duration_s": motion.duration,
        "pga_g": motion.pga / gravity,
        "pga_v_g": None if vertical is None else vertical / gravity,
        "pgv_m_s": measures.pgv(motion.horizontal, motion.dt, motion.initial),
        "pgd_m": measures.believable_pgd(motion),
        "arias_m_s": measures.arias_intensity(motion.horizontal, motion.dt, gravity),
        "d5_95_s": measures.duration_of_shaking(motion),
        "azimuth_deg": motion.azimuth,
        "magnitude": motion.magnitude,
        "distance_km": motion.distance_km,
        **({"pulse_period_s": _four_digits([pulse_period(motion)])[0]} if with_pulse else {}),
        "factor": motion.factor,
        **({} if motion.vertical_factor is None else {"vertical_factor": motion.vertical_factor}),
        "source": motion.source,
        "vertical_source": motion.vertical_source,
        "recorded": motion.recorded,
        "processed": motion.processed,
        "digest": digest(motion),
        "findings": [asdict(finding) for finding in motion.findings],
        "notes": list(motion.notes),
    }


def digest(motion: Motion) -> str:
    """Return the SHA-256 of a motion as it is run: time step [s], and accelerations [m/s²], little-endian in 64 bits.

    A component across the axis, and the velocity and displacement with which the ground begins, follow behind their names.
    """
    hashed = hashlib.sha256(np.array([motion.dt], dtype="<f8").tobytes())
    for samples in (motion.horizontal, motion.vertical):
        hashed.update(b"" if samples is None else samples.astype("<f8").tobytes())
    if motion.across is not None:
        hashed.update(b"across" + motion.across.astype("<f8").tobytes())
    if motion.initial is not None:
        of_ground = [motion.initial.velocity, motion.initial.displacement]
        hashed.update(b"initial" + np.array(of_ground, dtype="<f8").tobytes())
    return hashed.hexdigest()


def spectra(
    motions: list[Motion], fitted: list[Motion], gravity: float, target: SpectrumTarget | None
) -> Spectra | None:
    """Return response spectra of a suite; None if it has more than :data:`MOST_SPECTRA` motions.

    With a ``target``, they have its damping and periods, and are followed by it and by the mean of the motions ``fitted``.
    """
    if len(motions) > MOST_SPECTRA:
        return None
    if target is None:
        return suite_spectra(motions, gravity)
    suite = suite_spectra(motions, gravity, target.spectrum.damping, periods_over(*target.range_s))
    periods = np.array(suite["period_s"], dtype=np.float64)
    names = {motion.name for motion in fitted}
    rows = [sa for motion, sa in zip(motions, suite["sa_g"], strict=True) if motion.name in names]
    mean = target.mean(fitted, periods, gravity, np.array(rows, dtype=np.float64))
    suite["mean_sa_g"] = _four_digits(mean)
    suite["target_sa_g"] = _four_digits(target.spectrum.at(periods))
    return suite


def _four_digits(values: Iterable[float | None]) -> list[float | None]:
    """Return values rounded to four significant digits, None for NaN and None, in a list."""
    return [None if value is None or math.isnan(value) else float(f"{value:.4g}") for value in values]


def suite_spectra(
    motions: list[Motion], gravity: float, damping: float = 0.05, periods: npt.ArrayLike = PERIODS
) -> Spectra:
    """Return the horizontal response spectra [g] of motions, in their order, at ``periods`` [s], all rounded to four digits."""
    undamped = np.asarray(periods, dtype=np.float64)
    spectra = [spectral_acceleration(m.horizontal, m.dt, undamped, damping) / gravity for m in motions]
    return {
        "damping": damping,
        "period_s": [float(f"{period:.4g}") for period in undamped],
        "sa_g": [[float(f"{value:.4g}") for value in spectrum] for spectrum in spectra],
    }
