"""``rockbatch motions``: what is in a folder of records, and what could not be read and why."""

import argparse
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rockbatch.batch.listening import count
from rockbatch.commands.streams import filled, in_width, say, show
from rockbatch.common.errors import InputError
from rockbatch.common.files import csv_text, write_output
from rockbatch.common.grouping import grouped
from rockbatch.common.units import GRAVITY
from rockbatch.motions import LeftOut, Motion, MotionSet, ReadOptions, Unusable, read_motions
from rockbatch.motions.manifest_draft import write_manifest
from rockbatch.motions.motion_set import COLUMNS, TEXTS, row

_SHOWN = {  # heads of the table in the terminal, and how their numbers are written
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

MOST_LINES = 60
LEAST_STATIONS = 12
MOST_GROUPS = 4
"""Reasons of each kind that are printed, each with an example; rare ones first."""
_VARIABLE = re.compile(r'"[^"]*"|\([^)]*\)|[^\s;:,]*[\d/][^\s;:,]*')
"""Names and numbers in a reason."""


def main(arguments: argparse.Namespace) -> int:
    """Print the records of files or folders, and what is not used; write a table or a manifest if asked."""
    columns = tuple(arguments.columns.split(",")) if arguments.columns else None
    options = ReadOptions(
        arguments.unit, arguments.dt, columns, arguments.sensitivity, arguments.role, arguments.layout
    )
    for path in arguments.path:
        if path.suffix == ".toml" and path.is_file():
            raise InputError(
                f"{path}: no record; give the folder of records, as a study has it in path under [motions]"
            )
    if arguments.write_manifest:
        if len(arguments.path) > 1:
            raise InputError("--write-manifest: give one folder, which it is written into")
        say(str(write_manifest(arguments.path[0], options)))
    suite = read_motions(arguments.path, options=options)
    rows = [row(motion) for motion in suite]
    if arguments.csv:
        _write(arguments.csv, rows, suite)
    if arguments.all:
        _show_all(rows, suite)
    else:
        show(overview(suite))
    if arguments.strict and suite.unusable:
        return 2
    return 1 if suite.unusable or not suite.motions else 0


def overview(suite: MotionSet) -> str:
    """Return the counts, what is missing or odd by its reason, and a line for each station, in at most :data:`MOST_LINES`."""
    stations = suite.stations()
    sources = {source for motion in suite for source in (motion.source, motion.vertical_source) if source}
    for not_used in (suite.unusable, suite.left_out):
        sources |= {file.source for file in not_used}
    files = {source.split(" (")[0] for source in sources}
    lines = [
        f"{count(len(files), 'file')}: {count(len(suite), 'usable recording')} of {count(len(stations), 'station')}, "
        f"{len(suite.unusable)} not used, {len(suite.left_out)} left out"
    ]
    entries = {
        "Not used": [(file.source, file.reason) for file in suite.unusable],
        "Look at these": [(motion.named, finding.text) for motion in suite for finding in motion.findings],
        "No vertical": [(motion.named, "none beside it that fits") for motion in suite if motion.lacks_vertical],
        "Left out": [(file.source, file.reason.partition(";")[0]) for file in suite.left_out],
    }
    for most in range(MOST_GROUPS, 0, -1):
        groups = [line for title, of_title in entries.items() for line in _by_reason(title, of_title, most)]
        if len(groups) <= MOST_LINES - LEAST_STATIONS - 5:
            break
    lines += groups
    if stations:
        room = max(MOST_LINES - len(lines) - 4, LEAST_STATIONS)
        rows = [_of_station(name, motions) for name, motions in list(stations.items())[:room]]
        lines += ["", in_width(["station", "event", "n", "PGA [g]", "check"], rows, left=(1, 4))]
        if len(stations) > room:
            lines.append(f"and {count(len(stations) - room, 'station')} more")
    return "\n".join([*lines, "every recording: --all, or --csv FILE"])


def _of_station(name: str, motions: Sequence[Motion]) -> list[str]:
    """Return the line of a station: the greatest of its recordings, and what is odd about them."""
    first = motions[0].origin
    pga = max(motion.pga for motion in motions) / GRAVITY
    checks = dict.fromkeys(finding.what for motion in motions for finding in motion.findings)
    return [first.short_station or name, first.short_event, str(len(motions)), f"{pga:.3f}", ", ".join(checks)]


def _by_reason(title: str, entries: Sequence[tuple[str, str]], most: int) -> list[str]:
    """Return how often each reason occurs, with one example of it; reasons that differ in names and numbers alone are one."""
    reasons = sorted(grouped(entries, lambda entry: _VARIABLE.sub("", entry[1])).values(), key=len)
    lines = ["", title] if entries else []
    for same in reasons[:most]:
        name, reason = same[0]
        example = f"such as {name}" if len(same) > 1 else name
        lines += filled(f"{len(same)} ×: {reason} ({example})", 2, 6).split("\n")
    if len(reasons) > most:
        rest = sum(map(len, reasons[most:]))
        lines.append(f"  {rest} × for {count(len(reasons) - most, 'other reason')}")
    return lines


def _show_all(rows: list[dict[str, Any]], suite: MotionSet) -> None:
    """Print every recording, what was done to it, and every file that is not used."""
    if rows:
        show(_table(rows))
    _list("What was done", [(motion.named, note) for motion in suite.motions for note in motion.notes])
    lacking = [motion.named for motion in suite.motions if motion.lacks_vertical]
    _list("No vertical", [(name, "none beside it that fits") for name in lacking])
    _list("Not used", [(file.source, file.reason) for file in suite.unusable])
    _list("Left out", [(file.source, file.reason) for file in suite.left_out])
    files = f"{count(len(suite.unusable), 'file')} not used, {len(suite.left_out)} left out"
    say(f"{count(len(suite.motions), 'record')}, {files}; {count(len(suite.stations()), 'station')}")


def _write(path: Path, rows: list[dict[str, Any]], suite: MotionSet) -> None:
    """Write the table, with a row for each file that is not used."""
    files: list[Unusable | LeftOut] = [*suite.unusable, *suite.left_out]
    not_used = [{"record": file.name, "file_h": file.source, "reason": file.reason} for file in files]
    heads = list(COLUMNS)
    heads.insert(heads.index("azimuth_deg"), "reason")
    write_output(path, csv_text(heads, [*rows, *not_used]))


def _table(rows: list[dict[str, Any]]) -> str:
    """Return the rows as a table; a column without a value is left out."""
    used = {key: shown for key, shown in _SHOWN.items() if key == "record" or any(row[key] is not None for row in rows)}
    cells = [["" if row[key] is None else format(row[key], form) for key, (_, form) in used.items()] for row in rows]
    flush_left = [place for place, key in enumerate(used) if key in TEXTS]
    return in_width([head for head, _ in used.values()], cells, left=flush_left)


def _list(title: str, entries: list[tuple[str, str]]) -> None:
    if entries:
        show("\n".join([f"\n{title}", *(f"  {name}: {words}" for name, words in entries)]))
