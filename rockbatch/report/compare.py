"""Two studies side by side: runs of the same record, direction, scale and case are matched by name."""

import difflib
import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

from rockbatch.checks import Verdict
from rockbatch.report.document import Section, document, paragraphs
from rockbatch.report.finished import Finished, as_dicts, worst_first
from rockbatch.report.labels import head, quantity, symbol
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.sections import peak_rotations, statistics, summary, verdicts
from rockbatch.report.sections.peaks import on_scale, outcome
from rockbatch.report.table import MOST_ROWS, THETA, THETA_FORMAT, Head, table, told_apart
from rockbatch.results.columns import COLUMNS
from rockbatch.study import PIER_KEYS

if TYPE_CHECKING:
    import pandas as pd

SIDES = ("A", "B")


class Side(NamedTuple):
    """One of the studies, and what its checks came to."""

    study: Finished
    verdicts: list[Verdict]


@dataclass(frozen=True, eq=False)
class Matched:
    """Runs of two studies that belong together.

    ``runs`` are of A and of B, row by row; those of B have A's places of series and pier. ``only`` are those that the
    other study does not have, or has more than once. ``keys`` are the columns that were matched.
    """

    runs: "tuple[pd.DataFrame, pd.DataFrame]"
    only: "tuple[pd.DataFrame, pd.DataFrame]"
    keys: list[str]


def match(a: Finished, b: Finished) -> Matched:
    """Match runs by record, polarity, scale, case and the values of the keys that both studies vary."""

    both = [key for key in a.info["varied"] if key in b.info["varied"] and key != "vertical"]
    keys = ["record", "polarity", "scale", "case", *both]
    if "" not in {*a.runs["with_vertical"], *b.runs["with_vertical"]}:
        keys.append("with_vertical")

    def places(study: Finished, name: str) -> "pd.DataFrame":
        found = study.runs[keys].astype({key: object for key in both}).fillna({key: "" for key in both})
        found[name] = range(len(found))
        return found.drop_duplicates(keys, keep=False)

    pairs = places(a, "a").merge(places(b, "b"), on=keys).sort_values("a", kind="stable")
    first, second = a.runs.iloc[pairs["a"]], b.runs.iloc[pairs["b"]]
    shared = {name: first[name].to_numpy() for name in ("series", "pier", "with_vertical")}
    left = a.runs.drop(index=first.index), b.runs.drop(index=second.index)
    return Matched((first, second.assign(**shared)), left, keys)


def comparison(first: tuple[Finished, list[Verdict]], second: tuple[Finished, list[Verdict]]) -> str:
    """The whole page as HTML."""
    a, b = Side(*first), Side(*second)
    matched = match(a.study, b.study)
    named = _named(a.study, matched.keys)
    sections = [
        Section("What is compared", "studied", _studied(a, b, matched)),
        Section("Does it pass", "checks", _checks(a, b)),
        Section("Peak rotations", "figure", _figures(named, matched)),
        Section("Every pair of runs", "peaks", _pairs(matched)),
        Section("The suite in each case", "suite", _suites(a.study, b.study, named, matched)),
        Section("Only in one", "only", _only(a.study, b.study, matched)),
        Section("How the study files differ", "difference", _difference(a.study, b.study)),
    ]
    titles = [side.study.info["study"]["title"] or side.study.saved.directory.name for side in (a, b)]
    title = " against ".join(titles) if titles[0] != titles[1] else f"{titles[0]}: two studies"
    return document("Rocking response of stepping piers, two studies", title, sections)


def _named(study: Finished, keys: list[str]) -> Finished:
    """The study with series called after what was matched: the rest may differ in the other one."""
    varied = study.info["varied"]
    of_foundation = [key for key in varied if key not in PIER_KEYS and key != "vertical"]
    series = []
    for key, place in study.places.items():
        words = [
            quantity(name, value)
            for name, value in zip(of_foundation, key[1:], strict=True)
            if name in keys and value != ""
        ]
        series.append(replace(study.series[place], label=f"{key[0]}: {', '.join(words)}" if words else str(key[0])))
    return replace(study, series=series)


def _studied(a: Side, b: Side, matched: Matched) -> Markup:
    parts: list[object] = [
        tag("p", f"{summary.counted(len(matched.runs[0]), 'pair')} of runs with the same ground motion and case name.")
    ]
    for name, side in zip(SIDES, (a, b), strict=True):
        title = side.study.info["study"]["title"] or ""
        told = join(f"{name}: {title} ", tag("code", side.study.saved.directory))
        parts += [tag("h3", told), tag("p", summary.worst(side.study)), summary.studied(side.study, level="h4")]
    return join(*parts, paragraphs(_other_motions(a.study, b.study)))


def _other_motions(a: Finished, b: Finished) -> Markup:
    """Records of one name that are not the same motion."""
    keys = ("pga_g", "pga_v_g", "npts", "dt_s")
    other = [
        name for name in a.records
        if name in b.records and any(not _same(a.records[name][key], b.records[name][key]) for key in keys)
    ]  # fmt: skip
    if not other:
        return Markup("")
    listed = ", ".join(other[:8]) + (f" and {len(other) - 8} more" if len(other) > 8 else "")
    return join(tag("span", "Not the same motion in both", class_="alarm"), f", though of one name: {listed}.")


def _same(one: float | None, other: float | None) -> bool:
    return one is other if one is None or other is None else math.isclose(one, other, rel_tol=1e-9)


