"""The first screen: the verdict of each case, the scorecard, runs without a result, and a picture of all peaks."""

from collections import Counter
from collections.abc import Collection, Iterator
from decimal import ROUND_UP, Decimal
from itertools import compress

import numpy as np

from rockbatch.checks import wording
from rockbatch.checks.remarks import pulled_supports, undamped_settlement, weak_supports
from rockbatch.checks.responses import LOST, RESPONSES, Worst, heights_of, in_words, standing
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.common.showing import capital
from rockbatch.common.statuses import NO_PEAK
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.quantity import FOOTING, SETTLING
from rockbatch.quantities.rows import NOT_RUN
from rockbatch.reporting.drawings import drawings
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import counted
from rockbatch.reporting.markup import Markup, join, number, paragraphs, tag
from rockbatch.reporting.overview import by_record
from rockbatch.reporting.sections import verdicts
from rockbatch.reporting.table import Head, alarm, for_paper, table
from rockbatch.results.labelled import Row, as_dicts
from rockbatch.results.suite_statistics import reasons_of_failure

LEAST_ERROR = 1e-6
"""Smallest error [α] that is stated; smaller ones are rounded up to it."""
DEVICES = {
    "damper": ("stroke_m", "stroke"),
    "tendon": ("yield_m", "plastic elongation"),
    "stop": ("deflection_m", "deflection"),
    "deck_spring": ("deflection_m", "deflection"),
}
"""Deformation shown beside the force of each kind of device: its column and its name."""


def section(finished: Finished) -> Markup:
    """Return the first screen: the answer, runs without a result, scorecard or greatest responses, and the peaks by record.

    Supports that cannot carry the pier alone come before these, notes before the peaks.
    The piers stand beside the scorecard; on paper, with the other inputs.
    """
    weak = weak_supports(finished.info["cases"])
    checked = any(verdict.case for verdict in finished.verdicts)
    card = verdicts.scorecard(finished) if checked else responses(finished)
    notes = tag("p", *_notes(finished, checked), class_="legend")
    return join(
        tag("div", alarm(weak)) if weak else "",
        tag("div", verdicts.answer(finished), class_="lead"),
        paragraphs(*_without_a_result(finished)),
        join(card, notes) if for_paper() else tag("div", tag("div", card), drawings(finished), notes, class_="beside"),
        by_record(finished),
    )


def responses_beside_checks(finished: Finished) -> Markup:
    """Return the greatest responses of each case; empty without checks, since the first screen shows them then."""
    if not any(verdict.case for verdict in finished.verdicts):
        return Markup("")
    return join(responses(finished), tag("p", _standing(finished), class_="legend"))


def responses(finished: Finished) -> Markup:
    """Return a table of each case's greatest responses over the runs that end standing, with their records as tooltips.

    Cases with the fewest other runs come first, then those with the smallest rotation. Empty without runs.
    """
    if finished.runs.empty:
        return Markup("")
    by_case = grouped(finished.worst, lambda worst: _place(finished, worst))
    heights = heights_of(finished.worst)
    present = [name for name in RESPONSES if name in heights]
    devices = [kind for kind, (column, _) in DEVICES.items() if f"{kind}_{column}" in finished.runs]
    places = [worst.place for worst in finished.worst]
    run_at = dict(zip(places, as_dicts(finished.runs.iloc[places]), strict=True))  # row by row takes a millisecond each
    places_of_runs = list(zip(finished.runs["series"].tolist(), finished.runs["pier"].tolist(), strict=True))
    planned = Counter(places_of_runs)
    fallen = Counter(compress(places_of_runs, (~standing(finished.runs)).tolist()))
    rows = []
    for series, pier in sorted(planned, key=lambda place: (fallen[place], _rotation(by_case.get(place, [])))):
        by_demand = {worst.demand: worst for worst in by_case.get((series, pier), [])}
        name = finished.named_place(series, pier)
        cells: list[object] = []
        for demand in present:
            worst = by_demand.get(demand)
            cells.append(_response(finished, worst, run_at[worst.place], heights[demand]) if worst else "–")
        if devices:
            runs = finished.runs[(finished.runs["series"] == series) & (finished.runs["pier"] == pier)]
            cells += [cell for kind in devices for cell in _device_demands(finished, runs, kind)]
        place = series, pier
        rows.append([name, *cells, f"{fallen[place]:,} of {planned[place]:,}" if fallen[place] else "none"])
    heads = [Head("case"), *(_head(name, heights[name]) for name in present)]
    heads += [head for kind in devices for head in _device_heads(finished, kind)]
    if fallen:
        return table([*heads, Head(LOST)], rows, name="Greatest responses")
    return table(heads, [row[:-1] for row in rows], name="Greatest responses")


def _place(finished: Finished, worst: Worst) -> tuple[int, int]:
    return finished.place(str(worst.case["case"]), worst.case["columns"])


def _rotation(of_case: "list[Worst]") -> float:
    return next((worst.value for worst in of_case if worst.demand == "theta_max_over_alpha"), 0.0)


def _head(name: str, heights: Collection[float]) -> Head:
    return Head(RESPONSES[name].named(heights), ".3g", DEMANDS[name].words, unit=RESPONSES[name].unit)


