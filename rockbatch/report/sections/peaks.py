"""Peaks in tables: Fig. 7 in numbers, every run with the worst first, and published values beside ours."""

import math
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

from rockbatch.report.finished import Finished, as_dicts, worst_first
from rockbatch.report.labels import head, symbol
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.table import MOST_ROWS, THETA, THETA_FORMAT, Head, alarm, table, told_apart
from rockbatch.results.columns import COLUMNS, PEAKS, on_page
from rockbatch.results.suite_statistics import NO_PEAK

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

MOST_COLUMNS = 24


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


def every_run(finished: Finished) -> Markup:
    """The rows of ``peaks.csv``, the worst first."""
    runs, varied = finished.runs, finished.info["varied"]
    # These say something only where they change
    also = {"polarity": finished.both_directions, "scale": runs["scale"].nunique() > 1}
    names = {"record": head(COLUMNS["record"]), "case": head(COLUMNS["case"])}
    names |= {key: Head(symbol(key), note=key) for key in varied}
    names |= {name: head(COLUMNS[name]) for name, changes in also.items() if changes}
    if runs["with_vertical"].nunique() > 1:
        names["with_vertical"] = Head("vertical component")
    columns = {column.name: head(column) for column in on_page() if column.of and column.name in runs}
    columns |= {
        name: Head(name)
        for name in map(str, finished.saved.peaks)
        if name not in COLUMNS and name not in ("vertical", *varied)
    }
    shown = worst_first(runs, MOST_ROWS)
    rows = [[*(run[name] for name in names), *(_cell(name, run[name]) for name in columns)] for run in as_dicts(shown)]
    told = tag("p", alarm(f"{PEAKS} {finished.saved.told_missing}"), ".") if finished.saved.missing else ""
    heads = [*names.values(), *columns.values()]
    drawn = table(heads, rows, sortable=True, name="Every run")
    return join(told, told_apart(len(shown), len(runs), "worst"), drawn)


def _cell(name: str, value: Any) -> object:
    if name == "status":
        return alarm(value) if value != "ok" else value
    return value if isinstance(value, str) else on_scale(name, value)


def on_scale(name: str, value: float | None) -> float | None:
    """A number of column ``name`` in the unit in which the page has it; None where there is none."""
    column = COLUMNS.get(name)
    factor = column.page.factor if column and column.page else 1
    return None if value is None or value != value else factor * float(value)


def published(finished: Finished) -> Markup:
    """Published values beside ours: every run that a reference's record pattern, case and columns fit."""
    runs = finished.runs
    more = [key for key in ("polarity", "scale") if runs[key].nunique() > 1]
    keys = [*finished.info["varied"], *more]
    heads = [Head("record"), Head("case"), *(Head(symbol(key)) for key in keys)]
    heads += [Head(join(THETA, ", ours"), THETA_FORMAT), Head(join(THETA, ", published"))]
    heads += [Head("difference [%]", "+.1f"), Head("source")]
    rows: list[list[object]] = []
    for reference in finished.info["references"]:
        name, case, theirs = reference["record"], reference["case"], reference["theta_max_over_alpha"]
        fits = [run for run in as_dicts(runs[runs["case"] == case]) if _fits(run, reference)]
        for run in fits:
            ours = run["theta_max_over_alpha"] if run["status"] not in (*NO_PEAK, "failed") else None
            difference = 100 * (ours / theirs - 1) if ours is not None and theirs else None
            rows.append(
                [
                    run["record"],
                    case,
                    *(run[key] for key in keys),
                    outcome(run),
                    theirs,
                    difference,
                    reference["source"],
                ]
            )
        if not fits:
            values = [reference["columns"].get(key, "") for key in keys]
            nothing = tag("span", "no such run", class_="muted")
            rows.append([name, case, *values, nothing, theirs, None, reference["source"]])
    return table(heads, rows, name="Compared with published values")


def _fits(run: dict[str, Any], reference: dict[str, Any]) -> bool:
    def equal(ours: object, theirs: object) -> bool:
        if isinstance(ours, float) and isinstance(theirs, float | int):
            return math.isclose(ours, theirs, rel_tol=1e-9)
        return ours == theirs

    return fnmatchcase(run["record"], reference["record"]) and all(
        equal(run.get(key), value) for key, value in reference["columns"].items()
    )
