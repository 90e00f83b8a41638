"""``rockbatch statics``: what each pier of a study bears and how it swings, without a run."""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rockbatch.checks.remarks import pulled_supports, weak_supports
from rockbatch.commands.summary import flexible
from rockbatch.common.files import csv_text, write_output
from rockbatch.motions import Motion
from rockbatch.pier.statics import FACTS, Statics, statics
from rockbatch.results.run_json import describe_case
from rockbatch.study import Case, Study, load_study
from rockbatch.terminal.naming import named
from rockbatch.terminal.streams import in_width, say, show

MOST_CASES = 12
"""Cases of a study beyond which their curves are not printed."""

Sheets = Sequence[tuple[Case, Statics]]


def main(arguments: argparse.Namespace) -> int:
    """Print the statics sheets of a study, and write them if asked."""
    study = load_study(arguments.file, motions=Motion("none", 0.01, np.zeros(2)))
    sheets = [(case, statics(case.pier, case.base)) for case in study.cases]
    described = [describe_case(case) for case in study.cases]
    for remark in filter(None, (weak_supports(described), pulled_supports(described))):
        show(f"{remark}\n")
    show(table(sheets))
    if len(sheets) <= MOST_CASES:
        for case, sheet in sheets:
            show(f"\n{name_of(case)}\n{rotations(sheet)}")
    else:
        say(f"{len(sheets)} cases: their curves are written with --curves FILE")
    for warning in flexible(study):
        say(warning)
    if any(getattr(device, "kind", "") == "viscous" for case in study.cases for device in case.base.restraints):
        say("viscous dampers carry no force at rest and enter none of these numbers")
    if arguments.csv:
        _write(arguments.csv, study, [fact.name for fact in FACTS], [(case, [sheet.row]) for case, sheet in sheets])
    if arguments.curves:
        curves = [(case, sheet.curve.to_dict("records")) for case, sheet in sheets]
        columns = [str(name) for name in max((sheet.curve.columns for _, sheet in sheets), key=len)]
        _write(arguments.curves, study, columns, curves)
    return 0


def name_of(case: Case) -> str:
    """Return the name of a case with its varied values."""
    return f"{case.name} {named(case.columns, case.columns.values())}".rstrip()


def table(sheets: Sheets) -> str:
    """Return the sheets side by side: a line for each quantity that any of them has."""
    all_of_them = [sheet.row for _, sheet in sheets]
    rows = [(fact, [row[fact.name] for row in all_of_them]) for fact in FACTS]
    lines = [
        [fact.heading.replace("θ", "theta").replace("α", "alpha"), *map(fact.written, values)]
        for fact, values in rows
        if any(v is not None for v in values)
    ]
    return in_width(["", *(name_of(case) for case, _ in sheets)], lines)


def rotations(sheet: Statics) -> str:
    """Return the moment–rotation curve and the swings of a sheet at some rotations, for a terminal."""
    curve, swings, alpha = sheet.equilibria, sheet.swings_at, sheet.pier.alpha
    angles = np.unique([*curve.theta[[0, -1]], sheet.lift_off_rad or 0.0, sheet.strength_rad or 0.0, *swings.amplitude])
    size, unit = (1.0, "m") if sheet.weight_kN is None else (sheet.weight_kN, "kN m")

    def cells_of(values: Any, form: str, scale: float = 1.0) -> list[str]:
        return [format(scale * value, form) for value in np.interp(angles, curve.theta, values)]

    def of_swings(values: Any, form: str) -> list[str]:
        known = dict(zip(swings.amplitude, values, strict=True))
        return ["" if np.isnan(known.get(theta, np.nan)) else format(known[theta], form) for theta in angles]

    form = "z.4f" if sheet.weight_kN is None else "z,.0f"
    columns = {
        "theta/alpha": [f"{theta / alpha:.4g}" for theta in angles],
        "theta [rad]": [f"{theta:.4g}" for theta in angles],
        "held by [g]": cells_of(curve.acceleration, "z.4f"),
        f"moment [{unit}]": cells_of(curve.moment, form, size),
        "of tendons": cells_of(curve.tendons, form, size) if curve.tendons.any() else [],
        "of stops, springs": cells_of(curve.stops, form, size) if curve.stops.any() else [],
        "of dampers": cells_of(curve.dampers, form, size) if curve.dampers.any() else [],
        "period [s]": of_swings(swings.period, ".3g"),
        "damping": of_swings(swings.impact_damping, ".2%"),
    }
    shown = {head: cells for head, cells in columns.items() if any(cells)}
    return in_width(list(shown), list(zip(*shown.values(), strict=True)))


def _write(path: Path, study: Study, columns: Sequence[str], rows: Sequence[tuple[Case, list[Any]]]) -> None:
    """Write a table whose rows begin with the case and the varied values."""
    lines = [{"case": case.name} | case.columns | line for case, of_case in rows for line in of_case]
    write_output(path, csv_text(["case", *study.varied, *columns], lines))
    say(str(path))
