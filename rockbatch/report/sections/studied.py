"""The study in words and units: the pier, its foundations and the ground motions."""

import math
from collections.abc import Mapping
from typing import Any

from rockbatch.pier.statics import lift_off_acceleration, lift_off_rotation, unstable_equilibrium
from rockbatch.report.drawing import pier as drawing
from rockbatch.report.finished import Finished
from rockbatch.report.labels import counted, plain, quantity, symbol
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.structure import in_words, pier_of, restraints_of
from rockbatch.report.table import THETA_FORMAT, Head, sub, table
from rockbatch.study import PIER_KEYS

GIVEN = {
    "width_m": ("between the pivots", "m"),
    "height_m": ("height", "m"),
    "mass_t": ("mass", "t"),
    "columns": ("columns", ""),
    "deck_mass_t": ("deck", "t"),
    "deck_height_m": ("centre of the deck at", "m"),
    "deck_inertia_t_m2": ("its rotary inertia", "t m²"),
    "top_m": ("drift read at", "m"),
}
"""Keys of [pier] that are quoted, with their words and units."""

BALANCE = (
    "Balance: the unstable equilibrium, beyond which the pier does not come back. All quasi-static: "
    "lift-off under a steady horizontal ground acceleration without a vertical one, from elastic supports; "
    "weight, tendons and friction hold the pier, viscous and hysteretic dampers bear nothing at rest. On springs a pier in "
    "first-order kinematics comes back from up to tan α."
)


def section(finished: Finished, level: str = "h3") -> Markup:
    """Describe the pier, the foundations and the records; ``level`` is that of the headings within."""
    info, runs = finished.info, finished.runs
    piers: dict[tuple[float, ...], dict[str, float]] = {}
    for case in info["cases"]:
        pier = case["pier"]
        piers.setdefault(tuple(pier[key] for key in ("alpha", "p", "mu", "gravity")), pier)
    scales = sorted(runs["scale"].unique()) if len(runs) else []
    extent = (
        f"{counted(len(piers), 'pier')} on {counted(len(finished.series), 'foundation')} under "
        f"{counted(len(info['records']), 'ground motion')} ({_vertical(finished)})"
        + (", in both polarities" if finished.both_directions else "")
        + (f", scaled by {', '.join(number(float(scale)) for scale in scales)}" if scales not in ([], [1.0]) else "")
        + f": {counted(len(runs), 'run')}."
        + (" Polarity: mirror images, counted once." if finished.mirrored else "")
    )
    described = tag("ul", *(tag("li", _pier(pier)) for pier in piers.values()), *_masses(finished.pier_as_given))
    return join(
        tag("p", extent[0].upper() + extent[1:]), described, _drawn(finished), tag("p", _motions(finished)),
        tag(level, "Foundations"), foundations(finished), tag(level, "Lift-off, balance and devices"), balance(finished),
    )  # fmt: skip


def _drawn(finished: Finished) -> Markup:
    """Draw each pier with its devices."""
    bases = {case["base"] for case in finished.info["cases"]}
    has_deck = "deck_mass_t" in finished.pier_as_given
    shown: dict[tuple[object, ...], tuple[dict[str, Any], list[str]]] = {}
    for case in finished.info["cases"]:
        pier = pier_of(case)
        places = drawing.devices(pier, restraints_of(case)) if pier else ()
        key = case["pier"]["alpha"], case["pier"]["p"], places
        deck = {"deck_m": pier.deck} if has_deck and pier else {}
        names = shown.setdefault(key, (case["pier"] | deck | {"devices": places}, []))[1]
        if case["case"] not in names:
            names.append(str(case["case"]))
    piers = [pier | {"name": ", ".join(names) if len(shown) > 1 else ""} for pier, names in shown.values()]
    return tag("div", *drawing.piers(piers, bases), class_="piers") if piers else Markup("")


def _masses(given: Mapping[str, Any]) -> list[Markup]:
    """Return the numbers of the pier in the units of the study file; those that vary are in the tables."""
    parts = given.get("part", ())
    words = GIVEN | ({"mass_t": ("shaft", "t")} if "deck_mass_t" in given else {})
    numbers = [
        f"{words[key][0]} {plain(value, 6)} {words[key][1]}".strip()
        for key, value in given.items()
        if key in words and isinstance(value, int | float)
    ]
    numbers += [
        f"a part of {part['mass_t']:g} t at {part['height_m']:g} m"
        for part in (parts if isinstance(parts, list) else ())
        if isinstance(part, dict) and all(isinstance(part.get(key), int | float) for key in ("mass_t", "height_m"))
    ]
    return [tag("li", f"As given: {', '.join(numbers)}.")] if numbers else []


