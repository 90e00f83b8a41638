"""Quantities of devices: dampers, tendons, stops and deck springs."""

from collections.abc import Callable
from typing import Any, Literal

from rockbatch.quantities.cases import weight
from rockbatch.quantities.limits import LENGTHS, WIDER
from rockbatch.quantities.quantity import Limit, Quantity, ReportFormat, Run


def of_device(
    name: str, words: str, source: str | Callable[[Run], Any], unit: str, head: str, form: str, factor: int = 1,
    *limits: Limit, device: str, more: str = "", behind: str = "", kind: Literal["number", "count"] = "number",
    weighed: bool = False,
) -> Quantity:  # fmt: skip
    """Return a quantity of a kind of devices; checks limit it as it is unless ``limits`` are given."""
    error = "" if kind == "count" else "devices_error"
    page = ReportFormat(head, form, factor, behind)
    return Quantity(
        f"{device}_{name}", words, source, unit, page, more, kind, sometimes=True, error=error, limits=limits or (Limit(),),
        device=device, weighed=weighed,
    )  # fmt: skip


def _device_force(device: str, symbol: str) -> Quantity:
    """Return the greatest force of a kind of devices over the weight."""
    kind = device.replace("_", " ")
    words = f"greatest force of a {kind} over the pier's weight"
    return of_device("force_over_weight", words, f"{device}_force", "1", f"{kind} {symbol}/(M g)", ".4f", device=device)


def _device_force_in_kilonewtons(device: str, symbol: str) -> Quantity:
    """Return it in kN; checks take it from that over the weight, since earlier results have no other."""

    def value(run: Run) -> float | None:
        force, mass = getattr(run.outcome, f"{device}_force"), run.pier.mass_t
        return None if force is None or mass is None else force * mass * run.pier.gravity

    kind, over_weight = device.replace("_", " "), f"{device}_force_over_weight"
    limit = Limit(times=weight, columns=(over_weight,))
    return of_device(
        "force_kN", f"greatest force of a {kind}", value, "kN", f"{kind} {symbol} [kN]", ".0f", 1, limit, device=device,
        more=", if mass_t is given", behind=over_weight, weighed=True,
    )  # fmt: skip


DEVICES = (
    _device_force("damper", "F"),
    of_device(
        "stroke_m", "greatest elongation of a damper", "damper_stroke", "m", "damper stroke [mm]", ".1f", 1000, *LENGTHS,
        device="damper",
    ),
    of_device("speed_m_s", "greatest speed of a damper", "damper_speed", "m/s", "damper speed [m/s]", ".3f", device="damper"),
    of_device(
        "energy_J_kg", "energy dissipated by all dampers, per unit mass of the pier", "damper_energy", "J/kg",
        "dampers [J/kg]", ".4f", device="damper",
    ),
    _device_force("tendon", "T"),
    of_device(
        "yield_m", "largest permanent elongation of a tendon", "tendon_yield", "m", "tendon yield [mm]", ".2f",
        1000, Limit(ceiling=WIDER), device="tendon",
    ),
    of_device("slack", "number of times tendons went slack", "tendon_slack", "1", "slack", ".0f", device="tendon", kind="count"),
    _device_force_in_kilonewtons("damper", "F"),
    _device_force_in_kilonewtons("tendon", "T"),
    _device_force("stop", "F"),
    of_device(
        "deflection_m", "greatest deflection of a stop beyond its gap", "stop_depth", "m", "stop deflection [mm]", ".1f", 1000,
        *LENGTHS, device="stop",
    ),
    of_device("blows", "number of contacts with stops", "stop_blows", "1", "blows", ".0f", device="stop", kind="count"),
    of_device(
        "energy_J_kg", "energy dissipated by all stops, per unit mass of the pier", "stop_energy", "J/kg",
        "stops [J/kg]", ".4f", device="stop",
    ),
    _device_force_in_kilonewtons("stop", "F"),
    _device_force("deck_spring", "F"),
    of_device(
        "deflection_m", "greatest deflection of a deck spring beyond its gap", "deck_spring_depth", "m",
        "deck spring deflection [mm]", ".1f", 1000, *LENGTHS, device="deck_spring",
    ),
    of_device(
        "blows", "number of times gaps at the deck closed", "deck_spring_blows", "1", "closures", ".0f", device="deck_spring",
        kind="count",
    ),
    of_device(
        "energy_J_kg", "energy dissipated by all deck springs, per unit mass of the pier", "deck_spring_energy",
        "J/kg", "deck springs [J/kg]", ".4f", device="deck_spring",
    ),
    _device_force_in_kilonewtons("deck_spring", "F"),
)  # fmt: skip
"""Quantities of devices."""
