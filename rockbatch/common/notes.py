"""Words of a run's note, reason or kind by which other parts of the program recognise what it says."""

CHAOTIC = "chaotic"
"""Of a result that depends on digits that no record has: no error of it is claimed."""

OVERTURNS = "overturns the pier"
"""Of a chaotic run that stands, and falls under a motion a hair stronger or weaker."""

WOULD_SLIDE = "would slide"
"""Words of a note on a run whose friction demand is greater than what the interface has."""

RATCHETS = "the pier leans further and further"
"""Words of the reason of a run that failed because its springs ratchet on vibration after the motion."""

LINEARISED = "linearised kinematics"
"""Words of a note on a run whose rotations are too large for them."""

LEANS = "lean"
"""Kind of a greatest rotation at which the pier hardly rocks, on a base that has yielded."""
