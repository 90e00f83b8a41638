"""Release test: restitution, or the losses of springs, fitted to measured impacts and amplitudes."""

from rockbatch.common.analyses import Door
from rockbatch.common.slices import ReportPart

DOOR = Door(
    parts=(ReportPart("The release test", "release"),),
    tables=("release",),
    engine=False,
)
