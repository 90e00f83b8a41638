"""What the model assumes of this study, in about ten lines: its values decide which."""

from collections.abc import Callable, Collection, Iterable
from typing import Any

from rockbatch.quantities.cases import (
    Case,
    asks_tension,
    bends,
    devices,
    is_across,
    is_frame,
    lands_by_impulse,
    number_of_modes,
    stops_by_impulse,
)
from rockbatch.quantities.quantity import FOOTING, TWO_SPRINGS
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import counted
from rockbatch.reporting.markup import Markup, number, tag


def section(finished: Finished) -> Markup:
    """Return the list of assumptions."""
    return tag("ul", *(tag("li", line) for line in lines(finished, finished.info["cases"])), class_="assumptions")


def lines(finished: Finished, cases: Collection[Case]) -> list[str]:
    """Return the assumptions of some cases of a study as sentences, in a fixed order."""
    system = (_plane(cases), _body(cases), _ground(cases), _landings(cases), _flight(cases), _sliding(cases))
    rest = (_damping(cases), _devices(cases), _motions(finished), _numerics(finished.info["numerics"], cases))
    return [line for line in (*system, *rest) if line]


def _plane(cases: Collection[Case]) -> str:
    if any(is_across(case) for case in cases):
        return "Two planar models of each pier, one for each axis; rolling on a corner and twisting are not modelled."
    return "Each pier moves in one vertical plane; rolling on a corner and twisting are not modelled."


def _body(cases: Collection[Case]) -> str:
    """Return sentences on what bends: never a frame; a shaft in its lowest modes; else nothing. "" without cases.

    The last two have their cases unless they are true of all.
    """
    parts = []
    if any(map(is_frame, cases)):
        parts.append("The columns of the frame are rigid and alike, and its deck stays level and on them.")
    if bending := [case for case in cases if bends(case)]:
        known = [period for case in bending if (period := case["pier"].get("flexural_period_s")) is not None]
        first = f", the first of {_listed({number(float(period)) for period in known})} s" if known else ""
        modes = _listed({counted(number_of_modes(case), "mode") for case in bending})
        parts.append(f"The shaft bends in {modes}{first}{_only(bending, cases)}; higher ones are not modelled.")
    if rigid := [case for case in cases if not bends(case) and not is_frame(case)]:
        parts.append(f"The pier is one rigid body with the masses that it carries{_only(rigid, cases)}.")
    return " ".join(parts)


def _ground(cases: Collection[Case]) -> str:
    """Return a sentence for each kind of base on which piers stand, with its cases unless all have it."""
    kinds: list[tuple[Callable[[Case], bool], str]] = [
        (
            lands_by_impulse,
            "rigid ground, which does not give, at two pivots that keep their place: no crushing of edges",
        ),
        (lambda case: case["base"] in TWO_SPRINGS, "two vertical supports that push and never pull, one at each pivot"),
        (lambda case: case["base"] in FOOTING, "a footing on a bed of independent strips that push and never pull"),
    ]
    stand = [(words, [case for case in cases if of_kind(case)]) for of_kind, words in kinds]
    return " ".join(f"The pier stands on {words}{_only(some, cases)}." for words, some in stand if some)


def _landings(cases: Collection[Case]) -> str:
    """Return sentences on how landings lose energy: on rigid ground, and on springs by Housner's factor or by ε.

    Those on springs have their cases unless it is all. "" if no landing is stopped by an impulse.
    """
    parts = []
    if impulsive := [case for case in cases if lands_by_impulse(case)]:
        given = {case["parameters"].get("restitution") for case in impulsive if not bends(case)}
        factors = [number(float(value)) for value in sorted(value for value in given if value is not None)]
        words = ["Housner's factor on the angular velocity, by conservation of its moment"] if None in given else []
        words += [f"the given factor {_listed(factors)}"] if factors else []
        words += ["the momenta of the modes of a shaft that bends are kept"] if any(map(bends, impulsive)) else []
        parts.append(f"A landing on rigid ground is an impulse without a duration or a force: {' or '.join(words)}.")
    springs = [case for case in cases if not lands_by_impulse(case)]
    if pulled := [case for case in springs if asks_tension(case)]:
        parts.append(
            f"An impact has Housner's factor on springs, too, for which a support would pull{_only(pulled, cases)}."
        )
    stopped = [case for case in springs if "epsilon" in case["parameters"] and stops_by_impulse(case)]
    if stopped := [case for case in stopped if not asks_tension(case)]:
        shares = _listed({number(float(case["parameters"]["epsilon"])) for case in stopped})
        parts.append(f"The pivot that lands keeps ε = {shares} of its speed, by an impulse{_only(stopped, cases)}.")
    return " ".join(parts)


