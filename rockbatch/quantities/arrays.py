"""Rows of peaks.csv as arrays, for what asks a few of them for a few columns, a thousand times over."""

import copy
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from rockbatch.quantities.statistics import Values

if TYPE_CHECKING:
    import pandas as pd

Texts = npt.NDArray[np.object_]

MISSING = -1
"""Place of a row that a table lacks."""


def texts_in(column: "pd.Series[Any]") -> "pd.Series[Any]":
    """Return a column as texts, "" where there is none, however pandas keeps it."""
    cells = column.astype(object)
    return cells.where(cells.notna(), "").map(str)


class Rows:
    """Rows of a table, n of them: columns of numbers, NaN where there is none, and of texts, "" there; shape (n,).

    ``places`` are theirs in the table, each of whose columns is converted once, for all that :meth:`at` takes from it.
    """

    def __init__(self, table: "pd.DataFrame") -> None:
        self.places = np.arange(len(table))
        self._table = table
        self._own: dict[str, Texts] = {}
        self._numbers: dict[str, Values] = {}
        self._texts: dict[str, Texts] = {}

    def at(self, places: npt.NDArray[np.intp], **own: Texts) -> "Rows":
        """Return those at ``places`` of the table, :data:`MISSING` for one that it lacks.

        Columns of their ``own`` stand in place of the table's, shape (n,).
        """
        taken = copy.copy(self)
        taken.places, taken._own = places, own
        return taken

    def where(self, chosen: npt.NDArray[np.bool_]) -> "Rows":
        """Return those that are ``chosen``, shape (n,)."""
        return self.at(self.places[chosen], **{name: texts[chosen] for name, texts in self._own.items()})

    def beside(self, wider: "Rows") -> "Rows":
        """Return the same rows of a table that has further columns, all of whose rows are in ``wider``."""
        return wider.at(self.places, **self._own)

    def __len__(self) -> int:
        return len(self.places)

    def __contains__(self, column: str) -> bool:
        return column in self._table

    def numbers(self, column: str) -> Values:
        """Return a column of numbers; NaN for one that an earlier version did not write."""
        if column not in self._table:
            return np.full(len(self), np.nan)
        if column not in self._numbers:
            whole = self._table[column].to_numpy(dtype=np.float64, na_value=np.nan)
            self._numbers[column] = np.append(whole, np.nan)  # which MISSING takes
        return self._numbers[column][self.places]

    @property
    def missing(self) -> npt.NDArray[np.bool_]:
        """True for each row that the table lacks, shape (n,)."""
        return self.places == MISSING

    def facts(self, column: str) -> npt.NDArray[np.bool_]:
        """Return True where a column of facts is 1, shape (n,); False where it is empty, too."""
        return self.numbers(column) == 1.0

    def texts(self, column: str) -> Texts:
        """Return a column of texts; "" for one that an earlier version did not write."""
        if column in self._own:
            return self._own[column]
        if column not in self._table:
            return np.full(len(self), "", dtype=object)
        if column not in self._texts:
            self._texts[column] = np.array([*texts_in(self._table[column]), ""], dtype=object)  # which MISSING takes
        return self._texts[column][self.places]
