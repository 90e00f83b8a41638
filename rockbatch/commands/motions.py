"""``rockbatch motions``: list the records of a folder, and the files that cannot be used, with reasons."""

import argparse
from collections.abc import Hashable, Mapping, Sequence
from pathlib import Path

from rockbatch.batch.listening import count
from rockbatch.common.errors import InputError
from rockbatch.common.files import csv_text, write_output
from rockbatch.common.grouping import distinct, grouped
from rockbatch.motions import MotionSet, ReadOptions, read_motions
from rockbatch.motions.manifest_draft import write_manifest
from rockbatch.motions.motion_set import COLUMNS, TEXTS, row
from rockbatch.motions.ranking import ADDED, RankedRecord, Use, ranked_records
from rockbatch.motions.ranking import rows as csv_rows
from rockbatch.motions.sources.source import file_of
from rockbatch.terminal.streams import WIDTH, aligned, filled, in_width, say, shortened, show, width

_SHOWN = {  # heads and number formats of the table in the terminal
    "record": ("record", ""),
    "event": ("event", ""),
    "station_name": ("station", ""),
    "direction": ("direction", ""),
    "station": ("counts as", ""),
    "dt_s": ("dt [s]", "g"),
    "npts": ("npts", "d"),
    "duration_s": ("length [s]", ".2f"),
    "pga_h_g": ("PGA [g]", ".3f"),
    "pga_v_g": ("up [g]", ".3f"),
    "pgv_h_m_s": ("PGV [m/s]", ".3f"),
    "pgd_h_m": ("PGD [m]", ".3f"),
    "arias_m_s": ("Arias [m/s]", ".3f"),
    "d5_95_s": ("D5-95 [s]", ".2f"),
    "azimuth_deg": ("azimuth", "g"),
    "magnitude": ("M", "g"),
    "distance_km": ("R [km]", "g"),
    "vs30_m_s": ("Vs30 [m/s]", "g"),
    "list_scale": ("list scale", "g"),
    "list_d5_95_s": ("list D5-95 [s]", "g"),
    "list_pulse_period_s": ("list Tp [s]", "g"),
    "check": ("check", ""),
    "file_h": ("horizontal", ""),
    "file_v": ("vertical", ""),
}

_GLANCE = {  # the same for the scorecard, whose units are printed above it
    "pga_h_g": ("PGA", ".3f"),
    "pga_h2_g": ("2nd", ".3f"),
    "pga_v_g": ("up", ".3f"),
    "pgv_h_m_s": ("PGV", ".2f"),
    "dt_s": ("dt", "g"),
    "d5_95_s": ("D5-95", ".1f"),
    "pulse_period_s": ("Tp", ".1f"),
    "magnitude": ("M", ".3g"),
    "distance_km": ("R", ".1f"),
    "vs30_m_s": ("Vs30", ".0f"),
}
_UNITS = "PGA of both horizontals and up in g, PGV in m/s, dt, D5-95 and Tp (pulse) in s, R in km, Vs30 in m/s"
_NAMES = (10, 24)
"""Fewest and most letters of a record's name in the scorecard."""

MOST_LINES = 60
LEAST_LINES = 16
MOST_GROUPS = 4
"""Most reasons printed under a title, each with an example; rare ones first."""


def main(arguments: argparse.Namespace) -> int:
    """Print the records of files or folders and the files not used; write a table, page or manifest if requested.

    The exit code is 2 if a file cannot be used and --strict is given, 1 if so without it, or without any record, else 0.
    """
    columns = tuple(arguments.columns.split(",")) if arguments.columns else None
    options = ReadOptions(
        arguments.unit, arguments.dt, columns, arguments.sensitivity, arguments.role, arguments.layout
    )
    for path in arguments.path:
        if path.suffix == ".toml" and path.is_file():
            raise InputError(f"{path}: not a record; give the folder of records, the path under [motions] of a study")
    if arguments.write_manifest:
        if len(arguments.path) > 1:
            raise InputError("--write-manifest: give one folder, to which it is written")
        say(str(write_manifest(arguments.path[0], options)))
    suite = read_motions(arguments.path, options=options)
    if arguments.csv:
        _write(arguments.csv, suite)
    if arguments.html:
        from rockbatch.workflow.records import write_records

        write_records(arguments.html, suite, f"Records in {', '.join(map(str, arguments.path))}", counts(suite))
    if arguments.all:
        _show_all([row(motion) for motion in suite], suite)
    else:
        show(overview(suite))
    if arguments.strict and suite.unusable:
        return 2
    return 1 if suite.unusable or not suite.motions else 0


def counts(suite: MotionSet) -> str:
    """Return "3 files: 2 usable recordings of 1 station, 0 not used, 1 left out" with the numbers of the set."""
    files = {file_of(source) for item in (*suite, *suite.unusable, *suite.left_out) for source in item.sources}
    recordings = f"{count(len(suite), 'usable recording')} of {count(len(suite.stations()), 'station')}"
    return f"{count(len(files), 'file')}: {recordings}, {len(suite.unusable)} not used, {len(suite.left_out)} left out"


