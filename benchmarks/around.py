"""What a command takes around its kernels: rows, journal, report, start; processor time, so that a busy machine blurs it little.

    python benchmarks/around.py [--times 3] [ROW ...]

"fixed" and "tolerance" run whole studies with `--jobs 1`, the kernels of the same groups of runs alone, and their report and
checks, in turn. "fig7" is `rockbatch run` of the study of that name, then `check` and `report` of its folder; "dry" is
`--dry-run` of a study with dampers. "million", on request only, is a million short runs of rigid piers on rigid ground, once.
The others are medians; what is compiled is compiled before, Python's modules too (PYTHONDONTWRITEBYTECODE, which would have
each command compile them anew, is left out).
"""

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from statistics import median

from rockbatch.batch.groups import groups
from rockbatch.batch.plan import Plan, simulations
from rockbatch.motions.fema_p695 import stations
from rockbatch.simulation import Stop, run_all_fixed, run_all_to_tolerance
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

CONFIGS = Path(__file__).parents[1] / "configs"
CHECKS = CONFIGS / "checks" / "stepping_pier.toml"

STUDY = """
title = "{title}"

[pier]
alpha = 0.13
p = 0.38

[motions]
scale = {scales}

[numerics]
{numerics}

[output]
both_laws = false
histories = "none"

[[case]]
name = "foundation"
base = "yielding"
beta = {betas}
eta = {etas}
epsilon = 0.05
flight = "stop"
"""

DAMPER = """
[[case.damper]]
kind = "viscous"
coefficient_kN_s_m = {coefficients}
"""

RECORD = """
[[motions.fema_p695]]
station = "{station}"
azimuth = 0
"""


def study(title: str, records: int, scales: int, betas: int, etas: int, numerics: str, more: str = "") -> str:
    """A study file of ``records`` × ``scales`` × ``betas`` × ``etas`` runs of the tower of Palmeri & Makris (2007), Fig. 7."""
    near = [each.rsn for each in stations() if each.set != "farfield"][:records]
    text = STUDY.format(
        title=title,
        scales=[round(0.5 + 0.05 * i, 2) for i in range(scales)],
        numerics=numerics,
        betas=[40 + i for i in range(betas)],
        etas=[round(1.5 + 0.1 * i, 2) for i in range(etas)],
    )
    return text + more + "".join(RECORD.format(station=station) for station in near)


PULSES = """
title = "1,000,000 short runs"

[pier]
alpha = {alphas}
p = {ps}

[motions]
scale = {scales}

[numerics]
substeps = 1
quiet_s = 0.5

[output]
histories = "none"

[[case]]
name = "rigid"
base = "rigid"
"""

PULSE = """
[[motions.pulse]]
name = "sine {period:.2f} s"
shape = "sine"
amplitude_g = 0.4
period_s = {period:.2f}
dt_s = 0.02
duration_s = 2.0
"""

STUDIES = {
    "fixed": study("4,800 runs at one step per sample", 12, 4, 10, 10, "substeps = 1"),
    "tolerance": study("16,320 runs to the tolerance, 2,720 groups", 6, 20, 8, 17, "tolerance = 1e-4"),
}


def processor_time(command: Sequence[str]) -> float:
    """User and system time [s] of a process; it may end with 1, where a check failed."""
    usage = usage_of(command)
    return usage.ru_utime + usage.ru_stime


