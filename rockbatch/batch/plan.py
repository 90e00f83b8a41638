"""Plan of the runs of a study, in the order of its table, each made on demand."""

from abc import abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import overload

from rockbatch.motions import Motion, MotionSet
from rockbatch.results.columns import StudyRun
from rockbatch.simulation.runs import Run
from rockbatch.study import Study


def scaled(motion: Motion, scale: float, polarity: str) -> Motion:
    """Return a motion times ``scale``, with its horizontal component reversed for polarity "-"; the same object for 1 and "+"."""
    if scale == 1.0 and polarity == "+":
        return motion
    return motion.times(scale, reverse=polarity == "-")


def simulations(runs: Iterable[StudyRun]) -> list[Run]:
    """Return the simulations of ``runs``; runs of a record with the same scale and polarity share one motion."""
    motions: dict[tuple[int, float, str], Motion] = {}
    made = []
    for run in runs:
        key = id(run.record), run.scale, run.polarity
        if key not in motions:
            motions[key] = scaled(run.record, run.scale, run.polarity)
        made.append(Run(run.case.pier, run.case.base, motions[key]))
    return made


class Runs(Sequence[StudyRun]):
    """Sequence of runs made on demand, so that memory does not grow with their number."""

    mirrored = False
    """True if some runs are mirror images of others."""

    @abstractmethod
    def run(self, number: int) -> StudyRun:
        """Return run ``number``, from 0."""

    def images(self, number: int) -> Sequence[int]:
        """Return the numbers of a run and of its mirror image, if any; the first of them is simulated for both."""
        return (number,)

    @overload
    def __getitem__(self, index: int) -> StudyRun: ...

    @overload
    def __getitem__(self, index: slice) -> list[StudyRun]: ...

    def __getitem__(self, index: int | slice) -> StudyRun | list[StudyRun]:
        if isinstance(index, slice):
            return [self.run(i) for i in range(*index.indices(len(self)))]
        if not -len(self) <= index < len(self):
            raise IndexError(index)
        return self.run(index % len(self))

    def __iter__(self) -> Iterator[StudyRun]:
        return map(self.run, range(len(self)))


MOST_RUNS = 10_000_000
"""Most runs of a table, which is read into memory when finished, at some 300 bytes a row."""


class Plan(Runs):
    """The runs of a study by record, polarity, scale and case, the last varying fastest.

    Pier and foundation are symmetric, so that the two polarities are mirror images.
    """

    def __init__(self, study: Study, motions: MotionSet) -> None:
        self.motions = tuple(motions.motions)
        self.polarity, self.scale = study.motions.polarity, study.motions.scale
        self.cases = study.cases
        self.simulated = study.motions.simulated
        self.mirrored = len(self.polarity) > 1
        self._of_one = len(self.scale) * len(self.cases)  # runs of a motion in one polarity
        self._simulated_first = sorted(range(len(self.polarity)), key=lambda i: self.polarity[i] != self.simulated)
        self._length = len(self.motions) * len(self.polarity) * self._of_one

    def __len__(self) -> int:
        return self._length

    def run(self, number: int) -> StudyRun:
        """Return run ``number``, from 0; its ``mirror_of`` is the polarity that is simulated for both, "" for that itself."""
        rest, case = divmod(number, len(self.cases))
        rest, scale = divmod(rest, len(self.scale))
        motion, polarity = divmod(rest, len(self.polarity))
        sign = self.polarity[polarity]
        mirror_of = "" if sign == self.simulated else self.simulated
        on_axis = self.cases[case].motion(self.motions[motion])
        return StudyRun(on_axis, sign, self.scale[scale], self.cases[case], mirror_of)

    def images(self, number: int) -> Sequence[int]:
        """Return the numbers of both polarities of a run, the simulated one first; of one polarity its own number."""
        if not self.mirrored:
            return (number,)
        group, rest = divmod(number, self._of_one)
        first = group - group % len(self.polarity)
        return [(first + place) * self._of_one + rest for place in self._simulated_first]


class Made(Runs):
    """``length`` runs, the i-th of which is ``make(i)``."""

    def __init__(self, length: int, make: Callable[[int], StudyRun]) -> None:
        self._length, self._make = length, make

    def __len__(self) -> int:
        return self._length

    def run(self, number: int) -> StudyRun:
        """Return ``make(number)``."""
        return self._make(number)


def some_of(runs: Sequence[StudyRun], indices: Sequence[int]) -> Made:
    """Return the runs at ``indices``, made on demand."""
    return Made(len(indices), lambda number: runs[indices[number]])
