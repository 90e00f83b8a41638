"""Observers that a study requests."""

from collections.abc import Iterable

from rockbatch.common.observers import parts
from rockbatch.motions import Motion
from rockbatch.simulation.observing import Observer
from rockbatch.study import Output


def observers_of(output: Output) -> tuple[Observer, ...]:
    """Return the requested observers that add columns to peaks.csv."""
    return tuple(observer for observer in _requested(output) if not observer.table)


def observers_beside(output: Output, motions: Iterable[Motion]) -> tuple[Observer, ...]:
    """Return the requested observers that write tables beside peaks.csv and apply to some of ``motions``."""
    read = list(motions)
    return tuple(observer for observer in _requested(output) if observer.table and observer.observes(read))


def _requested(output: Output) -> list[Observer]:
    requested = (requested(output) for requested in parts("observe.requested"))
    return [observer for observer in requested if observer is not None]