def _response(finished: Finished, worst: Worst, run: Row, heights: Collection[float]) -> Markup:
    """Return a greatest response; its tooltip has the value in all units, its record and its time."""
    title = f"{in_words(worst)}: {finished.place_of(run)}, t = {number(float(run['t_max_s']))} s"
    value = number(worst.value * RESPONSES[worst.demand].factor, "#.3g")
    return tag("span", value + worst.place_among(heights), title=title)


def _device_heads(finished: Finished, kind: str) -> list[Head]:
    words = DEVICES[kind][1]
    name = kind.replace("_", " ")
    unit = "kN" if _weighed(finished.runs, kind) else "of the weight"
    return [Head(f"{name} force", ".3g", unit=unit), Head(words, ".3g", f"greatest of a {name}", unit="mm")]


def _weighed(runs: "pd.DataFrame", kind: str) -> bool:
    """Return whether forces of these devices are known in kN."""
    return f"{kind}_force_kN" in runs and bool(runs[f"{kind}_force_kN"].notna().any())


def _device_demands(finished: Finished, runs: "pd.DataFrame", kind: str) -> list[object]:
    """Return the greatest force and deformation [mm] of a kind of device over the runs that end standing; "–" for none.

    The force is in kN, or over the weight if the mass of a pier is not known.
    """
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
    """Yield sentences on runs that overturned, flew, failed or are missing, and on files that could not be used."""
    runs = finished.runs
    if runs.empty:
        yield alarm("No ground motion could be used: there are no results.")
    overturned, flown = (runs[runs["status"] == status] for status in NO_PEAK)
    share = f"{len(overturned):,} of {counted(len(runs), 'run')}"
    stops = f"In {counted(len(flown), 'run')} both pivots leave the ground, and the analysis stops there"
    for ended, words, time in (
        (overturned, f"The pier overturns in {share}", "t_end_s"),
        (flown, stops, "flight_s"),
    ):
        if len(ended):
            first = (ended.sort_values(time, kind="stable") if time in ended else ended).iloc[0]
            yield join(alarm(words), f"{': ' if len(ended) == 1 else ', among them '}{finished.place_of(first)}.")
    failed, unread = int((runs["status"] == "failed").sum()), len(finished.info["unusable"])
    counts = (unread, "file", "could not be used"), (failed, "run", "failed"), (finished.not_run, "run", NOT_RUN)
    lost = [f"{counted(n, noun)} {state}" for n, noun, state in counts if n]
    if lost:
        reasons = "; ".join(reasons_of_failure(runs))
        words = " and ".join(lost)
        yield join(
            alarm(capital(words)),
            f" ({reasons})" if reasons else "",
            "; see ",
            tag("a", "Not used", href="#unusable"),
            ".",
        )


def _notes(finished: Finished, checked: bool) -> Iterator[object]:
    """Yield the notes below the table: the meaning of its values, the error of peaks, and a link to remarks."""
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
    if doubtful := [record for record in finished.info["records"] if record.get("findings")]:
        strongest = max(doubtful, key=lambda record: record["pga_g"])  # as one in another unit would be
        records = tag("a", f"{counted(len(doubtful), 'record').capitalize()} to check", href="#records")
        among = ", such as " if len(doubtful) > 1 else ", "
        yield join(
            " ", records, among, finished.shown(strongest["record"]), ": ", strongest["findings"][0]["text"], "."
        )
    noted = int((finished.runs.loc[finished.runs["status"] == "ok", "note"] != "").sum())
    if noted:
        yield join(
            " ",
            tag("a", f"{counted(noted, 'run').capitalize()} {'has' if noted == 1 else 'have'} remarks", href="#peaks"),
            ".",
        )


def _standing(finished: Finished) -> str:
    """Return "Largest value over 8 of 10 runs that end standing; hover for the record. ", or "over 10 runs" if all do."""
    standing = finished.of_all(int((finished.runs["status"] == "ok").sum()), "end standing")
    return f"Largest value over {standing}; hover for the record. "


def _error(finished: Finished) -> str:
    """Return "Error of rotations: at most 0.0002 α (0.001 α allowed).", or that it was not estimated, if the step is fixed.

    "" if the step was adapted, and no run that ended standing has an error.
    """
    numerics = finished.info["numerics"]
    errors = finished.runs.loc[finished.runs["status"] == "ok", "theta_max_error"]
    largest, lacking = errors.max(), int(errors.isna().sum())
    if largest == largest and numerics["tolerance"]:
        error = Decimal(repr(max(float(largest), LEAST_ERROR)))
        error = error.quantize(Decimal(1).scaleb(error.adjusted()), ROUND_UP)
        allowed = Decimal(repr(float(numerics["tolerance"])))
        unknown = f"; unknown in {counted(lacking, 'run')}" if lacking else ""
        strips = ", besides the error of a footing's strips" * any(
            case["base"] in FOOTING for case in finished.info["cases"]
        )
        return f"Error of rotations: at most {error:f} α ({allowed:f} α allowed{strips}){unknown}."
    if numerics.get("substeps"):
        steps = counted(numerics["substeps"], "step")
        return f"Every sampling interval was integrated in {steps}; the error was not estimated."
    return ""
