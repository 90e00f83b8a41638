"""Columns of the files of ``rockbatch sensitivity``."""

TORNADO = ("parameter", "low", "base", "high", "answer_low", "answer_base", "answer_high", "swing")
"""Columns of sensitivity.csv after those of the case."""

SOBOL = ("parameter", "first", "first_error", "total", "total_error")
"""Columns of sobol.csv after those of the case."""
