"""Observers of runs: optional outputs, all read from one history of a run, and their errors from one of twice its step."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, ClassVar

from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.motions.motion import Motion
from rockbatch.outcome.outcome import Outcome
from rockbatch.simulation.coarser import coarser
from rockbatch.simulation.recording import Recording, recorded, recorded_side_by_side
from rockbatch.simulation.runs import Run, Stop, steps_of

MOST_STEPS_RECORDED = 5_000_000
"""Longer runs are not recorded at every step: half a gigabyte."""


class Observer:
    """An optional output of runs. Subclasses are frozen dataclasses of settings, which can be sent to other machines.

    Attributes
    ----------
    table : str
        File of its table beside peaks.csv, a key of :attr:`Outcome.tables`; empty if it adds columns to peaks.csv.
    every_step : bool
        True if it reads every step, not only samples and events.
    most_steps : float
        Greatest number of steps of a run that it reads at every step.
    separates_lean : bool
        True if it determines whether a peak is lean, which otherwise takes a shorter run.
    column : str
        A column of peaks.csv that is filled for each run that it read, if it adds to the histories; empty if it does not.
    histories_of_steps : bool
        True if it needs every step to add to the histories.
    """

    table: ClassVar[str] = ""
    every_step: ClassVar[bool] = True
    most_steps: ClassVar[float] = MOST_STEPS_RECORDED
    separates_lean: ClassVar[bool] = False
    column: ClassVar[str] = ""
    histories_of_steps: ClassVar[bool] = False

    def observes(self, motions: Sequence[Motion]) -> bool:
        """Return whether the observer applies to runs under any of these ``motions``: True unless a class overrides it."""
        return True

    def beside(self, run: Run, outcome: Outcome) -> Run | None:
        """Return another run whose outcome is compared with that of ``run``: None, for none, unless a class overrides it."""
        return None

    def compare(self, outcome: Outcome, other: Outcome) -> Outcome:
        """Return ``outcome`` with results of the ``other`` run by :meth:`beside`: unchanged unless a class overrides it."""
        return outcome

    def reads(self, run: Run, outcome: Outcome) -> bool:
        """Return whether the observer reads the history of this run: all but refused ones, unless a class overrides it."""
        return outcome.was_run

    def claims_error(self, outcome: Outcome) -> bool:
        """Return whether results have an error, by a history of twice the step: unless a run failed or is chaotic."""
        return outcome.status != "failed" and not outcome.chaotic

    def quiet_s(self, run: Run, quiet_s: float) -> float:
        """Return the time after the motion [s] that the observer needs in the history; ``quiet_s`` by default."""
        return quiet_s

    def read(self, recording: Recording, outcome: Outcome) -> Any:
        """Return the results of a history, of the type that :meth:`add` takes."""

    def beyond(self, run: Run, fine: Any, fewer: Any) -> Any:
        """Return the results ``fine`` with what a coarser model changes in their errors: one mode fewer, or half the strips.

        Unchanged unless a class overrides it.
        """
        return fine

    def add(self, run: Run, outcome: Outcome, fine: Any, coarse: Any) -> Outcome:
        """Return ``outcome`` with the results ``fine`` of its history and ``coarse`` by twice the step; None if not read.

        Unchanged unless a class overrides it.
        """
        return outcome

    def histories(self, recording: Recording) -> "Mapping[str, pd.DataFrame]":
        """Return tables that the observer adds to a run's histories, by fields of :class:`Response`: {} unless overridden."""
        return {}


Readings = dict[Observer, Any]
"""Results of a run's history, of the type of each observer."""


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
    """Return ``outcomes`` with the results of ``observers``; with ``error`` also their errors, by a history of twice the step.

    A run that is too long to be recorded at every step is read only by observers that need samples. A run with an odd number of
    steps per sample has no errors. Runs that come after ``stop`` are not read.
    """
    reading, halved = dict[int, list[Observer]](), [o.changed(substeps=o.substeps // 2) for o in outcomes]
    for i, (run, outcome) in enumerate(zip(runs, outcomes, strict=True)):
        chosen = [observer for observer in observers if _is_read(observer, run, outcome, quiet_s)]
        if chosen:
            reading[i] = chosen
    fine = _read_all(runs, outcomes, reading, quiet_s, wait, stop)
    claiming = dict[int, list[Observer]]()
    for i, found in fine.items() if error else ():
        chosen = [observer for observer in found if observer.claims_error(outcomes[i])]
        if chosen and outcomes[i].substeps % 2 == 0:
            claiming[i] = chosen
    coarse = _read_all(runs, halved, claiming, quiet_s, wait, stop, longer=False)
    models = {i: coarser(runs[i]) for i in claiming}
    fewer = list[dict[int, Readings]]()
    for n in range(max(map(len, models.values()), default=0)):
        of_models = {i: chosen for i, chosen in claiming.items() if n < len(models[i])}
        others = [models[i][n] if i in of_models else run for i, run in enumerate(runs)]
        fewer.append(_read_all(others, outcomes, of_models, quiet_s, wait, stop, longer=False))
    done = list(outcomes)
    for i, run in enumerate(runs):
        for observer in observers:
            read, of_twice = (found.get(i, {}).get(observer) for found in (fine, coarse))
            for of_model in fewer:
                if (of_fewer := of_model.get(i, {}).get(observer)) is not None:
                    read = observer.beyond(run, read, of_fewer)
            done[i] = observer.add(run, done[i], read, of_twice)
    return done


def _is_read(observer: Observer, run: Run, outcome: Outcome, quiet_s: float) -> bool:
    """Return True if the observer reads the run, and it is not too long for it."""
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
) -> dict[int, Readings]:
    """Return the readings of the observers in ``reading``, by the numbers of runs; those at samples run side by side.

    If ``longer``, a run continues as long as any of its observers needs, and the others read until the run's own end.
    """
    found, together = dict[int, Readings](), dict[float, list[int]]()
    for i, observers in reading.items():
        longest = max(observer.quiet_s(runs[i], quiet_s) for observer in observers) if longer else quiet_s
        if not any(observer.every_step for observer in observers):
            together.setdefault(longest, []).append(i)
        elif stop is None or not stop.is_set:
            try:
                recording = recorded(runs[i], outcomes[i], longest, True, wait)
            except InputError:  # its impacts make too many rows at every step
                together.setdefault(longest, []).append(i)
            else:
                found[i] = _readings_of(recording, outcomes[i], observers, quiet_s, longest)
    for longest, numbers in together.items():
        chosen = [runs[i] for i in numbers], [outcomes[i] for i in numbers]
        for j, recording in recorded_side_by_side(*chosen, longest, wait, stop):
            i = numbers[j]
            at_samples = [observer for observer in reading[i] if not observer.every_step]
            found[i] = _readings_of(recording, outcomes[i], at_samples, quiet_s, longest)
    return found


def _readings_of(
    recording: Recording, outcome: Outcome, observers: Iterable[Observer], quiet_s: float, longest: float
) -> Readings:
    """Return what each observer reads in a ``recording``, which goes on ``longest`` [s] after its motion.

    Observers that need no more than ``quiet_s`` read until the run's own end; those of samples read no steps between these.
    """
    whole = {True: recording, False: recording.at_samples}
    own = recording.until(outcome.t_end) if longest > quiet_s else recording
    short = {True: own, False: own.at_samples}
    found = Readings()
    for observer in observers:
        needs_all = observer.quiet_s(recording.run, quiet_s) > quiet_s
        found[observer] = observer.read((whole if needs_all else short)[observer.every_step], outcome)
    return found
