"""The sections of a comparison of two studies."""

import difflib
import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace

from rockbatch.checks.responses import RESPONSES, Worst, in_words, standing, worst_of_all
from rockbatch.quantities.catalogue import COLUMNS
from rockbatch.reporting.finished import Finished, worst_first
from rockbatch.reporting.labels import counted, head, symbol
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.reporting.overview import drawn_by_record
from rockbatch.reporting.pair import SIDES, Pair
from rockbatch.reporting.sections import statics, statistics, studied, verdicts
from rockbatch.reporting.sections.answer import responses
from rockbatch.reporting.sections.peaks import on_scale, outcome
from rockbatch.reporting.table import MOST_ROWS, THETA, THETA_FORMAT, Head, table
from rockbatch.results.labelled import as_dicts
from rockbatch.results.labels import digits_that_tell
from rockbatch.results.suite_statistics import NO_PEAK

LEVEL = 0.02
"""Largest relative difference of a response that makes neither study better."""
INDEPENDENT = ("theta_max_over_alpha", "settlement_m", "base_tilt_rad", "ductility")
"""Responses that decide; drift and uplift go with the rotation."""
BETTER = {
    (True, False): "B is better",
    (False, True): "A is better",
    (True, True): "Neither is better throughout",
    (False, False): "Neither is better",
}
"""The better study, by whether a response of B is smaller, and whether one is larger."""
MOST_VALUES = 6
"""Most values of one input that are shown."""
PIER = ("alpha", "p", "mu", "gravity", "size_m", "mass_t", "top_m")
BASE = (
    "beta",
    "stiffness_kN_m",
    "eta",
    "yield_kN",
    "impact",
    "epsilon",
    "spring",
    "n",
    "kinematics",
    "flight",
    "flight_limit_mm",
    "restitution",
)
NUMERICS = {"tolerance": "tolerance", "substeps": "steps per sample", "quiet_s": "time at rest after the record [s]"}


def answer(pair: Pair) -> Markup:
    """Name the better study, with the differences and governing records, over the runs that both have."""
    in_common = zip(pair.studies, pair.runs, strict=True)
    studies = [replace(study, runs=study.runs.loc[runs.index]) for study, runs in in_common]
    if studies[0].runs.empty:
        return tag("p", "The two studies have no run in common.")
    stood = standing(pair.runs[0]) & standing(pair.runs[1])
    in_both = [worst_of_all(replace(study, runs=study.runs[stood]).worst) for study in studies]
    changed = _pairs(pair)
    return join(
        tag("div", _better(studies, in_both, int(stood.sum())), class_="lead"),
        tag("p", changed) if changed else "",
        _worst_of_both(studies, in_both, int(stood.sum())),
    )


def _better(studies: list[Finished], responses: list[dict[str, Worst]], stood: int) -> Markup:
    """Name the study with fewer runs that do not end standing; if equal, the study with smaller worst responses.

    ``responses`` are the worst of each study over the ``stood`` runs that end standing in both.
    """
    lost = [int(study.runs["status"].isin((*NO_PEAK, "failed")).sum()) for study in studies]
    if lost[0] != lost[1]:
        good, bad = (0, 1) if lost[0] < lost[1] else (1, 0)
        lead = f": of {counted(len(studies[0].runs), 'run')} {lost[good]} do not end standing, of {SIDES[bad]} {lost[bad]}."
        return join(tag("strong", f"{SIDES[good]} is better"), lead)
    in_both = {name: [w[name] for w in responses] for name in INDEPENDENT if all(name in w for w in responses)}
    changes = {name: _change(*(w.value for w in pair)) for name, pair in in_both.items()}
    smaller, larger = (any(sign * change > LEVEL for change in changes.values()) for sign in (-1, 1))
    parts = []
    for name, pair in in_both.items():
        labels = (study.label(w.run["record"]) for study, w in zip(studies, pair, strict=True))
        change = f"{100 * changes[name]:+.3g} %" if math.isfinite(changes[name]) else "from none"
        parts.append(f"{RESPONSES[name].words} {change} ({'; then '.join(dict.fromkeys(labels))})")
    lead = f": from A to B, worst {', '.join(parts)}" if parts else ": no run ends standing"
    if parts and lost[0]:
        lead += f", of the {stood} of {len(studies[0].runs)} runs that end standing in both"
    lead += "."
    return join(tag("strong", BETTER[smaller, larger]), lead)


def _change(first: float, second: float) -> float:
    """Return the relative change; infinite from 0 to more, 0 from 0 to 0."""
    return second / first - 1.0 if first > 0.0 else math.inf if second > 0.0 else 0.0


def _pairs(pair: Pair) -> str:
    """Report the number of pairs with a smaller and a larger rotation in B, and the range of B/A; empty without any ratio."""
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
    """Return a table of the inputs that differ: pier, foundations, motions and numerics."""
    in_both = set.intersection(*({case["case"] for case in study.info["cases"]} for study in pair.studies))
    sides = [_inputs(study, in_both) for study in pair.studies]
    rows = []
    for name in dict.fromkeys(name for side in sides for name in side):
        values, others = (side.get(name, []) for side in sides)
        if values != others:
            rows.append([name, _shown(values, values + others), _shown(others, values + others)])
    if not rows:
        return tag("p", "Pier, foundations, motions and numerics are the same in both.")
    return table([Head("input"), *map(Head, SIDES)], rows, name="Inputs")


