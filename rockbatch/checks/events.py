"""Records of one earthquake, which a code's statistic takes as independent motions."""

from collections import Counter
from collections.abc import Mapping
from typing import NamedTuple

from rockbatch.quantities.arrays import Texts


class OfEvent(NamedTuple):
    """The earthquake with the most records of a suite: its name and their number; the number of all, and of unknown events."""

    event: str
    records: int
    total: int
    unknown: int

    @property
    def remarks(self) -> list[str]:
        """Remarks on records of one event, if it has several: "3 of 8 stations are of one event, Kaikoura 2016".

        And on unknown events, if some are unknown but not all; [] for neither.
        """
        parts = []
        if self.records > 1:
            parts.append(f"{self.records} of {self.total} stations are of one event, {self.event}")
        if 0 < self.unknown < self.total:
            parts.append(f"of {self.unknown} of {self.total} stations the event is not known")
        return parts


def largest_event(records: Texts, counted_as: Texts, events: Mapping[str, str]) -> OfEvent:
    """Return the earthquake with the most records; "" with none of them if none is known.

    ``records`` and ``counted_as`` have the component of each run and the record under which it counts, shape (n,); ``events``
    has the earthquake of each component, "" if it is not known. Of equal numbers the first counts.
    """
    event_of: dict[str, str] = {}
    for record, counted in zip(records, counted_as, strict=True):
        event_of[counted] = event_of.get(counted) or events.get(record, "")
    named = Counter(event for event in event_of.values() if event)
    event, number = next(iter(named.most_common(1)), ("", 0))
    return OfEvent(event, number, len(event_of), len(event_of) - sum(named.values()))
