"""What a run states of each shock of a sequence: tables and pages read it without the simulation."""

import math
from dataclasses import dataclass
from typing import Literal

from rockbatch.common.statuses import Status

ShockStatus = Status | Literal["not reached", "not read"]


@dataclass(frozen=True)
class ShockOutcome:
    """Effects of a shock; SI units, angles in radians, NaN if one does not apply."""

    # "ok"; "overturned" or "flight" if the run ended so before the next shock began; "not reached"; "failed"; or "not read", of
    # a run too long to be held in memory
    status: ShockStatus
    # greatest rotation |θ| from its first sample until the next shock begins, or the run ends, and its time
    theta_max: float = math.nan
    t_max: float = math.nan
    theta_max_error: float = math.nan  # its change by halving the step; NaN with a fixed step
    # Static rest rotation on the deformed base when the next shock begins; with dampers or tendons the middle of the extremes
    # of θ in the last quarter of the pause. The last shock has a pause, too.
    theta_res: float = math.nan
    settlement: float = math.nan  # mean settlement of the supports since the start, at that time
    moving: float = math.nan  # half the range of θ in the last quarter of the pause