def balance(finished: Finished) -> Markup:
    """Report acceleration and rotation at lift-off, the unstable equilibrium and the devices of each case."""
    varied_pier = [key for key in finished.info["varied"] if key in PIER_KEYS]
    heads = [
        Head("case"),
        *(Head(symbol(key)) for key in varied_pier),
        Head("lift-off [g]", ".3f", "steady horizontal ground acceleration"),
        Head("lift-off, θ/α", THETA_FORMAT),
        Head(
            "balance, θ/α", ".3g", "unstable equilibrium of a pier on rigid ground, beyond which it does not come back"
        ),
        Head("e", ".4f", "factor on the angular velocity at an impact on rigid ground"),
        Head("dampers and tendons"),
    ]
    rows = []
    for case in finished.info["cases"]:
        pier = pier_of(case)
        if pier is None:
            continue
        devices, rigid, given = restraints_of(case), case["base"] == "rigid", case["parameters"]
        deflection = 0.0 if rigid else float(given.get("delta_s_m") or 0.0)
        edge = unstable_equilibrium(pier, devices)
        given_e = given.get("restitution")
        own = [quantity(key, value) for key, value in case["columns"].items() if key not in PIER_KEYS]
        rows.append([
            " ".join([str(case["case"]), *own]),
            *(case["columns"].get(key) for key in varied_pier),
            lift_off_acceleration(pier, devices, deflection),
            lift_off_rotation(pier, devices, deflection) / pier.alpha,
            "never: the tendons hold it" if edge is None else edge / pier.alpha,
            (pier.restitution if given_e is None else float(given_e)) if rigid else None,
            "; ".join(in_words(pier, device) for device in devices) or "none",
        ])  # fmt: skip
    return join(
        table(heads, rows, prose=True, name="Lift-off, balance and devices"), tag("p", BALANCE, class_="legend")
    )


def _vertical(finished: Finished) -> str:
    records, runs = finished.info["records"], finished.runs
    if runs["with_vertical"].nunique() > 1:
        return "with and without the vertical component"
    vertical = sum(record["pga_v_g"] is not None for record in records)
    if vertical in (0, len(records)):
        return "with the vertical component" if vertical else "horizontal component only"
    return f"{vertical} with the vertical component"


def _pier(pier: dict[str, float]) -> str:
    weighs = f"; mass {plain(pier['mass_t'], 6)} t" if pier.get("mass_t") else ""
    return (
        f"Pier of slenderness α = {number(pier['alpha'])} rad ({math.degrees(pier['alpha']):.1f}°), "
        f"frequency parameter p = {number(pier['p'])} rad/s, shape factor μ = {number(pier['mu'])}; "
        f"size R0 = {number(pier['size_m'], '.3g')} m, half-width {number(pier['half_width_m'], '.3g')} m, "
        f"centre of mass {number(pier['height_m'], '.3g')} m above the base{weighs}; "
        f"g = {number(pier['gravity'])} m/s²."
    )


def _motions(finished: Finished) -> str:
    records = finished.info["records"]
    if not records:
        return ""

    def span(key: str, form: str, unit: str) -> str:
        values = [record[key] for record in records if record[key] is not None]
        if not values:
            return "unknown"
        first, last = format(min(values), form), format(max(values), form)
        return f"{first} {unit}" if first == last else f"{first} to {last} {unit}"

    factors = [float(record.get("factor", 1.0)) for record in records]
    scaled = "as recorded"
    if any(factor != 1.0 for factor in factors):
        ends = f"{min(factors):.4g}", f"{max(factors):.4g}"
        scaled = f"scaled to the target by {ends[0] if ends[0] == ends[1] else ' to '.join(ends)}"
    return (
        f"Peak ground acceleration {span('pga_g', '.3f', 'g')}, velocity {span('pgv_m_s', '.2f', 'm/s')}, displacement "
        f"{span('pgd_m', '.2f', 'm')}, {scaled}; length {span('duration_s', '.3g', 's')}."
    )


def foundations(finished: Finished) -> Markup:
    """Describe the bases of the piers: parameters, and the deflections that follow from them."""
    varied_pier = [key for key in finished.info["varied"] if key in PIER_KEYS]
    heads = [Head("case"), *(Head(symbol(key)) for key in varied_pier), Head("base")]
    weighed = {
        "stiffness_kN_m": "stiffness of a support",
        "yield_kN": "force at which a support yields",
    }
    in_kilonewtons = {
        key: note for key, note in weighed.items() if any(key in case["parameters"] for case in finished.info["cases"])
    }
    heads += [
        Head("β", ".5g", note="vertical over rocking frequency parameter"),
        Head("η", ".5g", note="yield over static deflection: capacity of a support over its static load"),
        *(Head(symbol(key), ",.0f", note) for key, note in in_kilonewtons.items()),
        Head("ε", note="restitution of the landing pivot's velocity"),
        Head("ζ", note="damping of the supports, as a share of critical damping of the vertical vibration"),
        Head("spring"),
        Head("n", note="Bouc–Wen exponent"),
        Head("kinematics"),
        Head("in flight"),
        Head("e", note="factor on the angular velocity at impact; empty: Housner's"),
        Head(join(sub("ω", "v"), " [rad/s]"), ".2f", "vertical frequency"),
        Head(join(sub("δ", "s"), " [mm]"), ".2f", "static deflection"),
        Head(join(sub("δ", "y"), " [mm]"), ".2f", "yield deflection"),
    ]
    given = ("epsilon", "zeta", "spring", "n", "kinematics", "flight", "restitution", "omega_v")
    names = ("beta", "eta", *in_kilonewtons, *given)
    rows = []
    for case in finished.info["cases"]:
        values = case["parameters"]
        deflections = [values.get(key) for key in ("delta_s_m", "delta_y_m")]
        millimetres = [None if metres is None else 1000 * metres for metres in deflections]
        pier = [case["columns"].get(key) for key in varied_pier]
        rows.append([case["case"], *pier, case["base"], *(values.get(key) for key in names), *millimetres])
    legend = (
        "β: vertical over rocking frequency parameter. η: yield over static deflection, the capacity of a support over its "
        "static load. ε: restitution of the pivot that lands. ζ: damping of the supports, as a share of critical. δ: deflections "
        "of a support, static and at yield."
    )
    springs = any(case["base"] != "rigid" for case in finished.info["cases"])
    return join(table(heads, rows, name="Foundations"), tag("p", legend, class_="legend") if springs else "")