def _flight(cases: Collection[Case]) -> str:
    """Return a sentence for each way in which a flight of both pivots goes on or ends, with its cases unless all."""
    flying: dict[str, list[Case]] = {}
    for case in cases:
        flying.setdefault(case["parameters"].get("flight", "guided"), []).append(case)
    words = {
        "guided": "If both pivots leave the ground, shear keys guide the pier down to where it stood",
        "stop": "A run ends when both pivots leave the ground",
    }
    return " ".join(f"{words[kind]}{_only(some, cases)}." for kind, some in flying.items() if some and kind in words)


def _sliding(cases: Collection[Case]) -> str:
    known = [case for case in cases if case["parameters"].get("friction") is not None]
    if not known:
        return "The feet do not slide, whatever friction this requires: shear keys must carry the rest."
    friction = _listed({number(float(case["parameters"]["friction"])) for case in known})
    return f"The feet do not slide; runs that would, at a friction of {friction}{_only(known, cases)}, are marked."


def _damping(cases: Collection[Case]) -> str:
    """Return a sentence on dashpots beside the supports: "… by ζ = 0.05 of critical; there is no other damping but …".

    Without them it is "Nothing but landings, yielding and devices takes energy."
    """
    damped = [case for case in cases if case["parameters"].get("zeta")]
    if not damped:
        return "Nothing but landings, yielding and devices takes energy."
    shares = _listed({number(float(case["parameters"]["zeta"])) for case in damped})
    words = (
        f"Dashpots beside the supports damp the vertical vibration by ζ = {shares} of critical{_only(damped, cases)}"
    )
    return f"{words}; there is no other damping but that of landings, yielding and devices."


def _devices(cases: Collection[Case]) -> str:
    if not any(list(devices(case)) for case in cases):
        return ""
    return (
        "Devices act between the pier and ground or neighbours that move with the ground; they do not degrade, break "
        "or reach the end of their travel."
    )


def _motions(finished: Finished) -> str:
    """Return a sentence on the components of the ground motion, which is alike under both pivots."""
    records = finished.info["records"]
    vertical = sum(record["pga_v_g"] is not None for record in records)
    components = "horizontally and vertically" if vertical == len(records) else "horizontally"
    some = f" (vertically, too, in {vertical} of {len(records)} records)" if 0 < vertical < len(records) else ""
    return (
        f"The ground moves {components}{some} and alike under both pivots; the records are the motion at the base, without site "
        "response and without radiation or kinematic interaction beyond the foundation's own parameters."
    )


def _numerics(numerics: Any, cases: Collection[Case]) -> str:
    kept = f"Runs go on for at least {number(float(numerics['quiet_s']))} s beyond the record, until nothing can exceed the peak"
    if numerics["tolerance"]:
        largest = number(float(numerics["tolerance"]))
        strips = ", or on a footing a tenth of the error of its strips" * any(case["base"] in FOOTING for case in cases)
        return f"{kept}; the step is halved until the estimated error of θ/α is at most {largest}{strips}."
    return f"{kept}; the step is fixed, and its error was not estimated."


def _only(some: Collection[Case], cases: Collection[Case]) -> str:
    """Return the cases of which a sentence is true, " (pads; piles)"; empty if that is all of them."""
    if len(some) == len(cases):
        return ""
    return f" ({'; '.join(dict.fromkeys(str(case['case']) for case in some))})"


def _listed(values: Iterable[str]) -> str:
    return ", ".join(sorted(values))
