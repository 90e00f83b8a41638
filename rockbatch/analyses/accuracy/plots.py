"""Figures of accuracy, for notebooks and papers; the report draws its own. Loads matplotlib: imported where one is drawn."""

from matplotlib.figure import Figure

from rockbatch.common.figures.style import figure, line, marks, styled, with_legend
from rockbatch.common.lazy import pd


@styled
def accuracy(table: "pd.DataFrame", width_mm: float) -> Figure:
    """See :meth:`rockbatch.analyses.accuracy.analysis.Accuracy.plot`."""
    drawn = figure(width_mm, 0.65 * width_mm + 12.0)
    axes = drawn.subplots()
    for place, (method, rows) in enumerate(table.groupby("method", sort=False)):
        style = marks(place) | {"linestyle": line(place)["linestyle"]}
        axes.loglog(1000.0 * rows["seconds_per_run"], rows["error_95"].clip(lower=1e-16), label=str(method), **style)
        for steps, seconds, error in rows[["substeps", "seconds_per_run", "error_95"]].dropna().to_numpy().tolist():
            axes.annotate(
                f"{steps:g}", (1000.0 * seconds, error), xytext=(4, 4), textcoords="offset points", fontsize=6.0
            )
    axes.set(xlabel="time of a run [ms]; numbers: steps per sample", ylabel=r"error of $\theta_{\max}/\alpha$, 95 %")
    return with_legend(drawn, [axes])
