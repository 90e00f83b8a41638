"""How a batch ends, in one process or in several: from its finished runs to everything in the folder of its results."""

import datetime
import json
import platform
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockbatch._version import __version__
from rockbatch.commands.messages import count, say

if TYPE_CHECKING:
    from rockbatch.batch.journal import Journal
    from rockbatch.batch.plan import Plan
    from rockbatch.motions import MotionSet
    from rockbatch.results.reading import Saved
    from rockbatch.study import Study

PACKAGES = ("numba", "numpy", "pandas", "obspy", "h5py")


def what_was_run(study: "Study", motions: "MotionSet", runs: "Plan", digest: dict[str, str]) -> dict[str, Any]:
    """What run.json says, but for what the runs cost."""
    from rockbatch.batch.carrying_out import to_simulate
    from rockbatch.batch.threads import cores
    from rockbatch.results.columns import describe

    return {
        "rockbatch": __version__,
        "created": datetime.datetime.now().astimezone().isoformat(timespec="seconds"),
        "command": ["rockbatch", *sys.argv[1:]],
        **describe(study, motions),
        "versions": _versions(),
        "machine": f"{platform.system()} {platform.machine()}, {cores()} processors",
        "runs": len(to_simulate(runs, range(len(runs)))),
        "digest": digest,
    }


def cost_of_finished(directory: Path, info: dict[str, Any]) -> dict[str, Any] | None:
    """What the runs in ``directory`` cost, if they are those of ``info``, all of them; else None."""
    from rockbatch.results.columns import INFO, PEAKS

    try:
        earlier = json.loads((directory / INFO).read_text(encoding="utf-8"))
        same = all(earlier[name] == info[name] for name in ("digest", "runs", "varied", "unusable"))
        cost = {name: earlier[name] for name in ("jobs", "wall_s", "kept")}
    except (OSError, ValueError, LookupError, TypeError):
        return None
    return cost if same and (directory / PEAKS).exists() else None


def write_peaks(journal: "Journal", motions: "MotionSet") -> None:
    """Write peaks.csv; what belongs to earlier ones goes first, so that they cannot be mixed up."""
    from rockbatch.results.columns import INFO, PEAKS, unusable_rows

    directory = journal.path.parent
    (directory / INFO).unlink(missing_ok=True)
    _remove_what_was_made_of_peaks(directory)
    journal.write_in_order(directory / PEAKS, unusable_rows(motions))


def end(directory: Path, study: "Study", motions: "MotionSet", runs: "Plan", info: dict[str, Any]) -> int:
    """Write run.json, histories, checks and report beside peaks.csv, and tell them; returns the exit code."""
    from rockbatch.checks.suite import simulated
    from rockbatch.commands.summary import other_law, summary
    from rockbatch.results.columns import INFO, PEAKS, write_info
    from rockbatch.results.reading import read_saved

    write_info(directory, info)
    saved = read_saved(directory)
    code, histories = _keep_histories(saved, study, runs)
    peaks = simulated(saved.peaks)
    by_pga = [motion.name for motion in sorted(motions.motions, key=lambda motion: motion.pga)]
    print(summary(peaks, study.varied, by_pga))
    if warning := other_law(peaks, study.varied):
        say(warning)
    if study.checks:
        from rockbatch.commands.check import tell
        from rockbatch.results.checking import verdicts

        code = max(code, tell(directory, verdicts(saved)))

    from rockbatch.report import write_report

    report = write_report(directory)
    for path in (directory / PEAKS, directory / INFO, histories, report):
        if path:
            say(str(path))
    if failed := int((peaks["status"] == "failed").sum()):
        say(f"{count(failed, 'row')} with status failed; the column reason says why")
        code = 1
    return code


def _remove_what_was_made_of_peaks(directory: Path) -> None:
    from rockbatch.checks.verdicts import CHECKS
    from rockbatch.results.columns import HISTORIES, REPORT

    for name in (HISTORIES, CHECKS, REPORT):
        (directory / name).unlink(missing_ok=True)


def _keep_histories(saved: "Saved", study: "Study", runs: "Plan") -> tuple[int, Path | None]:
    """Write the histories that the study asks for: exit code, and the file; what cannot be written is told."""
    from rockbatch.batch.kept_histories import keep_histories, kept
    from rockbatch.commands.progress import Progress
    from rockbatch.errors import InputError
    from rockbatch.results.columns import HISTORIES

    try:
        with Progress(len(kept(study, saved.peaks.iloc[: len(runs)]))) as progress:
            path = keep_histories(saved, study, runs, lambda: progress(1))
        if path is None:
            (saved.directory / HISTORIES).unlink(missing_ok=True)
        return 0, path
    except InputError as error:
        say(str(error))
        return 1, None


def _versions() -> dict[str, str]:
    from importlib.metadata import version

    return {"python": platform.python_version(), **{name: version(name) for name in PACKAGES}}
