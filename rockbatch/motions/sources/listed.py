"""A record's facts in the list of PEER's search beside it."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Listed:
    """Facts that a list gives of a record; None where it gives none."""

    scale: float | None = None
    magnitude: float | None = None
    distance_km: float | None = None
    vs30_m_s: float | None = None
    d5_95_s: float | None = None
    pulse_period_s: float | None = None


NOT_LISTED = Listed()
"""For a record in no list."""
