"""``rockbatch merge``: the shares of a study that several machines have carried out, to what one run would have left."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from rockbatch.commands.messages import tell_motions
from rockbatch.commands.options import add_study, folder, study_of

HELP = "join the shares of `rockbatch run --shard`: the same results as if one machine had run them all"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_study(parser)
    parser.add_argument("shares", type=Path, nargs="+", metavar="DIR", help="folders of the shares")


def main(arguments: argparse.Namespace) -> int:
    study = study_of(arguments)

    from rockbatch.batch.digests import study_digests
    from rockbatch.batch.finishing import finish, what_was_run, write_peaks
    from rockbatch.batch.journal import Journal
    from rockbatch.batch.plan import Plan
    from rockbatch.commands.ending import tell
    from rockbatch.commands.progress import Progress
    from rockbatch.errors import InputError
    from rockbatch.results.columns import PART, columns
    from rockbatch.study.suite import ground_motions

    motions = ground_motions(study)
    tell_motions(motions)
    runs = Plan(study, motions)
    digest = study_digests(study, motions)
    directory = folder(arguments)
    with Journal(directory / PART, columns(study), digest) as journal:
        problems = []
        for share in arguments.shares:
            try:
                journal.add_from(share / PART)
            except FileNotFoundError:
                problems.append(f"{share / PART}: not there; give folders that `rockbatch run --shard` has written")
            except InputError as error:
                problems += error.problems
        left = [number for number in range(len(runs)) if number not in journal]
        if left and not problems:
            problems.append(
                f"{len(left)} of {len(runs)} rows are in none of these folders: {_ranges(left)}; finish their shares "
                f"and merge again, or carry them out here: rockbatch run {arguments.study} --out {directory}"
            )
        if problems:
            raise InputError(*problems)
        write_peaks(journal, motions)
        info = what_was_run(study, motions, runs, digest)
        info |= {"jobs": 0, "wall_s": 0.0, "kept": info["runs"]}
        return tell(finish(directory, study, runs, info, Progress), study, motions)


def _ranges(numbers: Sequence[int], most: int = 5) -> str:
    """Numbers, counted from 1, as ranges: "1 to 12, 17"."""
    starts = [i for i, number in enumerate(numbers) if i == 0 or number != numbers[i - 1] + 1]
    ends = [i - 1 for i in starts[1:]] + [len(numbers) - 1]
    ranges = [
        f"{numbers[a] + 1} to {numbers[b] + 1}" if b > a else str(numbers[a] + 1)
        for a, b in zip(starts, ends, strict=True)
    ]
    return ", ".join(ranges[:most]) + (", …" if len(ranges) > most else "")
