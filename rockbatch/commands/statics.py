"""``rockbatch statics``: print static strength and rocking periods of each pier of a study."""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from rockbatch.checks.remarks import pulled_supports, weak_supports
from rockbatch.commands.summary import flexible
from rockbatch.common.files import csv_text, write_output
from rockbatch.common.grouping import grouped
from rockbatch.pier.statics import FACTS, Statics
from rockbatch.results.run_json import describe_case
from rockbatch.study import Study
from rockbatch.terminal.streams import in_width, say, show
from rockbatch.workflow.statics import statics, without_records

MOST_CASES = 12
"""Most cases whose curves are printed."""

Array = npt.NDArray[np.float64]
Line = Mapping[Any, object]


def main(arguments: argparse.Namespace) -> int:
    """Print the statics sheets of a study, and write them and their curves if requested; return 0."""
    study = without_records(arguments.file)
    sheets = statics(study)
    entries = [describe_case(case) for case in study.cases]
    for remark in filter(None, (weak_supports(entries), pulled_supports(entries))):
        show(f"{remark}\n")
    show(table(sheets))
    if len(sheets) <= MOST_CASES:
        named = ((name, rotations(sheet)) for name, sheet in sheets.items())
        for curve, alike in grouped(named, lambda one: one[1]).items():
            show(f"\n{', '.join(name for name, _ in alike)}\n{curve}")
    else:
        say(f"{len(sheets)} cases: use --curves FILE for their curves")
    for warning in flexible(study):
        say(warning)
    if any(device.law == "viscous" for case in study.cases for device in case.base.restraints):
        say("viscous dampers carry no static force and are left out of these numbers")
    if arguments.csv:
        _write(arguments.csv, study, [fact.name for fact in FACTS], [[sheet.row] for sheet in sheets.values()])
    if arguments.curves:
        curves = [sheet.curve.to_dict("records") for sheet in sheets.values()]
        columns = [str(name) for name in max((sheet.curve.columns for sheet in sheets.values()), key=len)]
        _write(arguments.curves, study, columns, curves)
    return 0


def table(sheets: Mapping[str, Statics]) -> str:
    """Return the named sheets side by side as text: a column for each case, and a line for each quantity that any of them has."""
    lines = []
    for fact in FACTS:
        values = [sheet.row[fact.name] for sheet in sheets.values()]
        if any(value is not None for value in values):
            lines.append([fact.heading.replace("θ", "theta").replace("α", "alpha"), *map(fact.written, values)])
    return in_width(["", *sheets], lines)


def rotations(sheet: Statics) -> str:
    """Return the moment–rotation curve, free-rocking periods and damping of a sheet at selected rotations as text.

    The rotations are the curve's ends, lift-off, that of greatest strength, and the amplitudes of swings. Moments are in kN m, or
    over the weight [m] if the mass is not known; empty columns are left out.
    """
    curve, swings, alpha = sheet.equilibria, sheet.swings_at, sheet.pier.alpha
    angles = np.unique([*curve.theta[[0, -1]], sheet.lift_off_rad or 0.0, sheet.strength_rad or 0.0, *swings.amplitude])
    size, unit = (1.0, "m") if sheet.weight_kN is None else (sheet.weight_kN, "kN m")

    def interpolated(values: Array, form: str, scale: float = 1.0) -> list[str]:
        return [format(scale * value, form) for value in np.interp(angles, curve.theta, values)]

    def of_swings(values: Array, form: str) -> list[str]:
        """Format values at the amplitudes of swings; "" at other angles and for NaN."""
        known = dict(zip(swings.amplitude, values, strict=True))
        return ["" if np.isnan(known.get(theta, np.nan)) else format(known[theta], form) for theta in angles]

    form = "z.4f" if sheet.weight_kN is None else "z,.0f"
    columns = {
        "theta/alpha": [f"{theta / alpha:.4g}" for theta in angles],
        "theta [rad]": [f"{theta:.4g}" for theta in angles],
        "held by [g]": interpolated(curve.acceleration, "z.4f"),
        f"moment [{unit}]": interpolated(curve.moment, form, size),
        "pressed": [] if sheet.contact_share is None else interpolated(sheet.contact_share, ".0%"),
        "of tendons": interpolated(curve.tendons, form, size) if curve.tendons.any() else [],
        "of stops, springs": interpolated(curve.stops, form, size) if curve.stops.any() else [],
        "of dampers": interpolated(curve.dampers, form, size) if curve.dampers.any() else [],
        "period [s]": of_swings(swings.period, ".3g"),
        "damping": of_swings(swings.impact_damping, ".2%"),
    }
    shown = {head: cells for head, cells in columns.items() if any(cells)}
    return in_width(list(shown), list(zip(*shown.values(), strict=True)))


def _write(path: Path, study: Study, columns: Sequence[str], rows: Sequence[Sequence[Line]]) -> None:
    """Write a CSV of the rows of each case, which begin with case and varied values, and print its path."""
    cases = zip(study.cases, rows, strict=True)
    lines = [{"case": case.name, **case.columns, **line} for case, of_case in cases for line in of_case]
    write_output(path, csv_text(["case", *study.varied, *columns], lines))
    say(str(path))
