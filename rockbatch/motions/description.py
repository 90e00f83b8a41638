"""What a table or run.json says of motions: sizes, measures and spectra, numbers and texts only."""

import math
from dataclasses import asdict
from typing import Any

import numpy as np
import numpy.typing as npt

from rockbatch.motions import measures
from rockbatch.motions.motion import Motion
from rockbatch.motions.spectrum import PERIODS, periods_over, spectral_acceleration
from rockbatch.motions.spectrum_target import SpectrumTarget
from rockbatch.motions.velocity_pulses import pulse_period

MOST_SPECTRA = 200
"""Motions whose spectra go into run.json; each takes about 10 ms."""


def entry(motion: Motion, label: str, gravity: float, with_pulse: bool) -> dict[str, Any]:
    """Return names, sizes and measures of a motion under its short name ``label``, and its pulse if that is asked for."""
    vertical = motion.pga_vertical
    return {
        "record": motion.name,
        "station": motion.of_station,
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
        "d5_95_s": None if len(motion.shocks) > 1 else measures.significant_duration(motion.horizontal, motion.dt),
        "azimuth_deg": motion.azimuth,
        "magnitude": motion.magnitude,
        "distance_km": motion.distance_km,
        **(_pulse(motion) if with_pulse else {}),
        "factor": motion.factor,
        **({} if motion.vertical_factor is None else {"vertical_factor": motion.vertical_factor}),
        "source": motion.source,
        "vertical_source": motion.vertical_source,
        "processed": motion.processed,
        "findings": [asdict(finding) for finding in motion.findings],
        "notes": list(motion.notes),
    }


def _pulse(motion: Motion) -> dict[str, Any]:
    """Return the period of the pulse of a motion that is pulse-like by the criterion of Baker (2007)."""
    period = pulse_period(motion)
    return {"pulse_period_s": None if period is None else float(f"{period:.4g}")}


def spectra(
    motions: list[Motion], fitted: list[Motion], gravity: float, target: SpectrumTarget | None
) -> dict[str, Any] | None:
    """Return response spectra of a suite that is not too large; with the damping and periods of its target, if any, and the mean
    of those ``fitted`` to it."""
    if len(motions) > MOST_SPECTRA:
        return None
    if target is None:
        return suite_spectra(motions, gravity)
    found = suite_spectra(motions, gravity, target.spectrum.damping, periods_over(*target.range_s))
    of_target = target.spectrum.at(np.array(found["period_s"], dtype=np.float64))
    periods = np.array(found["period_s"], dtype=np.float64)
    names = {motion.name for motion in fitted}
    rows = [sa for motion, sa in zip(motions, found["sa_g"], strict=True) if motion.name in names]
    mean = target.mean(fitted, periods, gravity, np.array(rows, dtype=np.float64))
    return found | {
        "mean_sa_g": [None if math.isnan(sa) else float(f"{sa:.4g}") for sa in mean],
        "target_sa_g": [None if math.isnan(sa) else float(f"{sa:.4g}") for sa in of_target],
    }


def suite_spectra(
    motions: list[Motion], gravity: float, damping: float = 0.05, periods: npt.ArrayLike = PERIODS
) -> dict[str, Any]:
    """Return horizontal spectra of motions, as run.json has them: ``damping``, ``period_s`` and, in the order of the motions,
    ``sa_g``."""
    undamped = np.asarray(periods, dtype=np.float64)
    spectra = [spectral_acceleration(m.horizontal, m.dt, undamped, damping) / gravity for m in motions]
    return {
        "damping": damping,
        "period_s": [float(f"{period:.4g}") for period in undamped],
        "sa_g": [[float(f"{value:.4g}") for value in spectrum] for spectrum in spectra],
    }
