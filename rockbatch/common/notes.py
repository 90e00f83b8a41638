"""Words of a run's note by which other parts of the program recognise what it says."""

CHAOTIC = "chaotic"
"""Of a result that depends on digits that no record has: no error of it is claimed."""

OVERTURNS = "overturns the pier"
"""Of a chaotic run that stands, and falls under a motion a hair stronger or weaker."""
