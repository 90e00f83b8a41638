"""Optional outputs of runs, a folder each: what a study asks for beyond the peaks, read from one history of a run."""
