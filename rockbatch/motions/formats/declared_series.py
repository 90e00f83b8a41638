"""Series declared by a line with count, interval and unit, then numbers in equal columns.

The volumes of Caltech, USC and CSMIP have them (Shakal & Huang 1985, OSMS 85-03): "1887 POINTS OF ACC DATA EQUALLY SPACED AT
.020 SEC. IN UNITS CM/SEC/SEC". Corrected volumes continue with velocities and displacements.
"""

import re

from rockbatch.common.errors import InputError
from rockbatch.motions.formats.fixed_width import fixed_numbers, number_in
from rockbatch.motions.formats.header_lines import line_at, match_line
from rockbatch.motions.formats.recording import Series
from rockbatch.motions.motion import Samples

_PER_LINE = 8
_SPACING = re.compile(
    r"\s*(?P<npts>[0-9]{1,9}) +"
    r"(?:points of (?P<what>acc|vel|dis)[a-z]*\.? data equally spaced at +(?P<dt>[0-9.]{1,12}) *sec"
    r"|accelerogram points at +(?P<rate>[0-9.]{1,12}) *pts/sec)\b(?P<rest>.*)",
    re.IGNORECASE,
)
_UNIT = re.compile(r"(?:\(units:|in units?(?: of)?|, *in) *(?P<unit>[a-z0-9/*^]+)", re.IGNORECASE)
_WORDS = {"acc": "accel", "vel": "veloc", "dis": "displ"}
_FORMAT = re.compile(r"\((?P<per_line>[0-9]{1,2})f(?P<width>[0-9]{1,2})\.[0-9]{1,2}\)", re.IGNORECASE)


def declares_series(lines: list[str], index: int) -> bool:
    """Return whether ``lines[index]`` declares a series, as "1887 POINTS OF ACC DATA EQUALLY SPACED AT .020 SEC" does.

    False after the last line.
    """
    return _SPACING.match(line_at(lines, index)) is not None


def declared_series(lines: list[str], start: int) -> tuple[float, dict[str, Series], int]:
    """Return the interval [s], the series by kind ("acc", "vel", "dis"), and the index of the line after them.

    ``lines[start]`` declares the accelerations; velocities and displacements may follow. Raises ``InputError`` with the line of
    an incomplete series.
    """
    _, dt, accelerations, end = _block(lines, start, ("acc",))
    series = {"acc": accelerations}
    while declares_series(lines, end):
        quantity, _, values, end = _block(lines, end, ("vel", "dis"))
        series[quantity] = values
    return dt, series, end


def _block(lines: list[str], start: int, expected: tuple[str, ...]) -> tuple[str, float, Series, int]:
    """Return kind ("acc", "vel", "dis"), interval [s], values with unit of the series at ``lines[start]``, and the next index."""
    line = match_line(_SPACING, lines, start, "… points of accel data equally spaced at … sec. (units: …)")
    quantity = (line["what"] or "acc").lower()
    unit, layout = _UNIT.search(line["rest"]), _FORMAT.search(line["rest"])
    npts = int(line["npts"])
    step = number_in(line["rate"] or line["dt"], start)
    if quantity not in expected or unit is None or npts < 1 or not 1e-6 < step < 1e6:
        raise InputError(
            f'line {start + 1}: found "{line[0].strip()[:75]}"; expected a count, an interval and a unit of '
            f"{' or '.join(_WORDS[word] for word in expected)}"
        )
    columns = (int(layout["width"]), int(layout["per_line"])) if layout else None
    values, end = equal_columns(lines, start + 1, npts, columns)
    return quantity, float(f"{1.0 / step:.12g}") if line["rate"] else step, (values, unit["unit"]), end


def equal_columns(
    lines: list[str], start: int, npts: int, columns: tuple[int, int] | None = None
) -> tuple[Samples, int]:
    """Return ``npts`` ≥ 1 numbers from ``lines[start]`` on, shape (npts,), and the index of the line after them.

    ``columns`` are their width and number per line; by default eight, with the width from the first line: 8F9.6 or 8F10.3. Every
    line is full but the last. Raises ``InputError`` with the line as :func:`fixed_numbers` does.
    """
    width, per_line = columns or (len(line_at(lines, start).rstrip()) // min(_PER_LINE, npts), _PER_LINE)
    if per_line < 1 or width < 2:
        raise InputError(f'line {start + 1}: found "{line_at(lines, start)[:40]}"; expected numbers in equal columns')
    return fixed_numbers(lines, start, npts, width, per_line)
