"""``rockbatch run``: a study file to peaks.csv, run.json and report.html."""

import argparse
import re
import sys

from rockbatch.commands.messages import Terminal
from rockbatch.commands.options import add_engine, add_study, engine, folder, study_of

HELP = "run every record of a study in every case; write the table of peaks and the report"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_study(parser)
    add_engine(parser)
    parser.add_argument(
        "--shard",
        type=_shard,
        metavar="I/N",
        help="carry out the I-th of N shares only, in a folder of its own, for `rockbatch merge`",
    )


def _shard(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d+)/(\d+)", text, re.ASCII)
    share, shares = map(int, found.groups()) if found else (0, 0)
    if not 1 <= share <= shares:
        raise argparse.ArgumentTypeError(f"{text}: must be such as 2/4, the second of four shares")
    return share, shares


def main(arguments: argparse.Namespace) -> int:
    study = study_of(arguments)

    from rockbatch.batch.running import run_into
    from rockbatch.commands.ending import tell

    directory = folder(arguments)
    if arguments.shard and not arguments.out:
        share, shares = arguments.shard
        directory /= f"shard-{share}-of-{shares}"
    finished = run_into(
        directory, study, engine(arguments), Terminal(),
        command=sys.argv[1:], fresh=arguments.fresh, share=arguments.shard,
    )  # fmt: skip
    return 0 if finished is None else tell(finished, study)
