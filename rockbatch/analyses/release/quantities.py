"""Quantities of a release test, as the terminal and the page show them: heads, formats and meanings."""

from rockbatch.common.analyses import Entry
from rockbatch.reporting.markup import number
from rockbatch.reporting.table import Head


def interval(fit: Entry) -> str:
    """Return the interval of a fitted value with its confidence: "0.9061 to 0.918 (95%)"."""
    return f"{number(fit['low'], '.4g')} to {number(fit['high'], '.4g')} ({float(fit['confidence']):.0%})"


def in_words(fit: Entry) -> str:
    """Return the fitted value: "restitution = 0.9122 (95 %: 0.9061 to 0.918), Housner's is 0.9118"; then its scatter if above 0.1
    %.
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
    Head("of Housner's", ".3f", "over the value that keeps the angular momentum", value="over_housner"),
)
"""Heads of a table of release.csv."""

IMPACTS = (
    Head("impact", "d", value="impact"),
    *(
        Head(origin, form, group=group, value=f"{name}_{origin}{unit}")
        for name, unit, group, form in (
            ("t", "_s", "time [s]", ".4f"),
            ("amplitude", "_rad", "amplitude [rad]", ".5f"),
            ("restitution", "", "apparent e", ".3f"),
        )
        for origin in ("measured", "computed")
    ),
)
"""Heads of a table of release_impacts.csv."""
