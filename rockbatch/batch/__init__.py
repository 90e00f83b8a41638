"""Batches of runs: plan, prepare, execute on an engine, and write the results."""
