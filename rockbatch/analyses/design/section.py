"""Report the values that pass: the answer, the figure, and the intervals."""

from rockbatch.analyses.design.answer import answer
from rockbatch.analyses.design.figures import figure_of
from rockbatch.analyses.design.quantities import heads
from rockbatch.checks.remarks import bounds_in_words
from rockbatch.checks.verdicts import FAIL, NOT_DECIDED, PASS
from rockbatch.checks.wording import SIGNS
from rockbatch.common.lazy import pd
from rockbatch.reporting.finished_analysis import FinishedAnalysis, answered, of_analysis
from rockbatch.reporting.labels import counted
from rockbatch.reporting.markup import Markup, figure, join, paragraphs, tag
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import listed
from rockbatch.results.labelled import as_dicts

INTERVALS = ("case", "verdict", "low", "high", "values", "below", "above", "below_check", "above_check")
VALUES = ("case", "verdict", "check", "ratio")
CHECKS = ("case", "check", "verdict", "ratio")
ONE = (
    "Demand over limit of every check, the worst of all bounds; open: not decided; above the frame: beyond the axis, or an event "
    "that must not occur. Shaded: all checks pass."
)
TWO = (
    "White: all checks pass, and each point has the colour of the check that is closest to its limit. Filled: the colour of the "
    "check that fails."
)


@of_analysis("design", design=INTERVALS, design_values=VALUES, design_checks=CHECKS)
def section(
    analysis: FinishedAnalysis, intervals: "pd.DataFrame", values: "pd.DataFrame", checks: "pd.DataFrame"
) -> Markup:
    """Return the report's section of a design: the answer, the figure, the table of intervals, and how it was computed."""
    info = analysis.info
    said = answer(info, intervals, values)
    lead = [f"{SIGNS[verdict]} {words}" for verdict, words in said if verdict in (PASS, FAIL)]
    open_ = [f"{SIGNS[verdict]} {words}" for verdict, words in said if verdict == NOT_DECIDED]
    remarks = [words for verdict, words in said if verdict not in SIGNS]
    nominally = ", nominally and under each bound," if info["bounds"] else ""
    tried, width = counted(info["tried"], "value"), f"{info['width']:g}"
    method = (
        f"Every value ran with all motions{nominally} and was judged by every check. First came a scan, then the middle of every "
        f"two neighbours with different verdicts until they were {width} or less apart, {tried} in all. All values are in "
        "design_values.csv, all verdicts in design_checks.csv."
    )
    refused = [
        f"Refused at {', '.join(f'{value:.10g}' for value in each['values'])}: {each['reason']}."
        for each in info["refused"]
    ]
    return join(
        answered(*lead, remarks=open_),
        paragraphs(*remarks),
        figure(drawn(figure_of(info, intervals, values, checks)), TWO if len(info["vary"]) > 1 else ONE),
        listed(heads(info), as_dicts(intervals), name="Intervals of values"),
        tag(
            "details",
            tag("summary", "How this was computed"),
            paragraphs(method, *bounds_in_words(info), *refused),
            analysis.provenance(),
        ),
    )
