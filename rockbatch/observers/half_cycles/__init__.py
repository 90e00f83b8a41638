"""Half cycles of rocking: half_cycles.csv."""

TABLE = "half_cycles.csv"
