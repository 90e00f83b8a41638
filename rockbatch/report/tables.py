"""The report's tables."""

import math
from collections.abc import Iterable, Sequence
from fnmatch import fnmatchcase
from typing import Any, NamedTuple

from rockbatch.report.finished import ASKED_FOR, NUMBERS, SYMBOLS, TEXTS, Finished, Run
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.study import PIER_KEYS

THETA = join("θ", tag("sub", "max"), "/α")
THETA_FORMAT = ".4f"
WHOLE = ".10g"  # as it was given


class Head(NamedTuple):
    """Head of a column: what it says, how its numbers are written, and a word of explanation."""

    says: str
    form: str = WHOLE
    note: str | None = None


def table(heads: Sequence[Head], rows: Iterable[Sequence[object]], *, sortable: bool = False) -> Markup:
    """A table in a container of its own that scrolls when it is too wide. Columns without a value are left out."""
    rows = list(rows)
    used = [i for i in range(len(heads)) if i == 0 or any(row[i] not in (None, "") for row in rows)]
    numeric = {i for i in used if heads[i].form != WHOLE or any(isinstance(row[i], float | int) for row in rows)}

    def cell(name: str, i: int, content: object, **more: object) -> Markup:
        return tag(name, content, class_="n" if i in numeric else None, **more)

    top = tag("tr", *(cell("th", i, heads[i].says, scope="col", title=heads[i].note) for i in used))
    body = []
    for row in rows:
        texts = {i: row[i] if isinstance(row[i], Markup) else number(row[i], heads[i].form) for i in used}
        first = {"scope": "row"}
        body.append(tag("tr", *(cell("th", i, texts[i], **first) if i == 0 else cell("td", i, texts[i]) for i in used)))
    whole = tag("table", tag("thead", top), tag("tbody", *body), class_="sortable" if sortable else None)
    return tag("div", whole, class_="wide", tabindex="0")


def at_a_glance(finished: Finished, runs: Sequence[Run]) -> Markup:
    """The paper's Fig. 7 in numbers: a row per record, a column per foundation (and direction)."""
    both = len({run.polarity for run in runs}) > 1
    columns = sorted({(not run.series.rigid, run.series.index, run.polarity) for run in runs})
    label = {(not run.series.rigid, run.series.index): run.series.label for run in runs}
    found = {(run.record, not run.series.rigid, run.series.index, run.polarity): run for run in runs}
    heads = [Head("record"), Head("PGA [g]", ".3f")]
    heads += [Head(label[kind, index] + (f" ({sign})" if both else ""), THETA_FORMAT) for kind, index, sign in columns]
    worst = max((run.theta for run in runs if run.status == "ok" and run.theta is not None), default=math.nan)
    rows = []
    for name in finished.by_pga(runs):
        pga = finished.record(name).get("pga_g")
        values = [found.get((name, *column)) for column in columns]
        rows.append([name, pga and pga * runs[0].scale, *(outcome(run, worst) for run in values)])
    return table(heads, rows)


def outcome(run: Run | None, worst: float = math.nan) -> object:
    """θ_max/α of a run, or what happened instead."""
    if run is None:
        return ""
    if run.status == "flight" and run.row["flight_s"] is not None:
        return alarm(f"flight at {number(run.row['flight_s'])} s")
    if run.status != "ok" or run.theta is None:
        return alarm(run.status)
    value = number(run.theta, THETA_FORMAT)
    shown = tag("strong", value) if run.theta == worst else value
    if run.row["flight_s"] is not None:
        return join(shown, tag("sup", "f", title=f"both pivots in the air first at {number(run.row['flight_s'])} s"))
    return shown if isinstance(shown, Markup) else run.theta


def alarm(words: str) -> Markup:
    return tag("span", words, class_="alarm")


