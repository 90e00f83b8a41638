"""Text files of the program EMOD3D and of QuakeCoRE's ucgmsim: a component each, called .000, .090 or .ver.

A line with station and direction, one with count, interval, hour, minute and second of the first sample, distance and two
azimuths, then the values, six to a line between blanks. They do not state their quantity: records are in g, simulations in
cm/s² or, of velocities, in cm/s. The layout is that of the programs' own files.
"""

from rockbatch.common.errors import NoUnit
from rockbatch.motions.component import Component, Sensor
from rockbatch.motions.formats.fixed_width import lines_of, spaced_numbers
from rockbatch.motions.formats.header_lines import count_and_step, layout, read_header
from rockbatch.motions.formats.recording import Recording, to_components
from rockbatch.motions.labels.origin import origin_of
from rockbatch.motions.sources.record_file import RecordFile
from rockbatch.motions.unused import Unusable

_PER_LINE = 6
_TEXT = layout(
    (0, r"^(?P<station>\S{1,20}) +(?P<label>000|090|ver)(?: +(?P<title>.*?))? *$", "STATION 090"),
    (1, r"^ *(?P<npts>\d{1,9}) +(?P<dt>\S{1,20})(?: +[-+.\dEe]{1,20}){6} *$", "… points, interval, and six numbers"),
)


def is_emod3d(head: bytes) -> bool:
    """Return whether the first two lines are those of EMOD3D: station and direction, then count, interval and six numbers."""
    lines = head.decode("latin-1").splitlines()
    return len(lines) > 1 and all(pattern.search(lines[index][:200]) for index, pattern, _ in _TEXT)


def read_emod3d(file: RecordFile) -> list[Component | Unusable]:
    """Return the component in a list; raise ``InputError`` if the file is incomplete, or if the user has not stated its unit."""
    lines = lines_of(file.text)
    fields = read_header(lines, 0, _TEXT)
    npts, dt = count_and_step(fields, "npts", "dt")
    values = spaced_numbers(lines, 2, npts, _PER_LINE)
    if file.options.unit is None:
        raise NoUnit("no unit in the header")
    station = fields["station"]
    recording = Recording(
        label=fields["label"],
        dt=dt,
        values=values,
        unit=file.options.unit,
        station=", ".join(filter(None, [station, fields["title"]])),
        sensor=Sensor(station),
        origin=origin_of(fields["title"], station),
    )
    return to_components(file, [recording])
