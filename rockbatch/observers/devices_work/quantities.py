"""Quantities of the work of devices."""

from collections.abc import Callable
from dataclasses import replace
from typing import Literal

from rockbatch.pier import Pier
from rockbatch.pier.restraints import YIELDING_TENDON
from rockbatch.quantities.devices import of_device
from rockbatch.quantities.quantity import Limit, Quantity, Run


def _work(
    name: str, words: str, field: str, unit: str, head: str, form: str, factor: int = 1, *limits: Limit, device: str,
    more: str = "", kind: Literal["number", "count"] = "number", per: Callable[[Pier], float | None] = lambda pier: 1.0,
    behind: str = "",
) -> Quantity:  # fmt: skip
    """Return a quantity of a ``field`` of ``DeviceWork``, times ``per`` of the pier if that is known."""

    def value(run: Run) -> float | None:
        work = None if run.outcome.device_work is None else getattr(run.outcome.device_work, field)
        times = per(run.pier)
        return None if work is None or times is None else work * times

    weighed = unit == "kJ"
    quantity = of_device(
        name, words, value, unit, head, form, factor, *limits, device=device, more=more, behind=behind, kind=kind,
        weighed=weighed,
    )  # fmt: skip
    return replace(quantity, needs="devices_work")


FURTHER = (
    _work(
        "travel_m", "greatest cumulative travel of a damper", "damper_travel", "m", "damper travel [m]", ".3f", device="damper",
        more=", the sum of its way to and fro",
    ),
    _work(
        "work_J_kg", "greatest energy that one damper dissipates, per unit mass of the pier", "damper_work", "J/kg",
        "damper work [J/kg]", ".4f", device="damper",
    ),
    _work(
        "work_kJ", "greatest energy that one damper dissipates", "damper_work", "kJ", "damper work [kJ]", ".1f",
        device="damper", more=", if mass_t is given", per=lambda pier: pier.mass_t,
    ),
    _work(
        "half_cycles", "most half cycles of a damper", "damper_half_cycles", "1", "half cycles", ".0f", device="damper",
        more=", by rainflow counting, from [output] least_stroke_mm from end to end up, 10 mm unless given", kind="count",
    ),
    replace(
        _work(
            "strain_over_yield", "greatest strain of a tendon over its yield strain", "tendon_strain", "1", "tendon ε/ε_y",
            ".3f", device="tendon", more=", prestress and plastic strain included; of tendons that yield",
        ),
        device=YIELDING_TENDON,
    ),
)  # fmt: skip
