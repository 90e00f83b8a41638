"""Figures of sensitivity, for notebooks and papers; the report draws its own. Loads matplotlib: imported where one is drawn."""

from matplotlib.figure import Figure

from rockbatch.common.figures.style import COLOURS, figure, marks, styled, with_legend
from rockbatch.common.lazy import pd


@styled
def sensitivity(swings: "pd.DataFrame", sobol: "pd.DataFrame", width_mm: float) -> Figure:
    """See :meth:`rockbatch.analyses.sensitivity.analysis.Sensitivity.plot`."""
    cases = list(swings["case"].unique())
    drawn = figure(width_mm, 16.0 + (12.0 + 5.0 * swings["parameter"].nunique()) * len(cases))
    for (tornado, shares), case in zip(drawn.subplots(len(cases), 2, squeeze=False), cases, strict=True):
        bars = swings[swings["case"] == case].drop_duplicates("parameter")[::-1]
        tornado.barh(
            bars["parameter"], bars["answer_high"] - bars["answer_low"], left=bars["answer_low"], color=COLOURS[0]
        )
        tornado.axvline(bars["answer_base"].iloc[0], color="black", linewidth=0.8)
        tornado.set(title=case, xlabel=r"$\theta_{\max}/\alpha$, one at a time")
        of_case = (
            sobol[sobol["case"] == case]
            .drop_duplicates("parameter")
            .set_index("parameter")
            .reindex(bars["parameter"])
            .dropna()
        )
        for place, (index, label) in enumerate((("total", "total"), ("first", "first order"))):
            shares.errorbar(of_case[index], of_case.index, xerr=of_case[f"{index}_error"], label=label, **marks(place))
        shares.set(
            title=case, xlabel="Sobol index", xlim=(min(-0.05, *shares.get_xlim()), max(1.05, *shares.get_xlim()))
        )
    return with_legend(drawn, [shares])
