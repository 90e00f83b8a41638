"""What was studied: the pier, its foundations and the ground motions, in words and units."""

import math

from rockbatch.report.contents import Contents
from rockbatch.report.document import Section
from rockbatch.report.drawing import pier as drawing
from rockbatch.report.finished import Finished
from rockbatch.report.labels import counted, symbol
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.table import Head, sub, table
from rockbatch.study import PIER_KEYS


def section(contents: Contents) -> Section | None:
    """What was studied."""
    if contents.finished is None:
        return None
    return Section("What was studied", "studied", studied(contents.finished))


def studied(finished: Finished, level: str = "h3") -> Markup:
    """The pier, the foundations and the records, in words and units; ``level`` is that of the heading within."""
    info, runs = finished.info, finished.runs
    piers: dict[tuple[float, ...], dict[str, float]] = {}
    for case in info["cases"]:
        pier = case["pier"]
        piers.setdefault(tuple(pier[key] for key in ("alpha", "p", "mu", "gravity")), pier)
    scales = sorted(runs["scale"].unique()) if len(runs) else []
    extent = (
        f"{counted(len(piers), 'pier')} on {counted(len(finished.series), 'foundation')} under "
        f"{counted(len(info['records']), 'ground motion')} ({_vertical(finished)})"
        + (", as recorded and reversed" if finished.both_directions else "")
        + (f", scaled by {', '.join(number(float(scale)) for scale in scales)}" if scales not in ([], [1.0]) else "")
        + f": {counted(len(runs), 'run')}."
        + (" Polarity: mirror images, counted once." if finished.mirrored else "")
    )
    described = tag("ul", *(tag("li", _pier(pier)) for pier in piers.values()))
    bases = {case["base"] for case in info["cases"]}
    drawn = tag("div", *drawing.piers(list(piers.values()), bases), class_="piers") if piers else ""
    return join(
        tag("p", extent[0].upper() + extent[1:]), described, drawn, tag("p", _motions(finished)),
        tag(level, "Foundations"), foundations(finished),
    )  # fmt: skip


def _vertical(finished: Finished) -> str:
    records, runs = finished.info["records"], finished.runs
    if runs["with_vertical"].nunique() > 1:
        return "with and without the vertical component"
    vertical = sum(record["pga_v_g"] is not None for record in records)
    if vertical in (0, len(records)):
        return "with the vertical component" if vertical else "horizontal component only"
    return f"{vertical} with the vertical component"


def _pier(pier: dict[str, float]) -> str:
    return (
        f"Pier of slenderness α = {number(pier['alpha'])} rad ({math.degrees(pier['alpha']):.1f}°), "
        f"frequency parameter p = {number(pier['p'])} rad/s, shape factor μ = {number(pier['mu'])}; "
        f"size R0 = {number(pier['size_m'], '.3g')} m, half-width {number(pier['half_width_m'], '.3g')} m, "
        f"centre of mass {number(pier['height_m'], '.3g')} m above the base; "
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

    return (
        f"Peak ground acceleration {span('pga_g', '.3f', 'g')}, velocity {span('pgv_m_s', '.2f', 'm/s')}, displacement "
        f"{span('pgd_m', '.2f', 'm')}, as recorded; length {span('duration_s', '.3g', 's')}."
    )


def foundations(finished: Finished) -> Markup:
    """What the piers stand on: parameters, and the deflections that follow from them."""
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
        Head("spring"),
        Head("n", note="Bouc–Wen exponent"),
        Head("kinematics"),
        Head("in flight"),
        Head("e", note="factor on the angular velocity at impact; empty: Housner's"),
        Head(join(sub("ω", "v"), " [rad/s]"), ".2f", "vertical frequency"),
        Head(join(sub("δ", "s"), " [mm]"), ".2f", "static deflection"),
        Head(join(sub("δ", "y"), " [mm]"), ".2f", "yield deflection"),
    ]
    names = ("beta", "eta", *in_kilonewtons, "epsilon", "spring", "n", "kinematics", "flight", "restitution", "omega_v")
    rows = []
    for case in finished.info["cases"]:
        values = case["parameters"]
        deflections = [values.get(key) for key in ("delta_s_m", "delta_y_m")]
        millimetres = [None if metres is None else 1000 * metres for metres in deflections]
        pier = [case["columns"].get(key) for key in varied_pier]
        rows.append([case["case"], *pier, case["base"], *(values.get(key) for key in names), *millimetres])
    legend = (
        "β: vertical over rocking frequency parameter. η: yield over static deflection, the capacity of a support over its "
        "static load. ε: restitution of the pivot that lands. δ: deflections of a support, static and at yield."
    )
    springs = any(case["base"] != "rigid" for case in finished.info["cases"])
    return join(table(heads, rows, name="Foundations"), tag("p", legend, class_="legend") if springs else "")
