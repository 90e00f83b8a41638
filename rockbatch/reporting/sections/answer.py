"""The first screen: which cases pass, every check in every case, runs without a result, and every peak in one picture."""

from collections import Counter
from collections.abc import Collection, Iterator
from decimal import ROUND_UP, Decimal
from itertools import compress
from typing import Any

import numpy as np

from rockbatch.checks import wording
from rockbatch.checks.remarks import pulled_supports, undamped_settlement, weak_supports
from rockbatch.checks.responses import LOST, RESPONSES, Worst, heights_of, in_words, standing
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.quantity import SETTLING
from rockbatch.quantities.rows import NOT_RUN
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import counted
from rockbatch.reporting.markup import Markup, join, number, paragraphs, tag
from rockbatch.reporting.overview import by_record
from rockbatch.reporting.sections import verdicts
from rockbatch.reporting.table import Head, alarm, table
from rockbatch.results.labelled import as_dicts
from rockbatch.results.suite_statistics import reasons_of_failure

LEAST_ERROR = 1e-6
"""Of α: smaller errors are given as this."""
DEVICES = {
    "damper": ("stroke_m", "stroke"), "tendon": ("yield_m", "plastic elongation"), "stop": ("deflection_m", "deflection"),
    "deck_spring": ("deflection_m", "deflection"),
}  # fmt: skip
"""Column of each kind of device of which the table has the greatest value beside the force, and its words."""


def section(finished: Finished) -> Markup:
    """Return the first screen; every check and every run follow further down."""
    weak = weak_supports(finished.info["cases"])
    checked = any(verdict.case for verdict in finished.verdicts)
    card = verdicts.scorecard(finished) if checked else responses(finished)
    return join(
        tag("div", alarm(weak)) if weak else "", tag("div", verdicts.answer(finished), class_="lead"),
        paragraphs(*_without_a_result(finished)), card, tag("p", *_notes(finished, checked), class_="legend"),
        by_record(finished),
    )  # fmt: skip


def responses_beside_checks(finished: Finished) -> Markup:
    """Return the greatest responses of each case, whatever is checked; empty without checks, since they are the answer then."""
    if not any(verdict.case for verdict in finished.verdicts):
        return Markup("")
    return join(responses(finished), tag("p", _standing(finished), class_="legend"))


def responses(finished: Finished) -> Markup:
    """Return a row for each case with its greatest responses among the runs that end standing, each with its record.

    The best first: those with the fewest runs that do not, then by their rotation.
    """
    if finished.runs.empty:
        return Markup("")
    by_case = grouped(finished.worst, lambda worst: _place(finished, worst))
    heights = heights_of(finished.worst)
    present = [name for name in RESPONSES if name in heights]
    devices = [kind for kind, (column, _) in DEVICES.items() if f"{kind}_{column}" in finished.runs]
    places = [worst.place for worst in finished.worst]
    run_at = dict(zip(places, as_dicts(finished.runs.iloc[places]), strict=True))  # one by one takes a millisecond each
    places_of_runs = list(zip(finished.runs["series"].tolist(), finished.runs["pier"].tolist(), strict=True))
    planned = Counter(places_of_runs)
    fallen = Counter(compress(places_of_runs, (~standing(finished.runs)).tolist()))
    rows = []
    for series, pier in sorted(planned, key=lambda place: (fallen[place], _rotation(by_case.get(place, [])))):
        by_demand = {worst.demand: worst for worst in by_case.get((series, pier), [])}
        name = finished.series[series].label + (f", {finished.piers[pier]}" if finished.piers[pier] else "")
        cells: list[object] = [
            _response(finished, by_demand[demand], run_at[by_demand[demand].place], heights[demand])
            if demand in by_demand
            else "–"
            for demand in present
        ]
        if devices:
            runs = finished.runs[(finished.runs["series"] == series) & (finished.runs["pier"] == pier)]
            cells += [cell for kind in devices for cell in _of_devices(finished, runs, kind)]
        place = series, pier
        rows.append([name, *cells, f"{fallen[place]:,} of {planned[place]:,}" if fallen[place] else "none"])
    heads = [Head("case"), *(_head(name, heights[name]) for name in present)]
    heads += [head for kind in devices for head in _heads_of(finished, kind)]
    if fallen:
        return table([*heads, Head(LOST)], rows, name="Greatest responses")
    return table(heads, [row[:-1] for row in rows], name="Greatest responses")


def _place(finished: Finished, worst: Worst) -> tuple[int, int]:
    return finished.place(str(worst.case["case"]), worst.case["columns"])


def _rotation(of_case: "list[Worst]") -> float:
    return next((worst.value for worst in of_case if worst.demand == "theta_max_over_alpha"), 0.0)


def _head(name: str, heights: Collection[float]) -> Head:
    return Head(RESPONSES[name].head(heights), ".3g", DEMANDS[name].words)


def _response(finished: Finished, worst: Worst, run: dict[str, Any], heights: Collection[float]) -> Markup:
    """Return a greatest response, with the value in all its units and its record as a note."""
    said = f"{in_words(worst)}: {finished.place_of(run)}, t = {number(float(run['t_max_s']))} s"
    value = number(worst.value * RESPONSES[worst.demand].factor, "#.3g")
    return tag("span", value + worst.place_among(heights), title=said)


