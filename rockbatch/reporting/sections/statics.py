"""Statics: what each pier bears on its base and how it swings, before any earthquake."""

from collections.abc import Mapping, Sequence
from typing import Any

from rockbatch.pier.figures import Sheet, statics
from rockbatch.pier.statics import FACTS, Statics, flexure, is_too_soft, sheet_of
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup, join, paragraphs, tag
from rockbatch.reporting.structure import base_of, in_words, pier_of
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import Head, alarm, table
from rockbatch.results.labels import quantity

MOST_CASES, ABREAST = 16, 8
"""Most cases that have a sheet, since each takes some milliseconds, and how many stand beside each other."""

LEGEND = (
    "All quasi-static, or by the energy of free rocking: nothing was simulated. Accelerations are steady and horizontal; an "
    "earthquake may exceed the static strength for moments, which tips the pier and need not overturn it. Friction and "
    "hysteretic dampers take part as on the way out, viscous ones bear nothing. Moments are about the pivot that bears more. "
    "Periods are those of swings that lose nothing, on elastic supports."
)

Named = Sequence[tuple[str, Statics]]


def section(finished: Finished) -> Markup:
    """Report the statics sheet of each case, with the moment–rotation curves and the periods."""
    sheets: list[tuple[str, Statics]] = []
    devices: list[str] = []
    for case in finished.info["cases"][:MOST_CASES]:
        pier = pier_of(case)
        base = None if pier is None else base_of(case, pier)
        if pier is not None and base is not None:
            sheets.append((_name(case), sheet_of(pier, base)))
            devices.append("; ".join(in_words(pier, device) for device in base.restraints))
    if not sheets:
        return Markup("")
    omitted = len(finished.info["cases"]) - MOST_CASES
    soft = [f"{name}: {flexure(sheet)}" for name, sheet in sheets if is_too_soft(sheet)]
    tables = [_table(sheets[i : i + ABREAST], devices[i : i + ABREAST]) for i in range(0, len(sheets), ABREAST)]
    return join(
        paragraphs(*map(alarm, soft)),
        *tables,
        tag(
            "figure",
            drawn(statics([Sheet(name, one.pier, one.equilibria, one.swings_at) for name, one in sheets])),
            class_="whole",
        ),
        tag("p", LEGEND, class_="legend"),
        paragraphs(f"The first {MOST_CASES} cases are shown; `rockbatch statics` shows all." if omitted > 0 else ""),
    )


def _name(case: Mapping[str, Any]) -> str:
    return " ".join([str(case["case"]), *(quantity(key, value, case=case) for key, value in case["columns"].items())])


def _table(sheets: Named, devices: Sequence[str]) -> Markup:
    """Return sheets beside each other, a row for each number that one of them has."""
    values = [sheet.row for _, sheet in sheets]
    rows = [[fact.heading, *(fact.written(row[fact.name]) for row in values), fact.meaning] for fact in FACTS]
    turned = ["" if sheet.towards == "either" else f"to the {sheet.towards}" for _, sheet in sheets]
    rows += [["direction", *turned, "the weaker one, of devices that differ"], ["devices", *devices, ""]]
    heads = [Head(""), *(Head(name) for name, _ in sheets), Head("")]
    return table(heads, [row for row in rows if any(row[1:-1])], prose=True, name="Statics")
