"""What went in: foundations, ground motions, and what could not be used."""

from collections.abc import Sequence
from typing import Any

from rockbatch.report.finished import Finished
from rockbatch.report.labels import symbol
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.table import Head, sub, table
from rockbatch.study import PIER_KEYS


def foundations(finished: Finished) -> Markup:
    """What the piers stand on: parameters, and the deflections that follow from them."""
    varied_pier = [key for key in finished.info["varied"] if key in PIER_KEYS]
    heads = [Head("case"), *(Head(symbol(key)) for key in varied_pier), Head("base")]
    heads += [
        Head("β", note="vertical over rocking frequency parameter"),
        Head("η", note="yield over static deflection: capacity of a support over its static load"),
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
    names = ("beta", "eta", "epsilon", "spring", "n", "kinematics", "flight", "restitution", "omega_v")
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


def records(finished: Finished) -> Markup:
    """The ground motions as they were used, like the paper's Table 1, the weakest first."""
    heads = [
        Head("record"),
        Head("PGA [g]", ".3f"),
        Head("PGV [m/s]", ".3f"),
        Head("PGD [m]", ".3f"),
        Head("vertical PGA [g]", ".3f"),
        Head("Arias [m/s]", ".3f", "arias_m_s: Arias intensity"),
        Head("D5–95 [s]", ".1f", "d5_95_s: significant duration, from 5 to 95 % of the Arias intensity"),
        Head("dt [s]"),
        Head("points"),
        Head("length [s]", ".2f", "duration_s: from the first to the last sample"),
        Head("processed", note="whether its agency has corrected it; empty: the file does not say"),
        Head("to check", note="what is odd about it; the notes below say more"),
        Head("azimuth [°]", note="degrees clockwise from north"),
        Head("M", note="magnitude"),
        Head("distance [km]"),
        Head("factor", ".4g", "what brought the record to the study's target"),
    ]
    names = (
        "record", "pga_g", "pgv_m_s", "pgd_m", "pga_v_g", "arias_m_s", "d5_95_s", "dt_s", "npts", "duration_s",
        "processed", "check", "azimuth_deg", "magnitude", "distance_km", "factor",
    )  # fmt: skip
    scaled = any(record.get("factor", 1.0) != 1.0 for record in finished.info["records"])
    ordered = sorted(finished.info["records"], key=lambda record: (record["pga_g"], record["record"]))
    rows = [[_told(record, name) if name != "factor" or scaled else None for name in names] for record in ordered]
    measured = table(heads, rows, sortable=True, name="Ground motions")
    lacking = finished.info.get("without_vertical")
    without = tag("p", f"no vertical: {', '.join(lacking)}") if lacking else ""
    return join(measured, without, tag("h3", "Where they come from, and what was done to them"), _sources(ordered))


def _told(record: dict[str, Any], name: str) -> Any:
    """A value of run.json, as the table of ground motions has it."""
    if name == "processed":
        return {True: "yes", False: "no"}.get(record.get(name, ""))
    if name == "check":
        return ", ".join(finding["what"] for finding in record.get("findings", [])) or None
    return record.get(name)


def _sources(records: Sequence[dict[str, Any]]) -> Markup:
    heads = [Head("record"), Head("horizontal from"), Head("vertical from"), Head("what was done")]
    rows: list[list[object]] = []
    for record in records:
        notes = tag("ul", *(tag("li", note) for note in record["notes"])) if record["notes"] else ""
        sources = (record[name] and tag("span", record[name], class_="path") for name in ("source", "vertical_source"))
        rows.append([record["record"], *sources, notes])
    return table(heads, rows, prose=True, name="Sources")


def unusable(finished: Finished) -> Markup:
    """Files and runs that gave no result, and why."""
    rows = [[entry["name"], "", entry["source"], entry["reason"]] for entry in finished.info["unusable"]]
    failed = finished.runs[finished.runs["status"] == "failed"]
    rows += [[run["record"], finished.which(run), "", run["reason"]] for _, run in failed.iterrows()]
    return table([Head("record"), Head("case"), Head("file"), Head("why")], rows, prose=True, name="Not used")


def left_out(finished: Finished) -> Markup:
    """Files and records that were left out on purpose, or are no records, and why."""
    rows = [[entry["name"], entry["source"], entry["reason"]] for entry in finished.info["left_out"]]
    return table([Head("record"), Head("file"), Head("why")], rows, prose=True, name="Left out")
