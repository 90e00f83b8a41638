"""Axial force and moment of the same moment in sections, read from every step of a run."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rockbatch.motions.motion import Samples
from rockbatch.observers.interaction.study import Interaction
from rockbatch.outcome.changes import LEAST
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier.sections import section_heights
from rockbatch.quantities.demands import OF_INTERACTION
from rockbatch.results.interaction import INTERACTION
from rockbatch.simulation.coarser import of_last_mode
from rockbatch.simulation.error_control import CHANCE
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.recording import Recording
from rockbatch.simulation.runs import Run
from rockbatch.simulation.sections import forces_in_sections
from rockbatch.study import Output

DIRECTIONS = np.linspace(0.0, np.pi, 61)
"""Directions in the plane of N and |M| in which two envelopes are compared [rad]."""


class Envelope(NamedTuple):
    """Corners of the least concave envelope of |M| over N in a section: forces and moments over the mass, shape (k,) each.

    ``error`` is relative to the greatest |N| and |M|; None with a fixed step.
    """

    height: float
    axial: Samples  # N/M, positive in compression, ascending [m/s²]
    moment: Samples  # |moment|/M [m²/s²]
    error: float | None = None


def envelope(height: float, axial: Samples, moment: Samples) -> Envelope:
    """Return the corners of the least concave envelope of |``moment``| over ``axial``, by ascending axial force.

    A ratio of moment to a concave capacity, over time, is greatest at one of its corners (THEORY.md, Forces in sections).
    """
    corners: list[tuple[float, float]] = []
    for point in sorted(zip(axial.tolist(), np.abs(moment).tolist(), strict=True)):
        while corners and (
            corners[-1][0] == point[0] or (len(corners) > 1 and not _turns_right(corners[-2], corners[-1], point))
        ):
            corners.pop()
        corners.append(point)
    n, m = np.array(corners).T
    return Envelope(height, n, m)


def _turns_right(first: tuple[float, float], second: tuple[float, float], third: tuple[float, float]) -> bool:
    """Return whether a path through three points, by ascending N, turns to the right at the second; False if it is straight."""
    (n, m), (n2, m2), (n3, m3) = first, second, third
    return (n2 - n) * (m3 - m) < (m2 - m) * (n3 - n)


def with_errors(fine: Sequence[Envelope], coarse: Sequence[Envelope], chance: float) -> list[Envelope]:
    """Return ``fine`` with ``chance`` times the greatest change of their reach in any direction added to their errors."""
    changed = []
    for own, other in zip(fine, coarse, strict=True):
        sizes = max(float(np.abs(own.axial).max()), LEAST), max(float(own.moment.max()), LEAST)
        change = float(np.abs(_reach(own, sizes) - _reach(other, sizes)).max())
        changed.append(own._replace(error=(own.error or 0.0) + chance * max(change, LEAST)))
    return changed


def _reach(of: Envelope, sizes: tuple[float, float]) -> Samples:
    """Return how far an envelope reaches in each of :data:`DIRECTIONS`, with N and |M| over their ``sizes``."""
    n, m = of.axial / sizes[0], of.moment / sizes[1]
    return np.asarray((np.outer(np.cos(DIRECTIONS), n) + np.outer(np.sin(DIRECTIONS), m)).max(axis=1))


@dataclass(frozen=True)
class InteractionInSections(Observer):
    """Axial forces and moments in sections of the shaft at some ``heights`` [m], of every run that did not fail."""

    heights: tuple[float, ...]

    table = INTERACTION

    def reads(self, run: Run, outcome: Outcome) -> bool:
        """Return True unless the run failed."""
        return outcome.status != "failed"

    def read(self, recording: Recording, outcome: Outcome) -> list[Envelope]:
        """Return the envelope in each section."""
        heights = section_heights(recording.run.pier, self.heights)
        forces = forces_in_sections(recording.run, recording.rows, heights)
        return [envelope(height, its.axial, its.moment) for height, its in zip(heights, forces, strict=True)]

    def beyond(self, run: Run, fine: list[Envelope], fewer: list[Envelope]) -> list[Envelope]:
        """Return ``fine`` with the change from ``fewer`` modes as errors."""
        return with_errors(fine, fewer, of_last_mode(run, 1.0, CHANCE))

    def add(self, run: Run, outcome: Outcome, fine: list[Envelope] | None, coarse: list[Envelope] | None) -> Outcome:
        """Return ``outcome`` with a row of the table for each corner of ``fine``, with errors by ``coarse``.

        No rows without ``fine`` or a mass.
        """
        if fine is None or run.pier.mass_t is None:
            return outcome.with_table(self.table, [])
        rows = []
        for own in fine if coarse is None else with_errors(fine, coarse, CHANCE):
            for n, m in zip(
                (run.pier.mass_t * own.axial).tolist(), (run.pier.mass_t * own.moment).tolist(), strict=True
            ):
                rows.append(dict(zip(OF_INTERACTION, (own.height, n, m, own.error), strict=True)))
        return outcome.with_table(self.table, rows)


def requested(output: Output) -> InteractionInSections | None:
    """Return the observer if [output] of a study asks for it, else None."""
    heights = output.of(Interaction).interaction_m
    return InteractionInSections(heights) if heights else None
