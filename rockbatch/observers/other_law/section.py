"""By which law a settlement is, or how wide its range: the remark in the report, and the warning in the terminal."""

from collections.abc import Callable
from typing import Any

import numpy as np

from rockbatch.common.lazy import pd
from rockbatch.common.showing import several
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


def warning(table: "pd.DataFrame", case_of: Callable[["pd.Series[Any]"], str]) -> str:
    """Return a warning if settlements by the two spring laws differ by over 10 % and 1 mm in a run; else "".

    It has the number of these runs and the widest range, whose case ``case_of`` names.
    """
    if OTHER_LAW not in table:
        return ""
    of_case, by_other = table["settlement_m"], table[OTHER_LAW]
    gap = (of_case - by_other).abs()
    differ = gap > (0.1 * of_case.abs()).clip(lower=1e-3)
    if not differ.any():
        return ""
    worst = table.iloc[int(np.nanargmax(gap.to_numpy()))]
    run = f"{worst['record']}, {case_of(worst)}"
    mm = [1000 * worst[name] for name in ("settlement_m", OTHER_LAW)]
    law = "Bouc–Wen" if mm[0] > mm[1] else "elastic–perfectly plastic"
    return (
        f"the settlement is a range, not one value, in {several(int(differ.sum()), 'run')}, depending on the law of the "
        f"springs; the widest in {run}: {min(mm):z.1f} to {max(mm):z.1f} mm, the larger by the {law} law; checks take the worse"
    )
