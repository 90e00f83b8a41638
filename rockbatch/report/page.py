"""The page: what was studied, what came out, and how to get there again."""

import base64
import hashlib
import shlex
from collections.abc import Sequence
from importlib.resources import files

from rockbatch.report import accuracy, histories, peaks, tables
from rockbatch.report.finished import Finished, Run, quantity
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.summary import counted, summary
from rockbatch.response import Response


def page(finished: Finished, responses: Sequence[Response] = (), levels: Sequence[accuracy.Level] = ()) -> str:
    """The whole report as HTML: one file, no address outside it."""
    style, script = (
        files(__package__).joinpath(name).read_text(encoding="utf-8") for name in ("style.css", "script.js")
    )
    title = finished.info["study"]["title"] or "Rocking piers"
    sections = [
        ("Summary", "summary", summary(finished)),
        ("Peak rotations", "figure", _figures(finished)),
        ("Peak rotations in numbers", "numbers", _numbers(finished)),
        ("Compared with published values", "references", _references(finished)),
        ("Notes", "notes", _notes(finished)),
        ("Histories", "histories", _histories(finished, responses)),
        ("All results", "peaks", _all(finished)),
        ("Foundations", "foundations", tables.foundations(finished)),
        ("Ground motions", "records", _records(finished)),
        ("Not used", "unusable", _unusable(finished)),
        ("Speed and error", "accuracy", _accuracy(levels)),
        ("How to reproduce", "reproduce", _reproduce(finished)),
    ]
    sections = [section for section in sections if section[2]]
    links = [tag("a", name, href=f"#{key}") for name, key, _ in sections]
    # Only the script below may run, and nothing is fetched, whatever a record is called
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    policy = f"default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-{digest}'"
    head = tag(
        "head",
        Markup('<meta charset="utf-8">'),
        Markup(f'<meta http-equiv="Content-Security-Policy" content="{policy}">'),
        Markup('<meta name="viewport" content="width=device-width, initial-scale=1">'),
        Markup('<meta name="color-scheme" content="light dark">'),
        tag("title", title),
        tag("style", Markup(style)),
    )
    body = tag(
        "body",
        tag("header", tag("p", "Rocking response of stepping piers", class_="kind"), tag("h1", title)),
        tag("nav", *links, aria_label="Sections"),
        tag("main", *(tag("section", tag("h2", name), content, id=key) for name, key, content in sections)),
        tag("script", Markup(script)),
    )
    return f'<!DOCTYPE html>\n<html lang="en">\n{head}\n{body}\n</html>\n'


def _paragraphs(*sentences: object) -> Markup:
    return join(*(tag("p", sentence) for sentence in sentences if sentence))


def _groups(finished: Finished) -> list[tuple[str, list[Run]]]:
    """Runs that share a pier and a scale, with the words that tell them from the others."""
    keys = sorted({(run.scale, run.pier) for run in finished.runs})
    scaled = len({scale for scale, _ in keys}) > 1
    groups = []
    for scale, pier in keys:
        words = [finished.piers[pier], f"motions scaled by {number(scale)}" if scaled else ""]
        runs = [run for run in finished.runs if (run.scale, run.pier) == (scale, pier)]
        groups.append((", ".join(filter(None, words)), runs))
    return groups


def _figure(drawn: Markup, caption: Sequence[object]) -> Markup:
    return tag("figure", tag("div", drawn, class_="wide", tabindex="0"), tag("figcaption", *caption))


def _figures(finished: Finished) -> Markup:
    groups = _groups(finished)
    shown = []
    for index, (words, runs) in enumerate(groups):
        # Piers are compared on one axis; larger motions have their own
        top = peaks.ceiling([run for run in finished.runs if run.scale == runs[0].scale])
        drawn = peaks.draw(finished, runs, top, f"peaks{index}")
        caption: list[object] = [tag("strong", f"{words}. ")] if words else []
        caption += ["Largest rotation over slenderness, records in order of peak ground acceleration"]
        if any(run.series.rigid for run in runs):
            caption += ["; lines: rigid base"]
        if len({run.polarity for run in runs}) > 1:
            caption += ["; open markers: horizontal component reversed"]
        caption += ["."]
        if any(run.status in peaks.HAPPENED for run in runs):
            caption += [
                " Symbols in the shaded strip are runs without a largest rotation: "
                "the pier overturned, or left the ground."
            ]
        shown.append(_figure(drawn, caption))
    return join(*shown)


def _numbers(finished: Finished) -> Markup:
    shown = []
    for words, runs in _groups(finished):
        shown.append(join(tag("h3", words) if words else "", tables.at_a_glance(finished, runs)))
    if not shown:
        return join()
    flew = any(run.status == "ok" and run.row["flight_s"] is not None for run in finished.runs)
    legend = [tables.THETA, ", in order of PGA; the largest of each table in bold."]
    if flew:
        legend += [" ", tag("sup", "f"), " both pivots left the ground on the way; the pier was guided down."]
    return join(tag("p", *legend), *shown)


