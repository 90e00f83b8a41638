"""The table of peaks in the terminal, as in the paper's Fig. 7, and remarks on the runs."""

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from rockbatch.checks.suite_target import NAMES
from rockbatch.common.lazy import pd
from rockbatch.common.observers import parts
from rockbatch.outcome.outcome import LEANS, Failure
from rockbatch.pier.bending import flexural_period
from rockbatch.pier.laws import without_ratcheting
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.limits import IN_MOTION, IN_MOTION_ERROR
from rockbatch.quantities.rows import with_case
from rockbatch.results.labelled import Item
from rockbatch.study import PIER_KEYS, Study
from rockbatch.terminal.naming import named
from rockbatch.terminal.streams import in_width

MOST_RUNS = 1000
"""Number of runs above which only the worst are printed."""


def summary(table: "pd.DataFrame", varied: tuple[str, ...], records: Mapping[str, str]) -> str:
    """Return θ_max/α as text: a block for each pier, a line for each record, a column for each case.

    Of more than :data:`MOST_RUNS` runs, only the ten largest values are listed. ``records`` maps the names of records, in order,
    to labels. A status other than "ok", or "lean" for a peak that is mostly lean, precedes its value.
    """
    runs = with_case(table)
    if len(runs) > MOST_RUNS:
        return _worst(runs.assign(record=runs["record"].map(records)), varied)
    place = {name: i for i, name in enumerate(records)}
    runs = runs.sort_values("record", key=lambda names: names.map(place), kind="stable")
    runs = runs.assign(record=runs["record"].map(records))
    pier_keys = [name for name in varied if name in PIER_KEYS]
    case_keys = [name for name in varied if name not in PIER_KEYS]
    rows = ["record", *(name for name in ("polarity", "scale") if runs[name].nunique() > 1)]
    if not pier_keys:
        return "Peak rotation theta_max/alpha\n" + _block(runs, rows, case_keys)
    blocks = []
    for values, block in runs.groupby(pier_keys, sort=False):
        title = f"Peak rotation theta_max/alpha, {named(pier_keys, values)}"
        blocks.append(f"{title}\n{_block(block, rows, case_keys)}")
    return "\n\n".join(blocks)


def _worst(runs: "pd.DataFrame", varied: tuple[str, ...]) -> str:
    """Return, as text, the number of runs of each status, and a table of the ten runs with the greatest rotations."""
    ended = ", ".join(f"{n} {status}" for status, n in runs["status"].value_counts().items())
    shown = ["record", "polarity", "scale", "case", *varied, "status", "theta_max_over_alpha", "theta_max_error"]
    largest = runs.nlargest(10, "theta_max_over_alpha")[shown]
    rows = [
        ["" if x != x else x if isinstance(x, str) else f"{x:.4g}" for x in row] for row in largest.to_numpy().tolist()
    ]
    return f"{len(runs)} runs: {ended}\nThe largest theta_max/alpha\n{in_width(shown, rows)}"


def warnings(table: "pd.DataFrame", varied: Sequence[str]) -> list[str]:
    """Return a sentence each on runs of ``table`` that an observer warns of, that rotate too far for linearised kinematics,
    lean, or slide; [] for none.

    ``varied`` are the keys by which an observer names a run.
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
        *(warning(table, varied) for warning in parts("summary.warning")),
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
        advice = f"; {share} the springs ratchet on free vibration: take spring = {laws}, or zeta of 0.2 or more"
    return f"{n:,} failed only after the motion: {IN_MOTION} has the peak until then, a lower bound{advice}"


def flexible(study: Study) -> list[str]:
    """Return a warning for each case whose flexural period, given or by rigidities, is too long for a rigid pier."""
    flexible_cases = [case for case in study.cases if flexural_period(case.pier) is not None]
    if not flexible_cases:
        return []
    from rockbatch.pier.statics import flexure, is_too_soft, sheet_of

    sheets = [(case, sheet_of(case.pier, case.base)) for case in flexible_cases]
    warnings = []
    for case, sheet in sheets:
        if is_too_soft(sheet):
            name = f"{case.name} {named(case.columns, case.columns.values())}".rstrip()
            warnings.append(f"{name}: {flexure(sheet)}".replace("α", "alpha"))
    return warnings


def _block(runs: "pd.DataFrame", rows: list[str], case_keys: list[str]) -> str:
    """Return a table of θ_max/α as text: a line for each set of values of columns ``rows``, a column for each case.

    A case includes the values of ``case_keys``; a cell without a run is empty.
    """
    cells: dict[str, dict[str, str]] = {}
    for run in runs.to_dict("records"):
        line = " ".join(f"{run[name]:g}" if name == "scale" else str(run[name]) for name in rows)
        varied = named(case_keys, [run[name] for name in case_keys])
        mark = run["theta_max_is"] if run["status"] == "ok" else run["status"]
        cell = f"{mark} {run['theta_max_over_alpha']:.4f}".lstrip()
        cells.setdefault(line, {})[f"{run['case']} {varied}".strip()] = cell
    cases = list(dict.fromkeys(case for line in cells.values() for case in line))
    lines = [[line, *(of_line.get(case, "") for case in cases)] for line, of_line in cells.items()]
    return in_width(["", *cases], lines)
