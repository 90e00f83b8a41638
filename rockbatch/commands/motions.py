"""``rockbatch motions``: what is in a folder of records, and what could not be read and why."""

import argparse
from pathlib import Path
from typing import Any

from rockbatch.batch.listening import count
from rockbatch.commands.streams import in_width, say, show
from rockbatch.common.errors import InputError
from rockbatch.common.files import csv_text, write_whole
from rockbatch.motions import LeftOut, MotionSet, ReadOptions, Unusable, read_motions
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
    "check": ("check", ""),
    "file_h": ("horizontal", ""),
    "file_v": ("vertical", ""),
}


def main(arguments: argparse.Namespace) -> int:
    """Print the records of files or folders, and what is not used; write a table or a manifest if asked."""
    columns = tuple(arguments.columns.split(",")) if arguments.columns else None
    options = ReadOptions(
        arguments.unit, arguments.dt, columns, arguments.sensitivity, arguments.role, arguments.layout
    )
    if arguments.write_manifest:
        if len(arguments.path) > 1:
            raise InputError("--write-manifest: give one folder, which it is written into")
        say(str(write_manifest(arguments.path[0], options)))
    suite = read_motions(arguments.path, options=options)
    rows = [row(motion) for motion in suite]
    if arguments.csv:
        _write(arguments.csv, rows, suite)
    if rows:
        show(_table(rows))
    _list("What was done", [(motion.named, note) for motion in suite.motions for note in motion.notes])
    lacking = [motion.named for motion in suite.motions if motion.lacks_vertical]
    _list("No vertical", [(name, "none beside it that fits") for name in lacking])
    _list("Not used", [(file.source, file.reason) for file in suite.unusable])
    _list("Left out", [(file.source, file.reason) for file in suite.left_out])
    files = f"{count(len(suite.unusable), 'file')} not used, {len(suite.left_out)} left out"
    stations = count(len({motion.of_station for motion in suite.motions}), "station")
    say(f"{count(len(suite.motions), 'record')}, {files}; {stations}")
    if arguments.strict and suite.unusable:
        return 2
    return 1 if suite.unusable or not suite.motions else 0


def _write(path: Path, rows: list[dict[str, Any]], suite: MotionSet) -> None:
    """Write the table, with a row for each file that is not used."""
    files: list[Unusable | LeftOut] = [*suite.unusable, *suite.left_out]
    not_used = [{"record": file.name, "file_h": file.source, "reason": file.reason} for file in files]
    heads = list(COLUMNS)
    heads.insert(heads.index("azimuth_deg"), "reason")
    try:
        write_whole(path, csv_text(heads, [*rows, *not_used]))
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None


def _table(rows: list[dict[str, Any]]) -> str:
    """Return the rows as a table; a column without a value is left out."""
    used = {key: shown for key, shown in _SHOWN.items() if key == "record" or any(row[key] is not None for row in rows)}
    cells = [["" if row[key] is None else format(row[key], form) for key, (_, form) in used.items()] for row in rows]
    flush_left = [place for place, key in enumerate(used) if key in TEXTS]
    return in_width([head for head, _ in used.values()], cells, left=flush_left)


def _list(title: str, entries: list[tuple[str, str]]) -> None:
    if entries:
        show("\n".join([f"\n{title}", *(f"  {name}: {words}" for name, words in entries)]))