def _references(finished: Finished) -> Markup:
    return tables.comparison(finished) if finished.info["references"] else join()


def _notes(finished: Finished) -> Markup:
    notes = finished.info["study"]["notes"] or ""
    return _paragraphs(*(part.strip() for part in notes.split("\n\n")))


def _histories(finished: Finished, responses: Sequence[Response]) -> Markup:
    shown = []
    for index, group in enumerate(histories.groups(responses)):
        pier = group[0].pier
        titles = [_column_title(finished, response) for response in group]
        drawn = histories.draw(group, titles, f"histories{index}")
        caption: list[object] = [
            tag("strong", f"{group[0].record}. "),
            f"Pier α = {number(pier.alpha)} rad, p = {number(pier.p)} rad/s. ",
            "Rotation, angular velocity, energy relative to the start, and ground acceleration",
        ]
        if len(group) > 1 and group[0].base.name == "rigid":
            caption += ["; thin line: rigid base"]
        if group[-1].base.name != "rigid":
            caption += ["; shaded: rotations at which both supports stay loaded in weak rocking"]
        caption += ["."]
        if any(response.base.name == "yielding" for response in group):
            caption += [
                " At the foot, force against deflection of the left (L) and right (R) spring, "
                "over their values at yield."
            ]
        shown.append(_figure(drawn, caption))
    return join(*shown)


def _column_title(finished: Finished, response: Response) -> str:
    series = finished.series(response.case, response.columns)
    if series is None:
        return ", ".join([response.case, *(quantity(key, value) for key, value in response.columns.items())])
    return series.label.replace(": ", "\n", 1)


def _all(finished: Finished) -> Markup:
    if not finished.rows:
        return join()
    lead = tag("p", "Every row of ", tag("code", "peaks.csv"), ". Click a heading to sort.", class_="scripted")
    return join(lead, _ratcheting(finished), tables.peaks(finished))


def _ratcheting(finished: Finished) -> Markup:
    """That settlement hangs on the spring law, and by how much where both were run."""
    if not any(case["parameters"].get("spring") for case in finished.info["cases"]):
        return Markup("")
    told = "Bouc–Wen springs ratchet: they settle a little with every cycle, elastic–perfectly plastic ones do not. "
    name = "settlement_other_law_m"
    if not any(name in row for row in finished.rows):
        told += (
            "Settlement and residual rotation depend on that; [output] both_laws = true in the study shows how much."
        )
        return tag("p", told)
    pairs = [(run, run.row["settlement_m"], run.row.get(name)) for run in finished.runs]
    both = [(abs(own - other), run, own, other) for run, own, other in pairs if own is not None and other is not None]
    if not both:
        return tag("p", told)
    _, run, own, other = max(both, key=lambda entry: entry[0])
    told += (
        f"The settlement differs most in {run.record}, {run.series.label}: {1000 * own:.1f} mm by the study's law, "
        f"{1000 * other:.1f} mm by the other one."
    )
    return tag("p", told)


def _records(finished: Finished) -> Markup:
    return tables.records(finished) if finished.info["records"] else join()


def _unusable(finished: Finished) -> Markup:
    failed = any(run.status == "failed" for run in finished.runs)
    return tables.unusable(finished) if finished.info["unusable"] or failed else join()


def _accuracy(levels: Sequence[accuracy.Level]) -> Markup:
    if not levels:
        return join()
    runs = counted(int(levels[0].runs or 0), "run")
    settled = number(max(level.reference_change or 0.0 for level in levels), ".0e")
    caption = (
        f"Measured on {levels[0].machine}, in one thread, over {runs} of this study (SciPy's solvers: at most two of "
        "them, on springs), against runs with ever smaller steps, the last halving of which changed the peak by "
        f"{settled} at most. k: steps per sample; SciPy: its rtol. Runs that overturn, or end otherwise than they "
        "should, have no error; the table counts the latter."
    )
    lead = accuracy.lead(levels)
    return join(_paragraphs(lead), _figure(accuracy.draw(levels), [caption]), accuracy.levels_table(levels))


def _reproduce(finished: Finished) -> Markup:
    info = finished.info
    study = info["study"]
    versions = ", ".join(f"{name} {version}" for name, version in info["versions"].items())
    wall = number(float(info["wall_s"]), ".3g")
    facts = [
        ("Command", tag("code", shlex.join(info["command"]))),
        ("Study", tag("code", study["path"])),
        ("SHA-256", tag("code", study["sha256"])),
        ("Made", info["created"]),
        ("rockbatch", info["rockbatch"]),
        ("With", versions),
        ("Machine", info["machine"]),
        ("Cost", f"{counted(info['runs'], 'run')} in {wall} s on {counted(info['jobs'], 'job')}"),
    ]
    listed = tag("dl", *(join(tag("dt", name), tag("dd", value)) for name, value in facts))
    text = tag("details", tag("summary", "The study file"), tag("pre", tag("code", study["text"])))
    return join(listed, text)
