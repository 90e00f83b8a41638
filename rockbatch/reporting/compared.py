"""The sections of a comparison of two studies."""

import difflib
import math
from dataclasses import replace

from rockbatch.checks.responses import RESPONSES, Worst, in_words, standing, worst_of_all
from rockbatch.common.statuses import NOT_STANDING
from rockbatch.quantities.catalogue import COLUMNS
from rockbatch.quantities.labels import plain
from rockbatch.reporting.differing import differences
from rockbatch.reporting.drawings import drawings
from rockbatch.reporting.finished import Finished, worst_first
from rockbatch.reporting.labels import counted, first_of, head, head_of_key
from rockbatch.reporting.margins import headline, margins
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.reporting.overview import drawn_by_record
from rockbatch.reporting.pair import SIDES, Pair
from rockbatch.reporting.sections import statics, statistics, studied, verdicts
from rockbatch.reporting.sections.answer import responses
from rockbatch.reporting.sections.peaks import on_scale, outcome
from rockbatch.reporting.table import MOST_ROWS, THETA, THETA_FORMAT, Head, table
from rockbatch.results.labelled import as_dicts

INDEPENDENT = ("theta_max_over_alpha", "settlement_m", "base_tilt_rad", "ductility")
"""Responses that are compared in a sentence; drift and uplift go with the rotation."""


def answer(pair: Pair) -> Markup:
    """Return which study passes and by how much, then margins by check, and the worst responses and rotations of both.

    Responses are over the runs that end standing in both, the change of the rotation over pairs of runs. Without a run in
    common it says so in place of both.
    """
    lead = tag("div", tag("strong", headline(pair)), class_="lead")
    in_common = zip(pair.studies, pair.runs, strict=True)
    studies = [replace(study, runs=study.runs.loc[runs.index]) for study, runs in in_common]
    if studies[0].runs.empty:
        return join(lead, margins(pair), tag("p", "The two studies have no run in common."))
    stood = standing(pair.runs[0]) & standing(pair.runs[1])
    in_both = [worst_of_all(replace(study, runs=study.runs[stood]).worst) for study in studies]
    changed = _pairs(pair)
    return join(
        lead,
        margins(pair),
        tag("p", _responses(studies, in_both, int(stood.sum()))),
        tag("p", changed) if changed else "",
        _worst_of_both(studies, in_both, int(stood.sum())),
    )


def _responses(studies: list[Finished], responses: list[dict[str, Worst]], stood: int) -> str:
    """Return a sentence on the change of the worst responses from A to B, over the ``stood`` runs that end standing in both.

    If some do not end standing, a sentence before it has their numbers; if none stands in both, it says so instead.
    """
    lost = [int(study.runs["status"].isin(NOT_STANDING).sum()) for study in studies]
    total = counted(len(studies[0].runs), "run")
    ended = f"Of {total} in common {lost[0]} of A and {lost[1]} of B do not end standing. " if any(lost) else ""
    in_both = {name: [w[name] for w in responses] for name in INDEPENDENT if all(name in w for w in responses)}
    parts = []
    for name, pair in in_both.items():
        change = _change(*(w.value for w in pair))
        labels = (study.label(w.run["record"]) for study, w in zip(studies, pair, strict=True))
        sign = "−" if change < 0.0 else "+" if change > 0.0 else ""
        percent = f"{sign}{plain(abs(100.0 * change), 3)} %" if math.isfinite(change) else "from none"
        parts.append(f"{RESPONSES[name].words} {percent} ({'; then '.join(dict.fromkeys(labels))})")
    if not parts:
        return f"{ended}No run ends standing in both."
    over = total if stood == len(studies[0].runs) else f"{stood} of {total} that end standing in both"
    return f"{ended}From A to B, over {over}: worst {', '.join(parts)}."


def _change(first: float, second: float) -> float:
    """Return the relative change, 0.1 for 10 % more; infinite from 0 to more, 0 from 0 to 0."""
    return second / first - 1.0 if first > 0.0 else math.inf if second > 0.0 else 0.0


