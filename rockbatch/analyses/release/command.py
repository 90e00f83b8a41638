"""``rockbatch release``: restitution, or the losses of springs, fitted to a release test."""

import argparse
import math

from rockbatch.analyses.release.analysis import release
from rockbatch.commands.analysis import print_files
from rockbatch.commands.messages import Terminal
from rockbatch.commands.options import folder
from rockbatch.commands.streams import in_width, show
from rockbatch.commands.summary import named
from rockbatch.common.lazy import pd
from rockbatch.study import Study


def main(arguments: argparse.Namespace, study: Study) -> int:
    """Fit the test, and print what was fitted and how measured and computed values differ."""
    result = release(study, folder(arguments), progress=Terminal())
    show(shown(result.release, result.release_impacts, study.varied))
    print_files(result)
    return 0


def shown(fits: "pd.DataFrame", impacts: "pd.DataFrame", varied: tuple[str, ...]) -> str:
    """Return a block for each case: the fitted value, how well it describes the test, and a table of impacts."""
    keys, blocks = ["case", *varied], []
    for (names, rows), fit in zip(
        impacts.groupby(keys, sort=False, dropna=False), fits.to_dict("records"), strict=True
    ):
        cells = {
            "impact": rows["impact"].map(str),
            "t [s]": rows["t_measured_s"].map(lambda t: _number(t, ".4f")),
            "computed": rows["t_computed_s"].map(lambda t: _number(t, ".4f")),
            "amplitude [rad]": rows["amplitude_measured_rad"].map(lambda a: _number(a, ".5f")),
            "computed ": rows["amplitude_computed_rad"].map(lambda a: _number(a, ".5f")),
            "apparent e": rows["restitution_measured"].map(lambda e: _number(e, ".3f")),
            "computed  ": rows["restitution_computed"].map(lambda e: _number(e, ".3f")),
        }
        head = f"{names[0]} {named(varied, names[1:])}".rstrip()
        table = in_width(list(cells), list(zip(*cells.values(), strict=True)))
        blocks.append(f"{head}: {in_words({str(key): value for key, value in fit.items()})}\n{table}")
    return "\n\n".join(blocks)


def in_words(fit: "dict[str, object]") -> str:
    """Return what was fitted in a case, in sentences."""
    value = {name: float(str(fit[name])) for name in ("value", "low", "high", "confidence", "scatter", "over_housner")}
    text = f"{fit['parameter']} = {value['value']:.4g}, {value['low']:.4g} to {value['high']:.4g} ({value['confidence']:.0%})"
    if not math.isnan(value["over_housner"]):
        text += f", {value['over_housner']:.3f} of Housner's"
    if value["scatter"] > 1e-3 * value["value"]:
        text += f"; it scatters by ±{value['scatter']:.2g} from impact to impact"
    return f"{text}.\n  {fit['remark']}"


def _number(value: float, form: str) -> str:
    return "" if math.isnan(value) else format(value, form)
