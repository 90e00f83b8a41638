"""Recorded runs: histories at samples and events, or at every step."""

import contextlib
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from rockbatch.common.errors import InputError
from rockbatch.core import types
from rockbatch.core.types import Result
from rockbatch.outcome.outcome import Outcome
from rockbatch.simulation.runs import Run, Stop, alike, written_run, written_runs

MOST_ROWS = 10_000_000
"""Greatest number of rows of a history held in memory, about a gigabyte."""

ROWS_TOGETHER = 150_000
"""Greatest total number of rows of histories written side by side, some 16 megabytes."""

SPARE = 1.1
"""Rows reserved over the steps of a run: velocity reversals of springs have rows of their own."""


class Recording(NamedTuple):
    """A run, the rows of its history (``core.history``), and the time of its first flight [s], NaN without one."""

    run: Run
    rows: np.recarray
    t_flight: float

    @property
    def at_samples(self) -> "Recording":
        """The recording without steps between samples and events: bitwise the one that is recorded without them."""
        return self._replace(rows=self.rows[self.shown].view(np.recarray))

    @property
    def shown(self) -> np.ndarray:
        """Return True for each row at a sample or event, and for the last one, shape (rows,)."""
        shown: np.ndarray = self.rows.kind != types.STEP
        shown[-1:] = True  # an overturned pier may fall between samples
        return shown

    def until(self, t: float) -> "Recording":
        """Return the recording up to and including the time ``t`` [s]."""
        return self._replace(rows=self.rows[: int(np.searchsorted(self.rows.t, t, side="right"))].view(np.recarray))


def upright(rows: np.recarray, alpha: float) -> np.recarray:
    """Return ``rows`` until the pier leans beyond ``alpha`` [rad] for good, with a last one at α if it does.

    It lies on straight lines between the ends of the step in which the pier does so, whose velocities and devices are off by the
    square of its length.
    """
    last = int(np.flatnonzero(np.abs(rows.theta) <= alpha)[-1])
    kept = rows[: last + 1]
    if last + 1 == len(rows):
        return kept.view(np.recarray)
    start, end = rows[last], rows[last + 1]
    share = (alpha - abs(start.theta)) / (abs(end.theta) - abs(start.theta))
    at_alpha = rows[last : last + 1].copy()
    for name in rows.dtype.names or ():
        at_alpha[name] = start[name] + share * (end[name] - start[name])
    at_alpha["kind"] = types.STEP
    return np.concatenate([kept, at_alpha]).view(np.recarray)


def recorded(run: Run, outcome: Outcome, quiet_s: float, every_step: bool, wait: bool = True) -> Recording:
    """Return the history of a run again, with the steps and the end of its ``outcome``.

    Raises ``InputError`` for more than :data:`MOST_ROWS`.
    """
    capacity = min(_room(run, outcome, every_step), MOST_ROWS)
    result, rows = written_run(run, outcome.substeps, quiet_s, capacity, every_step=every_step, wait=wait)
    if result.rows > MOST_ROWS:
        instead = "leave out the energy ledger or use fewer substeps" if every_step else "cut the record"
        raise InputError(f"{run.motion.name}: a history of {result.rows} rows, more than {MOST_ROWS}; {instead}")
    if result.rows > capacity:
        result, rows = written_run(run, outcome.substeps, quiet_s, result.rows, every_step=every_step, wait=wait)
    return _recording(run, result, rows)


def _recording(run: Run, result: Result, rows: np.recarray) -> Recording:
    """Return the recording in the first of ``rows``, as many as the ``result`` has."""
    return Recording(run, rows[: result.rows].view(np.recarray), result.t_flight)


def _room(run: Run, outcome: Outcome, every_step: bool, until: float = math.inf) -> int:
    """Return an estimate of the number of rows of a run that ends by ``until`` [s]."""
    steps = min(outcome.t_end, until) / run.motion.dt * (outcome.substeps if every_step else 1)
    return int(SPARE * steps) + 64 * (outcome.impacts + outcome.separations + 64)


def recorded_side_by_side(
    runs: Sequence[Run], outcomes: Sequence[Outcome], quiet_s: float, wait: bool = True, stop: Stop | None = None
) -> Iterator[tuple[int, Recording]]:
    """Yield number and history, at samples and events, of each run; those of over MOST_ROWS are left out.

    Runs alike in system and step follow each other, short ones first. Runs that come after ``stop`` are left out, too.
    """
    ends = [math.inf if wait else run.motion.duration + quiet_s for run in runs]
    room = [_room(run, o, False, end) for run, o, end in zip(runs, outcomes, ends, strict=True)]
    groups: dict[tuple[object, ...], list[int]] = {}
    for i in sorted(range(len(runs)), key=room.__getitem__):
        groups.setdefault((outcomes[i].substeps, *alike(runs[i])), []).append(i)
    for members in groups.values():
        first = 0
        for n, i in enumerate(members, 1):
            if n == len(members) or (n + 1 - first) * room[members[n]] > ROWS_TOGETHER:
                if stop is not None and stop.is_set:
                    return
                yield from _recorded_together(runs, outcomes, members[first:n], quiet_s, room[i], wait)
                first = n


def _recorded_together(
    runs: Sequence[Run], outcomes: Sequence[Outcome], numbers: Sequence[int], quiet_s: float, room: int, wait: bool
) -> Iterator[tuple[int, Recording]]:
    """Yield the histories of the runs ``numbers``, alike in system and step, with ``room`` rows each, or more if needed."""
    if len(numbers) == 1:
        with contextlib.suppress(InputError):
            yield numbers[0], recorded(runs[numbers[0]], outcomes[numbers[0]], quiet_s, False, wait)
        return
    written = written_runs([runs[i] for i in numbers], outcomes[numbers[0]].substeps, quiet_s, room, wait=wait)
    for i, (result, rows) in zip(numbers, written, strict=True):
        if result.rows > room:
            with contextlib.suppress(InputError):
                yield i, recorded(runs[i], outcomes[i], quiet_s, False, wait)
        else:
            yield i, _recording(runs[i], result, rows)
