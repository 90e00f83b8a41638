"""Inputs in which both studies differ: pier, foundations, motions and numerics, value by value."""

from collections.abc import Collection, Iterable

from rockbatch.report.document import Section
from rockbatch.report.finished import Finished
from rockbatch.report.labels import SYMBOLS, counted, digits_that_tell
from rockbatch.report.markup import Markup, tag
from rockbatch.report.pair import SIDES, Pair
from rockbatch.report.table import Head, table

MOST = 6
"""Most values of one key that are shown."""

PIER = ("alpha", "p", "mu", "gravity", "size_m", "mass_t", "top_m")
BASE = (
    "beta", "stiffness_kN_m", "eta", "yield_kN", "epsilon", "spring", "n", "kinematics", "flight", "flight_limit_mm",
    "restitution",
)  # fmt: skip
NUMERICS = {"tolerance": "tolerance", "substeps": "steps per sample", "quiet_s": "time at rest after the record [s]"}

Values = list[object]


def section(pair: Pair) -> Section:
    """Return a row for each input that differs."""
    in_both = set.intersection(*({case["case"] for case in study.info["cases"]} for study in pair.studies))
    sides = [_inputs(study, in_both) for study in pair.studies]
    names = dict.fromkeys(name for side in sides for name in side)
    rows = []
    for name in names:
        values, others = (side.get(name, []) for side in sides)
        if values != others:
            rows.append([name, _shown(values, values + others), _shown(others, values + others)])
    heads = [Head("input"), *map(Head, SIDES)]
    nothing: Markup = tag("p", "Pier, foundations, motions and numerics are the same in both.")
    return Section("What differs in the inputs", "inputs", table(heads, rows, name="Inputs") if rows else nothing)


def _inputs(study: Finished, compared: Collection[str]) -> dict[str, Values]:
    """Return all values of every input, by its name; of cases only those that are ``compared``."""
    info = study.info
    inputs: dict[str, Values] = {}
    for key in PIER:
        inputs[f"pier: {_called(key)}"] = _distinct(case["pier"].get(key) for case in info["cases"])
    inputs["cases"] = _distinct(case["case"] for case in info["cases"])
    for name in filter(compared.__contains__, inputs["cases"]):
        own = [case for case in info["cases"] if case["case"] == name]
        inputs[f"{name}: base"] = _distinct(case["base"] for case in own)
        for key in BASE:
            inputs[f"{name}: {_called(key)}"] = _distinct(case["parameters"].get(key) for case in own)
    records = [record["record"] for record in info["records"]]
    inputs["ground motions"] = [*sorted(records)]
    vertical = sum(record["pga_v_g"] is not None for record in info["records"])
    some = f"{vertical} of {len(records)}"
    inputs["with the vertical component"] = [{0: "none", len(records): "all"}.get(vertical, some)]
    inputs["files that could not be used"] = [len(info["unusable"])]
    inputs["scale"] = _distinct(study.runs["scale"].tolist())
    inputs["polarity"] = _distinct(study.runs["polarity"].tolist())
    for key, words in NUMERICS.items():
        inputs[words] = _distinct([info["numerics"].get(key)])
    return inputs


def _called(key: str) -> str:
    symbol, unit = SYMBOLS.get(key, (key, ""))
    return f"{symbol} [{unit}]" if unit else symbol


def _distinct(values: Iterable[object]) -> Values:
    """Return the values that are not None, each once, in order."""
    return list(dict.fromkeys(value for value in values if value is not None))


def _shown(values: Values, both: Values) -> str:
    """Format values with the digits that distinguish those of both studies."""
    digits = digits_that_tell(both, least=4)
    words = [f"{value:.{digits}g}" if isinstance(value, float | int) else str(value) for value in values]
    if len(words) > MOST:
        return f"{counted(len(words), 'value')}: {', '.join(words[:MOST])}, …"
    return ", ".join(words) or "none"
