"""The answer: verdicts, worst responses, runs without a result, and every peak in one picture."""

import math
from decimal import ROUND_UP, Decimal

import numpy as np

from rockbatch.checks.remarks import undamped_settlement, weak_supports
from rockbatch.checks.responses import RESPONSES, in_words, worst_of_all
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import counted
from rockbatch.reporting.markup import Markup, join, number, tag
from rockbatch.reporting.overview import by_record
from rockbatch.reporting.sections import verdicts
from rockbatch.reporting.table import alarm
from rockbatch.reporting.templates import render
from rockbatch.results.rows import NOT_RUN
from rockbatch.results.suite_statistics import reasons_of_failure

MOST_COMPARED = 4
"""Cases whose greatest rotations stand beside each other."""

LEAST_ERROR = 1e-6
"""Of α: smaller errors are given as this."""

Facts = list[tuple[str, Markup]]
"""Headings with a sentence each."""


def section(finished: Finished) -> Markup:
    """Return the first screen; every check and every run follow further down."""
    weak = weak_supports(finished.info["cases"])
    passes = tag("div", verdicts.answer(finished), class_="lead")
    return join(tag("div", alarm(weak)) if weak else "", passes, worst(finished), by_record(finished))


def worst(finished: Finished) -> Markup:
    """Return the worst responses, and how the runs ended, first those that did not end standing."""
    runs = finished.runs
    stood, unread = runs["status"] == "ok", len(finished.info["unusable"])
    failed = int((runs["status"] == "failed").sum())
    guided = runs.loc[stood & runs["flight_s"].notna(), "flight_height_m"]
    lost = [
        f"{counted(n, noun)} {state}"
        for n, noun, state in (
            (unread, "file", "could not be used"), (failed, "run", "failed"), (finished.not_run, "run", NOT_RUN)
        )
        if n
    ]  # fmt: skip
    return render(
        "reporting/sections/answer.html", finished=finished, runs=runs, guided=guided,
        alphas={f"{math.degrees(case['pier']['alpha']):.3g}°" for case in finished.cases.values()},
        symbols=any("=" in words for words in (*(series.label for series in finished.series), *finished.piers)),
        over=runs[runs["status"] == "overturned"],
        flown=runs[runs["status"] == "flight"].sort_values("flight_s", kind="stable"),
        lost=lost, standing=finished.of_all(int(stood.sum()), "end standing"), all_stand=stood.all() and not finished.not_run,
        reasons=reasons_of_failure(runs),
        responses=[] if runs.empty else [*_responses(finished), *_of_devices(finished), *_by_case(finished)],
        went=_converged(finished),
        height=float(guided.max()), error=_error(finished), noted=int((runs.loc[stood, "note"] != "").sum()),
    )  # fmt: skip


def _responses(finished: Finished) -> Facts:
    """Return the worst of all cases, regardless of checks, with the run in which it occurs."""
    largest = worst_of_all(finished.worst)
    facts: Facts = []
    first: dict[object, str] = {}
    for name, worst in largest.items():
        words, run = RESPONSES[name].words, worst.run
        rotation = name == "theta_max_over_alpha"
        time = f", at t = {number(float(run['t_max_s']))} s" if rotation else ""
        place = f": {finished.label(run['record'])}, case {finished.case_of(run)}{time}"
        if first.setdefault(run.name, words) != words:
            place = f", in the run of the greatest {first[run.name]}"
        lean = " (mostly the lean of a base that has yielded)" if rotation and run["theta_max_is"] else ""
        qualifier = {"top_drift_m": ", of a rigid shaft", "heel_uplift_m": ", above the toe"}.get(name, "")
        facts.append((words, join(tag("strong", in_words(worst)), lean, qualifier, place)))
    bases = {worst.case["base"] for worst in finished.worst}
    if bases == {"rigid"}:
        exception = "" if "theta_res_rad" in largest else "; nothing holds the pier at a tilt"
        facts.append(("of the supports", join(f"no settlement: the ground is rigid{exception}")))
    elif "yielding" not in bases:
        facts.append(("of the supports", join("no settlement: they are elastic")))
    if undamped := undamped_settlement(finished.worst):
        facts.append(("of the settlement", join(undamped)))
    return facts


def _of_devices(finished: Finished) -> Facts:
    """Return the greatest force of devices, in kN if the mass is known, and the greatest stroke, yield or deflection."""
    stood = finished.runs["status"] == "ok"
    facts: Facts = []
    for device, quantity, words in (
        ("damper", "damper_stroke_m", "stroke"),
        ("tendon", "tendon_yield_m", "plastic elongation"),
        ("stop", "stop_deflection_m", "deflection"),
        ("deck_spring", "deck_spring_deflection_m", "deflection"),
    ):
        if quantity not in finished.runs or finished.runs.loc[stood, quantity].isna().all():
            continue
        runs = finished.runs[stood]
        weighed = f"{device}_force_kN" in runs and runs[f"{device}_force_kN"].notna().any()
        forces = runs[f"{device}_force_kN" if weighed else f"{device}_force_over_weight"]
        hardest, longest = (runs.iloc[int(np.nanargmax(values))] for values in (forces, runs[quantity]))
        force = f"{forces.max():,.0f} kN" if weighed else f"{forces.max():.3g} of the pier's weight"
        moved = join(f"no {words}")
        if longest[quantity] > 0.0:
            place = f": {finished.label(longest['record'])}, case {finished.case_of(longest)}"
            moved = join(f"{words} at most ", tag("strong", f"{1000 * longest[quantity]:,.3g} mm"), place)
        bears = join("force of one at most ", tag("strong", force), f" ({finished.case_of(hardest)}); ")
        facts.append((f"{device.replace('_', ' ')}s", join(bears, moved)))
    return facts


def _by_case(finished: Finished) -> Facts:
    """Return the greatest rotation of each of a few cases if all runs stood, for studies that compare cases."""
    rotations = [worst for worst in finished.worst if worst.demand == "theta_max_over_alpha"]
    stood = len(rotations) == len(finished.cases) and (finished.runs["status"] == "ok").all()
    if not stood or not 1 < len(rotations) <= MOST_COMPARED:
        return []
    words = (f"{worst.value:.4f} α ({finished.case_of(worst.run)})" for worst in rotations)
    return [("rotation by case", join("; ".join(words)))]


def _converged(finished: Finished) -> str:
    """Report how many peaks converged; a chaotic one has no error."""
    if not finished.info["numerics"].get("tolerance"):
        return "none failed"
    errors = finished.runs["theta_max_error"]
    return "every peak converged" if errors.notna().all() else f"{counted(int(errors.notna().sum()), 'peak')} converged"


def _error(finished: Finished) -> str:
    """Report the largest error of the peaks, or that none was estimated."""
    numerics = finished.info["numerics"]
    errors = finished.runs.loc[finished.runs["status"] == "ok", "theta_max_error"]
    largest, lacking = errors.max(), int(errors.isna().sum())
    if largest == largest and numerics["tolerance"]:
        error = Decimal(repr(max(float(largest), LEAST_ERROR)))
        error = error.quantize(Decimal(1).scaleb(error.adjusted()), ROUND_UP)
        allowed = Decimal(repr(float(numerics["tolerance"])))
        unknown = f"; of {counted(lacking, 'run')} it is not known" if lacking else ""
        return f"Estimated error of rotation: at most {error:f} α ({allowed:f} α allowed){unknown}."
    if numerics.get("substeps"):
        steps = counted(numerics["substeps"], "step")
        return f"Every sampling interval was integrated in {steps}; the error was not estimated."
    return ""
