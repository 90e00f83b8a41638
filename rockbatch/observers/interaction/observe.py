"""Axial force and moment in sections, and normal force and shear of the base, of the same moment: read from every step."""

from dataclasses import dataclass

import numpy as np

from rockbatch.motions.motion import Samples
from rockbatch.observers.interaction import TABLE
from rockbatch.observers.interaction.envelopes import Envelope, envelope, thinned, with_errors
from rockbatch.observers.interaction.study import Interaction
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier.sections import section_heights
from rockbatch.quantities.demands import OF_INTERACTION
from rockbatch.simulation.base_forces import at_rows
from rockbatch.simulation.coarser import of_model
from rockbatch.simulation.error_control import CHANCE
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.recording import Recording, upright
from rockbatch.simulation.runs import Run
from rockbatch.simulation.sections import forces_in_sections
from rockbatch.study import Output

SHARES = np.array([0.25, 0.5, 0.75])
"""Shares of a step at which forces of the base are interpolated."""


def _at_base(recording: Recording) -> Envelope:
    """Return the envelope of shear over normal force of the base, until the pier leans beyond α for good."""
    run = recording.run
    rows = upright(recording.rows, run.pier.alpha)
    forces = at_rows(run, rows)
    return envelope(None, *(with_values_between(rows.t, values) for values in (forces.normal, forces.shear)))


def with_values_between(t: Samples, values: Samples) -> Samples:
    """Return ``values`` at the times ``t`` [s] of rows, and behind all of them those interpolated at the :data:`SHARES` of steps.

    These are cubic through the four rows around a step, and left out for a step not as long as both its neighbours, as beside an
    event, and for the first and the last.
    """
    steps = np.diff(t)
    even = (steps[1:-1] > 0.0) & np.isclose(steps[:-2], steps[1:-1]) & np.isclose(steps[2:], steps[1:-1])
    around = np.flatnonzero(even)[:, None] + np.arange(4)
    s = SHARES[:, None]
    weights = -s * (s - 1) * (s - 2) / 6, (s * s - 1) * (s - 2) / 2, -s * (s + 1) * (s - 2) / 2, s * (s * s - 1) / 6
    return np.concatenate([values, (values[around] @ np.hstack(weights).T).ravel()])


@dataclass(frozen=True)
class InteractionInSections(Observer):
    """Axial forces and moments in sections of the shaft at some ``heights`` [m], and normal forces and shears of the ``base``, of
    every run that did not fail."""

    heights: tuple[float, ...]
    base: bool = False

    table = TABLE

    def reads(self, run: Run, outcome: Outcome) -> bool:
        """Return True unless the run failed."""
        return outcome.status != "failed"

    def read(self, recording: Recording, outcome: Outcome) -> list[Envelope]:
        """Return the envelope in each section, and that of the base behind them."""
        heights = section_heights(recording.run.pier, self.heights) if self.heights else ()
        forces = forces_in_sections(recording.run, recording.rows, heights)
        found = [envelope(height, its.axial, its.moment) for height, its in zip(heights, forces, strict=True)]
        return [*found, _at_base(recording)] if self.base else found

    def beyond(self, run: Run, fine: list[Envelope], fewer: list[Envelope]) -> list[Envelope]:
        """Return ``fine`` with ``CHANCE`` times the relative change by ``fewer`` modes or strips added to its errors.

        NaN if the last mode is damped too strongly for its change to tell.
        """
        return with_errors(fine, fewer, of_model(run, 1.0, CHANCE))

    def add(self, run: Run, outcome: Outcome, fine: list[Envelope] | None, coarse: list[Envelope] | None) -> Outcome:
        """Return ``outcome`` with a row of the table for each corner of ``fine``, thinned, in kN, with errors by ``coarse``.

        No rows without ``fine`` or a mass.
        """
        if fine is None or run.pier.mass_t is None:
            return outcome.with_table(self.table, [])
        rows = []
        for own in map(thinned, fine if coarse is None else with_errors(fine, coarse, CHANCE)):
            forces = run.pier.mass_t * np.array([own.axial, own.effect])
            for n, e in forces.T.tolist():
                moment, shear = (e, None) if own.height is not None else (None, e)
                rows.append(dict(zip(OF_INTERACTION, (own.height, n, moment, shear, own.error), strict=True)))
        return outcome.with_table(self.table, rows)


def requested(output: Output) -> InteractionInSections | None:
    """Return the observer if [output] of a study asks for it, else None."""
    settings = output.of(Interaction)
    chosen = InteractionInSections(settings.interaction_m, settings.interaction_base)
    return chosen if chosen.heights or chosen.base else None
