"""Peaks in tables: Fig. 7 in numbers, and every run with the worst first."""

import math
from typing import TYPE_CHECKING, Any

from rockbatch.checks.suite import MIRROR_OF
from rockbatch.report.contents import Contents
from rockbatch.report.document import Section
from rockbatch.report.finished import Finished, as_dicts, worst_first
from rockbatch.report.labels import symbol
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.table import MOST_ROWS, THETA, THETA_FORMAT, Head, alarm, sub, table, told_apart

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

MOST_COLUMNS = 24

_COLUMNS = {
    "status": (1, Head("status")),
    "theta_max_over_alpha": (1, Head(THETA, ".5f", "theta_max_over_alpha: peak rotation over slenderness")),
    "theta_max_error": (1, Head("±", ".0e", "theta_max_error: estimated error of the peak rotation over slenderness")),
    "t_max_s": (1, Head("at t [s]", ".2f", "t_max_s: time of the peak")),
    "theta_res_over_alpha": (1, Head(sub("θ", "res", "/α"), ".5f", "theta_res_over_alpha: residual over slenderness")),
    "theta_res_error": (1, Head("±", ".0e", "theta_res_error: estimated error of the residual over slenderness")),
    "base_tilt_rad": (1000, Head("base tilt [mrad]", ".3f", "base_tilt_rad × 1000: tilt of the base after the record")),
    "settlement_m": (1000, Head("settlement [mm]", ".2f", "settlement_m × 1000")),
    "settlement_other_law_m": (1000, Head("by the other law [mm]", ".2f", "settlement_other_law_m × 1000")),
    "settlement_drift_m_s": (
        1000,
        Head("drift [mm/s]", ".3f", "settlement_drift_m_s × 1000: how fast it went on then"),
    ),
    "theta_res_drift_per_s": (
        1,
        Head("drift [1/s]", ".1e", "theta_res_drift_per_s: how fast the residual went on then"),
    ),
    "residual_s": (1, Head("read at [s]", ".2f", "residual_s: when residual rotation, tilt and settlement were read")),
    "impacts": (1, Head("impacts", ".0f")),
    "separations": (1, Head("separations", ".0f")),
    "flight_s": (1, Head("flight [s]", ".3f", "flight_s: first time with both pivots off the ground")),
    "ductility_left": (1, Head("demand L", ".2f", "ductility_left: largest deflection over yield deflection")),
    "ductility_right": (1, Head("demand R", ".2f", "ductility_right: largest deflection over yield deflection")),
    "dissipated_left_J_kg": (1, Head("dissipated L [J/kg]", ".4f", "dissipated_left_J_kg: plastic work")),
    "dissipated_right_J_kg": (1, Head("dissipated R [J/kg]", ".4f", "dissipated_right_J_kg: plastic work")),
    "t_end_s": (1, Head("end [s]", ".2f", "t_end_s: time at which the analysis ended")),
    "substeps": (1, Head("substeps", ".0f", "integration steps per sampling interval")),
    "reason": (1, Head("reason")),
    "note": (1, Head("note")),
}
"""Factor and head of each column of peaks.csv after the names of the run, in the order of the page."""


def section(contents: Contents) -> Section | None:
    """Every run."""
    finished = contents.finished
    if finished is None or finished.runs.empty:
        return None
    lead = [
        "The worst first: overturned, ended by flight, then by rotation. All of it is in ", tag("code", "peaks.csv"), ". ",
        tag("span", "Click a heading to sort.", class_="scripted"),
    ]  # fmt: skip
    return Section("Every run", "peaks", join(tag("p", *lead), _ratcheting(finished), _every_run(finished)))


