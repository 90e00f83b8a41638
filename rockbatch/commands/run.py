"""``rockbatch run``: a study file to peaks.csv, run.json and report.html."""

import argparse
import math
import re
import time
from typing import TYPE_CHECKING

from rockbatch.commands.messages import count, make_ready, once, say, tell_motions
from rockbatch.commands.options import add_engine, add_study, engine, folder, study_of

if TYPE_CHECKING:
    from rockbatch.motions import MotionSet
    from rockbatch.study import Study

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
    started = time.monotonic()
    study = study_of(arguments)

    from rockbatch.batch.carrying_out import carry_out, to_simulate
    from rockbatch.batch.digests import study_digests
    from rockbatch.batch.finishing import cost_of_finished, finish, what_was_run, write_peaks
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
    wanted, directory = range(len(runs)), folder(arguments)
    if arguments.shard:
        share, shares = arguments.shard
        if shares > len(runs):
            raise InputError(
                f"--shard {share}/{shares}: the study has {count(len(runs), 'run')}; make as many shares or fewer"
            )
        wanted = range(len(runs) * (share - 1) // shares, len(runs) * share // shares)
        directory = arguments.out or directory / f"shard-{share}-of-{shares}"
    digest = study_digests(study, motions)
    info = what_was_run(study, motions, runs, digest)
    with Journal(directory / PART, columns(study), digest, arguments.fresh) as journal:
        cost = None if arguments.fresh or len(journal) else cost_of_finished(directory, info)
        if cost:
            say(f"{told(study, motions)} are finished in {directory}; nothing is left to run (--fresh runs them again)")
            return tell(finish(directory, study, runs, info | cost, Progress), study, motions)
        with engine(arguments) as carrier:
            every = len(to_simulate(runs, wanted))
            of_share = f"; share {share} of {shares} is {count(every, 'run')}" if arguments.shard else ""
            say(f"{told(study, motions)} on {carrier}{of_share}")
            left = len(to_simulate(runs, wanted, journal))
            kept = every - left
            if kept:
                say(f"{kept} of them are finished already, {left} are left (--fresh starts over)")
            make_ready(study)
            try:
                with Progress(left) as progress:
                    carry_out(runs, study.numerics, journal, carrier, study.output, among=wanted, progress=progress)
            except KeyboardInterrupt:
                done = every - len(to_simulate(runs, wanted, journal))
                say(
                    f"interrupted: {done} of {count(every, 'run')} are finished and kept in {journal.path}; "
                    "the same command goes on from there"
                )
                return 130
            cost = {"jobs": carrier.jobs, "kept": kept}
        if arguments.shard:
            say(f"{journal.path}: share {share} of {shares} is finished; `rockbatch merge` joins the shares")
            return 0
        write_peaks(journal, motions)
        cost["wall_s"] = round(time.monotonic() - started, 3)
        return tell(finish(directory, study, runs, info | cost, Progress), study, motions)


def told(study: "Study", motions: "MotionSet") -> str:
    """How many runs there are, and why: "2 records × 5 cases = 10 runs"."""
    factors = {
        "record": len(motions.motions),
        "scale": len(study.motions.scale),
        "case": len(study.cases),
    }
    counted = [count(n, noun) for noun, n in factors.items() if n > 1 or noun in ("record", "case")]
    return f"{' × '.join(counted)} = {count(math.prod(factors.values()), 'run')}{once(study)}"