def peaks(finished: Finished) -> Markup:
    """Everything in ``peaks.csv``."""
    heads = [
        ("record", Head("record")),
        ("case", Head("case")),
        *((key, Head(_symbol(key), note=key)) for key in finished.info["varied"]),
        ("polarity", Head("polarity", note="+ as recorded, - horizontal component reversed")),
        ("scale", Head("scale", note="factor on all components")),
        ("status", Head("status")),
        ("theta_max_over_alpha", Head(THETA, ".5f", "theta_max_over_alpha: peak rotation over slenderness")),
        ("theta_max_error", Head("±", ".0e", "theta_max_error: estimated error of the peak rotation over slenderness")),
        ("t_max_s", Head("at t [s]", ".2f", "t_max_s: time of the peak")),
        (
            "theta_res_over_alpha",
            Head(_sub("θ", "res", "/α"), ".5f", "theta_res_over_alpha: residual over slenderness"),
        ),
        ("theta_res_error", Head("±", ".0e", "theta_res_error: estimated error of the residual over slenderness")),
        ("settlement_mm", Head("settlement [mm]", ".2f", "settlement_m × 1000")),
        ("other_law_mm", Head("by the other law [mm]", ".2f", "settlement_other_law_m × 1000: Bouc–Wen or EPP")),
        ("base_tilt_mrad", Head("base tilt [mrad]", ".3f", "base_tilt_rad × 1000")),
        ("ductility_left", Head("demand L", ".2f", "ductility_left: largest deflection over yield deflection")),
        ("ductility_right", Head("demand R", ".2f", "ductility_right: largest deflection over yield deflection")),
        ("dissipated_left_J_kg", Head("dissipated L [J/kg]", ".4f", "dissipated_left_J_kg")),
        ("dissipated_right_J_kg", Head("dissipated R [J/kg]", ".4f", "dissipated_right_J_kg")),
        ("impacts", Head("impacts")),
        ("separations", Head("separations")),
        ("flight_s", Head("flight [s]", ".3f", "flight_s: first time with both pivots off the ground")),
        ("t_end_s", Head("end [s]", ".2f", "t_end_s: time at which the analysis ended")),
        ("substeps", Head("substeps", note="integration steps per sampling interval")),
        ("reason", Head("reason")),
    ]
    thousandths = {
        "settlement_mm": "settlement_m",
        "other_law_mm": "settlement_other_law_m",
        "base_tilt_mrad": "base_tilt_rad",
    }
    columns = finished.rows[0] if finished.rows else {}
    known = {key for key, _ in heads} | {*TEXTS, *NUMBERS, *ASKED_FOR}
    heads = [(key, head) for key, head in heads if thousandths.get(key, key) in columns]
    heads += [(key, _energy(key)) for key in columns if key not in known]

    def cell(row: dict[str, Any], key: str) -> object:
        if key in thousandths:
            value = row[thousandths[key]]
            return None if value is None else 1000 * value
        if key == "status" and row["status"] != "ok":
            return alarm(row["status"])
        return row[key]

    # "polarity" and "scale" say something only where they change
    simulated = [run.row for run in finished.runs]
    same = {key for key in ("polarity", "scale") if len({row[key] for row in simulated}) == 1}
    shown = [(key, head) for key, head in heads if key not in same]
    rows = [[cell(row, key) for key, _ in shown] for row in finished.rows]
    return table([head for _, head in shown], rows, sortable=True)


def _energy(key: str) -> Head:
    """Head of a term of the energy ledger, or of a column that is not known here."""
    if not key.startswith("energy_"):
        return Head(key)
    term = key.removeprefix("energy_").removesuffix("_J_kg").replace("_", "-")
    return Head(f"{term} [J/kg]", ".0e" if term == "remainder" else ".4f", key)


def _symbol(key: str) -> str:
    """Head of a column that holds values of a study key."""
    symbol, unit = SYMBOLS.get(key, ("", ""))
    return (symbol or key) + (f" [{unit}]" if unit else "")


def _sub(base: str, index: str, rest: str = "") -> Markup:
    return join(base, tag("sub", index), rest)


