"""Remarks on the supports of a study's cases, shown before the results: one sentence each, with the cases."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rockbatch.checks.responses import Worst
from rockbatch.common.grouping import grouped
from rockbatch.quantities.cases import Case, asks_tension, backbone, capacity_index
from rockbatch.quantities.labels import in_full

MOST_NAMES = 3


def weak_supports(cases: Sequence[Case]) -> str:
    """Return "pads: one support cannot carry the full weight (40 %): it yields …", with the cases of which it is true; or ""."""
    shares = {i: share for i, case in enumerate(cases) if (share := _borne_alone(case)) < 1.0}
    if not shares:
        return ""
    least, most = (f"{100.0 * share:.3g}" for share in (min(shares.values()), max(shares.values())))
    borne = most if least == most else f"{least} to {most}"
    weak = [cases[i] for i in shares]
    load = "weight and prestress" if any(map(_prestress, weak)) else "weight"
    named = _named(weak, cases)
    limit = "reaches its greatest force" if any(map(backbone, weak)) else "yields"
    return f"{named}: one support cannot carry the full {load} ({borne} %): it {limit} before the pier lifts off"


def pulled_supports(cases: Sequence[Case]) -> str:
    """Return a sentence on cases whose impacts need a support to pull; empty for none."""
    pulled = [case for case in cases if asks_tension(case)]
    if not pulled:
        return ""
    return (
        f"{_named(pulled, cases)}: to multiply the angular velocity by Housner's e and keep the other pivot's velocity, a "
        "support would have to pull at every impact, which one without tension cannot"
    )


def undamped_settlement(worst: Sequence[Worst]) -> str:
    """Return a sentence on cases that settle while nothing damps the vertical vibration; empty for none.

    ``worst`` are the worst responses of all cases.
    """
    settlements = [response for response in worst if response.demand == "settlement_m"]
    settled = [response.case for response in settlements]
    undamped = [response.case for response in settlements if response.value > 0.0 and not _is_damped(response.case)]
    if not undamped:
        return ""
    return (
        f"{_named(undamped, settled)}: without zeta nothing damps the vertical vibration, which adds to the settlement"
    )


def bounds_in_words(info: Mapping[str, Any]) -> list[str]:
    """Return sentences on the bounds of the design in run.json: what each changes, and cases that lack its keys; [] for none."""
    bounds = info.get("bounds", ())
    if not bounds:
        return []
    listed = "; ".join(f"{bound['bound']}: {changes_of(bound)}" for bound in bounds)
    sentences = [f"Each case ran as it is nominally and, one at a time, under these bounds: {listed}."]
    lacking = [(case["case"], ", ".join(case["keys"]), bound["bound"]) for bound in bounds for case in bound["lacking"]]
    for (name, keys), rows in grouped(lacking, lambda row: row[:2]).items():
        under = ", ".join(row[2] for row in rows)
        sentences.append(f"{name} lacks {keys}, and ran without this change under {under}.")
    return sentences


def changes_of(bound: Mapping[str, Any]) -> str:
    """Return the changes of a bound in run.json, and its source, if any: "case.beta × 1.2, pier.mass_t = 950 (site report)"."""
    return ", ".join(bound["changes"]) + (f" ({bound['source']})" if bound["source"] else "")


def _borne_alone(case: Case) -> float:
    """Return the greatest force of a support over weight and prestress; infinite without one."""
    index = capacity_index(case)
    return math.inf if math.isnan(index) else 0.5 * index / (1.0 + _prestress(case))


def _prestress(case: Case) -> float:
    """Return the prestress of all tendons over the weight."""
    return sum(float(device.get("psi") or 0.0) for device in case["parameters"].get("restraints", ()))


def _is_damped(case: Case) -> bool:
    """Return whether the supports have dashpots, or the pier has any damper, which damp the vertical vibration."""
    parameters = case["parameters"]
    return bool(parameters.get("zeta")) or any("kind" in device for device in parameters.get("restraints", ()))


def _named(cases: Sequence[Case], among: Sequence[Case]) -> str:
    """Return up to three names of ``cases``, with varied values unless all of a name are meant; for more "5 of 8 cases"."""
    names = []
    every = grouped(among, lambda case: str(case["case"]))
    for name, of_name in grouped(cases, lambda case: str(case["case"])).items():
        for case in of_name if len(of_name) < len(every[name]) else of_name[:1]:
            values = case["columns"] if len(of_name) < len(every[name]) else {}
            names.append(in_full(name, values, case))
    return "; ".join(names) if len(names) <= MOST_NAMES else f"{len(cases)} of {len(among)} cases"
