"""Intensity measures of the motions, and how well each orders the peaks of a case."""

import math

from rockbatch.common.lazy import pd
from rockbatch.observers.intensity import TABLE
from rockbatch.observers.intensity.order import LEAST_RUNS, orders
from rockbatch.observers.intensity.table import MEANING, read
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.table import Head, table
from rockbatch.reporting.templates import render

SYMBOLS = {
    "pga_over_g_tan_alpha": "PGA/(g tan α)",
    "p_pgv_over_g_tan_alpha": "p PGV/(g tan α)",
    "bracketed_s": "bracketed duration",
    "uniform_s": "uniform duration",
    "cav_m_s": "CAV",
}


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
    names = list(dict.fromkeys(order["measure"]))
    ranks: list[list[object]] = []
    lines: list[list[object]] = []
    for key, group in order.groupby(["case", *varied, "scale"], sort=False, dropna=False):
        series, pier = finished.place(str(key[0]), dict(zip(varied, key[1:-1], strict=True)))
        words = finished.named_place(series, pier)
        by_measure = group.set_index("measure")
        rho, sigma, first = by_measure["rank_correlation"], by_measure["dispersion"], by_measure.iloc[0]
        case = [words, float(first["scale"]) if many_scales else None]
        best = _symbol(rho.idxmax()) if rho.notna().any() else "—"
        ranks.append([*case, first["runs"], first["without_peak"], best, *(_shown(rho[name]) for name in names)])
        best = _symbol(sigma.idxmin()) if sigma.notna().any() else "—"
        lines.append([*case, first["fitted"], None, best, *(_shown(sigma[name]) for name in names)])
    measures = [
        Head(_symbol(name), ".2f", f"{name}: {MEANING.get(name, 'spectral acceleration [g]')}") for name in names
    ]
    heads = [Head("case"), Head("scale of motions"), Head("runs", ".0f")]
    heads += [Head("without a peak", ".0f", "overturned, or ended by flight")]
    return (
        table([*heads, Head("largest"), *measures], ranks, sortable=True, name="Rank correlation"),
        table([*heads, Head("least"), *measures], lines, sortable=True, name="Dispersion"),
    )


def _shown(value: float) -> float | str:
    return "—" if math.isnan(value) else float(value)


def _symbol(name: object) -> str:
    """Return the symbol of a column: "PGA/(g tan α)", "CAV"; "SA(0.5 s)" of sa_0.5s_g, "RotD100(0.5 s)" of sa_0.5s_rotd100_g."""
    period, _, rule = str(name).removeprefix("sa_").removesuffix("_g").partition("s_")
    measure = {"geomean": "geometric mean", "rotd50": "RotD50", "rotd100": "RotD100"}.get(rule, "SA")
    return SYMBOLS.get(str(name)) or f"{measure}({period.removesuffix('s')}\u00a0s)"
