"""``rockbatch accuracy``: error against time per run for a study on this machine, beside SciPy's solvers."""

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockbatch.commands.messages import say
from rockbatch.commands.options import add_study, folder, study_of

if TYPE_CHECKING:
    import pandas as pd

HELP = "measure error against time per run, for this study on this machine"
RUNS = 24


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_study(parser)
    parser.add_argument(
        "--runs",
        type=_runs,
        default=RUNS,
        metavar="N",
        help=f"runs to measure, spread over the study (default: {RUNS})",
    )


def _runs(text: str) -> int:
    runs = int(text)
    if runs < 1:
        raise argparse.ArgumentTypeError(f"{text}: must be at least 1")
    return runs


def main(arguments: argparse.Namespace) -> int:
    study = study_of(arguments)
    directory = folder(arguments)

    from rockbatch.analysis.accuracy import measure, reference, spread
    from rockbatch.batch.plan import Plan
    from rockbatch.commands.progress import Progress
    from rockbatch.errors import InputError
    from rockbatch.files import write_whole
    from rockbatch.study.suite import ground_motions

    motions = ground_motions(study)
    runs = Plan(study, motions)
    chosen = spread(runs, arguments.runs)
    say(f"{len(chosen)} of {len(runs)} runs: first their references, then a minute or so of measurements")
    found = []
    with Progress(len(chosen)) as progress:
        for run in chosen:
            found.append(reference(run, study.numerics.quiet_s))
            progress()
    references = [one for one in found if one is not None]
    if not references:
        raise InputError(
            f"{arguments.study}: no run settles with ever smaller steps, so there is nothing to measure errors against"
        )
    if len(references) < len(found):
        say(f"left out: {len(found) - len(references)} that do not settle with ever smaller steps")
    table = measure(study, references)
    directory.mkdir(parents=True, exist_ok=True)
    write_whole(directory / "accuracy.csv", table.to_csv(index=False, float_format="%.6g", lineterminator="\n"))
    print(shown(table))
    say(str(directory / "accuracy.csv"))
    if _same_study(directory, table["study"].iloc[0], motions):
        from rockbatch.report import write_report

        say(str(write_report(directory)))
    return 0


def shown(table: "pd.DataFrame") -> str:
    """The table for a terminal: errors of θ_max/α, milliseconds per run."""
    import pandas as pd

    def error(value: float) -> str:
        return "" if pd.isna(value) else f"{value:.1e}"

    def milliseconds(seconds: float) -> str:
        if pd.isna(seconds):
            return ""
        return f"{1000 * seconds:.0f}" if seconds >= 0.1 else f"{1000 * seconds:.3g}"

    cells = pd.DataFrame(
        {
            "": table["method"],
            "k": ["" if pd.isna(k) else str(k) for k in table["substeps"]],
            "tolerance": ["" if pd.isna(value) else f"{value:.0e}" for value in table["tolerance"]],
            "runs": table["runs"],
            "median error": table["error_median"].map(error),
            "95 %": table["error_95"].map(error),
            "largest": table["error_max"].map(error),
            "ms per run": table["seconds_per_run"].map(milliseconds),
            "other outcome": table["status_differs"].map(lambda count: str(count) if count else ""),
        }
    )
    settled = table["reference_change"].max()
    return f"Error of theta_max/alpha (references to {settled:.0e})\n{cells.to_string(index=False)}"


def _same_study(directory: Path, digest: str, motions: Any) -> bool:
    """Whether the folder holds results of this very study with these motions, whose report can show the table."""
    try:
        info = json.loads((directory / "run.json").read_text(encoding="utf-8"))
        records = [record["record"] for record in info["records"]]
        same = info["study"]["sha256"] == digest and records == [motion.name for motion in motions.motions]
    except (OSError, ValueError, KeyError, TypeError):
        return False
    return same and (directory / "peaks.csv").exists()