def at_a_glance(finished: Finished, runs: "pd.DataFrame", records: "Sequence[str]") -> Markup:
    """The paper's Fig. 7 in numbers: a row per record, a column per foundation (and direction)."""
    series = [(place, finished.series[place]) for place in runs["series"].unique()]
    series.sort(key=lambda pair: (not pair[1].rigid, pair[1].index))
    signs = sorted(runs["polarity"].unique())
    if len(series) * len(signs) > MOST_COLUMNS:
        return Markup("")
    heads = [Head("record"), Head("PGA [g]", ".3f")]
    heads += [
        Head(one.label + (f" ({sign})" if len(signs) > 1 else ""), THETA_FORMAT) for _, one in series for sign in signs
    ]
    stood = runs[runs["status"] == "ok"]["theta_max_over_alpha"]
    shown = runs[runs["record"].isin(records)]
    found = {(run["record"], run["series"], run["polarity"]): run for run in as_dicts(shown)}
    rows: list[list[object]] = []
    for name in records:
        values = [found.get((name, place, sign)) for place, _ in series for sign in signs]
        pga = next((run["pga_g"] for run in values if run), math.nan)
        rows.append([name, pga, *(outcome(run, stood.max()) for run in values)])
    return table(heads, rows, name="Peak rotations in numbers")


def outcome(run: "dict[str, Any] | None", worst: float = math.nan) -> object:
    """θ_max/α of a run, or what happened instead."""
    if run is None:
        return ""
    status, theta, flight = run["status"], float(run["theta_max_over_alpha"]), run["flight_s"]
    if status == "flight" and flight == flight:
        return alarm(f"flight at {number(flight)} s")
    if status != "ok" or math.isnan(theta):
        return alarm(status)
    value = number(theta, THETA_FORMAT)
    shown = tag("strong", value) if theta == worst else value
    if flight == flight:
        return join(shown, tag("sup", "f", title=f"both pivots in the air first at {number(flight)} s"))
    return shown if isinstance(shown, Markup) else theta


def _every_run(finished: Finished) -> Markup:
    """The rows of ``peaks.csv``, the worst first."""
    runs, varied = finished.runs, finished.info["varied"]
    names = {"record": Head("record"), "case": Head("case"), **{key: Head(symbol(key), note=key) for key in varied}}
    # These say something only where they change
    if finished.both_directions:
        names["polarity"] = Head("polarity", note="+ as recorded, - horizontal component reversed")
    if runs["scale"].nunique() > 1:
        names["scale"] = Head("scale", note="factor on all components")
    if runs["with_vertical"].nunique() > 1:
        names["with_vertical"] = Head("vertical component")
    known = {"record", "case", "polarity", "scale", "vertical", MIRROR_OF, *varied, *_COLUMNS}
    columns = {name: column for name, column in _COLUMNS.items() if name in runs}
    columns |= {name: (1, _energy(name)) for name in finished.saved.peaks.columns if name not in known}
    shown = worst_first(runs, MOST_ROWS)
    rows = [
        [*(run[name] for name in names), *(_cell(name, factor, run[name]) for name, (factor, _) in columns.items())]
        for run in as_dicts(shown)
    ]
    heads = [*names.values(), *(head for _, head in columns.values())]
    return join(told_apart(len(shown), len(runs), "worst"), table(heads, rows, sortable=True, name="Every run"))


def _cell(name: str, factor: int, value: Any) -> object:
    if name == "status":
        return alarm(value) if value != "ok" else value
    if isinstance(value, str):
        return value
    return None if value is None or value != value else factor * float(value)


def _energy(name: str) -> Head:
    """Head of a term of the energy ledger, or of a column that is not known here."""
    if not name.startswith("energy_"):
        return Head(name)
    term = name.removeprefix("energy_").removesuffix("_J_kg").replace("_", "-")
    return Head(f"{term} [J/kg]", ".0e" if term == "remainder" else ".4f", name)


def _ratcheting(finished: Finished) -> Markup:
    """That settlement hangs on the spring law, and by how much where both were run."""
    if not any(case["parameters"].get("spring") for case in finished.info["cases"]):
        return Markup("")
    told = "Bouc–Wen springs ratchet: they settle a little with every cycle, elastic–perfectly plastic ones do not. "
    name, runs = "settlement_other_law_m", finished.runs
    if name not in runs:
        told += (
            "Settlement and residual rotation depend on that; [output] both_laws = true in the study shows how much."
        )
        return tag("p", told)
    gap = (runs["settlement_m"] - runs[name]).abs()
    if gap.notna().any():
        run = runs.iloc[int(gap.argmax())]
        told += (
            f"The settlement differs most in {finished.where(run)}: {1000 * run['settlement_m']:z.1f} mm by the study's "
            f"law, {1000 * run[name]:z.1f} mm by the other one."
        )
    return tag("p", told)
