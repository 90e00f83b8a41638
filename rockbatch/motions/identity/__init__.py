"""Which components belong together: stations, copies, directions, and the vertical of each horizontal."""
