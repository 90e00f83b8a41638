"""Properties of a suite of motions that statistics of codes depend on: stations, events, records and target spectrum."""

from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple


class Suite(NamedTuple):
    """The motions of a suite, by the names of their horizontal components."""

    # station and earthquake of each component, empty if it is not known
    stations: Mapping[str, str] = {}
    events: Mapping[str, str] = {}
    # stations of the shocks of each component that is a sequence of records of several stations; () if they are not known
    shocks: Mapping[str, Sequence[str]] = {}
    unrecorded: Collection[str] = ()  # components that are not records: pulses, and still ground
    without_vertical: Collection[str] = ()  # components that lack the vertical component which the study asks for
    not_selected: Mapping[str, int] = {}  # number of components that the study does not select, by station
    code: str = ""  # the code by whose conditions the suite is held against its target spectrum; empty if it is not
