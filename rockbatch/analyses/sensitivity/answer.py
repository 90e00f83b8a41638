"""The answer of a sensitivity study in sentences: the inputs that matter most, and the effect of one alone."""

from collections.abc import Iterator, Sequence

from rockbatch.analyses.sensitivity.figures import symbol, written
from rockbatch.common.analyses import Entry
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.quantities.labels import plain
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.reporting.finished_analysis import answered, named, sentence
from rockbatch.reporting.labels import counted, heading
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.results.labelled import as_dicts

HARDLY = 0.05
"""Total index below which an input hardly matters."""
MOST_CASES = 3
"""Most cases that have a sentence each; of more the answer says in how many an input comes first."""
MOST_INPUTS = 4
"""Most inputs of a case that are named with their indices."""

Info = Entry
"""Content of sensitivity.json."""
Rows = Sequence[Entry]
"""Inputs of a case: rows of sensitivity.csv with their indices of sobol.csv, the greatest total index first."""


def answer(info: Info, swings: "pd.DataFrame", sobol: "pd.DataFrame") -> Markup:
    """Return a sentence on the most important inputs of each case, with doubts about their order, and remarks on runs.

    Above :data:`MOST_CASES` cases, one sentence says in how many of them an input comes first.
    """
    keys = ["case", *info["varied"]]
    merged = swings.merge(sobol, on=[*keys, "parameter"]).groupby(keys, sort=False, dropna=False)
    parts = (as_dicts(part.sort_values("total", ascending=False, kind="stable")) for _, part in merged)
    cases = {named(info, rows[0], keys): rows for rows in parts}
    subject = heading(f"{STATISTICS[info['statistic']].words} of θ_max/α over {counted(info['motions'], 'motion')}")
    if len(cases) > MOST_CASES:
        lines = [join("The ", subject, _in_most(list(cases.values())))]
    else:
        lines = [
            join(f"{case}: the " if len(cases) > 1 else "The ", subject, _of_case(rows, info["overturned"]))
            for case, rows in cases.items()
        ]
    return answered(*lines, remarks=_of_runs(info))


def _of_case(rows: Rows, overturned: float) -> Markup:
    """Return the rest of the sentence about a case, and one about the input that alone moves the answer most, if one does.

    If all answers are the same (NaN indices), the sentence says so. An answer of ``overturned`` is that "or more".
    """

    def written_answer(value: float) -> str:
        return plain(value, 3) + (" or more" if value >= overturned else "")

    if rows[0]["total"] != rows[0]["total"]:
        nothing = tag("span", "there is nothing to attribute to any of them", class_="undecided")
        return join(f" is {written_answer(rows[0]['answer_base'])} whatever the inputs are: ", nothing, ".")
    first, *others = rows
    shown = [row for row in others if row["total"] >= HARDLY][: MOST_INPUTS - 1]
    said = f" depends most on {symbol(first['parameter'])} (total Sobol index {_index(first)})"
    if shown:
        said += ", then " + ", ".join(f"{symbol(row['parameter'])} ({_index(row)})" for row in shown)
    if remaining := others[len(shown) :]:
        most = max(row["total"] + row["total_error"] for row in remaining)
        names = symbol(remaining[0]["parameter"]) if len(remaining) == 1 else f"the other {len(remaining)}"
        matter = "may matter, too" if most >= HARDLY else "hardly matters" if len(remaining) == 1 else "hardly matter"
        said += f"; {names} {matter} ({most:.2f} at most)"
    greatest = max(rows, key=lambda row: row["swing"])
    ends = [f"{written_answer(greatest[f'answer_{end}'])} at {written(greatest[end])}" for end in ("low", "high")]
    study = f"{written_answer(greatest['answer_base'])} in the study"
    moved = f" Alone {symbol(greatest['parameter'])} moves it from {ends[0]} to {ends[1]} ({study})."
    return join(sentence(said, _doubt(first, shown)), moved if greatest["swing"] > 0 else "")


def _index(row: Entry) -> str:
    return f"{row['total']:.2f}\u00a0±\u00a0{row['total_error']:.2f}"


def _doubt(first: Entry, shown: Rows) -> Iterator[str]:
    """Yield advice to take more samples if errors leave open which input is first, else if its error is over half its index.

    ``first`` has the greatest total index; ``shown`` are the inputs that are compared with it.
    """
    least = first["total"] - first["total_error"]
    alike = [symbol(row["parameter"]) for row in shown if row["total"] + row["total_error"] >= least]
    if alike:
        yield f"more samples would tell {symbol(first['parameter'])} and {', '.join(alike)} apart"
    elif first["total_error"] > 0.5 * first["total"]:
        yield "more samples would narrow that interval"


def _in_most(cases: Sequence[Rows]) -> Markup:
    """Return the rest of a sentence about many cases: which input comes first in how many, for up to four inputs."""
    known = [rows[0] for rows in cases if rows[0]["total"] == rows[0]["total"]]
    groups = sorted(grouped(known, lambda row: symbol(row["parameter"])).items(), key=lambda group: -len(group[1]))
    parts = []
    for name, rows in groups[:MOST_INPUTS]:
        totals = [row["total"] for row in rows]
        parts.append(f"on {name} in {len(rows)} (total Sobol index {min(totals):.2f} to {max(totals):.2f})")
    if len(known) < len(cases):
        parts.append(f"on none of the inputs in {len(cases) - len(known)}")
    return join(f" depends most, in {len(cases)} cases, {', '.join(parts)}.")


def on_coverage(info: Info) -> str:
    """Return a sentence on how many further records exceed a quantile, or that its motions are not independent.

    "" for other statistics, and if an earlier version did not write the number of stations.
    """
    statistic, motions, stations = STATISTICS[info["statistic"]], info["motions"], info.get("stations")
    if statistic.coverage is None or stations is None:
        return ""
    if stations == motions:
        return f"The {statistic.words} is {statistic.coverage(motions)}."
    shared = f"{counted(motions, 'motion')} of {counted(stations, 'station')}"
    return f"The {statistic.words} is of {shared}, which are not independent."


def _of_runs(info: Info) -> Iterator[str]:
    """Yield remarks on the coverage of a quantile, on runs that overturned or flew, with their value, and on failed runs."""
    if coverage := on_coverage(info):
        yield coverage
    number, runs = info["statuses"], counted(sum(info["statuses"].values()), "run")
    if ended := number.get("overturned", 0) + number.get("flight", 0):
        yield f"{ended} of {runs} overturned or were ended by flight, and count as {info['overturned']:g} here."
    if failed := number.get("failed", 0):
        yield f"{failed} of {runs} failed, and count with their best value."
