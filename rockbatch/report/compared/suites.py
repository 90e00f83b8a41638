"""Statistics of the suite in each case of both studies."""

from rockbatch.report.document import Section
from rockbatch.report.markup import join, tag
from rockbatch.report.pair import SIDES, Pair
from rockbatch.report.sections import statistics


def section(pair: Pair) -> Section | None:
    """Return statistics over the runs that both have, since another suite would give other statistics."""
    matched = pair.matched
    if matched.runs[0].empty:
        return None
    with_vertical = [any(record["pga_v_g"] is not None for record in study.info["records"]) for study in pair.studies]
    sides = list(SIDES)
    if with_vertical[0] != with_vertical[1]:
        sides = [
            f"{name}, {'with' if vertical else 'without'} vertical"
            for name, vertical in zip(SIDES, with_vertical, strict=True)
        ]
    keys = ["scale", "pier", "series", "with_vertical"]
    runs = dict(zip(sides, matched.runs, strict=True))
    names, heads = statistics.rows_of(pair.named, matched.runs[0], keys)
    content = join(
        tag("p", "Over the pairs of runs only."), statistics.tables(runs, keys, names, heads, pair.studies[0].count)
    )
    return Section("The suite in each case", "suite", content)