def comparison(finished: Finished) -> Markup:
    """Published values beside ours: every run that a reference's record pattern, case and columns fit."""
    varied = finished.info["varied"]
    # "dir." and "scale" say something only where they change
    more = [key for key in ("polarity", "scale") if len({run.row[key] for run in finished.runs}) > 1]
    heads = [Head("record"), Head("case"), *(Head(_symbol(key)) for key in (*varied, *more))]
    heads += [Head(join(THETA, ", ours"), THETA_FORMAT), Head(join(THETA, ", published"))]
    heads += [Head("difference [%]", "+.1f"), Head("source")]
    rows: list[Sequence[object]] = []
    for reference in finished.info["references"]:
        name, case, published = reference["record"], reference["case"], reference["theta_max_over_alpha"]
        fits = [run for run in finished.runs if _fits(run, reference)]
        for run in fits:
            ours = run.theta if run.status == "ok" else None
            difference = 100 * (ours / published - 1) if ours is not None and published else None
            values = [run.row[key] for key in (*varied, *more)]
            rows.append([run.record, case, *values, outcome(run), published, difference, reference["source"]])
        if not fits:
            values = [reference["columns"].get(key, "") for key in (*varied, *more)]
            nothing = tag("span", "no such run", class_="muted")
            rows.append([name, case, *values, nothing, published, None, reference["source"]])
    return table(heads, rows)


def _fits(run: Run, reference: dict[str, Any]) -> bool:
    def equal(ours: object, theirs: object) -> bool:
        if isinstance(ours, float) and isinstance(theirs, float | int):
            return math.isclose(ours, theirs, rel_tol=1e-9)
        return ours == theirs

    return (
        fnmatchcase(run.record, reference["record"])
        and run.row["case"] == reference["case"]
        and all(equal(run.row.get(key), value) for key, value in reference["columns"].items())
    )


def foundations(finished: Finished) -> Markup:
    """What the piers stand on: parameters, and the deflections that follow from them."""
    varied_pier = [key for key in finished.info["varied"] if key in PIER_KEYS]
    heads = [Head("case"), *(Head(_symbol(key)) for key in varied_pier), Head("base")]
    heads += [
        Head("β", note="vertical over rocking frequency parameter"),
        Head("η", note="yield over static deflection"),
        Head("ε", note="restitution of the landing pivot's velocity"),
        Head("spring"),
        Head("n", note="Bouc–Wen exponent"),
        Head("kinematics"),
        Head("in flight"),
        Head("e", note="factor on the angular velocity at impact; empty: Housner's"),
        Head(join(_sub("ω", "v"), " [rad/s]"), ".2f", "vertical frequency"),
        Head(join(_sub("δ", "s"), " [mm]"), ".2f", "static deflection"),
        Head(join(_sub("δ", "y"), " [mm]"), ".2f", "yield deflection"),
    ]
    names = ("beta", "eta", "epsilon", "spring", "n", "kinematics", "flight", "restitution", "omega_v")
    rows = []
    for case in finished.info["cases"]:
        values = case["parameters"]
        deflections = [values.get(key) for key in ("delta_s_m", "delta_y_m")]
        millimetres = [None if metres is None else 1000 * metres for metres in deflections]
        pier = [case["columns"].get(key) for key in varied_pier]
        rows.append([case["case"], *pier, case["base"], *(values.get(key) for key in names), *millimetres])
    return table(heads, rows)


def records(finished: Finished) -> Markup:
    """The ground motions, as they were used."""
    heads = [
        Head("record"),
        Head("PGA [g]", ".3f"),
        Head("PGV [m/s]", ".3f"),
        Head("PGD [m]", ".3f"),
        Head("dt [s]"),
        Head("points"),
        Head("duration [s]", ".2f"),
        Head("vertical PGA [g]", ".3f"),
        Head("horizontal from"),
        Head("vertical from"),
        Head("what was done"),
    ]
    names = (
        "record", "pga_g", "pgv_m_s", "pgd_m", "dt_s", "npts", "duration_s", "pga_v_g", "source", "vertical_source",
    )  # fmt: skip
    rows: list[list[object]] = []
    for record in finished.info["records"]:
        notes = tag("ul", *(tag("li", note) for note in record["notes"])) if record["notes"] else ""
        rows.append([*(record[name] for name in names), notes])
    return table(heads, rows)


def unusable(finished: Finished) -> Markup:
    """Files and runs that gave no result, and why."""
    rows = [[entry["name"], "", entry["source"], entry["reason"]] for entry in finished.info["unusable"]]
    failed = [run for run in finished.runs if run.status == "failed"]
    rows += [[run.record, run.series.label, "", run.row["reason"]] for run in failed]
    return table([Head("record"), Head("case"), Head("file"), Head("why")], rows)
