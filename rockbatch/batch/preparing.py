"""Prepare a study for execution in a folder, and recognise earlier results there."""

import datetime
import json
import math
import platform
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

from rockbatch.batch.digests import study_digests
from rockbatch.batch.execution import to_simulate
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import Listener, count, once
from rockbatch.batch.observers import observers_beside
from rockbatch.batch.plan import Plan, Runs
from rockbatch.batch.threads import cores
from rockbatch.common.errors import InputError
from rockbatch.common.files import legible, read_text, refuse_irregular
from rockbatch.common.grouping import closest
from rockbatch.common.observers import tables
from rockbatch.common.version import __version__
from rockbatch.motions import MotionSet
from rockbatch.quantities.rows import PEAKS
from rockbatch.results.beside_peaks import SEMICOLONS
from rockbatch.results.columns import JOURNAL, columns
from rockbatch.results.histories_file import HISTORIES
from rockbatch.results.labelled import Row
from rockbatch.results.reading import edited
from rockbatch.results.run_json import INFO, describe, versions
from rockbatch.simulation.observing import Observer
from rockbatch.study import Study
from rockbatch.study.suite import ground_motions

OUTPUTS = (PEAKS, INFO, HISTORIES, *tables(), SEMICOLONS)
"""Files that a batch may leave in its folder."""


@dataclass(frozen=True, eq=False)
class Batch:
    """A study that is ready to be carried out in a folder."""

    directory: Path  # folder of its results
    study: Study
    motions: MotionSet  # its ground motions, and the files that could not be used
    runs: Plan
    observers: tuple[Observer, ...]  # observers that write tables beside peaks.csv
    info: Row  # content of run.json without the cost
    listener: Listener  # receives its messages and progress
    later: tuple[str, ...] = ()  # names of files that the caller derives from the results; removed with the results

    def journal(self, fresh: bool = False) -> Journal:
        """Return the journal of finished runs, a context; with ``fresh`` earlier runs are dropped."""
        return Journal(
            self.directory / JOURNAL,
            columns(self.study),
            self.info["digest"],
            fresh,
            runs=len(self.runs),
            tell=self.listener.say,
            beside=[observer.table for observer in self.observers],
        )

    @property
    def run_count(self) -> str:
        """Return the number of runs in words; see :func:`run_count`."""
        return run_count(self.study, self.motions)


def prepare(
    directory: Path,
    study: Study,
    listener: Listener,
    command: Sequence[str],
    *,
    records: Collection[str] = (),
    later: tuple[str, ...] = (),
) -> Batch:
    """Read the motions of ``study`` and prepare its runs for execution in ``directory``.

    ``command`` holds the words after ``rockbatch`` that repeat it, for run.json; ``records`` are names that must exist.
    Raises ``InputError`` for unknown ``records``, or if something other than a regular file is where one will be written.
    """
    refuse_irregular(*(directory / name for name in (*OUTPUTS, *later)))
    motions = ground_motions(study)
    listener.motions(motions)
    check_records(records, motions)
    runs = Plan(study, motions)
    info = run_info(study, motions, runs, study_digests(study, motions), command)
    observers = observers_beside(study.output, motions.motions)
    return Batch(directory, study, motions, runs, observers, info, listener, later)


def run_info(study: Study, motions: MotionSet, runs: Plan, digest: dict[str, str], command: Sequence[str]) -> Row:
    """Return the content of run.json without the cost; ``command`` holds the words after ``rockbatch`` that repeat it."""
    return {
        "rockbatch": __version__,
        "created": datetime.datetime.now().astimezone().isoformat(timespec="seconds"),
        "command": ["rockbatch", *command],
        **describe(study, motions),
        "versions": versions(),
        "machine": f"{platform.system()} {platform.machine()}, {cores()} processors",
        "runs": len(to_simulate(runs, range(len(runs)))),
        "digest": digest,
    }


