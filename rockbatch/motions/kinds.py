"""What a study or a manifest may say about a record: its unit, and the azimuth of a component."""

from typing import Any

from rockbatch.toml.kinds import KindError, number, text
from rockbatch.units import acceleration_factor


def unit(value: Any) -> str:
    """A unit of acceleration, as it was written."""
    try:
        acceleration_factor(text(value))
    except KindError:
        raise
    except ValueError as error:
        raise KindError(str(error).rpartition("; write ")[2]) from None
    return str(value)


def azimuth(value: Any) -> float:
    """Degrees clockwise from north, 0..360."""
    if not 0 <= number(value) <= 360:
        raise KindError("an azimuth within 0..360 degrees")
    return float(value)
