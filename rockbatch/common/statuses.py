"""Ways in which a run ends."""

from typing import Literal, get_args

Status = Literal["ok", "overturned", "flight", "failed"]
STATUSES: tuple[Status, ...] = get_args(Status)
NOT_STANDING = STATUSES[1:]
"""Statuses of runs that do not end standing."""
NO_PEAK: tuple[Status, ...] = ("overturned", "flight")
"""Statuses without a largest rotation: they count as infinite."""
CUT_SHORT: tuple[Status, ...] = ("flight", "failed")
"""Statuses of runs that ended early: their values are only bounds."""
