"""What a list beside records says of one of them."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Listed:
    """What a list says of a record; None where it does not."""

    scale: float | None = None
    magnitude: float | None = None
    distance_km: float | None = None
    vs30_m_s: float | None = None
    d5_95_s: float | None = None
    pulse_period_s: float | None = None


NOTHING = Listed()
"""Of a record that no list has."""
