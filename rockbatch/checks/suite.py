"""What is known of the motions of a suite beside their runs, which statistics of codes depend on."""

from collections.abc import Collection, Mapping
from typing import NamedTuple


class Suite(NamedTuple):
    """The motions of a suite, by the names of their horizontal components.

    Attributes
    ----------
    stations, events : mapping
        Station and earthquake of each component, empty if it is not known.
    unrecorded : collection of str
        Components that nobody recorded: pulses, and ground that does not move.
    code : str
        The code by whose conditions the suite is held against its target spectrum; empty if it is not.
    """

    stations: Mapping[str, str] = {}
    events: Mapping[str, str] = {}
    unrecorded: Collection[str] = ()
    code: str = ""
