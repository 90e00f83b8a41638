"""Tables of the worst runs of every case."""

from rockbatch.common.lazy import pd
from rockbatch.common.statuses import CUT_SHORT
from rockbatch.quantities.cases import devices
from rockbatch.quantities.quantity import Quantity
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import head
from rockbatch.reporting.markup import Markup, join, number
from rockbatch.reporting.sections.peaks import on_scale
from rockbatch.reporting.table import Head, alarm, table


def of_cases(finished: Finished, shown: list[Quantity], name: str) -> Markup:
    """Return a table with a row for each case, pier and scale: the worst of its runs, column by column.

    Cases without devices have no row if all that is ``shown`` is of devices.
    """
    rows: list[list[object]] = []
    of_devices = all(column.device for column in shown)
    for words, group in finished.groups():
        for place in group["series"].unique():
            runs, label = group[group["series"] == place], finished.series[int(place)].label
            if of_devices and not devices(finished.cases[int(place), int(runs["pier"].iloc[0])]):
                continue
            ended = int(runs["status"].isin(CUT_SHORT).sum())
            counts = f"{len(runs) - ended} of {len(runs)}"
            cells = (_worst(column, runs, bool(ended)) for column in shown)
            rows.append([f"{label} ({words})" if words else label, alarm(counts) if ended else counts, *cells])
    runs_head = Head(
        "runs", note="that went through, of all; where some did not, the others bound the values from one side"
    )
    return table([Head("case"), runs_head, *map(head, shown)], rows, sortable=True, name=name)


def _worst(column: Quantity, runs: "pd.DataFrame", cut_short: bool) -> object:
    """Return the worst value of a column in the page's unit, with ≥ or ≤ if runs were ``cut_short``; None without a value.

    The worst is the greatest, or the smallest of a quantity of which the least is worst.
    """
    values = runs[column.name].dropna()
    if values.empty:
        return None
    least = column.least_is_worst
    value = on_scale(column.name, float(values.min() if least else values.max()))
    shown = number(value, head(column).form)
    return join(f"{'≤' if least else '≥'}\u00a0", shown) if cut_short else value
