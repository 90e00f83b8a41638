"""The ground motions: response spectra, intensity measures, and sources."""

from collections.abc import Sequence
from typing import Any

from rockbatch.report.contents import Contents
from rockbatch.report.document import Section, figure
from rockbatch.report.drawing import response_spectra
from rockbatch.report.finished import Finished
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.table import Head, table

PULSE_LIKE = (
    "by the criterion of Baker (2007), of the record before scaling; late, weak: no, because the pulse arrives late or PGV is "
    "below 0.3 m/s"
)


def section(contents: Contents) -> Section | None:
    """Describe the ground motions that could be used."""
    finished = contents.finished
    if finished is None or not finished.info["records"]:
        return None
    return Section("Ground motions", "records", join(_spectra(finished), _records(finished)))


def _spectra(finished: Finished) -> Markup:
    """Draw the response spectra; empty if run.json has none, as for very large suites, or if the target shows them."""
    records, spectra = finished.info["records"], finished.info.get("spectra")
    if (
        "target" in finished.info
        or not spectra
        or len(spectra["sa_g"]) != len(records)
        or not response_spectra.drawable(spectra)
    ):
        return join()
    caption = (
        f"Pseudo-spectral accelerations of the horizontal components, {100 * spectra['damping']:g} % damped, before "
        "the study's scale."
    )
    return figure(response_spectra.draw(spectra, [finished.label(record["record"]) for record in records]), caption)


def _records(finished: Finished) -> Markup:
    """Return a table of the ground motions as used, like the paper's Table 1, the weakest first."""
    heads = [
        Head("record"),
        Head("station", note="its components count as one record"),
        Head("PGA [g]", ".3f"),
        Head("PGV [m/s]", ".3f"),
        Head("PGD [m]", ".3f"),
        Head("vertical PGA [g]", ".3f"),
        Head("Arias [m/s]", ".3f", "arias_m_s: Arias intensity"),
        Head("D5–95 [s]", ".1f", "d5_95_s: significant duration, from 5 to 95 % of the Arias intensity"),
        Head("dt [s]"),
        Head("points"),
        Head("length [s]", ".2f", "duration_s: from the first to the last sample"),
        Head("processed", note="whether its agency has corrected it; empty: the file does not say"),
        Head("to check", note="what is odd about it; the notes below say more"),
        Head("azimuth [°]", note="degrees clockwise from north"),
        Head("M", note="magnitude"),
        Head("distance [km]"),
        Head("factor", ".4g", "what brought the record to the study's target"),
        Head("pulse-like", note=PULSE_LIKE),
        Head("pulse indicator", ".2f", "pulse_indicator: above 0.85 pulse-like, below 0.15 not"),
        Head("pulse [s]", ".2f", "pulse_period_s: period of the largest pulse"),
    ]
    names = (
        "station", "pga_g", "pgv_m_s", "pgd_m", "pga_v_g", "arias_m_s", "d5_95_s", "dt_s", "npts", "duration_s",
        "processed", "check", "azimuth_deg", "magnitude", "distance_km", "factor", "pulse", "pulse_indicator",
        "pulse_period_s",
    )  # fmt: skip
    scaled = any(record.get("factor", 1.0) != 1.0 for record in finished.info["records"])
    ordered = sorted(finished.info["records"], key=lambda record: (record["pga_g"], record["record"]))
    rows = [
        [
            finished.shown(record["record"]),
            *(_value(record, name) if name != "factor" or scaled else None for name in names),
        ]
        for record in ordered
    ]
    measured = table(heads, rows, sortable=True, name="Ground motions")
    lacking = finished.info.get("without_vertical")
    without = tag("p", f"no vertical: {'; '.join(map(finished.named, lacking))}") if lacking else ""
    heading = tag("h3", "Where they come from, and what was done to them")
    return join(measured, without, heading, _sources(finished, ordered))


def _value(record: dict[str, Any], name: str) -> Any:
    """Return a value of run.json as shown in the table of ground motions."""
    if name == "processed":
        return {True: "yes", False: "no"}.get(record.get(name, ""))
    if name == "check":
        return ", ".join(finding["what"] for finding in record.get("findings", [])) or None
    return record.get(name)


def _sources(finished: Finished, records: Sequence[dict[str, Any]]) -> Markup:
    heads = [Head("record"), Head("horizontal from"), Head("vertical from"), Head("what was done")]
    rows: list[list[object]] = []
    for record in records:
        notes = tag("ul", *(tag("li", note) for note in record["notes"])) if record["notes"] else ""
        sources = (record[name] and tag("span", record[name], class_="path") for name in ("source", "vertical_source"))
        rows.append([finished.shown(record["record"]), *sources, notes])
    return table(heads, rows, prose=True, name="Sources")
