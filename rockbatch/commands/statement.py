"""``rockbatch statement``: print a paragraph on each case of finished results, for a calculation file."""

import argparse

from rockbatch.reporting import statement
from rockbatch.terminal.streams import show


def main(arguments: argparse.Namespace) -> int:
    """Print a paragraph on each case, or on those of --case; return 0."""
    show(statement(arguments.directory, arguments.case))
    return 0
