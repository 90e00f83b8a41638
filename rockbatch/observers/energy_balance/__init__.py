"""Energy balance of runs."""
