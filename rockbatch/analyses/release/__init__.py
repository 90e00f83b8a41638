"""Release test: restitution, or the losses of springs, fitted to measured impacts and amplitudes."""

from rockbatch.common.analyses import Door, ReportPart

DOOR = Door(
    help="fit restitution or damping to a release test",
    example="rockbatch release test.toml",
    writes="  release.csv          what was fitted, and its interval\n"
    "  release_impacts.csv  times and amplitudes, measured and computed\n"
    "  release_history.csv, release.json, and a section of report.html",
    parts=(ReportPart("The release test", "release", "section.section"),),
    tables=("release",),
    engine=False,
)
