"""The table of peaks in the terminal, as in the paper's Fig. 7, and remarks on the runs."""

import textwrap
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from rockbatch.checks.suite_target import NAMES
from rockbatch.common.lazy import pd
from rockbatch.common.observers import parts
from rockbatch.outcome.outcome import LEANS, Failure
from rockbatch.pier.bending import flexural_period
from rockbatch.pier.laws import without_ratcheting
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.labels import scaled_by
from rockbatch.quantities.limits import IN_MOTION, IN_MOTION_ERROR
from rockbatch.results.labelled import Item, Labelled, Row, as_dicts, names_of
from rockbatch.results.run_json import describe_case
from rockbatch.study import Study
from rockbatch.terminal.streams import in_width

MOST_RUNS = 1000
"""Number of runs above which only the worst are printed."""
ALSO: Mapping[str, Callable[[Any], str]] = {
    "polarity": lambda polarity: "reversed" if polarity == "-" else "",
    "scale": scaled_by,
    "with_vertical": str,
}
"""Words for the columns in which runs of one record and case differ."""
_PEAK = ("theta_max_over_alpha", "theta_max_error")
_WRAPPED = 16  # characters per line of a head


def summary(results: Labelled, records: Mapping[str, str]) -> str:
    """Return θ_max/α as text: a block for each pier, a line for each record, a column for each case.

    Of more than :data:`MOST_RUNS` runs, only the ten largest values are listed. ``records`` maps the names of records, in order,
    to labels. A status other than "ok", or "lean" for a peak that is mostly lean, precedes its value.
    """
    runs = results.runs
    if len(runs) > MOST_RUNS:
        return _worst(runs, records, results.case_of)
    place = {name: i for i, name in enumerate(records)}
    runs = runs.sort_values("record", key=lambda names: names.map(place), kind="stable")
    also = {name: words for name, words in ALSO.items() if runs[name].nunique() > 1}
    labels = [series.label for series in results.series]
    blocks = []
    for pier in sorted(runs["pier"].unique()):
        title = ", ".join(filter(None, ("Peak rotation theta_max/alpha", results.piers[pier])))
        blocks.append(f"{title}\n{_block(as_dicts(runs[runs['pier'] == pier]), records, also, labels)}")
    return "\n\n".join(blocks)


def _worst(runs: "pd.DataFrame", records: Mapping[str, str], case_of: Callable[[Row], str]) -> str:
    """Return, as text, the number of runs of each status, and a table of the ten runs with the greatest rotations."""
    ended = ", ".join(f"{n} {status}" for status, n in runs["status"].value_counts().items())
    rows = [
        [
            *(records[run["record"]], case_of(run), run["status"]),
            *(f"{run[name]:.4g}" if run[name] == run[name] else "" for name in _PEAK),
        ]
        for run in as_dicts(runs.nlargest(10, _PEAK[0]))
    ]
    head = ["record", "case", "status", *_PEAK]
    return f"{len(runs)} runs: {ended}\nThe largest theta_max/alpha\n{in_width(head, rows, names=2)}"


def warnings(table: "pd.DataFrame", case_of: Callable[["pd.Series[Any]"], str]) -> list[str]:
    """Return a sentence each on runs of ``table`` that an observer warns of, that rotate too far for linearised kinematics,
    lean, or slide; [] for none.

    ``case_of`` names the case of a run in the warnings of observers; the other sentences count runs.
    """

    def counted(runs: npt.NDArray[np.bool_], singular: str, plural: str) -> str:
        """Return the words for the number of these runs, in singular or plural; "" for none."""
        n = int(runs.sum())
        return "" if n == 0 else singular if n == 1 else plural.format(n)

    runs = Rows(table)
    rotate = counted(runs.facts("beyond_linearised"), "1 run rotates", "{} runs rotate")
    lean = counted(runs.texts("theta_max_is") == LEANS, "of 1 run, marked lean, is", "of {} runs, marked lean, is")
    slide = counted(runs.facts("slides"), "1 run demands", "{} runs demand")
    beyond = 'too far for linearised kinematics; see the column note, and run kinematics = "finite"'
    leans = (
        "mostly the lean of a yielded base; the column note gives the rocking about it, and rocking = true under [output] "
        "adds a column for all runs"
    )
    slides = "more friction than the interface has: the pier would slide, which is not modelled; see the column note"
    sentences = [
        *(warning(table, case_of) for warning in parts("section.warning")),
        rotate and f"{rotate} {beyond}",
        lean and f"theta_max/alpha {lean} {leans}",
        slide and f"{slide} {slides}",
    ]
    return [sentence for sentence in sentences if sentence]


def of_targets(info: Item) -> list[str]:
    """Return the remarks on the target spectra in ``info``, the content of run.json, a sentence each; [] without targets."""
    targets = (info.get(name) or {} for name in NAMES)
    return [f"target spectrum: {remark}" for target in targets for remark in target.get("remarks") or ()]


def failed_later(runs: "pd.DataFrame") -> str:
    """Return a sentence on the runs that failed after their motion, whose peaks are lower bounds; empty without any."""
    failed = (runs["status"] == "failed") & runs[IN_MOTION_ERROR].notna()
    if not failed.any():
        return ""
    ratchet = int((runs.loc[failed, "failure"] == Failure.RATCHETS).sum())
    n, advice = int(failed.sum()), ""
    if ratchet:
        share = "in all of them" if ratchet == n else f"in {ratchet:,}"
        laws = without_ratcheting("or")
        advice = f"; {share} the springs ratchet in free vibration: take spring = {laws}, or zeta of 0.2 or more"
    return f"{n:,} failed only after the motion: {IN_MOTION} has the peak until then, a lower bound{advice}"


def flexible(study: Study) -> list[str]:
    """Return a warning for each case whose flexural period, given or by rigidities, is too long for a rigid pier."""
    flexible_cases = [case for case in study.cases if flexural_period(case.pier) is not None]
    if not flexible_cases:
        return []
    from rockbatch.pier.statics import flexure, is_too_soft, sheet_of

    sheets = [(case, sheet_of(case.pier, case.base)) for case in flexible_cases]
    names = names_of(map(describe_case, study.cases), study.varied, study.text)
    return [
        f"{names.named_case(case.name, case.columns, study.varied)}: {flexure(sheet)}"
        for case, sheet in sheets
        if is_too_soft(sheet)
    ]


def _block(
    runs: Sequence[Row],
    records: Mapping[str, str],
    also: Mapping[str, Callable[[Any], str]],
    labels: Sequence[str],
) -> str:
    """Return a table of θ_max/α as text: a line for each record and its values of the columns ``also``, a column for each case.

    A cell without a run is empty, a run without a peak has its status alone.
    """
    cells: dict[str, dict[int, str]] = {}
    for run in runs:
        line = ", ".join(filter(None, (records[run["record"]], *(words(run[name]) for name, words in also.items()))))
        mark, peak = run["theta_max_is"] if run["status"] == "ok" else run["status"], run["theta_max_over_alpha"]
        cells.setdefault(line, {})[run["series"]] = " ".join(
            filter(None, (mark, "" if peak != peak else f"{peak:.4f}"))
        )
    places = sorted({place for of_line in cells.values() for place in of_line})
    heads = [textwrap.wrap(labels[place], _WRAPPED, break_long_words=False) for place in places]
    depth = max(map(len, heads))
    top = [["", *line] for line in zip(*([""] * (depth - len(head)) + head for head in heads), strict=True)]
    lines = [[line, *(of_line.get(place, "") for place in places)] for line, of_line in cells.items()]
    return in_width(top[0], [*top[1:], *lines])
