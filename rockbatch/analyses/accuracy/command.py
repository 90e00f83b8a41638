"""``rockbatch accuracy``: error against time per run for a study on this machine."""

import argparse

from rockbatch.analyses.accuracy.analysis import accuracy
from rockbatch.commands.analysis import print_files
from rockbatch.commands.messages import Terminal
from rockbatch.commands.options import folder
from rockbatch.commands.streams import in_width, show
from rockbatch.common.lazy import pd
from rockbatch.study import Study


def main(arguments: argparse.Namespace, study: Study) -> int:
    """Measure error against time, and print them."""
    result = accuracy(
        study,
        folder(arguments),
        runs=arguments.runs,
        seconds=arguments.seconds,
        progress=Terminal(),
    )
    show(shown(result.accuracy))
    print_files(result)
    return 0


def shown(table: "pd.DataFrame") -> str:
    """Return the table for a terminal: errors of θ_max/α, milliseconds per run."""

    def cells(column: str, form: str = ".0f") -> list[str]:
        return ["" if pd.isna(value) else format(value, form) for value in table[column]]

    columns = {
        "": list(table["method"]),
        "k": cells("substeps"),
        "tolerance": cells("tolerance", ".0e"),
        "runs": cells("runs"),
        "median error": cells("error_median", ".1e"),
        "95 %": cells("error_95", ".1e"),
        "largest": cells("error_max", ".1e"),
        "ms per run": [
            "" if pd.isna(s) else f"{1000 * s:{'.0f' if s >= 0.1 else '.3g'}}" for s in table["seconds_per_run"]
        ],
        "other outcome": ["" if n == "0" else n for n in cells("status_differs")],
    }
    rows = list(zip(*columns.values(), strict=True))
    change = table["reference_change"].max()
    return f"Error of theta_max/alpha (references to {change:.0e})\n{in_width(list(columns), rows)}"