def _checks(a: Side, b: Side) -> Markup:
    parts: list[object] = []
    for name, side in zip(SIDES, (a, b), strict=True):
        parts += [tag("h3", name), tag("div", verdicts.answer(side.verdicts))]
        if side.verdicts:
            parts += [verdicts.legend(), verdicts.matrix(side.verdicts)]
    return join(*parts)


def _figures(named: Finished, matched: Matched) -> Markup:
    """Panels with the markers of both studies; of both directions, the worse one."""
    import pandas as pd

    if matched.runs[0].empty:
        return Markup("")
    worse = []
    for name, runs in zip(SIDES, matched.runs, strict=True):
        kept = worst_first(runs, len(runs)).drop_duplicates(["record", "series", "pier", "scale", "with_vertical"])
        worse.append(kept.assign(side=name))
    both = replace(named, runs=pd.concat(worse, ignore_index=True))
    lines = both.runs["series"].map(lambda place: named.series[place].rigid).any()
    caption = [
        "Largest rotation over slenderness, ", THETA, ": filled markers A, open markers B",
        "; lines: rigid base, B dashed" if lines else "",
        "; the worse direction of each motion" if matched.runs[0]["polarity"].nunique() > 1 else "", ".",
    ]  # fmt: skip
    return peak_rotations.figures(both, caption, side="side")


def _pairs(matched: Matched) -> Markup:
    a, b = matched.runs
    if a.empty:
        return Markup("")
    worse = a["theta_max_over_alpha"].fillna(0).to_numpy() < b["theta_max_over_alpha"].fillna(0).to_numpy()
    worst = a.assign(theta_max_over_alpha=a["theta_max_over_alpha"].where(~worse, b["theta_max_over_alpha"].to_numpy()))
    worst["status"] = [max(pair, key=_badness) for pair in zip(a["status"], b["status"], strict=True)]
    order = a.index.get_indexer(worst_first(worst, MOST_ROWS).index)
    names = [key for key in matched.keys if key in ("record", "case") or a[key].nunique() > 1]
    heads = [Head(symbol(name)) for name in names]
    heads += [
        Head("A", THETA_FORMAT, over=THETA),
        Head("B", THETA_FORMAT, over=THETA),
        Head("B / A", ".3f", over=THETA),
    ]
    more = [column for column in COLUMNS.values() if column.suite and column.name != "theta_max_over_alpha"]
    heads += [Head(side, over=head(column).says, form=head(column).form) for column in more for side in SIDES]
    pairs = as_dicts(a.iloc[order]), as_dicts(b.iloc[order])
    rows = []
    for place in range(len(order)):
        pair = pairs[0][place], pairs[1][place]
        shown = [outcome(run) for run in pair]
        ratio = _ratio(*(run["theta_max_over_alpha"] if run["status"] == "ok" else math.nan for run in pair))
        others = (on_scale(column.name, run[column.name]) for column in more for run in pair)
        rows.append([*(pair[0][name] for name in names), *shown, ratio, *others])
    return join(told_apart(len(order), len(a), "worst"), table(heads, rows, sortable=True, name="Pairs of runs"))


def _badness(status: str) -> int:
    return ("ok", "failed", "flight", "overturned").index(status)


def _ratio(a: float, b: float) -> float | None:
    return b / a if a > 0 and b == b else None


def _suites(a: Finished, b: Finished, named: Finished, matched: Matched) -> Markup:
    """Statistics over the runs that both have: another suite would be another statistic."""
    if matched.runs[0].empty:
        return Markup("")
    with_vertical = [any(record["pga_v_g"] is not None for record in study.info["records"]) for study in (a, b)]
    sides = list(SIDES)
    if with_vertical[0] != with_vertical[1]:
        sides = [
            f"{name}, {'with' if has else 'without'} vertical" for name, has in zip(SIDES, with_vertical, strict=True)
        ]
    keys = ["scale", "pier", "series", "with_vertical"]
    runs = dict(zip(sides, matched.runs, strict=True))
    names, heads = statistics.rows_of(named, matched.runs[0], keys)
    grouped = {side: dict(list(same.groupby(keys))) for side, same in runs.items()}
    return join(tag("p", "Over the pairs of runs only."), statistics.tables(grouped, names, heads))


def _only(a: Finished, b: Finished, matched: Matched) -> Markup:
    rows: list[list[Any]] = []
    for name, study, runs in zip(SIDES, (a, b), matched.only, strict=True):
        grouped = runs.groupby(["series", "pier", "scale", "polarity", "with_vertical"], sort=False)
        for _, same in grouped:
            records = list(dict.fromkeys(same["record"]))
            listed = ", ".join(records[:6]) + (f" and {len(records) - 6} more" if len(records) > 6 else "")
            rows.append([name, study.which(same.iloc[0]), len(same), listed])
    return (
        table([Head("study"), Head("case"), Head("runs"), Head("records")], rows, name="Only in one")
        if rows
        else Markup("")
    )


def _difference(a: Finished, b: Finished) -> Markup:
    texts = [study.info["study"]["text"].splitlines() for study in (a, b)]
    lines = list(difflib.unified_diff(texts[0], texts[1], "A", "B", n=1, lineterm=""))
    versions = [
        " ".join(
            f"{name} {version}" for name, version in {"rockbatch": s.info["rockbatch"], **s.info["versions"]}.items()
        )
        for s in (a, b)
    ]
    told = tag("p", f"Versions: A {versions[0]}; B {versions[1]}.") if versions[0] != versions[1] else ""
    if not lines:
        return join(tag("p", "The study files are the same."), told)
    return join(tag("pre", tag("code", "\n".join(lines))), told)
