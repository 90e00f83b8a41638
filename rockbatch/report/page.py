"""The page of one study: what was studied, whether it passes, what came out, and how to get there again."""

import shlex
from collections.abc import Sequence

from rockbatch.checks import Verdict
from rockbatch.report.document import Section, document, figure, paragraphs
from rockbatch.report.finished import Finished
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.sections import (
    accuracy,
    analyses,
    histories,
    inputs,
    peak_rotations,
    peaks,
    spectra,
    statistics,
    summary,
    verdicts,
)
from rockbatch.report.sections.summary import counted
from rockbatch.report.table import THETA
from rockbatch.results.response import Response


def page(
    finished: Finished,
    responses: Sequence[Response] = (),
    levels: Sequence[accuracy.Level] = (),
    judged: Sequence[Verdict] = (),
) -> str:
    """The whole report as HTML."""
    title = finished.info["study"]["title"] or "Rocking piers"
    checks = [tag("p", summary.worst(finished), class_="lead"), tag("div", verdicts.answer(judged), class_="lead")]
    sections = [
        Section("What was studied", "studied", summary.studied(finished)),
        Section("Does it pass", "checks", join(*checks, summary.quality(finished), verdicts.section(judged))),
        Section("Peak rotations", "figure", _figures(finished)),
        Section("Compared with published values", "references", _references(finished)),
        Section("Every run", "peaks", _all(finished)),
        Section("The suite in each case", "suite", statistics.section(finished)),
        *analyses.sections(finished.saved.directory, finished.info["study"]["sha256"]),
        Section("Histories", "histories", _histories(finished, responses)),
        Section("Ground motions", "records", _records(finished)),
        Section("Not used", "unusable", _unusable(finished)),
        Section("Speed and error", "accuracy", _accuracy(finished, levels)),
        Section(
            "Notes",
            "notes",
            paragraphs(*(part.strip() for part in (finished.info["study"]["notes"] or "").split("\n\n"))),
        ),
        Section("How to reproduce", "reproduce", _reproduce(finished)),
    ]
    return document("Rocking response of stepping piers", title, sections)


def _figures(finished: Finished) -> Markup:
    runs = finished.runs
    if runs.empty:
        return Markup("")
    caption = [
        "Largest rotation over slenderness, ", THETA, ", records in order of peak ground acceleration",
        "; lines: rigid base" if any(series.rigid for series in finished.series) else "",
        "; open markers and dashed lines: horizontal component reversed" if finished.both_directions else "", ".",
    ]  # fmt: skip
    drawn = peak_rotations.figures(finished, caption)
    flew = ((runs["status"] == "ok") & runs["flight_s"].notna()).any()
    legend = tag("sup", "f"), " both pivots left the ground on the way; the pier was guided down."
    return join(drawn, tag("p", *legend, class_="legend") if flew else "")


def _references(finished: Finished) -> Markup:
    return peaks.published(finished) if finished.info["references"] else join()


def _all(finished: Finished) -> Markup:
    if finished.runs.empty:
        return join()
    lead = [
        "The worst first: overturned, ended by flight, then by rotation. All of it is in ", tag("code", "peaks.csv"), ". ",
        tag("span", "Click a heading to sort.", class_="scripted"),
    ]  # fmt: skip
    return join(tag("p", *lead), _ratcheting(finished), peaks.every_run(finished))


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


def _histories(finished: Finished, responses: Sequence[Response]) -> Markup:
    if not len(responses):
        return Markup("")
    drawn = join(*(figure(*pair) for pair in histories.figures(finished, responses)))
    hint = "Point at a picture, touch it, or go through it with the arrow keys, to read values."
    return join(tag("p", hint, class_="scripted"), drawn)


def _records(finished: Finished) -> Markup:
    return join(spectra.section(finished), inputs.records(finished)) if finished.info["records"] else join()


def _unusable(finished: Finished) -> Markup:
    failed = (finished.runs["status"] == "failed").any()
    return join(
        inputs.unusable(finished) if finished.info["unusable"] or failed else "",
        join(tag("h3", "Left out"), inputs.left_out(finished)) if finished.info.get("left_out") else "",
    )


def _accuracy(finished: Finished, levels: Sequence[accuracy.Level]) -> Markup:
    info, errors = finished.info, finished.runs["theta_max_error"].dropna()
    kept = info.get("kept", 0)  # of an earlier session, or of other machines: what they took is not known
    cost = f"{counted(kept, 'run')} had been finished before. " if kept else ""
    if kept < info["runs"]:
        took = f"{number(float(info['wall_s']), '.3g')} s on {counted(info['jobs'], 'thread')}"
        cost += f"{counted(info['runs'] - kept, 'run')} took {took}."
    if len(errors):
        cost += (
            f" The error of θmax/α, estimated by halving the step, is {errors.median():.0e} in the median and "
            f"{errors.max():.0e} at most."
        )
    if not levels:
        against = join(
            "Not measured against references: ", tag("code", "rockbatch accuracy"), " does that for this study."
        )
        return paragraphs(cost, against)
    runs = counted(int(levels[0].runs or 0), "run")
    settled = number(max(level.reference_change or 0.0 for level in levels), ".0e")
    caption = (
        f"Measured on {levels[0].machine}, in one thread, over {runs} of this study (SciPy's solvers: at most two of "
        "them, on springs), against runs with ever smaller steps, the last halving of which changed the peak by "
        f"{settled} at most. k: steps per sample; SciPy: its rtol. Runs that overturn, or end otherwise than they "
        "should, have no error; the table counts the latter."
    )
    return join(
        paragraphs(cost, accuracy.lead(levels)), figure(accuracy.draw(levels), caption), accuracy.levels_table(levels)
    )


def _reproduce(finished: Finished) -> Markup:
    info = finished.info
    study = info["study"]
    versions = ", ".join(f"{name} {version}" for name, version in info["versions"].items())
    facts = [
        ("Command", tag("code", shlex.join(info["command"]))),
        ("Study", tag("code", study["path"])),
        ("SHA-256", tag("code", study["sha256"])),
        ("Made", info["created"]),
        ("rockbatch", info["rockbatch"]),
        ("With", versions),
        ("Machine", info["machine"]),
    ]
    listed = tag("dl", *(join(tag("dt", name), tag("dd", value)) for name, value in facts))
    return join(listed, tag("h3", "The study file"), tag("pre", tag("code", study["text"])))
