"""Quantities of devices: dampers, tendons, stops and deck springs."""

from collections.abc import Callable
from typing import Any

from rockbatch.quantities.cases import TENDON_YIELDS, weight
from rockbatch.quantities.limits import LENGTHS, WIDER
from rockbatch.quantities.quantity import Limit, Quantity, ReportFormat, Run


def of_device(
    name: str,
    words: str,
    source: str | Callable[[Run], Any],
    unit: str,
    page: ReportFormat,
    error: str = "devices_error",
    limits: tuple[Limit, ...] = (Limit(),),
    **facts: Any,
) -> Quantity:
    """Return a quantity of a kind of devices, given by ``device``; checks limit it as it is unless ``limits`` are given."""
    return Quantity(name, words, source, unit, page, sometimes=True, error=error, limits=limits, **facts)


def _count(device: str, name: str, words: str, head: str) -> Quantity:
    """Return the quantity of a number of events of devices, which has no error."""
    return of_device(name, words, name, "1", ReportFormat(head, ".0f"), kind="count", error="", device=device)


def _force(device: str, symbol: str) -> Quantity:
    """Return the quantity of the greatest force of a kind of devices over the weight."""
    kind = device.replace("_", " ")
    words, page = f"greatest force of a {kind} over the pier's weight", ReportFormat(f"{kind} {symbol}/(M g)", ".4f")
    return of_device(f"{device}_force_over_weight", words, f"{device}_force", "1", page, device=device)


def _force_in_kilonewtons(device: str, symbol: str) -> Quantity:
    """Return the quantity of the greatest force of a kind of devices [kN], None without a mass.

    Checks take it from the force over the weight, since earlier results have no other.
    """

    def value(run: Run) -> float | None:
        force, mass = getattr(run.outcome, f"{device}_force"), run.pier.mass_t
        return None if force is None or mass is None else force * mass * run.pier.gravity

    kind, over_weight = device.replace("_", " "), f"{device}_force_over_weight"
    words, page = f"greatest force of a {kind}", ReportFormat(f"{kind} {symbol}", ".0f", behind=over_weight)
    limits = (Limit(times=weight, columns=(over_weight,)),)
    return of_device(
        f"{device}_force_kN",
        words,
        value,
        "kN",
        page,
        more=", if mass_t is given",
        weighed=True,
        limits=limits,
        device=device,
    )


def _depth(device: str) -> Quantity:
    """Return the quantity of the greatest deflection of a stop or a deck spring beyond its gap [m]."""
    kind = device.replace("_", " ")
    words = f"greatest deflection of a {kind} beyond its gap"
    page = ReportFormat(f"{kind} deflection", ".1f", 1000)
    return of_device(f"{device}_deflection_m", words, f"{device}_depth", "m", page, limits=LENGTHS, device=device)


def _energy(device: str) -> Quantity:
    """Return the quantity of the energy that all devices of a kind dissipate [J/kg]."""
    kinds = f"{device.replace('_', ' ')}s"
    words = f"energy dissipated by all {kinds} until the run ends, per unit mass of the pier"
    page = ReportFormat(f"{kinds}", ".4f")
    return of_device(f"{device}_energy_J_kg", words, f"{device}_energy", "J/kg", page, device=device, cumulative=True)


_STROKE, _SPEED = ReportFormat("damper stroke", ".1f", 1000), ReportFormat("damper speed", ".3f")
_YIELD = ReportFormat("tendon yield", ".2f", 1000)

DEVICES = (
    _force("damper", "F"),
    of_device(
        "damper_stroke_m",
        "greatest elongation of a damper",
        "damper_stroke",
        "m",
        _STROKE,
        limits=LENGTHS,
        device="damper",
    ),
    of_device("damper_speed_m_s", "greatest speed of a damper", "damper_speed", "m/s", _SPEED, device="damper"),
    _energy("damper"),
    _force("tendon", "T"),
    of_device(
        "tendon_yield_m",
        "largest permanent elongation of a tendon",
        "tendon_yield",
        "m",
        _YIELD,
        limits=(Limit(ceiling=WIDER),),
        device="tendon",
        condition=TENDON_YIELDS,
    ),
    _count("tendon", "tendon_slack", "number of times tendons went slack", "slack"),
    _force_in_kilonewtons("damper", "F"),
    _force_in_kilonewtons("tendon", "T"),
    _force("stop", "F"),
    _depth("stop"),
    _count("stop", "stop_blows", "number of contacts with stops", "blows"),
    _energy("stop"),
    _force_in_kilonewtons("stop", "F"),
    _force("deck_spring", "F"),
    _depth("deck_spring"),
    _count("deck_spring", "deck_spring_blows", "number of times gaps at the deck closed", "closures"),
    _energy("deck_spring"),
    _force_in_kilonewtons("deck_spring", "F"),
)
"""Quantities of devices."""
