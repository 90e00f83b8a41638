"""Results of ``rockbatch sensitivity``: what matters most, the effect of each input alone, and Sobol's indices."""

from rockbatch.analyses.sensitivity.answer import answer
from rockbatch.analyses.sensitivity.columns import SOBOL, TORNADO
from rockbatch.analyses.sensitivity.figures import bars, symbol
from rockbatch.analyses.sensitivity.quantities import of_inputs
from rockbatch.common.lazy import pd
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.reporting.finished_analysis import FinishedAnalysis, named, of_analysis
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import Head, listed
from rockbatch.reporting.templates import render
from rockbatch.results.labelled import as_dicts


@of_analysis("sensitivity", sensitivity=("case", *TORNADO), sobol=("case", *SOBOL))
def section(analysis: FinishedAnalysis, swings: "pd.DataFrame", shares: "pd.DataFrame") -> Markup:
    """Return the report's section of sensitivity: inputs one at a time, and Sobol's indices."""
    info = analysis.info
    keys, cases = ["case", *info["varied"]], swings.groupby(["case", *info["varied"]], dropna=False).ngroups
    heads = [Head("input", value=lambda row: symbol(row["parameter"])), *of_inputs(info)]
    heads = [Head("case", value=lambda row: named(info, row, keys)), *heads] if cases > 1 else heads
    rows, inputs = as_dicts(swings.merge(shares, on=[*keys, "parameter"])), [entry["name"] for entry in info["inputs"]]
    return render(
        "analyses/sensitivity/section.html",
        info=info,
        statistic=STATISTICS[info["statistic"]].words,
        answer=answer(info, swings, shares),
        picture=drawn(bars(swings, shares, info)),
        table=listed(heads, rows, name="Sensitivity in numbers"),
        runs=[f"{count} {status}" for status, count in sorted(info["statuses"].items())],
        idle="vertical" in inputs and not any(motion["vertical"] for motion in info["under"]),
        provenance=analysis.provenance(),
    )
