"""Quantities of a release test, as the terminal and the page show them: heads, formats and meanings."""

from rockbatch.common.analyses import Entry
from rockbatch.reporting.markup import number
from rockbatch.reporting.table import Head


def interval(fit: Entry) -> str:
    """Return the interval of a fitted value with its confidence: "0.9061 to 0.918 (95%)"."""
    return f"{number(fit['low'], '.4g')} to {number(fit['high'], '.4g')} ({float(fit['confidence']):.0%})"


def in_words(fit: Entry) -> str:
    """Return the fitted value: "restitution = 0.9122 (95 %: 0.9061 to 0.918), Housner's is 0.9118".

    Housner's is of a restitution alone; behind stands the scatter from impact to impact if above 0.1 % of the value.
    """
    value, low, high = (number(fit[name], ".4g") for name in ("value", "low", "high"))
    text = f"{fit['parameter']} = {value} ({100.0 * fit['confidence']:g} %: {low} to {high})"
    if fit["over_housner"] > 0.0:
        text += f", Housner's is {fit['value'] / fit['over_housner']:.4g}"
    if fit["scatter"] > 1e-3 * fit["value"]:
        text += f"; it scatters by ±{fit['scatter']:.2g} from impact to impact"
    return text


FIT = (
    Head("fitted", value="parameter"),
    Head("value", ".4g", value="value"),
    Head("interval", value=interval),
    Head("scatter", ".2g", "standard deviation from impact to impact, beside errors of reading", value="scatter"),
    Head("over Housner's", ".3f", "over the value that keeps the angular momentum", value="over_housner"),
)
"""Heads of a table of release.csv."""


def _beside(name: str, unit: str, group: str, form: str) -> tuple[Head, Head]:
    """Return the heads of a measured quantity and of the computed one."""
    return (
        Head("measured", form, group=group, value=f"{name}_measured{unit}"),
        Head("computed", form, group=group, value=f"{name}_computed{unit}"),
    )


IMPACTS = (
    Head("impact", "d", value="impact"),
    *_beside("t", "_s", "time [s]", ".4f"),
    *_beside("amplitude", "_rad", "amplitude [rad]", ".5f"),
    *_beside("restitution", "", "apparent e", ".3f"),
)
"""Heads of a table of release_impacts.csv."""