def usage_of(command: Sequence[str]) -> resource.struct_rusage:
    """What a process used, as of :func:`processor_time`."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
    _, status, usage = os.wait4(process.pid, 0)
    assert os.waitstatus_to_exitcode(status) in (0, 1), " ".join(command)
    return usage


def rockbatch(*words: object) -> float:
    """Processor time of a command."""
    return processor_time([sys.executable, "-m", "rockbatch", *map(str, words)])


def alone(file: Path) -> float:
    """Processor time of the kernels of a study, called as a batch on one thread calls them."""
    loaded = load_study(file)
    plan, numerics = Plan(loaded, ground_motions(loaded)), loaded.numerics
    members = [simulations(group.values()) for group in groups(plan, numerics, 1)]

    def run(runs):
        if numerics.substeps is not None:
            return run_all_fixed(runs, [numerics.substeps] * len(runs), numerics.quiet_s, Stop())
        return run_all_to_tolerance(runs, numerics.tolerance, numerics.quiet_s, Stop())

    run(members[0][:1])
    start = time.process_time()
    for runs in members:
        run(runs)
    return time.process_time() - start


def checks_of_one_law(folder: Path) -> Path:
    """The shipped checks, in ``folder``, without those that need settlements by both spring laws."""
    rules = folder / CHECKS.name
    rules.write_text(CHECKS.read_text(encoding="utf-8").replace("other_law = true", ""), encoding="utf-8")
    return rules


def whole(name: str, folder: Path, times: int) -> None:
    """Print what a study of many runs takes over its kernels, what its report takes again, and what judging it does."""
    file, rules = folder / f"{name}.toml", checks_of_one_law(folder)
    file.write_text(STUDIES[name], encoding="utf-8")
    runs = len(Plan(load_study(file), ground_motions(load_study(file))))
    command, kernels, report, check = [], [], [], []
    for _ in range(times):
        kernels.append(alone(file))
        command.append(rockbatch("run", file, "--out", folder / name, "--jobs", 1, "--fresh"))
        report.append(rockbatch("report", folder / name))
        check.append(rockbatch("check", folder / name, "--rules", rules))
    verdicts = len((folder / name / "checks.csv").read_text(encoding="utf-8").splitlines()) - 1
    a, b, c, d = map(median, (command, kernels, report, check))
    print(f"{name}: {runs} runs: whole command {a:.2f} s, kernels alone {b:.2f} s; report again {c:.2f} s, ", end="")
    print(f"check and its report, {verdicts} verdicts, {d:.2f} s", flush=True)


def fig7(folder: Path, times: int) -> None:
    """Print what a small study takes, its checks and its report."""
    out = folder / "fig7"
    run = "run", CONFIGS / "fig7.toml", "--out", out, "--fresh"
    words = (run, ("check", out, "--rules", checks_of_one_law(folder)), ("report", out), ("run", "-h"))
    rockbatch(*run)
    taken = [[rockbatch(*each) for each in words] for _ in range(times)]
    for each, seconds in zip(words, zip(*taken, strict=True), strict=True):
        print(f"rockbatch {' '.join(Path(str(word)).name for word in each)}: {median(seconds):.2f} s", flush=True)


def dry(folder: Path, times: int) -> None:
    """Print what a dry run of 144 runs with dampers takes."""
    file = folder / "dry.toml"
    more = DAMPER.format(coefficients=[2e3, 4e3, 8e3])
    text = study("144 runs with dampers", 6, 2, 2, 2, "tolerance = 1e-4", more)
    file.write_text(text.replace("[pier]", "[pier]\nmass_t = 5000"), encoding="utf-8")
    command = "run", file, "--out", folder / "dry", "--dry-run"
    rockbatch(*command)
    start = time.monotonic()
    taken = median(rockbatch(*command) for _ in range(times))
    wall = (time.monotonic() - start) / times
    print(f"--dry-run of 144 runs with dampers: {taken:.2f} s of processor time, {wall:.2f} s", flush=True)


def million(folder: Path) -> None:
    """Print what a million runs take, the memory, and the size of their page."""
    file, out = folder / "million.toml", folder / "million"
    text = PULSES.format(
        alphas=[round(0.1 + 0.01 * i, 2) for i in range(20)],
        ps=[round(0.8 + 0.1 * i, 1) for i in range(10)],
        scales=[round(0.3 + 0.01 * i, 2) for i in range(100)],
    )
    file.write_text(text + "".join(PULSE.format(period=0.3 + 0.02 * i) for i in range(50)), encoding="utf-8")
    usage = usage_of([sys.executable, "-m", "rockbatch", "run", str(file), "--out", str(out)])
    print(
        f"1,000,000 runs: {usage.ru_utime + usage.ru_stime:.0f} s, {usage.ru_maxrss / 2**20:.2f} GiB at most; page of "
        f"{(out / 'report.html').stat().st_size / 1e6:.1f} MB",
        flush=True,
    )


ROWS = {
    "fixed": lambda folder, times: whole("fixed", folder, times),
    "tolerance": lambda folder, times: whole("tolerance", folder, times),
    "fig7": fig7,
    "dry": dry,
}
LONG = {"million": lambda folder, _: million(folder)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rows", nargs="*", metavar="ROW", help=", ".join([*ROWS, *LONG]))
    parser.add_argument("--times", type=int, default=3)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.rows or ROWS:
            (ROWS | LONG)[name](Path(folder), arguments.times)


if __name__ == "__main__":
    main()
