"""The warning in the terminal that a settlement is a range."""

from collections.abc import Callable
from typing import Any

import numpy as np

from rockbatch.batch.listening import count
from rockbatch.common.lazy import pd
from rockbatch.observers.other_law.quantities import OTHER_LAW


def warning(table: "pd.DataFrame", case_of: Callable[["pd.Series[Any]"], str]) -> str:
    """Return a warning if settlements by the two spring laws differ by over 10 % and 1 mm in a run; else "".

    ``case_of`` names the case of a run.
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
        f"the settlement is a range, not one value, in {count(int(differ.sum()), 'run')}, depending on the law of the "
        f"springs; the widest in {run}: {min(mm):z.1f} to {max(mm):z.1f} mm, the larger by the {law} law; checks take the worse"
    )