def _pairs(pair: Pair) -> str:
    """Return how many pairs have a smaller and a larger rotation in B, and the range of B/A; "" if no pair has a ratio.

    A pair has one if both runs end standing and the rotation of A is above 0; the number of the others is in brackets.
    """
    a, b = pair.runs
    first, second = (runs["theta_max_over_alpha"].where(runs["status"] == "ok").to_numpy(float) for runs in (a, b))
    comparable = (first > 0) & (second >= 0)
    if not comparable.any():
        return ""
    ratio, runs = second[comparable] / first[comparable], a[comparable]
    ends = [(float(ratio[place]), runs.iloc[place]) for place in (int(ratio.argmin()), int(ratio.argmax()))]
    shown = [f"{value:.2g} ({pair.named.label(run['record'])}, {pair.named.case_of(run)})" for value, run in ends]
    return (
        f"From A to B the rotation becomes smaller in {int((ratio < 1.0).sum())} of {counted(len(ratio), 'pair')} of runs"
        f"{'' if comparable.all() else f' ({int((~comparable).sum())} more have no ratio)'}, "
        f"larger in {int((ratio > 1.0).sum())}. B/A ranges from {shown[0]} to {shown[1]}."
    )


def _worst_of_both(studies: list[Finished], responses: list[dict[str, Worst]], stood: int) -> Markup:
    """Return a table of the worst responses over the ``stood`` runs that end standing in both; empty without any."""
    rows: list[list[object]] = []
    for name, response in RESPONSES.items():
        pair = [w.get(name) for w in responses]
        if not any(pair):
            continue
        row: list[object] = [response.words]
        for study, w in zip(studies, pair, strict=True):
            place = w and f"{study.label(w.run['record'])}, {study.case_of(w.run)}"
            row += ["none" if w is None else in_words(w), place]
        first, second = (math.nan if w is None else w.value for w in pair)
        rows.append([*row, second / first if first > 0 else None])
    if not rows:
        return Markup("")
    common = len(studies[0].runs)
    words = "runs in common" if stood == common else f"{stood} of {common} runs that end standing in both"
    heads = [Head(f"worst of the {words}")]
    heads += [Head(words, group=side) for side in SIDES for words in ("value", "record and case")]
    return table([*heads, Head("B / A", ".3f")], rows, prose=True, name="Worst responses of both")


def checks(pair: Pair) -> Markup:
    """Return each study's verdicts: the answer, then the scorecard."""
    parts: list[object] = []
    for name, study in zip(SIDES, pair.studies, strict=True):
        parts += [tag("h3", name), tag("div", verdicts.answer(study))]
        if study.verdicts:
            parts.append(verdicts.scorecard(study))
    return join(*parts)


def inputs(pair: Pair) -> Markup:
    """Return a table of the inputs that differ: keys of the studies, by value, and motions; or a sentence that none does.

    Pairs of cases with different names stand above it.
    """
    others = [f"{first} with {second}" for second, first in pair.names.items() if first != second]
    words = tag("p", f"Paired cases of A and B: {'; '.join(others)}.") if others else ""
    rows = differences(*pair.studies, pair.names)
    if not rows:
        return join(words, tag("p", "Every key of the two studies has the same value, and their motions are the same."))
    return join(words, table([Head("input"), *map(Head, SIDES)], rows, name="Inputs"))


def figures(pair: Pair) -> Markup:
    """Return the figure of peaks of both studies side by side, those of the worse polarity; empty without pairs."""
    named = pair.named
    if pair.runs[0].empty:
        return Markup("")
    worse = []
    for name, runs in zip(SIDES, pair.runs, strict=True):
        chosen = worst_first(runs, len(runs)).drop_duplicates(["record", "series", "pier", "scale", "with_vertical"])
        worse.append((name, chosen))
    return drawn_by_record(named, worse)


