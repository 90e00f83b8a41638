"""Results with chosen numbers, for the design checks."""

import json
import math
from pathlib import Path
from typing import Any

import pandas as pd

from rockbatch.checks import Rule, Verdict, judge
from rockbatch.checks.suite import Suite
from rockbatch.pier import Base, ElasticBase, Pier, RigidBase, YieldingBase
from rockbatch.quantities.catalogue import DEMANDS, FIXED, TRAILING, names
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.results.run_json import describe_case
from rockbatch.study import Case

PIER = Pier(alpha=0.2, p=1.0, mass_t=3000.0)
"""R0 = 7.3575 m, b = 1.46171 m, h = 7.21084 m."""
PADS = YieldingBase(beta=50.0, eta=2.5)

RECORD = {
    "source": "x.AT2", "vertical_source": None, "notes": [], "npts": 100, "dt_s": 0.01, "duration_s": 0.99, "pga_g": 0.5,
    "pga_v_g": None, "pgv_m_s": None, "pgd_m": None,
}  # fmt: skip


def case(name: str = "pads", base: Base = PADS, **columns: float | str) -> dict[str, Any]:
    """Return a case as run.json has it."""
    return describe_case(Case(name, PIER, base, columns))


RIGID, ELASTIC = case("rigid", RigidBase()), case("elastic", ElasticBase(beta=50.0))


def runs(theta: Any = (0.1, 0.2, 0.6, 0.3), name: str = "pads", **cells: Any) -> pd.DataFrame:
    """Return one run that went well for each value of θ_max/α, each of its own station; ``cells`` gives other columns, a value
    each."""
    table = pd.DataFrame({"theta_max_over_alpha": [float(value) for value in theta]})
    table["record"] = [f"r{i}" for i in range(len(table))]
    table["case"], table["polarity"], table["scale"], table["status"], table["reason"] = name, "+", 1.0, "ok", ""
    for column in names((*FIXED, *TRAILING)):
        if column not in table:
            table[column] = math.nan
    table["station"] = table["record"]
    for column, value in cells.items():
        table[column] = value
    return table


SECTION = {
    "section_shear_kN": 3000.0, "section_moment_kNm": 40000.0, "section_axial_least_kN": -200.0,
    "section_axial_greatest_kN": 30000.0,
}  # fmt: skip


def judged(table, *, one=None, records=(), demand="theta_max_over_alpha", at_most=0.5, suite=None, **asked):
    """Return the verdict on one case by one rule, without ``suite`` of motions that are judged by the target of its code."""
    if "at_least" in asked:
        at_most = None
    place, sections = in_sections(table, demand)
    (verdict,) = judge(
        [Rule("check", demand, at_most, **place | asked)],
        table,
        [one or case()],
        suite or Suite(dict.fromkeys(records, ""), code=STATISTICS[asked.get("statistic", "max")].code),
        sections=sections,
        interaction=interaction_of(table),
    )
    return verdict


def in_sections(table, demand, **cells):
    """What a check of a section says too, and rows of sections.csv for those of ``table``; nothing for other demands."""
    if DEMANDS[demand].needs == "interaction":
        return {"at_m": 7.5, "capacity": ((0.0, 0.0), (1e4, 5e4), (1e5, 0.0))}, None
    if DEMANDS[demand].over_capacity:
        return {"capacity": ((0.0, 0.0), (1e4, 5e3), (1e5, 0.0))}, None
    if DEMANDS[demand].needs != "sections":
        return {}, None
    values = SECTION | {"sections_error": math.nan} | cells
    return {"at_m": 7.5}, table[["record", "case", "polarity", "scale"]].assign(height_m=7.5, **values)


def interaction_of(table):
    """Rows of interaction.csv for those of ``table``: 4/5 of the capacities of :func:`in_sections`."""
    of_section = {
        "height_m": 7.5,
        "axial_kN": 1e4,
        "moment_kNm": 4e4,
        "shear_kN": math.nan,
        "interaction_error": math.nan,
    }
    of_base = of_section | {"height_m": math.nan, "moment_kNm": math.nan, "shear_kN": 4e3}
    runs_of = table[["record", "case", "polarity", "scale"]]
    return pd.concat([runs_of.assign(**cells) for cells in (of_section, of_base)])


def folder(path: Path, peaks: pd.DataFrame, cases: list[dict[str, Any]], checks: str = "", **info: Any) -> Path:
    """Write a folder as ``rockbatch run`` leaves it, of a study with the text ``checks``."""
    table = peaks.reindex(columns=list(dict.fromkeys([*names(FIXED), *names(TRAILING), *peaks.columns])))
    path.mkdir(exist_ok=True)
    table.to_csv(path / "peaks.csv", index=False, float_format="%.10g")
    records = peaks.loc[peaks["case"] != "", ["record", "station"]].drop_duplicates("record")
    content = {
        "rockbatch": "0", "created": "", "command": [], "versions": {}, "machine": "",
        "study": {"path": "pier.toml", "title": "", "notes": "", "text": checks, "sha256": ""},
        "numerics": {"tolerance": 1e-4, "substeps": None, "quiet_s": 2.0},
        "varied": list(dict.fromkeys(key for entry in cases for key in entry["columns"])),
        "cases": cases,
        "records": [RECORD | cells for cells in records.to_dict("records")],
        "unusable": [], "references": [], "runs": len(peaks), "jobs": 1, "wall_s": 1.0,
    }  # fmt: skip
    (path / "run.json").write_text(json.dumps(content | info), encoding="utf-8")
    return path


def verdict(case: str, decided: str, *, check: str = "margin", ratio: float = 0.5, **more: object) -> Verdict:
    """Return the verdict of a check on a case."""
    values = {
        "columns": {}, "scale": 1.0, "demand": "theta_max_over_alpha", "statistic": "mean",
        "words": "mean of theta_max_over_alpha", "records": 6, "runs": 6, "value": 0.25, "low": 0.2, "high": 0.3,
        "sense": "at most", "limit": 0.5, "margin": 0.25, "basis": "judgement", "reason": "half of α",
        "counting": "overturned: infinite", "counted": "", "remarks": (),
    }  # fmt: skip
    return Verdict(**{**values, "check": check, "case": case, "verdict": decided, "ratio": ratio, **more})
