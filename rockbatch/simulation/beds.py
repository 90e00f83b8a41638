"""Runs on a footing: their outcome, and the share of the number of strips in its errors."""

import math
from dataclasses import replace
from typing import Any

from rockbatch.core.types import Result
from rockbatch.outcome.outcome import BedDemands, Outcome
from rockbatch.pier import FootingBase, Pier

ORDER = 3.0
"""By how much more halving the number of strips changes than they are wrong: an error of order 2 is a third of the change."""

FEWER_STRIPS = "half as many strips come to another end: {status}; no error is claimed"


def of_bed(pier: Pier, base: FootingBase, result: Result, survived: bool) -> dict[str, Any]:
    """Return fields of Outcome for a pier on a footing: demands on its ``bed``, and residuals if it ``survived``."""
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


def with_fewer_strips(base: FootingBase) -> FootingBase:
    """Return the same footing on half as many strips."""
    return replace(base, strips=base.strips // 2)


def with_strips_error(outcome: Outcome, fewer: Outcome) -> Outcome:
    """Return ``outcome`` with the share of the strips in its errors, from that of half as many at the same step.

    Without errors and noted if ``fewer`` strips end otherwise; unchanged for a pier that did not stand.
    """
    if outcome.status != "ok" or outcome.bed is None:
        return outcome
    if fewer.status != outcome.status:
        unknown = dict.fromkeys(("theta_max_error", "theta_res_error", "settlement_error"))
        return outcome.noted(FEWER_STRIPS.format(status=fewer.status), **unknown)
    share = abs(outcome.theta_max - fewer.theta_max) / ORDER
    assert fewer.bed is not None
    own, other = outcome.bed.pressure, fewer.bed.pressure
    of_pressure = None if own is None or other is None else abs(own - other)  # of order 1
    more: dict[str, Any] = {"bed": replace(outcome.bed, strips_error=share, pressure_error=of_pressure)}
    for name in ("theta_max", "theta_res", "settlement"):
        own, other, error = (
            getattr(of, field) for of, field in ((outcome, name), (fewer, name), (outcome, f"{name}_error"))
        )
        if error is not None and own is not None and other is not None:
            more[f"{name}_error"] = error + abs(own - other) / ORDER
    return outcome.changed(**more)
