"""Kinds of values that a study or a manifest may state about records: units, sampling intervals, azimuths of components."""

from rockbatch.common.units import ACCELERATIONS, acceleration_factor
from rockbatch.motions.limits import LONGEST_STEP, SHORTEST_STEP, STEPS
from rockbatch.toml.kinds import Choice, KindError, Number, Other, Text, Whole, text

_LONGEST_NAME = 1000


def _check_unit(value: str) -> None:
    """Raise :class:`KindError` for a text that is no unit of acceleration."""
    try:
        acceleration_factor(value)
    except ValueError:
        raise KindError(f"expected {ACCELERATIONS}", whole=True) from None


def _check_file_name(value: str) -> None:
    """Raise :class:`KindError` for a file name with a NUL, or of more than 1000 characters."""
    if "\x00" in value or len(value) > _LONGEST_NAME:
        raise KindError("the name of a file")


_NUMBER = Whole()


def _channel(value: object) -> int | str:
    """Return the text, or whole number from 1, that names a component; raise ``KindError`` for other values."""
    if isinstance(value, float) and value.is_integer():
        value = int(value)  # 2.0, which a schema takes for a whole number, too
    return _NUMBER(value) if isinstance(value, int) else text(value)


unit = Text(check=_check_unit)
file_name = Text(check=_check_file_name)
channel = Other("text in quotes, or a whole number", _channel, {"anyOf": [text.schema(), _NUMBER.schema()]})
vertical = Choice((True, False, "required"), 'true, false or "required"')
step = Number(f"a sampling interval of {STEPS}", low=SHORTEST_STEP, high=LONGEST_STEP)
azimuth = Number("an azimuth within 0..360 degrees", low=0.0, high=360.0)
