"""The answer of rocking spectra and maps in sentences: the largest piers that overturn, and the greatest rotation of others."""

import math
import re
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from rockbatch.analyses.spectrum.map_regions import FLIGHT, OVERTURNED, UNDECIDED
from rockbatch.common.analyses import Entry
from rockbatch.common.lazy import pd
from rockbatch.quantities.labels import plain, quantity, symbol_of
from rockbatch.reporting.finished_analysis import answered, named
from rockbatch.reporting.labels import counted
from rockbatch.reporting.markup import Markup, escape
from rockbatch.reporting.table import sub
from rockbatch.results.labelled import as_dicts

MOST_SLENDERNESSES = 4
"""Most slendernesses of which the answer says what overturns; of more it says so of the first and the last."""
MOST_MAPS = 3
"""Most maps that have a sentence; of more the worst has one."""

Info = Entry
"""Content of spectrum.json."""


def answer(sentences: Sequence[str], remarks: Sequence[str]) -> Markup:
    """Return the sentences as a paragraph, and a line below for each remark."""
    return answered(_marked(" ".join(sentences)), remarks=map(_marked, remarks))


def _marked(words: str) -> Markup:
    """Return escaped words, with subscripts for θ, ω and a before _max, _g and _p; other underscores, as in names, stay."""
    return Markup(re.sub(r"\b([θωa])_(max|g|p)\b", lambda match: sub(match[1], match[2]), escape(words)))


def of_spectra(info: Info, suite: "pd.DataFrame") -> tuple[list[str], list[str]]:
    """Return sentences on the largest piers that overturn and on the greatest median rotation, and remarks on them."""
    remarks, order = list(_of_runs(suite)), _order(info["axis"])
    fallen = suite[suite["overturned"] + suite["flight"] > 0]
    if fallen[order].max() == suite[order].max():
        remarks.insert(0, "The largest piers that were run overturn: larger ones may, too.")
    return [*_overturning(info, suite, fallen), *_greatest(info, suite)], remarks


def _overturning(info: Info, suite: "pd.DataFrame", fallen: "pd.DataFrame") -> Iterator[str]:
    """Yield a sentence on the largest piers that overturn under at least one motion, and under half of them.

    It has a size for each slenderness; of more than MOST_SLENDERNESSES, 4, for the least and the greatest only. If no pier
    overturns, it says so.
    """
    axis, motions, many = info["axis"], counted(info["motions"], "motion"), info["motions"] > 1
    if fallen.empty:
        yield f"No pier overturns under {'any of ' if many else ''}{motions}."
        return
    slendernesses = _ends(sorted(suite["alpha"].unique()))

    def sizes(rows: "pd.DataFrame") -> str:
        return _listed(_largest(rows, axis, alpha) for alpha in slendernesses)

    said = (
        f"The largest piers that overturn under {'one or more of ' if many else ''}{motions} have {_axis(axis)[0]} = "
    )
    said += f"{sizes(fallen)} for α = {_listed(plain(alpha, 3) for alpha in slendernesses)} rad"
    if many:
        half = fallen[np.isinf(fallen["median"])]
        said += f", under half of them {'none' if half.empty else sizes(half)}"
    panels = suite.groupby(_apart(info, suite), dropna=False).ngroups
    yield f"{said}, in the worst of {panels} panels." if panels > 1 else f"{said}."


def _greatest(info: Info, suite: "pd.DataFrame") -> Iterator[str]:
    """Yield "The greatest median rotation is θ_max/α = 0.5 (16 to 84 %: …), at 2π/p = 4 s, α = 0.15 rad.".

    It is over the piers with a finite median; nothing if there are none. Of fewer than 6 motions there are no quantiles.
    """
    standing = as_dicts(suite[np.isfinite(suite["median"])])
    if not standing:
        return
    row = max(standing, key=lambda row: float(row["median"]))
    words, unit = _axis(info["axis"])
    places = [f"{words} = {plain(row[info['axis']], 3)}{unit}", quantity("alpha", row["alpha"])]
    apart = _apart(info, suite)
    places += [named(info, row, apart)] if suite.groupby(apart, dropna=False).ngroups > 1 else []
    of = " of those that stand" if len(standing) < len(suite) else ""
    interval = "" if np.isnan(row["p16"]) else f" (16 to 84 %: {_peak(row['p16'])} to {_peak(row['p84'])})"
    statistic = "median rotation" if info["motions"] > 1 else "rotation"
    yield f"The greatest {statistic}{of} is θ_max/α = {plain(row['median'], 3)}{interval}, at {', '.join(places)}."


def _apart(info: Info, suite: "pd.DataFrame") -> list[str]:
    """Return "case", and the columns of scale and varied keys with several values, but for alpha and the axis of sizes."""
    names = [name for name in ("scale", *info["varied"]) if name not in ("alpha", info["axis"]) and name in suite]
    return ["case", *(name for name in names if suite[name].nunique(dropna=False) > 1)]


def _ends(slendernesses: Sequence[float]) -> list[float]:
    return list(slendernesses) if len(slendernesses) <= MOST_SLENDERNESSES else [slendernesses[0], slendernesses[-1]]


