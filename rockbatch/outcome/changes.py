"""Errors of design demands: the greatest relative change by halving the step."""

import math
from collections.abc import Mapping
from typing import NamedTuple

from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import Pier

FLOOR = 0.01
"""Share of a quantity's scale below which it governs no design; changes are relative to at least that."""

LEAST = 1e-8
"""Least relative error that is claimed for devices and sections: two runs may agree better than either is right."""


class Sized(NamedTuple):
    """Fields of one quantity, such as those of both pivots, and the name of its scale in :func:`scales_of`."""

    fields: tuple[str, ...]
    scale: str


def scales_of(pier: Pier) -> Mapping[str, float]:
    """Return sizes by kind of quantity ("force", "gap", "energy", …), a hundredth of which a change must reach to matter.

    Per unit mass and in SI units: of the weight ("force", "moment"), 1 ("share"), tan α ("friction"), and of a pier that
    leans by α (the rest). :func:`greatest_change` divides by no less.
    """
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


def greatest_change(quantities: Mapping[str, Sized], fine: object, coarse: object, pier: Pier) -> tuple[str, float]:
    """Return the name and relative change of the quantity that changes most from ``coarse`` to ``fine``; None counts as 0.

    Changes are relative to the greatest ``fine`` value, or to :data:`FLOOR` of the quantity's scale if that is more.
    """
    scales = scales_of(pier)
    changes = {}
    for name, (fields, scale) in quantities.items():
        finer, coarser = ([getattr(results, field) or 0.0 for field in fields] for results in (fine, coarse))
        changed = max(abs(new - old) for new, old in zip(finer, coarser, strict=True))
        changes[name] = changed / max(*map(abs, finer), FLOOR * scales[scale])
    worst = max(changes, key=changes.__getitem__)
    return worst, changes[worst]


OF_DEVICES = {
    "damper force": Sized(("damper_force",), "share"),
    "damper stroke": Sized(("damper_stroke",), "gap"),
    "damper speed": Sized(("damper_speed",), "speed"),
    "damper energy": Sized(("damper_energy",), "energy"),
    "tendon force": Sized(("tendon_force",), "share"),
    "tendon yield": Sized(("tendon_yield",), "gap"),
    "stop force": Sized(("stop_force",), "share"),
    "stop depth": Sized(("stop_depth",), "gap"),
    "stop energy": Sized(("stop_energy",), "energy"),
    "deck spring force": Sized(("deck_spring_force",), "share"),
    "deck spring depth": Sized(("deck_spring_depth",), "gap"),
    "deck spring energy": Sized(("deck_spring_energy",), "energy"),
}


def change_of_devices(fine: Outcome, coarse: Outcome, pier: Pier) -> float | None:
    """Return the greatest relative change of the devices' demands but counts, at least :data:`LEAST`; None without devices."""
    if fine.damper_force is fine.tendon_force is fine.stop_force is fine.deck_spring_force is None:
        return None
    return max(greatest_change(OF_DEVICES, fine, coarse, pier)[1], LEAST)
