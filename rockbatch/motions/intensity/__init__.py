"""Intensity measures of motions and of pairs of components, and velocity pulses."""
