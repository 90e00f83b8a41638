"""Runs on a footing: what they came to."""

import math
from typing import Any

from rockbatch.core.types import Result
from rockbatch.outcome.outcome import BedDemands
from rockbatch.pier import FootingBase, Pier


def of_bed(pier: Pier, base: FootingBase, result: Result, survived: bool) -> dict[str, Any]:
    """Return what only piers on a footing have, by fields of Outcome: ``bed``, the demands on it, and residuals.

    These, settlement, tilt and rotation, and the settlements of both edges in ``bed``, are missing unless the pier ``survived``
    and has a rest.
    """
    more: dict[str, Any] = {}
    edges: dict[str, float] = {}
    if survived and math.isfinite(result.lean):
        more = {"settlement": result.settled, "base_tilt": result.bed_tilt, "theta_res": result.lean}
        rise = pier.half_width * math.sin(result.lean)
        edges = {"settlement_left": result.settled - rise, "settlement_right": result.settled + rise}
    more["bed"] = BedDemands(
        contact_least=result.contact_least,
        force=result.bed_force,
        t_force=result.t_force,
        pressure=_in_megapascals(pier, base, result.bed_pressure),
        t_pressure=result.t_pressure,
        pressure_at=result.pressure_side * pier.half_width,
        yielding_rocks=int(result.yielding_rocks),
        work=result.dissipated_left,
        **edges,
    )
    return more


def _in_megapascals(pier: Pier, base: FootingBase, pressure: float) -> float | None:
    """Return a ``pressure`` times the whole area over the mass [m/s²] in MPa; None if mass or length is not known."""
    if pier.mass_t is None or base.length_m is None:
        return None
    return pressure * pier.mass_t / (2.0 * pier.half_width * base.length_m) / 1000.0
