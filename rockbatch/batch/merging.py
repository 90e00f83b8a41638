"""The shares of a study that several machines have carried out, joined to what one run would have left."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from rockbatch.batch.digests import study_digests
from rockbatch.batch.finishing import FinishedBatch, finish, what_was_run, write_peaks
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import Listener
from rockbatch.batch.plan import Plan
from rockbatch.errors import InputError
from rockbatch.results.columns import PART, columns
from rockbatch.study import Study
from rockbatch.study.suite import ground_motions


def merge(
    directory: Path, study: Study, shares: Iterable[Path], listener: Listener, command: Sequence[str]
) -> FinishedBatch:
    """Join the journals in the folders ``shares``, and write the results into ``directory``.

    ``command`` as in :func:`rockbatch.batch.running.run_into`. Raises ``InputError`` with all that is wrong with the shares,
    or missing; what could be joined stays, so that it can be carried out there.
    """
    motions = ground_motions(study)
    listener.motions(motions)
    runs = Plan(study, motions)
    digest = study_digests(study, motions)
    with Journal(directory / PART, columns(study), digest, runs=len(runs), tell=listener.say) as journal:
        problems = []
        for share in shares:
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
                f"and merge again, or carry them out here: rockbatch run {study.path} --out {directory}"
            )
        if problems:
            raise InputError(*problems)
        info = what_was_run(study, motions, runs, digest, command)
        info |= {"peaks": write_peaks(journal, motions), "jobs": 0, "wall_s": 0.0, "kept": info["runs"]}
        return finish(directory, study, motions, runs, info, listener)


def _ranges(numbers: Sequence[int], most: int = 5) -> str:
    """Numbers, counted from 1, as ranges: "1 to 12, 17"."""
    starts = [i for i, number in enumerate(numbers) if i == 0 or number != numbers[i - 1] + 1]
    ends = [i - 1 for i in starts[1:]] + [len(numbers) - 1]
    ranges = [
        f"{numbers[a] + 1} to {numbers[b] + 1}" if b > a else str(numbers[a] + 1)
        for a, b in zip(starts, ends, strict=True)
    ]
    return ", ".join(ranges[:most]) + (", …" if len(ranges) > most else "")
