"""Forces are read from every step of a run."""

from collections.abc import Mapping
from dataclasses import dataclass

from rockbatch.common.lazy import pd
from rockbatch.observers.forces.peaks import (
    PeakForces,
    forces_table,
    impacts_table,
    peak_forces,
    with_error,
    with_model_error,
)
from rockbatch.observers.forces.study import Forces
from rockbatch.outcome.outcome import Outcome
from rockbatch.simulation.base_forces import at_rows
from rockbatch.simulation.error_control import CHANCE
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.recording import Recording
from rockbatch.simulation.runs import Run
from rockbatch.study import Output

Peaks = tuple[PeakForces, str]
"""Demands on the design, and a note."""


@dataclass(frozen=True)
class PeaksOfForces(Observer):
    """The greatest forces; friction counts while N is above the share ``least_normal`` of the weight."""

    least_normal: float

    column = "base_shear_m_s2"

    def read(self, recording: Recording, outcome: Outcome) -> Peaks:
        """Return the design demands and a note."""
        return peak_forces(recording.run, recording.rows, self.least_normal)

    def beyond(self, run: Run, fine: Peaks, fewer: Peaks) -> Peaks:
        """Return ``fine`` with the change by ``fewer`` modes or strips in its error; NaN if the last mode is damped strongly."""
        return with_model_error(run, fine[0], fewer[0], CHANCE), fine[1]

    def add(self, run: Run, outcome: Outcome, fine: Peaks | None, coarse: Peaks | None) -> Outcome:
        """Return ``outcome`` with the demands and note of ``fine``, and their error by ``coarse``; unchanged without ``fine``."""
        if fine is None:
            return outcome
        peaks, note = fine
        outcome = outcome.noted(note)
        if coarse is not None:
            peaks, note = with_error(peaks, coarse[0], run.pier, CHANCE)
            outcome = outcome.noted(note)
        return outcome.with_observed("forces", peaks)

    def histories(self, recording: Recording) -> "Mapping[str, pd.DataFrame]":
        """Return the tables ``forces``, at samples and events, and ``impacts``."""
        run, rows = recording.run, recording.at_samples.rows
        moments = at_rows(run, recording.rows)[recording.shown] if run.base.remembers else at_rows(run, rows)
        return {"forces": forces_table(rows.t, moments, run.pier.gravity), "impacts": impacts_table(rows, moments)}


def requested(output: Output) -> PeaksOfForces | None:
    """Return the observer if [output] of a study asks for it, else None."""
    settings = output.of(Forces)
    return PeaksOfForces(settings.least_normal_share) if settings.forces else None
