"""``rockbatch report``: the report of finished results, made again, or of two studies side by side."""

import argparse
from pathlib import Path

from rockbatch.commands.messages import say

HELP = "make the report again, or compare two studies"
EXAMPLE = "rockbatch report reports/pier reports/other"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("directory", type=Path, metavar="DIR", help="folder that `rockbatch run` has written")
    parser.add_argument("other", type=Path, metavar="OTHER", nargs="?", help="a second one, to compare the first with")
    parser.add_argument(
        "--out", type=Path, metavar="FILE", help="file to write (default: DIR/report.html, or DIR/compare-OTHER.html)"
    )


def main(arguments: argparse.Namespace) -> int:
    from rockbatch.report import report

    say(str(report(arguments.directory, arguments.other, out=arguments.out).path))
    return 0
