"""``rockbatch motions``: what is in a folder of records, and what could not be read and why."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockbatch.batch.listening import count
from rockbatch.commands.messages import say, show

if TYPE_CHECKING:
    from rockbatch.motions import LeftOut, MotionSet, Unusable

HELP = "show what is in a folder of records, and what is not used"
EXAMPLE = "rockbatch motions records --csv records.csv"

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


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("path", type=Path, nargs="+", metavar="PATH", help="files or folders (recursive)")
    parser.add_argument("--csv", type=Path, metavar="FILE", help="write the table to FILE too")
    parser.add_argument("--write-manifest", action="store_true", help="draft PATH/motions.toml from what was found")
    parser.add_argument("--strict", action="store_true", help="fail if any file cannot be used")
    parser.add_argument("--unit", help='acceleration unit of files that do not state theirs, such as "cm/s2"')
    parser.add_argument("--dt", type=float, help="sampling interval [s] of text columns without a time column")
    parser.add_argument("--columns", help='names of text columns, such as "time,000,090,up"')
    parser.add_argument("--role", choices=("horizontal",), help="what components are whose direction nothing tells")
    parser.add_argument(
        "--layout", choices=("columns", "wrapped"), help="wrapped: one series goes on from line to line"
    )
    parser.add_argument("--sensitivity", type=float, help="counts per acceleration unit")


def main(arguments: argparse.Namespace) -> int:
    from rockbatch.errors import InputError
    from rockbatch.motions import ReadOptions, read_motions
    from rockbatch.motions.motion_set import row

    columns = tuple(arguments.columns.split(",")) if arguments.columns else None
    options = ReadOptions(
        arguments.unit, arguments.dt, columns, arguments.sensitivity, arguments.role, arguments.layout
    )
    if arguments.write_manifest:
        from rockbatch.motions.manifest_draft import write_draft

        if len(arguments.path) > 1:
            raise InputError("--write-manifest: give one folder, which it is written into")
        say(str(write_draft(arguments.path[0], options)))
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
    stations = len({motion.of_station for motion in suite.motions})
    counts = f"{len(suite.motions)} records, {len(suite.unusable)} files not used, {len(suite.left_out)} left out"
    say(f"{counts}; {count(stations, 'station')}")
    if arguments.strict and suite.unusable:
        return 2
    return 1 if suite.unusable or not suite.motions else 0


def _write(path: Path, rows: list[dict[str, Any]], suite: "MotionSet") -> None:
    from rockbatch.errors import InputError
    from rockbatch.files import csv_text, write_whole
    from rockbatch.motions.motion_set import COLUMNS

    files: list[Unusable | LeftOut] = [*suite.unusable, *suite.left_out]
    not_used = [{"record": file.name, "file_h": file.source, "reason": file.reason} for file in files]
    heads = list(COLUMNS)
    heads.insert(heads.index("azimuth_deg"), "reason")
    try:
        write_whole(path, csv_text(heads, [*rows, *not_used]))
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None


def _table(rows: list[dict[str, Any]]) -> str:
    """Return the rows in columns of equal width; a column without a value is left out."""
    from rockbatch.motions.motion_set import TEXTS

    used = {key: shown for key, shown in _SHOWN.items() if key == "record" or any(row[key] is not None for row in rows)}
    lines = [[head for head, _ in used.values()]]
    lines += [["" if row[key] is None else format(row[key], form) for key, (_, form) in used.items()] for row in rows]
    widths = [max(len(line[i]) for line in lines) for i in range(len(used))]
    aligned_left = [key in TEXTS for key in used]
    return "\n".join(
        "  ".join(
            cell.ljust(width) if text else cell.rjust(width)
            for cell, width, text in zip(line, widths, aligned_left, strict=True)
        ).rstrip()
        for line in lines
    )


def _list(title: str, entries: list[tuple[str, str]]) -> None:
    if entries:
        show(f"\n{title}")
        for name, words in entries:
            show(f"  {name}: {words}")
