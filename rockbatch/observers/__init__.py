"""Optional outputs of runs, a folder each: results beyond the peaks, read from one history of a run."""
