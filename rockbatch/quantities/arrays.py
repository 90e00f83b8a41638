"""Rows of peaks.csv as arrays, converted once, for fast access to a few rows and columns."""

import copy
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from rockbatch.quantities.statistics import Values

if TYPE_CHECKING:
    import pandas as pd

Texts = npt.NDArray[np.object_]

MISSING = -1
"""Place of a missing row."""


def texts_in(column: "pd.Series[Any]") -> "pd.Series[Any]":
    """Return a column of any dtype as texts, "" for None and NaN."""
    cells = column.astype(object)
    return cells.where(cells.notna(), "").map(str)


class Rows:
    """Rows of a table, at its n ``places``; their columns have shape (n,), with NaN or "" in missing rows and empty cells.

    Each column of the table is converted once, for all rows that :meth:`at` takes from it.
    """

    def __init__(self, table: "pd.DataFrame") -> None:
        self.places = np.arange(len(table))
        self._table = table
        self._own: dict[str, Texts] = {}
        self._numbers: dict[str, Values] = {}
        self._texts: dict[str, Texts] = {}

    def at(self, places: npt.NDArray[np.intp], **own: Texts) -> "Rows":
        """Return the rows at ``places`` of the table (not of these rows), :data:`MISSING` for a missing one.

        Columns of texts in ``own``, shape (n,), replace those of the table; those of these rows are not kept.
        """
        taken = copy.copy(self)
        taken.places, taken._own = places, own
        return taken

    def where(self, chosen: npt.NDArray[np.bool_]) -> "Rows":
        """Return the rows for which ``chosen``, shape (n,), is True."""
        return self.at(self.places[chosen], **{name: texts[chosen] for name, texts in self._own.items()})

    def same_rows_of(self, wider: "Rows") -> "Rows":
        """Return the rows of ``wider`` at the same places, where ``wider`` is the same table with further columns."""
        return wider.at(self.places, **self._own)

    def __len__(self) -> int:
        return len(self.places)

    def __contains__(self, column: str) -> bool:
        return column in self._table

    def numbers(self, column: str) -> Values:
        """Return a column of numbers; NaN throughout if the table lacks it, as the table of an earlier version may."""
        if column not in self._table:
            return np.full(len(self), np.nan)
        if column not in self._numbers:
            whole = self._table[column].to_numpy(dtype=np.float64, na_value=np.nan)
            self._numbers[column] = np.append(whole, np.nan)  # at MISSING, the last place
        return self._numbers[column][self.places]

    @property
    def missing(self) -> npt.NDArray[np.bool_]:
        """True for each missing row, shape (n,)."""
        return self.places == MISSING

    def facts(self, column: str) -> npt.NDArray[np.bool_]:
        """Return True where a column of facts is 1, shape (n,); False where it is 0 or empty, or the table lacks it."""
        return self.numbers(column) == 1.0

    def texts(self, column: str) -> Texts:
        """Return a column of texts; "" throughout if the table lacks it, as the table of an earlier version may."""
        if column in self._own:
            return self._own[column]
        if column not in self._table:
            return np.full(len(self), "", dtype=object)
        if column not in self._texts:
            self._texts[column] = np.array(
                [*texts_in(self._table[column]), ""], dtype=object
            )  # at MISSING, the last place
        return self._texts[column][self.places]
