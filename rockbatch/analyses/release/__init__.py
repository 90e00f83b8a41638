"""Release test: restitution, or the losses of springs, fitted to measured impacts and amplitudes."""

from rockbatch.common.analyses import Door, ReportPart

DOOR = Door(
    parts=(ReportPart("The release test", "release", "section.section"),),
    tables=("release",),
    engine=False,
)
