"""``rockbatch motions``: what is in a folder of records, and what could not be read and why."""

import argparse
import sys
from pathlib import Path

HELP = "show the records in a file or folder: components, dt, duration, peaks, and what could not be used"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("path", type=Path, nargs="+", metavar="PATH", help="files or folders (recursive)")
    parser.add_argument("--unit", help='acceleration unit of files that do not state theirs, such as "cm/s2"')
    parser.add_argument("--dt", type=float, help="sampling interval [s] of text columns without a time column")
    parser.add_argument("--columns", help='names of text columns, such as "time,000,090,up"')
    parser.add_argument("--sensitivity", type=float, help="counts per acceleration unit")


def main(arguments: argparse.Namespace) -> int:
    from rockbatch.motions import ReadOptions, measures, read_motions
    from rockbatch.units import GRAVITY

    columns = tuple(arguments.columns.split(",")) if arguments.columns else None
    options = ReadOptions(unit=arguments.unit, dt=arguments.dt, columns=columns, sensitivity=arguments.sensitivity)
    found = read_motions(arguments.path, options=options)
    lines = [("record", "dt [s]", "npts", "[s]", "PGA [g]", "PGV [m/s]", "PGD [m]", "PGA up [g]", "vertical")]
    for motion in found.motions:
        vertical = motion.pga_vertical
        lines.append(
            (
                motion.name,
                f"{motion.dt:g}",
                str(motion.npts),
                f"{motion.duration:.2f}",
                f"{motion.pga / GRAVITY:.3f}",
                f"{measures.pgv(motion.horizontal, motion.dt):.3f}",
                f"{measures.pgd(motion.horizontal, motion.dt):.3f}",
                "" if vertical is None else f"{vertical / GRAVITY:.3f}",
                motion.vertical_source,
            )
        )
    widths = [max(len(line[i]) for line in lines) for i in range(len(lines[0]))]
    for line in lines:
        names = line[0].ljust(widths[0])
        numbers = "  ".join(cell.rjust(width) for cell, width in zip(line[1:8], widths[1:8], strict=True))
        print(f"{names}  {numbers}  {line[8]}".rstrip())
    noted = [(motion.name, note) for motion in found.motions for note in motion.notes]
    if noted:
        print("\nWhat was done")
        for name, note in noted:
            print(f"  {name}: {note}")
    if found.unusable:
        print("\nNot used")
        for file in found.unusable:
            print(f"  {file.source}: {file.reason}")
    print(f"{len(found.motions)} records, {len(found.unusable)} files not used", file=sys.stderr)
    return 1 if found.unusable or not found.motions else 0
