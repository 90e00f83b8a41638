"""Analyses of a study beyond its runs: a folder for each, listed in ``rockbatch/common/analyses.py``."""
