"""What a study or a manifest may say about records: units, azimuths of components, and whether verticals are used."""

from typing import Any

from rockbatch.motions.limits import STEPS, is_step
from rockbatch.toml.kinds import KindError, number, text
from rockbatch.units import acceleration_factor

_LONGEST_NAME = 1000


def unit(value: Any) -> str:
    """A unit of acceleration, as it was written."""
    try:
        acceleration_factor(text(value))
    except KindError:
        raise
    except ValueError as error:
        raise KindError(str(error).rpartition("; write ")[2]) from None
    return str(value)


def file_name(value: Any) -> str:
    """The name of a file, as one that there can be."""
    if isinstance(value, str) and ("\x00" in value or len(value) > _LONGEST_NAME):
        raise KindError("the name of a file")
    return str(text(value))


def vertical(value: Any) -> bool | str:
    """Whether vertical components are used: true, false, or "required"."""
    if not isinstance(value, bool) and value != "required":
        raise KindError('true, false or "required"')
    return value


def step(value: Any) -> float:
    """A sampling interval [s]."""
    if isinstance(value, int | float) and not is_step(value):
        raise KindError(f"a sampling interval of {STEPS}")
    return number(value)


def azimuth(value: Any) -> float:
    """Degrees clockwise from north, 0..360."""
    if not 0 <= number(value) <= 360:
        raise KindError("an azimuth within 0..360 degrees")
    return float(value)
