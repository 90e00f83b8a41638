"""``rockbatch run``: a study file to peaks.csv, run.json and report.html."""

import argparse
import re
import sys
from typing import TYPE_CHECKING

from rockbatch.commands.messages import Terminal, show
from rockbatch.commands.options import add_engine, add_study, engine, folder, study_of

if TYPE_CHECKING:
    from rockbatch.study import Study

HELP = "run every record on every foundation; table and report"
EXAMPLE = "rockbatch run pier.toml --out reports/pier"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_study(parser)
    add_engine(parser)
    parser.add_argument(
        "--shard",
        type=_shard,
        metavar="I/N",
        help="carry out the I-th of N shares only, in a folder of its own, for `rockbatch merge`",
    )
    parser.add_argument(
        "--history",
        action="append",
        default=[],
        metavar="RECORD",
        help="keep the histories of all runs under this record, too; finished runs are not repeated for it",
    )
    parser.add_argument(
        "--dry-run",
        action="store_true",
        help="write nothing; say how many runs there are, and how long and how much disk they will take",
    )


def _shard(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d+)/(\d+)", text, re.ASCII)
    share, shares = map(int, match.groups()) if match else (0, 0)
    if not 1 <= share <= shares:
        raise argparse.ArgumentTypeError(f"{text}: must be such as 2/4, the second of four shares")
    return share, shares


def main(arguments: argparse.Namespace) -> int:
    study = study_of(arguments)
    if arguments.dry_run:
        return _expect(study, arguments.jobs)

    from rockbatch.batch.running import run_into
    from rockbatch.commands.ending import tell

    directory = folder(arguments)
    if arguments.shard and not arguments.out:
        share, shares = arguments.shard
        directory /= f"shard-{share}-of-{shares}"
    finished = run_into(
        directory, study, engine(arguments), Terminal(),
        command=sys.argv[1:], fresh=arguments.fresh, share=arguments.shard, records=arguments.history,
    )  # fmt: skip
    return 0 if finished is None else tell(finished, study)


def _expect(study: "Study", jobs: int | None) -> int:
    """Print the time and the disk space that the study would take."""
    from rockbatch.batch.expecting import expected
    from rockbatch.batch.threads import cores

    estimate = expected(study, jobs or cores(), Terminal())
    threads = "1 thread" if estimate.jobs == 1 else f"{estimate.jobs} threads"
    show(estimate.what)
    show(f"{in_words(estimate.seconds)} on {threads}, as {estimate.tried} of them took; then the report")
    show(f"peaks.csv: about {estimate.table / 1e6:.2g} MB; histories: about {estimate.histories / 1e6:.2g} MB")
    return 0


def in_words(seconds: float) -> str:
    """Return a time as one would say it: "less than 1 s", "40 s", "12 min", "3.5 h"."""
    if seconds < 1.0:
        return "less than 1 s"
    if seconds < 90.0:
        return f"about {seconds:.0f} s"
    return f"about {seconds / 60.0:.0f} min" if seconds < 5400.0 else f"about {seconds / 3600.0:.1f} h"
