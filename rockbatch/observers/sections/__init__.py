"""Forces in sections of the shaft: sections.csv."""

TABLE = "sections.csv"
