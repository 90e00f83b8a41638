"""Writing of a folder of results: from finished runs to the table, run.json, histories, checks and the report."""

import datetime
import json
import math
import platform
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rockbatch.batch.beside import rows_beside
from rockbatch.batch.execution import to_simulate
from rockbatch.batch.journal import Journal
from rockbatch.batch.kept_histories import keep_histories, to_keep
from rockbatch.batch.listening import Listener, announced_if_slow
from rockbatch.batch.plan import Plan
from rockbatch.batch.threads import cores
from rockbatch.checks import Verdict, write_verdicts
from rockbatch.checks.checking import verdicts
from rockbatch.checks.suite_target import suite_verdicts
from rockbatch.checks.verdicts import CHECKS
from rockbatch.common.errors import InputError
from rockbatch.common.files import is_plain, legible, read_text, remove
from rockbatch.common.observers import tables
from rockbatch.common.version import __version__
from rockbatch.motions import MotionSet
from rockbatch.reporting import REPORT, write_report
from rockbatch.results.beside_peaks import SEMICOLONS, write
from rockbatch.results.columns import PEAKS, unusable_rows
from rockbatch.results.histories_file import HISTORIES
from rockbatch.results.intensity import INTENSITY, intensities
from rockbatch.results.opened import open_results
from rockbatch.results.reading import Saved, edited
from rockbatch.results.run_json import INFO, describe, versions, write_info
from rockbatch.simulation.observing import Observer
from rockbatch.study import Study

OUTPUTS = (PEAKS, INFO, HISTORIES, INTENSITY, *tables(), CHECKS, REPORT, SEMICOLONS)
"""Files that a run may leave in its folder."""

_OF_COMMAND = ("created", "command", "machine", "jobs", "wall_s", "kept", "peaks")
"""Entries of run.json that tell of the command, and not of what its results are."""


@dataclass(frozen=True, eq=False)
class FinishedBatch:
    """Results that were written into a folder.

    Attributes
    ----------
    saved : Saved
        ``peaks.csv`` and ``run.json``.
    motions : MotionSet
        What the study was run under, and what of it could not be used.
    verdicts : list of Verdict
        Those of the study's checks, and of its target spectrum; empty where it has neither.
    files : tuple of Path
        Table, run.json, histories, checks and report, those that were written.
    without : InputError or None
        Why histories that the study asks for are not there.
    """

    saved: Saved
    motions: MotionSet
    verdicts: list[Verdict]
    files: tuple[Path, ...]
    without: InputError | None


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


def unchanged(
    directory: Path, observers: Sequence[Observer], study: Study, motions: MotionSet, runs: Plan, info: dict[str, Any]
) -> FinishedBatch | None:
    """Return what is in ``directory`` if nothing would change by finishing its runs again, those of ``info``; else None."""
    saved = open_results(directory)
    described = json.loads(json.dumps(info))
    if any(saved.info.get(name) != value for name, value in described.items() if name not in _OF_COMMAND):
        return None
    kept = len(to_keep(study, runs, saved.peaks.iloc[: len(runs)]).numbers)
    try:
        histories = [HISTORIES] if len(saved.responses) else []
        if len(saved.responses) < kept:
            return None
    except (InputError, OSError):  # damaged, or those of an earlier run
        return None
    beside = _beside_peaks(study, observers)
    if not all(is_plain(directory / name) for name in beside):
        return None
    judged = _judged(saved, study)
    names = (PEAKS, INFO, *beside, *histories, *([CHECKS] if judged else []), REPORT)
    files = tuple(directory / name for name in names)
    return FinishedBatch(saved, motions, judged, files, None) if all(map(is_plain, files)) else None


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


def write_peaks(journal: Journal, motions: MotionSet) -> dict[str, Any]:
    """Write peaks.csv; what belongs to earlier ones goes first, so that they cannot be mixed up.

    Returns its number of rows and its digest, as run.json has them.
    """
    directory = journal.path.parent
    for name in OUTPUTS[1:]:
        remove(directory / name)
    return journal.write_in_order(directory / PEAKS, unusable_rows(motions))._asdict()


def finish(
    journal: Journal,
    observers: Sequence[Observer],
    study: Study,
    motions: MotionSet,
    runs: Plan,
    info: dict[str, Any],
    listener: Listener,
    records: Collection[str] = (),
) -> FinishedBatch:
    """Write run.json, histories, checks and the report beside peaks.csv in the folder of its ``journal``.

    ``observers`` are those of tables beside it. Of ``records`` all histories are written, too.

    ``info`` is what run.json is to say: :func:`what_was_run`, ``jobs``, ``wall_s`` and ``kept``.
    """
    directory = journal.path.parent
    remove(directory / REPORT)  # it comes last: where it is, the others are there
    with announced_if_slow(listener, f"writing {INFO}"):
        write_info(directory, info)
        saved = open_results(directory)
    histories, refusal = _keep_histories(saved, study, runs, listener, records)
    beside = [
        write(directory / name, rows)
        for name, rows in _tables(saved, study, motions, runs, journal, observers, listener)
    ]
    with announced_if_slow(listener, f"holding {len(study.checks)} checks against {len(study.cases)} cases"):
        judged = _judged(saved, study)
        checks = write_verdicts(directory, judged) if judged else None
    with announced_if_slow(listener, f"writing {REPORT}"):
        report = write_report(directory, saved=saved)
    written = (directory / PEAKS, directory / INFO, *beside, histories, checks, report)
    return FinishedBatch(saved, motions, judged, tuple(path for path in written if path), refusal)


def _judged(saved: Saved, study: Study) -> list[Verdict]:
    """Return the verdicts of the study's checks and of its target spectrum, if it has them."""
    return verdicts(saved) if study.checks or suite_verdicts(saved.info, ()) else []


def _beside_peaks(study: Study, observers: Iterable[Observer]) -> list[str]:
    """Return the tables that stand beside peaks.csv, of intensity measures and of ``observers``."""
    return [*([INTENSITY] if study.output.intensity else []), *(observer.table for observer in observers)]


def _tables(
    saved: Saved,
    study: Study,
    motions: MotionSet,
    runs: Plan,
    journal: Journal,
    observers: Sequence[Observer],
    listener: Listener,
) -> Iterator[tuple[str, Iterable[dict[str, Any]]]]:
    """Yield name and rows of the tables beside the peaks, and take away those of another time."""
    for name in {INTENSITY, *tables()}.difference(_beside_peaks(study, observers)):
        remove(saved.directory / name)
    if study.output.intensity:
        yield INTENSITY, intensities(saved.peaks, study, motions.motions)
    jobs = min(int(saved.info["jobs"]) or cores(), cores())
    yield from rows_beside(observers, study, runs, saved.peaks, journal, jobs, listener).items()


def _keep_histories(
    saved: Saved, study: Study, runs: Plan, listener: Listener, records: Collection[str]
) -> tuple[Path | None, InputError | None]:
    """Write the histories that the study asks for: their file, and why some are not in it."""
    chosen = to_keep(study, runs, saved.peaks.iloc[: len(runs)], records)
    if chosen.left_out:
        number = len(chosen.numbers)
        listener.say(
            f"{HISTORIES}: {number} of the {number + chosen.left_out} worst runs, those with the greatest rotations; more would "
            f"exceed [output] histories_MB = {study.output.histories_MB:g}"
        )
    try:
        with listener.progress(len(chosen.numbers)) as progress:
            path = keep_histories(saved, study, runs, progress, records)
    except InputError as error:
        return None, error
    if path is None:
        remove(saved.directory / HISTORIES)
    return path, None
