"""Properties of a suite of motions that statistics of codes depend on: stations, events, records and target spectrum."""

from collections.abc import Collection, Mapping
from typing import NamedTuple


class Suite(NamedTuple):
    """The motions of a suite, by the names of their horizontal components.

    Attributes
    ----------
    stations, events : mapping
        Station and earthquake of each component, empty if it is not known.
    unrecorded : collection of str
        Components that are not records: pulses, and still ground.
    code : str
        The code by whose conditions the suite is held against its target spectrum; empty if it is not.
    """

    stations: Mapping[str, str] = {}
    events: Mapping[str, str] = {}
    unrecorded: Collection[str] = ()
    code: str = ""
