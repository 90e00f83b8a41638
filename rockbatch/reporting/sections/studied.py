"""The study in words and units: pier, foundations and ground motions."""

import math
from collections.abc import Collection, Sequence

from rockbatch.checks.coverage import stations_of
from rockbatch.pier.restraints import KINDS
from rockbatch.quantities.cases import Case, is_across, names_across, top
from rockbatch.quantities.design import BOUND
from rockbatch.quantities.labels import plain, titled
from rockbatch.quantities.quantity import FOOTING
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import counted, head_of_key
from rockbatch.reporting.markup import Markup, number
from rockbatch.reporting.sections.inputs import symbol_and_unit
from rockbatch.reporting.structure import devices_in_words
from rockbatch.reporting.table import Head, sub, table
from rockbatch.reporting.templates import render
from rockbatch.results.labelled import Row
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
"""Keys of [pier] that the page quotes, with their names and units."""

IN_A_LINE = {"height_m": "m high", "width_m": "m wide", "mass_t": "t", "deck_mass_t": "t of deck"}
"""Keys of [pier] in the line below the title, with their units."""
MOST_VALUES = 3
DEVICES = tuple(f"{kind}_" for kind in KINDS)
"""Beginnings of the keys of devices that are varied."""


def section(finished: Finished, level: str = "h3") -> Markup:
    """Return piers, foundations and records in words; ``level`` is the tag of its subheadings."""
    cases, records = finished.info["cases"], finished.info["records"]
    factors = [float(record.get("factor", 1.0)) for record in records]
    ends = dict.fromkeys(f"{factor:.4g}" for factor in (min(factors, default=1.0), max(factors, default=1.0)))
    as_recorded = all(factor == 1.0 for factor in factors)

    def span(key: str, form: str, unit: str) -> str:
        values = [record[key] for record in records if record[key] is not None]
        written = dict.fromkeys(format(value, form) for value in (min(values), max(values))) if values else ()
        return f"{' to '.join(written)} {unit}" if written else "unknown"

    along: dict[tuple[float, ...], Case] = {}
    across: dict[tuple[float, ...], Case] = {}
    for case in cases:
        piers = across if is_across(case) else along
        drift_at = top(case)
        key = *(case["pier"][key] for key in ("alpha", "p", "mu", "gravity")), drift_at
        piers.setdefault(key, case["pier"] | {"top_m": drift_at})
    are_across = names_across(cases)
    return render(
        "reporting/sections/studied.html",
        finished=finished,
        records=records,
        level=level,
        span=span,
        plain=plain,
        degrees=math.degrees,
        along=list(along.values()),
        across=list(across.values()),
        foundations_along=sum(key[0] not in are_across for key in finished.places),
        given=_numbers_of(finished.pier_as_given),
        vertical=_vertical(finished),
        scales=sorted(finished.runs["scale"].unique().astype(float)) if len(finished.runs) else [],
        scaled="as recorded" if as_recorded else f"scaled to the target by {' to '.join(ends)}",
        foundations=_foundations(finished),
        springs=any(case["base"] != "rigid" for case in cases),
    )


def in_a_line(finished: Finished) -> str:
    """Return the line below the title: "20 m high, 4 m wide · 11 stations, 22 components (…) · 44 runs, all end standing".

    In brackets are the words on vertical components. α and p stand for sizes that are not given; "41 end standing" if not all
    do.
    """
    highest = {case["pier"].get("highest_m") for case in finished.info["cases"]}
    of_parts = {"height_m": highest.pop()} if "part" in finished.pier_as_given and len(highest) == 1 else {}
    given = finished.pier_as_given | of_parts | _foot(finished.info["cases"])
    numbers = {key: given[key] for key in IN_A_LINE if type(given.get(key)) in (int, float)}
    sizes = [f"{plain(float(value), 6)} {IN_A_LINE[key]}" for key, value in numbers.items()]
    for symbol_, key, unit in () if sizes else (("α", "alpha", ""), ("p", "p", " rad/s")):
        values = dict.fromkeys(plain(case["pier"][key], 4) for case in finished.info["cases"])
        if len(values) <= MOST_VALUES:
            sizes.append(f"{symbol_} = {', '.join(values)}{unit}")
    stations, records = stations_of(finished.info), finished.info["records"]
    of_all = "" if len(stations.used) == stations.total or not stations.known else f" of {stations.total}"
    suite = f"{len(stations.used)}{of_all} {'station' if stations.total == 1 else 'stations'}"
    axes = 1 + any(is_across(case) for case in finished.info["cases"])
    motions = f"{counted(axes * len(records), 'component')} ({_vertical(finished)})"
    runs, stood = len(finished.runs), int((finished.runs["status"] == "ok").sum())
    ended = "all end standing" if stood == runs and not finished.not_run else f"{stood:,} end standing"
    parts = (", ".join(sizes), f"{suite}, {motions}", f"{counted(runs + finished.not_run, 'run')}, {ended}")
    return " · ".join(filter(None, parts))


def _foot(cases: Sequence[Case]) -> dict[str, float]:
    """Return the width of the foot as ``width_m`` [m] if all ``cases`` stand on footings of the same width; else {}."""
    widths = {2.0 * case["pier"]["half_width_m"] if case["base"] in FOOTING else None for case in cases}
    (width,) = widths if len(widths) == 1 else (None,)
    return {} if width is None else {"width_m": width}


