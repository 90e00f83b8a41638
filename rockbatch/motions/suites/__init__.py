"""Suites of motions: selection, scaling, target spectra, hazard, sequences and pulses by formulas."""
