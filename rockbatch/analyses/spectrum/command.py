"""``rockbatch spectrum``: rocking spectra and overturning maps of a study, as tables and in the report."""

import argparse

import numpy as np

from rockbatch.analyses.spectrum.analysis import spectrum
from rockbatch.analyses.spectrum.rocking_spectrum import OWN, groups
from rockbatch.analyses.spectrum.study import SELF_SIMILAR, SpectrumSpec
from rockbatch.common.analyses import Entry
from rockbatch.common.grouping import spread
from rockbatch.common.lazy import pd
from rockbatch.reporting.finished_analysis import named
from rockbatch.study import Study
from rockbatch.terminal.analysis import analysis_arguments, finished
from rockbatch.terminal.streams import in_width, show

MOST_LINES = 12
"""Greatest number of lines of a table for the terminal."""


def main(arguments: argparse.Namespace, study: Study) -> int:
    """Compute spectra and maps, and print them; return the exit code."""
    result = spectrum(study, **analysis_arguments(arguments))
    if result.spectra is not None and result.spectrum_suite is not None:
        show(shown(result.info, result.spectrum_suite, result.spectra))
    if result.overturning_map is not None:
        show(shown_maps(result.info, result.overturning_map))
    return finished(result)


def shown(info: Entry, suite: "pd.DataFrame", spectrum: SpectrumSpec) -> str:
    """Return medians of θ_max/α for a terminal: a line for each of up to MOST_LINES, 12, values on the axis, ∞ if overturned."""
    axis = spectrum.axis
    keys = [name for name in groups(spectrum.varied) if name != axis]
    labels = [name for name in keys if name != "case" and (name != "scale" or suite[name].nunique() > 1)]
    lines = spread(suite[axis].unique().tolist(), MOST_LINES)
    columns: dict[str, dict[str, str]] = {}
    for names, of_suite in suite[suite[axis].isin(lines)].groupby(keys, sort=False, dropna=False):
        values = dict(zip(keys, names, strict=True))
        heading = named(info, values, labels)
        columns[heading] = {
            f"{value:.4g}": "" if np.isnan(median) else "∞" if np.isinf(median) else f"{median:.4f}"
            for value, median in zip(of_suite[axis], of_suite["median"], strict=True)
        }
    medians = dict.fromkeys(value for column in columns.values() for value in column)
    rows = [[value, *(column.get(value, "") for column in columns.values())] for value in medians]
    total = suite[axis].nunique()
    share = f", {len(lines)} of {total} values of {axis}" if len(lines) < total else ""
    text = f"Median of theta_max/alpha{share}; ∞: overturned or ended by flight\n{in_width([axis, *columns], rows)}"
    if axis == SELF_SIMILAR and len(suite):
        sizes, scales = (f"{suite[f'least_{name}'].min():.3g} to {suite[f'greatest_{name}'].max():.3g}" for name in OWN)
        text += f"\nomega_g = PGA/PGV of each record; piers with R0 = {sizes} m, factors {scales}"
    return text


def _evenly(values: np.ndarray) -> np.ndarray:
    """Return at most :data:`MOST_LINES` of ``values``: of more than these, those that are nearest to evenly spaced ones."""
    if len(values) <= MOST_LINES:
        return values
    targets = np.linspace(values[0], values[-1], MOST_LINES)
    return values[np.unique(np.abs(values[:, None] - targets).argmin(axis=0))]


def shown_maps(info: Entry, table: "pd.DataFrame") -> str:
    """Return the regions of every map for a terminal, a line for each of up to MOST_LINES, 12, frequencies."""
    blocks, keys = [], ["case", *info["varied_map"]]
    for names, of_map in table.groupby(["map", *keys], sort=False, dropna=False):
        case = named(info, dict(zip(keys, names[1:], strict=True)), keys)
        lines = [f"{names[0]}, {case}; outcome by a_p/(g tan alpha)"]
        for frequency in _evenly(of_map["omega_p_over_p"].unique()):
            column = of_map[of_map["omega_p_over_p"] == frequency]
            regions = "; ".join(
                f"{region.low:.4g} to {region.high:.4g} {region.outcome}" for region in column.itertuples()
            )
            lines.append(f"  omega_p/p = {frequency:<6.4g} {regions}")
        blocks.append("\n".join(lines))
    return "\n\n".join(blocks)
