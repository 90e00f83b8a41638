"""Runs on springs that ratchet are compared with runs by the other spring law."""

from dataclasses import dataclass, replace

from rockbatch.observers.other_law.study import BothLaws
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import Base, YieldingBase
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.runs import Run
from rockbatch.study import Output


@dataclass(frozen=True)
class OtherLaw(Observer):
    """Settlement by the other spring law, to the same tolerance; with a note unless that converged."""

    def beside(self, run: Run, outcome: Outcome) -> Run | None:
        """Return the run on springs of the other law; None if the springs do not ratchet, or ``run`` was refused."""
        base = by_other_law(run.base)
        return replace(run, base=base) if base and outcome.was_run else None

    def compare(self, outcome: Outcome, other: Outcome) -> Outcome:
        """Return ``outcome`` with the settlement of the ``other`` [m], None if that did not stand, and a note if it failed."""
        failed = f"by the other spring law: {other.reason}" if other.status == "failed" else ""
        return outcome.noted(failed).with_observed("other_law", other.settlement)

    def reads(self, run: Run, outcome: Outcome) -> bool:
        """Return False: histories are not read."""
        return False


def by_other_law(base: Base) -> YieldingBase | None:
    """Return a base on Bouc–Wen springs with elastic–perfectly plastic ones; None for another, whose springs do not ratchet."""
    if not isinstance(base, YieldingBase) or base.law.creep is None:
        return None
    return replace(base, spring=base.law.creep.other)


def requested(output: Output) -> OtherLaw | None:
    """Return the observer if [output] of a study asks for it, else None."""
    return OtherLaw() if output.of(BothLaws).both_laws else None
