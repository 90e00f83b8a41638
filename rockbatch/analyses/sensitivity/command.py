"""``rockbatch sensitivity``: the sensitivity of the peak rotation, one at a time and by Sobol's indices."""

import argparse

from rockbatch.analyses.sensitivity.analysis import sensitivity
from rockbatch.commands.analysis import analysis_arguments, print_files
from rockbatch.commands.streams import in_width, say, show
from rockbatch.commands.summary import named
from rockbatch.common.lazy import pd
from rockbatch.study import Study


def main(arguments: argparse.Namespace, study: Study) -> int:
    """Compute and print the sensitivity of the peak rotation."""
    result = sensitivity(study, **analysis_arguments(arguments))
    show(shown(result.sensitivity, result.sobol, study.varied))
    ended = ", ".join(f"{number} {status}" for status, number in sorted(result.info["statuses"].items()))
    cut = f"theta_max/alpha = {result.spec.overturned:g}"
    say(f"{ended}; runs that overturned or were ended by flight count as {cut}")
    print_files(result)
    return 1 if result.unusable else 0  # what failed counts, as the report says


def shown(swings: "pd.DataFrame", shares: "pd.DataFrame", varied: tuple[str, ...]) -> str:
    """Return both tables for a terminal, a block for each case: the answer at both ends, and the indices with their errors."""
    keys = ["case", *varied]
    blocks = []
    for names, of_case in swings.groupby(keys, sort=False, dropna=False):
        merged = of_case.merge(shares, on=[*keys, "parameter"])
        cells = {
            "": merged["parameter"],
            **{end: merged[end].map(_value) for end in ("low", "base", "high")},
            **{f"at {end}": merged[f"answer_{end}"].map("{:.4f}".format) for end in ("low", "base", "high")},
            "first-order": merged["first"].map("{:z.2f}".format) + merged["first_error"].map(" ± {:.2f}".format),
            "total": merged["total"].map("{:z.2f}".format) + merged["total_error"].map(" ± {:.2f}".format),
        }
        table = in_width(list(cells), list(zip(*cells.values(), strict=True)))
        head = f"{names[0]} {named(varied, names[1:])}".rstrip()
        blocks.append(f"{head}: theta_max/alpha one at a time, and Sobol indices\n{table}")
    return "\n\n".join(blocks)


def _value(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
