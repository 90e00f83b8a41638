"""``rockbatch examples``: the studies that come with rockbatch."""

import argparse

from rockbatch.commands.messages import show
from rockbatch.examples import examples

HELP = "list the studies that come with rockbatch"
EXAMPLE = "rockbatch examples"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    del parser  # it has no arguments


def main(arguments: argparse.Namespace) -> int:
    del arguments
    every = examples()
    width = max(len(example.name) for example in every)
    for example in every:
        needs = ' (needs pip install "rockbatch[records]")' if example.package else ""
        show(f"{example.name:<{width}}  {example.title}{needs}")
    show("\nA copy to work on, with its records: rockbatch init FOLDER --example NAME")
    show(f"Or as they are:                      rockbatch {every[0].command} {every[0].path}")
    return 0
