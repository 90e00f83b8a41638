"""A study that is ready to be carried out in a folder, and what of it is there already."""

import datetime
import json
import math
import platform
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rockbatch.batch.digests import study_digests
from rockbatch.batch.execution import to_simulate
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import Listener, count, once
from rockbatch.batch.observers import observers_beside
from rockbatch.batch.plan import Plan
from rockbatch.batch.threads import cores
from rockbatch.common.errors import InputError
from rockbatch.common.files import legible, read_text, refuse_irregular
from rockbatch.common.grouping import closest
from rockbatch.common.observers import tables
from rockbatch.common.version import __version__
from rockbatch.motions import MotionSet
from rockbatch.results.beside_peaks import SEMICOLONS
from rockbatch.results.columns import JOURNAL, PEAKS, columns
from rockbatch.results.histories_file import HISTORIES
from rockbatch.results.reading import edited
from rockbatch.results.run_json import INFO, describe, versions
from rockbatch.simulation.observing import Observer
from rockbatch.study import Study
from rockbatch.study.suite import ground_motions

OUTPUTS = (PEAKS, INFO, HISTORIES, *tables(), SEMICOLONS)
"""Files that a batch may leave in its folder."""


@dataclass(frozen=True, eq=False)
class Batch:
    """A study that is ready to be carried out in a folder.

    Attributes
    ----------
    directory : Path
        The folder of its results.
    study : Study
        The study.
    motions : MotionSet
        What it is run under, and what of it could not be used.
    runs : Plan
        Its runs.
    observers : tuple of Observer
        Those of its tables beside peaks.csv.
    info : dict
        Content of run.json but for the cost.
    listener : Listener
        Receives its messages and progress.
    later : tuple of str
        Files beside those of the batch, which whoever asked for it makes of them, and which go with them.
    """

    directory: Path
    study: Study
    motions: MotionSet
    runs: Plan
    observers: tuple[Observer, ...]
    info: dict[str, Any]
    listener: Listener
    later: tuple[str, ...] = ()

    def journal(self, fresh: bool = False) -> Journal:
        """Return the journal of its finished runs, a context; without those of earlier processes if ``fresh``."""
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
    def described(self) -> str:
        """How many runs there are, and why."""
        return described(self.study, self.motions)


def prepare(
    directory: Path,
    study: Study,
    listener: Listener,
    command: Sequence[str],
    *,
    records: Collection[str] = (),
    later: tuple[str, ...] = (),
) -> Batch:
    """Read the motions of ``study``, and return it ready to be carried out in ``directory``.

    ``command`` are the words after ``rockbatch`` that do it again, for run.json, ``records`` names of records that have to be
    there. Raises ``InputError`` where something other than a file is in the way.
    """
    refuse_irregular(*(directory / name for name in (*OUTPUTS, *later)))
    motions = ground_motions(study)
    listener.motions(motions)
    check_records(records, motions)
    runs = Plan(study, motions)
    info = what_was_run(study, motions, runs, study_digests(study, motions), command)
    return Batch(
        directory, study, motions, runs, observers_beside(study.output, motions.motions), info, listener, later
    )


def what_was_run(
    study: Study, motions: MotionSet, runs: Plan, digest: dict[str, str], command: Sequence[str]
) -> dict[str, Any]:
    """Return the content of run.json but for the cost; ``command`` are the words after ``rockbatch`` that do it again."""
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


def cost_of_finished(directory: Path, info: dict[str, Any]) -> dict[str, Any] | None:
    """Return the cost of the runs in ``directory``, if they are those of ``info``, all of them; else None.

    Raises ``InputError`` where they are, and their table is not as it was written: it is nobody's to write over.
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
            f"{directory / PEAKS}: {differs}; nothing is run: keep it as a copy elsewhere if it was edited, and run the "
            "study again with --fresh"
        )
    return cost


def to_be_replaced(directory: Path, study: Study) -> str | None:
    """Describe the results in ``directory`` that those of ``study`` will replace; None without any.

    Raises ``InputError`` for those of another study: of another file, or of one that is gone and had another title.
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


def described(study: Study, motions: MotionSet) -> str:
    """Return how many runs there are, and why: "2 records × 5 cases = 10 runs"."""
    factors = {
        "record": len(motions.motions),
        "scale": len(study.motions.scale),
        "case": len(study.cases),
    }
    counted = [count(n, noun) for noun, n in factors.items() if n > 1 or noun in ("record", "case")]
    stations = len({motion.of_station for motion in motions.motions})
    if stations < factors["record"]:
        counted[0] += f" of {count(stations, 'station')}"
    return f"{' × '.join(counted)} = {count(math.prod(factors.values()), 'run')}{once(study)}"


def check_records(records: Collection[str], motions: MotionSet) -> None:
    """Raise ``InputError`` for names of records that do not exist."""
    names = [motion.name for motion in motions.motions]
    wrong = []
    for name in (name for name in records if name not in names):
        near = closest(name, names)
        wrong.append(
            f"--history {name}: no such record; "
            + (f"did you mean {near}?" if near else f"there is {', '.join(names)}")
        )
    if wrong:
        raise InputError(*wrong)


def share_of(runs: int, share: int, shares: int) -> range:
    """Return the indices of a share of so many runs; ``InputError`` for more shares than runs."""
    if shares > runs:
        raise InputError(f"--shard {share}/{shares}: the study has {count(runs, 'run')}; make as many shares or fewer")
    return range(runs * (share - 1) // shares, runs * share // shares)