def _inputs(study: Finished, compared: Collection[str]) -> dict[str, list[object]]:
    """Return the distinct values of every input, by its name; base parameters only of the cases ``compared``."""
    info = study.info
    records = [record["record"] for record in info["records"]]
    vertical = sum(record["pga_v_g"] is not None for record in info["records"])
    values: dict[str, Iterable[object]] = {
        f"pier: {symbol(key)}": [case["pier"].get(key) for case in info["cases"]] for key in PIER
    }
    values["cases"] = names = list(dict.fromkeys(case["case"] for case in info["cases"]))
    for name in filter(compared.__contains__, names):
        entries = [case for case in info["cases"] if case["case"] == name]
        values[f"{name}: base"] = [case["base"] for case in entries]
        values |= {f"{name}: {symbol(key)}": [case["parameters"].get(key) for case in entries] for key in BASE}
    values |= {
        "ground motions": sorted(records),
        "with the vertical component": [
            {0: "none", len(records): "all"}.get(vertical, f"{vertical} of {len(records)}")
        ],
        "files that could not be used": [len(info["unusable"])],
        "scale": study.runs["scale"].tolist(),
        "polarity": study.runs["polarity"].tolist(),
    }
    values |= {words: [info["numerics"].get(key)] for key, words in NUMERICS.items()}
    return {
        name: list(dict.fromkeys(value for value in entries if value is not None)) for name, entries in values.items()
    }


def _shown(values: Sequence[object], all_values: Iterable[object]) -> str:
    """Format one study's values with enough digits to distinguish ``all_values``; "none" without any."""
    digits = digits_that_tell(all_values, least=4)
    words = [f"{value:.{digits}g}" if isinstance(value, float | int) else str(value) for value in values]
    if len(words) > MOST_VALUES:
        return f"{counted(len(words), 'value')}: {', '.join(words[:MOST_VALUES])}, …"
    return ", ".join(words) or "none"


def figures(pair: Pair) -> Markup:
    """Draw the peaks of both studies side by side, those of the worse polarity."""
    named = pair.named
    if pair.runs[0].empty:
        return Markup("")
    worse = []
    for name, runs in zip(SIDES, pair.runs, strict=True):
        chosen = worst_first(runs, len(runs)).drop_duplicates(["record", "series", "pier", "scale", "with_vertical"])
        worse.append((name, chosen))
    return drawn_by_record(named, worse)


def pairs(pair: Pair) -> Markup:
    """Return a table with a row for each pair of runs, worst first."""
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
    heads = [*(Head(symbol(name)) for name in names), *(Head(side, THETA_FORMAT, group=THETA) for side in SIDES)]
    heads.append(Head("B / A", ".3f", group=THETA))
    heads += [Head(side, group=head(column).text, form=head(column).form) for column in more for side in SIDES]
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
    """Return statistics over the runs that both have: those of different suites are not comparable."""
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
    """Return a table of the cases with unmatched runs; empty without any."""
    rows: list[list[object]] = []
    for name, study, runs in zip(SIDES, pair.studies, pair.only, strict=True):
        for _, group in runs.groupby(["series", "pier", "scale", "polarity", "with_vertical"], sort=False):
            rows.append(
                [name, study.case_of(group.iloc[0]), len(group), _first(list(dict.fromkeys(group["record"])), 6)]
            )
    heads = [Head("study"), Head("case"), Head("runs"), Head("records")]
    return table(heads, rows, name="Only in one") if rows else Markup("")


def _first(names: Sequence[str], most: int) -> str:
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")


def studies(pair: Pair) -> Markup:
    """Describe both studies: responses, inputs and statics."""
    parts: list[object] = [
        tag("p", f"{counted(len(pair.runs[0]), 'pair')} of runs with the same ground motion and case name.")
    ]
    for name, study in zip(SIDES, pair.studies, strict=True):
        title = tag("h3", f"{name}: {study.study['title'] or ''} ", tag("code", study.directory))
        parts += [title, responses(study), studied.section(study, level="h4")]
        parts += [tag("h4", "Statics"), statics.section(study)]
    return join(*parts, _records_that_differ(*pair.studies))


def _records_that_differ(a: Finished, b: Finished) -> Markup:
    """List records that have the same name in both studies but are different motions; empty without any."""
    keys = ("pga_g", "pga_v_g", "npts", "dt_s")
    shared = [name for name in a.records if name in b.records]
    differing = [name for name in shared if any(not _same(a.records[name][key], b.records[name][key]) for key in keys)]
    if not differing:
        return Markup("")
    lead = tag("span", "Different motions under the same name", class_="alarm")
    return tag("p", lead, f": {_first(differing, 8)}.")


def _same(a: float | None, b: float | None) -> bool:
    return a is b if a is None or b is None else math.isclose(a, b, rel_tol=1e-9)


def difference(pair: Pair) -> Markup:
    """Show a diff of the study files, and the versions if they differ."""
    a, b = (study.study["text"].splitlines() for study in pair.studies)
    lines = difflib.unified_diff(a, b, "A", "B", n=1, lineterm="")
    versions = [{"rockbatch": study.info["rockbatch"], **study.info["versions"]}.items() for study in pair.studies]
    words = [" ".join(f"{name} {version}" for name, version in pairs) for pairs in versions]
    shown = "\n".join(lines)
    return join(
        tag("pre", tag("code", shown)) if shown else tag("p", "The study files are the same."),
        tag("p", f"Versions: A {words[0]}; B {words[1]}.") if words[0] != words[1] else "",
    )
