"""A pier on two springs that dampers and tendons tie to the ground: one run at a time."""
