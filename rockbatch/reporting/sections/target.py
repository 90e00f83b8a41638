"""The suite against its target spectrum, its pulse-like records, and distances from the source."""

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from rockbatch.checks import wording
from rockbatch.checks.suite_target import NAMES, Target, suite_verdicts
from rockbatch.checks.verdicts import FAIL, MEAN_OVER_TARGET, NOT_DECIDED, PASS, Verdict
from rockbatch.common.grouping import spread
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup, join
from rockbatch.reporting.sections.motions import spectra
from rockbatch.reporting.sections.verdicts import mark
from rockbatch.reporting.table import Head, table
from rockbatch.reporting.templates import render
from rockbatch.results.labelled import Item

NEAR_KM = 15.0
"""A usual limit of near-source sites: 15 km from a fault of M 7, 10 km of M 6 in ASCE 7-16, 11.4.1."""
MOST_PERIODS = 12
MET = {PASS: "met", FAIL: "not met", NOT_DECIDED: "not decided"}


def section(finished: Finished) -> Markup:
    """Return the comparison of the suite with its horizontal and vertical target spectra.

    Empty if the study has none, or no record, or if the values in run.json are unsound.
    """
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
                **_mean_over(vertical)._asdict(),
            )
        )
    return join(*parts)


def _of_target(finished: Finished, entry: str) -> list[Verdict]:
    """Return the verdicts on a target's conditions at each scale that was run; ``entry`` is the target's key in run.json."""
    scales = finished.runs["scale"].unique().tolist()
    return [verdict for verdict in suite_verdicts(finished.info, scales) if verdict.check == NAMES[entry]]


def _below(finished: Finished, entry: str) -> str:
    """Return "required" if scale 1 is the only one at which the suite's mean is below a required target, "" if none is.

    Otherwise the scales: "required, at scale 0.5, 1".
    """
    failing = [verdict for verdict in _of_target(finished, entry) if verdict.verdict == FAIL]
    scales = [verdict.scale for verdict in failing if verdict.demand == MEAN_OVER_TARGET]
    if scales in ([], [1.0]):
        return "required" if scales else ""
    return f"required, at scale {', '.join(f'{scale:g}' for scale in scales)}"


def _conditions(finished: Finished, entry: str) -> Markup:
    """Return a table of the conditions on the suite, each met, not met or not decided; empty for a target only compared."""
    rows: list[list[object]] = []
    for verdict in _of_target(finished, entry):
        numbers = wording.limit(verdict), wording.demanded(verdict), verdict.unit
        met = mark(verdict.verdict, MET[verdict.verdict])
        rows.append([verdict.words, *numbers, met, verdict.reason, verdict.note])
    heads = map(Head, ("condition", "required", "actual", "unit", "", "by", "note"))
    return table([*heads], rows, prose=True, name="Conditions on the suite") if rows else Markup("")


class MeanOverTarget(NamedTuple):
    """Mean spectrum of the suite over its target at ``periods`` [s], the indices of its extremes, and a table of it."""

    periods: Sequence[float]
    over: list[float]
    least: int
    most: int
    ratios: Markup


def _mean_over(target: Target) -> MeanOverTarget:
    """Return the suite's mean over a target of run.json."""
    periods = target["period_s"]
    ratio = np.array(target["mean_sa_g"], dtype=np.float64) / np.array(target["sa_g"], dtype=np.float64)
    places = spread(range(len(periods)), MOST_PERIODS)
    rows = [[periods[i], target["sa_g"][i], target["mean_sa_g"][i], float(ratio[i])] for i in places]
    heads = [
        Head("T", ".3g", unit="s"),
        Head("target SA", ".3f", unit="g"),
        Head("mean SA", ".3f", unit="g"),
        Head("mean over target", ".2f"),
    ]
    ratios = table(heads, rows, name="Mean over target")
    return MeanOverTarget(periods, ratio.tolist(), int(np.argmin(ratio)), int(np.argmax(ratio)), ratios)


def _horizontal(finished: Finished, target: Target, records: Sequence[Item]) -> Markup:
    """Return the comparison of the horizontal components with their target, and what is known of pulses and distances."""
    pulses = [record for record in records if record.get("pulse_period_s") is not None]
    distances = [record["distance_km"] for record in records if record.get("distance_km") is not None]
    caption = "their mean, and the target; shaded: the range over which they are fitted."
    both = np.array(target.get("components_sa_g", ()), dtype=np.float64)
    return render(
        "reporting/sections/target.html",
        target=target,
        records=records,
        below=_below(finished, "target"),
        conditions=_conditions(finished, "target"),
        **_mean_over(target)._asdict(),
        run=(both / np.array(target["sa_g"], dtype=np.float64)).tolist() if len(both) == len(target["sa_g"]) else [],
        factors=[record.get("factor", 1.0) for record in records],
        picture=spectra(finished, caption, tuple(target["range_s"])),
        stations=_stations(records),
        pulses=pulses,
        with_pulse=_stations(pulses),
        lengths=[record["pulse_period_s"] for record in pulses],
        known=distances,
        near=sum(distance <= NEAR_KM for distance in distances),
        near_km=f"{NEAR_KM:g}",
    )


def _stations(records: Iterable[Item]) -> int:
    """Return the number of stations; a record without one counts as its own."""
    return len({record.get("station") or record["record"] for record in records})


def _sound(target: Target) -> bool:
    """Return whether a target's spectra fit its periods, and its numbers are above 0, those of the mean finite and not below 0.

    run.json is untrusted.
    """
    periods, ends = target["period_s"], target["range_s"]
    fitting = all(len(target[name]) == len(periods) > 0 for name in ("sa_g", "mean_sa_g"))
    has_mean = fitting and all(0.0 <= mean < math.inf for mean in target["mean_sa_g"])
    return len(ends) == 2 and min(ends) > 0 and has_mean and min((*periods, *target["sa_g"])) > 0
