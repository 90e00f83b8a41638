"""The ground motions: response spectra, measures, sources, and files that could not be used."""

from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup, figure, join, tag
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import MOST_ROWS, Head, listed, table
from rockbatch.results.labelled import Item, as_dicts
from rockbatch.results.spectra_figure import drawable, response_spectra

COLUMNS = (
    Head("event", value="event"),
    Head("station", value="station_name"),
    Head("code", note="column station of peaks.csv: components of a station count as one record", value="station"),
    Head("PGA", ".3f", value="pga_g", unit="g"),
    Head("PGV", ".3f", value="pgv_m_s", unit="m/s"),
    Head("PGD", ".3f", value="pgd_m", unit="m"),
    Head("vertical PGA", ".3f", value="pga_v_g", unit="g"),
    Head("Arias", ".3f", "arias_m_s: Arias intensity", value="arias_m_s", unit="m/s"),
    Head(
        "D5–95",
        ".1f",
        "d5_95_s: significant duration, from 5 to 95 % of the Arias intensity",
        value="d5_95_s",
        unit="s",
    ),
    Head("dt", value="dt_s", unit="s"),
    Head("points", value="npts"),
    Head("length", ".2f", "duration_s: from the first to the last sample", value="duration_s", unit="s"),
    Head(
        "processed",
        note="whether its agency has corrected it; empty if the file does not say",
        value=lambda record: {True: "yes", False: "no"}.get(record.get("processed", "")),
    ),
    Head(
        "to check",
        note="apparent faults; see the notes below",
        value=lambda record: ", ".join(finding["what"] for finding in record.get("findings", [])) or None,
    ),
    Head("azimuth", note="degrees clockwise from north", value="azimuth_deg", unit="°"),
    Head("M", note="magnitude", value="magnitude"),
    Head("distance", value="distance_km", unit="km"),
    Head("factor", ".4g", "scale factor to the study's target", value="factor"),
    Head(
        "vertical factor",
        ".4g",
        "vertical_factor: scale factor of the vertical component, if different",
        value="vertical_factor",
    ),
    Head(
        "pulse",
        ".2f",
        "pulse_period_s: pulse period if the unscaled record is pulse-like by Baker (2007)",
        unit="s",
        value="pulse_period_s",
    ),
)
"""Columns of the table of ground motions; a ``value`` that is a name is a key of run.json's records."""


def section(finished: Finished) -> Markup:
    """Return spectra, table and sources of the usable ground motions, weakest first; empty without any.

    Spectra are left out if the study has a target, which is compared with them elsewhere.
    """
    if not finished.info["records"]:
        return Markup("")
    caption = "before the study's scale."
    picture = Markup("") if "target" in finished.info else spectra(finished, caption)
    records = sorted(finished.info["records"], key=lambda record: (record["pga_g"], record["record"]))
    name = Head("record", value=lambda record: finished.shown(record["record"]))
    scaled = any(record.get("factor", 1.0) != 1.0 for record in records)
    heads = [
        name,
        Head("in peaks.csv", value="record"),
        *(head for head in COLUMNS if scaled or head.value != "factor"),
    ]
    lacking = finished.info.get("without_vertical")
    no_vertical = tag("p", f"no vertical: {'; '.join(map(finished.named, lacking))}") if lacking else ""
    sources = [
        name,
        Head("horizontal from", value=lambda record: _path(record["source"])),
        Head("vertical from", value=lambda record: _path(record["vertical_source"])),
        Head("processing", value=_processing),
    ]
    return join(
        picture,
        listed(heads, records, sortable=True, name="Ground motions"),
        no_vertical,
        tag(
            "details",
            tag("summary", "Files and their processing"),
            listed(sources, records, prose=True, name="Sources"),
        ),
    )


def spectra(finished: Finished, caption: str, fitted: tuple[float, float] | None = None) -> Markup:
    """Return the figure of response spectra; empty if run.json has none that match its records, as in very large suites."""
    records, shown = finished.info["records"], finished.info.get("spectra")
    if not shown or len(shown["sa_g"]) != len(records) or not drawable(shown):
        return Markup("")
    described = response_spectra(shown, [finished.label(record["record"]) for record in records], fitted)
    lead = f"Pseudo-spectral accelerations of the horizontal components, {100 * shown['damping']:g} % damped, "
    return figure(drawn(described), lead, caption)


def _path(source: str | None) -> object:
    return source and tag("span", source, class_="path")


def _processing(record: Item) -> object:
    return tag("ul", *(tag("li", note) for note in record["notes"])) if record["notes"] else ""


def unusable(finished: Finished) -> Markup:
    """Return tables of files and runs without a result, and of files left out on purpose, with reasons; empty without any."""
    rows = [[entry["name"], "", entry["source"], entry["reason"]] for entry in finished.info["unusable"]]
    failed = finished.runs[finished.runs["status"] == "failed"]
    most = max(MOST_ROWS - len(rows), 0)
    rows += [
        [finished.shown(run["record"]), finished.case_of(run), "", run["reason"]] for run in as_dicts(failed[:most])
    ]
    rows += [[]] * (len(failed) - most)  # not shown
    heads = [Head("record"), Head("case", key=True), Head("file"), Head("why")]
    shown = table(heads, rows, prose=True, name="Not used") if rows else Markup("")
    left_out = finished.info.get("left_out")
    if not left_out:
        return shown
    heads = [Head("record", value="name"), Head("file", value="source"), Head("why", value="reason")]
    named = [file for file in left_out if file.get("named")]
    others = [file for file in left_out if not file.get("named")]
    for title, files in (("Left out by name", named), ("Left out", others)):
        if files:
            shown = join(shown, tag("h3", title), listed(heads, files, prose=True, name=title))
    return shown
