"""A reference that shares no code with rockbatch: an eighth-order Runge–Kutta pair that is restarted at every kink."""

from .reference import Reference, reference, twice

__all__ = ["Reference", "reference", "twice"]
