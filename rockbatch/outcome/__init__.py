"""The outcome of a run, its histories, and quantities that follow from these without the core."""