def cost_of_finished(directory: Path, info: Row) -> Row | None:
    """Return the cost of the finished results in ``directory``, or None.

    They count if digests, runs, varied keys and unusable files are those of ``info``. Raises ``InputError`` if they are, but
    their table was edited, so that it is not overwritten.
    """
    try:
        earlier = json.loads(read_text(directory / INFO))
        is_same = all(earlier[name] == info[name] for name in ("digest", "runs", "varied", "unusable"))
        cost = {name: earlier[name] for name in ("jobs", "wall_s", "kept", "peaks")}
        jobs, wall_s, n_kept = (float(cost[name]) for name in ("jobs", "wall_s", "kept"))
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        return None
    if not (is_same and math.isfinite(jobs + wall_s + n_kept) and (directory / PEAKS).exists()):
        return None
    if differs := edited(directory, earlier):
        raise InputError(
            f"{directory / PEAKS}: {differs}; nothing was run: move it away if you edited it, and run the study again with "
            "--fresh"
        )
    return cost


def to_be_replaced(directory: Path, study: Study) -> str | None:
    """Describe the results in ``directory`` that those of ``study`` will replace; None if there are none that can be read.

    Raises ``InputError`` for results of another study: of another file or, if that is gone, with another title.
    """
    try:
        earlier = json.loads(read_text(directory / INFO))
        path, title = Path(earlier["study"]["path"]), str(earlier["study"]["title"])
        created = str(earlier["created"])[:16].replace("T", " ")
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        return None
    is_same = path.samefile(study.path) if path.exists() and study.path.exists() else title == study.title
    if not is_same:
        raise InputError(
            f'{directory} holds the results of another study, {legible(str(path))}, "{legible(title)}", of {legible(created)}; '
            "choose another folder with --out, or replace them with --fresh"
        )
    return f"the results of an earlier version of the study, of {legible(created)}, in {directory}"


def run_count(study: Study, motions: MotionSet) -> str:
    """Return the number of runs as a product: "4 records of 2 stations × 5 cases = 20 runs".

    Stations are named if fewer than the records, scales if several; mirror images are not counted, :func:`once` says so.
    """
    factors = {"record": len(motions.motions), "scale": len(study.motions.scale), "case": len(study.cases)}
    counted = [count(n, noun) for noun, n in factors.items() if n > 1 or noun in ("record", "case")]
    stations = len({motion.of_station for motion in motions.motions})
    if stations < factors["record"]:
        counted[0] += f" of {count(stations, 'station')}"
    return f"{' × '.join(counted)} = {count(math.prod(factors.values()), 'run')}{once(study)}"


def check_records(records: Collection[str], motions: MotionSet) -> None:
    """Raise ``InputError`` for ``records`` that are not names of ``motions``."""
    names = [motion.name for motion in motions.motions]
    wrong = []
    for name in (name for name in records if name not in names):
        near = closest(name, names)
        hint = f"did you mean {near}?" if near else f"there is {', '.join(names)}"
        wrong.append(f"--history {name}: no such record; {hint}")
    if wrong:
        raise InputError(*wrong)


def share_of(runs: Runs, share: int, shares: int) -> Collection[int]:
    """Return the indices, ascending, of the ``share``-th (from 1) of ``shares`` consecutive parts of ``runs``.

    Parts are equal to within one simulation, and have a run together with its mirror image. Raises ``InputError`` for more shares
    than simulations.
    """
    simulated = to_simulate(runs, range(len(runs)))
    n = len(simulated)
    if shares > n:
        images = "" if n == len(runs) else ", each for a run and its mirror image"
        raise InputError(
            f"--shard {share}/{shares}: the study has {count(n, 'simulation')}{images}; make as many shares or fewer"
        )
    part = simulated[n * (share - 1) // shares : n * share // shares]
    # A dictionary, since runs are looked up in it one by one
    return dict.fromkeys(sorted(image for index in part for image in runs.images(index))).keys()
