"""Quantities of the work of devices."""

from collections.abc import Callable
from typing import Any

from rockbatch.pier import Pier
from rockbatch.pier.restraints import YIELDING_TENDON
from rockbatch.quantities.devices import of_device
from rockbatch.quantities.quantity import Quantity, ReportFormat, Run


def _of_work(field: str, per: Callable[[Pier], float | None] = lambda pier: 1.0) -> Callable[[Run], float | None]:
    """Return a function of a run: ``field`` of its ``DeviceWork`` times ``per`` of the pier; None if one of the two is None."""

    def value(run: Run) -> float | None:
        work = getattr(run.outcome.observed.get("devices_work"), field, None)
        times = per(run.pier)
        return None if work is None or times is None else work * times

    return value


def _work(
    name: str, words: str, source: Callable[[Run], float | None], unit: str, head: str, form: str, **facts: Any
) -> Quantity:
    """Return a quantity of the work of devices."""
    return of_device(name, words, source, unit, ReportFormat(head, form), needs="devices_work", **facts)


_TRAVEL, _CYCLES, _STRAIN = _of_work("damper_travel"), _of_work("damper_half_cycles"), _of_work("tendon_strain")
_WORK, _IN_KILOJOULES = _of_work("damper_work"), _of_work("damper_work", lambda pier: pier.mass_t)

FURTHER = (
    _work(
        "damper_travel_m", "greatest cumulative travel of a damper", _TRAVEL, "m", "damper travel", ".3f",
        device="damper", cumulative=True, more=", the sum of its way to and fro until the run ends",
    ),
    _work(
        "damper_work_J_kg", "greatest energy that one damper dissipates until the run ends, per unit mass of the pier", _WORK,
        "J/kg", "damper work", ".4f", device="damper", cumulative=True,
    ),
    _work(
        "damper_work_kJ", "greatest energy that one damper dissipates until the run ends", _IN_KILOJOULES, "kJ",
        "damper work", ".1f", device="damper", cumulative=True, more=", if mass_t is given", weighed=True,
    ),
    _work(
        "damper_half_cycles", "most half cycles of a damper until the run ends", _CYCLES, "1", "half cycles", ".0f",
        device="damper", kind="count", error="", cumulative=True,
        more=", by rainflow counting, from [output] least_stroke_mm from end to end up, 10 mm unless given",
    ),
    _work(
        "tendon_strain_over_yield", "greatest strain of a tendon over its yield strain", _STRAIN, "1", "tendon ε/ε_y", ".3f",
        more=", prestress and plastic strain included; of tendons that yield", device=YIELDING_TENDON,
    ),
)  # fmt: skip
