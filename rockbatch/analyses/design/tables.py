"""Tables of a design: the verdict at every value, and intervals of values with one verdict."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rockbatch.analyses.design.search import REFUSED, Interval, intervals
from rockbatch.analyses.design.study import DesignSpec
from rockbatch.analyses.design.trials import Design, Judged, Trial, worse
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.quantities.demands import INTERACTION, SECTIONS
from rockbatch.quantities.design import BOUND

RUNS, CHECKS = "design_runs.csv", "design_checks.csv"
VALUES, INTERVALS = "design_values.csv", "design.csv"
BESIDE = {SECTIONS: "design_sections.csv", INTERACTION: "design_interaction.csv"}
"""Files of the rows beside those of the runs, by the names that a batch has for them."""
GOVERNING = ("check", "under_bound", "at_scale", "station", "record", "ratio")
"""Columns of the check that governs: its name, the bound and scale at which it does, the run, and demand over limit."""
ENDS = ("below", "above")
RECORDS = ("record", *(f"{end}_record" for end in ENDS))
"""Columns with the name of a record."""
_OF_INTERVAL = ("verdict", "low", "high", "values", "widest_step")
_OF_END = ("", "_verdict", *(f"_{name}" for name in GOVERNING), "_reason")

Judgements = Mapping[Trial, Judged]


def value_columns(spec: DesignSpec, varied: Sequence[str]) -> list[str]:
    """Return the columns of design_values.csv: case, ``varied`` but for the bound, the keys of ``spec``, verdict and why."""
    return ["case", *_of_designs(varied), *spec.paths, "verdict", *GOVERNING, "reason"]


def interval_columns(spec: DesignSpec, varied: Sequence[str]) -> list[str]:
    """Return the columns of design.csv: case, ``varied`` but for the bound, later keys of ``spec``, the interval and its ends."""
    ends = [f"{end}{name}" for end in ENDS for name in _OF_END]
    return ["case", *_of_designs(varied), *spec.paths[1:], *_OF_INTERVAL, *ends]


def _of_designs(varied: Sequence[str]) -> list[str]:
    return [name for name in varied if name != BOUND]


def values_table(judged: Judgements, spec: DesignSpec, varied: Sequence[str]) -> "pd.DataFrame":
    """Return a row for each value of each design, with the verdict and the check that governs it.

    Rows are sorted by case, then by the value of the second key, if any, then of the first.
    """
    rows = [
        {"case": trial.design.case, **dict(trial.design.columns), **dict(zip(spec.paths, trial.values, strict=True))}
        | {"verdict": found.verdict, **_governing(found), "reason": found.reason}
        for trial, found in sorted(judged.items(), key=lambda item: (item[0].design.case, item[0].values[::-1]))
    ]
    return pd.DataFrame(rows, columns=value_columns(spec, varied))


def intervals_table(
    judged: Judgements, spec: DesignSpec, varied: Sequence[str], designs: Sequence[Design]
) -> "pd.DataFrame":
    """Return a row for each interval of values of the first key, of each design and value of the second key."""
    rows = [row for design in designs for row in _of_design(judged, spec, design)]
    return pd.DataFrame(rows, columns=interval_columns(spec, varied))


def _of_design(judged: Judgements, spec: DesignSpec, design: Design) -> Iterator[dict[str, Any]]:
    of_design = {trial.values: found for trial, found in judged.items() if trial.design == design}
    for others, values in sorted(grouped(of_design, lambda values: values[1:]).items()):
        line = {value[0]: of_design[value] for value in values}
        named = {"case": design.case, **dict(design.columns), **dict(zip(spec.paths[1:], others, strict=True))}
        for interval in intervals({value: found.verdict for value, found in line.items()}):
            yield named | _row(interval, line)


def _row(interval: Interval, line: Mapping[float, Judged]) -> dict[str, Any]:
    """Return the cells of an interval: verdict, its ends, number of values, widest step.

    For each end with a neighbour beyond it, ``below`` and ``above``, also that value, its verdict, and what governs the worse of
    the two values there, as "below_check".
    """
    verdict, low, high, below, above, values, widest = interval
    row: dict[str, Any] = dict(zip(_OF_INTERVAL, (verdict, low, high, values, widest), strict=True))
    for end, inner, outer in zip(ENDS, (low, high), (below, above), strict=True):
        if outer is not None:
            governs = worse(line[outer], line[inner])
            row |= {end: outer, f"{end}_verdict": line[outer].verdict, f"{end}_reason": governs.reason}
            row |= {f"{end}_{name}": value for name, value in _governing(governs).items()}
    return row


def _governing(found: Judged) -> dict[str, Any]:
    """Return the cells :data:`GOVERNING` of the check that governs, from check to ratio; {} if the study is refused or no check
    applies.
    """
    verdict = found.governing
    if verdict is None:
        return {}
    cells = (
        verdict.check,
        verdict.columns.get(BOUND, ""),
        verdict.scale,
        verdict.station,
        verdict.record,
        verdict.ratio,
    )
    return dict(zip(GOVERNING, cells, strict=True))


def refusals(judged: Judgements) -> Iterator[dict[str, Any]]:
    """Yield the entries of design.json on values at which the study is refused: ``case``, ``values`` and ``reason``, sorted by
    case.
    """
    for trial, found in sorted(judged.items()):
        if found.verdict == REFUSED:
            yield {"case": trial.design.case, "values": list(trial.values), "reason": found.reason}


def is_known(value: object) -> bool:
    """Return whether a cell of a table is filled: neither empty nor NaN."""
    return value is not None and value != "" and not (isinstance(value, float) and math.isnan(value))
