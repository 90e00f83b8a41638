"""``rockbatch accuracy``: error against time per run for a study on this machine, beside SciPy's solvers."""

import argparse

from rockbatch.commands.analyses import tell_files
from rockbatch.commands.messages import Terminal, in_width, show
from rockbatch.commands.options import add_study, folder, study_of
from rockbatch.lazy import pd

HELP = "measure error against time of a study on this machine"
EXAMPLE = "rockbatch accuracy pier.toml --no-scipy"
RUNS, SECONDS = 24, 60.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_study(parser)
    parser.add_argument(
        "--runs",
        type=_runs,
        default=RUNS,
        metavar="N",
        help=f"runs to measure, spread over the study (default: {RUNS})",
    )
    parser.add_argument(
        "--seconds",
        type=_seconds,
        default=SECONDS,
        metavar="S",
        help=f"how long it may take; what there is no time for is left out (default: {SECONDS:g})",
    )
    parser.add_argument("--no-scipy", action="store_true", help="leave out SciPy's solvers, which are slow")


def _runs(text: str) -> int:
    runs = int(text)
    if runs < 1:
        raise argparse.ArgumentTypeError(f"{text}: must be at least 1")
    return runs


def _seconds(text: str) -> float:
    seconds = float(text)
    if not seconds > 0:
        raise argparse.ArgumentTypeError(f"{text}: must be above 0")
    return seconds


def main(arguments: argparse.Namespace) -> int:
    study = study_of(arguments)

    from rockbatch.analysis.accuracy import accuracy

    result = accuracy(
        study,
        folder(arguments),
        runs=arguments.runs,
        seconds=arguments.seconds,
        scipy=not arguments.no_scipy,
        progress=Terminal(),
    )
    show(shown(result.accuracy))
    tell_files(result)
    return 0


def shown(table: "pd.DataFrame") -> str:
    """Return the table for a terminal: errors of θ_max/α, milliseconds per run."""

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
    change = table["reference_change"].max()
    return f"Error of theta_max/alpha (references to {change:.0e})\n{in_width(cells, index=False)}"
