"""The suite against its target spectrum, its pulse-like records, and their distances from the source."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rockbatch.report.contents import Contents
from rockbatch.report.document import Section, figure, paragraphs
from rockbatch.report.drawing import response_spectra
from rockbatch.report.finished import Finished
from rockbatch.report.labels import counted
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.table import Head, alarm, table

FACTORS = {
    "both": "Every record is scaled by least squares of ln SA over this range, and then all by one factor where their mean "
    "is still below {share} of the target",
    "each": "Every record is scaled by least squares of ln SA over this range",
    "suite": "All records are scaled by one factor, the least by which their mean is nowhere below {share} of the target",
    "none": "The records are as they were: nothing is scaled to the target",
}
PAIRS = {
    "apart": "The mean is the arithmetic one of all horizontal components, each with a spectrum of its own.",
    "srss": "The mean is the arithmetic one over stations, each with the square root of the sum of its components' squares, as "
    "EN 1998-2 has it.",
}
CAVEAT = (
    "Components of a station have one factor. The study's scale comes on top. Where records come in pairs EN 1998-2 asks for "
    "the mean of roots of sums of squares (the study's key pairs), and ASCE 7 for maximum-direction spectra, which are not "
    "formed here. What the codes say is taken from later literature, not checked against their clauses, and no conformity is "
    "claimed."
)
NEAR_KM = 15.0
"""A usual limit of near-source sites: ASCE 7-16, 11.4.1, has 15 km from a fault of M 7, and 10 km of M 6."""

MOST_PERIODS = 12


def section(contents: Contents) -> Section | None:
    """Compare the suite with its target spectrum; None if the study has none."""
    finished = contents.finished
    target = None if finished is None else finished.info.get("target")
    if finished is None or target is None or not finished.info["records"] or not _sound(target):
        return None
    records = finished.info["records"]
    content = join(
        _fit(target, records),
        _picture(finished, target, records),
        _ratios(target),
        _near_source(records),
    )
    return Section("The suite against its target spectrum", "target", content)


def _sound(target: Mapping[str, Any]) -> bool:
    """Return whether the parts of a target fit each other, since run.json may come from anybody."""
    periods, spectra = target["period_s"], (target["sa_g"], target["mean_sa_g"])
    fitting = all(len(spectrum) == len(periods) > 0 for spectrum in spectra)
    return (
        len(target["range_s"]) == 2 and min(target["range_s"]) > 0 and fitting and min((*periods, *target["sa_g"])) > 0
    )


def _fit(target: Mapping[str, Any], records: Sequence[Mapping[str, Any]]) -> Markup:
    low, high = target["range_s"]
    share = f"{target['at_least']:g}"
    scaled = FACTORS[target["factors"]].format(share=share)
    factors = [record.get("factor", 1.0) for record in records]
    extent = (
        f" (factors {min(factors):.3g} to {max(factors):.3g}, in the table of ground motions)"
        if target["factors"] != "none"
        else ""
    )
    over = _over(target)
    least, most = int(np.argmin(over)), int(np.argmax(over))
    periods = target["period_s"]
    words = (
        f"Over the range, the mean of their spectra is {over[least]:.2f} of the target at least, at "
        f"{periods[least]:.2g} s, and {over[most]:.2f} at most, at {periods[most]:.2g} s"
    )
    below = float(over[least]) < target["at_least"] * (1 - 1e-3)
    warning = alarm(f": below the {share} that is asked for.") if below else "."
    alone = ""
    if target["pairs"] == "srss" and target["alone"]:
        alone = alarm(f" {counted(target['alone'], 'station')} without two components: that is less than a pair has.")
    what = tag("strong", target["spectrum"])
    first = join("Target: ", what, f", between {low:g} s and {high:g} s. {scaled}{extent}.")
    return paragraphs(first, join(words, warning), join(PAIRS[target["pairs"]], alone), CAVEAT)


def _over(target: Mapping[str, Any]) -> "np.ndarray[Any, np.dtype[np.float64]]":
    return np.array(target["mean_sa_g"], dtype=np.float64) / np.array(target["sa_g"], dtype=np.float64)


def _picture(finished: Finished, target: Mapping[str, Any], records: Sequence[Mapping[str, Any]]) -> Markup:
    """Draw target, records and mean; empty if run.json has no spectra, as for very large suites."""
    spectra = finished.info.get("spectra")
    if not spectra or len(spectra["sa_g"]) != len(records) or not response_spectra.drawable(spectra):
        return join()
    low, high = target["range_s"]
    drawn = response_spectra.draw(spectra, [finished.label(record["record"]) for record in records], (low, high))
    caption = (
        f"Pseudo-spectral accelerations of the horizontal components, {100 * spectra['damping']:g} % damped, their "
        "mean, and the target; shaded: the range over which they are fitted."
    )
    return figure(drawn, caption)


def _ratios(target: Mapping[str, Any]) -> Markup:
    """Return the mean over the target at some of the periods, including both ends."""
    periods, over = target["period_s"], _over(target)
    places = np.unique(np.linspace(0, len(periods) - 1, min(MOST_PERIODS, len(periods))).round().astype(int))
    heads = [
        Head("T [s]", ".3g"),
        Head("target SA [g]", ".3f"),
        Head("mean SA [g]", ".3f"),
        Head("mean over target", ".2f"),
    ]
    rows = [[periods[i], target["sa_g"][i], target["mean_sa_g"][i], float(over[i])] for i in places]
    return join(tag("h3", "Mean over target"), table(heads, rows, name="Mean over target"))


def _near_source(records: Sequence[Mapping[str, Any]]) -> Markup:
    kinds = [record.get("pulse") for record in records]
    pulses, open_ = kinds.count("yes"), kinds.count("ambiguous")
    of_pulses = (record.get("pulse_period_s") for record in records if record.get("pulse") == "yes")
    periods = sorted(period for period in of_pulses if period is not None)
    sentence = f"{pulses} of {counted(len(records), 'horizontal component')} ({100 * pulses / len(records):.0f} %) "
    sentence += f"{'is' if pulses == 1 else 'are'} pulse-like"
    stations = {record.get("station") or record["record"] for record in records}
    with_pulse = {record.get("station") or record["record"] for record in records if record.get("pulse") == "yes"}
    sentence += f", at {len(with_pulse)} of {counted(len(stations), 'station')}" if len(stations) < len(records) else ""
    sentence += f", with pulses of {periods[0]:.2g} to {periods[-1]:.2g} s" if periods else ""
    sentence += f"; of {open_} more the criterion does not tell" if open_ else ""
    criterion = (
        "By the wavelet criterion of Baker (2007): pulse indicator above 0.85, PGV of 0.3 m/s at least before scaling, "
        "and an early pulse. It was made for fault-normal components; another direction of the same record may be "
        "judged otherwise."
    )
    far = [record.get("distance_km") for record in records]
    known = [distance for distance in far if distance is not None]
    near = sum(distance <= NEAR_KM for distance in known)
    where = "No distance from the source is known; a manifest has a place for it (distance_km in motions.toml)."
    if known:
        were = "was" if near == 1 else "were"
        where = (
            f"Of {counted(len(known), 'component')} with a known distance {near} {were} recorded within {NEAR_KM:g} km"
        )
        where += f"; of the other {len(far) - len(known)} it is not known" if len(known) < len(far) else ""
        where += ". The distance is the one that the manifest or the file has, whichever kind that is."
    asked = (
        "A site near a fault asks for a share of pulse-like records like that of its hazard, and one far from faults for "
        "none; see which yours is."
    )
    return join(tag("h3", "Pulses and near-source records"), paragraphs(f"{sentence}. {criterion}", where, asked))
