"""Observers of runs: optional outputs, all read from one history of a run, and their errors from one of twice its step."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, ClassVar

from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.motions.motion import Motion
from rockbatch.outcome.outcome import Outcome
from rockbatch.simulation.recording import Recording, recorded, recorded_side_by_side
from rockbatch.simulation.runs import Run, Stop, steps_of

MOST_STEPS_RECORDED = 5_000_000
"""Longer runs are not recorded at every step: half a gigabyte."""


class Observer:
    """An optional output of runs. Subclasses are frozen dataclasses of settings, which engines send to other machines.

    Attributes
    ----------
    table : str
        File of its rows beside peaks.csv, a key of :attr:`Outcome.tables`; empty for columns of peaks.csv.
    every_step : bool
        True if it reads every step, not only samples and events.
    most_steps : float
        Steps of a run beyond which it reads none.
    separates_lean : bool
        True if it finds whether a peak is lean, which is else found with a shorter run.
    column : str
        A column of peaks.csv that has a number for each run that it read, if it adds to the histories; empty if it adds nothing.
    histories_of_steps : bool
        True if what it adds to the histories takes every step.
    """

    table: ClassVar[str] = ""
    every_step: ClassVar[bool] = True
    most_steps: ClassVar[float] = MOST_STEPS_RECORDED
    separates_lean: ClassVar[bool] = False
    column: ClassVar[str] = ""
    histories_of_steps: ClassVar[bool] = False

    def observes(self, motions: Sequence[Motion]) -> bool:
        """Return whether it observes runs under one of these ``motions``."""
        return True

    def beside(self, run: Run, outcome: Outcome) -> Run | None:
        """Return another run to whose outcome that of ``run`` is compared; None without."""
        return None

    def compare(self, outcome: Outcome, other: Outcome) -> Outcome:
        """Return ``outcome`` with what the other run came to."""
        return outcome

    def reads(self, run: Run, outcome: Outcome) -> bool:
        """Return whether it reads the history of a run."""
        return outcome.was_run

    def claims_error(self, outcome: Outcome) -> bool:
        """Return whether what it reads has an error, by a history of twice the step."""
        return outcome.status != "failed" and not outcome.chaotic

    def quiet_s(self, run: Run, quiet_s: float) -> float:
        """Return how long after its motion a run has to go on for it [s], ``quiet_s`` for others."""
        return quiet_s

    def read(self, recording: Recording, outcome: Outcome) -> Any:
        """Return what it takes from a history of a run."""

    def add(self, run: Run, outcome: Outcome, fine: Any, coarse: Any) -> Outcome:
        """Return ``outcome`` with what was read of it, None where nothing was, and of a history of twice the step."""
        return outcome

    def histories(self, recording: Recording) -> "Mapping[str, pd.DataFrame]":
        """Return fields of :class:`Response` that it adds to the histories of a run."""
        return {}


Found = dict[Observer, Any]
"""What each observer has read of a run."""


def observed(
    runs: Sequence[Run],
    outcomes: Sequence[Outcome],
    observers: Sequence[Observer],
    quiet_s: float,
    *,
    error: bool,
    wait: bool = True,
    stop: Stop | None = None,
) -> list[Outcome]:
    """Return ``outcomes`` with what ``observers`` read, with their ``error`` by a history of twice the step, too.

    A run that is too long to be recorded at every step is read at samples by those that need no more. Runs that come after
    ``stop`` are not read.
    """
    reading, halved = dict[int, list[Observer]](), [o.changed(substeps=o.substeps // 2) for o in outcomes]
    for i, (run, outcome) in enumerate(zip(runs, outcomes, strict=True)):
        chosen = [observer for observer in observers if _is_read(observer, run, outcome, quiet_s)]
        if chosen:
            reading[i] = chosen
    fine = _read_all(runs, outcomes, reading, quiet_s, wait, stop)
    claiming = {
        i: chosen
        for i, found in fine.items()
        if error and outcomes[i].substeps % 2 == 0 and (chosen := [o for o in found if o.claims_error(outcomes[i])])
    }
    coarse = _read_all(runs, halved, claiming, quiet_s, wait, stop, longer=False)
    done = list(outcomes)
    for i, run in enumerate(runs):
        for observer in observers:
            read, of_twice = (found.get(i, {}).get(observer) for found in (fine, coarse))
            done[i] = observer.add(run, done[i], read, of_twice)
    return done


def _is_read(observer: Observer, run: Run, outcome: Outcome, quiet_s: float) -> bool:
    if not (outcome.was_run and observer.reads(run, outcome)):
        return False
    return not observer.every_step or steps_of(run.motion, outcome.substeps, quiet_s) <= observer.most_steps


def _read_all(
    runs: Sequence[Run],
    outcomes: Sequence[Outcome],
    reading: Mapping[int, Sequence[Observer]],
    quiet_s: float,
    wait: bool,
    stop: Stop | None,
    longer: bool = True,
) -> dict[int, Found]:
    """Return what each observer in ``reading`` takes from the run of this number: those at samples side by side.

    If ``longer``, a run goes on for as long as one of them needs, and the others read until its own end.
    """
    found, together = dict[int, Found](), dict[float, list[int]]()
    for i, observers in reading.items():
        longest = max(observer.quiet_s(runs[i], quiet_s) for observer in observers) if longer else quiet_s
        if not any(observer.every_step for observer in observers):
            together.setdefault(longest, []).append(i)
        elif stop is None or not stop.is_set:
            try:
                recording = recorded(runs[i], outcomes[i], longest, True, wait)
            except InputError:  # too many impacts to be written down
                together.setdefault(longest, []).append(i)
            else:
                found[i] = _taken(recording, outcomes[i], observers, quiet_s, longest)
    for longest, numbers in together.items():
        chosen = [runs[i] for i in numbers], [outcomes[i] for i in numbers]
        for j, recording in recorded_side_by_side(*chosen, longest, wait, stop):
            i = numbers[j]
            at_samples = [observer for observer in reading[i] if not observer.every_step]
            found[i] = _taken(recording, outcomes[i], at_samples, quiet_s, longest)
    return found


def _taken(
    recording: Recording, outcome: Outcome, observers: Iterable[Observer], quiet_s: float, longest: float
) -> Found:
    """Return what ``observers`` read of a ``recording`` that goes on for the ``longest`` time after its motion [s]."""
    whole = {True: recording, False: recording.at_samples}
    own = recording.until(outcome.t_end) if longest > quiet_s else recording
    short = {True: own, False: own.at_samples}
    found = Found()
    for observer in observers:
        needs_all = observer.quiet_s(recording.run, quiet_s) > quiet_s
        found[observer] = observer.read((whole if needs_all else short)[observer.every_step], outcome)
    return found
