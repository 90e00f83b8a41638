"""The remark in the report by which law a settlement is, or how wide its range."""

from rockbatch.observers.other_law.quantities import OTHER_LAW
from rockbatch.quantities.cases import creeps
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.templates import render


def remark(finished: Finished) -> Markup:
    """Return the remark above the table of every run; empty where no springs ratchet."""
    runs = finished.runs
    if not any(map(creeps, finished.info["cases"])):
        return Markup("")
    gap = (runs["settlement_m"] - runs[OTHER_LAW]).abs() if OTHER_LAW in runs else None
    widest = None if gap is None or gap.isna().all() else runs.iloc[int(gap.argmax())]
    return render(
        "observers/other_law/section.html",
        finished=finished,
        one_law=gap is None,
        widest=widest,
        range=[] if widest is None else sorted(1000 * widest[name] for name in ("settlement_m", OTHER_LAW)),
    )
