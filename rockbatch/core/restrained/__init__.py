"""A block on a rigid base that dampers and tendons tie to the ground: one run at a time."""
