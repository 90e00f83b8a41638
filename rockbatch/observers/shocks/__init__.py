"""Effects of each shock of a sequence: shocks.csv."""

TABLE = "shocks.csv"
