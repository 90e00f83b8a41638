"""Runs that are made when they are asked for, so that memory does not grow with their number."""

from collections.abc import Callable, Iterator, Sequence
from typing import overload

from rockbatch.plan import Run


class Made(Sequence[Run]):
    """``length`` runs, the i-th of which is ``make(i)``."""

    def __init__(self, length: int, make: Callable[[int], Run]) -> None:
        self._length, self._make = length, make

    def __len__(self) -> int:
        return self._length

    @overload
    def __getitem__(self, index: int) -> Run: ...

    @overload
    def __getitem__(self, index: slice) -> list[Run]: ...

    def __getitem__(self, index: int | slice) -> Run | list[Run]:
        if isinstance(index, slice):
            return [self._make(i) for i in range(*index.indices(self._length))]
        if not -self._length <= index < self._length:
            raise IndexError(index)
        return self._make(index % self._length)

    def __iter__(self) -> Iterator[Run]:
        return map(self._make, range(self._length))