def _numbers_of(pier: Row) -> list[str]:
    """Return the constants of [pier] as given, "height 20 m", then masses and heights of parts; varied keys are left out."""
    parts = pier.get("part", ())
    words = GIVEN | ({"mass_t": ("shaft", "t")} if "deck_mass_t" in pier else {})
    numbers = []
    for key, value in pier.items():
        if key in words and isinstance(value, int | float):
            numbers.append(f"{words[key][0]} {plain(value, 6)} {words[key][1]}".strip())
    tables = [part for part in parts if isinstance(part, dict)] if isinstance(parts, list) else []
    values = [(part.get("mass_t"), part.get("height_m")) for part in tables]
    known = [pair for pair in values if all(isinstance(value, int | float) for value in pair)]
    return numbers + [f"a part of {mass:g} t at {height:g} m" for mass, height in known]


def _vertical(finished: Finished) -> str:
    """Return which motions have a vertical component: "with the vertical component", "3 with …", "horizontal component only".

    "with and without the vertical component" if runs with both were made.
    """
    records = finished.info["records"]
    if finished.runs["with_vertical"].nunique() > 1:
        return "with and without the vertical component"
    vertical = sum(record["pga_v_g"] is not None for record in records)
    if vertical in (0, len(records)):
        return "with the vertical component" if vertical else "horizontal component only"
    return f"{vertical} with the vertical component"


def _foundations(finished: Finished) -> Markup:
    """Return a table of the bases: parameters, and the deflections [mm] that follow from them."""
    varied = [key for key in finished.info["varied"] if key in PIER_KEYS or key.startswith(DEVICES)]
    heads = [Head("case"), *(head_of_key(key) for key in varied), Head("base")]
    present = {key for case in finished.info["cases"] for key in case["parameters"]}
    at_corner, static = "", ""
    if "backbone" in present:
        at_corner = "; of a backbone at its first corner"
        static = ", also beyond the first corner of a backbone, where the supports settle more"
    weighed = {"stiffness_kN_m": "stiffness of a support", "yield_kN": f"force at which a support yields{at_corner}"}
    in_kilonewtons = {key: note for key, note in weighed.items() if key in present}
    heads += [
        Head("β", ".5g", note="vertical over rocking frequency parameter"),
        Head("η", ".5g", note=f"yield over static deflection: a support's yield force over its static load{at_corner}"),
        *(head_of_key(key, ",.0f", note) for key, note in in_kilonewtons.items()),
        Head("impact", note="landing: impulse at the landing pivot, by ε; housner: factor e on the angular velocity"),
        Head("ε", note="restitution of the landing pivot's velocity"),
        Head("ζ", note="damping of the supports, as a share of critical damping of the vertical vibration"),
        Head("spring"),
        Head("n", note="Bouc–Wen exponent"),
        Head("kinematics"),
        Head("in flight"),
        Head("e", note="factor on the angular velocity at impact; empty: Housner's"),
        Head(sub("ω", "v"), ".2f", "vertical frequency", unit="rad/s"),
        Head(sub("δ", "s"), ".2f", f"static deflection, elastic{static}", unit="mm"),
        Head(sub("δ", "y"), ".2f", f"yield deflection{at_corner}", unit="mm"),
    ]
    keys = ("impact", "epsilon", "zeta", "spring", "n", "kinematics", "flight", "restitution", "omega_v")
    names = ("beta", "eta", *in_kilonewtons, *keys)
    further = _further(finished.info["cases"], {*names, "backbone", "delta_s_m", "delta_y_m"})
    rows = []
    devices = _devices(finished.info["cases"])
    for case, of_case in zip(finished.info["cases"], devices, strict=True):
        values = case["parameters"]
        deflections = [values.get(key) for key in ("delta_s_m", "delta_y_m")]
        millimetres = [None if metres is None else 1000 * metres for metres in deflections]
        own = [case["columns"].get(key) for key in varied]
        name = titled(case["case"], filter(None, [case["columns"].get(BOUND)]))
        if points := values.get("backbone"):
            listed = ", ".join(f"({x:.7g}, {force:.7g})" for x, force in points)
            values = values | {"spring": f"backbone of {len(points)} points (δ/δ_y, F/F_y): {listed}"}
        cells = [name, *own, case["base"], *(values.get(key) for key in names), *millimetres]
        rows.append([*cells, *(values.get(key) for key in further), of_case])
    heads += [*(Head(symbol, ".6g", unit=unit) for symbol, unit in map(symbol_and_unit, further)), Head("devices")]
    heads = [head._replace(form=_telling(head.form, [row[i] for row in rows])) for i, head in enumerate(heads)]
    return table(heads, rows, name="Foundations")


def _telling(form: str, cells: Sequence[object]) -> str:
    """Return the format of a column, or one of ten digits if numbers that differ would read alike in it."""
    numbers = {float(f"{cell:.10g}") for cell in cells if isinstance(cell, float)}
    return form if len({number(value, form) for value in numbers}) == len(numbers) else ".10g"


def _devices(cases: Sequence[Case]) -> list[str]:
    """Return the devices of each case in words, with as many digits as tell them apart, from 4 on; "" without any, or for
    impossible values.
    """

    def in_words(digits: int) -> list[str]:
        return ["; ".join(devices_in_words(case, digits)) for case in cases]

    most = len(set(in_words(10)))
    return next(words for digits in range(4, 11) if len(set(words := in_words(digits))) == most)


def _further(cases: Sequence[Case], shown: Collection[str]) -> list[str]:
    """Return the keys of parameters that are not ``shown`` and differ between cases, so that rows can be told apart.

    Devices, which have a column of their own, are left out.
    """
    parameters = [case["parameters"] for case in cases]
    keys = dict.fromkeys(key for of_case in parameters for key in of_case if key not in shown)
    differing = [key for key in keys if len({str(of_case.get(key)) for of_case in parameters}) > 1]
    return [key for key in differing if key != "restraints"]