def pairs(pair: Pair) -> Markup:
    """Return a table with a row for each of the worst :data:`MOST_ROWS` pairs of runs, worst first; empty without pairs."""
    a, b = pair.runs
    if a.empty:
        return Markup("")
    worse = a["theta_max_over_alpha"].fillna(0).to_numpy() < b["theta_max_over_alpha"].fillna(0).to_numpy()
    worst = a.assign(theta_max_over_alpha=a["theta_max_over_alpha"].where(~worse, b["theta_max_over_alpha"].to_numpy()))
    rank = ("ok", "failed", "flight", "overturned").index
    worst["status"] = [max(pair_of_runs, key=rank) for pair_of_runs in zip(a["status"], b["status"], strict=True)]
    order = a.index.get_indexer(worst_first(worst, MOST_ROWS).index)
    names = [key for key in pair.keys if key in ("record", "case") or a[key].nunique() > 1]
    in_both = {*a.columns} & {*b.columns} - {"theta_max_over_alpha"}
    more = [column for column in COLUMNS.values() if column.suite and column.name in in_both]
    heads = [*(head_of_key(name) for name in names), *(Head(side, THETA_FORMAT, group=THETA) for side in SIDES)]
    heads.append(Head("B / A", ".3f", group=THETA))
    heads += [Head(side, group=head(column).words, form=head(column).form) for column in more for side in SIDES]
    rows = []
    for pair_of_runs in zip(as_dicts(a.iloc[order]), as_dicts(b.iloc[order]), strict=True):
        first, second = (run["theta_max_over_alpha"] if run["status"] == "ok" else math.nan for run in pair_of_runs)
        ratio = second / first if first > 0 else None
        other_values = (on_scale(column.name, run[column.name]) for column in more for run in pair_of_runs)
        own = (
            pair.named.shown(run[name]) if name == "record" else run[name] for run in pair_of_runs[:1] for name in names
        )
        rows.append([*own, *map(outcome, pair_of_runs), ratio, *other_values])
    return table(heads, rows, sortable=True, name="Pairs of runs", worst_of=len(a))


def suites(pair: Pair) -> Markup:
    """Return statistics over the runs that both have: those of different suites are not comparable; empty without pairs."""
    if pair.runs[0].empty:
        return Markup("")
    vertical = [any(record["pga_v_g"] is not None for record in study.info["records"]) for study in pair.studies]
    sides = list(SIDES)
    if vertical[0] != vertical[1]:
        sides = [f"{name}, {'with' if v else 'without'} vertical" for name, v in zip(SIDES, vertical, strict=True)]
    keys = ["scale", "pier", "series", "with_vertical"]
    names, heads = statistics.rows_of(pair.named, pair.runs[0], keys)
    runs = dict(zip(sides, pair.runs, strict=True))
    drawn = statistics.tables(runs, keys, names, heads, pair.studies[0].count)
    return join(tag("p", "Over the pairs of runs only."), drawn)


def only_in_one(pair: Pair) -> Markup:
    """Return a table of the cases with unmatched runs, a row for each polarity and scale, with up to six records each.

    Empty without any.
    """
    rows: list[list[object]] = []
    for name, study, runs in zip(SIDES, pair.studies, pair.only, strict=True):
        for _, group in runs.groupby(["series", "pier", "scale", "polarity", "with_vertical"], sort=False):
            rows.append(
                [name, study.case_of(group.iloc[0]), len(group), first_of(list(dict.fromkeys(group["record"])), 6)]
            )
    heads = [Head("study"), Head("case", key=True), Head("runs"), Head("records")]
    return table(heads, rows, name="Runs in one study only") if rows else Markup("")


def studies(pair: Pair) -> Markup:
    """Return the number of pairs of runs, then both studies: greatest responses, drawings, what was studied, and statics."""
    parts: list[object] = [
        tag("p", f"{counted(len(pair.runs[0]), 'pair')} of runs of paired cases under the same ground motion.")
    ]
    for name, study in zip(SIDES, pair.studies, strict=True):
        title = tag("h3", f"{name}: {study.study['title'] or ''} ", tag("code", study.directory))
        parts += [title, responses(study), drawings(study), studied.section(study, level="h4")]
        parts += [tag("h4", "Statics"), statics.section(study)]
    return join(*parts)


def difference(pair: Pair) -> Markup:
    """Return a diff of the study files, or that they are the same, and the versions of both if they differ."""
    a, b = (study.study["text"].splitlines() for study in pair.studies)
    lines = difflib.unified_diff(a, b, "A", "B", n=1, lineterm="")
    versions = [{"rockbatch": study.info["rockbatch"], **study.info["versions"]}.items() for study in pair.studies]
    words = [" ".join(f"{name} {version}" for name, version in pairs) for pairs in versions]
    shown = "\n".join(lines)
    return join(
        tag("pre", tag("code", shown)) if shown else tag("p", "The study files are the same."),
        tag("p", f"Versions: A {words[0]}; B {words[1]}.") if words[0] != words[1] else "",
    )
