"""The page of a folder of records: measures, trace and spectrum of each, doubtful ones first."""

from collections.abc import Sequence
from pathlib import Path

from rockbatch.common.files import write_output
from rockbatch.motions.motion_set import MotionSet
from rockbatch.motions.ranking import RankedRecord, Use, ranked_records
from rockbatch.motions.small_figures import spectra, trace
from rockbatch.motions.unused import LeftOut, Unusable
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.reporting.svg import sketch
from rockbatch.reporting.table import MOST_ROWS, Head, table
from rockbatch.reporting.templates import Section, document

_NAMED = ("event", "station_name", "record")
"""Columns that are combined in one cell, the name of the record."""

COLUMNS = {
    "record": Head("record", note="station_name, event, and record: the name of the stronger component"),
    "use": Head("status", note="use: whether and how the record is used", filter=True),
    "check": Head("to check", note="check: doubts; reasons are below"),
    "acceleration": Head("acceleration", note="of the stronger component, on its own scale"),
    "sa": Head("SA", note="response spectrum, 5 % damped, 0.05 to 5 s"),
    "pga_h_g": Head("PGA", ".3f", "pga_h_g: of the stronger horizontal component", unit="g"),
    "pga_h2_g": Head("across", ".3f", "pga_h2_g: PGA of the other horizontal component", unit="g"),
    "pga_v_g": Head("vertical", ".3f", "pga_v_g: PGA of the vertical component", unit="g"),
    "pgv_h_m_s": Head("PGV", ".3f", "pgv_h_m_s: of the stronger component", unit="m/s"),
    "d5_95_s": Head("D5–95", ".1f", "d5_95_s: significant duration, from 5 to 95 % of the Arias intensity", unit="s"),
    "pulse_period_s": Head(
        "pulse",
        ".1f",
        "pulse_period_s: from PEER's list, else for a component that is pulse-like by Baker (2007)",
        unit="s",
    ),
    "magnitude": Head("M", note="magnitude"),
    "distance_km": Head("R", "g", "distance_km", unit="km"),
    "vs30_m_s": Head("Vs30", "g", "vs30_m_s", unit="m/s"),
    "dt_s": Head("dt", "g", "dt_s", unit="s"),
    "duration_s": Head("length", ".1f", "duration_s: from the first to the last sample", unit="s"),
}
"""Heads of the columns: those of :mod:`rockbatch.motions.ranking`, and pictures."""


def write_records(path: Path, motions: MotionSet, title: str, about: str) -> None:
    """Write the page of ``motions`` to ``path``; "-" is stdout."""
    write_output(path, page(motions, title, about))


def page(motions: MotionSet, title: str, about: str) -> str:
    """Return the page of motions as HTML: ranked records, then files not used, findings and files left out, if there are any."""
    records = ranked_records(motions)
    findings = [(motion.named, finding.text) for motion in motions for finding in motion.findings]
    remarks = [[tag("span", name, class_="named"), text] for name, text in findings]
    doubts = table([Head("record"), Head("why")], remarks, prose=True) if remarks else Markup("")
    sections = [
        Section("Records", "records", scorecard(records) if records else tag("p", "No record was found.")),
        Section("Not used", "unusable", _reasons(motions.unusable, "Not used"), badge=len(motions.unusable)),
        Section("Look at these", "check", doubts),
        Section("Left out", "left_out", _reasons(motions.left_out, "Left out"), folded=True),
    ]
    return document(title, about, sections)


def scorecard(records: Sequence[RankedRecord]) -> Markup:
    """Return a table of the first :data:`MOST_ROWS` records, which readers can sort and filter, and its legend."""
    shown = records[:MOST_ROWS]
    read = [record for record in shown if record.motions]
    drawn = dict(zip(map(id, read), spectra([record.motions[0] for record in read]), strict=True))
    rows = []
    for record in shown:
        cells: dict[str, object] = {**record.values, "record": _name(record), "use": _use(record)}
        if record.motions:
            cells |= {"acceleration": sketch(trace(record.motions[0])), "sa": sketch(drawn[id(record)])}
        rows.append([cells.get(name) for name in COLUMNS])
    legend = tag(
        "p",
        "PGV, dt, length and D5–95 are of the stronger component, which is drawn. Spectra are 5 % damped, from 0.05 to 5 s, on a "
        "common logarithmic scale of three decades; lines are powers of ten of g.",
        class_="legend",
    )
    return join(
        table([*COLUMNS.values()], rows, sortable=True, name="Records", open_=True, worst_of=len(records)), legend
    )


def _name(record: RankedRecord) -> Markup:
    """Return station, event and table name of a record; its files are the tooltip."""
    event, station, name = (record.values[column] for column in _NAMED)
    first, *others = filter(None, (station, event, name))
    return tag("span", first, *(tag("small", " ", words) for words in others), class_="named", title=record.files)


def _use(record: RankedRecord) -> Markup:
    """Return how a record is used; the reasons are the tooltip."""
    marked = {Use.HELD_BACK: "undecided", Use.NOT_READ: "fail"}.get(record.use)
    return tag("span", record.use.value, class_=marked, title="\n".join(record.reasons) or None)


def _reasons(files: Sequence[Unusable | LeftOut], name: str) -> Markup:
    """Return a table of files, each with its source and the reason; empty without files."""
    rows = [
        [tag("span", file.name, class_="named"), tag("span", file.source, class_="path"), file.reason] for file in files
    ]
    return table([Head("record"), Head("file"), Head("why")], rows, prose=True, name=name) if rows else Markup("")
