"""Analyses of a study, each by batches of runs of its own."""