def _heads_of(finished: Finished, kind: str) -> list[Head]:
    words = DEVICES[kind][1]
    name = kind.replace("_", " ")
    unit = "kN" if _weighed(finished.runs, kind) else "of the weight"
    return [Head(f"{name} force [{unit}]", ".3g"), Head(f"{words} [mm]", ".3g", f"greatest of a {name}")]


def _weighed(runs: "pd.DataFrame", kind: str) -> bool:
    return f"{kind}_force_kN" in runs and bool(runs[f"{kind}_force_kN"].notna().any())


def _of_devices(finished: Finished, runs: "pd.DataFrame", kind: str) -> list[object]:
    """Return the greatest force, and stroke, yield or deflection [mm], of devices of a kind among runs that end standing."""
    stood = runs[runs["status"] == "ok"]
    force = f"{kind}_force_kN" if _weighed(finished.runs, kind) else f"{kind}_force_over_weight"
    cells: list[object] = []
    for column, factor in ((force, 1.0), (f"{kind}_{DEVICES[kind][0]}", 1000.0)):
        values = stood[column].to_numpy(np.float64) if column in stood else np.empty(0)
        if not np.isfinite(values).any():
            cells.append("–")
            continue
        place = int(np.nanargmax(values))
        cells.append(tag("span", number(factor * values[place], "#.3g"), title=finished.place_of(stood.iloc[place])))
    return cells


def _without_a_result(finished: Finished) -> Iterator[Markup]:
    """Yield sentences on runs that did not end standing, and on files that could not be used."""
    runs = finished.runs
    if runs.empty:
        yield alarm("No ground motion could be used: there are no results.")
    ended = (
        ("overturned", "The pier overturns in {}", "t_end_s"),
        ("flight", "In {} both pivots leave the ground, and the analysis stops there", "flight_s"),
    )
    for status, words, time in ended:
        of_status = runs[runs["status"] == status]
        if len(of_status):
            first = of_status.sort_values(time, kind="stable").iloc[0] if time in of_status else of_status.iloc[0]
            place = finished.place_of(first)
            said = words.format(
                f"{len(of_status):,} of {counted(len(runs), 'run')}"
                if status == "overturned"
                else counted(len(of_status), "run")
            )
            yield join(alarm(said), f"{': ' if len(of_status) == 1 else ', among them '}{place}.")
    failed, unread = int((runs["status"] == "failed").sum()), len(finished.info["unusable"])
    lost = [
        f"{counted(n, noun)} {state}"
        for n, noun, state in (
            (unread, "file", "could not be used"), (failed, "run", "failed"), (finished.not_run, "run", NOT_RUN)
        )
        if n
    ]  # fmt: skip
    if lost:
        reasons = "; ".join(f"{count} ×: {reason}" for reason, count in reasons_of_failure(runs).items())
        words = " and ".join(lost)
        yield join(
            alarm(words[0].upper() + words[1:]), f" ({reasons})" if reasons else "", "; see ",
            tag("a", "Not used", href="#unusable"), ".",
        )  # fmt: skip


def _notes(finished: Finished, checked: bool) -> Iterator[object]:
    """Yield what belongs to the scorecard: what a value is, the error of peaks, and where remarks are."""
    if not checked:
        yield _standing(finished)
        yield "θ/α = 1: the pier alone stands on its edge on rigid ground. "
        bases = {str(case["base"]) for case in finished.info["cases"]}
        if bases == {"rigid"}:
            yield "No settlement: the ground is rigid. "
        elif not bases & set(SETTLING):
            yield "No settlement: the supports are elastic. "
    else:
        yield f"{verdicts.statistics_in_words(finished)} "
        if axes := wording.both_axes(finished.verdicts):
            yield f"{axes} "
    for remark in (undamped_settlement(finished.worst), pulled_supports(finished.info["cases"])):
        if remark:
            yield f"{remark}. "
    yield _error(finished)
    noted = int((finished.runs.loc[finished.runs["status"] == "ok", "note"] != "").sum())
    if noted:
        yield join(
            " ", tag("a", f"{counted(noted, 'run')} {'has' if noted == 1 else 'have'} remarks", href="#peaks"), "."
        )


def _standing(finished: Finished) -> str:
    """Return of which runs the greatest values are."""
    standing = finished.of_all(int((finished.runs["status"] == "ok").sum()), "end standing")
    return f"Greatest values of {standing}; the record of each is its note. "


def _error(finished: Finished) -> str:
    """Report the largest error of the peaks, or that none was estimated; a chaotic peak has none."""
    numerics = finished.info["numerics"]
    errors = finished.runs.loc[finished.runs["status"] == "ok", "theta_max_error"]
    largest, lacking = errors.max(), int(errors.isna().sum())
    if largest == largest and numerics["tolerance"]:
        error = Decimal(repr(max(float(largest), LEAST_ERROR)))
        error = error.quantize(Decimal(1).scaleb(error.adjusted()), ROUND_UP)
        allowed = Decimal(repr(float(numerics["tolerance"])))
        unknown = f"; of {counted(lacking, 'run')} it is not known" if lacking else ""
        return f"Error of rotations: at most {error:f} α ({allowed:f} α allowed){unknown}."
    if numerics.get("substeps"):
        steps = counted(numerics["substeps"], "step")
        return f"Every sampling interval was integrated in {steps}; the error was not estimated."
    return ""
