"""Errors of demands on the design: by which share of itself halving the step still changed one of them at most."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import Pier

FLOOR = 0.01
"""Share of a quantity's scale below which it governs no design: an error is a share of no less than that."""


LEAST = 1e-8
"""Least error of demands on devices and in sections that is claimed, as a share: two runs may agree by chance better than either
is right."""


class Sized(NamedTuple):
    """Fields that make one quantity, such as those of both pivots, and its scale, one of :func:`scales_of`."""

    fields: tuple[str, ...]
    scale: str


def scales_of(pier: Pier) -> Mapping[str, float]:
    """Return the scales of quantities: the weight, friction tan α, and a pier that leans by α."""
    gap = 2.0 * pier.half_width * pier.alpha
    return {
        "force": pier.gravity,
        "moment": pier.gravity * pier.half_width,
        "share": 1.0,
        "friction": math.tan(pier.alpha),
        "gap": gap,
        "speed": pier.size * pier.alpha * pier.p,
        "rotation": pier.alpha,
        "energy": 0.25 * pier.gravity * gap,
    }


def greatest_change(quantities: Mapping[str, Sized], fine: Any, coarse: Any, pier: Pier) -> tuple[str, float]:
    """Return the name of the quantity that differs most between ``fine`` and ``coarse``, and the difference as a share of it."""
    scales = scales_of(pier)
    changes = {}
    for name, (fields, scale) in quantities.items():
        finer, coarser = ([getattr(results, field) or 0.0 for field in fields] for results in (fine, coarse))
        changed = max(abs(new - old) for new, old in zip(finer, coarser, strict=True))
        changes[name] = changed / max(*map(abs, finer), FLOOR * scales[scale])
    worst = max(changes, key=changes.__getitem__)
    return worst, changes[worst]


OF_DEVICES = {
    field.replace("_", " "): Sized((field,), scale)
    for field, scale in {
        "damper_force": "share",
        "damper_stroke": "gap",
        "damper_speed": "speed",
        "damper_energy": "energy",
        "tendon_force": "share",
        "tendon_yield": "gap",
        "stop_force": "share",
        "stop_depth": "gap",
        "stop_energy": "energy",
        "deck_spring_force": "share",
        "deck_spring_depth": "gap",
        "deck_spring_energy": "energy",
    }.items()
}  # fmt: skip


def change_of_devices(fine: Outcome, coarse: Outcome, pier: Pier) -> float | None:
    """Return the error of the demands on devices; None without any."""
    if fine.damper_force is fine.tendon_force is fine.stop_force is fine.deck_spring_force is None:
        return None
    return max(greatest_change(OF_DEVICES, fine, coarse, pier)[1], LEAST)
