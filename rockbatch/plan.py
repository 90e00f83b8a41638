"""Which runs a study consists of, in the order of its table, each made when it is asked for."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import overload

from rockbatch.motions import Motion, MotionSet
from rockbatch.study import Case, Study


@dataclass(frozen=True)
class Run:
    """One simulation: a motion, already scaled and turned, in a case.

    ``recorded`` is the motion before that, if it is at hand: a cluster is then sent each record once.
    """

    motion: Motion
    polarity: str
    scale: float
    case: Case
    recorded: Motion | None = None


def scaled(motion: Motion, scale: float, polarity: str) -> Motion:
    """A motion times ``scale``; with polarity "-" its horizontal component is reversed."""
    if scale == 1.0 and polarity == "+":
        return motion
    vertical = None if motion.vertical is None else motion.vertical * scale
    sign = -scale if polarity == "-" else scale
    return replace(motion, horizontal=motion.horizontal * sign, vertical=vertical)


class Plan(Sequence[Run]):
    """The runs of a study: record, polarity, scale, case, the last running fastest.

    Nothing is held but the study and its motions, however many runs there are; runs beside each other share the same
    scaled motion.
    """

    def __init__(self, study: Study, motions: MotionSet) -> None:
        self.motions = tuple(motions.motions)
        self.polarity, self.scale = study.motions.polarity, study.motions.scale
        self.cases = study.cases
        self._last: tuple[object, Motion] | None = None

    def __len__(self) -> int:
        return len(self.motions) * len(self.polarity) * len(self.scale) * len(self.cases)

    @overload
    def __getitem__(self, index: int) -> Run: ...

    @overload
    def __getitem__(self, index: slice) -> list[Run]: ...

    def __getitem__(self, index: int | slice) -> Run | list[Run]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        if not -len(self) <= index < len(self):
            raise IndexError(index)
        rest, case = divmod(index % len(self), len(self.cases))
        rest, scale = divmod(rest, len(self.scale))
        motion, polarity = divmod(rest, len(self.polarity))
        variant = (motion, polarity, scale)
        last = self._last
        if last is None or last[0] != variant:
            moved = scaled(self.motions[motion], self.scale[scale], self.polarity[polarity])
            last = self._last = (variant, moved)
        return Run(last[1], self.polarity[polarity], self.scale[scale], self.cases[case], self.motions[motion])

    def __iter__(self) -> Iterator[Run]:
        return (self[i] for i in range(len(self)))


class Chosen(Sequence[Run]):
    """Some of ``runs``, by their indices."""

    def __init__(self, runs: Sequence[Run], indices: Sequence[int]) -> None:
        self.runs, self.indices = runs, indices

    def __len__(self) -> int:
        return len(self.indices)

    @overload
    def __getitem__(self, index: int) -> Run: ...

    @overload
    def __getitem__(self, index: slice) -> list[Run]: ...

    def __getitem__(self, index: int | slice) -> Run | list[Run]:
        if isinstance(index, slice):
            return [self.runs[i] for i in self.indices[index]]
        return self.runs[self.indices[index]]
