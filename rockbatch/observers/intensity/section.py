"""Intensity measures of the motions, and how well each orders the peaks of a case."""

import math

from rockbatch.common.lazy import pd
from rockbatch.observers.intensity import TABLE
from rockbatch.observers.intensity.order import LEAST_RUNS, orders
from rockbatch.observers.intensity.table import measures_in, read
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.table import Head, table
from rockbatch.reporting.templates import render


def section(finished: Finished) -> Markup:
    """Return tables of rank correlations and dispersions of each measure; empty without intensity.csv, or rows in it."""
    measures = read(finished.directory) if (finished.directory / TABLE).exists() else None
    if measures is None or measures.empty:
        return Markup("")
    ranks, dispersions = _tables(finished, orders(measures, finished.info["varied"]))
    return render(
        "observers/intensity/section.html", ranks=ranks, dispersions=dispersions, file=TABLE, least=LEAST_RUNS
    )


def _tables(finished: Finished, order: "pd.DataFrame") -> tuple[Markup, Markup]:
    """Return a table of rank correlations and one of dispersions, with a row for each case and scale."""
    varied = finished.info["varied"]
    many_scales = order["scale"].nunique() > 1
    names = measures_in(order["measure"])
    ranks: list[list[object]] = []
    lines: list[list[object]] = []
    for key, group in order.groupby(["case", *varied, "scale"], sort=False, dropna=False):
        series, pier = finished.place(str(key[0]), dict(zip(varied, key[1:-1], strict=True)))
        words = finished.named_place(series, pier)
        by_measure = group.set_index("measure")
        rho, sigma, first = by_measure["rank_correlation"], by_measure["dispersion"], by_measure.iloc[0]
        case = [words, float(first["scale"]) if many_scales else None]
        best = names[str(rho.idxmax())].symbol if rho.notna().any() else "—"
        ranks.append([*case, first["runs"], first["without_peak"], best, *(_shown(rho[name]) for name in names)])
        best = names[str(sigma.idxmin())].symbol if sigma.notna().any() else "—"
        lines.append([*case, first["fitted"], None, best, *(_shown(sigma[name]) for name in names)])
    measures = [Head(measure.symbol, ".2f", f"{name}: {measure.meaning}") for name, measure in names.items()]
    heads = [Head("case"), Head("scale of motions"), Head("runs", ".0f")]
    heads += [Head("without a peak", ".0f", "overturned, or ended by flight")]
    return (
        table([*heads, Head("largest"), *measures], ranks, sortable=True, name="Rank correlation"),
        table([*heads, Head("least"), *measures], lines, sortable=True, name="Dispersion"),
    )


def _shown(value: float) -> float | str:
    return "—" if math.isnan(value) else float(value)
