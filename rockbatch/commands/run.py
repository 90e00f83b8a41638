"""``rockbatch run``: a study file to peaks.csv, run.json and report.html."""

import argparse
import datetime
import platform
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

from rockbatch import __version__

HELP = "run every record of a study in every case; write the table of peaks and the report"
PACKAGES = ("numba", "numpy", "pandas", "obspy", "h5py")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("study", type=Path, metavar="STUDY.toml", help="the study file")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for the results (default: reports/STUDY)")
    parser.add_argument("--jobs", type=_jobs, metavar="N", help="threads (default: all processors)")
    parser.add_argument(
        "--motions", type=Path, metavar="PATH", help="file or folder of records instead of the study's motions"
    )
    parser.add_argument("--strict", action="store_true", help="run nothing if any record cannot be used")


def _jobs(text: str) -> int:
    jobs = int(text)
    if jobs < 1:
        raise argparse.ArgumentTypeError(f"{text}: must be at least 1")
    return jobs


def main(arguments: argparse.Namespace) -> int:
    from rockbatch.study import load_study

    started = time.monotonic()
    study = load_study(arguments.study, motions=arguments.motions)
    if arguments.strict:
        study = replace(study, motions=replace(study.motions, strict=True))
    directory = arguments.out or Path("reports") / arguments.study.stem

    from rockbatch.batch import compile_kernels, cores, outcomes, row_of
    from rockbatch.commands.progress import Progress
    from rockbatch.commands.summary import other_law, summary
    from rockbatch.core.kernel import is_compiled
    from rockbatch.plan import Plan
    from rockbatch.results import INFO, PEAKS, PeaksFile, describe, unusable_rows, write_info
    from rockbatch.saved import read_saved
    from rockbatch.study.suite import ground_motions

    motions = ground_motions(study)
    for file in motions.unusable:
        _say(f"not used: {file.source}: {file.reason}")
    if motions.left_out:
        _say(f"{_count(len(motions.left_out), 'file')} left out, or no records: the report says why")
    jobs = arguments.jobs or cores()
    runs = Plan(study, motions)
    factors = (
        (len(motions.motions), "record"),
        (len(study.motions.polarity), "direction"),
        (len(study.motions.scale), "scale"),
        (len(study.cases), "case"),
    )
    counted = " × ".join(_count(n, noun) for n, noun in factors if n > 1 or noun in ("record", "case"))
    _say(f"{counted} = {_count(len(runs), 'run')} on {_count(jobs, 'thread')}")
    if not is_compiled():
        _say("compiling the kernels (once per installation, about 20 s)")
    compile_kernels(study)
    interrupted = False
    with PeaksFile(directory, study) as peaks, Progress(len(runs)) as progress:
        try:
            for index, outcome in outcomes(runs, study.numerics, jobs, study.output):
                peaks.add(index, row_of(runs[index], outcome))
                progress()
        except KeyboardInterrupt:
            interrupted = True
        peaks.end_with(unusable_rows(motions))
    info = {
        "rockbatch": __version__,
        "created": datetime.datetime.now().astimezone().isoformat(timespec="seconds"),
        "command": ["rockbatch", *sys.argv[1:]],
        **describe(study, motions),
        "versions": _versions(),
        "machine": f"{platform.system()} {platform.machine()}, {cores()} processors",
        "runs": peaks.finished,
        "jobs": jobs,
        "wall_s": round(time.monotonic() - started, 3),
    }
    write_info(directory, info)
    if interrupted:
        _say(f"interrupted: {peaks.finished} of {len(runs)} runs are in {directory / PEAKS}")
        return 130

    saved = read_saved(directory)
    code, histories = _keep_histories(saved, study, runs)
    by_pga = [motion.name for motion in sorted(motions.motions, key=lambda motion: motion.pga)]
    print(summary(saved.peaks, study.varied, by_pga))
    if warning := other_law(saved.peaks):
        _say(warning)
    if study.checks:
        from rockbatch.commands.check import tell
        from rockbatch.design import verdicts

        code = max(code, tell(directory, verdicts(saved)))

    from rockbatch.report import write_report

    report = write_report(directory)
    for path in (directory / PEAKS, directory / INFO, histories, report):
        if path:
            _say(str(path))
    if peaks.failed:
        _say(f"{_count(peaks.failed, 'row')} with status failed; the column reason says why")
        code = 1
    return code


def _keep_histories(saved: Any, study: Any, runs: Any) -> tuple[int, Path | None]:
    """Write the histories that the study asks for: exit code, and the file; what cannot be written is told."""
    from rockbatch.errors import InputError
    from rockbatch.keep import keep_histories

    try:
        return 0, keep_histories(saved, study, runs)
    except InputError as error:
        _say(str(error))
        return 1, None


def _count(n: int, noun: str) -> str:
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"


def _versions() -> dict[str, str]:
    from importlib.metadata import version

    return {"python": platform.python_version(), **{name: version(name) for name in PACKAGES}}


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