def _of_runs(suite: "pd.DataFrame") -> Iterator[str]:
    """Yield a remark on runs that flight ended, and one on runs that failed, each if there are any."""
    flight, failed = int(suite["flight"].sum()), int(suite["failed"].sum())
    runs = counted(int(suite["count"].sum()) + failed, "run")
    if flight:
        yield f"{flight} of {runs} were ended by flight, and count as overturned."
    if failed:
        yield f"{failed} of {runs} failed, and are left out here."


def _order(axis: str) -> str:
    """Return the column that grows with the size: ``axis`` itself, but "two_pi_over_p_s" for "p", which falls."""
    return "two_pi_over_p_s" if axis == "p" else axis


def _largest(fallen: "pd.DataFrame", axis: str, alpha: float) -> str:
    """Return the size of the largest of the ``fallen`` piers with this slenderness; "none" if none has it."""
    rows = as_dicts(fallen[fallen["alpha"] == alpha])
    if not rows:
        return "none"
    return plain(max(rows, key=lambda row: float(row[_order(axis)]))[axis], 3) + _axis(axis)[1]


def _listed(words: Iterable[str]) -> str:
    *most, last = words
    return f"{', '.join(most)} and {last}" if most else last


def _axis(axis: str) -> tuple[str, str]:
    """Return symbol and unit of ``axis``, a column: "2π/p" and "\u00a0s" of "two_pi_over_p_s"; "" for a column without unit."""
    words, unit = symbol_of(axis)
    return words, f"\u00a0{unit}" if unit else ""


def _peak(value: float) -> str:
    return "overturned" if np.isinf(value) else plain(value, 3)


def of_maps(info: Info, regions: "pd.DataFrame") -> tuple[list[str], list[str]]:
    """Return sentences on the least amplitude that overturns in each map, of over MOST_MAPS, 3, in the worst; and remarks."""
    maps = [of_map for _, of_map in regions.groupby("map", sort=False)]
    of = ""
    if len(maps) > MOST_MAPS:
        of, maps = f", the least of {len(maps)} maps", [min(maps, key=_least)]
    keys = ["case", *info["varied_map"]]
    sentences = [_least_of(info, of_map, keys, of) for of_map in maps]
    return sentences, [f"{of_map['map'].iloc[0]}: {remark}." for of_map in maps for remark in _left_open(of_map)]


def _least(regions: "pd.DataFrame") -> float:
    """Return the least amplitude that overturns in a map, infinite without any."""
    amplitudes = regions.loc[regions["outcome"].isin(OVERTURNED), "low"]
    return float(amplitudes.min()) if len(amplitudes) else math.inf


def _worst(regions: "pd.DataFrame") -> "pd.DataFrame":
    """Return the regions that begin with the least amplitude that overturns."""
    return regions[regions["outcome"].isin(OVERTURNED) & (regions["low"] == _least(regions))]


def _least_of(info: Info, regions: "pd.DataFrame", keys: list[str], of: str) -> str:
    """Return "The least sine that overturns the pier has a_p/(g tan α) = 2.1, at ω_p/p = 3.", or that none of the map does.

    "sine" is the name of the map; of several cases it says for which, or for how many, and ``of`` stands at the end.
    """
    name, worst, cases = regions["map"].iloc[0], _worst(regions), regions.groupby(keys, dropna=False).ngroups
    if worst.empty:
        ends = f"ω_p/p = {_span(regions['omega_p_over_p'])}, up to a_p/(g tan α) = {plain(float(regions['high'].max()), 3)}"
        return f"No {name} of {ends} overturns the pier{f', in any of {cases} cases' if cases > 1 else ''}."
    alike = worst.groupby(keys, dropna=False).ngroups
    least_case = named(info, as_dicts(worst)[0], keys)
    case = f"{least_case}, the least of {cases} cases" if alike == 1 else f"{alike} of {cases} cases"
    least = f"a_p/(g tan α) = {plain(_least(regions), 3)}, at ω_p/p = {_span(worst['omega_p_over_p'])}"
    return f"The least {name} that overturns the pier has {least}{f', for {case}' if cases > 1 else ''}{of}."


def _left_open(regions: "pd.DataFrame") -> Iterator[str]:
    """Yield remarks on lower amplitudes that may overturn, too: by flight, undecided, or beyond the ends of the map."""
    least, worst, frequencies = _least(regions), _worst(regions)["omega_p_over_p"], regions["omega_p_over_p"]
    for outcome, words in (
        (FLIGHT, "the run ends by flight"),
        (UNDECIDED, "it is not decided whether the pier overturns"),
    ):
        rows = regions[(regions["outcome"] == outcome) & (regions["low"] < least)]
        if len(rows):
            lowest = rows[rows["low"] == rows["low"].min()]
            at = f"a_p/(g tan α) = {plain(float(lowest['low'].iloc[0]), 3)} on, at ω_p/p = {_span(lowest['omega_p_over_p'])}"
            yield f"from {at}, {words}"
    if least == regions["low"].min():
        yield "that is the least amplitude of the map, and lower ones may overturn the pier, too"
    elif worst.isin([frequencies.min(), frequencies.max()]).any():
        yield "that is at the end of the map's frequencies, and beyond it less may overturn the pier"


def _span(values: "pd.Series[float]") -> str:
    return " to ".join(dict.fromkeys(plain(float(end), 3) for end in (values.min(), values.max())))