def overview(suite: MotionSet) -> str:
    """Return counts, a scorecard of the doubtful and strongest records, and faults by reason, some :data:`MOST_LINES` lines."""
    entries: dict[str, list[tuple[Hashable, str, str]]] = {
        "Not used": [(file.cause, file.source, file.reason) for file in suite.unusable],
        "Look at these": [(found.what, motion.named, found.text) for motion in suite for found in motion.findings],
        "No vertical": [("", motion.named, "no matching file") for motion in suite if motion.lacks_vertical],
        "Left out": [(Use.COPY if file.of else file.reason, file.source, file.reason) for file in suite.left_out],
    }
    for most in range(MOST_GROUPS, 0, -1):
        groups = [line for title, of_title in entries.items() for line in _by_cause(title, of_title, most)]
        if len(groups) <= MOST_LINES - LEAST_LINES - 8:
            break
    records = [record for record in ranked_records(suite) if record.use in (Use.USED, Use.HELD_BACK)]
    card = _scorecard(records, max(MOST_LINES - len(groups) - 8, LEAST_LINES)) if records else []
    return "\n".join([counts(suite), *card, *groups, "", "every recording: --all, --csv FILE or --html FILE"])


def _scorecard(records: Sequence[RankedRecord], room: int) -> list[str]:
    """Return the first doubtful records, their doubts in a second line, and the strongest others; doubtful ones come first.

    Records take at most ``room`` lines, two for each doubtful one; half of the lines or more go to these if there are so many.
    ``records`` has the doubtful first. Heads and the number of further records are not counted in ``room``.
    """
    doubtful = [record for record in records if record.doubtful]
    sound = records[len(doubtful) :]
    first = min(len(doubtful), max(room // 4, (room - len(sound)) // 2))
    shown = [*doubtful[:first], *sound[: room - 2 * first]]
    known = [key for key in _GLANCE if any(record.values[key] is not None for record in shown)]
    cells = [[_cell(record.values[key], _GLANCE[key][1]) for key in known] for record in shown]
    numbers = aligned([[_GLANCE[key][0] for key in known], *cells], ())
    least, most = _NAMES
    letters = min(max((width() or WIDTH) - len(numbers[0]) - 2, least), most)
    labels = [record.label for record in shown]
    named = distinct(labels, lambda i, name: f"{name} {shown[i].values['event'] or ''}".strip())
    names = ["record", *shortened(named, letters)]
    edge = max(map(len, names))
    table = [f"{name.ljust(edge)}  {line}".rstrip() for name, line in zip(names, numbers, strict=True)]
    lines = ["", *filled(_UNITS).split("\n"), "", table[0]]
    for record, line in zip(shown, table[1:], strict=True):
        held = "held back: " if record.use is Use.HELD_BACK else "to check: "
        lines += [line, *([f"    {held}{', '.join(record.doubts)}"] if record.doubtful else [])]
    hidden = {"doubtful": len(doubtful) - first, "other": len(sound) - (len(shown) - first)}
    kinds = " and ".join(f"{number} {kind}" for kind, number in hidden.items() if number)
    plural = "" if sum(hidden.values()) == 1 else "s"
    return [*lines, *([f"and {kinds} station{plural} more"] if kinds else [])]


def _cell(value: object, form: str) -> str:
    return "" if value is None else format(value, form)


def _by_cause(title: str, entries: Sequence[tuple[Hashable, str, str]], most: int) -> list[str]:
    """Return a title, and a line for each of the ``most`` rarest causes, then the number of others; [] without entries.

    ``entries`` are (cause, name, reason); a line has the number, and name and reason of the first as an example.
    """
    causes = sorted(grouped(entries, lambda entry: entry[0]).values(), key=len)
    lines = ["", title] if entries else []
    for same in causes[:most]:
        _, name, reason = same[0]
        example = f"such as {name}" if len(same) > 1 else name
        lines += filled(f"{len(same)} ×: {reason} ({example})", 2, 6).split("\n")
    if len(causes) > most:
        rest = sum(map(len, causes[most:]))
        lines.append(f"  {rest} × for {count(len(causes) - most, 'other reason')}")
    return lines


def _show_all(rows: Sequence[Mapping[str, object]], suite: MotionSet) -> None:
    """Print every recording, its processing, missing verticals, every file that is not used or left out, and their numbers."""
    if rows:
        show(_table(rows))
    _list("Processing", [(motion.named, note) for motion in suite.motions for note in motion.notes])
    lacking = [motion.named for motion in suite.motions if motion.lacks_vertical]
    _list("No vertical", [(name, "no matching file") for name in lacking])
    _list("Not used", [(file.source, file.reason) for file in suite.unusable])
    _list("Left out", [(file.source, file.reason) for file in suite.left_out])
    files = f"{count(len(suite.unusable), 'file')} not used, {len(suite.left_out)} left out"
    say(f"{count(len(suite.motions), 'record')}, {files}; {count(len(suite.stations()), 'station')}")


def _write(path: Path, suite: MotionSet) -> None:
    """Write the table as CSV, including a row for each file that is not used."""
    heads = [*COLUMNS, *ADDED]
    heads.insert(heads.index("azimuth_deg"), "reason")
    write_output(path, csv_text(heads, csv_rows(suite)))


def _table(rows: Sequence[Mapping[str, object]]) -> str:
    """Return the columns of :data:`_SHOWN` as a table in text, without those that are None in all rows; the record stays."""
    used = {key: shown for key, shown in _SHOWN.items() if key == "record" or any(row[key] is not None for row in rows)}
    cells = [[_cell(row[key], form) for key, (_, form) in used.items()] for row in rows]
    flush_left = [place for place, key in enumerate(used) if key in TEXTS]
    return in_width([head for head, _ in used.values()], cells, left=flush_left)


def _list(title: str, entries: list[tuple[str, str]]) -> None:
    if entries:
        show("\n".join([f"\n{title}", *(f"  {name}: {words}" for name, words in entries)]))
