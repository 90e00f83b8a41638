"""The next questions about a study, each answered by batches of runs of its own."""
