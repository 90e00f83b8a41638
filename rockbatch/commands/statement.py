"""``rockbatch statement``: print a paragraph on each case of finished results, for a calculation file."""

import argparse

from rockbatch.reporting import statement
from rockbatch.terminal.streams import show


def main(arguments: argparse.Namespace) -> int:
    """Print the statements, each on a line of its own unless they are shown in a terminal."""
    show(statement(arguments.directory, arguments.case))
    return 0
