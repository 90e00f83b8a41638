"""Forces in sections are read from every step of a run."""

from dataclasses import dataclass

from rockbatch.observers.sections import TABLE
from rockbatch.observers.sections.study import Sections
from rockbatch.outcome.outcome import Outcome, Section
from rockbatch.pier.sections import section_heights
from rockbatch.results.sections import section_rows
from rockbatch.simulation.coarser import of_model
from rockbatch.simulation.error_control import CHANCE
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.recording import Recording
from rockbatch.simulation.runs import Run
from rockbatch.simulation.sections import sections_of, with_errors
from rockbatch.study import Output


@dataclass(frozen=True)
class ForcesInSections(Observer):
    """The greatest forces in so many sections of the shaft, or in those at some heights [m], of every run that did not fail."""

    sections: int | tuple[float, ...]

    table = TABLE

    def reads(self, run: Run, outcome: Outcome) -> bool:
        """Return True unless the run failed."""
        return outcome.status != "failed"

    def read(self, recording: Recording, outcome: Outcome) -> list[Section]:
        """Return the greatest forces in each section."""
        return sections_of(recording.run, recording.rows, section_heights(recording.run.pier, self.sections))

    def beyond(self, run: Run, fine: list[Section], fewer: list[Section]) -> list[Section]:
        """Return ``fine`` with ``CHANCE`` times the relative change by ``fewer`` modes or strips added to its errors.

        NaN if the last mode is damped too strongly for its change to tell.
        """
        return with_errors(fine, fewer, run.pier, of_model(run, 1.0, CHANCE))

    def add(self, run: Run, outcome: Outcome, fine: list[Section] | None, coarse: list[Section] | None) -> Outcome:
        """Return ``outcome`` with a row of the table for each section of ``fine``, if any, with errors by ``coarse``."""
        if fine is None:
            return outcome.with_table(self.table, [])
        sections = fine if coarse is None else with_errors(fine, coarse, run.pier, CHANCE)
        return outcome.with_table(self.table, section_rows(run.pier, sections))


def requested(output: Output) -> ForcesInSections | None:
    """Return the observer if [output] of a study asks for it, else None."""
    sections = output.of(Sections).requested
    return None if sections is None else ForcesInSections(sections)
