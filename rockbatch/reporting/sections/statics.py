"""Statics: static strength and rocking periods of each pier, without records."""

from collections.abc import Sequence

from rockbatch.pier.figures import Sheet, statics
from rockbatch.pier.statics import FACTS, Statics, flexure, is_too_soft, sheet_of
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup, join, paragraphs, tag
from rockbatch.reporting.structure import base_of, device_in_words, pier_of
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import Head, alarm, table

MOST_CASES, ABREAST = 16, 8
"""Most cases with a statics sheet, since each takes some milliseconds, and columns of one table."""

LEGEND = (
    "Statics and energy only; no time history was run. Accelerations are steady and horizontal; an earthquake may briefly "
    "exceed the static strength, which tips the pier but need not overturn it. Friction and hysteretic dampers act as in "
    "loading; viscous dampers carry no static force. Moments are about the more heavily loaded pivot. Periods are undamped, "
    "on elastic supports."
)

Named = Sequence[tuple[str, Statics]]


def section(finished: Finished) -> Markup:
    """Return the statics of the first :data:`MOST_CASES` cases: numbers, moment–rotation curves and periods.

    Cases whose pier or base cannot be rebuilt from run.json are left out; empty if all are.
    """
    sheets: list[tuple[str, Statics]] = []
    devices: list[str] = []
    for case in finished.info["cases"][:MOST_CASES]:
        pier = pier_of(case)
        base = None if pier is None else base_of(case, pier)
        if pier is not None and base is not None:
            name = finished.named_case(case["case"], case["columns"], finished.info["varied"])
            sheets.append((name, sheet_of(pier, base)))
            devices.append("; ".join(device_in_words(pier, device) for device in base.restraints))
    if not sheets:
        return Markup("")
    omitted = len(finished.info["cases"]) - MOST_CASES
    soft = [f"{name}: {flexure(sheet)}" for name, sheet in sheets if is_too_soft(sheet)]
    tables = [_table(sheets[i : i + ABREAST], devices[i : i + ABREAST]) for i in range(0, len(sheets), ABREAST)]
    curves = statics(
        [Sheet(name, sheet.pier, sheet.equilibria, sheet.swings_at, sheet.contact_share) for name, sheet in sheets]
    )
    return join(
        paragraphs(*map(alarm, soft)),
        *tables,
        tag("figure", drawn(curves), class_="whole"),
        tag("p", LEGEND, class_="legend"),
        paragraphs(f"The first {MOST_CASES} cases are shown; `rockbatch statics` shows all." if omitted > 0 else ""),
    )


def _table(sheets: Named, devices: Sequence[str]) -> Markup:
    """Return a table with a column for each sheet and a row for each quantity that any has, for its direction and devices."""
    values = [sheet.row for _, sheet in sheets]
    rows = [[fact.heading, *(fact.written(row[fact.name]) for row in values), fact.meaning] for fact in FACTS]
    turned = ["" if sheet.towards == "either" else f"to the {sheet.towards}" for _, sheet in sheets]
    rows += [["direction", *turned, "the weaker direction, if devices differ"], ["devices", *devices, ""]]
    heads = [Head(""), *(Head(name) for name, _ in sheets), Head("")]
    return table(heads, [row for row in rows if any(row[1:-1])], prose=True, name="Statics")
