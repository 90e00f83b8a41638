"""``rockbatch merge``: the shares of a study that several machines have carried out, joined as if one run had."""

import argparse
import sys
from pathlib import Path

from rockbatch.commands.messages import Terminal
from rockbatch.commands.options import add_study, folder, study_of

HELP = "join the shares of `rockbatch run --shard`"
EXAMPLE = "rockbatch merge pier.toml one two"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_study(parser)
    parser.add_argument("shares", type=Path, nargs="+", metavar="DIR", help="folders of the shares")


def main(arguments: argparse.Namespace) -> int:
    study = study_of(arguments)

    from rockbatch.batch.merging import merge
    from rockbatch.commands.ending import tell

    return tell(merge(folder(arguments), study, arguments.shares, Terminal(), sys.argv[1:]), study)
