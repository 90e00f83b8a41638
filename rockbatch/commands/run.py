"""``rockbatch run`` and ``rockbatch merge``: run a study, at once or in shares, and write its results."""

import argparse
import sys

from rockbatch.batch.expecting import expected
from rockbatch.batch.listening import count
from rockbatch.batch.threads import cores
from rockbatch.checks.verdicts import CHECKS
from rockbatch.commands import check
from rockbatch.commands.summary import failed_later, flexible, of_targets, summary, warnings
from rockbatch.quantities.rows import simulated, with_case
from rockbatch.results.beside_peaks import write_semicolons
from rockbatch.results.labelled import labelled
from rockbatch.results.suite_statistics import reasons_of_failure
from rockbatch.study import Study
from rockbatch.terminal.messages import Terminal
from rockbatch.terminal.options import engine, folder
from rockbatch.terminal.streams import say, show
from rockbatch.workflow.running import FinishedBatch, merge, run_into


def main(arguments: argparse.Namespace, study: Study) -> int:
    """Carry out the runs of a study, or a share of them, or estimate their cost; print the results, and return the exit code."""
    if arguments.dry_run:
        return _expect(study, arguments)
    directory = folder(arguments)
    if arguments.shard and not arguments.out:
        share, shares = arguments.shard
        directory /= f"shard-{share}-of-{shares}"
    finished = run_into(
        directory,
        study,
        engine(arguments),
        Terminal(),
        command=sys.argv[1:],
        fresh=arguments.fresh,
        share=arguments.shard,
        records=arguments.history,
    )
    return 0 if finished is None else _finished(finished, study, arguments.csv)


def merge_shares(arguments: argparse.Namespace, study: Study) -> int:
    """Join the shares of a study that several machines computed; print the results, and return the exit code."""
    finished = merge(folder(arguments), study, arguments.shares, Terminal(), sys.argv[1:])
    return _finished(finished, study, arguments.csv)


def _expect(study: Study, arguments: argparse.Namespace) -> int:
    """Print the estimated time and disk space of a study or a share of it; return 0."""
    estimate = expected(study, arguments.jobs or cores(), Terminal(), arguments.shard, arguments.history)
    threads = count(estimate.jobs, "thread")
    show(estimate.what)
    show(f"{in_words(estimate.seconds)} on {threads}, measured on {estimate.tried} of them; then the report")
    show(f"peaks.csv: about {estimate.table / 1e6:.2g} MB; histories: about {estimate.histories / 1e6:.2g} MB")
    return 0


def in_words(seconds: float) -> str:
    """Return a time rounded for people: "less than 1 s", "about 40 s", from 90 s "about 12 min", from 90 min "about 3.5 h"."""
    if seconds < 1.0:
        return "less than 1 s"
    if seconds < 90.0:
        return f"about {seconds:.0f} s"
    return f"about {seconds / 60.0:.0f} min" if seconds < 5400.0 else f"about {seconds / 3600.0:.1f} h"


def _finished(finished: FinishedBatch, study: Study, separator: str | None) -> int:
    """Print peaks, warnings, verdicts, or responses without checks, files and failures; return the exit code.

    It is 1 if a run failed, a file was not used, histories are missing, or a check did not pass; else 0.
    """
    saved, code = finished.saved, 0
    if finished.without:
        say(str(finished.without))
        code = 1
    peaks = simulated(saved.peaks)
    labels = finished.motions.labels
    names = {m.name: labels[m.name] for m in sorted(finished.motions.motions, key=lambda m: m.pga)}
    results = labelled(saved.peaks, saved.info, saved.directory)
    show(summary(results, names) + "\n")
    for warning in warnings(results.runs.assign(record=results.runs["record"].map(names)), results.case_of):
        say(warning)
    for warning in (*flexible(study), *of_targets(saved.info)):
        say(warning)
    if finished.verdicts:
        code = max(code, check.tell(finished.verdicts, saved.directory / CHECKS, saved))
    else:
        show(check.answered((), saved))
    for path in finished.files:
        if path.name != CHECKS:  # printed with the verdicts
            say(str(path))
    if separator:
        say(str(write_semicolons(saved.directory)))
    runs = with_case(peaks)
    failed = int((runs["status"] == "failed").sum())
    lost = ((failed, "run", "failed"), (len(saved.info["unusable"]), "file", "not used"))
    if words := " and ".join(f"{count(n, noun)} {state}" for n, noun, state in lost if n):
        say(f"{words}: see the column reason of peaks.csv")
        for reason in reasons_of_failure(runs):
            say(f"  {reason}")
        if later := failed_later(runs):
            say(later)
        code = 1
    return code
