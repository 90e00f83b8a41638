"""The suite against its target spectrum, its pulse-like records, and their distances from the source."""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from rockbatch.checks import wording
from rockbatch.checks.suite_target import NAMES, suite_verdicts
from rockbatch.checks.verdicts import FAIL, MEAN_OVER_TARGET, NOT_DECIDED, PASS, Verdict
from rockbatch.common.grouping import spread
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup, join
from rockbatch.reporting.sections.motions import Record, spectra
from rockbatch.reporting.sections.verdicts import mark
from rockbatch.reporting.table import Head, table
from rockbatch.reporting.templates import render

NEAR_KM = 15.0
"""A usual limit of near-source sites: ASCE 7-16, 11.4.1, has 15 km from a fault of M 7, and 10 km of M 6."""
MOST_PERIODS = 12
MET = {PASS: "met", FAIL: "not met", NOT_DECIDED: "not decided"}


def section(finished: Finished) -> Markup:
    """Compare the suite with its target spectra, horizontal and vertical; empty if the study has none."""
    records = finished.info["records"]
    targets = (finished.info.get(name) for name in ("target", "vertical_target"))
    horizontal, vertical = (target if target is not None and records and _sound(target) else None for target in targets)
    parts = [Markup("")]
    if horizontal is not None:
        parts.append(_horizontal(finished, horizontal, records))
    if vertical is not None:
        factors = [record["vertical_factor"] for record in records if record.get("vertical_factor") is not None]
        parts.append(
            render(
                "reporting/sections/vertical_target.html",
                target=vertical,
                factors=factors,
                below=_below(finished, "vertical_target"),
                conditions=_conditions(finished, "vertical_target"),
                **_mean_over(vertical),
            )
        )
    return join(*parts)


def _of_target(finished: Finished, entry: str) -> list[Verdict]:
    """Return what becomes of every condition on the suite by a target, ``entry`` of run.json, at every scale that was run."""
    scales = finished.runs["scale"].unique().tolist()
    return [verdict for verdict in suite_verdicts(finished.info, scales) if verdict.check == NAMES[entry]]


def _below(finished: Finished, entry: str) -> str:
    """Return at which scales the mean spectrum of the suite is below a target, in words; empty if at none."""
    scales = [
        verdict.scale
        for verdict in _of_target(finished, entry)
        if verdict.verdict == FAIL and verdict.demand == MEAN_OVER_TARGET
    ]
    if scales in ([], [1.0]):
        return "that is asked for" if scales else ""
    return f"that is asked for, at scale {', '.join(f'{scale:g}' for scale in scales)}"


def _conditions(finished: Finished, entry: str) -> Markup:
    """Return a table of the conditions on the suite, each met or not; empty for a target that is only compared."""
    rows = [
        [
            verdict.words,
            wording.limit(verdict),
            wording.demanded(verdict),
            verdict.unit,
            mark(verdict.verdict, MET[verdict.verdict]),
            verdict.reason,
            verdict.note,
        ]
        for verdict in _of_target(finished, entry)
    ]
    heads = map(Head, ("condition", "asked", "is", "unit", "", "by", "note"))
    return table([*heads], rows, prose=True, name="Conditions on the suite") if rows else Markup("")


def _mean_over(target: Mapping[str, Any]) -> dict[str, Any]:
    """Return the mean over the target at its periods, where it is the least and the largest, and a table of it."""
    periods = target["period_s"]
    ratio = np.array(target["mean_sa_g"], dtype=np.float64) / np.array(target["sa_g"], dtype=np.float64)
    places = spread(range(len(periods)), MOST_PERIODS)
    rows = [[periods[i], target["sa_g"][i], target["mean_sa_g"][i], float(ratio[i])] for i in places]
    heads = [
        Head("T [s]", ".3g"),
        Head("target SA [g]", ".3f"),
        Head("mean SA [g]", ".3f"),
        Head("mean over target", ".2f"),
    ]
    return {
        "periods": periods, "over": ratio.tolist(), "least": int(np.argmin(ratio)), "most": int(np.argmax(ratio)),
        "ratios": table(heads, rows, name="Mean over target"),
    }  # fmt: skip


def _horizontal(finished: Finished, target: Mapping[str, Any], records: Sequence[Record]) -> Markup:
    pulses = [record for record in records if record.get("pulse_period_s") is not None]
    distances = [record["distance_km"] for record in records if record.get("distance_km") is not None]
    caption = "their mean, and the target; shaded: the range over which they are fitted."
    both = np.array(target.get("components_sa_g", ()), dtype=np.float64)
    return render(
        "reporting/sections/target.html", target=target, records=records, below=_below(finished, "target"),
        conditions=_conditions(finished, "target"),
        **_mean_over(target),
        run=(both / np.array(target["sa_g"], dtype=np.float64)).tolist() if len(both) == len(target["sa_g"]) else [],
        factors=[record.get("factor", 1.0) for record in records],
        picture=spectra(finished, caption, tuple(target["range_s"])),
        stations=_stations(records), pulses=pulses, with_pulse=_stations(pulses),
        lengths=[record["pulse_period_s"] for record in pulses],
        known=distances, near=sum(distance <= NEAR_KM for distance in distances), near_km=f"{NEAR_KM:g}",
    )  # fmt: skip


def _stations(records: Iterable[Record]) -> int:
    return len({record.get("station") or record["record"] for record in records})


def _sound(target: Mapping[str, Any]) -> bool:
    """Return whether the parts of a target fit each other, since run.json may come from anybody."""
    periods, ends = target["period_s"], target["range_s"]
    fitting = all(len(target[name]) == len(periods) > 0 for name in ("sa_g", "mean_sa_g"))
    is_finite = fitting and all(map(math.isfinite, target["mean_sa_g"]))
    return len(ends) == 2 and min(ends) > 0 and is_finite and min((*periods, *target["sa_g"])) > 0
